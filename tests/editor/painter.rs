//! The painter of the biome table.

use crate::app::{
    Editor, canvas, click, drag_row_below, planet, point_at_planet, send, undo_label, undo_len, until, wait_for_picture,
};
use crate::dice::Dice;
use crate::png::{changed_png, pick};
use crate::press;
use eframe::egui;
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;
use std::sync::Arc;
use tellus::editor::command::Command;
use tellus::editor::painter::table_png;
use tellus::planet::{Biomes, STARTING_TABLES};
use tellus::terrain::Terrain;

/// An editor on the biomes tab, without a picture; file dialogs give these answers.
fn editor(answers: Vec<Option<PathBuf>>) -> Editor {
    let mut harness = crate::app::open([1024.0, 760.0], answers);
    click(&mut harness, "Biomes");
    harness
}

/// An editor on the biomes tab, its picture complete.
fn drawn_editor() -> Editor {
    on_biomes(crate::app::open_with_picture([1024.0, 760.0], vec![]))
}

fn on_biomes(mut harness: Editor) -> Editor {
    // A debug view is drawn fast: without sky and sea.
    send(&mut harness, Command::Show(tellus::render::DebugView::Biome));
    click(&mut harness, "Biomes");
    wait_for_picture(&mut harness);
    harness
}

fn biomes(harness: &Editor) -> Biomes {
    planet(harness).biomes
}

fn undo(harness: &mut Editor) {
    send(harness, Command::Undo);
}

/// The middle of a cell on screen.
fn cell(harness: &Editor, column: usize, row: usize) -> egui::Pos2 {
    let table = biomes(harness).table;
    let rect = harness.get_by_label("Biome table").rect();
    let size = rect.size() / egui::vec2(table.columns() as f32, table.rows().len() as f32);
    rect.min + size * egui::vec2(column as f32 + 0.5, row as f32 + 0.5)
}

/// Presses in the first cell, moves over the others and releases in the last.
fn stroke(harness: &mut Editor, cells: &[(usize, usize)]) {
    let at: Vec<egui::Pos2> = cells.iter().map(|&(column, row)| cell(harness, column, row)).collect();
    harness.hover_at(at[0]);
    harness.run_steps(1);
    harness.drag_at(at[0]);
    harness.run_steps(1);
    for &pos in &at[1..] {
        harness.hover_at(pos);
        harness.run_steps(1);
    }
    harness.drop_at(*at.last().unwrap());
    harness.run_steps(2);
}

fn choose(harness: &mut Editor, index: usize) -> char {
    let biome = biomes(harness).palette[index].clone();
    click(harness, &format!("Biome {}", biome.name));
    biome.key
}

fn count(biomes: &Biomes, key: char) -> usize {
    biomes.table.rows().iter().map(|row| row.matches(key).count()).sum()
}

#[test]
fn strokes_lines_rectangles_and_fills_are_one_step_each() {
    let mut harness = editor(vec![]);
    let before = biomes(&harness);
    let key = choose(&mut harness, 3);
    let steps = undo_len(&harness);
    stroke(&mut harness, &[(1, 1), (2, 1), (5, 1)]);
    let painted = biomes(&harness);
    (1..=5).for_each(|column| assert_eq!(painted.table.key(column, 1), Some(key), "column {column}"));
    assert_eq!((undo_len(&harness), undo_label(&harness)), (steps + 1, "Paint biomes".to_owned()));

    click(&mut harness, "Line");
    stroke(&mut harness, &[(0, 3), (9, 9), (4, 7)]);
    let lined = biomes(&harness);
    (0..=4).for_each(|i| assert_eq!(lined.table.key(i, 3 + i), Some(key), "step {i}"));
    assert_ne!(lined.table.key(9, 9), Some(key), "a line follows the pointer back");
    assert_eq!((undo_len(&harness), undo_label(&harness)), (steps + 2, "Draw line".to_owned()));

    click(&mut harness, "Rectangle");
    stroke(&mut harness, &[(10, 2), (12, 5)]);
    let boxed = biomes(&harness);
    (10..=12).for_each(|column| (2..=5).for_each(|row| assert_eq!(boxed.table.key(column, row), Some(key))));
    assert_eq!((undo_len(&harness), undo_label(&harness)), (steps + 3, "Draw rectangle".to_owned()));

    click(&mut harness, "Fill");
    let other = choose(&mut harness, 0);
    stroke(&mut harness, &[(11, 3)]);
    assert_eq!(biomes(&harness).table.key(12, 5), Some(other));
    assert_eq!((undo_len(&harness), undo_label(&harness)), (steps + 4, "Fill biome".to_owned()));

    for expected in [&boxed, &lined, &painted, &before] {
        undo(&mut harness);
        assert_eq!(biomes(&harness), *expected);
    }
}

