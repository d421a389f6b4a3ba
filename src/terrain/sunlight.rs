//! How much of a sun the ground leaves to a point, by rays.

use super::Terrain;
use super::points::unit;
use super::query::{Scratch, with_scratch};
use super::raycast::RayLimits;
use glam::DVec3;
use std::f64::consts::PI;

/// Searches for the horizon within the disc: its place there is known to a thirty-second of the radius.
const SEARCHES: usize = 6;
/// Height over the ground or the sea of a point that lies on or in them.
const LEAST_HEIGHT_M: f64 = 0.3;

impl Terrain {
    /// Share of the disc of a sun that the ground leaves to a point over it: 1 in the light, 0 in the shadow of a
    /// mountain, between them in its penumbra. Of a disc that the horizon of the smooth planet cuts, it is the share of
    /// the part over that horizon; the shader function `light_at` knows of the rest. The point is in the planet frame,
    /// metres; one on or in the ground counts as just over it. NaN has share 1.
    ///
    /// By two to eight rays of [`Terrain::raycast`], most often two.
    pub fn sun_share(&self, point_planet_m: DVec3, sun_dir_planet: DVec3, sun_radius_rad: f64) -> f64 {
        with_scratch(|scratch| self.sun_share_with(point_planet_m, (sun_dir_planet, sun_radius_rad), scratch))
    }

    /// As [`Terrain::sun_share`] of a direction and an angular radius, with the caller's scratch.
    pub fn sun_share_with(&self, point_planet_m: DVec3, sun: (DVec3, f64), scratch: &mut Scratch) -> f64 {
        let (up, dir, radius_m) = (unit(point_planet_m), unit(sun.0), self.planet().radius_m());
        let sun_radius_rad = sun.1.max(0.0);
        let mut height_m = [0.0];
        self.heights_spaced_into(&[up], 0.0, &mut height_m, scratch);
        let surface_m = radius_m + height_m[0].max(self.planet().sea_level_m().unwrap_or(f64::MIN));
        let away_m = point_planet_m.length().max(surface_m + LEAST_HEIGHT_M);
        let from_m = up * away_m;
        // Heights on the disc are in radii, from its middle.
        let beside = (up - dir * up.dot(dir)).normalize_or(dir.any_orthonormal_vector());
        let mut is_free = |height: f64| {
            let (sin, cos) = (height * sun_radius_rad).sin_cos();
            self.raycast_within(from_m, dir * cos + beside * sin, &RayLimits::default(), scratch).is_none()
        };
        if sun_radius_rad == 0.0 {
            return if is_free(0.0) { 1.0 } else { 0.0 };
        }
        let smooth_rad = -(radius_m / away_m.max(radius_m)).acos() - (0.5 * PI - up.angle_between(dir));
        let smooth = (smooth_rad / sun_radius_rad).clamp(-1.0, 1.0);
        if smooth >= 1.0 || !is_free(1.0) {
            return 0.0;
        }
        if is_free(smooth) {
            return 1.0;
        }
        let (mut hidden, mut free) = (smooth, 1.0);
        for _ in 0..SEARCHES {
            let middle = 0.5 * (hidden + free);
            *(if is_free(middle) { &mut free } else { &mut hidden }) = middle;
        }
        (disc_above(0.5 * (hidden + free)) / disc_above(smooth)).clamp(0.0, 1.0)
    }
}

/// Share of a disc above a level, in radii from its middle.
fn disc_above(level: f64) -> f64 {
    (level.acos() - level * (1.0 - level * level).max(0.0).sqrt()) / PI
}
