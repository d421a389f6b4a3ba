//! What is left after a crash or the loss of the graphics device, and what is told of it.

use super::app::{open_after_loss, open_file, open_watched, until};
use super::*;
use std::cell::Cell;
use std::rc::Rc;
use tellus::editor::files::dialogs::NoDialogs;

/// An editor with unsaved work, which is given too.
fn with_work(folder: &std::path::Path, restarts: &Rc<Cell<u32>>) -> (Editor, Planet) {
    let restarts = restarts.clone();
    let mut harness = open_watched(folder, move || {
        restarts.set(restarts.get() + 1);
        Ok(())
    });
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);
    (harness, edited)
}

#[test]
fn a_lost_device_leaves_the_work_to_the_next_editor() {
    let folder = tempfile::tempdir().unwrap();
    let restarts = Rc::new(Cell::new(0));
    let (mut harness, edited) = with_work(folder.path(), &restarts);
    harness.state().device().note_lost("gone".to_owned());
    harness.run_steps(3);
    assert_eq!(restarts.get(), 1);
    // The old editor is still ending while the new one begins.
    let next = open_file(None, NoDialogs, folder.path());
    assert!(next.query_by_label("Recover unsaved work?").is_some());
    drop((harness, next));
    let app = open_after_loss(folder.path());
    assert_eq!(planet(&app), edited);
    assert!(app.query_by_label_contains("your work is as it was").is_some());
}

#[test]
fn work_that_a_crash_left_is_offered_to_one_editor() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, edited) = with_work(folder.path(), &Rc::default());
    until(&mut harness, "a working copy", |_| folder.path().join("recovery-0.ron").exists());
    drop(harness);
    let mut first = open_file(None, NoDialogs, folder.path());
    let second = open_file(None, NoDialogs, folder.path());
    assert!(first.query_by_label("Recover unsaved work?").is_some());
    assert!(second.query_by_label("Recover unsaved work?").is_none());
    click(&mut first, "Recover");
    assert_eq!(planet(&first), edited);
}

#[test]
fn an_error_of_the_device_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, _) = with_work(folder.path(), &Rc::default());
    let error = || "Validation Error\n\nCaused by:\n  a texture".to_owned();
    harness.state().device().note_error(error());
    harness.run_steps(2);
    assert!(harness.query_by_label("The graphics device reports an error").is_some());
    assert!(harness.query_by_label("Validation Error").is_some());
    click(&mut harness, "Dismiss");
    harness.state().device().note_error(error());
    harness.run_steps(2);
    assert!(harness.query_by_label("The graphics device reports an error").is_none());
}

#[test]
fn it_is_told_that_no_working_copy_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "no folder").unwrap();
    let harness = open_file(None, NoDialogs, &file.join("recovery"));
    assert!(harness.query_by_label_contains("No working copy is kept").is_some());
    let kept = open_file(None, NoDialogs, folder.path());
    assert!(kept.query_by_label_contains("No working copy is kept").is_none());
}

#[test]
fn a_working_copy_that_cannot_be_written_is_told_and_written_later() {
    let folder = tempfile::tempdir().unwrap();
    let copy = folder.path().join("recovery-0.ron");
    let mut harness = open_file(None, NoDialogs, folder.path());
    // A folder in its place.
    std::fs::create_dir(&copy).unwrap();
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let is_told = |harness: &Editor| harness.query_by_label_contains("No working copy is kept").is_some();
    until(&mut harness, "the problem", is_told);
    std::fs::remove_dir(&copy).unwrap();
    until(&mut harness, "a working copy", |harness| copy.is_file() && !is_told(harness));
}

#[test]
fn a_crash_report_is_told_at_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("crash-00000000000000000001-1.new.txt"), "a report").unwrap();
    let mut harness = open_file(None, NoDialogs, folder.path());
    assert!(harness.query_by_label("Tellus stopped at an error the last time").is_some());
    let report = folder.path().join("crash-00000000000000000001-1.txt");
    assert!(harness.query_by_label_contains(&report.display().to_string()).is_some());
    click(&mut harness, "Dismiss");
    drop(harness);
    let again = open_file(None, NoDialogs, folder.path());
    assert!(again.query_by_label("Tellus stopped at an error the last time").is_none());
}
