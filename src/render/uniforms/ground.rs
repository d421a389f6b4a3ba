//! Uniforms of the ground: macro variation, patterns, biome table.

use super::{Body, octave, wrapped};
use crate::noise_tile::VARIATION_PERIODS_M;
use crate::planet::{Planet, TableBlend, TableRows};
use crate::render::biome_table::WRAP_M;
use crate::terrain::border::{self, OCTAVE_TURN};
use crate::terrain::material::WRAP_FAR_M;
use glam::DVec3;

/// Sets the climate of a planet and the shape of its biome table.
pub(super) fn of(out: &mut Body, planet: &Planet) {
    out.settlements = planet.settlements as f32;
    out.lapse_c_per_m = (planet.climate.lapse_c_per_km * 1e-3) as f32;
    out.border_jitter_cells = planet.biomes.border_jitter as f32;
    out.crisp_borders = u32::from(planet.biomes.blend == TableBlend::Crisp);
    let (offset, per_c, per_m) = row(planet);
    (out.row_offset, out.row_per_c, out.row_per_m) = (offset as f32, per_c as f32, per_m as f32);
    out.moisture_per_m = (-planet.climate.drying_per_km * 1e-3) as f32;
}

/// Sets the offsets of noises and patterns around an eye.
pub(super) fn from_eye(out: &mut Body, planet: &Planet, eye_m: DVec3) {
    let mut position_m = eye_m;
    for (slot, period_m) in out.variation.iter_mut().zip(VARIATION_PERIODS_M) {
        *slot = octave(position_m, period_m);
        position_m = OCTAVE_TURN * position_m;
    }
    out.eye_wrap_m = (wrapped(eye_m / WRAP_M) * WRAP_M).as_vec3();
    out.eye_wrap_far_m = (wrapped(eye_m / WRAP_FAR_M) * WRAP_FAR_M).as_vec3();
    // The point of the reference sphere under the eye.
    let mut position_m = eye_m / eye_m.length().max(1.0) * planet.radius_m();
    for (slot, period_m) in out.border.iter_mut().zip(border::periods_m(planet.radius_m())) {
        *slot = octave(position_m, period_m);
        position_m = OCTAVE_TURN * position_m;
    }
}

/// Row of the biome table at temperature and height 0, its change by °C and by metre.
fn row(planet: &Planet) -> (f64, f64, f64) {
    let biomes = &planet.biomes;
    match biomes.rows {
        TableRows::Temperature => {
            let per_c = 1.0 / (biomes.hottest_c - biomes.coldest_c);
            (-biomes.coldest_c * per_c, per_c, 0.0)
        }
        TableRows::Elevation => {
            let per_m = 1.0 / (biomes.highest_m - biomes.lowest_m);
            (-biomes.lowest_m * per_m, 0.0, per_m)
        }
    }
}
