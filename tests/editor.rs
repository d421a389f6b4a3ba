//! Drives the real editor without a window: the application, its panels, its files.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "support/app.rs"]
mod app;

use app::{Editor, click, planet, undo_label, undo_len};
use eframe::egui;
use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;
use tellus::editor::EditorApp;
use tellus::editor::command::Command;
use tellus::editor::viewport::camera::Mode;
use tellus::planet::Planet;
use tellus::render::DebugView;

/// An editor in the smallest window that must hold everything; file dialogs give these answers.
fn editor(answers: Vec<Option<PathBuf>>) -> Editor {
    app::open([1024.0, 640.0], answers)
}

fn slide(harness: &mut Editor, label: &str, value: f64) {
    harness.get_by_role_and_label(Role::Slider, label).set_value_accesskit(value);
    harness.run_steps(3);
}

fn send(harness: &mut Editor, command: Command) {
    harness.state_mut().send(command);
    harness.run_steps(4);
}

fn press(harness: &mut Editor, modifiers: egui::Modifiers, key: egui::Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
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
    click(&mut harness, "Ridged");
    assert_eq!(planet(&harness).layers.len(), count + 1);
    assert_eq!(undo_label(&harness), "Add layer");
    click(&mut harness, "Duplicate layer");
    let names: Vec<String> = planet(&harness).layers.iter().map(|layer| layer.name.clone()).collect();
    let selected = names.iter().position(|name| name.ends_with(" 2")).unwrap();
    slide(&mut harness, &format!("Amplitude of {}", names[selected]), 4321.0);
    assert_eq!(planet(&harness).layers[selected].amplitude_m, 4321.0);
    assert_eq!(undo_label(&harness), format!("Change amplitude of {}", names[selected]));
    harness.get_by_label("Add mask").scroll_to_me();
    harness.run_steps(30);
    click(&mut harness, "Add mask");
    assert_eq!(planet(&harness).layers[selected].masks.len(), 1);
    harness.get_by_label("Remove layer").scroll_to_me();
    harness.run_steps(30);
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
    let row = |harness: &Editor, index: usize| harness.get_by_label(&format!("Layer {}", before[index])).rect();
    let (from, to) = (row(&harness, 0).center(), row(&harness, 2).center_bottom() - egui::vec2(0.0, 2.0));
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(to);
    harness.run_steps(2);
    harness.drop_at(to);
    harness.run_steps(3);
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
    click(&mut harness, &format!("Bend Curve of {name}"));
    assert_eq!(curve(&harness), vec![[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]]);

    let steps = undo_len(&harness);
    let rect = harness.get_by_label(&format!("Curve of {name}")).rect();
    let middle = rect.center();
    harness.drag_at(middle);
    harness.run_steps(2);
    harness.hover_at(middle - egui::vec2(0.0, 20.0));
    harness.run_steps(2);
    harness.hover_at(middle - egui::vec2(0.0, 30.0));
    harness.run_steps(2);
    harness.drop_at(middle - egui::vec2(0.0, 30.0));
    harness.run_steps(2);
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
    slide(&mut harness, "Coverage of clouds", 0.25);
    let clouds = planet(&harness).clouds;
    assert_eq!(clouds.as_ref().unwrap().coverage, 0.25);
    click(&mut harness, "This planet has clouds");
    assert_eq!(planet(&harness).clouds, None);
    assert_eq!(undo_label(&harness), "Turn clouds off");
    click(&mut harness, "This planet has clouds");
    assert_eq!(planet(&harness).clouds, clouds);
}

#[test]
fn a_drag_with_shift_turns_the_star_in_one_step() {
    let mut harness = editor(vec![]);
    let before = planet(&harness).star;
    let center = harness.get_by_role_and_label(Role::Canvas, "View of the planet").rect().center();
    let button = |pressed, pos| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::SHIFT,
    };
    harness.hover_at(center);
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::SHIFT));
    harness.event(button(true, center));
    for step in 1..6 {
        harness.hover_at(center + egui::vec2(20.0 * step as f32, 0.0));
    }
    harness.event(button(false, center + egui::vec2(100.0, 0.0)));
    harness.run_steps(3);
    assert_ne!(planet(&harness).star.longitude_deg, before.longitude_deg);
    assert_eq!(undo_label(&harness), "Turn the sun");
    assert_eq!(undo_len(&harness), 1);
}

