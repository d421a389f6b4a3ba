//! The editor's own section of a preset. Pictures, heights and games do not read it.

use super::param::{Domain, Stage, Unit, linear, params};

/// Most bookmarks a planet may have.
pub const MAX_BOOKMARKS: usize = 64;
/// Most locks a planet may have.
pub const MAX_LOCKS: usize = 1024;

params! {
    /// The editor's own section of a preset.
    pub struct EditorNotes {
    } with {
        /// Bookmarked views of the planet.
        bookmarks: Vec<Bookmark> = Vec::new();
        /// Parameters and parts that variations and random planets leave as they are.
        locks: Vec<Lock> = Vec::new();
    }
}

params! {
    /// A lock on a parameter or a part.
    pub struct Lock {
        /// Path of the parameter or part, with layers by name and biomes by key: `layers["Hills"].amplitude_m`.
        path: String = String::new(), "Path", Unit::None, Domain::Text { max_chars: 200 }, Stage::Label;
    }
}

params! {
    /// A view of the planet: position and orientation of the camera.
    pub struct Bookmark {
        /// Name of the view.
        name: String = "View".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
        /// Latitude of the camera; north is positive.
        latitude_deg: f64 = 0.0, "Latitude", Unit::Degrees, linear(-90.0, 90.0), Stage::Label;
        /// Longitude of the camera; east is positive.
        longitude_deg: f64 = 0.0, "Longitude", Unit::Degrees, linear(-180.0, 180.0), Stage::Label;
        /// Height of the camera above the ground or the sea, whichever is higher; negative is under water.
        altitude_m: f64 = 1000.0, "Altitude", Unit::Metres, linear(-100_000.0, 1e11), Stage::Label;
        /// Heading: 0 is north, 90 is east.
        heading_deg: f64 = 0.0, "Heading", Unit::Degrees, linear(-360.0, 360.0), Stage::Label;
        /// Pitch: angle above the horizon; -90 is straight down.
        pitch_deg: f64 = 0.0, "Pitch", Unit::Degrees, linear(-90.0, 90.0), Stage::Label;
        /// Roll: positive leans the top of the view to the right.
        roll_deg: f64 = 0.0, "Roll", Unit::Degrees, linear(-180.0, 180.0), Stage::Label;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::param::{ParamPath, Params as _, Stages};
    use crate::planet::{Planet, VERSION, random};

    fn planet() -> Planet {
        let bookmark = Bookmark { name: "Beach".to_owned(), pitch_deg: -12.5, ..Bookmark::default() };
        Planet { editor: Some(EditorNotes { bookmarks: vec![bookmark], locks: Vec::new() }), ..random::random(5) }
    }

    #[test]
    fn notes_are_saved_but_change_nothing_that_is_drawn() {
        let planet = planet();
        assert_eq!(Planet::from_text("f.ron", &planet.to_text()).unwrap(), planet);
        let bare = Planet { editor: None, ..planet.clone() };
        assert!(!bare.to_text().contains("editor"), "a preset without notes does not mention them");
        let mut all_labels = true;
        EditorNotes { bookmarks: vec![Bookmark::default()], locks: vec![Lock::default()] }.each_value(
            &mut ParamPath::default(),
            &mut |_, param, _| {
                all_labels &= param.stages == Stages::of(&[Stage::Label]);
            },
        );
        assert!(all_labels);
        assert_eq!(random::vary(&planet, 3, 1.0).editor, planet.editor, "a variation is seen from the same places");
    }

    #[test]
    fn what_is_wrong_with_a_bookmark_is_told() {
        let message = |bookmarks: &str| {
            let text = format!("(version: {VERSION}, editor: (bookmarks: {bookmarks}))");
            Planet::from_text("f.ron", &text).unwrap_err().to_string()
        };
        assert_eq!(
            message("[(pitch_deg: 99)]"),
            "f.ron:1:47: editor.bookmarks[0].pitch_deg: 99 is out of range; use -90 to 90°"
        );
        assert_eq!(
            message("3"),
            "f.ron:1:34: editor.bookmarks: `3` is not what belongs here; use a list: `[(...), (...)]`"
        );
        let many = format!("[{}]", "(),".repeat(MAX_BOOKMARKS + 1));
        assert_eq!(message(&many), "f.ron:1:34: editor.bookmarks: 65 bookmarks are too many; use at most 64");
    }
}
