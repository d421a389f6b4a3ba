//! Where the eye is, and what it looks at.

use super::Viewport;
use crate::lod::pose::Pose;
use crate::planet::Planet;
use crate::sphere::LatLon;
use glam::DVec3;

impl Viewport {
    /// Height of the eye above the ground or the sea, and the location under it.
    pub fn eye(&self, planet: &Planet) -> (f64, LatLon) {
        self.with_ground(planet, |cameras, ground| {
            let pose = cameras.pose(ground);
            let altitude_m = pose.position_planet_m.length() - ground.surface_radius_m(pose.up());
            (altitude_m, LatLon::from_direction(pose.up()))
        })
    }

    /// The place in the middle of the picture and its distance from the eye; where that is sky, the place under the
    /// eye.
    pub fn looked_at(&self, planet: &Planet) -> (LatLon, f64) {
        self.with_ground(planet, |cameras, ground| {
            let pose = cameras.pose(ground);
            let (eye_m, ahead) = (pose.position_planet_m, pose.planet_from_view * DVec3::NEG_Z);
            let altitude_m = || eye_m.length() - ground.surface_radius_m(pose.up());
            match ground.raycast(eye_m, ahead) {
                Some(away_m) => (LatLon::from_direction(eye_m + ahead * away_m), away_m),
                None => (LatLon::from_direction(pose.up()), altitude_m()),
            }
        })
    }

    /// Size on the ground of a point in the middle of the picture; None where the middle is sky.
    pub fn metres_per_point(&self) -> Option<f64> {
        let (surface, camera) = (self.surface()?, self.shown_camera?);
        let away_m = surface.terrain.raycast(camera.position_planet_m, camera.forward_planet())?;
        Some(2.0 * away_m * (0.5 * camera.fov_y_rad).tan() / f64::from(self.rect.height().max(1.0)))
    }

    /// Position and orientation of the eye.
    pub fn pose(&self, planet: &Planet) -> Pose {
        self.with_ground(planet, |cameras, ground| cameras.pose(ground))
    }

    /// Distance from the planet's centre to the ground or the sea, whichever is higher.
    pub fn surface_radius_m(&self, planet: &Planet, dir_planet: DVec3) -> f64 {
        self.with_ground(planet, |_, ground| ground.surface_radius_m(dir_planet))
    }
}