#[test]
fn saved_as_and_opened_again_it_is_the_same_planet() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let mut harness = editor(vec![Some(path.clone()), Some(path.clone())]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);
    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::S);
    assert!(path.exists());
    assert!(!harness.state().document().is_dirty());
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
    send(&mut harness, Command::New);
    assert_ne!(planet(&harness), edited);
    send(&mut harness, Command::Open);
    assert_eq!(planet(&harness), edited);
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
}

#[test]
fn unsaved_work_is_never_dropped_without_asking() {
    let mut harness = editor(vec![None]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);

    send(&mut harness, Command::New);
    assert_eq!(planet(&harness), edited, "nothing happens before the answer");
    click(&mut harness, "Cancel");
    assert_eq!(planet(&harness), edited);

    send(&mut harness, Command::New);
    click(&mut harness, "Save changes");
    assert_eq!(planet(&harness), edited, "the file dialog was cancelled");

    send(&mut harness, Command::New);
    click(&mut harness, "Discard changes");
    assert_ne!(planet(&harness), edited);
    assert!(!harness.state().document().is_dirty());
}

#[test]
fn closing_the_window_with_unsaved_work_asks() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let root = harness.ctx.viewport_id();
    harness.input_mut().viewports.entry(root).or_default().events.push(egui::ViewportEvent::Close);
    harness.step();
    let commands = harness.output().viewport_output[&root].commands.clone();
    assert!(commands.contains(&egui::ViewportCommand::CancelClose), "{commands:?}");
    harness.run_steps(2);
    assert!(harness.query_by_label("Save your changes?").is_some());
}

#[test]
fn a_file_that_cannot_be_opened_is_explained_and_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.ron");
    std::fs::write(&path, "(version: 1, radius_km: \"large\")").unwrap();
    let mut harness = editor(vec![Some(path)]);
    let before = planet(&harness);
    send(&mut harness, Command::Open);
    assert!(harness.query_by_label("The planet could not be opened").is_some());
    assert!(harness.query_by_label_contains("radius_km").is_some());
    click(&mut harness, "Dismiss");
    assert_eq!(planet(&harness), before);
}

#[test]
fn everything_has_a_name_and_nothing_is_clipped_in_a_small_window() {
    let mut harness = editor(vec![]);
    for tab in ["Planet", "Terrain", "Climate", "Biomes", "Water", "Air", "Clouds", "Star"] {
        harness.get_by_role_and_label(Role::Button, tab).click();
        harness.run_steps(3);
        harness.check_accessibility();
        for node in harness.query_all_by_role(Role::Slider) {
            let rect = node.rect();
            assert!(rect.left() >= 0.0 && rect.right() <= 1024.0, "{tab}: {rect:?}");
        }
    }
}

