//! Where the camera stands when a planet is opened: for the editor, for pictures and for benches alike.

use super::{Camera, Quality, View};
use crate::planet::Planet;
use crate::sphere::LatLon;

/// Latitude of the opening view.
pub const OPENING_LAT_DEG: f64 = 20.0;
/// Longitude of the opening view, east of the star: most of the disc is lit, and the night shows at the rim.
pub const OPENING_LON_FROM_STAR_DEG: f64 = 52.0;
/// Height of the opening view in radii: the whole disc fits, with some room around it.
pub const OPENING_ALTITUDE_RADII: f64 = 1.9;
/// Least distance of the opening view, in radii of the highest ground: no relief, however tall, reaches the camera.
const CLEAR_RADII: f64 = 1.6;
/// Altitude, in radii, below which the camera looks along the ground rather than down at it.
pub const LOOK_DOWN_RADII: f64 = 0.2;

/// Pitch of the camera above [`LOOK_DOWN_RADII`]: straight down.
pub const FAR_PITCH_DEG: f64 = -90.0;
/// Pitch of the camera below [`LOOK_DOWN_RADII`]: a little below the horizon.
pub const NEAR_PITCH_DEG: f64 = -10.0;

/// The place over which a planet is first seen.
pub fn opening_place(planet: &Planet) -> LatLon {
    let lon = planet.star.longitude_deg + OPENING_LON_FROM_STAR_DEG;
    LatLon::from_degrees(OPENING_LAT_DEG, if lon > 180.0 { lon - 360.0 } else { lon })
}

/// Straight down from afar, a little below the horizon from near.
pub fn default_pitch_deg(planet: &Planet, altitude_m: f64) -> f64 {
    if altitude_m > LOOK_DOWN_RADII * planet.radius_m() { FAR_PITCH_DEG } else { NEAR_PITCH_DEG }
}

/// Distance of the opening view from the centre, for a planet with its highest ground at a height.
pub fn opening_radius_m(planet: &Planet, highest_m: f64) -> f64 {
    let radius_m = planet.radius_m();
    (radius_m * (1.0 + OPENING_ALTITUDE_RADII)).max((radius_m + highest_m) * CLEAR_RADII)
}

/// The whole planet, seen from where most of it is lit.
pub fn opening_view(planet: &Planet, size_px: [u32; 2], quality: Quality) -> View {
    let radius_m = planet.radius_m() * (1.0 + OPENING_ALTITUDE_RADII);
    let down = -std::f64::consts::FRAC_PI_2;
    let camera = Camera::over(opening_place(planet), radius_m, 0.0, down, Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px, quality }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_opening_view_is_clear_of_the_tallest_relief() {
        let planet = Planet { radius_km: 10.0, ..Planet::default() };
        assert_eq!(opening_radius_m(&planet, 200.0), 29_000.0, "relief of a usual planet changes nothing");
        assert_eq!(opening_radius_m(&planet, 25_000.0), 56_000.0);
    }
}
