//! Variations of the planet, and locks on what they leave as it is.

use super::*;
use tellus::editor::command::{ClipAction, VariationAction, Wanted};
use tellus::editor::state::variations::COUNT;
use tellus::planet::locks::Locks;
use tellus::planet::param::ParamPath;

fn names() -> impl Iterator<Item = String> {
    (1..=COUNT).map(|number| format!("Variation {number}"))
}

fn locks(harness: &Editor) -> Locks {
    Locks::of(&planet(harness))
}

#[test]
fn a_variation_is_taken_with_a_click_and_is_an_undo_step() {
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::E);
    names().for_each(|name| assert!(harness.query_by_label(&name).is_some(), "{name}"));
    harness.check_accessibility();
    click(&mut harness, "Variation 4");
    let taken = planet(&harness);
    assert_ne!(taken, before);
    assert_eq!(undo_label(&harness), "Take variation 4");
    assert!(harness.query_by_label("Save your changes?").is_none(), "it is no question");
    click(&mut harness, "Variation 4");
    assert_eq!(undo_len(&harness), 2, "each is a step of its own");
    let ratio = |planet: &Planet| planet.layers[0].amplitude_m / before.layers[0].amplitude_m;
    assert!((0.5..2.0).contains(&ratio(&taken)), "a variation strays as far as it may: {}", ratio(&taken));
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(planet(&harness), before);
    click(&mut harness, "Again");
    click(&mut harness, "Variation 4");
    assert_ne!(planet(&harness), taken, "nine others");
    escape(&mut harness);
    assert!(harness.query_by_label("Variation 1").is_none());
}

#[test]
fn one_tab_varies_alone() {
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    click(&mut harness, "Climate");
    click(&mut harness, "Vary climate");
    let varied = planet(&harness);
    assert_ne!(varied.climate, before.climate);
    assert_eq!(Planet { climate: before.climate.clone(), ..varied }, before);
    assert_eq!(undo_label(&harness), "Vary climate");

    send(&mut harness, Command::Variations);
    let mut wish = harness.state().variations().wish;
    wish.part = Some("star");
    harness.state_mut().push(Action::Variation(VariationAction::Wish(wish)));
    harness.run_steps(3);
    let varied = planet(&harness);
    click(&mut harness, "Variation 9");
    let taken = planet(&harness);
    assert_ne!(taken.star, varied.star);
    assert_eq!(Planet { star: varied.star.clone(), ..taken }, varied);
}

#[test]
fn what_is_locked_stays() {
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    click(&mut harness, "Climate");
    click(&mut harness, "Lock climate");
    assert!(locks(&harness).hold(&ParamPath::default().join("climate").join("seed")));
    assert_eq!(undo_label(&harness), "Lock climate");
    click(&mut harness, "Vary climate");
    assert_eq!(planet(&harness).climate, before.climate);

    click(&mut harness, "Planet");
    harness.get_by_role_and_label(Role::Label, "Radius").click_secondary();
    harness.run_steps(3);
    click(&mut harness, "Lock");
    assert_eq!(undo_label(&harness), "Lock radius");
    send(&mut harness, Command::RandomPlanet);
    let rolled = planet(&harness);
    assert_ne!(rolled.name, before.name);
    assert_eq!((&rolled.climate, rolled.radius_km), (&before.climate, before.radius_km));
    assert_eq!(locks(&harness).len(), 2, "the locks stay with what they are on");

    click(&mut harness, "Unlock Radius of planet");
    assert_eq!(locks(&harness).len(), 1);
    send(&mut harness, Command::Variations);
    assert!(harness.query_by_label("1 lock").is_some());
    click(&mut harness, "Unlock all");
    assert!(locks(&harness).is_empty());
}

#[test]
fn a_locked_layer_stays_under_another_name() {
    let mut harness = editor(vec![]);
    let layer = planet(&harness).layers[0].clone();
    click(&mut harness, "Terrain");
    harness.get_by_label(&format!("Layer {}", layer.name)).click_secondary();
    harness.run_steps(3);
    click(&mut harness, "Lock");
    click(&mut harness, "Vary terrain");
    let varied = planet(&harness);
    assert_eq!(varied.layers[0], layer);
    assert_ne!(varied.layers[1..], planet(&editor(vec![])).layers[1..]);
    harness.get_by_label(&format!("Name of {}", layer.name)).focus();
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
    type_text(&mut harness, "Renamed");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    assert_eq!(planet(&harness).layers[0].name, "Renamed");
    click(&mut harness, "Vary terrain");
    assert_eq!(planet(&harness).layers[0].amplitude_m, layer.amplitude_m);
}

