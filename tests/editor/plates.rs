//! Plates of the structure, changed by hand on the planet and in the panel.

use super::app::{canvas, click, planet, undo_label, undo_len, until};
use super::{app, slide};
use eframe::egui;
use egui_kittest::kittest::Queryable;
use tellus::planet::{Planet, PlateByHand, Structure, Water};

/// A planet that is quick to solve.
fn small() -> Planet {
    let structure = Some(Structure { grids: 1, ..Structure::default() });
    Planet { structure, water: Some(Water::default()), ..Planet::default() }
}

fn by_hand(harness: &app::Editor) -> Vec<PlateByHand> {
    planet(harness).structure.unwrap().plates.by_hand
}

#[test]
fn a_plate_is_chosen_by_a_click_moved_by_a_drag_and_changed_in_the_panel() {
    let mut harness = app::open_planet_with_picture([1024.0, 640.0], small());
    app::wait_for_picture(&mut harness);
    click(&mut harness, "Structure");
    let middle = canvas(&harness).center();
    harness.hover_at(middle);
    harness.run_steps(2);
    harness.drag_at(middle);
    harness.run_steps(1);
    harness.drop_at(middle);
    until(&mut harness, "a chosen plate", |harness| {
        harness.query_all_by_label_contains("Heading of plate").next().is_some()
    });
    assert!(by_hand(&harness).is_empty() && undo_len(&harness) == 0, "a choice is no edit");

    // With Ctrl the plate follows the pointer; without it the planet turns.
    let to = middle + egui::vec2(60.0, -20.0);
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::COMMAND));
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::COMMAND,
    };
    let eye = harness.state().viewport().eye(&planet(&harness)).1;
    harness.event(button(middle, true));
    harness.run_steps(2);
    for share in [0.3, 0.7, 1.0] {
        harness.event(egui::Event::PointerMoved(middle + (to - middle) * share));
        harness.run_steps(2);
    }
    harness.event(button(to, false));
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::NONE));
    harness.run_steps(3);
    assert_eq!((undo_label(&harness).as_str(), undo_len(&harness)), ("Move plate", 1));
    assert_eq!(harness.state().viewport().eye(&planet(&harness)).1, eye, "the planet does not turn");
    let moved = by_hand(&harness);
    assert_eq!(moved.len(), 1);
    app::wait_for_picture(&mut harness);

    // In the panel: another motion, then back to the layout.
    let name = format!("plate {}", moved[0].plate);
    slide(&mut harness, &format!("Drift of {name}"), 200.0);
    assert_eq!(undo_label(&harness), format!("Change {name}"));
    assert_eq!(by_hand(&harness), [PlateByHand { drift_mm_yr: 200.0, ..moved[0].clone() }]);
    let lay_out = format!("Lay out Plate {}", moved[0].plate);
    app::scroll_to(&mut harness, &lay_out);
    click(&mut harness, &lay_out);
    assert!(by_hand(&harness).is_empty());
    assert_eq!(undo_label(&harness), format!("Lay out {name}"));
}
