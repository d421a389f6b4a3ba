//! The cost of moving things on a patch of ground: contacts, sweeps, and a crowd of walkers.

use super::{median, queries, repeat};
use crate::lod::opening;
use crate::planet::Planet;
use crate::sphere::Tangent;
use crate::terrain::{Capsule, GroundPatch, Terrain, Walker, WalkerBody};
use glam::DVec3;
use serde_json::{Value, json};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// Walkers, who stand about a place in rows.
const CROWD: u32 = 200;
const IN_A_ROW: u32 = 20;
/// Distance between them.
const APART_M: f64 = 5.0;
/// They walk so long, each its own way.
const STEPS: u32 = 600;
const RATE_HZ: f64 = 60.0;
const PACE_M_S: f64 = 1.5;
/// Height and motion of a fall.
const FALL_M: f64 = 25.0;

/// An entry of the `collision` list of the report: means in microseconds of capsules of a person's size, on ground that
/// is known; `placed_us` is what a walker's first ground takes. `walker_step_us` is a step of one of 200 walkers, new
/// ground included; `walkers_a_core` how many of them one core moves in time. `deviation_m` is the greatest that the
/// patch said.
pub(super) fn measure(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = Arc::new(Terrain::try_new(planet.clone()).map_err(|error| error.to_string())?);
    let tangent = Tangent::at(opening::opening_place(planet));
    let body = WalkerBody::on(planet);
    let mut patch = GroundPatch::new(terrain);
    let along = |i: u32| (f64::from(i) - f64::from(IN_A_ROW) / 2.0) * APART_M / planet.radius_m();
    let dirs: Vec<DVec3> = (0..CROWD).map(|i| tangent.direction(along(i % IN_A_ROW), along(i / IN_A_ROW))).collect();

    let begun = Instant::now();
    let mut walkers: Vec<Walker> = dirs.iter().map(|dir| Walker::on_ground(body, &mut patch, *dir)).collect();
    let placed_us = begun.elapsed().as_secs_f64() * 1e6 / f64::from(CROWD);

    let capsule = |walker: &Walker, over_m: f64| {
        let (up, feet_m) = (walker.feet_planet_m().normalize(), walker.feet_planet_m());
        let ends_m = [body.radius_m + over_m, body.height_m - body.radius_m + over_m];
        Capsule { ends_planet_m: ends_m.map(|end_m| feet_m + up * end_m), radius_m: body.radius_m }
    };
    let standing: Vec<Capsule> = walkers.iter().map(|walker| capsule(walker, 0.0)).collect();
    let high: Vec<Capsule> = walkers.iter().map(|walker| capsule(walker, FALL_M)).collect();
    let mut deviation_m = 0.0_f64;
    let contact_us = queries::each_us(&standing, |capsule| {
        deviation_m = patch.contact(capsule, 0.2).map_or(deviation_m, |contact| deviation_m.max(contact.deviation_m));
    });
    let step_us = queries::each_us(&standing, |capsule| {
        let up = capsule.ends_planet_m[0].normalize();
        black_box(patch.sweep(capsule, (up.any_orthonormal_vector() - up) * 0.1, body.skin_m));
    });
    let fall_us = queries::each_us(&high, |capsule| {
        let up = capsule.ends_planet_m[0].normalize();
        black_box(patch.sweep(capsule, up * (-2.0 * FALL_M), body.skin_m));
    });

    let begun = Instant::now();
    for _ in 0..STEPS {
        for (number, walker) in walkers.iter_mut().enumerate() {
            let (sin, cos) = libm::sincos(number as f64);
            let wish_m_s = (tangent.east_planet * sin + tangent.north_planet * cos) * PACE_M_S;
            walker.step(&mut patch, wish_m_s, 1.0 / RATE_HZ);
        }
    }
    let walker_step_us = begun.elapsed().as_secs_f64() * 1e6 / f64::from(CROWD * STEPS);
    let rest_us = median(&repeat(|| {
        walkers.iter_mut().for_each(|walker| walker.step(&mut patch, DVec3::ZERO, 1.0 / RATE_HZ));
    }));
    Ok(json!({
        "planet": planet.name,
        "contact_us": contact_us,
        "sweep_us": step_us,
        "fall_us": fall_us,
        "walker_step_us": walker_step_us,
        "walker_rest_us": rest_us.map(|ms| ms * 1000.0 / f64::from(CROWD)),
        "walkers_a_core": 1e6 / (RATE_HZ * walker_step_us),
        "placed_us": placed_us,
        "deviation_m": deviation_m,
        "patch_mb": patch.resident_bytes() as f64 / 1e6,
    }))
}
