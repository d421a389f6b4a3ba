//! The finder.

use super::*;
use tellus::editor::commands::COMMANDS;

fn is_open(harness: &Editor) -> bool {
    harness.query_by_role_and_label(Role::TextInput, "Find anything").is_some()
}

/// Opens the finder and types.
fn find(harness: &mut Editor, text: &str) {
    press(harness, egui::Modifiers::COMMAND, egui::Key::K);
    type_text(harness, text);
}

fn enter(harness: &mut Editor) {
    press(harness, egui::Modifiers::NONE, egui::Key::Enter);
}

#[test]
fn the_finder_opens_and_closes_by_keys_and_by_the_mouse() {
    let mut harness = editor(vec![]);
    for key in [egui::Key::K, egui::Key::P] {
        press(&mut harness, egui::Modifiers::COMMAND, key);
        assert!(is_open(&harness), "{key:?}");
        harness.check_accessibility();
        press(&mut harness, egui::Modifiers::COMMAND, key);
        assert!(!is_open(&harness), "{key:?}");
    }
    find(&mut harness, "x");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(!is_open(&harness));
    find(&mut harness, "");
    let beside = canvas(&harness).left_bottom() + egui::vec2(20.0, -20.0);
    harness.drag_at(beside);
    harness.drop_at(beside);
    harness.run_steps(3);
    assert!(!is_open(&harness));
    click(&mut harness, "Edit");
    harness.get_by_label_contains("Find anything…").click();
    harness.run_steps(3);
    assert!(is_open(&harness));
}

#[test]
fn every_command_is_found_by_its_name() {
    let mut harness = editor(vec![]);
    find(&mut harness, "");
    for row in COMMANDS.iter().filter(|row| !matches!(row.command, Command::Finder | Command::GoTo(_))) {
        press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
        type_text(&mut harness, row.label);
        let place = row.menu.map_or("Commands", |(menu, _)| menu.label());
        assert_eq!(chosen(&harness), format!("{place} › {}", row.label));
    }
}

#[test]
fn a_command_is_carried_out_unless_it_is_disabled() {
    let mut harness = editor(vec![]);
    find(&mut harness, "undo");
    assert_eq!(chosen(&harness), "Edit › Undo");
    enter(&mut harness);
    harness.get_by_label("Edit › Undo").click();
    harness.run_steps(3);
    assert!(is_open(&harness), "there is nothing to undo");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
    type_text(&mut harness, "perf");
    enter(&mut harness);
    assert!(!is_open(&harness));
    assert!(harness.query_by_label_contains("times of the next edit").is_some());
}

#[test]
fn planets_and_bookmarks_are_found() {
    let mut harness = editor(vec![]);
    send(&mut harness, Command::AddBookmark);
    find(&mut harness, "view 1");
    assert_eq!(chosen(&harness), "Bookmarks › View 1");
    escape(&mut harness);
    send(&mut harness, Command::Undo);
    find(&mut harness, "maren");
    assert_eq!(chosen(&harness), "Planets › Maren");
    harness.get_by_label("Planets › Maren").click();
    harness.run_steps(4);
    assert_eq!(planet(&harness).name, "Maren");
}

#[test]
fn a_parameter_is_found_shown_and_highlighted() {
    let mut harness = editor(vec![]);
    let name = planet(&harness).layers.last().unwrap().name.clone();
    click(&mut harness, "Star");
    find(&mut harness, &format!("amp {name}"));
    assert_eq!(chosen(&harness), format!("Terrain › {name} › Amplitude"));
    enter(&mut harness);
    harness.run_steps(30);
    let slider = harness.get_by_role_and_label(Role::Slider, &format!("Amplitude of {name}")).rect();
    let row = harness.state().revealed().unwrap();
    assert!(row.contains(slider.center()), "{row:?} {slider:?}");
    type_text(&mut harness, "1234");
    enter(&mut harness);
    assert_eq!(planet(&harness).layers.last().unwrap().amplitude_m, 1234.0, "one can type its value at once");
    harness.run_steps(90);
    assert_eq!(harness.state().revealed(), None, "the highlight has faded");
    send(&mut harness, Command::TogglePanel);
    find(&mut harness, "axial");
    enter(&mut harness);
    harness.run_steps(5);
    assert!(harness.query_by_role_and_label(Role::Slider, "Axial tilt of star").is_some(), "the panel comes back");
}

