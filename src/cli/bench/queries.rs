//! The cost of terrain queries: one at a time as a game asks, and in batches.

use super::{median, repeat};
use crate::planet::Planet;
use crate::sphere::spread;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use serde_json::{Value, json};
use std::hint::black_box;
use std::sync::Arc;

/// Directions of single queries, spread evenly over the globe.
const SINGLES: usize = 2000;
/// Directions of a batch.
const BATCH: usize = 50_000;
/// Height of a ray's origin above the ground or the sea.
const EYE_M: f64 = 50.0;
/// Angles of the rays below the horizon.
const PITCHES_DEG: [f64; 4] = [5.0, 15.0, 30.0, 60.0];

/// The `queries` object of the report. `height_single_us`, `sample_single_us` and `ray_us` are means over the globe;
/// `height_batch_mps` is million points a second on one core, `samples_batch_mps` on all. Medians over the runs.
pub(super) fn measure(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = Terrain::try_new(planet.clone()).map_err(|error| error.to_string())?;
    let singles: Vec<DVec3> = spread(SINGLES).collect();
    let batch: Vec<DVec3> = spread(BATCH).collect();
    let mut scratch = Scratch::default();

    let height_single_us = each_us(&singles, |dir| {
        black_box(terrain.height_m(*dir));
    });
    let sample_single_us = each_us(&singles, |dir| {
        black_box(terrain.sample(*dir));
    });
    let rays = rays(&terrain, &singles);
    let ray_us = each_us(&rays, |(origin_m, dir)| {
        black_box(terrain.raycast_with(*origin_m, *dir, &mut scratch));
    });

    let mut heights_m = vec![0.0; BATCH];
    let height_batch_mps = mps(|| terrain.heights_into(&batch, black_box(&mut heights_m), &mut scratch));
    let mut samples: Vec<Sample> = Vec::new();
    let samples_batch_mps = mps(|| samples = black_box(terrain.samples(&batch, Wanted::ALL)));
    Ok(json!({
        "height_single_us": height_single_us,
        "sample_single_us": sample_single_us,
        "height_batch_mps": height_batch_mps,
        "samples_batch_mps": samples_batch_mps,
        "ray_us": ray_us,
    }))
}

/// Rays from above the ground, down at one of the pitches.
fn rays(terrain: &Terrain, dirs: &[DVec3]) -> Vec<(DVec3, DVec3)> {
    let planet = terrain.planet();
    let ray = |(&up, &pitch_deg): (&DVec3, &f64)| {
        let surface_m = terrain.height_m(up).max(planet.sea_level_m().unwrap_or(f64::MIN));
        let (sin, cos) = libm::sincos(pitch_deg.to_radians());
        (up * (planet.radius_m() + surface_m + EYE_M), up.any_orthonormal_vector() * cos - up * sin)
    };
    dirs.iter().zip(PITCHES_DEG.iter().cycle()).map(ray).collect()
}

/// Microseconds of one query: the mean over all of a run, the median of the runs.
fn each_us<T>(questions: &[T], mut ask: impl FnMut(&T)) -> Option<f64> {
    let times_ms = repeat(|| questions.iter().for_each(&mut ask));
    median(&times_ms).map(|ms| ms * 1000.0 / questions.len() as f64)
}

/// Million points a second of a query of [`BATCH`] points.
fn mps(mut ask: impl FnMut()) -> Option<f64> {
    median(&repeat(&mut ask)).map(|ms| BATCH as f64 / ms / 1000.0)
}
