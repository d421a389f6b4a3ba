//! Systems: opening one, flying from body to body, the time.

use crate::app::{self, Editor, click, drag, planet, send, type_text, unfold, until};
use eframe::egui;
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::{Action, ClipAction, Command, NewBody, SystemAction};
use tellus::editor::files::dialogs::ScriptedDialogs;
use tellus::editor::state::system::trial::TrialRun;
use tellus::editor::viewport::camera::Mode;
use tellus::editor::viewport::travel::Arrival;
use tellus::planet::shipped;
use tellus::terrain::Terrain;

fn hearth() -> Editor {
    let mut harness = app::open([1024.0, 700.0], Vec::new());
    send(&mut harness, Command::System);
    click(&mut harness, "Choose a system");
    click(&mut harness, "Hearth");
    harness.run_steps(6);
    harness
}

#[test]
fn a_system_opens_its_first_planet_and_goes_from_body_to_body() {
    let mut harness = hearth();
    assert_eq!(planet(&harness).name, "Maren");
    // Stars have no surface to go to.
    let go = |harness: &Editor| harness.query_all_by_label("Go").count();
    assert_eq!(go(&harness), 7);
    harness.state_mut().push(Action::System(SystemAction::Visit(3, Arrival::Orbit)));
    harness.run_steps(6);
    assert_eq!(planet(&harness).name, "Pallor");
    click(&mut harness, "+1");
    let time_secs = harness.state().viewport().settings.time_secs;
    assert!((time_secs - 86_400.0).abs() < 1e-6, "{time_secs}");
    // Unsaved work is asked for before another body.
    harness.state_mut().send(Command::RandomPlanet);
    harness.run_steps(6);
    harness.state_mut().push(Action::System(SystemAction::Visit(2, Arrival::Orbit)));
    harness.run_steps(6);
    assert!(harness.query_by_label_contains("Discard").is_some());
}

#[test]
fn a_system_file_opens_like_a_preset_and_its_errors_are_told() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("one.ron"), "(version: 3, name: \"One\", radius_km: 900.0)").unwrap();
    let path = folder.path().join("small.ron");
    let text = |preset: &str| {
        format!(
            "(version: 1, name: \"Small\", bodies: [(name: \"S\", mass_earths: 3e5, light: ()), \
             (name: \"One\", preset: \"{preset}\", parent: \"S\", mass_earths: 0.01, orbit: ())])"
        )
    };
    std::fs::write(&path, text("one.ron")).unwrap();
    let recovery = tempfile::tempdir().unwrap();
    let mut harness = app::open_file(Some(&path), ScriptedDialogs::default(), recovery.path());
    harness.run_steps(4);
    assert_eq!(planet(&harness).name, "One");
    std::fs::write(&path, text("gone.ron")).unwrap();
    harness.state_mut().push(Action::OpenPath(path));
    until(&mut harness, "the message", |harness| harness.query_by_label_contains("could not be opened").is_some());
    assert!(harness.query_by_label_contains("gone.ron").is_some());
    // Another planet stands alone.
    let moon = shipped::ALL.iter().position(|preset| preset.file == "pallor.ron").unwrap();
    harness.state_mut().push(Action::DismissMessage);
    harness.state_mut().push(Action::OpenShipped(moon));
    harness.run_steps(6);
    assert_eq!(planet(&harness).name, "Pallor");
}

#[test]
fn a_planet_becomes_a_giant_and_gets_its_ground_back() {
    let mut harness = app::open([1024.0, 700.0], Vec::new());
    let before = planet(&harness);
    click(&mut harness, "Gas giant");
    click(&mut harness, "This planet is a gas giant");
    let giant = planet(&harness);
    assert!(giant.giant.is_some() && giant.layers.is_empty() && giant.water.is_none());
    assert!(harness.state().document().problems().is_empty());
    click(&mut harness, "This planet is a gas giant");
    assert_eq!(planet(&harness), before);
}

fn system(harness: &Editor) -> tellus::system::System {
    (**harness.state().system().unwrap().system()).clone()
}

fn act(harness: &mut Editor, action: SystemAction) {
    harness.state_mut().push(Action::System(action));
    harness.run_steps(6);
}

