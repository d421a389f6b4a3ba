//! Bookmarks: views kept in the preset. Each change is an undo step; going to a bookmark is a smooth flight.

use crate::editor::command::BookmarkAction;
use crate::editor::state::State;
use crate::lod::pose::Pose;
use crate::planet::notes::MAX_BOOKMARKS;
use crate::planet::{Bookmark, EditorNotes};

/// Adds a bookmark of the current view.
pub fn add(state: &mut State) {
    let bookmark = bookmark_here(state, free_name(state.document.bookmarks()));
    edit(state, "Add bookmark", |bookmarks| {
        if bookmarks.len() < MAX_BOOKMARKS {
            bookmarks.push(bookmark);
        }
    });
}

/// Flies to the bookmark of this index, if there is one.
pub fn go_to(state: &mut State, index: usize) {
    if let Some(bookmark) = state.document.bookmarks().get(index).cloned() {
        state.move_cameras(|cameras, ground| {
            cameras.fly_to_pose(Pose::of_bookmark(&bookmark, |up| ground.surface_radius_m(up)), ground);
        });
    }
}

/// Carries out an action on a bookmark.
pub fn apply(state: &mut State, action: BookmarkAction) {
    match action {
        BookmarkAction::GoTo(index) => go_to(state, index),
        BookmarkAction::AskName(index) => state.renaming = Some(index),
        BookmarkAction::CancelName => state.renaming = None,
        BookmarkAction::Rename(index, name) => {
            state.renaming = None;
            edit(state, "Rename bookmark", |bookmarks| {
                if let Some(bookmark) = bookmarks.get_mut(index) {
                    bookmark.name = name;
                }
            });
        }
        BookmarkAction::Update(index) => {
            let here = bookmark_here(state, String::new());
            edit(state, "Move bookmark", |bookmarks| {
                if let Some(bookmark) = bookmarks.get_mut(index) {
                    *bookmark = Bookmark { name: std::mem::take(&mut bookmark.name), ..here };
                }
            });
        }
        BookmarkAction::Delete(index) => edit(state, "Delete bookmark", |bookmarks| {
            if index < bookmarks.len() {
                bookmarks.remove(index);
            }
        }),
    }
}

fn edit(state: &mut State, label: &str, change: impl FnOnce(&mut Vec<Bookmark>)) {
    let mut planet = (**state.document.planet()).clone();
    let mut notes = planet.editor.take().unwrap_or_default();
    change(&mut notes.bookmarks);
    // A planet without bookmarks is saved without the editor's section.
    planet.editor = (notes != EditorNotes::default()).then_some(notes);
    state.document.settle();
    state.document.edit(planet, Some(label.to_owned()));
    state.document.settle();
}

fn bookmark_here(state: &State, name: String) -> Bookmark {
    let planet = state.document.valid_planet();
    let pose = state.viewport.pose(planet);
    pose.bookmark(name, state.viewport.surface_radius_m(planet, pose.up()))
}

/// `View 1`, or the first number that no bookmark has.
fn free_name(taken: &[Bookmark]) -> String {
    (1..).map(|number| format!("View {number}")).find(|name| taken.iter().all(|b| b.name != *name)).unwrap_or_default()
}
