//! Maps, meshes and tiles for other programs, baked from the window.

use crate::app::{self, Editor, click, send, until};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use tellus::bake::{Format, Map, Quadtree, Region};
use tellus::editor::command::{Action, BakeAction, Command};
use tellus::editor::state::bake_settings::{BakeSettings, Form, MeshChoice, Product, TilesChoice};

fn open(answers: Vec<Option<PathBuf>>) -> Editor {
    let mut harness = app::open([1280.0, 800.0], answers);
    send(&mut harness, Command::Bake);
    harness
}

fn set(harness: &mut Editor, settings: BakeSettings) {
    harness.state_mut().push(Action::Bake(BakeAction::Set(Box::new(settings))));
    harness.run_steps(4);
}

fn small() -> BakeSettings {
    BakeSettings { size: 64, ..BakeSettings::default() }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn chosen_maps_are_baked_into_a_folder_and_a_notice_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(vec![Some(folder.path().to_owned())]);
    set(&mut harness, small());
    click(&mut harness, "Normal");
    click(&mut harness, "Slope");
    assert_eq!(harness.state().bake_settings().maps, [Map::Height, Map::Slope, Map::Albedo]);
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "the maps are there", |harness| harness.query_by_label_contains("Saved 3 maps").is_some());
    let expected = ["albedo.json", "albedo.png", "height.json", "height.png", "slope.json", "slope.png"];
    assert_eq!(names(folder.path()), expected);
    let height = image::open(folder.path().join("height.png")).unwrap();
    assert_eq!((height.width(), height.height()), (64, 32));
}

#[test]
fn a_cube_has_six_faces_and_a_region_lies_where_it_was_set() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(vec![Some(folder.path().to_owned())]);
    set(&mut harness, BakeSettings { maps: vec![Map::Height], form: Form::Cube, size: 16, ..BakeSettings::default() });
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "the faces are there", |harness| harness.query_by_label_contains("Saved 6 maps").is_some());
    assert!(names(folder.path()).contains(&"height_neg_z.png".to_owned()));
    click(&mut harness, "Region");
    click(&mut harness, "Here");
    let region = harness.state().bake_settings().region;
    assert_eq!((region.lat_deg, region.lon_deg), looked_at(&harness));
}

#[test]
fn a_landscape_and_a_quadtree_are_tiles() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let mut harness = open(folders.iter().map(|folder| Some(folder.path().to_owned())).collect());
    set(&mut harness, BakeSettings { maps: vec![Map::Height], ..BakeSettings::default() });
    click(&mut harness, "Landscape");
    assert_eq!(harness.state().bake_settings().size, 1009);
    assert!(harness.query_by_label("Tiles of landscape").is_some() && harness.query_by_label("Here").is_some());
    let now = harness.state().bake_settings().clone();
    set(&mut harness, BakeSettings { size: 9, ..now });
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "the tiles are there", |harness| harness.query_by_label_contains("Saved 4 maps").is_some());
    assert!(names(folders[0].path()).contains(&"height_x1_y1.png".to_owned()), "{:?}", names(folders[0].path()));

    let now = harness.state().bake_settings().clone();
    set(&mut harness, BakeSettings { size: 1009, ..now });
    click(&mut harness, "Quadtree");
    assert_eq!(harness.state().bake_settings().size, 256);
    let now = harness.state().bake_settings().clone();
    let quadtree = Quadtree { levels: 1, apron: 1 };
    set(&mut harness, BakeSettings { size: 16, quadtree, ..now });
    assert!(harness.query_by_label_contains("30 tiles of 18 × 18").is_some());
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "all levels are there", |harness| harness.query_by_label_contains("Saved 30 maps").is_some());
}

fn looked_at(harness: &Editor) -> (f64, f64) {
    let editor = harness.state();
    editor.viewport().looked_at(editor.document().valid_planet()).0.to_degrees()
}

#[test]
fn a_region_begins_where_the_camera_looks_and_stays_where_it_was_set() {
    let mut harness = open(vec![]);
    let region = harness.state().bake_settings().region;
    assert_eq!((region.lat_deg, region.lon_deg), looked_at(&harness));
    assert!(region.lat_deg != 0.0 && region.side_km > 1.0, "{region:?}");
    let own = Region { lat_deg: -7.0, lon_deg: 5.0, side_km: 12.0 };
    set(&mut harness, BakeSettings { region: own, ..small() });
    for _ in 0..2 {
        send(&mut harness, Command::Bake);
    }
    assert_eq!(harness.state().bake_settings().region, own);
}

#[test]
fn a_mesh_is_baked_into_a_file_that_is_replaced_only_with_leave() {
    let folder = tempfile::tempdir().unwrap();
    let typed = folder.path().join("globe");
    let file = folder.path().join("globe.glb");
    std::fs::write(&file, "another's").unwrap();
    let mut harness = open(vec![Some(typed.clone()), Some(typed)]);
    set(&mut harness, coarse_mesh());
    for answer in ["Cancel", "Replace"] {
        click(&mut harness, "Bake into file…");
        until(&mut harness, "the question", |harness| harness.query_by_label("Replace the file?").is_some());
        click(&mut harness, answer);
        if answer == "Cancel" {
            assert_eq!(std::fs::read(&file).unwrap(), b"another's");
        }
    }
    until(&mut harness, "the mesh is there", |harness| harness.query_by_label_contains("Saved /").is_some());
    let bytes = std::fs::read(&file).unwrap();
    assert_eq!(
        (&bytes[..4], bytes.len()),
        (&b"glTF"[..], u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize)
    );
    assert_eq!(names(folder.path()), ["globe.glb"]);
}

