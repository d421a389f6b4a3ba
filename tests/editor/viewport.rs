//! The camera and the picture.

use super::*;

#[test]
fn a_drag_with_shift_turns_the_star_in_one_step() {
    let mut harness = drawn_editor();
    let before = planet(&harness).star;
    let center = canvas(&harness).center();
    let button = |pressed, pos| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::SHIFT,
    };
    harness.hover_at(center);
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::SHIFT));
    harness.event(button(true, center));
    for step in 1..6 {
        harness.hover_at(center + egui::vec2(20.0 * step as f32, 0.0));
    }
    harness.event(button(false, center + egui::vec2(100.0, 0.0)));
    harness.run_steps(3);
    assert_ne!(planet(&harness).star.longitude_deg, before.longitude_deg);
    assert_eq!(undo_label(&harness), "Turn the sun");
    assert_eq!(undo_len(&harness), 1);
}

/// Frames a second of tests that travel: few, so that the tests are quick.
const FRAMES_PER_SEC: f32 = 8.0;

/// An editor for travelling. Its debug view is drawn fast: without sky and sea.
fn plain_editor(answers: Vec<Option<PathBuf>>) -> Editor {
    let mut harness = app::open_at_rate([1024.0, 640.0], answers, FRAMES_PER_SEC);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Num8);
    wait_for_picture(&mut harness);
    harness
}

fn run_secs(harness: &mut Editor, secs: f32) {
    harness.run_steps((secs * FRAMES_PER_SEC).round() as usize);
}

/// Steps until the camera is at rest.
fn wait_for_camera(harness: &mut Editor) {
    for _ in 0..400 {
        harness.step();
        if !harness.state().viewport().is_moving() {
            return;
        }
    }
    panic!("the camera never comes to rest");
}

fn mode(harness: &Editor) -> Mode {
    harness.state().viewport().cameras().mode()
}

fn eye_height_m(harness: &Editor) -> f64 {
    harness.state().viewport().eye(harness.state().document().valid_planet()).0
}

#[test]
fn keys_change_the_way_to_move_and_the_status_says_so() {
    let mut harness = plain_editor(vec![]);
    assert!(harness.query_by_label("Orbit").is_some());
    let from_space_m = eye_height_m(&harness);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F3);
    assert_eq!(mode(&harness), Mode::Fly);
    assert!(harness.query_by_label("Fly").is_some());
    assert!((eye_height_m(&harness) / from_space_m - 1.0).abs() < 1e-9, "the eye stays where it was");
    harness.key_down(egui::Key::W);
    run_secs(&mut harness, 0.34);
    harness.key_up(egui::Key::W);
    wait_for_camera(&mut harness);
    assert!(eye_height_m(&harness) < 0.9 * from_space_m, "W goes to where one looks");

    press(&mut harness, egui::Modifiers::NONE, egui::Key::F4);
    wait_for_camera(&mut harness);
    assert_eq!(mode(&harness), Mode::Walk);
    assert!((eye_height_m(&harness) - 1.7).abs() < 1e-3, "{}", eye_height_m(&harness));
    let start = harness.state().viewport().pose(&planet(&harness)).position_planet_m;
    harness.key_down(egui::Key::W);
    run_secs(&mut harness, 0.5);
    harness.key_up(egui::Key::W);
    wait_for_camera(&mut harness);
    let way_m = start.distance(harness.state().viewport().pose(&planet(&harness)).position_planet_m);
    assert!((0.1..10.0).contains(&way_m), "half a second's walk is {way_m} m");
    assert!((eye_height_m(&harness) - 1.7).abs() < 1e-3);
    harness.key_press(egui::Key::Space);
    run_secs(&mut harness, 0.2);
    assert!(eye_height_m(&harness) > 1.9, "a jump: {}", eye_height_m(&harness));
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F2);
    assert_eq!(mode(&harness), Mode::Orbit);
    assert_eq!(undo_len(&harness), 0, "to look around is no edit");
}

#[test]
fn number_keys_show_debug_views_but_not_while_one_types() {
    let mut harness = drawn_editor();
    for (key, view) in [
        (egui::Key::Num2, DebugView::Height),
        (egui::Key::Num6, DebugView::Temperature),
        (egui::Key::Num9, DebugView::TileBorders),
        (egui::Key::Num0, DebugView::Wireframe),
        (egui::Key::Minus, DebugView::Error),
        (egui::Key::Equals, DebugView::Coverage),
        (egui::Key::Num1, DebugView::Shaded),
    ] {
        press(&mut harness, egui::Modifiers::NONE, key);
        assert_eq!(harness.state().viewport().settings.debug_view, view);
    }
    click(&mut harness, "View");
    click(&mut harness, "Show: shaded");
    harness.get_by_label_contains("Moisture").click();
    harness.run_steps(3);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Moisture);
    click(&mut harness, "Planet");
    harness.get_by_role_and_label(Role::TextInput, "Name of planet").focus();
    harness.run_steps(3);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Num2);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Moisture);
}

#[test]
fn frozen_detail_stays_while_the_camera_goes_on() {
    let mut harness = plain_editor(vec![]);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F6);
    let frozen = harness.state().viewport().surface().unwrap();
    let drawn = harness.state().viewport().stats().tiles_drawn;
    assert!(harness.query_by_label_contains("detail frozen").is_some());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F3);
    harness.key_down(egui::Key::W);
    run_secs(&mut harness, 0.3);
    harness.key_up(egui::Key::W);
    wait_for_picture(&mut harness);
    let viewport = harness.state().viewport();
    assert!(std::sync::Arc::ptr_eq(&frozen, &viewport.surface().unwrap()), "no tile was built");
    assert_eq!(viewport.stats().tiles_drawn, drawn, "culled as seen from the frozen eye");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F6);
    wait_for_picture(&mut harness);
    assert!(!std::sync::Arc::ptr_eq(&frozen, &harness.state().viewport().surface().unwrap()));
}

