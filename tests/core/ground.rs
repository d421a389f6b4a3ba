//! The ground of a patch: contacts and sweeps against the evaluator's, within the deviation that is said.

use proptest::prelude::*;
use std::sync::{Arc, LazyLock, Mutex};
use tellus::glam::DVec3;
use tellus::planet::Planet;
use tellus::sphere::{Tangent, spread};
use tellus::terrain::{Capsule, GroundPatch, Terrain};

const RADIUS_M: f64 = 40_000.0;

/// Hills with crags, rough down to some metres.
fn terrain() -> Arc<Terrain> {
    static TERRAIN: LazyLock<Arc<Terrain>> = LazyLock::new(|| {
        let text = r#"(version: 3, name: "Islet", radius_km: 40.0, layers: [
            (name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 8.0, octaves: 8)),
            (name: "Crags", amplitude_m: 3.0, shape: Ridged(wavelength_km: 0.05, octaves: 5)),
        ])"#;
        Arc::new(Terrain::try_new(Planet::from_text("islet.ron", text).unwrap().into()).unwrap())
    });
    TERRAIN.clone()
}

/// A patch that all cases of a test share: what it was asked before must not matter.
fn shared(patch: &'static LazyLock<Mutex<GroundPatch>>) -> std::sync::MutexGuard<'static, GroundPatch> {
    patch.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// A capsule whose middle is at a height over the ground.
fn capsule(terrain: &Terrain, dir: DVec3, over_m: f64, length_m: f64, radius_m: f64) -> Capsule {
    let tangent = Tangent::new(dir);
    let middle_m = dir * (RADIUS_M + terrain.height_m(dir) + over_m);
    let half_m = tangent.planet(DVec3::new(0.6, -0.5, 0.4)).normalize() * (0.5 * length_m);
    Capsule { ends_planet_m: [middle_m - half_m, middle_m + half_m], radius_m }
}

/// Lowest height of points of a capsule's surface over the evaluator's ground.
fn clearance_m(terrain: &Terrain, capsule: &Capsule) -> f64 {
    let [from_m, to_m] = capsule.ends_planet_m;
    let points = spread(300).flat_map(|dir| [0.0, 0.5, 1.0].map(|at| from_m.lerp(to_m, at) + dir * capsule.radius_m));
    points.map(|at_m| at_m.length() - RADIUS_M - terrain.height_m(at_m)).fold(f64::INFINITY, f64::min)
}

fn direction() -> impl Strategy<Value = DVec3> {
    // Corners and edges of the lattice's faces are as good places as others.
    let edges =
        [DVec3::new(1.0, 1.0, 0.3), DVec3::new(1.0, -1.0, 1.0), DVec3::new(-1.0, 0.2, 1.0)].map(DVec3::normalize);
    (0..103_usize).prop_map(move |place| spread(100).nth(place).unwrap_or_else(|| edges[place - 100]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_contact_is_the_evaluators_within_the_deviation(
        dir in direction(), over in 0.3..3.0_f64, long in 0.0..3.0_f64, radius_m in 0.2..6.0_f64,
    ) {
        static PATCH: LazyLock<Mutex<GroundPatch>> = LazyLock::new(|| Mutex::new(GroundPatch::new(terrain())));
        let terrain = terrain();
        let capsule = capsule(&terrain, dir, (over + 0.3 * long) * radius_m, long * radius_m, radius_m);
        let found = shared(&PATCH).contact(&capsule, 0.5 * radius_m);
        match (found, terrain.contact(&capsule, 0.5 * radius_m)) {
            (Some(found), wanted) if found.gap_m > -0.9 * radius_m => {
                // The evaluator's search may overlook a crag that is narrower than a sixth of the radius.
                let overlooked_m = 0.01 * radius_m;
                let wanted_m = wanted.map_or(0.5 * radius_m, |wanted| wanted.gap_m);
                let slack_m = found.deviation_m + overlooked_m;
                prop_assert!((found.gap_m - wanted_m).abs() < slack_m, "{wanted_m} {found:?}");
                let ground_m = found.point_planet_m.length() - RADIUS_M - terrain.height_m(found.point_planet_m);
                prop_assert!(ground_m.abs() <= found.deviation_m, "{ground_m} {}", found.deviation_m);
            }
            (Some(found), wanted) => {
                prop_assert!(wanted.is_some_and(|wanted| wanted.gap_m < -0.8 * radius_m), "{found:?} {wanted:?}");
            }
            (None, wanted) => prop_assert!(wanted.is_none_or(|wanted| wanted.gap_m > 0.45 * radius_m), "{wanted:?}"),
        }
    }

    #[test]
    fn a_sweep_never_ends_in_the_ground_and_ends_at_it(
        dir in direction(), over_m in 0.0..20.0_f64, side in -3.0..3.0_f64, long in 0.0..3.0_f64,
        radius_m in 0.2..6.0_f64, skin_m in 0.0..0.1_f64,
    ) {
        static PATCH: LazyLock<Mutex<GroundPatch>> = LazyLock::new(|| Mutex::new(GroundPatch::new(terrain())));
        let (terrain, mut patch) = (terrain(), shared(&PATCH));
        let capsule = capsule(&terrain, dir, over_m + (2.0 + long) * radius_m, long * radius_m, radius_m);
        prop_assume!(clearance_m(&terrain, &capsule) > 0.5 * radius_m);
        let motion_m = (Tangent::new(dir).east_planet * side - dir) * (3.0 * over_m + 10.0 * radius_m);
        let Some(sweep) = patch.sweep(&capsule, motion_m, skin_m) else {
            // A slope that falls away is not met.
            prop_assert!(clearance_m(&terrain, &capsule.moved(motion_m)) > -0.5 * radius_m);
            return Ok(());
        };
        prop_assert!(sweep.share > 0.0 && sweep.share < 1.0);
        let end = capsule.moved(motion_m * sweep.share);
        let deviation_m = sweep.contact.deviation_m;
        prop_assert!((sweep.contact.gap_m - skin_m - 1e-4).abs() < 1e-5, "{} {skin_m}", sweep.contact.gap_m);
        prop_assert!(clearance_m(&terrain, &end) > -deviation_m, "{} {deviation_m}", clearance_m(&terrain, &end));
        // On the way it is never nearer than at its end.
        for step in 0..8 {
            let before = capsule.moved(motion_m * (sweep.share * f64::from(step) / 8.0));
            prop_assert!(patch.contact(&before, skin_m).is_none_or(|contact| contact.gap_m > skin_m - 1e-6));
        }
        // What touches leaves, and is stopped at once if it goes on.
        prop_assert_eq!(patch.sweep(&end, sweep.contact.normal_planet * 0.3, skin_m), None);
        let on = patch.sweep(&end, sweep.contact.normal_planet * -0.3, skin_m).unwrap();
        prop_assert!(on.share < 1e-3, "{}", on.share);
        let out = patch.contact(&end.moved(dir * -3.0 * radius_m), 0.0).unwrap();
        prop_assert!(out.gap_m < 0.0, "{out:?}");
    }
}

#[test]
fn the_ground_is_the_evaluators_within_the_deviation_and_the_same_whatever_was_asked_before() {
    let terrain = terrain();
    for width_m in [0.1, 0.25, 1.0] {
        let mut patch = GroundPatch::new(terrain.clone()).cell_m(width_m);
        let (mut greatest, mut said_m): (f64, f64) = (0.0, 0.0);
        for dir in spread(300) {
            let tangent = Tangent::new(dir);
            for i in 0..10 {
                let at = tangent.direction(f64::from(i % 5) * 0.2 / RADIUS_M, f64::from(i / 5) * 0.2 / RADIUS_M);
                let ball = Capsule::sphere(at * (RADIUS_M + terrain.height_m(at)), 0.01);
                let deviation_m = patch.contact(&ball, 3.0).unwrap().deviation_m;
                greatest = greatest.max((patch.height_m(at) - terrain.height_m(at)).abs() / deviation_m);
                said_m = said_m.max(deviation_m);
            }
        }
        println!(
            "cells of {width_m} m: the ground deviates by {said_m:.4} m at most, is {greatest:.2} of what is said"
        );
        assert!(greatest < 1.0, "{width_m} m: {greatest}");
        let mut other = GroundPatch::new(terrain.clone()).cell_m(width_m).budget_bytes(0);
        let dirs: Vec<DVec3> = spread(300).collect();
        for dir in dirs.into_iter().rev() {
            assert_eq!(other.height_m(dir), patch.height_m(dir));
        }
        assert!(other.resident_bytes() < 40_000 && patch.resident_bytes() > 3_000_000, "{}", other.resident_bytes());
    }
}

#[test]
fn a_capsule_that_has_landed_flies_away_again() {
    let terrain = terrain();
    let mut patch = GroundPatch::new(terrain.clone());
    for dir in spread(20) {
        let body = capsule(&terrain, dir, 12.0, 1.0, 0.4);
        let (down_m, up_m) = (dir * -20.0, dir * 1.0);
        for skin_m in [0.0, 0.02] {
            let landed = terrain.sweep_with(&body, down_m, skin_m, &mut Default::default()).unwrap();
            let gap_m = landed.contact.gap_m;
            assert!(gap_m > skin_m * 0.99 && gap_m < skin_m + 2e-4, "{gap_m}");
            let body = body.moved(down_m * landed.share);
            assert_eq!(terrain.sweep_with(&body, up_m, skin_m, &mut Default::default()), None);
            let on_patch = patch.sweep(&capsule(&terrain, dir, 12.0, 1.0, 0.4), down_m, skin_m).unwrap();
            let apart_m = (on_patch.share - landed.share).abs() * 20.0;
            assert!(apart_m < 3.0 * on_patch.contact.deviation_m + 0.01, "{apart_m}");
        }
    }
}

#[test]
fn what_is_far_or_not_finite_touches_nothing() {
    let terrain = terrain();
    let mut patch = GroundPatch::new(terrain.clone());
    let far = Capsule::sphere(DVec3::X * 60_000.0, 10.0);
    assert_eq!(patch.contact(&far, 1000.0), None);
    assert_eq!(patch.sweep(&far, DVec3::Y * 1e6, 0.0), None);
    assert_eq!(patch.sweep(&far, DVec3::ZERO, 0.0), None);
    let fall = patch.sweep(&far, DVec3::X * -30_000.0, 0.0).unwrap();
    let ground_m = fall.contact.point_planet_m.length() - RADIUS_M - terrain.height_m(fall.contact.point_planet_m);
    assert!(ground_m.abs() <= fall.contact.deviation_m, "{ground_m}");
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(patch.contact(&Capsule::sphere(DVec3::splat(bad), 1.0), 1.0), None);
        assert_eq!(patch.sweep(&far, DVec3::splat(bad), 0.0), None);
        assert!(patch.height_m(DVec3::splat(bad)).is_finite());
    }
    assert_eq!(patch.contact(&Capsule::sphere(DVec3::X * RADIUS_M, 0.0), 1.0), None);
    // A ball as large as the planet, and one in its middle.
    assert!(patch.contact(&Capsule::sphere(DVec3::ZERO, 50_000.0), 0.0).is_some());
    assert!(patch.contact(&Capsule::sphere(DVec3::ZERO, 1.0), 0.0).is_some());
}
