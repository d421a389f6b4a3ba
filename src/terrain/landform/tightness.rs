//! How much wider bounds near a direction are than the ground there.

use super::precision::starts;
use super::tests::shapes;
use crate::planet::{Layer, Planet, shipped};
use crate::terrain::Terrain;
use std::sync::Arc;
use std::time::Instant;

/// The angle from the centre of a quadtree node to its corners.
fn node_rad(level: i32) -> f64 {
    std::f64::consts::FRAC_PI_4 * 2.0_f64.sqrt() * 0.5_f64.powi(level)
}

/// Median ratio of the width of the bounds to the range of a thousand points, over many directions.
fn looseness(terrain: &Terrain, angle_rad: f64) -> f64 {
    let mut found: Vec<f64> = starts(40)
        .into_iter()
        .filter_map(|dir| {
            let (a, b) = dir.any_orthonormal_pair();
            let around = (0..1024).map(|i| {
                let (turn, share) = (f64::from(i) * 2.4, (f64::from(i) / 1024.0).sqrt());
                (dir + (a * turn.cos() + b * turn.sin()) * (angle_rad * share * 0.99).tan()).normalize()
            });
            let heights_m = terrain.heights_m(&around.collect::<Vec<_>>());
            let (least, most) = heights_m.iter().fold((f64::MAX, f64::MIN), |(lo, hi), &h| (lo.min(h), hi.max(h)));
            let (lo, hi) = terrain.height_bounds_near_m(dir, angle_rad);
            assert!(lo <= least && most <= hi, "{least} to {most} m is beyond {lo} to {hi}");
            // Level ground has nothing to compare.
            (most - least > 0.1).then(|| (hi - lo) / (most - least))
        })
        .collect();
    found.sort_by(f64::total_cmp);
    found.get(found.len() / 2).copied().unwrap_or(1.0)
}

/// Prints how loose the bounds of a planet are at three levels and what they cost; returns the looseness at the
/// finest.
fn report(name: &str, planet: Planet) -> f64 {
    let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
    let [coarse, middle, fine] = [6, 10, 14].map(|level| looseness(&terrain, node_rad(level)));
    let start = Instant::now();
    for dir in starts(20) {
        std::hint::black_box(terrain.height_bounds_near_m(dir, node_rad(10)));
    }
    let each_us = start.elapsed().as_secs_f64() * 1e6 / starts(20).len() as f64;
    eprintln!(
        "{name}: {coarse:.1} times as wide as the ground at level 6, {middle:.1} at 10, {fine:.1} at 14; {each_us:.0} us"
    );
    fine
}

#[test]
fn bounds_of_small_places_are_tight() {
    let mut loose = Vec::new();
    for (name, shape) in shapes() {
        let layers = vec![Layer { shape, amplitude_m: 4000.0, ..Layer::default() }];
        let fine = report(name, Planet { layers, ..Planet::default() });
        if fine > 4.0 {
            loose.push((name, fine));
        }
    }
    for shipped in shipped::ALL {
        // The bounds of a structure are those of its cells: wider than a small place by far.
        if let Some(planet) = shipped.load().ok().filter(|planet| planet.structure.is_none()) {
            let fine = report(shipped.file, planet);
            if fine > 4.0 {
                loose.push((shipped.file, fine));
            }
        }
    }
    assert!(loose.is_empty(), "{loose:?}");
}