/// The table has the focus after a stroke; keys with Ctrl still belong to the window.
#[test]
fn the_keys_of_undo_work_after_a_stroke() {
    let mut harness = editor(vec![]);
    let before = biomes(&harness);
    choose(&mut harness, 3);
    stroke(&mut harness, &[(1, 1), (2, 1), (5, 1)]);
    let painted = biomes(&harness);
    assert_ne!(painted, before);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(biomes(&harness), before);
    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::Z);
    assert_eq!(biomes(&harness), painted);
}

#[test]
fn letters_and_the_right_button_choose_biomes_and_a_selection_confines() {
    let mut harness = editor(vec![]);
    let before = biomes(&harness);
    let palette = &before.palette;
    let (letter, name) = (palette[5].key, palette[5].name.clone());
    harness.hover_at(cell(&harness, 4, 4));
    harness.run_steps(2);
    harness.event(egui::Event::Text(letter.to_string()));
    harness.run_steps(2);
    assert!(harness.query_by_label(&format!("Key of {name}")).is_some(), "its parameters are shown");

    click(&mut harness, "Select");
    stroke(&mut harness, &[(2, 2), (4, 4)]);
    assert_eq!(undo_len(&harness), 0, "to select is no edit");
    click(&mut harness, "Rectangle");
    stroke(&mut harness, &[(0, 0), (9, 9)]);
    let table = biomes(&harness).table;
    for row in 0..10 {
        for column in 0..10 {
            let inside = (2..=4).contains(&column) && (2..=4).contains(&row);
            let expected = if inside { Some(letter) } else { before.table.key(column, row) };
            assert_eq!(table.key(column, row), expected, "{column} {row}");
        }
    }
}

#[test]
fn painting_rebuilds_no_vertex_and_shows_in_the_next_frame() {
    let mut harness = drawn_editor();
    let below = harness.state().viewport().eye(&planet(&harness)).1;
    let [column, row] = Terrain::try_new(Arc::new(planet(&harness))).unwrap().sample(below.direction()).cell;
    // A biome without biome relief, other than the one there.
    let all = biomes(&harness);
    let has_relief = |key: char| all.index_of(key).is_some_and(|index| all.palette[index].relief_m != 0.0);
    let old = all.table.key(column, row).unwrap();
    let index = all.palette.iter().position(|biome| biome.key != old && !has_relief(biome.key)).unwrap();
    assert!(!has_relief(old), "choose another location");
    choose(&mut harness, index);
    harness.hover_at(cell(&harness, column, row));
    wait_for_picture(&mut harness);
    let viewport = harness.state().viewport();
    let (surface, runs, pictures) = (viewport.surface().unwrap(), viewport.lut_runs().unwrap(), viewport.pictures());
    harness.drag_at(cell(&harness, column, row));
    harness.step();
    let viewport = harness.state().viewport();
    assert!(viewport.pictures() > pictures, "drawn in the frame of the press");
    assert!(viewport.lut_runs().unwrap().biomes > runs.biomes);
    harness.drop_at(cell(&harness, column, row));
    wait_for_picture(&mut harness);
    let after = harness.state().viewport().surface().unwrap();
    assert!(after.leaves.iter().zip(&surface.leaves).all(|(a, b)| a.tile.serial == b.tile.serial), "the same tiles");
    assert_eq!(after.leaves.len(), surface.leaves.len());
}

