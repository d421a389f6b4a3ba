//! The flight to a location, as to a bookmark.

use crate::editor::finder::place::Place;
use crate::editor::state::State;
use crate::editor::viewport::camera::MAX_RADII;
use crate::lod::pose::Pose;
use crate::planet::Bookmark;

/// Below this altitude the eye looks ahead; above it looks down, so that the location is in the middle of the picture.
const LOOKS_AHEAD_M: f64 = 100.0;

/// Flies over a location. Without an altitude the eye keeps its height above the ground.
pub fn go_to(state: &mut State, place: Place) {
    state.shows.place = false;
    let planet = state.document.valid_planet().clone();
    let pose = state.viewport.pose(&planet);
    let here = pose.bookmark(String::new(), state.viewport.surface_radius_m(&planet, pose.up()));
    let altitude_m = place.altitude_m.unwrap_or(here.altitude_m).min((MAX_RADII - 1.0) * planet.radius_m());
    let (heading_deg, pitch_deg) = if altitude_m < LOOKS_AHEAD_M { (here.heading_deg, 0.0) } else { (0.0, -90.0) };
    let there = Bookmark {
        latitude_deg: place.lat_deg,
        longitude_deg: place.lon_deg,
        altitude_m,
        heading_deg,
        pitch_deg,
        ..Bookmark::default()
    };
    state.move_cameras(|cameras, ground| {
        cameras.fly_to_pose(Pose::of_bookmark(&there, |up| ground.surface_radius_m(up)), ground);
    });
    state.viewport.take_focus();
    state.notices.say(format!("Going to {place}"));
}
