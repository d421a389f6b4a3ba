//! Other programs and windows on the open file; files that do not exist yet; desktops without file dialogs.

use super::app::{open_file, until};
use super::*;
use std::path::Path;
use tellus::editor::files::dialogs::{NoDialogs, ScriptedDialogs};

fn seeded(seed: u32) -> Planet {
    Planet { seed, ..Planet::default() }
}

/// A folder with a saved planet of seed 1.
fn saved() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    seeded(1).save(&path).unwrap();
    (folder, path)
}

fn opened(folder: &Path, path: &Path, answers: Vec<Option<PathBuf>>) -> Editor {
    open_file(Some(path), ScriptedDialogs::new(answers), &folder.join("recovery"))
}

fn is_asked(harness: &Editor) -> bool {
    harness.query_by_label("The file has changed on disk").is_some()
}

/// Changes the planet in the editor.
fn edit(harness: &mut Editor) {
    click(harness, "Planet");
    slide(harness, "Radius of planet", 2500.0);
}

#[test]
fn a_clean_document_follows_its_file() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    seeded(2).save(&path).unwrap();
    until(&mut harness, "read again", |harness| planet(harness).seed == 2);
    assert!(!is_asked(&harness) && !harness.state().document().is_dirty());
    assert_eq!(undo_label(&harness), "Reload from disk");
    // Written in place, as some text editors do.
    std::fs::write(&path, seeded(3).to_text()).unwrap();
    until(&mut harness, "read again", |harness| planet(harness).seed == 3);

    std::fs::write(&path, "(version: 3, sed: 4)").unwrap();
    until(&mut harness, "told", |harness| harness.query_by_label_contains("cannot be read").is_some());
    assert_eq!(planet(&harness).seed, 3);
    send(&mut harness, Command::Save);
    assert!(is_asked(&harness), "half-written work of somebody else is not written over");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "(version: 3, sed: 4)");
}

#[test]
fn own_saves_are_no_news() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    edit(&mut harness);
    let steps = undo_len(&harness);
    send(&mut harness, Command::Save);
    assert!(harness.query_by_label_contains("Saved to").is_some());
    for _ in 0..40 {
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(undo_len(&harness), steps);
    assert!(!is_asked(&harness) && !harness.state().document().is_dirty());
}

#[test]
fn a_document_with_changes_asks_whose_planet_it_is() {
    let (folder, path) = saved();
    let elsewhere = folder.path().join("elsewhere.ron");
    let mut harness = opened(folder.path(), &path, vec![Some(elsewhere.clone())]);
    edit(&mut harness);
    let mine = planet(&harness);
    let changes = |harness: &mut Editor, seed| {
        seeded(seed).save(&path).unwrap();
        until(harness, "asked", is_asked);
        assert_eq!(planet(harness), mine);
    };
    changes(&mut harness, 2);
    click(&mut harness, "Reload");
    assert_eq!((planet(&harness).seed, harness.state().document().is_dirty()), (2, false));
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness), mine, "what was reloaded over can be had back");

    changes(&mut harness, 3);
    click(&mut harness, "Keep mine");
    assert!(harness.state().document().is_dirty());
    send(&mut harness, Command::Save);
    assert!(!is_asked(&harness), "it was asked once");
    assert_eq!(Planet::load(&path).unwrap(), mine);

    slide(&mut harness, "Radius of planet", 2600.0);
    seeded(4).save(&path).unwrap();
    until(&mut harness, "asked", is_asked);
    click(&mut harness, "Save mine as…");
    harness.run_steps(3);
    assert_eq!(Planet::load(&elsewhere).unwrap(), planet(&harness));
    assert_eq!(Planet::load(&path).unwrap().seed, 4);
}

/// The save comes before the report of the watch.
#[test]
fn a_file_that_changed_is_never_written_over_in_silence() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    edit(&mut harness);
    let mine = planet(&harness);
    std::fs::write(&path, seeded(2).to_text()).unwrap();
    send(&mut harness, Command::Save);
    assert!(is_asked(&harness));
    assert_eq!(Planet::load(&path).unwrap().seed, 2);
    click(&mut harness, "Cancel");
    assert_eq!(Planet::load(&path).unwrap().seed, 2);
    send(&mut harness, Command::Save);
    click(&mut harness, "Save mine over it");
    assert_eq!(Planet::load(&path).unwrap(), mine);
    assert!(!harness.state().document().is_dirty());
}

