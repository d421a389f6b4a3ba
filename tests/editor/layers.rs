//! Several layers at once, layers alone, and what a layer does on the planet.

use crate::app::{self, Editor, click, planet, send, undo_label, until};
use eframe::egui;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::editor::viewport::layer_view::LayerQuantity;

fn open() -> Editor {
    app::open([1280.0, 800.0], vec![])
}

fn names(harness: &Editor) -> Vec<String> {
    planet(harness).layers.iter().map(|layer| layer.name.clone()).collect()
}

/// Clicks the row of a layer with keys held.
fn click_row(harness: &mut Editor, name: &str, modifiers: egui::Modifiers) {
    let label = format!("Layer {name}");
    harness.get_by_label(&label).click_modifiers(modifiers);
    harness.run_steps(3);
}

#[test]
fn several_layers_are_removed_duplicated_and_turned_off_in_one_step() {
    let mut harness = open();
    let before = names(&harness);
    assert!(before.len() >= 4);
    click_row(&mut harness, &before[0], egui::Modifiers::NONE);
    click_row(&mut harness, &before[2], egui::Modifiers::COMMAND);
    click(&mut harness, "Duplicate layer");
    assert_eq!(names(&harness).len(), before.len() + 2);
    assert_eq!(undo_label(&harness), "Duplicate 2 layers");
    send(&mut harness, Command::Undo);
    assert_eq!(names(&harness), before);

    click_row(&mut harness, &before[1], egui::Modifiers::NONE);
    click_row(&mut harness, &before[3], egui::Modifiers::SHIFT);
    click(&mut harness, &format!("Enabled of {}", before[2]));
    let enabled: Vec<bool> = planet(&harness).layers.iter().map(|layer| layer.enabled).collect();
    assert!(enabled[1..4].iter().all(|on| *on == enabled[1]), "{enabled:?}");
    assert!(undo_label(&harness).ends_with("3 layers"), "{}", undo_label(&harness));
    click(&mut harness, "Remove layer");
    let expected: Vec<_> =
        before.iter().enumerate().filter(|(i, _)| !(1..4).contains(i)).map(|(_, n)| n.clone()).collect();
    assert_eq!((names(&harness), undo_label(&harness)), (expected, "Remove 3 layers".to_owned()));
}

#[test]
fn several_layers_move_together_and_stop_at_the_end() {
    let mut harness = open();
    let before = names(&harness);
    click_row(&mut harness, &before[1], egui::Modifiers::NONE);
    click_row(&mut harness, &before[2], egui::Modifiers::COMMAND);
    click(&mut harness, "Move layer up");
    let mut expected = before.clone();
    expected[0..3].rotate_left(1);
    assert_eq!(names(&harness), expected);
    assert!(app::is_disabled(&harness, "Move layer up"));
}

#[test]
fn a_layer_alone_is_seen_and_the_planet_stays() {
    let mut harness = open();
    let before = planet(&harness);
    let name = before.layers[1].name.clone();
    click_row(&mut harness, &name, egui::Modifiers::NONE);
    click(&mut harness, "Solo");
    until(&mut harness, "the layer alone", |harness| {
        harness.state().viewport().surface().is_some_and(|surface| {
            surface
                .terrain
                .planet()
                .layers
                .iter()
                .map(|layer| layer.enabled)
                .eq((0..before.layers.len()).map(|i| i == 1))
        })
    });
    assert_eq!(planet(&harness), before);
    click(&mut harness, "Planet");
    until(&mut harness, "all layers, with another tab open", |harness| {
        harness.state().viewport().surface().is_some_and(|surface| surface.terrain.planet().layers == before.layers)
    });
}

#[test]
fn an_overlay_shows_the_effect_of_the_selected_layer_with_a_legend() {
    let mut harness = open();
    click(&mut harness, "Effect");
    until(&mut harness, "the overlay", |harness| harness.state().viewport().layer_view().legend().is_some());
    assert_eq!(harness.state().viewport().layer_view().quantity(), Some(LayerQuantity::Change));
    click(&mut harness, "Mask");
    until(&mut harness, "the mask", |harness| {
        harness.state().viewport().layer_view().quantity() == Some(LayerQuantity::Mask)
    });
    click(&mut harness, "Mask");
    assert!(harness.state().viewport().layer_view().legend().is_none(), "gone at once");
}
