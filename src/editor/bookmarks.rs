//! Views to come back to: kept in the preset, listed in a menu, gone to in a smooth flight.
//! Each change is an undo step.

use super::app::EditorApp;
use super::command::Command;
use super::handle::Action;
use super::menus;
use super::viewport::camera::pose::{Attitude, Pose};
use crate::planet::notes::MAX_BOOKMARKS;
use crate::planet::{Bookmark, EditorNotes, Planet};
use crate::sphere::{LatLon, geo};
use eframe::egui;
use glam::DVec3;

/// What can be done with the bookmark of a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BookmarkAction {
    /// Fly there.
    GoTo(usize),
    /// Ask for another name.
    AskName(usize),
    /// Give it a name.
    Rename(usize, String),
    /// Put it where the eye is now.
    Update(usize),
    /// Forget it.
    Delete(usize),
}

/// The bookmark that is being renamed, and the name so far.
pub(super) type Renaming = Option<(usize, String)>;

/// A pose as a preset holds it; `surface_radius_m` is the distance of the ground or the sea below it from the centre.
fn bookmark(name: String, pose: &Pose, surface_radius_m: f64) -> Bookmark {
    let up = pose.up();
    let attitude = Attitude::of(pose);
    let (east, north) = geo::east_north(up);
    let heading_rad = libm::atan2(attitude.ahead.dot(east), attitude.ahead.dot(north));
    let (latitude_deg, longitude_deg) = LatLon::from_direction(up).to_degrees();
    // Seven decimals are a centimetre on the ground.
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

/// The pose that a bookmark stands for.
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

/// The planet's bookmarks.
pub(super) fn list(planet: &Planet) -> &[Bookmark] {
    planet.editor.as_ref().map_or(&[], |editor| &editor.bookmarks)
}

/// `View 1` or the first number that is free.
fn free_name(taken: &[Bookmark]) -> String {
    (1..).map(|number| format!("View {number}")).find(|name| taken.iter().all(|b| b.name != *name)).unwrap_or_default()
}

/// The menu: one submenu for each bookmark.
pub(super) fn menu(ui: &mut egui::Ui, app: &mut EditorApp) {
    let planet = app.document.planet().clone();
    let bookmarks = list(&planet);
    menus::entry(ui, app, Command::AddBookmark, bookmarks.len() < MAX_BOOKMARKS, None);
    if !bookmarks.is_empty() {
        ui.separator();
    }
    for (index, bookmark) in bookmarks.iter().enumerate() {
        let mut chosen = None;
        let submenu = ui.menu_button(&bookmark.name, |ui| {
            for (label, tooltip, action) in [
                ("Go there", "Fly to this view.", BookmarkAction::GoTo(index)),
                ("Rename…", "Give this view another name.", BookmarkAction::AskName(index)),
                ("Move here", "Make this view what you see now.", BookmarkAction::Update(index)),
                ("Delete", "Forget this view.", BookmarkAction::Delete(index)),
            ] {
                if ui.button(label).on_hover_text(tooltip).clicked() {
                    chosen = Some(action);
                    ui.close();
                }
            }
        });
        if let Some(shortcut) = Command::GO_TO.get(index).and_then(|command| command.shortcuts().first()) {
            submenu.response.on_hover_text(ui.ctx().format_shortcut(shortcut));
        }
        app.actions.extend(chosen.map(Action::Bookmark));
    }
}

/// Asks for a name while a bookmark is being renamed.
pub(super) fn rename_window(ctx: &egui::Context, app: &mut EditorApp) {
    let Some((index, name)) = &mut app.renaming else { return };
    let modal = egui::Modal::new(egui::Id::unique("rename bookmark")).show(ctx, |ui| {
        ui.set_width(280.0);
        let heading = ui.heading("Name of the view");
        ui.add_space(4.0);
        let field = ui.add(egui::TextEdit::singleline(name).char_limit(64)).labelled_by(heading.id);
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if !field.has_focus() && !entered {
            field.request_focus();
        }
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let named = ui.add_enabled(!name.trim().is_empty(), egui::Button::new("Rename")).clicked();
            (named || (entered && !name.trim().is_empty()), ui.button("Cancel").clicked())
        })
        .inner
    });
    let (named, cancelled) = modal.inner;
    if named {
        app.actions.push(Action::Bookmark(BookmarkAction::Rename(*index, name.trim().to_owned())));
    }
    if named || cancelled || modal.should_close() {
        app.renaming = None;
    }
}

impl EditorApp {
    /// Keeps the view of now.
    pub(super) fn add_bookmark(&mut self) {
        let here = |app: &Self, name| app.bookmark_here(name);
        self.edit_bookmarks("Add bookmark", |app, bookmarks| {
            if bookmarks.len() < MAX_BOOKMARKS {
                bookmarks.push(here(app, free_name(bookmarks)));
            }
        });
    }

    pub(super) fn handle_bookmark(&mut self, action: BookmarkAction) {
        match action {
            BookmarkAction::GoTo(index) => self.go_to_bookmark(index),
            BookmarkAction::AskName(index) => {
                self.renaming = list(self.document.planet()).get(index).map(|bookmark| (index, bookmark.name.clone()));
            }
            BookmarkAction::Rename(index, name) => self.edit_bookmarks("Rename bookmark", |_, bookmarks| {
                if let Some(bookmark) = bookmarks.get_mut(index) {
                    bookmark.name = name;
                }
            }),
            BookmarkAction::Update(index) => self.edit_bookmarks("Move bookmark", |app, bookmarks| {
                if let Some(bookmark) = bookmarks.get_mut(index) {
                    *bookmark = app.bookmark_here(std::mem::take(&mut bookmark.name));
                }
            }),
            BookmarkAction::Delete(index) => self.edit_bookmarks("Delete bookmark", |_, bookmarks| {
                if index < bookmarks.len() {
                    bookmarks.remove(index);
                }
            }),
        }
    }

    /// Flies to a bookmark, if there is one of that number.
    pub(super) fn go_to_bookmark(&mut self, index: usize) {
        let planet = self.document.valid_planet().clone();
        if let Some(bookmark) = list(self.document.planet()).get(index) {
            self.viewport.move_cameras(&planet, |cameras, ground| {
                cameras.fly_to_pose(pose(bookmark, |up| ground.surface_radius_m(up)), ground);
            });
        }
    }

    fn bookmark_here(&self, name: String) -> Bookmark {
        let planet = self.document.valid_planet();
        let pose = self.viewport.pose(planet);
        bookmark(name, &pose, self.viewport.surface_radius_m(planet, pose.up()))
    }

    fn edit_bookmarks(&mut self, label: &str, change: impl FnOnce(&Self, &mut Vec<Bookmark>)) {
        let mut planet = (**self.document.planet()).clone();
        let mut notes = planet.editor.take().unwrap_or_default();
        change(self, &mut notes.bookmarks);
        // A planet without bookmarks is saved as if there had never been any.
        planet.editor = (notes != EditorNotes::default()).then_some(notes);
        self.document.settle();
        self.document.edit(planet, Some(label.to_owned()));
        self.document.settle();
    }
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
