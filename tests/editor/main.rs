//! Tests of the real editor without a window: here its panels.
//!
//! - `files`: opening and saving without losing work
//! - `crash`: what is left after a crash, and what is told of it
//! - `disk`: other programs and windows on the open file; new files; no file dialogs
//! - `input`: typed numbers, keys, menus, windows
//! - `painter`: the painter of the biome table; `plates`: plates of the structure; `sculpt`, `edits`: ground edits
//! - `finder`: commands, planets, bookmarks and parameters by name
//! - `finding`: filters, and the row of a parameter that was searched for
//! - `inspector`: all that is known of a place; `looks`: golden pictures of windows
//! - `bake`: maps for other programs
//! - `life`: populations of plants and stones
//! - `layers`: several layers at once, layers alone
//! - `library`: planets and parts that the user keeps
//! - `system`: systems of planets
//! - `tour`: steps for a first look around
//! - `docks`: tabs that are moved
//! - `clipboard`: layers and parts as text
//! - `history`: the list of undo steps; `place`: the flight to a latitude and longitude
//! - `text`: the text of the preset
//! - `textures`: texture sets of biomes
//! - `variations`: variations of the planet, and locks
//! - `monkey`: random commands, all of which can be undone; `memory`: random events, over which memory levels off
//! - `photo`: photographs, films, and what a photographer sets
//! - `viewport`: the camera and the picture; `panes`: several views
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../support/app.rs"]
mod app;
mod bake;
mod clipboard;
mod crash;
#[path = "../support/dice.rs"]
mod dice;
mod disk;
mod docks;
mod edits;
mod files;
mod finder;
mod finding;
#[path = "../support/glb.rs"]
mod glb;
#[path = "../support/heap.rs"]
mod heap;
mod history;
mod input;
mod inspector;
#[path = "../support/layered.rs"]
mod layered;
mod layers;
mod library;
mod life;
mod looks;
mod memory;
mod monkey;
mod painter;
mod panes;
mod photo;
mod place;
mod plates;
#[path = "../support/png.rs"]
mod png;
mod sculpt;
mod system;
mod text;
mod textures;
#[path = "../support/textures.rs"]
mod textures_of;
mod tour;
mod variations;
mod viewport;

use app::{
    Editor, canvas, click, drag, drag_row_below, planet, scroll_to, send, type_text, undo_label, undo_len, unfold,
};
use eframe::egui;
use eframe::egui::accesskit::{Role, Toggled};
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::PathBuf;
use tellus::editor::command::{Action, Command};
use tellus::editor::state::templates;
use tellus::editor::viewport::camera::Mode;
use tellus::planet::Planet;
use tellus::render::{DebugView, Legend};

/// An editor in the smallest window that must show everything; file dialogs give these answers.
fn editor(answers: Vec<Option<PathBuf>>) -> Editor {
    app::open([1024.0, 640.0], answers)
}

/// The same with a picture.
fn drawn_editor() -> Editor {
    app::open_with_picture([1024.0, 640.0], vec![])
}

fn slide(harness: &mut Editor, label: &str, value: f64) {
    harness.get_by_role_and_label(Role::Slider, label).set_value_accesskit(value);
    harness.run_steps(3);
}

fn press(harness: &mut Editor, modifiers: egui::Modifiers, key: egui::Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

/// Presses Escape, and lets a window that closes fade away.
fn escape(harness: &mut Editor) {
    press(harness, egui::Modifiers::NONE, egui::Key::Escape);
    harness.run_steps(20);
}

/// The rows in view of the list that is open, and whether each is the chosen one.
fn listed(harness: &Editor) -> Vec<(String, bool)> {
    let rows = harness.query_all_by_role(Role::ListBoxOption);
    let row = |row: egui_kittest::Node<'_>| {
        let node = row.accesskit_node();
        (node.label().unwrap_or_default(), node.toggled() == Some(Toggled::True))
    };
    rows.map(row).collect()
}