#[test]
fn nine_pictures_are_drawn() {
    let mut harness = drawn_editor();
    send(&mut harness, Command::Variations);
    app::until(&mut harness, "nine pictures", |harness| {
        let variations = harness.state().variations();
        variations.sheet.cells.len() == COUNT && variations.sheet.missing() == 0
    });
    for cell in &harness.state().variations().sheet.cells {
        assert!(matches!(cell.picture, Some(Ok(_))));
    }
    send(&mut harness, Command::Variations);
    harness.run_steps(3);
    assert!(harness.state().variations().sheet.cells.is_empty(), "a closed window keeps no pictures");
}

#[test]
fn a_new_planet_begins_as_a_template() {
    let mut harness = editor(vec![]);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::N);
    for entry in &templates::ALL {
        assert!(harness.query_by_role_and_label(Role::Button, entry.name).is_some(), "{}", entry.name);
    }
    harness.check_accessibility();
    harness.get_by_role_and_label(Role::Button, "Blank sphere").click();
    harness.run_steps(20);
    assert_eq!(planet(&harness), Planet { name: "Untitled".to_owned(), ..Planet::default() });
    assert!(harness.query_by_role_and_label(Role::Button, "Blank sphere").is_none(), "the window has closed");
    assert!(!harness.state().document().is_dirty(), "nothing is lost yet");

    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    send(&mut harness, Command::New);
    harness.get_by_role_and_label(Role::Button, "Moon").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Save your changes?").is_some());
    click(&mut harness, "Cancel");
    assert_eq!(planet(&harness).radius_km, 2500.0);
    harness.get_by_role_and_label(Role::Button, "Random: dry").click();
    harness.run_steps(3);
    assert!(planet(&harness).water.is_none() && !planet(&harness).layers.is_empty());
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness).radius_km, 2500.0, "a random one is a step like any other");
}

#[test]
fn a_kept_copy_is_compared_and_swapped() {
    let mut harness = editor(vec![]);
    let kept = planet(&harness);
    send(&mut harness, Command::Compare);
    click(&mut harness, "Planet");
    // No parameter that moves the camera.
    slide(&mut harness, "Settlements of planet", 1.0);
    let now = planet(&harness);
    let compared = |harness: &Editor| harness.state().viewport().compare().map(|compare| (**compare.planet()).clone());
    assert_eq!(compared(&harness), Some(kept.clone()));
    const LINE: &str = "Line between the kept copy and the planet";
    let line = |harness: &Editor| harness.get_by_role_and_label(Role::Slider, LINE).rect().center();
    let (from, eye) = (line(&harness), pose(&harness));
    drag(&mut harness, from, from - egui::vec2(150.0, 0.0));
    assert!((line(&harness).x - (from.x - 150.0)).abs() < 2.0, "{:?}", line(&harness));
    assert_eq!(pose(&harness), eye, "the camera has no part in that drag");
    send(&mut harness, Command::SwapCompared);
    assert_eq!((planet(&harness), compared(&harness)), (kept, Some(now.clone())));
    assert_eq!(undo_label(&harness), "Swap with the kept copy");
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness), now);
    send(&mut harness, Command::Compare);
    assert_eq!(compared(&harness), None);
}

#[test]
fn both_planets_are_drawn() {
    let mut harness = drawn_editor();
    app::wait_for_picture(&mut harness);
    send(&mut harness, Command::Compare);
    app::until(&mut harness, "the kept planet is drawn", |harness| {
        harness.state().viewport().compare().is_some_and(tellus::editor::viewport::compare::Compare::is_drawn)
    });
    // On the right the planet loses everything that is not black or grey.
    let bare = Planet { name: "Bare".to_owned(), radius_km: planet(&harness).radius_km, ..Planet::default() };
    harness.state_mut().push(Action::Clip(ClipAction::Paste(Wanted::Part(""), bare.to_text())));
    harness.run_steps(3);
    app::wait_for_picture(&mut harness);
    let image = harness.render().unwrap();
    let rect = canvas(&harness);
    let scale = image.width() as f32 / 1024.0;
    // How blue the picture is on either side of the line.
    let blue = |from: f32, to: f32| {
        let mut sum = 0.0;
        for x in (from * scale) as u32..(to * scale) as u32 {
            for y in (rect.top() * scale) as u32..(rect.bottom() * scale) as u32 {
                let pixel = image.get_pixel(x, y);
                sum += f32::from(pixel[2]) - f32::from(pixel[0]);
            }
        }
        sum / (to - from)
    };
    let middle = rect.center().x;
    let (left, right) = (blue(rect.left(), middle - 2.0), blue(middle + 2.0, rect.right()));
    assert!(left > 500.0 && right < 0.2 * left, "{left} {right}");
}
