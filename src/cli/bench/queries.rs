//! The cost of terrain queries: one at a time as a game asks, and in batches.

use super::{median, noise, repeat};
use crate::lod::opening;
use crate::planet::Planet;
use crate::sphere::{Tangent, spread};
use crate::terrain::{Capsule, Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use serde_json::{Value, json};
use std::hint::black_box;
use std::sync::Arc;

/// Directions of single queries, spread evenly over the globe.
const SINGLES: usize = 2000;
/// Directions of contacts and sweeps.
const MOVING: usize = 200;
/// Directions of a batch.
const BATCH: usize = 50_000;
/// Height of a ray's origin above the ground or the sea.
const EYE_M: f64 = 50.0;
/// Angles of the rays below the horizon.
const PITCHES_DEG: [f64; 4] = [5.0, 15.0, 30.0, 60.0];

/// Radius of the ball and of the capsule that meet the ground, and the height of the capsule.
const RADIUS_M: f64 = 0.5;
const CAPSULE_M: f64 = 1.8;
/// Motions of a sweep: a walk downhill in a frame, and a fall.
const STEP_M: f64 = 0.5;
const FALL_M: f64 = 50.0;

/// An entry of the `queries` list of the report. `*_us` are means over the globe in microseconds; `height_one_mps` is
/// million points a second in a batch on one core, `height_all_mps` and `samples_batch_mps` on all. Medians over the
/// runs. `fastnoise_lite_mps`: fastnoise-lite on one core, on the same points and with as many octaves as the layers of
/// a height have at most.
pub(super) fn measure(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = Terrain::try_new(planet.clone()).map_err(|error| error.to_string())?;
    let singles: Vec<DVec3> = spread(SINGLES).collect();
    // Points that lie about, of which no two share a river, take milliseconds each where there are rivers: a batch is a
    // patch of ground, as a game asks.
    let batch: Vec<DVec3> = if planet.structure.is_some() { patch(planet) } else { spread(BATCH).collect() };
    let mut scratch = Scratch::default();

    let near = if planet.structure.is_some() { &batch[..SINGLES] } else { &singles[..] };
    let height_single_us = each_us(near, |dir| {
        black_box(terrain.height_m(*dir));
    });
    let sample_single_us = each_us(near, |dir| {
        black_box(terrain.sample(*dir));
    });
    let rays = rays(&terrain, near);
    let ray_us = each_us(&rays, |(origin_m, dir)| {
        black_box(terrain.raycast_with(*origin_m, *dir, &mut scratch));
    });
    let moving = moving(&terrain, &near[..MOVING], &mut scratch);

    let mut heights_m = vec![0.0; BATCH];
    let height_one_mps = mps(|| terrain.heights_spaced_into(&batch, 0.0, black_box(&mut heights_m), &mut scratch));
    let height_all_mps = mps(|| drop(black_box(terrain.heights_m(&batch))));
    let mut samples: Vec<Sample> = Vec::new();
    // What most programs ask for.
    let wanted = Wanted::HEIGHT.and_normal().and_biome().and_water();
    let samples_batch_mps = mps(|| samples = black_box(terrain.samples(&batch, wanted)));
    // The cost of an octave is that of eight, divided.
    let octaves = terrain.octaves_per_point();
    let of_octaves = |mps: f64| mps * f64::from(noise::OCTAVES) / octaves as f64;
    let mut report = json!({
        "planet": planet.name,
        "height_single_us": height_single_us,
        "sample_single_us": sample_single_us,
        "height_one_mps": height_one_mps,
        "height_all_mps": height_all_mps,
        "samples_batch_mps": samples_batch_mps,
        "octaves": octaves,
        "fastnoise_lite_mps": noise::fastnoise_lite_mpts(&batch).map(of_octaves),
        "ray_us": ray_us,
    });
    for (name, us) in moving {
        report[name] = json!(us);
    }
    Ok(report)
}

/// Microseconds of contacts and sweeps of a ball and of a capsule that stand on the ground.
fn moving(terrain: &Terrain, dirs: &[DVec3], scratch: &mut Scratch) -> [(&'static str, Option<f64>); 5] {
    let radius_m = terrain.planet().radius_m();
    let standing = |above_m: f64| -> Vec<(Capsule, DVec3)> {
        let stand = |&up: &DVec3| {
            let foot_m = radius_m + terrain.height_m(up) + RADIUS_M + above_m;
            let ends_planet_m = [up * foot_m, up * (foot_m + CAPSULE_M)];
            (Capsule { ends_planet_m, radius_m: RADIUS_M }, up)
        };
        dirs.iter().map(stand).collect()
    };
    let (near, high) = (standing(0.05), standing(FALL_M / 2.0));
    let ball = |capsule: &Capsule| Capsule::sphere(capsule.ends_planet_m[0], capsule.radius_m);
    let down = |up: DVec3, m: f64| (up.any_orthonormal_vector() * 3.0 - up).normalize() * m;
    let mut us = |of: &[(Capsule, DVec3)], ask: &dyn Fn(&Capsule, DVec3, &mut Scratch)| {
        each_us(of, |(capsule, up)| ask(capsule, *up, scratch))
    };
    [
        (
            "ball_contact_us",
            us(&near, &|of, _, scratch| {
                black_box(terrain.contact_with(&ball(of), 0.2, scratch));
            }),
        ),
        (
            "capsule_contact_us",
            us(&near, &|of, _, scratch| {
                black_box(terrain.contact_with(of, 0.2, scratch));
            }),
        ),
        (
            "ball_step_us",
            us(&near, &|of, up, scratch| {
                black_box(terrain.sweep_with(&ball(of), down(up, STEP_M), 0.0, scratch));
            }),
        ),
        (
            "capsule_step_us",
            us(&near, &|of, up, scratch| {
                black_box(terrain.sweep_with(of, down(up, STEP_M), 0.0, scratch));
            }),
        ),
        (
            "capsule_fall_us",
            us(&high, &|of, up, scratch| {
                black_box(terrain.sweep_with(of, up * -FALL_M, 0.0, scratch));
            }),
        ),
    ]
}

/// Directions of a batch a metre apart around a place on land.
fn patch(planet: &Planet) -> Vec<DVec3> {
    let tangent = Tangent::at(opening::opening_place(planet));
    let side = BATCH.isqrt() + 1;
    let along = |i: usize| (i as f64 - side as f64 / 2.0) / planet.radius_m();
    (0..BATCH).map(|i| tangent.direction(along(i % side), along(i / side))).collect()
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
pub(super) fn each_us<T>(questions: &[T], mut ask: impl FnMut(&T)) -> Option<f64> {
    let times_ms = repeat(|| questions.iter().for_each(&mut ask));
    median(&times_ms).map(|ms| ms * 1000.0 / questions.len() as f64)
}

/// Million points a second of a query of [`BATCH`] points.
fn mps(mut ask: impl FnMut()) -> Option<f64> {
    median(&repeat(&mut ask)).map(|ms| BATCH as f64 / ms / 1000.0)
}