/// The chosen row of the list that is open.
fn chosen(harness: &Editor) -> String {
    listed(harness).into_iter().find_map(|(name, chosen)| chosen.then_some(name)).unwrap_or_default()
}

/// Begins a new planet: a copy of the first that ships.
fn begin_new(harness: &mut Editor) {
    harness.state_mut().push(Action::Begin(templates::ALL[0].template));
    harness.run_steps(3);
}

/// Position and orientation of the eye.
fn pose(harness: &Editor) -> tellus::lod::pose::Pose {
    harness.state().viewport().pose(harness.state().document().valid_planet())
}

#[test]
fn a_slider_edits_and_undo_and_redo_go_back_and_forth() {
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 1234.0);
    assert_eq!(planet(&harness).radius_km, 1234.0);
    assert!(harness.state().document().is_dirty());
    assert!(harness.query_by_label_contains("•").is_some(), "the dirty mark is on screen");
    assert_eq!(undo_label(&harness), "Change radius");

    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(planet(&harness), before);
    assert!(!harness.state().document().is_dirty());
    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::Z);
    assert_eq!(planet(&harness).radius_km, 1234.0);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Y);
    assert_eq!(planet(&harness).radius_km, 1234.0);
}

#[test]
fn a_drag_of_a_slider_is_one_step_and_reset_goes_back_to_the_default() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    let steps = undo_len(&harness);
    let rect = harness.get_by_role_and_label(Role::Slider, "Radius of planet").rect();
    harness.drag_at(rect.center());
    for step in 1..8 {
        harness.hover_at(rect.center() + egui::vec2(4.0 * step as f32, 0.0));
    }
    harness.drop_at(rect.center() + egui::vec2(28.0, 0.0));
    harness.run_steps(3);
    assert_ne!(planet(&harness).radius_km, Planet::default().radius_km);
    assert_eq!(undo_len(&harness), steps + 1);
    click(&mut harness, "Reset Radius of planet");
    assert_eq!(planet(&harness).radius_km, Planet::default().radius_km);
}

#[test]
fn layers_are_added_edited_and_masked() {
    let mut harness = editor(vec![]);
    let count = planet(&harness).layers.len();
    click(&mut harness, "Terrain");
    click(&mut harness, "Add layer");
    click(&mut harness, "Ridges");
    assert_eq!(planet(&harness).layers.len(), count + 1);
    assert_eq!(undo_label(&harness), "Add layer: ridges");
    click(&mut harness, "Duplicate layer");
    let names: Vec<String> = planet(&harness).layers.iter().map(|layer| layer.name.clone()).collect();
    let selected = names.iter().position(|name| name.ends_with(" 2")).unwrap();
    slide(&mut harness, &format!("Amplitude of {}", names[selected]), 4321.0);
    assert_eq!(planet(&harness).layers[selected].amplitude_m, 4321.0);
    assert_eq!(undo_label(&harness), format!("Change amplitude of {}", names[selected]));
    scroll_to(&mut harness, "Add mask");
    click(&mut harness, "Add mask");
    assert_eq!(planet(&harness).layers[selected].masks.len(), 1);
    scroll_to(&mut harness, "Remove layer");
    click(&mut harness, "Remove layer");
    assert_eq!(planet(&harness).layers.len(), count + 1);
}

#[test]
fn a_layer_is_dragged_to_another_place_in_one_step() {
    let mut harness = editor(vec![]);
    let names =
        |harness: &Editor| -> Vec<String> { planet(harness).layers.iter().map(|layer| layer.name.clone()).collect() };
    let before = names(&harness);
    let steps = undo_len(&harness);
    drag_row_below(&mut harness, &format!("Layer {}", before[0]), &format!("Layer {}", before[2]));
    let mut expected = before.clone();
    let moved = expected.remove(0);
    expected.insert(2, moved);
    assert_eq!(names(&harness), expected);
    assert_eq!((undo_len(&harness), undo_label(&harness)), (steps + 1, "Move layer".to_owned()));
    send(&mut harness, Command::Undo);
    assert_eq!(names(&harness), before);
}

