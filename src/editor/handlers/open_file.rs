//! Another program has changed the open file.

use crate::editor::files::disk::{OnDisk, TheirFile, look};
use crate::editor::state::State;
use eframe::egui;
use std::path::Path;

/// Replaces the planet by what its file holds: one undo step.
pub fn revert(state: &mut State) {
    let Some(path) = state.document.path().map(Path::to_owned) else { return };
    let bytes = match look(&path, state.document.disk_bytes()) {
        OnDisk::Changed(bytes) => Some(bytes),
        _ => state.document.disk_bytes().map(<[u8]>::to_vec),
    };
    let Some(theirs) = bytes.map(|bytes| TheirFile::read(&path, bytes, state.document.planet())) else { return };
    match theirs.planet {
        Ok(planet) => {
            state.reload(planet, theirs.bytes);
            state.notices.say(format!("Back to {}; undo brings your changes back", path.display()));
        }
        Err(why) => state.report("The file cannot be read", vec![why]),
    }
}

/// Compares the open file with the document when the file may have changed.
pub fn poll(state: &mut State, ctx: &egui::Context) {
    state.open_file.follow(state.document.path(), ctx);
    state.questions.keep_change_of(state.document.path());
    if let Some(path) = state.document.path().filter(|_| state.document.disk_bytes().is_some()) {
        state.recent.note(path);
    }
    let gained_focus = state.open_file.gained_focus(ctx);
    // One question at a time.
    if state.questions.is_asking() {
        return;
    }
    if state.open_file.may_have_changed(ctx) || gained_focus {
        compare(state);
        ctx.request_repaint();
    }
}

fn compare(state: &mut State) {
    let Some(path) = state.document.path().map(Path::to_owned) else { return };
    match look(&path, state.document.disk_bytes()) {
        OnDisk::Same if state.document.disk_bytes().is_some() => state.open_file.settle(),
        // Still gone, or never written: the notice still holds.
        OnDisk::Same | OnDisk::Unknown => {}
        OnDisk::Gone => {
            // No file holds the planet any more: closing asks, and saving writes a new file.
            state.document.note_disk(None, None);
            state.open_file.put_off = None;
            state.open_file.notice = Some(format!("{} is gone from the disk. Save to write it again.", path.display()));
        }
        OnDisk::Changed(bytes) => {
            let theirs = TheirFile::read(&path, bytes, state.document.planet());
            take_over(state, &path, theirs);
        }
    }
}

/// The file holds another text: a document without unsaved work takes it over, any other asks.
fn take_over(state: &mut State, path: &Path, theirs: TheirFile) {
    state.open_file.notice = None;
    let dirty = state.document.is_dirty();
    match theirs.planet {
        Err(why) if !dirty => {
            state.open_file.notice = Some(format!("The file has changed on disk and cannot be read: {why}"));
        }
        Ok(planet) if planet == **state.document.planet() => {
            state.document.note_disk(Some(planet), Some(theirs.bytes));
        }
        Ok(planet) if !dirty => {
            state.reload(planet, theirs.bytes);
            state.notices.say(format!("{} has changed on disk and was read again", path.display()));
        }
        _ if state.open_file.put_off.as_ref() == Some(&theirs.bytes) => {}
        planet => state.questions.ask_about_change(path.to_owned(), TheirFile { planet, ..theirs }, false),
    }
}