/// A file that is dropped on the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn what_is_dropped_while_a_question_is_open_is_left_alone() {
    let (folder, path) = saved();
    let other = folder.path().join("other.ron");
    seeded(9).save(&other).unwrap();
    let mut harness = opened(folder.path(), &path, vec![]);
    let drop_other = |harness: &mut Editor| {
        harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(other.clone())));
        harness.run_steps(4);
    };
    edit(&mut harness);
    let mine = planet(&harness);
    seeded(2).save(&path).unwrap();
    until(&mut harness, "asked", is_asked);
    drop_other(&mut harness);
    assert!(is_asked(&harness) && harness.query_by_label("Save your changes?").is_none());
    click(&mut harness, "Keep mine");
    assert_eq!(planet(&harness), mine);
    send(&mut harness, Command::Save);
    drop_other(&mut harness);
    assert_eq!(planet(&harness).seed, 9);
}

#[test]
fn mine_that_was_to_be_saved_elsewhere_and_was_not_is_asked_about_again() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![None]);
    edit(&mut harness);
    seeded(2).save(&path).unwrap();
    until(&mut harness, "asked", is_asked);
    click(&mut harness, "Save mine as…");
    harness.run_steps(3);
    assert!(!is_asked(&harness), "the dialog was cancelled");
    send(&mut harness, Command::Save);
    assert!(is_asked(&harness));
    assert_eq!(Planet::load(&path).unwrap().seed, 2);
}

#[test]
fn a_file_that_is_no_text_is_saved_over_once_that_is_wanted() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    edit(&mut harness);
    std::fs::write(&path, b"(name: \"\xff\")").unwrap();
    send(&mut harness, Command::Save);
    assert!(is_asked(&harness) && harness.query_by_label_contains("not UTF-8").is_some());
    click(&mut harness, "Save mine over it");
    assert!(!is_asked(&harness), "it was asked once");
    assert_eq!(Planet::load(&path).unwrap(), planet(&harness));
}

/// Undo of the random planet leads back to the same file, which holds the random planet now.
#[test]
fn a_file_that_a_random_planet_was_saved_over_no_longer_holds_the_planet_before() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![Some(path.clone())]);
    send(&mut harness, Command::RandomPlanet);
    send(&mut harness, Command::SaveAs);
    assert_eq!(Planet::load(&path).unwrap(), planet(&harness));
    send(&mut harness, Command::Undo);
    assert_eq!((planet(&harness).seed, harness.state().document().path()), (1, Some(path.as_path())));
    assert!(harness.state().document().is_dirty(), "no file holds it");
    send(&mut harness, Command::Save);
    assert!(!is_asked(&harness) && !harness.state().document().is_dirty());
    assert_eq!(Planet::load(&path).unwrap().seed, 1);
}

#[test]
fn the_window_closes_while_a_path_is_typed() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open_file(None, NoDialogs, &folder.path().join("recovery"));
    let root = harness.ctx.viewport_id();
    let close = |harness: &mut Editor| {
        harness.input_mut().viewports.entry(root).or_default().events.push(egui::ViewportEvent::Close);
        harness.step();
        harness.output().viewport_output[&root].commands.contains(&egui::ViewportCommand::CancelClose)
    };
    send(&mut harness, Command::Open);
    assert!(harness.ctx.text_edit_focused());
    assert!(!close(&mut harness), "nothing is unsaved");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);

    edit(&mut harness);
    send(&mut harness, Command::Save);
    assert!(harness.ctx.text_edit_focused());
    assert!(close(&mut harness));
    harness.run_steps(2);
    assert!(harness.query_by_label("Save your changes?").is_some());
}

#[test]
fn a_file_that_is_gone_leaves_unsaved_work() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    std::fs::remove_file(&path).unwrap();
    until(&mut harness, "told", |harness| harness.query_by_label_contains("is gone from the disk").is_some());
    assert!(harness.state().document().is_dirty());
    // The file comes and goes again: the next look finds no file.
    std::fs::write(&path, "").unwrap();
    std::fs::remove_file(&path).unwrap();
    for _ in 0..40 {
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert!(harness.query_by_label_contains("is gone from the disk").is_some(), "still gone");
    send(&mut harness, Command::Save);
    assert_eq!(Planet::load(&path).unwrap().seed, 1);
    assert!(harness.query_by_label_contains("is gone from the disk").is_none());
}

#[test]
fn two_windows_on_one_file_know_of_each_other() {
    let (folder, path) = saved();
    let told = |harness: &Editor| harness.query_by_label_contains("open in another window").is_some();
    let mut first = opened(folder.path(), &path, vec![]);
    assert!(!told(&first));
    let mut second = opened(folder.path(), &path, vec![]);
    assert!(told(&second));
    until(&mut first, "told", told);
    // Saving is not blocked.
    edit(&mut second);
    send(&mut second, Command::Save);
    assert!(!second.state().document().is_dirty());
    // Dropped without eframe's `on_exit`, as in a crash.
    drop(second);
    until(&mut first, "alone again", |harness| !told(harness));
}