/// The place of a position on the map, as the map has it: distances as their roots.
fn on_map(harness: &Editor, center: usize, body: usize) -> egui::Pos2 {
    let rect = harness.get_by_role_and_label(Role::Canvas, "Map of the orbits").rect();
    let open = harness.state().system().unwrap();
    let (ephemeris, parents) = (open.worlds.ephemeris(), open.system().parents());
    let poses = ephemeris.at(harness.state().viewport().settings.time_secs);
    let children = (0..parents.len()).filter(|child| parents[*child] == Some(center));
    let reach =
        |body: usize| ephemeris.orbit(body).map_or(0.0, |orbit| orbit.semi_major_m * (1.0 + orbit.eccentricity));
    let widest_m = children.map(reach).fold(0.0, f64::max);
    let per_m = 0.5 * f64::from(rect.height()) / (widest_m * 1.12);
    let away_m = poses[body].position_m - poses[center].position_m;
    let away = away_m * (per_m * (widest_m / away_m.truncate().length()).sqrt());
    rect.center() + egui::vec2(away.x as f32, -away.y as f32)
}

#[test]
fn bodies_are_dragged_on_the_map_and_undo_takes_the_last_change_wherever_it_was() {
    let mut harness = hearth();
    let begun = system(&harness);
    let body = begun.find("Cinnabar").unwrap();
    let at = on_map(&harness, 0, body);
    let rect = harness.get_by_role_and_label(Role::Canvas, "Map of the orbits").rect();
    let to = rect.center() + (at - rect.center()) * 0.8;
    drag(&mut harness, at, to);
    let moved = system(&harness);
    let size_km = |system: &tellus::system::System| system.bodies[body].orbit.as_ref().unwrap().semi_major_km;
    // The map has the roots of distances.
    let ratio = size_km(&moved) / size_km(&begun);
    assert!((ratio - 0.64).abs() < 0.03, "{ratio}");
    assert!(on_map(&harness, 0, body).distance(to) < 3.0);
    assert_eq!(harness.state().system().unwrap().history().undo_label(), Some("Move Cinnabar"));
    assert_eq!(harness.state().system().unwrap().history().undo_len(), 1, "a drag is one step");
    // The widest orbit, held outside the map: the map keeps its scale meanwhile.
    let garland = begun.find("Garland").unwrap();
    let at = on_map(&harness, 0, garland);
    harness.drag_at(at);
    harness.run_steps(2);
    harness.hover_at(rect.center() + (at - rect.center()) * 1.1);
    harness.run_steps(30);
    harness.drop_at(rect.center() + (at - rect.center()) * 1.1);
    harness.run_steps(4);
    let of_garland_km = |system: &tellus::system::System| system.bodies[garland].orbit.as_ref().unwrap().semi_major_km;
    let ratio = of_garland_km(&system(&harness)) / of_garland_km(&begun);
    assert!((ratio - 1.21).abs() < 0.05, "{ratio}");
    act(&mut harness, SystemAction::Undo);
    assert_eq!(system(&harness), moved);
    // Then the planet.
    send(&mut harness, Command::RandomPlanet);
    send(&mut harness, Command::Undo);
    assert_eq!((planet(&harness).name.as_str(), system(&harness)), ("Maren", moved.clone()));
    act(&mut harness, SystemAction::Undo);
    assert_eq!(system(&harness), begun);
    send(&mut harness, Command::Redo);
    assert_eq!(system(&harness), moved, "the system was changed last");
    send(&mut harness, Command::Undo);
    assert_eq!(system(&harness), begun);
}