#[test]
fn a_curve_is_bent_by_its_points() {
    let mut harness = editor(vec![]);
    let index = planet(&harness).layers.iter().position(|layer| layer.curve.is_empty()).unwrap();
    let name = planet(&harness).layers[index].name.clone();
    let curve = |harness: &Editor| planet(harness).layers[index].curve.clone();
    click(&mut harness, &format!("Layer {name}"));
    scroll_to(&mut harness, &format!("Add Curve of {name}"));
    click(&mut harness, &format!("Add Curve of {name}"));
    assert_eq!(curve(&harness), vec![[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]]);

    let steps = undo_len(&harness);
    app::scroll_to(&mut harness, &format!("Curve of {name}"));
    let rect = harness.get_by_label(&format!("Curve of {name}")).rect();
    let middle = rect.center();
    drag(&mut harness, middle, middle - egui::vec2(0.0, 30.0));
    let [x, y] = curve(&harness)[1];
    assert!(x.abs() < 0.1 && (0.3..0.9).contains(&y), "{x} {y}");
    assert_eq!(undo_len(&harness), steps + 1);
    click(&mut harness, &format!("Reset Curve of {name}"));
    assert!(curve(&harness).is_empty());
}

#[test]
fn a_stroke_on_the_biome_table_paints_cells_in_one_step() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Biomes");
    click(&mut harness, "Add biome");
    let biomes = planet(&harness).biomes;
    let key = biomes.palette.last().unwrap().key;
    let steps = undo_len(&harness);
    let rect = harness.get_by_label("Biome table").rect();
    let cell = rect.size() / egui::vec2(biomes.table.columns() as f32, biomes.table.rows().len() as f32);
    let first = rect.min + cell * 0.5;
    harness.drag_at(first);
    harness.hover_at(first + egui::vec2(cell.x, 0.0));
    harness.hover_at(first + egui::vec2(3.0 * cell.x, 0.0));
    harness.drop_at(first + egui::vec2(3.0 * cell.x, 0.0));
    harness.run_steps(3);
    let table = planet(&harness).biomes.table;
    for column in 0..4 {
        assert_eq!(table.key(column, 0), Some(key), "column {column}");
    }
    assert_eq!(table.key(4, 0), biomes.table.key(4, 0));
    assert_eq!(undo_len(&harness), steps + 1);
    assert_eq!(undo_label(&harness), "Paint biomes");
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness).biomes, biomes);
}

#[test]
fn clouds_turned_off_and_on_are_the_same_clouds() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Clouds");
    if planet(&harness).clouds.is_none() {
        click(&mut harness, "This planet has clouds");
    }
    slide(&mut harness, "Low cover of clouds", 0.25);
    let clouds = planet(&harness).clouds;
    assert_eq!(clouds.as_ref().unwrap().coverage, 0.25);
    click(&mut harness, "This planet has clouds");
    assert_eq!(planet(&harness).clouds, None);
    assert_eq!(undo_label(&harness), "Turn clouds off");
    click(&mut harness, "This planet has clouds");
    assert_eq!(planet(&harness).clouds, clouds);
}

#[test]
fn everything_has_a_name_and_nothing_is_clipped_in_a_small_window() {
    let mut harness = editor(vec![]);
    for tab in ["Planet", "Terrain", "Climate", "Biomes", "Water", "Atmosphere", "Clouds", "Star"] {
        harness.get_by_role_and_label(Role::Button, tab).click();
        harness.run_steps(3);
        harness.check_accessibility();
        for node in harness.query_all_by_role(Role::Slider) {
            let rect = node.rect();
            assert!(rect.left() >= 0.0 && rect.right() <= 1024.0, "{tab}: {rect:?}");
        }
    }
}

