//! Uniforms of the layers of clouds.

use super::{Body, octave, rgb};
use crate::clouds::coverages;
use crate::lod::Quality;
use crate::planet::{Clouds, Planet};
use crate::render::scene::Scene;
use crate::render::shared::{
    CLOUD_LAYERS, CloudLayer, FOG_BANDS, FOG_LAYER, LOW_BANDS, LOW_LAYER, LOW_PUFF_BAND, MIDDLE_BANDS, MIDDLE_LAYER,
    RAIN_BANDS, RAIN_LAYER, ROWS,
};
use crate::terrain::border::OCTAVE_TURN;
use glam::{DVec3, Vec2};
use std::f64::consts::TAU;

/// Period of each band over that of the next finer one, and of those of middle clouds: groups, lumps, cells.
const BAND_RATIO: f64 = 3.3;
const MIDDLE_RATIO: f64 = 2.4;
/// Puffs along the side of the noise tile, in the band that makes puffs.
const PUFFS_PER_TILE: f64 = 4.0;
/// First step of a march that begins in the layer, in thicknesses of the layer.
const FIRST_STEP: f64 = 0.06;
/// Steps of a march through a layer that is thinner than a pixel.
const FAR_STEPS: f64 = 3.0;
/// Size of the waves on top of fog, and of shafts of rain, in thicknesses of the fog and in puffs.
const FOG_WAVE: f64 = 8.0;
const SHAFT: f64 = 0.4;
/// Optical depth of the densest rain, from the clouds to the reference sphere.
const RAIN_DEPTH: f64 = 3.0;
/// Height of the eye from which rain is not seen, in heights of the cloud tops.
const RAIN_FROM: f64 = 3.0;

/// A layer before the eye is known.
struct Layer {
    index: u32,
    coverage: f64,
    bottom_km: f64,
    thickness_km: f64,
    optical_depth: f64,
    /// Steps and parts of a step.
    effort: [f64; 2],
    /// Bands before, and from the band that makes puffs.
    bands: [usize; 2],
    /// Period of the band that makes puffs.
    puff_period_km: f64,
}

/// Sets the clouds around an eye; without clouds the coverages stay 0.
pub(super) fn from_eye(out: &mut Body, planet: &Planet, eye_m: DVec3, scene: &Scene<'_>, pixel_rad: f32) {
    out.has_wind = u32::from(planet.structure.as_ref().is_some_and(|structure| structure.weather_share > 0.0));
    let Some(clouds) = &planet.clouds else { return };
    let eye_km = eye_m * 1e-3;
    let (s, c) = drift_rad(planet, scene.time_secs).sin_cos();
    let drifted_km = DVec3::new(c * eye_km.x + s * eye_km.y, c * eye_km.y - s * eye_km.x, eye_km.z);
    out.cloud_color = rgb(clouds.color);
    out.cloud_coverages = coverages(clouds).map(|coverage| coverage as f32).into();
    out.cloud_drift = Vec2::new(c as f32, s as f32);
    out.cloud_layering = clouds.layering as f32;
    let layers = layers(planet, clouds, scene.quality);
    let low_top_km = clouds.altitude_km + clouds.thickness_km;
    let middle_top_km = low_top_km + clouds.middle_gap_km + clouds.middle_thickness_km;
    let top_km = if clouds.middle > 0.0 { middle_top_km } else { low_top_km };
    out.cloud_top_km = top_km as f32;
    (out.veil_km, out.veil_depth) = ((low_top_km + clouds.veil_gap_km).max(top_km) as f32, clouds.veil_density as f32);
    let eye_altitude_km = eye_km.length() - planet.radius_km;
    let mut first_band = 0;
    for layer in layers {
        let top_km = layer.bottom_km + layer.thickness_km;
        // One choice for the whole picture: where the layer is thinner than a pixel, few samples give its mean.
        let is_thin = (eye_altitude_km - top_km) * f64::from(pixel_rad) > 0.5 * layer.thickness_km;
        let is_hidden = layer.index == RAIN_LAYER && eye_altitude_km > RAIN_FROM * low_top_km;
        let even = if is_thin { 1.0 } else { 0.0 };
        let [steps, parts] = if is_thin { [FAR_STEPS.min(layer.effort[0]), 1.0] } else { layer.effort };
        let [before, after] = layer.bands;
        let mut position_km = drifted_km;
        for band in 0..before + after {
            let is_middle = layer.index == MIDDLE_LAYER;
            let ratio = if is_middle { MIDDLE_RATIO } else { BAND_RATIO };
            let period_km = layer.puff_period_km * ratio.powi(before as i32 - band as i32);
            out.cloud_bands[first_band + band] = octave(position_km, period_km);
            position_km = OCTAVE_TURN * position_km;
            if is_middle && band == before {
                position_km = ROWS * position_km;
            }
        }
        // The longest way within the layer goes from its top down to its bottom and up again.
        let longest_km = 2.0 * (2.0 * (planet.radius_km + top_km).max(0.0) * layer.thickness_km).sqrt();
        let first_km = FIRST_STEP * layer.thickness_km;
        out.cloud_layers[layer.index as usize] = CloudLayer {
            bottom_km: layer.bottom_km as f32,
            top_km: top_km as f32,
            optical_depth: layer.optical_depth as f32,
            steps: if layer.coverage > 0.0 && !is_hidden { steps as f32 } else { 0.0 },
            stride: DVec3::new(first_km, step_growth(longest_km / first_km, steps), parts).as_vec3().extend(even),
            first_band: first_band as u32,
            puff_band: (first_band + before) as u32,
            end_band: (first_band + before + after) as u32,
        };
        first_band += before + after;
        if layer.index == LOW_LAYER {
            out.cloud_is_far = u32::from(is_thin);
            // Few samples would miss low decks.
            out.cloud_towers = if is_thin { 0.0 } else { clouds.towers as f32 };
        }
    }
}

