//! From orbit down to the ground: the place to stand on, and the flight there.

use super::Viewport;
use super::camera::walk::EYE_M;
use super::ground::PlanetGround;
use crate::lod::pose::{Attitude, Pose};
use crate::planet::Planet;
use crate::sphere::Tangent;
use crate::terrain::{Sample, Search, Terrain, Wanted};
use glam::{DQuat, DVec3};

/// How far around the place below the eye is searched for ground, in radians of arc. Around the place over which a
/// planet is first seen, the star is up that far.
const REACH_RAD: f64 = 0.5;
/// Points of the search across that reach.
const STEPS: f64 = 60.0;
/// What to stand on: so far above the water, and so level.
const LEAST_DRY_M: f64 = 3.0;
const STEEPEST_RAD: f64 = 0.3;
/// The view is turned from the star by this angle: relief has shade, and the sky is blue.
const FROM_STAR_RAD: f64 = 1.9;

impl Viewport {
    /// Goes down to the ground, as soon as the planet has one on screen. A giant has none: the eye stays in orbit.
    pub fn go_down(&mut self) {
        self.is_landing = true;
    }

    /// Starts the flight that was asked for.
    pub(super) fn advance_landing(&mut self, planet: &Planet) {
        if !self.is_landing || self.travel.is_some() || self.cameras.is_carried() {
            return;
        }
        if planet.giant.is_some() {
            self.is_landing = false;
            return;
        }
        let Some(surface) = self.surface().filter(|surface| **surface.terrain.planet() == *planet) else { return };
        self.is_landing = false;
        let ground = PlanetGround::new(planet, Some(&surface.terrain));
        let star_dir = self.star_dir_planet(planet);
        let up = landing_place(&surface.terrain, self.cameras.pose(&ground).up());
        self.cameras.fly_to_pose(standing(&surface.terrain, up, star_dir), &ground);
    }
}

/// Dry and level ground near a place, or the place itself where there is none.
fn landing_place(terrain: &Terrain, around_planet: DVec3) -> DVec3 {
    let reach_m = REACH_RAD * terrain.planet().radius_m();
    let wanted = Wanted { normal: true, water: true, ..Wanted::HEIGHT };
    let search = Search { around_planet, within_m: reach_m, spacing_m: reach_m / STEPS, wanted };
    let sea_m = terrain.planet().sea_level_m().unwrap_or(f64::MIN);
    let holds = |at: &Sample| {
        let water_m = at.water_level_m.unwrap_or(sea_m);
        at.height_m > water_m + LEAST_DRY_M && at.slope_rad < STEEPEST_RAD
    };
    let found = terrain.nearest(&search, &holds, &|_| true).ok().flatten();
    found.map_or(around_planet, |place| place.dir_planet)
}

/// Stands there and looks along the ground, to the side of the star.
fn standing(terrain: &Terrain, up: DVec3, star_dir: DVec3) -> Pose {
    let planet = terrain.planet();
    let height_m = terrain.height_m(up).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let towards_star = (star_dir - up * star_dir.dot(up)).normalize_or(Tangent::new(up).north_planet);
    let ahead = DQuat::from_axis_angle(up, FROM_STAR_RAD) * towards_star;
    let attitude = Attitude { ahead, pitch_rad: 0.0, roll_rad: 0.0 };
    Pose::new(up * (planet.radius_m() + height_m + EYE_M), &attitude)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::opening::opening_place;
    use crate::planet::shipped;
    use std::sync::Arc;

    #[test]
    fn one_lands_on_dry_and_level_ground_by_day() {
        for preset in shipped::ALL.iter().filter(|preset| ["maren.ron", "pallor.ron"].contains(&preset.file)) {
            let planet = Arc::new(preset.load().unwrap());
            let terrain = Terrain::try_new(planet.clone()).unwrap();
            let up = landing_place(&terrain, opening_place(&planet).direction());
            let star_dir = planet.star.place(0.0).direction();
            let sample = terrain.sample(up);
            assert_eq!(sample.water_level_m, None, "{}", preset.file);
            assert!(sample.slope_rad < STEEPEST_RAD && up.dot(star_dir) > 0.1, "{}: {sample:?}", preset.file);
            let pose = standing(&terrain, up, star_dir);
            let over_m = pose.position_planet_m.length() - planet.radius_m() - sample.height_m;
            assert!((over_m - EYE_M).abs() < 1e-6, "{over_m}");
        }
    }
}
