//! Uniforms of the cloud layer.

use super::{Body, octave, rgb};
use crate::lod::Quality;
use crate::planet::Planet;
use crate::render::scene::Scene;
use crate::render::shared::CLOUD_PUFF_BAND;
use crate::terrain::border::OCTAVE_TURN;
use glam::{DVec3, Vec2};
use std::f64::consts::TAU;

/// Period of each band over that of the next finer one.
const BAND_RATIO: f64 = 3.3;
/// Puffs along the side of the noise tile, in the band that makes puffs.
const PUFFS_PER_TILE: f64 = 4.0;
/// First step of a march that begins in the layer, in thicknesses of the layer.
const FIRST_STEP: f64 = 0.06;
/// Steps of a march through a layer that is thinner than a pixel.
const FAR_STEPS: f64 = 3.0;

/// Sets the clouds around an eye; without clouds the coverage stays 0.
pub(super) fn from_eye(out: &mut Body, planet: &Planet, eye_m: DVec3, scene: &Scene<'_>, pixel_rad: f32) {
    out.has_wind = u32::from(planet.structure.as_ref().is_some_and(|structure| structure.weather_share > 0.0));
    let Some(clouds) = &planet.clouds else { return };
    let (steps, parts) = match scene.quality {
        Quality::Low => (7.0, 3.0),
        Quality::Medium => (14.0, 4.0),
        Quality::High => (22.0, 6.0),
    };
    let eye_km = eye_m * 1e-3;
    let (bottom_km, top_km) = (clouds.altitude_km, clouds.altitude_km + clouds.thickness_km);
    let angle = clouds.wind_km_h / 3600.0 * scene.time_secs / planet.radius_km;
    let (s, c) = angle.rem_euclid(TAU).sin_cos();
    // One choice for the whole picture: where the layer is thinner than a pixel, few samples give its mean.
    let away_km = eye_km.length() - planet.radius_km - top_km;
    let is_thin = away_km * f64::from(pixel_rad) > 0.5 * clouds.thickness_km;
    out.cloud_color = rgb(clouds.color);
    out.cloud_optical_depth = clouds.density as f32;
    (out.cloud_bottom_km, out.cloud_top_km) = (bottom_km as f32, top_km as f32);
    out.cloud_coverage = clouds.coverage as f32;
    let puff_period_km = clouds.puff_km * PUFFS_PER_TILE;
    out.cloud_puff_period_km = puff_period_km as f32;
    let mut position_km = DVec3::new(c * eye_km.x + s * eye_km.y, c * eye_km.y - s * eye_km.x, eye_km.z);
    for (band, slot) in out.cloud_bands.iter_mut().enumerate() {
        *slot = octave(position_km, puff_period_km * BAND_RATIO.powi(CLOUD_PUFF_BAND - band as i32));
        position_km = OCTAVE_TURN * position_km;
    }
    // The longest way within the layer goes from its top down to its bottom and up again.
    let longest_km = 2.0 * (2.0 * (planet.radius_km + top_km) * clouds.thickness_km).sqrt();
    let first_km = FIRST_STEP * clouds.thickness_km;
    let (steps, parts) = if is_thin { (FAR_STEPS, 1.0) } else { (steps, parts) };
    out.cloud_is_far = u32::from(is_thin);
    out.cloud_steps = steps as f32;
    out.cloud_parts = parts as f32;
    out.cloud_first_step_km = first_km as f32;
    out.cloud_step_growth = step_growth(longest_km / first_km, steps) as f32;
    out.cloud_drift = Vec2::new(c as f32, s as f32);
    // Ice clouds lie well over the layer.
    (out.veil_km, out.veil_coverage) = ((top_km + clouds.thickness_km) as f32, clouds.veil as f32);
}

/// Ratio of each of `steps` steps to the one before when their sum is `sum` first steps; above 1.
fn step_growth(sum: f64, steps: f64) -> f64 {
    let (mut low, mut high) = (1.001, 1e4);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let reached = (middle.powf(steps) - 1.0) / (middle - 1.0);
        (low, high) = if reached < sum { (middle, high) } else { (low, middle) };
    }
    high
}