#[test]
fn bodies_are_added_named_locked_rolled_and_removed() {
    let mut harness = hearth();
    let begun = system(&harness);
    let here = harness.state().viewport().body();
    let pallor = shipped::ALL.iter().position(|preset| preset.file == "pallor.ron").unwrap();
    act(&mut harness, SystemAction::Add(begun.find("Maren").unwrap(), NewBody::Shipped(pallor)));
    let added = system(&harness);
    assert_eq!(added.bodies.last().unwrap().name, "Pallor 2");
    assert_eq!(added.bodies.last().unwrap().parent, "Maren");
    assert_eq!(harness.state().system().unwrap().warnings, Vec::<String>::new());
    click(&mut harness, "Lock Aurel");
    click(&mut harness, "Random orbits");
    let rolled = system(&harness);
    let aurel = begun.find("Aurel").unwrap();
    assert_eq!(rolled.bodies[aurel], begun.bodies[aurel]);
    assert!(rolled.bodies.iter().zip(&added.bodies).any(|(a, b)| a.orbit != b.orbit));
    // The planet stays the body that it is.
    assert_eq!(harness.state().viewport().body(), here);
    act(&mut harness, SystemAction::Remove(begun.find("Maren").unwrap()));
    assert_eq!(system(&harness).bodies.len(), begun.bodies.len() - 1, "its moon went with it");
    assert_eq!(harness.state().viewport().body(), None, "the planet stands alone");
    for _ in 0..3 {
        act(&mut harness, SystemAction::Undo);
    }
    assert_eq!(system(&harness), begun);
}

#[test]
fn a_name_and_numbers_are_typed_and_children_follow_the_name() {
    let mut harness = hearth();
    let aurel = system(&harness).find("Aurel").unwrap();
    click(&mut harness, "Aurel");
    unfold(&mut harness, "Body: Aurel");
    harness.get_by_role_and_label(Role::TextInput, "Name").scroll_to_me();
    harness.run_steps(40);
    harness.get_by_role_and_label(Role::TextInput, "Name").focus();
    harness.run_steps(3);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    type_text(&mut harness, "Home");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(6);
    let named = system(&harness);
    assert_eq!(named.bodies[aurel].name, "Home");
    assert_eq!(named.bodies[named.find("Pallor").unwrap()].parent, "Home");
    assert_eq!(harness.state().system().unwrap().history().undo_label(), Some("Rename Aurel"));
}

#[test]
fn a_run_tells_whether_the_system_lasts() {
    let mut harness = hearth();
    act(&mut harness, SystemAction::Try(0.3));
    until(&mut harness, "the end of the run", |harness| {
        matches!(harness.state().system().unwrap().trial, TrialRun::Done(_))
    });
    unfold(&mut harness, "Does it last?");
    assert!(harness.query_by_label_contains("the energy is off by").is_some());
    assert!(harness.query_by_label_contains("No body met another").is_some());
    // Another system is not the one that was run.
    act(&mut harness, SystemAction::Roll);
    assert!(matches!(harness.state().system().unwrap().trial, TrialRun::None));
}

#[test]
fn a_changed_system_is_asked_for_and_saved_with_its_presets() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let mut harness = app::open([1024.0, 700.0], vec![Some(path.clone())]);
    act(&mut harness, SystemAction::Open(0));
    assert_eq!(planet(&harness).name, "Maren");
    act(&mut harness, SystemAction::Roll);
    let rolled = system(&harness);
    act(&mut harness, SystemAction::Open(1));
    assert!(harness.query_by_label_contains("Hearth has unsaved changes").is_some());
    click(&mut harness, "Save changes");
    until(&mut harness, "the other system", |harness| planet(harness).name == "Sabkha");
    let saved = tellus::system::System::load(&path).unwrap();
    assert_eq!(saved.bodies[2].orbit, rolled.bodies[2].orbit);
    assert!(saved.load_planets(&path).unwrap().iter().flatten().count() >= 6);
    // Saving again elsewhere replaces nothing without a question.
    act(&mut harness, SystemAction::Roll);
    act(&mut harness, SystemAction::Leave);
    click(&mut harness, "Discard changes");
    assert!(harness.state().system().is_none() && harness.state().viewport().body().is_none());
}