/// Steps until the picture is complete and its time is measured.
fn wait_for_picture(harness: &mut Editor) {
    app::wait_for_picture(harness);
    std::thread::sleep(std::time::Duration::from_millis(200));
    harness.run_steps(3);
}

#[test]
fn an_idle_editor_draws_nothing() {
    let mut harness = drawn_editor();
    wait_for_picture(&mut harness);
    let pictures = harness.state().viewport().pictures();
    assert!(pictures > 0);
    harness.run_steps(20);
    assert_eq!(harness.state().viewport().pictures(), pictures);
    harness.state_mut().viewport_mut().settings.post.exposure_ev = 1.0;
    harness.run_steps(3);
    assert_eq!(harness.state().viewport().pictures(), pictures + 1);
}

#[test]
fn the_time_from_an_edit_to_its_picture_is_measured() {
    let mut harness = drawn_editor();
    wait_for_picture(&mut harness);
    assert_eq!(harness.state().viewport().edit_clock.last(), None);
    click(&mut harness, "Star");
    slide(&mut harness, "Brightness of star", 2.0);
    wait_for_picture(&mut harness);
    let uniform = harness.state().viewport().edit_clock.last();
    assert!(uniform.is_some(), "an edit that rebuilds no tile");
    click(&mut harness, "Climate");
    slide(&mut harness, "Equator of climate", 20.0);
    for _ in 0..100 {
        wait_for_picture(&mut harness);
        if harness.state().viewport().edit_clock.last() != uniform {
            break;
        }
    }
    assert_ne!(harness.state().viewport().edit_clock.last(), uniform, "an edit that rebuilds tiles");
}

#[test]
fn memory_for_tiles_is_set_and_kept() {
    let mut harness = editor(vec![]);
    app::until(&mut harness, "tiles", |harness| harness.state().viewport().surface().is_some());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F8);
    let budget = |harness: &Editor| harness.state().viewport().memory().budget_bytes >> 20;
    assert_eq!(budget(&harness), 256);
    slide(&mut harness, "Memory for tiles", 512.0);
    assert_eq!(harness.state().viewport().settings.cache_mib, 512);
    // The builder tells it with the next tiles.
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    app::until(&mut harness, "the new budget", |harness| budget(harness) == 512);
    // Of the last run, if it is a number in range.
    let settings = &mut harness.state_mut().viewport_mut().settings;
    for (kept, mib) in [(Some("1024"), 1024), (Some("1"), 1024), (Some("many"), 1024), (None, 1024), (Some("64"), 64)] {
        settings.restore_cache(kept);
        assert_eq!(settings.cache_mib, mib, "{kept:?}");
    }
}

#[test]
fn the_performance_panel_tells_where_an_edit_went() {
    let mut harness = drawn_editor();
    wait_for_picture(&mut harness);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F8);
    assert!(harness.query_by_label_contains("times of the next edit").is_some());
    click(&mut harness, "Climate");
    slide(&mut harness, "Region size of climate", 900.0);
    for _ in 0..100 {
        wait_for_picture(&mut harness);
        if harness.state().viewport().edit_clock.last().is_some() {
            break;
        }
    }
    harness.run_steps(2);
    for step in ["Compare and compile", "Choose tiles", "Climate noise", "Vertices", "Upload", "Draw", "Present"] {
        assert!(harness.query_by_label(step).is_some(), "{step}");
    }
    assert!(harness.query_by_label("Layer noise").is_none(), "no layer was touched");
    let timeline = harness.state().viewport().edit_clock.timeline().unwrap().clone();
    let mut ends = timeline.steps.iter().map(|step| step.end_secs);
    assert!(ends.all(|end_secs| end_secs <= timeline.total.as_secs_f64()), "{timeline:?}");
    assert!(timeline.uploaded_bytes > 0 && timeline.build.octave_samples > 0);
    assert!(harness.state().viewport().memory().used_bytes > 0);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F8);
    assert!(harness.query_by_label("Draw").is_none());
}