#[test]
fn keys_move_the_cursor_and_the_text_keeps_the_focus() {
    let mut harness = editor(vec![]);
    find(&mut harness, "");
    let first = chosen(&harness);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::ArrowDown);
    let second = chosen(&harness);
    assert_ne!(second, first);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::PageDown);
    assert!(![&first, &second].contains(&&chosen(&harness)));
    press(&mut harness, egui::Modifiers::NONE, egui::Key::PageUp);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::ArrowUp);
    assert_eq!(chosen(&harness), first);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::ArrowUp);
    assert_ne!(chosen(&harness), first, "around the end");
    type_text(&mut harness, "full");
    assert_eq!(chosen(&harness), "View › Full screen");
}

#[test]
fn what_was_used_last_comes_first() {
    let mut harness = editor(vec![]);
    for text in ["perf", "controls"] {
        find(&mut harness, text);
        enter(&mut harness);
    }
    find(&mut harness, "");
    assert_eq!(chosen(&harness), "Help › Controls");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::ArrowDown);
    assert_eq!(chosen(&harness), "View › Performance");
}

#[test]
fn no_key_gets_past_the_finder() {
    let mut harness = editor(vec![]);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F3);
    harness.run_steps(60);
    let before = pose(&harness);
    find(&mut harness, "");
    let keys = [egui::Key::D, egui::Key::W, egui::Key::E, egui::Key::ArrowLeft, egui::Key::PageDown, egui::Key::Num2];
    for key in keys {
        harness.key_down(key);
        harness.run_steps(5);
        harness.key_up(key);
    }
    harness.run_steps(2);
    assert!(is_open(&harness));
    escape(&mut harness);
    assert_eq!(pose(&harness), before);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Shaded);
    harness.key_down(egui::Key::W);
    harness.run_steps(5);
    harness.key_up(egui::Key::W);
    assert_ne!(pose(&harness), before, "the keys are the camera's again");
}

#[test]
fn the_finder_is_on_top_of_windows_for_escape() {
    let mut harness = editor(vec![]);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F8);
    find(&mut harness, "");
    let performance = |harness: &Editor| harness.query_by_label_contains("times of the next edit").is_some();
    escape(&mut harness);
    assert!(!is_open(&harness) && performance(&harness));
    escape(&mut harness);
    assert!(!performance(&harness));
}

#[test]
fn the_finder_fits_the_smallest_window() {
    let mut harness = app::open([800.0, 500.0], vec![]);
    find(&mut harness, "");
    let rows = || harness.query_all_by_role(Role::ListBoxOption);
    assert!(rows().count() >= 10);
    let field = harness.get_by_role_and_label(Role::TextInput, "Find anything").rect();
    assert!(field.left() > 0.0 && field.right() < 800.0, "{field:?}");
}

#[test]
fn every_sign_of_the_finder_is_in_the_fonts() {
    let harness = editor(vec![]);
    assert!(harness.ctx.fonts_mut(|fonts| fonts.has_glyphs(&egui::FontId::default(), "›…°“”")));
}

#[test]
fn a_number_behind_a_name_is_set_in_one_step() {
    let mut harness = editor(vec![]);
    let before = planet(&harness).radius_km;
    find(&mut harness, "radius *2");
    assert!(chosen(&harness).starts_with("Planet › Set radius to "), "{}", chosen(&harness));
    enter(&mut harness);
    assert_eq!(planet(&harness).radius_km, 2.0 * before);
    assert_eq!(undo_label(&harness), "Change radius");
    assert!(harness.query_by_label_contains("Radius: ").is_some(), "it is said");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(planet(&harness).radius_km, before);
}
