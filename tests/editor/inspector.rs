//! The inspector: what is known of the place under the pointer, and of a place that is held while one edits.

use crate::app::{self, Editor, canvas, planet, point_at_planet, send};
use crate::press;
use eframe::egui;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;
use tellus::clouds::CloudField;
use tellus::editor::command::Command;
use tellus::editor::viewport::pointer::KnownPlace;
use tellus::terrain::Terrain;

fn inspected(harness: &Editor) -> Option<KnownPlace> {
    harness.state().viewport().inspector.place().cloned()
}

/// An editor whose inspector is open, beside the middle of the picture that it shows.
fn inspecting() -> Editor {
    let mut harness = app::open([1400.0, 800.0], vec![]);
    assert!(inspected(&harness).is_none());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::I);
    assert!(harness.query_by_label_contains("Point at the planet").is_some());
    point_at_planet(&mut harness);
    app::until(&mut harness, "clouds", |harness| inspected(harness).is_some_and(|place| place.cover.is_some()));
    harness.run_steps(3);
    harness
}

#[test]
fn a_place_is_told_as_the_evaluator_knows_it() {
    let mut harness = inspecting();
    let place = inspected(&harness).unwrap();
    let terrain = Terrain::try_new(Arc::new(planet(&harness))).unwrap();
    let dir = place.location.direction();
    let time_secs = harness.state().viewport().settings.time_secs;
    let cover = CloudField::new(&terrain).cover(dir, time_secs);
    assert!((place.cover.unwrap().low - cover.low).abs() < 1e-6);
    assert!((place.sample.height_m - terrain.height_m(dir)).abs() < 0.01);
    let told = |harness: &Editor, text: &str| harness.query_all_by_label_contains(text).next().is_some();
    for text in ["Height", "Slope", "Temperature", "Rain and snow", "Clouds", place.biome.as_str()] {
        assert!(told(&harness, text), "{text}");
    }
    for layer in planet(&harness).layers.iter().filter(|layer| layer.enabled) {
        assert!(told(&harness, &layer.name), "{}", layer.name);
    }
    // The pointer leaves: the last place stays, until the window closes.
    harness.hover_at(canvas(&harness).right_bottom() + egui::vec2(40.0, 0.0));
    harness.run_steps(3);
    assert_eq!(inspected(&harness).map(|place| place.location), Some(place.location));
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(inspected(&harness).is_none());
}

#[test]
fn a_held_place_stays_and_follows_edits() {
    let mut harness = inspecting();
    let before = inspected(&harness).unwrap();
    press(&mut harness, egui::Modifiers::SHIFT, egui::Key::I);
    assert!(harness.state().viewport().inspector.is_held());
    harness.hover_at(canvas(&harness).center() + egui::vec2(60.0, 40.0));
    harness.run_steps(20);
    let close = |place: &KnownPlace| place.location.direction().distance(before.location.direction()) < 1e-12;
    assert!(inspected(&harness).is_some_and(|place| close(&place)));
    let index = before.layers_m.iter().position(|change_m| change_m.abs() > 1.0).unwrap();
    let mut changed = planet(&harness);
    changed.layers[index].enabled = false;
    let text = changed.to_text();
    harness
        .state_mut()
        .push(tellus::editor::command::Action::Clip(tellus::editor::command::ClipAction::TakeText(text)));
    app::until(&mut harness, "the edit", |harness| {
        inspected(harness).is_some_and(|place| close(&place) && place.layers_m[index] == 0.0)
    });
    send(&mut harness, Command::HoldPlace);
    assert!(!harness.state().viewport().inspector.is_held());
}
