//! Tabs that are moved to other docks and into windows.

use crate::app::{self, Editor, canvas, click, drag, send};
use eframe::egui::{self, accesskit::Role};
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Action;
use tellus::editor::command::{Command, PanelAction};

const SIZE: [f32; 2] = [1280.0, 800.0];

fn tab(harness: &Editor, name: &str) -> egui::Rect {
    harness.get_by_role_and_label(Role::Button, name).rect()
}

fn has_slider(harness: &Editor, label: &str) -> bool {
    harness.query_by_role_and_label(Role::Slider, label).is_some()
}

/// Drags the name of a tab to a place.
fn drag_tab(harness: &mut Editor, name: &str, to: egui::Pos2) {
    let from = tab(harness, name).center();
    drag(harness, from, to);
    harness.run_steps(5);
}

#[test]
fn a_tab_dragged_to_the_other_side_of_the_picture_docks_there() {
    let mut harness = app::open(SIZE, vec![]);
    let before = canvas(&harness);
    drag_tab(&mut harness, "Water", before.left_center() + egui::vec2(20.0, 0.0));
    let after = canvas(&harness);
    assert!(after.left() > 300.0 && after.right() == before.right(), "{after:?}");
    assert!(tab(&harness, "Water").right() < after.left());
    assert!(has_slider(&harness, "Sea level of water"), "the tab is open there");
    assert!(harness.query_by_label("Add layer").is_some(), "and the terrain still at the right");
    send(&mut harness, Command::ResetLayout);
    assert_eq!(canvas(&harness), before);
}

#[test]
fn the_side_panel_splits_and_each_half_has_a_filter() {
    let mut harness = app::open(SIZE, vec![]);
    let right = harness.ctx.content_rect().right();
    drag_tab(&mut harness, "Star", egui::pos2(right - 100.0, 700.0));
    assert!(tab(&harness, "Star").top() > tab(&harness, "Planet").bottom() + 100.0);
    assert!(has_slider(&harness, "Brightness of star") && harness.query_by_label("Add layer").is_some());
    click(&mut harness, "Planet");
    assert!(has_slider(&harness, "Radius of planet") && has_slider(&harness, "Brightness of star"));
    harness.get_by_label("Filter of Star").focus();
    harness.run_steps(2);
    app::type_text(&mut harness, "bright");
    assert!(has_slider(&harness, "Brightness of star") && !has_slider(&harness, "Latitude of star"));
    assert!(has_slider(&harness, "Radius of planet"), "the other half is not filtered");
}

#[test]
fn a_tab_in_a_window_edits_and_closing_the_window_docks_it() {
    let mut harness = app::open(SIZE, vec![]);
    let picture = canvas(&harness);
    drag_tab(&mut harness, "Star", picture.center());
    assert_eq!(canvas(&harness), picture, "the window lies over the picture");
    assert!(harness.query_by_role_and_label(Role::Button, "Star").is_none(), "no tab of the panel");
    harness.get_by_role_and_label(Role::Slider, "Brightness of star").set_value_accesskit(2.0);
    harness.run_steps(4);
    assert_eq!(app::planet(&harness).star.brightness, 2.0);
    assert_eq!(app::undo_label(&harness), "Change brightness of star");
    click(&mut harness, "Close window");
    harness.run_steps(30);
    assert!(tab(&harness, "Star").left() > picture.right());
}

#[test]
fn a_searched_parameter_opens_its_tab_where_the_tab_stands() {
    let mut harness = app::open(SIZE, vec![]);
    let picture = canvas(&harness);
    drag_tab(&mut harness, "Clouds", picture.left_center() + egui::vec2(20.0, 0.0));
    let dock = canvas(&harness).left_center() - egui::vec2(60.0, 0.0);
    drag_tab(&mut harness, "Star", dock);
    assert!(has_slider(&harness, "Brightness of star") && !has_slider(&harness, "Low cover of clouds"));
    let path = tellus::planet::param::ParamPath::default().join("clouds").join("coverage");
    harness.state_mut().push(Action::Panel(PanelAction::Reveal { path, name: "coverage" }));
    harness.run_steps(6);
    assert!(has_slider(&harness, "Low cover of clouds") && !has_slider(&harness, "Brightness of star"));
}

#[test]
fn in_the_smallest_window_both_sides_leave_some_picture() {
    let mut harness = app::open([800.0, 500.0], vec![]);
    let picture = canvas(&harness);
    drag_tab(&mut harness, "Star", picture.left_center() + egui::vec2(10.0, 0.0));
    let picture = canvas(&harness);
    assert!(picture.width() > 100.0, "{picture:?}");
    assert!(has_slider(&harness, "Brightness of star"));
}
