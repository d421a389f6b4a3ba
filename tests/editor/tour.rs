//! The tour: its steps, what they offer, and ways to leave it.

use crate::app::{self, click, send};
use crate::escape;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;

#[test]
fn the_tour_goes_through_its_steps_and_ends() {
    let mut harness = app::open([1024.0, 640.0], vec![]);
    assert!(harness.query_by_label("1 of 6").is_none(), "it begins by itself in the first start alone");
    send(&mut harness, Command::Tour);
    for step in 1..6 {
        assert!(harness.query_by_label(&format!("{step} of 6")).is_some());
        click(&mut harness, "Next");
    }
    click(&mut harness, "Back");
    assert!(harness.query_by_label("5 of 6").is_some());
    click(&mut harness, "Next");
    click(&mut harness, "Done");
    assert!(harness.query_by_label("6 of 6").is_none());
}

#[test]
fn a_step_offers_its_commands_and_the_tour_is_left_at_any_time() {
    let mut harness = app::open([800.0, 500.0], vec![]);
    send(&mut harness, Command::Tour);
    for _ in 0..3 {
        click(&mut harness, "Next");
    }
    click(&mut harness, "Open the finder");
    harness.run_steps(3);
    assert!(harness.query_by_label("Find anything").is_some());
    escape(&mut harness);
    assert!(harness.query_by_label("4 of 6").is_some(), "Escape closes the finder first");
    click(&mut harness, "Leave the tour");
    assert!(harness.query_by_label("4 of 6").is_none());
    send(&mut harness, Command::Tour);
    escape(&mut harness);
    assert!(harness.query_by_label("1 of 6").is_none());
}