/// Angle about the pole by which the wind has carried the clouds at a time.
pub(crate) fn drift_rad(planet: &Planet, time_secs: f64) -> f64 {
    let wind_km_h = planet.clouds.as_ref().map_or(0.0, |clouds| clouds.wind_km_h);
    (wind_km_h / 3600.0 * time_secs / planet.radius_km).rem_euclid(TAU)
}

/// The layers of a planet.
fn layers(planet: &Planet, clouds: &Clouds, quality: Quality) -> [Layer; CLOUD_LAYERS] {
    let at = |low: [f64; 2], medium: [f64; 2], high: [f64; 2]| match quality {
        Quality::Low => low,
        Quality::Medium => medium,
        Quality::High => high,
    };
    let puff_period_km = clouds.puff_km * PUFFS_PER_TILE;
    let sea_km = planet.water.as_ref().map_or(0.0, |water| water.level_m * 1e-3);
    // Rain falls to the sea, or to the reference sphere.
    let rain_bottom_km = sea_km.min(clouds.altitude_km - 0.01);
    [
        Layer {
            index: LOW_LAYER,
            coverage: clouds.coverage,
            bottom_km: clouds.altitude_km,
            thickness_km: clouds.thickness_km,
            optical_depth: clouds.density,
            effort: at([14.0, 2.0], [28.0, 4.0], [44.0, 4.0]),
            bands: [LOW_PUFF_BAND, LOW_BANDS - LOW_PUFF_BAND],
            puff_period_km,
        },
        Layer {
            index: MIDDLE_LAYER,
            coverage: clouds.middle,
            bottom_km: clouds.altitude_km + clouds.thickness_km + clouds.middle_gap_km,
            thickness_km: clouds.middle_thickness_km,
            optical_depth: clouds.middle_density,
            effort: at([3.0, 1.0], [6.0, 1.0], [9.0, 2.0]),
            bands: [1, MIDDLE_BANDS - 1],
            puff_period_km: clouds.middle_puff_km * PUFFS_PER_TILE,
        },
        Layer {
            index: FOG_LAYER,
            coverage: clouds.fog,
            bottom_km: sea_km + clouds.fog_altitude_km,
            thickness_km: clouds.fog_thickness_km,
            optical_depth: clouds.fog_density,
            effort: at([4.0, 1.0], [7.0, 1.0], [10.0, 2.0]),
            bands: [1, FOG_BANDS - 1],
            puff_period_km: clouds.fog_thickness_km * FOG_WAVE * PUFFS_PER_TILE,
        },
        Layer {
            index: RAIN_LAYER,
            coverage: clouds.rain * clouds.coverage,
            bottom_km: rain_bottom_km,
            thickness_km: clouds.altitude_km - rain_bottom_km,
            optical_depth: clouds.rain * RAIN_DEPTH,
            effort: at([3.0, 1.0], [6.0, 1.0], [10.0, 1.0]),
            bands: [0, RAIN_BANDS],
            puff_period_km: puff_period_km * SHAFT,
        },
    ]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Water;

    #[test]
    fn fog_and_rain_reach_down_to_the_sea() {
        let clouds = Clouds { fog_altitude_km: 0.02, ..Clouds::default() };
        for (level_m, bottom_km) in [(Some(450.0), 0.45), (Some(-1800.0), -1.8), (None, 0.0)] {
            let water = level_m.map(|level_m| Water { level_m, ..Water::default() });
            let layers = layers(&Planet { water, ..Planet::default() }, &clouds, Quality::Low);
            let bottom = |index| layers.iter().find(|layer| layer.index == index).map(|layer| layer.bottom_km);
            assert_eq!((bottom(FOG_LAYER), bottom(RAIN_LAYER)), (Some(bottom_km + 0.02), Some(bottom_km)));
        }
    }
}