/// Steps until the picture is complete and its time is known.
fn wait_for_picture(harness: &mut Editor) {
    for _ in 0..600 {
        harness.step();
        let viewport = harness.state().viewport();
        if viewport.surface().is_some_and(|surface| surface.complete) && !viewport.is_busy() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    harness.run_steps(3);
    std::thread::sleep(std::time::Duration::from_millis(200));
    harness.run_steps(3);
}

#[test]
fn an_idle_editor_draws_nothing() {
    let mut harness = editor(vec![]);
    wait_for_picture(&mut harness);
    let pictures = harness.state().viewport().pictures();
    assert!(pictures > 0);
    harness.run_steps(20);
    assert_eq!(harness.state().viewport().pictures(), pictures);
    harness.state_mut().viewport_mut().settings.exposure_ev = 1.0;
    harness.run_steps(3);
    assert_eq!(harness.state().viewport().pictures(), pictures + 1);
}

#[test]
fn the_time_from_an_edit_to_its_picture_is_measured() {
    let mut harness = editor(vec![]);
    wait_for_picture(&mut harness);
    assert_eq!(harness.state().viewport().edit_clock.last(), None);
    click(&mut harness, "Star");
    slide(&mut harness, "Brightness of star", 2.0);
    wait_for_picture(&mut harness);
    let uniform = harness.state().viewport().edit_clock.last();
    assert!(uniform.is_some(), "an edit that rebuilds nothing");
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
fn unsaved_work_outlives_a_crash() {
    let folder = tempfile::tempdir().unwrap();
    let start = || {
        let mut harness = Harness::builder()
            .with_size([1024.0, 640.0])
            .with_step_dt(1.0 / 60.0)
            .wgpu()
            .build_eframe(|cc| EditorApp::new(cc, None).with_recovery(folder.path()));
        harness.run_steps(4);
        harness
    };
    let mut harness = start();
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);
    for _ in 0..200 {
        harness.step();
        if folder.path().join("recovery-0.ron").exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    // Dropped without the orderly end that eframe announces: a crash.
    drop(harness);

    let mut harness = start();
    assert_ne!(planet(&harness), edited);
    click(&mut harness, "Recover");
    assert_eq!(planet(&harness), edited);
    assert!(harness.state().document().is_dirty());
}

#[test]
fn the_performance_panel_tells_where_an_edit_went() {
    let mut harness = editor(vec![]);
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

#[test]
fn a_height_map_is_chosen_undone_saved_and_missed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let picture = path("maps/heights.png");
    std::fs::create_dir(path("maps")).unwrap();
    let pixels: Vec<u8> = (0..8 * 16).map(|i| 100 + i).collect();
    image::save_buffer(&picture, &pixels, 16, 8, image::ExtendedColorType::L8).unwrap();
    let preset = path("mine.ron");
    let mut harness = editor(vec![Some(picture.clone()), Some(preset.clone()), Some(preset.clone())]);
    let height_m = |harness: &Editor| {
        let planet = (**harness.state().document().planet()).clone();
        tellus::terrain::Terrain::new(planet.into()).sample(glam::DVec3::X).layers_m[1]
    };
    let settled = |harness: &mut Editor| {
        for _ in 0..200 {
            harness.run_steps(1);
            if !harness.state().pictures().is_reading() {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        harness.run_steps(2);
    };
    click(&mut harness, "Terrain");
    click(&mut harness, "Add layer");
    click(&mut harness, "HeightMap");
    assert_eq!(height_m(&harness), 0.0);
    click(&mut harness, "Browse…");
    settled(&mut harness);
    let chosen_m = height_m(&harness);
    assert!(chosen_m > 300.0, "{chosen_m}");
    assert_eq!(undo_label(&harness), "Choose picture");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(height_m(&harness), 0.0);
    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::Z);
    settled(&mut harness);
    assert_eq!(height_m(&harness), chosen_m);

    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::S);
    assert!(!harness.state().document().is_dirty());
    assert!(std::fs::read_to_string(&preset).unwrap().contains("file: \"maps/heights.png\""));
    assert_eq!(height_m(&harness), chosen_m);

    std::fs::rename(&picture, path("away.png")).unwrap();
    send(&mut harness, Command::New);
    send(&mut harness, Command::Open);
    settled(&mut harness);
    assert_eq!(harness.state().document().path(), Some(preset.as_path()), "it opens without its picture");
    assert!(!harness.state().document().is_dirty());
    assert_eq!(height_m(&harness), 0.0);
    assert!(harness.query_all_by_label_contains("put the picture there").next().is_some());
    std::fs::rename(path("away.png"), &picture).unwrap();
    harness.run_steps(2);
    settled(&mut harness);
    assert_eq!(height_m(&harness), chosen_m, "the file is back");
}

/// The same with a picture that is drawn fast: neither sky nor sea.
fn plain_editor(answers: Vec<Option<PathBuf>>) -> Editor {
    let mut harness = editor(answers);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Num8);
    wait_for_picture(&mut harness);
    harness
}

/// Steps until the camera is at rest.
fn wait_for_camera(harness: &mut Editor) {
    for _ in 0..400 {
        harness.step();
        if !harness.state().viewport().is_moving() {
            return;
        }
    }
    panic!("the camera never comes to rest");
}

fn mode(harness: &Editor) -> Mode {
    harness.state().viewport().cameras().mode()
}

fn eye_height_m(harness: &Editor) -> f64 {
    harness.state().viewport().eye(harness.state().document().valid_planet()).0
}

#[test]
fn keys_change_the_way_to_move_and_the_status_says_so() {
    let mut harness = plain_editor(vec![]);
    assert!(harness.query_by_label("Orbit").is_some());
    let from_space_m = eye_height_m(&harness);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F3);
    assert_eq!(mode(&harness), Mode::Fly);
    assert!(harness.query_by_label("Fly").is_some());
    assert!((eye_height_m(&harness) / from_space_m - 1.0).abs() < 1e-9, "the eye stays where it was");
    harness.key_down(egui::Key::W);
    harness.run_steps(20);
    harness.key_up(egui::Key::W);
    wait_for_camera(&mut harness);
    assert!(eye_height_m(&harness) < 0.9 * from_space_m, "W goes to where one looks");

    press(&mut harness, egui::Modifiers::NONE, egui::Key::F4);
    wait_for_camera(&mut harness);
    assert_eq!(mode(&harness), Mode::Walk);
    assert!((eye_height_m(&harness) - 1.7).abs() < 1e-3, "{}", eye_height_m(&harness));
    let start = harness.state().viewport().pose(&planet(&harness)).position_planet_m;
    harness.key_down(egui::Key::W);
    harness.run_steps(60);
    harness.key_up(egui::Key::W);
    wait_for_camera(&mut harness);
    let way_m = start.distance(harness.state().viewport().pose(&planet(&harness)).position_planet_m);
    assert!((0.2..20.0).contains(&way_m), "a second's walk is {way_m} m");
    assert!((eye_height_m(&harness) - 1.7).abs() < 1e-3);
    harness.key_press(egui::Key::Space);
    harness.run_steps(8);
    assert!(eye_height_m(&harness) > 1.9, "a jump: {}", eye_height_m(&harness));
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F2);
    assert_eq!(mode(&harness), Mode::Orbit);
    assert_eq!(undo_len(&harness), 0, "to look around is no edit");
}