#[test]
fn bookmarks_are_added_gone_to_renamed_and_deleted_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let mut harness = app::open([1024.0, 640.0], vec![Some(path.clone())]);
    let names = |harness: &Editor| -> Vec<String> {
        let bookmarks = planet(harness).editor.map(|editor| editor.bookmarks).unwrap_or_default();
        bookmarks.into_iter().map(|bookmark| bookmark.name).collect()
    };
    let before = planet(&harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::B);
    assert_eq!(names(&harness), ["View 1"]);
    assert_eq!(undo_label(&harness), "Add bookmark");
    let here = harness.state().viewport().pose(&planet(&harness));

    press(&mut harness, egui::Modifiers::NONE, egui::Key::F4);
    wait_for_camera(&mut harness);
    send(&mut harness, Command::AddBookmark);
    assert_eq!(names(&harness), ["View 1", "View 2"]);
    click(&mut harness, "Planet");
    assert!(harness.query_by_label("Name of planet").is_some());
    assert!(harness.query_by_label_contains("Heading").is_none(), "bookmarks are no parameters of the planet");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Num1);
    assert!(harness.state().viewport().is_moving(), "a flight, not a jump");
    wait_for_camera(&mut harness);
    assert_eq!(mode(&harness), Mode::Fly, "nobody stands in space");
    let now = harness.state().viewport().pose(&planet(&harness));
    let off_m = now.position_planet_m.distance(here.position_planet_m);
    assert!(off_m < 1.0, "{off_m} m off");
    assert!(now.planet_from_view.angle_between(here.planet_from_view) < 1e-3);

    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Num2);
    wait_for_camera(&mut harness);
    assert_eq!(mode(&harness), Mode::Walk, "on foot again");

    click(&mut harness, "Bookmarks");
    click(&mut harness, "View 2");
    click(&mut harness, "Rename…");
    let field = harness.get_by_role_and_label(Role::TextInput, "Name of the view");
    field.focus();
    harness.run_steps(2);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_role_and_label(Role::TextInput, "Name of the view").type_text("Beach");
    harness.run_steps(2);
    click(&mut harness, "Rename");
    assert_eq!(names(&harness), ["View 1", "Beach"]);
    assert_eq!(undo_label(&harness), "Rename bookmark");

    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::S);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("name: \"Beach\""), "{text}");
    assert_eq!(Planet::load(&path).unwrap(), planet(&harness));

    click(&mut harness, "Bookmarks");
    click(&mut harness, "View 1");
    click(&mut harness, "Delete");
    assert_eq!(names(&harness), ["Beach"]);
    for _ in 0..4 {
        send(&mut harness, Command::Undo);
    }
    assert_eq!(planet(&harness), before);
}

#[test]
fn every_key_stands_in_the_list_of_controls() {
    let mut harness = drawn_editor();
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F1);
    for text in ["Walk; slower uphill", "Keep this view in the preset", "Show the borders of the tiles"] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    press(&mut harness, egui::Modifiers::SHIFT, egui::Key::Questionmark);
    harness.run_steps(20);
    assert!(harness.query_by_label("Walk; slower uphill").is_none());
}

#[test]
fn what_lies_under_the_pointer_is_told_without_holding_up_the_picture() {
    let mut harness = plain_editor(vec![]);
    let rect = canvas(&harness);
    let under = app::point_at_planet(&mut harness).location;
    let below = harness.state().viewport().eye(&planet(&harness)).1;
    assert!(under.direction().distance(below.direction()) < 0.02, "{under:?} {below:?}");
    harness.hover_at(egui::pos2(rect.center().x, rect.bottom() + 10.0));
    harness.run_steps(3);
    assert!(harness.state().viewport().under_pointer().is_none());
}

/// Clicks an entry of the menu that is open; the name of an entry ends with its shortcut.
fn choose(harness: &mut Editor, entry: &str) {
    let named =
        |node: &egui_kittest::Node<'_>| node.accesskit_node().label().is_some_and(|name| name.starts_with(entry));
    let found = harness.query_all_by_role(Role::Button).rfind(named);
    found.unwrap().click();
    harness.run_steps(3);
}

#[test]
fn the_overlay_tells_how_one_looks_and_changes_it() {
    let mut harness = editor(vec![]);
    app::until(&mut harness, "tiles", |harness| harness.state().viewport().metres_per_point().is_some());
    harness.check_accessibility();
    click(&mut harness, "View: Shaded");
    choose(&mut harness, "Slope");
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Slope);
    assert!(harness.query_by_label("View: Slope").is_some());
    click(&mut harness, "Camera mode: Orbit");
    choose(&mut harness, "Fly");
    assert_eq!(harness.state().viewport().cameras().mode(), Mode::Fly);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F5);
    assert!(harness.query_by_label("View: Slope").is_none(), "it can be hidden");
}

#[test]
fn every_view_with_values_has_a_legend() {
    let mut harness = editor(vec![]);
    app::until(&mut harness, "tiles", |harness| harness.state().viewport().surface().is_some());
    let surface = harness.state().viewport().surface().unwrap();
    let without: Vec<DebugView> =
        DebugView::ALL.into_iter().filter(|view| Legend::of(*view, &surface).is_none()).collect();
    let known = [
        DebugView::Shaded,
        DebugView::Normal,
        DebugView::Coverage,
        DebugView::Albedo,
        DebugView::Plates,
        DebugView::Rivers,
        // The legend of a density names a population.
        DebugView::Density,
    ];
    assert_eq!(without, known);
}