#[test]
fn a_system_begins_around_a_planet_with_a_file() {
    let mut harness = app::open([1024.0, 700.0], Vec::new());
    act(&mut harness, SystemAction::Begin);
    assert!(harness.state().system().is_none(), "no file holds the planet");
    assert!(harness.query_by_label_contains("Save the planet first").is_some());
    let maren = shipped::ALL.iter().position(|preset| preset.file == "maren.ron").unwrap();
    harness.state_mut().push(Action::OpenShipped(maren));
    harness.run_steps(6);
    act(&mut harness, SystemAction::Begin);
    assert_eq!(harness.state().viewport().body(), Some(1));
    let begun = system(&harness);
    assert_eq!((begun.bodies[0].name.as_str(), begun.bodies[1].name.as_str()), ("Sun", "Maren"));
    assert_eq!(begun.bodies[1].orbit.as_ref().unwrap().semi_major_km.round(), 149_598_000.0);
    act(&mut harness, SystemAction::Add(1, NewBody::Open));
    assert_eq!(system(&harness).bodies[2].parent, "Maren");
}

/// A planet and its moon, both bare.
fn pair(folder: &std::path::Path) -> std::path::PathBuf {
    for (file, radius_km) in [("home.ron", 3000.0), ("moon.ron", 900.0)] {
        let text = format!("(version: 3, name: \"{file}\", radius_km: {radius_km:?})");
        std::fs::write(folder.join(file), text).unwrap();
    }
    let orbit = |semi_major_km: f64| format!("orbit: (semi_major_km: {semi_major_km:?})");
    let body = |name: &str, parent: &str, mass: f64, orbit: String| {
        format!("(name: \"{name}\", preset: \"{name}.ron\", parent: \"{parent}\", mass_earths: {mass:?}, {orbit})")
    };
    let bodies = [
        "(name: \"Star\", mass_earths: 3e5, light: ())".to_owned(),
        body("home", "Star", 0.5, orbit(1.5e8)),
        body("moon", "home", 0.01, orbit(60_000.0)),
    ];
    let path = folder.join("pair.ron");
    std::fs::write(&path, format!("(version: 1, name: \"Pair\", bodies: [{}])", bodies.join(", "))).unwrap();
    path
}

/// Distances of the eye from the centres of the planet and of its moon, in their radii.
fn away(harness: &Editor) -> [f64; 2] {
    let worlds = &harness.state().system().unwrap().worlds;
    let viewport = harness.state().viewport();
    let pose = viewport.pose(&planet(harness));
    let around = worlds.around(viewport.body().unwrap(), pose.position_planet_m, viewport.settings.time_secs);
    [1, 2].map(|body| around.place(body).0.length() / worlds.radii_m()[body])
}

#[test]
fn a_flight_to_a_moon_has_no_cut() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = app::open_file_with_picture([640.0, 480.0], &pair(folder.path()), 5.0);
    app::wait_for_picture(&mut harness);
    assert_eq!(planet(&harness).name, "home.ron");
    harness.state_mut().push(Action::System(SystemAction::Visit(2, Arrival::Orbit)));
    until(&mut harness, "the flight", |harness| harness.state().viewport().is_travelling());
    let (mut before, mut names, mut frames) = (away(&harness), vec!["home.ron".to_owned()], 0);
    while harness.state().viewport().is_travelling() {
        harness.step();
        // The builders have time between the frames, as on a slow machine.
        std::thread::sleep(std::time::Duration::from_millis(30));
        let now = away(&harness);
        // A fifth of a second: neither end comes nearer, or goes farther away, by more than a factor.
        for (now, before) in now.into_iter().zip(before) {
            assert!((0.3..3.3).contains(&(now / before)), "{before} {now} in frame {frames}");
        }
        let stats = harness.state().viewport().stats();
        assert!(stats.tiles_drawn > 0, "frame {frames}");
        let name = planet(&harness).name;
        if names.last() != Some(&name) {
            names.push(name);
        }
        (before, frames) = (now, frames + 1);
        assert!(frames < 200);
    }
    assert_eq!(names, ["home.ron", "moon.ron"]);
    assert!(frames > 10, "{frames}");
    harness.run_steps(8);
    assert!((before[1] - 2.9).abs() < 0.05, "{before:?}");
    assert!((away(&harness)[1] - before[1]).abs() < 0.02, "the camera in use takes over where the flight ends");
}

