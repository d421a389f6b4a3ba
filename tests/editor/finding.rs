//! Filters over the panels, and the row of a parameter that was searched for.

use super::*;
use tellus::editor::finder::entries::parameters;
use tellus::planet::{Mask, PlateByHand, Structure};

const TABS: [&str; 9] =
    ["Planet", "Terrain", "Structure", "Climate", "Biomes", "Water", "Atmosphere", "Clouds", "Star"];

/// A planet with parameters of every kind.
fn full_planet() -> Planet {
    let mut planet = tellus::planet::shipped::default_planet();
    let mut structure = planet.structure.take().unwrap_or_default();
    structure.plates.by_hand = vec![PlateByHand { plate: 3, ..PlateByHand::default() }];
    planet.structure = Some(Structure { ..structure });
    if let Some(layer) = planet.layers.last_mut() {
        layer.masks = Mask::all();
    }
    planet
}

/// Each parameter that can be found has a row, and the panel scrolls to it.
#[test]
fn every_parameter_that_can_be_found_has_a_row_in_view() {
    const HEIGHT: f32 = 700.0;
    let mut harness = app::open_planet([1100.0, HEIGHT], full_planet());
    let entries = parameters(&planet(&harness));
    assert!(entries.len() > 500, "{}", entries.len());
    let count = entries.len();
    // One of each name is enough, and some more.
    let mut names = std::collections::BTreeSet::new();
    for (index, entry) in entries.into_iter().enumerate() {
        if !names.insert(entry.name.clone()) && index % 40 != 0 && index + 1 != count {
            continue;
        }
        let name = entry.accessible_name();
        harness.state_mut().push(entry.action);
        harness.run_steps(12);
        let row = harness.state().revealed();
        let in_view = row.is_some_and(|row| row.top() > 60.0 && row.bottom() < HEIGHT - 20.0 && row.left() > 600.0);
        assert!(in_view, "{name}: {row:?}");
    }
}

fn filter(harness: &mut Editor, tab: &str, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, &format!("Filter of {tab}")).focus();
    harness.run_steps(2);
    press(harness, egui::Modifiers::COMMAND, egui::Key::A);
    type_text(harness, text);
}

fn has_slider(harness: &Editor, label: &str) -> bool {
    harness.query_by_role_and_label(Role::Slider, label).is_some()
}

#[test]
fn a_filter_narrows_a_panel_and_is_cleared_by_escape_and_by_its_button() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    filter(&mut harness, "Planet", "radius");
    assert!(has_slider(&harness, "Radius of planet") && !has_slider(&harness, "Settlements of planet"));
    filter(&mut harness, "Planet", "lights night");
    assert!(has_slider(&harness, "Settlements of planet"), "by the tooltip");
    filter(&mut harness, "Planet", "radius_km");
    assert!(has_slider(&harness, "Radius of planet"), "by the path");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(has_slider(&harness, "Radius of planet") && has_slider(&harness, "Settlements of planet"));
    filter(&mut harness, "Planet", "radius");
    click(&mut harness, "Clear filter");
    assert!(has_slider(&harness, "Settlements of planet"));
    assert!(harness.query_by_label("Clear filter").is_none());
}

#[test]
fn a_filter_that_hides_all_says_so_and_offers_to_search_everywhere() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    filter(&mut harness, "Star", "coverage");
    assert!(harness.query_by_label("No parameter matches “coverage” here.").is_some());
    click(&mut harness, "Search everywhere");
    harness.run_steps(3);
    assert!(harness.query_by_label("Clouds › Low cover").is_some());
}

#[test]
fn each_tab_has_a_filter_of_its_own() {
    let mut harness = app::open_planet([1024.0, 640.0], full_planet());
    for tab in TABS {
        harness.get_by_role_and_label(Role::Button, tab).click();
        harness.run_steps(3);
        filter(&mut harness, tab, "seed");
        harness.check_accessibility();
        let sliders = harness.query_all_by_role(Role::Slider).count();
        let seeds = harness.query_all_by_role(Role::SpinButton).count();
        assert!(sliders == 0, "{tab}: {sliders}");
        let told = harness.query_by_label("No parameter matches “seed” here.").is_some();
        assert_eq!(told, seeds <= 1, "{tab}: {seeds}, one of them is the speed of time");
    }
    harness.get_by_role_and_label(Role::Button, "Structure").click();
    harness.run_steps(3);
    filter(&mut harness, "Structure", "wetness");
    assert!(has_slider(&harness, "Wetness of weather"), "its section is folded without a filter");
    filter(&mut harness, "Structure", "");
}

#[test]
fn a_filtered_terrain_shows_one_layer_at_a_time() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Terrain");
    let names: Vec<String> = planet(&harness).layers.iter().map(|layer| layer.name.clone()).collect();
    filter(&mut harness, "Terrain", "amplitude");
    assert!(has_slider(&harness, &format!("Amplitude of {}", names[0])));
    click(&mut harness, "Layer with these parameters");
    harness.query_all_by_label(&names[1]).last().unwrap().click();
    harness.run_steps(3);
    assert!(has_slider(&harness, &format!("Amplitude of {}", names[1])));
    slide(&mut harness, &format!("Amplitude of {}", names[1]), 77.0);
    assert_eq!(planet(&harness).layers[1].amplitude_m, 77.0);
}

#[test]
fn escape_closes_windows_before_it_clears_a_filter() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    filter(&mut harness, "Planet", "radius");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F1);
    let help = |harness: &Editor| harness.query_by_label("Walk; slower uphill").is_some();
    assert!(help(&harness));
    escape(&mut harness);
    assert!(!help(&harness) && !has_slider(&harness, "Settlements of planet"));
    escape(&mut harness);
    assert!(has_slider(&harness, "Settlements of planet"));
}

#[test]
fn no_key_gets_past_a_filter_or_a_slider() {
    let mut harness = editor(vec![]);
    let before = pose(&harness);
    click(&mut harness, "Planet");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::F);
    type_text(&mut harness, "ra");
    let hold = |harness: &mut Editor| {
        for key in [egui::Key::D, egui::Key::W, egui::Key::Num2, egui::Key::ArrowRight, egui::Key::PageUp] {
            harness.key_down(key);
            harness.run_steps(4);
            harness.key_up(key);
            harness.run_steps(1);
        }
    };
    hold(&mut harness);
    assert_eq!(pose(&harness), before);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Shaded);
    harness.get_by_role_and_label(Role::Slider, "Radius of planet").focus();
    harness.run_steps(2);
    let radius_km = planet(&harness).radius_km;
    harness.key_down(egui::Key::ArrowRight);
    harness.run_steps(4);
    harness.key_up(egui::Key::ArrowRight);
    assert_ne!(planet(&harness).radius_km, radius_km, "the slider has the key");
    let up = |pose: tellus::lod::pose::Pose| pose.up();
    assert!(up(pose(&harness)).distance(up(before)) < 1e-9, "and the camera has not");
}

#[test]
fn a_parameter_that_a_filter_hides_is_revealed_all_the_same() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    filter(&mut harness, "Planet", "seed");
    let entries = parameters(&planet(&harness));
    let radius = entries.into_iter().find(|entry| entry.accessible_name() == "Planet › Radius").unwrap();
    harness.state_mut().push(radius.action);
    harness.run_steps(4);
    assert!(has_slider(&harness, "Radius of planet"));
}