#[test]
fn after_an_undo_no_preview_covers_what_came_back() {
    let mut harness = drawn_editor();
    let marked = |harness: &Editor| harness.state().viewport().tab.marked.clone();
    choose(&mut harness, 3);
    for tool in ["Fill", "Brush"] {
        click(&mut harness, tool);
        let before = biomes(&harness);
        harness.hover_at(cell(&harness, 4, 4));
        harness.run_steps(2);
        assert!(marked(&harness).is_some(), "{tool}: a preview");
        stroke(&mut harness, &[(4, 4)]);
        // Away and back: the preview of the next stroke.
        harness.hover_at(cell(&harness, 9, 9));
        harness.run_steps(2);
        harness.hover_at(cell(&harness, 4, 4));
        harness.run_steps(2);
        assert!(marked(&harness).is_some(), "{tool}: the next preview");
        undo(&mut harness);
        assert_eq!(biomes(&harness), before);
        assert!(marked(&harness).is_none(), "{tool}: what came back is seen");
        harness.hover_at(cell(&harness, 5, 4));
        harness.run_steps(2);
        assert!(marked(&harness).is_some(), "{tool}: the pointer went on");
    }
}

#[test]
fn the_planet_and_the_table_point_at_each_other() {
    let mut harness = drawn_editor();
    let marked = |harness: &Editor| harness.state().viewport().tab.marked.clone();
    assert!(marked(&harness).is_none());
    harness.hover_at(cell(&harness, 7, 5));
    harness.run_steps(2);
    let cells = marked(&harness).unwrap();
    assert!(cells.contains(7, 5) && cells.count() == 1, "the cell lights up on the planet");
    click(&mut harness, "Highlight");
    harness.hover_at(cell(&harness, 7, 5));
    harness.run_steps(2);
    assert!(marked(&harness).is_none());

    let under = point_at_planet(&mut harness);
    let sample = Terrain::try_new(Arc::new(planet(&harness))).unwrap().sample(under.location.direction());
    assert_eq!((under.sample.cell, under.sample.biome), (sample.cell, sample.biome));
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Here: ").is_some(), "the table says which cell that is");
}

#[test]
fn the_eyedropper_picks_on_the_planet_and_ctrl_paints_its_climate() {
    let mut harness = drawn_editor();
    let rect = canvas(&harness);
    let under = point_at_planet(&mut harness);
    let name = biomes(&harness).palette[under.sample.biome].name.clone();
    let other = (under.sample.biome + 3) % biomes(&harness).palette.len();
    choose(&mut harness, other);
    click(&mut harness, "Eyedropper");
    let press = |harness: &mut Editor, modifiers: egui::Modifiers| {
        harness.hover_at(rect.center());
        harness.run_steps(2);
        harness.event(egui::Event::ModifiersChanged(modifiers));
        for pressed in [true, false] {
            let button = egui::PointerButton::Primary;
            harness.event(egui::Event::PointerButton { pos: rect.center(), button, pressed, modifiers });
            harness.run_steps(1);
        }
        harness.event(egui::Event::ModifiersChanged(egui::Modifiers::NONE));
    };
    press(&mut harness, egui::Modifiers::NONE);
    let label = format!("Key of {name}");
    until(&mut harness, "picked", |harness| harness.query_by_label(&label).is_some());
    assert_eq!(undo_len(&harness), 0);

    let key = choose(&mut harness, other);
    let before = biomes(&harness);
    press(&mut harness, egui::Modifiers::COMMAND);
    until(&mut harness, "painted", |harness| undo_len(harness) == 1);
    assert_eq!(undo_label(&harness), "Paint climate of location");
    let mut expected = before.clone();
    expected.table.set_key(under.sample.cell[0], under.sample.cell[1], key);
    assert_eq!(biomes(&harness), expected, "that very cell and no other");
    undo(&mut harness);
    assert_eq!(biomes(&harness), before);
}