fn coarse_mesh() -> BakeSettings {
    let mesh = MeshChoice { spacing_m: Some(2e6), texture_px: None, ..BakeSettings::default().mesh };
    BakeSettings { product: Product::Mesh, mesh, ..BakeSettings::default() }
}

#[test]
fn tiles_are_baked_into_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(vec![Some(folder.path().to_owned())]);
    let tiles = TilesChoice { levels: 1, cells: 4, texture_px: None, ..BakeSettings::default().tiles };
    set(&mut harness, BakeSettings { product: Product::Tiles, tiles, ..BakeSettings::default() });
    assert!(harness.query_by_label_contains("30 tiles, vertices").is_some());
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "the tiles are there", |harness| harness.query_by_label_contains("Saved 30 tiles").is_some());
    assert_eq!(names(folder.path()), ["0", "1", "tiles.key", "tileset.json"]);
}

#[test]
fn tiles_have_whole_numbers_and_subtrees_if_they_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(vec![Some(folder.path().to_owned())]);
    let tiles = TilesChoice { levels: 1, cells: 4, texture_px: None, ..BakeSettings::default().tiles };
    set(&mut harness, BakeSettings { product: Product::Tiles, tiles, ..BakeSettings::default() });
    click(&mut harness, "Whole numbers");
    click(&mut harness, "Implicit");
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "the tiles are there", |harness| harness.query_by_label_contains("Saved 30 tiles").is_some());
    assert_eq!(names(folder.path()), ["0", "1", "subtrees", "tiles.key", "tileset.json"]);
    let tile = std::fs::read(folder.path().join("0/pos_x_0_0.glb")).unwrap();
    assert!(tile.windows(21).any(|bytes| bytes == b"KHR_mesh_quantization"));
}

#[test]
fn what_is_wrong_with_a_mesh_or_tiles_is_told_in_the_window() {
    let mut harness = open(vec![]);
    click(&mut harness, "Mesh");
    assert!(!is_disabled(&harness, "Bake into file…"));
    let mut settings = coarse_mesh();
    settings.mesh.spacing_m = Some(1.0);
    set(&mut harness, settings);
    assert!(harness.query_by_label_contains("more than 8 million vertices").is_some());
    assert!(is_disabled(&harness, "Bake into file…"));
    click(&mut harness, "3D tiles");
    let tiles = TilesChoice { levels: 12, ..BakeSettings::default().tiles };
    set(&mut harness, BakeSettings { product: Product::Tiles, tiles, ..BakeSettings::default() });
    assert!(harness.query_by_label_contains("use fewer levels, or a region").is_some());
    assert!(is_disabled(&harness, "Bake into folder…"));
}

#[test]
fn a_mesh_that_is_stopped_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(vec![Some(folder.path().join("globe.obj"))]);
    set(&mut harness, BakeSettings { product: Product::Mesh, ..BakeSettings::default() });
    click(&mut harness, "Bake into file…");
    until(&mut harness, "the bake is under way", |harness| harness.query_by_label("Stop").is_some());
    click(&mut harness, "Stop");
    until(&mut harness, "it has stopped", |harness| harness.query_by_label_contains("was not written").is_some());
    assert_eq!(names(folder.path()), [""; 0]);
}

fn is_disabled(harness: &Editor, label: &str) -> bool {
    use egui_kittest::kittest::NodeT as _;
    harness.get_by_role_and_label(Role::Button, label).accesskit_node().is_disabled()
}

#[test]
fn what_cannot_be_baked_is_not_offered() {
    let mut harness = open(vec![]);
    let raw = BakeSettings { maps: vec![Map::Normal], format: Format::R16, ..small() };
    set(&mut harness, raw);
    let button = |harness: &Editor| is_disabled(harness, "Bake into folder…");
    assert!(button(&harness), "r16 holds one channel");
    set(&mut harness, BakeSettings { maps: vec![], ..small() });
    assert!(button(&harness), "no map is chosen");
    set(&mut harness, small());
    assert!(!button(&harness));
}

#[test]
fn a_bake_that_cannot_be_written_says_where_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("taken");
    std::fs::write(&file, "").unwrap();
    let mut harness = open(vec![Some(file)]);
    set(&mut harness, small());
    click(&mut harness, "Bake into folder…");
    until(&mut harness, "the message", |harness| harness.query_by_label("The maps could not be baked").is_some());
    assert!(harness.query_by_label_contains("is a file; name a folder").is_some());
}

#[test]
fn the_small_picture_follows_the_map_that_was_clicked_last() {
    let mut harness = open(vec![]);
    until(&mut harness, "the small picture", |harness| harness.query_by_label_contains("Height: ").is_some());
    click(&mut harness, "Temperature");
    until(&mut harness, "the other map", |harness| harness.query_by_label_contains("Temperature: ").is_some());
}
