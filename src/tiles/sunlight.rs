//! How much of a sun the ground leaves to a place, from the horizon angles that the picture takes.

use super::Surface;
use crate::lod::horizon::{AZIMUTHS, HorizonTile, face_step};
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES};
use crate::sphere::NodeId;
use glam::DVec3;
use std::f64::consts::TAU;

/// Least angular radius of a disc, as in `disc_share` of `air_model.wgsl`.
const LEAST_RADIUS_RAD: f64 = 0.0015;

impl Surface {
    /// Share of the disc of a sun that the surrounding ground leaves to a place on the ground, as the picture shows it:
    /// from the horizon angles of the tile there. None without them. It is the share of
    /// [`crate::terrain::Terrain::sun_share`] for a hundredth of the time, for places on the ground alone: what stands
    /// on a tower sees more of the sun than its foot.
    pub fn sun_share(&self, place_planet_m: DVec3, sun_dir_planet: DVec3, sun_radius_rad: f64) -> Option<f64> {
        let (up, sun_dir) = (place_planet_m.try_normalize()?, sun_dir_planet.try_normalize()?);
        let here = NodeId::containing(up, NodeId::MAX_LEVEL);
        let is_over = |node: NodeId| {
            let steps = here.level.saturating_sub(node.level);
            node.face == here.face && node.x == here.x >> steps && node.y == here.y >> steps
        };
        let tile = self.leaves.iter().find(|leaf| is_over(leaf.tile.id))?.horizon.as_deref()?;
        let [side, x, y] = here.within(tile.id);
        let sine = horizon_sine(tile, [x + 0.5 * side, y + 0.5 * side], face_step(tile.id.face, up, sun_dir))?;
        let half = sun_radius_rad.max(LEAST_RADIUS_RAD);
        let share = |over: f64| {
            let x = (0.5 + 0.5 * over / half).clamp(0.0, 1.0);
            x * x * (3.0 - 2.0 * x)
        };
        let (sun_sine, radius_m) = (up.dot(sun_dir), self.terrain.planet().radius_m());
        let shrunk = radius_m / place_planet_m.length().max(radius_m);
        let plain = share(sun_sine + (1.0 - shrunk * shrunk).max(0.0).sqrt());
        Some(if plain > 0.0 { (share(sun_sine - sine) / plain).min(1.0) } else { 0.0 })
    }
}

/// Sine of the horizon's elevation at a place of a tile, 0 to 1 along its sides, towards a step on its face: as
/// `horizon_sine` of `horizon.wgsl`.
fn horizon_sine(tile: &HorizonTile, place: [f64; 2], [step_x, step_y]: [f64; 2]) -> Option<f64> {
    let quads = TILE_QUADS as f64;
    let at = place.map(|part| (part * quads).clamp(0.0, quads));
    let first = at.map(|part| (part as usize).min(TILE_QUADS - 1));
    let [u, v] = [at[0] - first[0] as f64, at[1] - first[1] as f64];
    let azimuth = (step_y.atan2(step_x) / TAU).rem_euclid(1.0) * AZIMUTHS as f64;
    let (number, f) = (azimuth as usize, azimuth.fract());
    let image = |offset: usize| {
        let image = (number + AZIMUTHS - 1 + offset) % AZIMUTHS;
        let value = |x: usize, y: usize| {
            let index = image * TILE_VERTICES + (first[1] + y) * TILE_SIDE + first[0] + x;
            tile.own.get(index).map(|value| value.to_f64())
        };
        let along = |y: usize| Some(value(0, y)? * (1.0 - u) + value(1, y)? * u);
        Some(along(0)? * (1.0 - v) + along(1)? * v)
    };
    let (before, after) = (0.5 * f * (1.0 - f) * (f - 1.0), -0.5 * f * (1.0 - f) * f);
    let [near, next] = [1.0 - f - 2.0 * before + after, f - 2.0 * after + before];
    Some(before * image(0)? + near * image(1)? + next * image(2)? + after * image(3)?)
}