#[test]
fn the_palette_is_reordered_by_dragging_and_renamed_in_place() {
    let mut harness = editor(vec![]);
    let before = biomes(&harness);
    let row = |index: usize| format!("Biome {}", before.palette[index].name);
    drag_row_below(&mut harness, &row(0), &row(2));
    let after = biomes(&harness);
    let keys = |biomes: &Biomes| -> String { biomes.palette.iter().take(3).map(|biome| biome.key).collect() };
    let old: Vec<char> = keys(&before).chars().collect();
    assert_eq!(keys(&after), format!("{}{}{}", old[1], old[2], old[0]));
    assert_eq!((undo_len(&harness), undo_label(&harness)), (1, "Move biome".to_owned()));
    assert_eq!(after.table, before.table);
}

#[test]
fn a_ready_made_table_goes_out_as_a_picture_and_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mars.png");
    let mut harness = editor(vec![Some(path.clone()), Some(path.clone())]);
    click(&mut harness, "Tables");
    click(&mut harness, "Mars");
    let mars = biomes(&harness);
    assert_eq!(undo_label(&harness), "Start from table: Mars");
    assert!(mars.palette.iter().any(|biome| biome.name == "Dust"));
    send(&mut harness, Command::ExportTable);
    let picture = image::open(&path).unwrap();
    assert_eq!((picture.width() as usize, picture.height() as usize), (mars.table.columns(), mars.table.rows().len()));

    let key = choose(&mut harness, 0);
    click(&mut harness, "Rectangle");
    stroke(&mut harness, &[(0, 0), (15, 11)]);
    assert_eq!(count(&biomes(&harness), key), 16 * 12);
    send(&mut harness, Command::ImportTable);
    assert_eq!(biomes(&harness), mars);
    assert_eq!(undo_label(&harness), "Import biome table");

    std::fs::write(&path, b"no picture").unwrap();
    let mut harness = editor(vec![Some(path)]);
    send(&mut harness, Command::ImportTable);
    assert!(harness.query_by_label("The biome table could not be imported").is_some());
}

/// A golden picture of the panel, drawn by Mesa's software driver and made again with `UPDATE_SNAPSHOTS=1`. Other tests
/// compare the planet beside it.
#[test]
fn the_painter_looks_as_it_did() {
    let mut harness = on_biomes(crate::app::open_drawn([1024.0, 760.0], vec![], 60.0, 1.0));
    choose(&mut harness, 3);
    wait_for_picture(&mut harness);
    let picture = harness.render().unwrap();
    // Without the planet to the left, and without the times in the status bar below.
    let (left, height) = (picture.width() * 61 / 100, picture.height() * 94 / 100);
    let panel = image::imageops::crop_imm(&picture, left, 0, picture.width() - left, height).to_image();
    let options = egui_kittest::SnapshotOptions::new().threshold(1.0).max_failed_pixels(200);
    egui_kittest::image_snapshot_options(&panel, "painter", &options);
}

/// Pictures of strangers: read or refused, never more.
#[test]
fn ten_thousand_changed_pictures_of_tables_are_read_or_refused() {
    let mut dice = Dice(11);
    let tables = STARTING_TABLES.iter().map(|start| start.biomes().unwrap());
    let tables: Vec<(Biomes, Vec<u8>)> =
        tables.map(|biomes| (biomes.clone(), table_png::encode(&biomes).unwrap())).collect();
    let mut read = 0;
    for _ in 0..10_000 {
        let (biomes, png) = &tables[pick(&mut dice, tables.len())];
        match table_png::decode(&changed_png(png, &mut dice), biomes) {
            Ok(imported) => {
                let rows = imported.table.rows();
                assert!(rows.iter().all(|row| row.chars().all(|key| biomes.index_of(key).is_some())));
                read += 1;
            }
            Err(why) => assert!(!why.is_empty() && why.len() < 300 && !why.contains(char::is_control), "{why}"),
        }
    }
    assert!((50..9_900).contains(&read), "{read}");
}
