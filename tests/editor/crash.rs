//! What is left after a crash or the loss of the graphics device, and what is told of it.

use super::app::{open_after_loss, open_file, open_watched, until};
use super::*;
use std::cell::Cell;
use std::rc::Rc;
use tellus::editor::command::SystemAction;
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
fn work_that_is_not_wanted_now_is_offered_at_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, edited) = with_work(folder.path(), &Rc::default());
    until(&mut harness, "a working copy", |_| folder.path().join("recovery-0.ron").exists());
    drop(harness);
    let mut first = open_file(None, NoDialogs, folder.path());
    click(&mut first, "Not now");
    assert!(first.query_by_label("Recover unsaved work?").is_none());
    assert_ne!(planet(&first), edited);
    drop(first);
    let mut next = open_file(None, NoDialogs, folder.path());
    click(&mut next, "Recover");
    assert_eq!(planet(&next), edited);
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

/// A system that was changed and never saved comes back after a crash, and knows its file; so does a planet.
#[test]
fn an_unsaved_system_is_recovered_with_the_file_that_it_belongs_to() {
    let (folder, work) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let planet_file = work.path().join("one.ron");
    std::fs::write(&planet_file, "(version: 3, name: \"One\", radius_km: 900.0)").unwrap();
    let path = work.path().join("small.ron");
    let text = "(version: 1, name: \"Small\", bodies: [(name: \"S\", mass_earths: 3e5, light: ()), \
                (name: \"One\", preset: \"one.ron\", parent: \"S\", mass_earths: 0.01, orbit: ())])";
    std::fs::write(&path, text).unwrap();
    let mut harness = open_file(Some(&path), NoDialogs, folder.path());
    harness.run_steps(4);
    let mut system = (**harness.state().system().unwrap().system()).clone();
    system.rename(1, "Uno");
    let edit = SystemAction::Edit(Box::new(system.clone()), "Rename One".to_owned());
    harness.state_mut().push(Action::System(edit));
    harness.run_steps(2);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 950.0);
    let copies =
        ["recovery-0.ron", "recovery-0.system.ron", "recovery-0.files.txt"].map(|name| folder.path().join(name));
    let holds =
        |copy: &std::path::Path, text: &str| std::fs::read_to_string(copy).is_ok_and(|held| held.contains(text));
    until(&mut harness, "a working copy", |_| {
        holds(&copies[0], "950") && holds(&copies[1], "Uno") && holds(&copies[2], "one.ron")
    });
    drop(harness);

    let mut again = open_file(None, NoDialogs, folder.path());
    assert!(again.query_by_label_contains("One and the system Small").is_some());
    click(&mut again, "Recover");
    again.run_steps(4);
    assert_eq!(planet(&again).radius_km, 950.0);
    assert_eq!(again.state().document().path(), Some(std::fs::canonicalize(&planet_file).unwrap().as_path()));
    let open = again.state().system().unwrap();
    assert_eq!(
        (open.system().bodies[1].name.as_str(), open.path(), open.is_dirty()),
        ("Uno", Some(path.as_path()), true)
    );
    assert_eq!(again.state().viewport().body(), Some(1), "the planet is the body that it was");
    // What is saved is no longer in the working copy, which has this editor's own number now.
    let copies = ["recovery-1.ron", "recovery-1.system.ron"].map(|name| folder.path().join(name));
    until(&mut again, "its own working copy", |_| copies.iter().all(|copy| copy.exists()));
    again.state_mut().push(Action::System(SystemAction::Save));
    again.run_steps(3);
    if again.query_by_label("Replace").is_some() {
        click(&mut again, "Replace");
    }
    until(&mut again, "the system is saved", |again| !again.state().system().unwrap().is_dirty());
    assert!(holds(&path, "Uno") && holds(&path, "\"one.ron\""));
    until(&mut again, "one copy less", |_| !copies[1].exists());
    assert!(copies[0].exists(), "the planet is not saved yet");
}

/// Files of which one cannot be read are neither offered nor touched.
#[test]
fn work_that_cannot_be_read_stays_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("recovery-0.ron"), "(version: 3, radius_km: \"torn").unwrap();
    let system = "(version: 1, name: \"Small\", bodies: [(name: \"S\", mass_earths: 3e5, light: ())])";
    std::fs::write(at("recovery-0.system.ron"), system).unwrap();
    let harness = open_file(None, NoDialogs, folder.path());
    assert!(harness.query_by_label("Recover unsaved work?").is_none());
    assert!(at("recovery-0.ron").exists() && at("recovery-0.system.ron").exists());
}
