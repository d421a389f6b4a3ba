//! The text of the preset in its window.

use super::*;

const TEXT: &str = "Text of the preset";

fn shown(harness: &Editor) -> String {
    harness.get_by_role_and_label(Role::MultilineTextInput, TEXT).accesskit_node().value().unwrap_or_default()
}

/// Replaces the whole text.
fn write(harness: &mut Editor, text: &str) {
    harness.get_by_role_and_label(Role::MultilineTextInput, TEXT).focus();
    harness.run_steps(2);
    press(harness, egui::Modifiers::COMMAND, egui::Key::A);
    harness.event(egui::Event::Paste(text.to_owned()));
    harness.run_steps(3);
}

#[test]
fn the_text_follows_the_planet_and_the_planet_the_text() {
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::T);
    assert_eq!(shown(&harness), before.to_text());
    harness.check_accessibility();
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    assert!(shown(&harness).contains("radius_km: 2500.0"));

    let wanted = Planet { radius_km: 3000.0, ..planet(&harness) };
    write(&mut harness, &wanted.to_text());
    assert_eq!(planet(&harness).radius_km, 2500.0, "nothing happens while one types");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Enter);
    assert_eq!(planet(&harness), wanted);
    assert_eq!(undo_label(&harness), "Edit text");
    send(&mut harness, Command::Undo);
    assert!(shown(&harness).contains("radius_km: 2500.0"));
}

#[test]
fn what_is_wrong_with_the_text_is_told_and_nothing_is_lost() {
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    send(&mut harness, Command::Text);
    write(&mut harness, "(\n    version: 3,\n    radius_km: -4.0,\n)\n");
    assert!(harness.query_by_label_contains("3:16: radius_km: -4 is out of range").is_some());
    assert!(harness.query_by_label("1 problem").is_some());
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Enter);
    assert_eq!(planet(&harness), before);
    click(&mut harness, "Discard");
    assert_eq!(shown(&harness), before.to_text());
    write(&mut harness, "a shopping list");
    assert!(harness.query_by_label_contains("1:1").is_some());
}
