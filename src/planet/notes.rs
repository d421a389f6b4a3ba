//! What the editor keeps in a preset for whoever edits it next. No picture, no height and no game depends on it.

use super::param::{Domain, Stage, Unit, linear, params};

/// Most bookmarks a planet may have.
pub const MAX_BOOKMARKS: usize = 64;

params! {
    /// The editor's own section of a preset.
    pub struct EditorNotes {
    } with {
        /// Views of the planet to come back to.
        bookmarks: Vec<Bookmark> = Vec::new();
    }
}

params! {
    /// A view of the planet: where the eye is and how the head is turned.
    pub struct Bookmark {
        /// What the view is called.
        name: String = "View".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
        /// Latitude of the eye, north positive.
        latitude_deg: f64 = 0.0, "Latitude", Unit::Degrees, linear(-90.0, 90.0), Stage::Label;
        /// Longitude of the eye, east positive.
        longitude_deg: f64 = 0.0, "Longitude", Unit::Degrees, linear(-180.0, 180.0), Stage::Label;
        /// Height of the eye above the ground or the sea, whichever is higher; below zero it is under water.
        altitude_m: f64 = 1000.0, "Altitude", Unit::Metres, linear(-100_000.0, 1e11), Stage::Label;
        /// Where one looks: 0 is north, 90 is east.
        heading_deg: f64 = 0.0, "Heading", Unit::Degrees, linear(-360.0, 360.0), Stage::Label;
        /// Angle above the horizon; -90 is straight down.
        pitch_deg: f64 = 0.0, "Pitch", Unit::Degrees, linear(-90.0, 90.0), Stage::Label;
        /// How far the top of the view leans to the right.
        roll_deg: f64 = 0.0, "Roll", Unit::Degrees, linear(-180.0, 180.0), Stage::Label;
    }
}
