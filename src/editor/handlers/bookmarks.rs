//! Bookmarks: views kept in the preset. Each change is an undo step; going to a bookmark is a smooth flight.

use crate::editor::command::BookmarkAction;
use crate::editor::state::State;
use crate::editor::viewport::camera::pose::{Attitude, Pose};
use crate::planet::notes::MAX_BOOKMARKS;
use crate::planet::{Bookmark, EditorNotes};
use crate::sphere::{LatLon, geo};
use glam::DVec3;

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
            cameras.fly_to_pose(pose(&bookmark, |up| ground.surface_radius_m(up)), ground);
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
    bookmark(name, &pose, state.viewport.surface_radius_m(planet, pose.up()))
}

/// The bookmark of a pose. `surface_radius_m` is the distance from the centre to the ground or the sea below it.
fn bookmark(name: String, pose: &Pose, surface_radius_m: f64) -> Bookmark {
    let up = pose.up();
    let attitude = Attitude::of(pose);
    let (east, north) = geo::east_north(up);
    let heading_rad = libm::atan2(attitude.ahead.dot(east), attitude.ahead.dot(north));
    let (latitude_deg, longitude_deg) = LatLon::from_direction(up).to_degrees();
    // Seven decimals of a degree are a centimetre on a planet of the size of the Earth.
    let rounded = |value: f64, decimals: i32| {
        let unit = 10_f64.powi(decimals);
        (value * unit).round() / unit
    };
    Bookmark {
        name,
        latitude_deg: rounded(latitude_deg, 7),
        longitude_deg: rounded(longitude_deg, 7),
        altitude_m: rounded(pose.position_planet_m.length() - surface_radius_m, 3),
        heading_deg: rounded(heading_rad.to_degrees().rem_euclid(360.0), 3),
        pitch_deg: rounded(attitude.pitch_rad.to_degrees(), 3),
        roll_deg: rounded(attitude.roll_rad.to_degrees(), 3),
    }
}

/// The pose of a bookmark.
fn pose(bookmark: &Bookmark, surface_radius_m: impl FnOnce(DVec3) -> f64) -> Pose {
    let up = LatLon::from_degrees(bookmark.latitude_deg, bookmark.longitude_deg).direction();
    let (east, north) = geo::east_north(up);
    let (sin_h, cos_h) = libm::sincos(bookmark.heading_deg.to_radians());
    let attitude = Attitude {
        ahead: north * cos_h + east * sin_h,
        pitch_rad: bookmark.pitch_deg.to_radians(),
        roll_rad: bookmark.roll_deg.to_radians(),
    };
    Pose::new(up * (surface_radius_m(up) + bookmark.altitude_m), &attitude)
}

/// `View 1`, or the first number that no bookmark has.
fn free_name(taken: &[Bookmark]) -> String {
    (1..).map(|number| format!("View {number}")).find(|name| taken.iter().all(|b| b.name != *name)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bookmark_is_the_pose_it_was_made_of() {
        let radius_m = 6_371_000.0;
        for (lat, lon, altitude_m, pitch_rad, roll_rad) in
            [(10.0, 20.0, 1.7, -0.2, 0.0), (-89.99, 100.0, 5e6, -1.5, 0.4), (90.0, 0.0, 12e6, -1.57, 0.0)]
        {
            let up = LatLon::from_degrees(lat, lon).direction();
            let attitude = Attitude { ahead: geo::east_north(up).0, pitch_rad, roll_rad };
            let before = Pose::new(up * (radius_m + altitude_m), &attitude);
            let kept = bookmark("Here".to_owned(), &before, radius_m);
            let after = pose(&kept, |_| radius_m);
            let off_m = before.position_planet_m.distance(after.position_planet_m);
            assert!(off_m < 0.02 + 1e-8 * altitude_m, "{off_m} m off");
            assert!(before.planet_from_view.angle_between(after.planet_from_view) < 1e-4);
        }
    }
}