#[test]
fn number_keys_show_debug_views_but_not_while_one_types() {
    let mut harness = editor(vec![]);
    for (key, view) in [
        (egui::Key::Num2, DebugView::Height),
        (egui::Key::Num6, DebugView::Temperature),
        (egui::Key::Num9, DebugView::TileBorders),
        (egui::Key::Num0, DebugView::Wireframe),
        (egui::Key::Minus, DebugView::Error),
        (egui::Key::Equals, DebugView::Coverage),
        (egui::Key::Num1, DebugView::Shaded),
    ] {
        press(&mut harness, egui::Modifiers::NONE, key);
        assert_eq!(harness.state().viewport().settings.debug_view, view);
    }
    click(&mut harness, "View");
    harness.get_by_label_contains("Moisture").click();
    harness.run_steps(3);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Moisture);
    click(&mut harness, "Planet");
    harness.get_by_role_and_label(Role::TextInput, "Name of planet").focus();
    harness.run_steps(3);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Num2);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Moisture);
}

#[test]
fn frozen_detail_stays_while_the_camera_goes_on() {
    let mut harness = plain_editor(vec![]);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F6);
    let frozen = harness.state().viewport().surface().unwrap();
    let drawn = harness.state().viewport().stats().tiles_drawn;
    assert!(harness.query_by_label_contains("detail frozen").is_some());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F3);
    harness.key_down(egui::Key::W);
    harness.run_steps(60);
    harness.key_up(egui::Key::W);
    wait_for_picture(&mut harness);
    let viewport = harness.state().viewport();
    assert!(std::sync::Arc::ptr_eq(&frozen, &viewport.surface().unwrap()), "no tile was built");
    assert_eq!(viewport.stats().tiles_drawn, drawn, "culled as seen from the frozen eye");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F6);
    wait_for_picture(&mut harness);
    assert!(!std::sync::Arc::ptr_eq(&frozen, &harness.state().viewport().surface().unwrap()));
}

