//! The flight to a latitude and longitude.

use super::*;

fn field(harness: &Editor) -> bool {
    harness.query_by_role_and_label(Role::TextInput, FIELD).is_some()
}

const FIELD: &str = "Latitude, longitude, and the altitude if you like";

/// Steps until the camera is at rest. Gives latitude, longitude and altitude of the eye.
fn arrived(harness: &mut Editor) -> (f64, f64, f64) {
    app::until(harness, "the camera is at rest", |harness| !harness.state().viewport().is_moving());
    let (altitude_m, location) = harness.state().viewport().eye(harness.state().document().valid_planet());
    let (lat_deg, lon_deg) = location.to_degrees();
    (lat_deg, lon_deg, altitude_m)
}

fn assert_near((lat_deg, lon_deg, altitude_m): (f64, f64, f64), (lat, lon, altitude): (f64, f64, f64)) {
    assert!((lat_deg - lat).abs() < 1e-3 && (lon_deg - lon).abs() < 1e-3, "{lat_deg} {lon_deg}");
    assert!((altitude_m / altitude - 1.0).abs() < 1e-3, "{altitude_m}");
}

#[test]
fn a_typed_location_is_flown_to() {
    let mut harness = editor(vec![]);
    let (.., altitude_m) = arrived(&mut harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::G);
    assert!(field(&harness));
    harness.check_accessibility();
    type_text(&mut harness, "12.5 N 45 W");
    assert!(harness.query_by_label("12.5°N 45°W").is_some(), "it is told how the text is read");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    harness.run_steps(20);
    assert!(!field(&harness));
    assert_near(arrived(&mut harness), (12.5, -45.0, altitude_m));
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::G);
    type_text(&mut harness, "-30, 100 @ 400 km");
    click(&mut harness, "Go");
    assert_near(arrived(&mut harness), (-30.0, 100.0, 400_000.0));
}

#[test]
fn a_bad_location_is_explained_and_escape_closes_the_window() {
    let mut harness = editor(vec![]);
    let before = pose(&harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::G);
    type_text(&mut harness, "95 N 0 E");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    assert!(field(&harness) && harness.query_by_label_contains("beyond a pole").is_some());
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
    type_text(&mut harness, "wasd");
    assert!(harness.query_by_label_contains("is no direction").is_some());
    assert_eq!(pose(&harness), before);
    escape(&mut harness);
    assert!(!field(&harness), "though a field had the focus");
}

#[test]
fn the_finder_takes_a_location_too() {
    let mut harness = editor(vec![]);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::K);
    type_text(&mut harness, "12°30'N 45°W @ 900 km");
    assert!(harness.query_by_label("Camera › Go to 12.5°N 45°W at 900 km").is_some());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    assert_near(arrived(&mut harness), (12.5, -45.0, 900_000.0));
}