#[test]
fn a_name_that_does_not_exist_yet_is_a_new_planet() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ice-moon.ron");
    let mut harness = opened(folder.path(), &path, vec![]);
    assert_eq!(planet(&harness).name, "Ice moon");
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
    assert!(!path.exists() && !harness.state().document().is_dirty());
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::S);
    assert_eq!(Planet::load(&path).unwrap(), planet(&harness));

    let mut harness = opened(folder.path(), &folder.path().join("no/such.ron"), vec![]);
    assert!(harness.query_by_label_contains("there is no folder").is_some());
    click(&mut harness, "Dismiss");
    assert_eq!(harness.state().document().path(), None);
}

#[test]
fn without_file_dialogs_a_path_is_typed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("typed");
    let mut harness = open_file(None, NoDialogs, &folder.path().join("recovery"));
    let kind = |harness: &mut Editor, text: &str| {
        press(harness, egui::Modifiers::COMMAND, egui::Key::A);
        harness.get_by_role_and_label(Role::TextInput, "Path of the file").type_text(text);
        harness.run_steps(2);
        press(harness, egui::Modifiers::NONE, egui::Key::Enter);
        harness.run_steps(2);
    };
    edit(&mut harness);
    let mine = planet(&harness);
    send(&mut harness, Command::Save);
    assert!(harness.query_by_label_contains("no file dialogs").is_some());
    kind(&mut harness, folder.path().join("no/such").to_str().unwrap());
    assert!(harness.query_by_label_contains("There is no folder").is_some());
    kind(&mut harness, path.to_str().unwrap());
    let written = path.with_extension("ron");
    assert_eq!(Planet::load(&written).unwrap(), mine);
    assert_eq!(harness.state().document().path(), Some(written.as_path()));

    // An existing file is not replaced without a question.
    seeded(7).save(folder.path().join("other.ron")).unwrap();
    send(&mut harness, Command::SaveAs);
    kind(&mut harness, folder.path().join("other.ron").to_str().unwrap());
    assert!(harness.query_by_label("Replace the file?").is_some());
    click(&mut harness, "Cancel");

    send(&mut harness, Command::Open);
    kind(&mut harness, folder.path().join("other.ron").to_str().unwrap());
    assert_eq!(planet(&harness).seed, 7);

    send(&mut harness, Command::ExportTable);
    kind(&mut harness, folder.path().join("table").to_str().unwrap());
    assert!(folder.path().join("table.png").exists());
    send(&mut harness, Command::ImportTable);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(harness.query_by_label("Path of the file").is_none(), "Escape is enough to leave");
}

#[test]
fn the_differences_are_shown_before_one_decides() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    edit(&mut harness);
    Planet { settlements: 2.0, ..seeded(1) }.save(&path).unwrap();
    until(&mut harness, "asked", is_asked);
    click(&mut harness, "Show the 2 differences");
    harness.run_steps(20);
    assert!(harness.query_by_label("radius: 2500 km, in the file 6371 km").is_some());
    assert!(harness.query_by_label("settlements: 0, in the file 2").is_some());
}

#[test]
fn revert_goes_back_to_the_file_and_undo_back_again() {
    let (folder, path) = saved();
    let mut harness = opened(folder.path(), &path, vec![]);
    let before = planet(&harness);
    edit(&mut harness);
    let mine = planet(&harness);
    send(&mut harness, Command::Revert);
    assert_eq!((planet(&harness), harness.state().document().is_dirty()), (before, false));
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness), mine);
}

#[test]
fn files_that_were_open_are_listed_and_the_last_one_opens_again() {
    let (folder, path) = saved();
    let other = folder.path().join("other.ron");
    seeded(7).save(&other).unwrap();
    drop(opened(folder.path(), &path, vec![]));
    drop(opened(folder.path(), &other, vec![]));
    let mut harness = open_file(None, NoDialogs, &folder.path().join("recovery"));
    assert_eq!((planet(&harness).seed, harness.state().document().path()), (7, Some(other.as_path())));
    click(&mut harness, "File");
    click(&mut harness, "Open recent");
    assert!(harness.query_by_label("other.ron").is_none(), "it is open");
    click(&mut harness, "mine.ron");
    assert_eq!(planet(&harness).seed, 1);
    // A file that is gone is no reason to start with a question.
    std::fs::remove_file(&path).unwrap();
    drop(harness);
    let harness = open_file(None, NoDialogs, &folder.path().join("recovery"));
    assert_eq!(harness.state().document().path(), None);
}
