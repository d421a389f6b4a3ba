//! Maps for other programs, baked from the window.

use crate::app::{self, Editor, click, send, until};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use tellus::bake::{Format, Map};
use tellus::editor::command::{Action, BakeAction, Command};
use tellus::editor::state::baking::{BakeSettings, Form};

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
    let eye = {
        let viewport = harness.state().viewport();
        viewport.eye(harness.state().document().valid_planet()).1.to_degrees()
    };
    let region = harness.state().bake_settings().region;
    assert_eq!((region.lat_deg, region.lon_deg), eye);
}

#[test]
fn what_cannot_be_baked_is_not_offered() {
    let mut harness = open(vec![]);
    let raw = BakeSettings { maps: vec![Map::Normal], format: Format::R16, ..small() };
    set(&mut harness, raw);
    let button = |harness: &Editor| {
        use egui_kittest::kittest::NodeT as _;
        harness.get_by_role_and_label(Role::Button, "Bake into folder…").accesskit_node().is_disabled()
    };
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
