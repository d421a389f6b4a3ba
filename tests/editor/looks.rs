//! Golden pictures of windows in the smallest window of the editor, dark and light, drawn by Mesa's software driver and
//! made again with `UPDATE_SNAPSHOTS=1`. There is no planet: other tests compare that.

use crate::app::{self, Editor, send};
use eframe::egui;
use tellus::editor::command::{Action, Command, SystemAction};

/// Small differences of drivers: how far a pixel may be off, and how many may be farther.
const THRESHOLD: f32 = 1.0;
const MOST_PIXELS: usize = 200;

fn is_same(harness: &mut Editor, name: &str) {
    // The scale bar needs the ground, which another thread builds.
    app::until(harness, "the scale bar", |harness| harness.state().viewport().metres_per_point().is_some());
    let options = egui_kittest::SnapshotOptions::new().threshold(THRESHOLD).max_failed_pixels(MOST_PIXELS);
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        harness.ctx.set_theme(theme);
        harness.run_steps(3);
        let picture = harness.render().unwrap();
        // Without the status bar below, which tells times.
        let height = picture.height() * 94 / 100;
        let picture = image::imageops::crop_imm(&picture, 0, 0, picture.width(), height).to_image();
        let file = format!("{name}_{}", if theme == egui::Theme::Dark { "dark" } else { "light" });
        egui_kittest::image_snapshot_options(&picture, file, &options);
    }
}

/// A window that a command opens.
fn looks_as_it_did(command: Command, name: &str) {
    let mut harness = app::open_without_planet([800.0, 500.0]);
    send(&mut harness, command);
    harness.run_steps(10);
    is_same(&mut harness, name);
}

#[test]
fn the_finder() {
    looks_as_it_did(Command::Finder, "finder");
}

#[test]
fn the_controls() {
    looks_as_it_did(Command::Controls, "controls");
}

#[test]
fn photographs() {
    looks_as_it_did(Command::Photo, "photo");
}

#[test]
fn the_text() {
    looks_as_it_did(Command::Text, "text");
}

#[test]
fn the_library() {
    looks_as_it_did(Command::Library, "library");
}

#[test]
fn the_variations() {
    looks_as_it_did(Command::Variations, "variations");
}

#[test]
fn a_system() {
    let mut harness = app::open_without_planet([800.0, 500.0]);
    harness.state_mut().push(Action::System(SystemAction::Open(0)));
    // The presets are read on another thread, and the camera flies to the first planet.
    app::until(&mut harness, "the first planet", |harness| app::planet(harness).name == "Maren");
    harness.run_steps(240);
    is_same(&mut harness, "system");
}

#[test]
fn the_tour() {
    looks_as_it_did(Command::Tour, "tour");
}

#[test]
fn a_curve_with_the_numbers_behind_it_and_the_history() {
    let mut harness = app::open_without_planet([800.0, 500.0]);
    let mut planet = app::planet(&harness);
    planet.layers[0].curve = vec![[-1.0, -0.6], [0.0, 0.1], [1.0, 0.9]];
    let text = planet.to_text();
    harness.state_mut().push(Action::Clip(tellus::editor::command::ClipAction::TakeText(text)));
    harness.run_steps(3);
    send(&mut harness, Command::History);
    let name = format!("Layer {}", planet.layers[0].name);
    app::click(&mut harness, &name);
    let curve = format!("Curve of {}", planet.layers[0].name);
    app::scroll_to(&mut harness, &curve);
    app::until(&mut harness, "the numbers behind the curve", |harness| harness.state().curve_inputs().is_some());
    harness.run_steps(3);
    is_same(&mut harness, "curve");
}
