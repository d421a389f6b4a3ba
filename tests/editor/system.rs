//! Systems: opening one, going from body to body, the time.

use crate::app::{self, Editor, click, planet, send, until};
use egui_kittest::kittest::Queryable;
use tellus::editor::command::{Action, Command, SystemAction};
use tellus::editor::files::dialogs::ScriptedDialogs;
use tellus::planet::shipped;

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
    harness.state_mut().push(Action::System(SystemAction::Visit(3)));
    harness.run_steps(6);
    assert_eq!(planet(&harness).name, "Pallor");
    click(&mut harness, "+1");
    let time_secs = harness.state().viewport().settings.time_secs;
    assert!((time_secs - 86_400.0).abs() < 1e-6, "{time_secs}");
    // Unsaved work is asked for before another body.
    harness.state_mut().send(Command::RandomPlanet);
    harness.run_steps(6);
    harness.state_mut().push(Action::System(SystemAction::Visit(2)));
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
