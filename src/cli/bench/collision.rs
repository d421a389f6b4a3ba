//! The cost of moving things on a patch of ground: contacts, sweeps, and a crowd of walkers.

use super::{median, queries, repeat};
use crate::life::Surroundings;
use crate::lod::opening;
use crate::planet::{Planet, Population, life::ReadyPopulation};
use crate::sphere::Tangent;
use crate::terrain::{Capsule, GroundPatch, RayLimits, Terrain, Walker, WalkerBody};
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
/// Trees on a hectare of the forest, and boulders between them.
const TREES: f64 = 600.0;
const BOULDERS: f64 = 60.0;
/// Height of rays and sweeps over the ground, and the end of a ray.
const EYE_M: f64 = 1.5;
const RAY_M: f64 = 100.0;

/// An entry of the `collision` list of the report, with those of [`objects`]: means in microseconds of capsules of a
/// person's size, on ground that is known; `placed_us` is what a walker's first ground takes. `walker_step_us` is a
/// step of one of 200 walkers, new ground included; `walkers_a_core` how many of them one core moves in time.
/// `deviation_m` is the greatest that the patch said.
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
        "objects": objects(planet, &dirs)?,
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

/// The planet with a dense forest and boulders everywhere, also in water.
fn forest(planet: &Planet) -> Planet {
    let anywhere = |name: &str, per_hectare: f64| {
        let ready = ReadyPopulation::named(name).unwrap_or_default();
        let Population { form, height_m, sunk, upright, .. } = ready;
        let wide = Population { slope_to_deg: 90.0, clumping: 0.0, in_water: true, ..Population::default() };
        Population { form, height_m, sunk, upright, per_hectare, shore_m: 0.0, ..wide }
    };
    let life = vec![anywhere("Broadleaf tree", TREES), anywhere("Boulder", BOULDERS)];
    Planet { life, ..planet.clone() }
}

/// Means in microseconds of objects alone, on places that are known: `contact_us` of those nearer than 2 m, `sweep_us`
/// over a decimetre, `far_us` over 25 m, `ray_us` over 100 m. `walker_step_us` is a step of one of 200 walkers among
/// the trunks, new ground and objects included. `forms_ms` is what measuring the forms takes.
fn objects(planet: &Planet, dirs: &[DVec3]) -> Result<Value, String> {
    let terrain = Arc::new(Terrain::try_new(Arc::new(forest(planet))).map_err(|error| error.to_string())?);
    let (body, radius_m) = (WalkerBody::on(planet), planet.radius_m());
    let begun = Instant::now();
    let mut around = Surroundings::new(Arc::clone(&terrain));
    let forms_ms = begun.elapsed().as_secs_f64() * 1e3;
    let capsule = |dir: &DVec3| body.capsule_at(*dir * (radius_m + terrain.height_m(*dir) + EYE_M));
    let capsules: Vec<Capsule> = dirs.iter().map(capsule).collect();
    let along = |capsule: &Capsule| capsule.ends_planet_m[0].normalize().any_orthonormal_vector();
    let limits = RayLimits::default().to_m(RAY_M);
    // All cells around are placed first.
    for capsule in &capsules {
        black_box(around.objects.sweep(&capsule.moved(along(capsule) * -FALL_M), along(capsule) * RAY_M, 0.0));
    }
    let contact_us = queries::each_us(&capsules, |capsule| {
        black_box(around.objects.contact(capsule, 2.0));
    });
    let mut sweep_us = |length_m: f64| {
        queries::each_us(&capsules, |capsule| {
            black_box(around.objects.sweep(capsule, along(capsule) * length_m, body.skin_m));
        })
    };
    let (step_us, far_us) = (sweep_us(0.1), sweep_us(FALL_M));
    let ray_us = queries::each_us(&capsules, |capsule| {
        black_box(around.objects.raycast(capsule.ends_planet_m[1], along(capsule), &limits));
    });
    let mut walkers: Vec<Walker> = dirs.iter().map(|dir| Walker::on_ground(body, &mut around, *dir)).collect();
    let begun = Instant::now();
    for _ in 0..STEPS {
        for (number, walker) in walkers.iter_mut().enumerate() {
            let (sin, cos) = libm::sincos(number as f64);
            let (east, north) = walker.feet_planet_m().normalize().any_orthonormal_pair();
            walker.step(&mut around, (east * sin + north * cos) * PACE_M_S, 1.0 / RATE_HZ);
        }
    }
    Ok(json!({
        "trees_per_hectare": TREES,
        "forms_ms": forms_ms,
        "contact_us": contact_us,
        "sweep_us": step_us,
        "far_us": far_us,
        "ray_us": ray_us,
        "walker_step_us": begun.elapsed().as_secs_f64() * 1e6 / f64::from(CROWD * STEPS),
        "patch_mb": around.objects.resident_bytes() as f64 / 1e6,
    }))
}
