//! Several views of the planet: their cameras, tools and maps.

use super::app::until;
use super::*;
use tellus::editor::viewport::panes::{PaneLayout, Shows};
use tellus::render::DebugView;

/// An editor with these panes. Its active pane shows the LOD levels, which are drawn fast.
fn with_views(layout: PaneLayout) -> Editor {
    let mut harness = app::open_at_rate([1400.0, 800.0], vec![], 8.0);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Num8);
    app::send(&mut harness, Command::Panes(layout));
    wait_for_picture(&mut harness);
    harness
}

fn rect(harness: &Editor, place: usize) -> egui::Rect {
    harness.state().viewport().pane(place).unwrap().0
}

fn eye_m(harness: &Editor, place: usize) -> glam::DVec3 {
    harness.state().viewport().pane(place).unwrap().1.unwrap().position_planet_m
}

fn shows(harness: &Editor) -> Vec<Shows> {
    (0..).map_while(|place| harness.state().viewport().shows(place)).collect()
}

#[test]
fn four_views_show_the_planet_and_a_map_and_one_view_has_all_the_room_again() {
    let mut harness = with_views(PaneLayout::One);
    let all = canvas(&harness);
    app::send(&mut harness, Command::Panes(PaneLayout::Four));
    wait_for_picture(&mut harness);
    let labels: Vec<&str> = shows(&harness).into_iter().map(Shows::label).collect();
    assert_eq!(labels, ["Level", "Height", "Biome", "Map"]);
    assert!((0..4).all(|place| all.expand(1.0).contains_rect(rect(&harness, place))));
    assert!((rect(&harness, 0).width() - 0.5 * all.width()).abs() < 3.0);
    click(&mut harness, "View 2 shows: Height");
    click(&mut harness, "Slope");
    assert_eq!(harness.state().viewport().shows(1), Some(Shows::Planet(DebugView::Slope)));
    app::send(&mut harness, Command::Panes(PaneLayout::One));
    wait_for_picture(&mut harness);
    assert_eq!((shows(&harness).len(), canvas(&harness)), (1, all));
}

#[test]
fn a_press_gives_a_view_the_tools_and_linked_views_share_a_camera() {
    let mut harness = with_views(PaneLayout::Four);
    let before_m = eye_m(&harness, 0);
    assert_eq!(eye_m(&harness, 2), before_m);
    let from = rect(&harness, 1).center();
    app::drag(&mut harness, from, from + egui::vec2(60.0, 10.0));
    let viewport = harness.state().viewport();
    assert_eq!((viewport.active_pane(), viewport.settings.debug_view), (1, DebugView::Height));
    assert_eq!(shows(&harness)[0], Shows::Planet(DebugView::Lod), "the first view shows what it showed");
    harness.run_steps(4);
    assert_ne!(eye_m(&harness, 1), before_m);
    assert_eq!(eye_m(&harness, 0), eye_m(&harness, 1));

    // A view that is not linked stays.
    click(&mut harness, "View 3 linked");
    let stays_m = eye_m(&harness, 2);
    app::drag(&mut harness, from, from - egui::vec2(80.0, 0.0));
    harness.run_steps(4);
    assert_eq!(eye_m(&harness, 2), stays_m);
    assert_ne!(eye_m(&harness, 1), stays_m);
    assert_eq!(eye_m(&harness, 0), eye_m(&harness, 1));
}

#[test]
fn tools_work_in_every_view_of_the_planet() {
    let mut harness = with_views(PaneLayout::Four);
    app::send(&mut harness, Command::TakeTool(0));
    for place in [2, 0, 1] {
        let from = rect(&harness, place).center();
        let edits = planet(&harness).edits.len();
        app::drag(&mut harness, from, from + egui::vec2(20.0, 15.0));
        assert_eq!(harness.state().viewport().active_pane(), place);
        let edits = (edits, planet(&harness).edits.len());
        assert_eq!(edits.1, edits.0 + 1, "view {place}");
        // The stroke begins in the middle of the view: under the eye, for an eye that looks down.
        let begun = planet(&harness).edits.get(edits.0).unwrap().points.0[0].direction();
        assert!(begun.angle_between(eye_m(&harness, place)) < 0.02, "view {place}");
    }
    assert_eq!(undo_len(&harness), 3);
}

#[test]
fn a_click_on_the_map_flies_there() {
    let mut harness = with_views(PaneLayout::Two);
    let map = rect(&harness, 1);
    let ahead = map.center() + egui::vec2(0.125 * map.width(), 0.0);
    harness.hover_at(ahead);
    harness.run_steps(2);
    for pressed in [true, false] {
        let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
        harness.event(egui::Event::PointerButton { pos: ahead, button, pressed, modifiers });
        harness.run_steps(2);
    }
    until(&mut harness, "the camera comes to rest", |harness| !harness.state().viewport().is_moving());
    let (lat_deg, lon_deg) = harness.state().viewport().eye(&planet(&harness)).1.to_degrees();
    assert!(lat_deg.abs() < 2.0 && (lon_deg - 45.0).abs() < 2.0, "{lat_deg} {lon_deg}");
    assert_eq!(harness.state().viewport().active_pane(), 0, "a map has no tools");
}

#[test]
fn views_of_their_own_keep_their_distance_in_radii_when_the_radius_changes() {
    let mut harness = with_views(PaneLayout::Four);
    let radii = |harness: &Editor, place: usize| eye_m(harness, place).length() / (planet(harness).radius_km * 1000.0);
    // The active view goes its own way, then the third: the others are linked.
    for (place, name) in [(0, "View 1 linked"), (2, "View 3 linked")] {
        click(&mut harness, name);
        let from = rect(&harness, place).center();
        app::drag(&mut harness, from, from + egui::vec2(30.0, 0.0));
    }
    let before = [0, 1, 2].map(|place| radii(&harness, place));
    click(&mut harness, "Planet");
    let twice_km = 2.0 * planet(&harness).radius_km;
    slide(&mut harness, "Radius of planet", twice_km);
    wait_for_picture(&mut harness);
    for (place, before) in before.into_iter().enumerate() {
        let after = radii(&harness, place);
        assert!((after / before - 1.0).abs() < 0.01, "view {place}: {before} radii, then {after}");
    }
}

#[test]
fn panes_are_there_again_at_the_next_start() {
    let mut harness = with_views(PaneLayout::Four);
    click(&mut harness, "View 3 linked");
    click(&mut harness, "View 2 shows: Height");
    click(&mut harness, "Slope");
    let (before, kept) = (shows(&harness), harness.state().viewport().panes_text());
    let mut next = app::open_stored([1400.0, 800.0], "tellus_panes", kept.clone());
    wait_for_picture(&mut next);
    assert_eq!(shows(&next), before);
    assert_eq!(next.state().viewport().panes_text(), kept);
    assert!(kept.contains("\t-Biome") && kept.contains("\t+Slope"), "{kept}");
    // The tools are in the same pane, and work.
    assert_eq!(next.state().viewport().active_pane(), harness.state().viewport().active_pane());
    // What is broken opens one view.
    let next = app::open_stored([1400.0, 800.0], "tellus_panes", kept.replace("Slope", "Slop"));
    assert_eq!(shows(&next).len(), 1);
}