#[test]
fn bookmarks_are_added_gone_to_renamed_and_deleted_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let mut harness = plain_editor(vec![Some(path.clone())]);
    let names = |harness: &Editor| -> Vec<String> {
        let bookmarks = planet(harness).editor.map(|editor| editor.bookmarks).unwrap_or_default();
        bookmarks.into_iter().map(|bookmark| bookmark.name).collect()
    };
    let before = planet(&harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::B);
    assert_eq!(names(&harness), ["View 1"]);
    assert_eq!(undo_label(&harness), "Add bookmark");
    let here = harness.state().viewport().pose(&planet(&harness));

    press(&mut harness, egui::Modifiers::NONE, egui::Key::F4);
    wait_for_camera(&mut harness);
    send(&mut harness, Command::AddBookmark);
    assert_eq!(names(&harness), ["View 1", "View 2"]);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Num1);
    assert!(harness.state().viewport().is_moving(), "a flight, not a jump");
    wait_for_camera(&mut harness);
    assert_eq!(mode(&harness), Mode::Fly, "nobody stands in space");
    let now = harness.state().viewport().pose(&planet(&harness));
    let off_m = now.position_planet_m.distance(here.position_planet_m);
    assert!(off_m < 1.0, "{off_m} m off");
    assert!(now.planet_from_view.angle_between(here.planet_from_view) < 1e-3);

    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Num2);
    wait_for_camera(&mut harness);
    assert_eq!(mode(&harness), Mode::Walk, "on foot again");

    click(&mut harness, "Bookmarks");
    click(&mut harness, "View 2");
    click(&mut harness, "Rename…");
    let field = harness.get_by_role_and_label(Role::TextInput, "Name of the view");
    field.focus();
    harness.run_steps(2);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_role_and_label(Role::TextInput, "Name of the view").type_text("Beach");
    harness.run_steps(2);
    click(&mut harness, "Rename");
    assert_eq!(names(&harness), ["View 1", "Beach"]);
    assert_eq!(undo_label(&harness), "Rename bookmark");

    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::S);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("name: \"Beach\""), "{text}");
    assert_eq!(Planet::load(&path).unwrap(), planet(&harness));

    click(&mut harness, "Bookmarks");
    click(&mut harness, "View 1");
    click(&mut harness, "Delete");
    assert_eq!(names(&harness), ["Beach"]);
    for _ in 0..4 {
        send(&mut harness, Command::Undo);
    }
    assert_eq!(planet(&harness), before);
}

#[test]
fn every_key_stands_in_the_list_of_controls() {
    let mut harness = editor(vec![]);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F1);
    for text in ["Walk; slower uphill", "Keep this view in the preset", "Show where tiles meet"] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    press(&mut harness, egui::Modifiers::SHIFT, egui::Key::Questionmark);
    harness.run_steps(20);
    assert!(harness.query_by_label("Walk; slower uphill").is_none());
}

#[test]
fn what_lies_under_the_pointer_is_told_without_holding_up_the_picture() {
    let mut harness = plain_editor(vec![]);
    let rect = harness.get_by_role_and_label(Role::Canvas, "View of the planet").rect();
    harness.hover_at(rect.center());
    for _ in 0..200 {
        harness.step();
        if harness.state().viewport().under_pointer().is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let viewport = harness.state().viewport();
    let below = viewport.eye(&planet(&harness)).1;
    let under = viewport.under_pointer().unwrap().place;
    assert!(under.direction().distance(below.direction()) < 0.02, "{under:?} {below:?}");
    harness.hover_at(egui::pos2(rect.center().x, rect.bottom() + 10.0));
    harness.run_steps(3);
    assert!(harness.state().viewport().under_pointer().is_none());
}
