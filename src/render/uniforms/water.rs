//! Uniforms of the sea, and of rivers and lakes.

use super::{Body, rgb};
use crate::planet::{Planet, Water};
use crate::render::shared::{CALM_SLOPE_VARIANCE, WAVES, Wave};
use glam::DVec3;
use std::f64::consts::TAU;

/// Longest and shortest wave that is drawn, metres.
const LENGTHS_M: (f64, f64) = (30.0, 0.2);
/// The golden angle, radians: it spreads directions evenly.
const GOLDEN_ANGLE_RAD: f64 = 2.399_963;
/// Gravity that drives the waves, m/s².
const GRAVITY_M_S2: f64 = 9.81;

/// Sets the water of a planet. Rivers and lakes of a planet with no sea have the default colours.
pub(super) fn of(out: &mut Body, planet: &Planet) {
    let none = Water::default();
    let water = planet.water.as_ref().unwrap_or(&none);
    // Cox and Munk 1954: variance of the slope, up- and crosswind together.
    let variance = CALM_SLOPE_VARIANCE + 0.00512 * water.wind_m_s;
    out.has_sea = u32::from(planet.water.is_some());
    out.has_rivers = u32::from(planet.structure.is_some());
    out.water_absorption_per_m = rgb(water.absorption_per_m);
    out.water_color = rgb(water.color);
    out.wave_slope_variance = variance as f32;
    out.ice_color = rgb(water.ice_color);
    out.freezing_c = water.freezing_c as f32;
    out.sea_level_km = (water.level_m * 1e-3) as f32;
    (out.equator_c, out.pole_c) = (planet.climate.equator_c as f32, planet.climate.pole_c as f32);
}

/// Sets the waves at a time around an eye.
pub(super) fn from_eye(out: &mut Body, planet: &Planet, eye_m: DVec3, time_secs: f64) {
    let level_m = planet.water.as_ref().map_or(Water::default().level_m, |water| water.level_m);
    let altitude_m = eye_m.length().max(1.0) - planet.radius_m();
    out.eye_over_sea_km = ((altitude_m - level_m) * 1e-3) as f32;
    for (i, slot) in out.waves.iter_mut().enumerate() {
        let x = (i as f64 + 0.5) / WAVES as f64;
        let length_m = LENGTHS_M.0 * (LENGTHS_M.1 / LENGTHS_M.0).powf(x);
        let z = 1.0 - 2.0 * ((i * 7 % WAVES) as f64 + 0.5) / WAVES as f64;
        let angle = i as f64 * GOLDEN_ANGLE_RAD;
        let flat = (1.0 - z * z).sqrt();
        let k = TAU / length_m;
        let vector_per_m = DVec3::new(flat * angle.cos(), flat * angle.sin(), z) * k;
        // Deep water: omega² = g k.
        let phase = vector_per_m.dot(eye_m) - (GRAVITY_M_S2 * k).sqrt() * time_secs;
        *slot = Wave { vector_per_m: vector_per_m.as_vec3(), phase: phase.rem_euclid(TAU) as f32 };
    }
}