/// From standing on the planet to standing on its moon: every frame has ground, and none jumps.
#[test]
fn a_flight_from_ground_to_ground_has_no_cut() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = app::open_file_with_picture([640.0, 480.0], &pair(folder.path()), 5.0);
    app::wait_for_picture(&mut harness);
    // The body is the open planet: it stays open.
    harness.state_mut().push(Action::System(SystemAction::Visit(1, Arrival::Ground)));
    let stands = |harness: &Editor| {
        let viewport = harness.state().viewport();
        !viewport.is_travelling() && viewport.cameras().mode() == Mode::Walk && !viewport.cameras().is_flying_to()
    };
    until(&mut harness, "standing on the planet", stands);
    assert_eq!(planet(&harness).name, "home.ron");
    harness.state_mut().push(Action::System(SystemAction::Visit(2, Arrival::Ground)));
    until(&mut harness, "the flight", |harness| harness.state().viewport().is_travelling());
    // Heights over the reference spheres, of a stone's throw at least.
    let heights = |harness: &Editor| away(harness).map(|radii| (radii - 1.0).max(1e-3));
    let (mut before, mut frames) = (heights(&harness), 0);
    while !stands(&harness) {
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(30));
        let now = heights(&harness);
        for (now, before) in now.into_iter().zip(before) {
            assert!((0.1..10.0).contains(&(now / before)), "{before} {now} in frame {frames}");
        }
        assert!(harness.state().viewport().stats().tiles_drawn > 0, "frame {frames}");
        (before, frames) = (now, frames + 1);
        assert!(frames < 300);
    }
    assert_eq!(planet(&harness).name, "moon.ron");
    let eye_m = harness.state().viewport().pose(&planet(&harness)).position_planet_m;
    let terrain = Terrain::try_new(planet(&harness).into()).unwrap();
    let sea_m = terrain.planet().sea_level_m().unwrap_or(f64::MIN);
    let over_m = eye_m.length() - terrain.planet().radius_m() - terrain.height_m(eye_m).max(sea_m);
    assert!((over_m - 1.7).abs() < 0.3, "{over_m}");
}

#[test]
fn a_key_ends_a_flight_at_its_goal() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = app::open_file_with_picture([640.0, 480.0], &pair(folder.path()), 30.0);
    app::wait_for_picture(&mut harness);
    harness.state_mut().push(Action::System(SystemAction::Visit(2, Arrival::Orbit)));
    until(&mut harness, "the flight", |harness| harness.state().viewport().is_travelling());
    harness.key_press(egui::Key::Space);
    harness.run_steps(4);
    assert!(!harness.state().viewport().is_travelling());
    assert_eq!(planet(&harness).name, "moon.ron");
    // And back, while the planet is changed: its changes are asked for before they are lost.
    harness.state_mut().push(Action::System(SystemAction::Visit(1, Arrival::Orbit)));
    until(&mut harness, "the flight", |harness| harness.state().viewport().is_travelling());
    let mut changed = planet(&harness);
    changed.seed += 1;
    harness.state_mut().push(Action::Clip(ClipAction::TakeText(changed.to_text())));
    harness.run_steps(2);
    harness.key_press(egui::Key::Space);
    until(&mut harness, "the question", |harness| harness.query_by_label_contains("Discard").is_some());
    assert!(!harness.state().viewport().is_travelling());
}

/// Changes that were discarded for a flight are not asked for again when it arrives.
#[test]
fn changes_that_are_discarded_for_a_flight_are_asked_for_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = app::open_file_with_picture([640.0, 480.0], &pair(folder.path()), 5.0);
    app::wait_for_picture(&mut harness);
    let mut changed = planet(&harness);
    changed.seed += 1;
    harness.state_mut().push(Action::Clip(ClipAction::TakeText(changed.to_text())));
    harness.run_steps(2);
    harness.state_mut().push(Action::System(SystemAction::Visit(2, Arrival::Ground)));
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Then moon opens").is_some());
    click(&mut harness, "Discard changes");
    let lands = |harness: &Editor| {
        assert!(harness.query_by_label_contains("Discard").is_none(), "asked again");
        let viewport = harness.state().viewport();
        !viewport.is_travelling() && viewport.cameras().mode() == Mode::Walk && !viewport.cameras().is_flying_to()
    };
    until(&mut harness, "standing on the moon", lands);
    assert_eq!(planet(&harness).name, "moon.ron");
}
