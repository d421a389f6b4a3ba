//! The library: keeping, finding, taking and removing planets and parts.

use crate::app::{self, Editor, canvas, click, drag, planet, send, undo_label, until};
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use tellus::editor::command::{Action, Command, LibraryAction};
use tellus::editor::files::dialogs::ScriptedDialogs;
use tellus::planet::shipped;

fn open(folder: &Path) -> Editor {
    let mut harness = app::open_file(None, ScriptedDialogs::default(), folder);
    send(&mut harness, Command::Library);
    until_listed(&mut harness, "Aurel: earth-like");
    harness
}

fn until_listed(harness: &mut Editor, name: &'static str) {
    until(harness, name, |harness| harness.query_all_by_label(name).next().is_some());
    harness.run_steps(3);
}

fn keep(harness: &mut Editor, part: &'static str, name: &'static str) {
    harness.state_mut().push(Action::Library(LibraryAction::Keep(part)));
    until_listed(harness, name);
}

fn open_cinnabar(harness: &mut Editor) {
    let cinnabar = shipped::ALL.iter().position(|preset| preset.file == "cinnabar.ron").unwrap();
    harness.state_mut().push(Action::OpenShipped(cinnabar));
    harness.run_steps(6);
}

#[test]
fn a_part_that_was_kept_is_taken_into_another_planet_as_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let clouds = planet(&harness).clouds;
    click(&mut harness, "Keep …");
    click(&mut harness, "Its clouds");
    let name = "Layered clouds";
    until_listed(&mut harness, name);
    assert!(folder.path().join("library").join(format!("{name}.ron")).is_file());
    open_cinnabar(&mut harness);
    until_listed(&mut harness, name);
    assert_ne!(planet(&harness).clouds, clouds);
    let layers = planet(&harness).layers;
    harness.get_by_role_and_label(Role::Button, name).click();
    harness.run_steps(4);
    assert_eq!((planet(&harness).clouds, planet(&harness).layers), (clouds, layers));
    assert_eq!(undo_label(&harness), format!("Take {name} from library"));
}

#[test]
fn words_and_tags_narrow_the_list_down() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let shown = |harness: &Editor, name: &str| harness.query_all_by_label_contains(name).next().is_some();
    assert!(shown(&harness, "Aurel: earth-like") && shown(&harness, "Pallor: moon"));
    click(&mut harness, "airless");
    assert!(!shown(&harness, "Aurel: earth-like") && shown(&harness, "Pallor: moon"));
    click(&mut harness, "airless");
    harness.get_by_label("Search the library").focus();
    harness.run_steps(2);
    app::type_text(&mut harness, "xyzzy");
    assert!(harness.query_by_label("Nothing here has all of these words.").is_some());
}

#[test]
fn an_item_dropped_on_the_planet_is_taken_and_undo_brings_the_planet_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let water = planet(&harness).water;
    keep(&mut harness, "water", "Layered water");
    open_cinnabar(&mut harness);
    until_listed(&mut harness, "Layered water");
    assert_ne!(planet(&harness).water, water);
    let from = harness.get_all_by_label("Layered water").next().unwrap().rect().center();
    let to = canvas(&harness).right_bottom() - eframe::egui::vec2(30.0, 30.0);
    drag(&mut harness, from, to);
    harness.run_steps(4);
    assert_eq!(planet(&harness).water, water);
    let before = planet(&harness);
    let from = harness.get_all_by_label("Aurel: earth-like").next().unwrap().rect().center();
    drag(&mut harness, from, to);
    harness.run_steps(4);
    assert_eq!(planet(&harness).name, "Aurel");
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness), before);
}

#[test]
fn what_is_removed_moves_aside() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    keep(&mut harness, "", "Layered");
    let file = folder.path().join("library").join("Layered.ron");
    assert!(file.is_file());
    // The list is read in the background.
    for _ in 0..200 {
        harness.state_mut().push(Action::Library(LibraryAction::Remove(0)));
        harness.run_steps(6);
        if !file.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert!(!file.exists() && folder.path().join("library/removed/Layered.ron").is_file());
}
