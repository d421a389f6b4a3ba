//! Rounding errors of heights: every kind, walked in steps of 0.1 m.
//!
//! The reference is the kind's own formula with every octave in f64.

use super::tests::shapes;
use super::*;
use crate::planet::{Planet, Precision, shipped};
use crate::simd::Simd;
use crate::terrain::Terrain;
use crate::terrain::field::Field;
use crate::terrain::lane::CHUNK;
use crate::terrain::points::Points;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const RADIUS_KM: f64 = 6371.0;

/// Starts of walks: poles, corners and edges of the cube's faces, and points between.
pub(super) fn starts(count: u32) -> Vec<DVec3> {
    let corners = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|side| f64::from(2 * side - 1)));
    let marks = corners.chain([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 1.0, 0.0], [0.0, 1.0, -1.0], [1.0, 0.0, 0.0]]);
    let between = (0..count).map(|k| {
        let turn = f64::from(k) * 2.4;
        [turn.cos(), turn.sin(), (f64::from(k) + 0.5) * 2.0 / f64::from(count) - 1.0]
    });
    marks.chain(between).map(|start| DVec3::from_array(start).normalize()).collect()
}

/// Greatest error of the values of a kind against f64.
fn farthest(shape: &Shape, arithmetic: Arithmetic, starts: &[DVec3]) -> f64 {
    let [landform, exact] = [arithmetic, Arithmetic::Full].map(|a| Landform::new(shape, 11, RADIUS_KM, a));
    let mut worst = 0.0_f64;
    for start in starts {
        let along = start.any_orthonormal_vector() * (0.1e-3 / RADIUS_KM);
        let points = Points::new((0..CHUNK).map(|i| (start + along * i as f64).normalize()).collect());
        let [values, exact] =
            [&landform, &exact].map(|landform| Field::new(landform, Simd::detect(), &points, &[]).value);
        worst = values.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
    }
    worst
}

/// The amplitude at which a kind is measured: 8 km, but less for dunes, which are never a tenth as high.
fn amplitude_m(shape: &Shape) -> f64 {
    if matches!(shape, Shape::Dunes(_)) { 800.0 } else { 8000.0 }
}

#[test]
fn every_kind_is_within_a_millimetre_of_f64() {
    let starts = starts(60);
    let mut too_far = Vec::new();
    for (name, shape) in shapes() {
        let [fine, classic] = [Arithmetic::Fine, Arithmetic::Classic]
            .map(|arithmetic| farthest(&shape, arithmetic, &starts) * amplitude_m(&shape) * 1e3);
        let line = format!("{name}: {fine:.2} mm, as presets before version 3: {classic:.2} mm");
        eprintln!("{line}");
        if fine >= 1.0 {
            too_far.push(line);
        }
    }
    assert!(too_far.is_empty(), "{too_far:#?}");
}

/// Ratio of two durations: the least of many short runs in turn, which other programs disturb the least.
fn times_longer(long: impl Fn(), short: impl Fn()) -> f64 {
    let seconds = |run: &dyn Fn()| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    let least = (0..60).fold((f64::MAX, f64::MAX), |(a, b), _| (a.min(seconds(&long)), b.min(seconds(&short))));
    least.0 / least.1
}

/// Prints the cost of f64 octaves for each kind and the shipped planets, on one core.
#[test]
#[ignore = "prints figures"]
fn cost() {
    let points = Points::new(starts(1011));
    let simd = Simd::detect();
    for (name, shape) in shapes() {
        let [fine, classic] = [Arithmetic::Fine, Arithmetic::Classic].map(|a| Landform::new(&shape, 11, RADIUS_KM, a));
        let ratio = |spacings_rad: &[f64]| {
            let run = |landform: &Landform| drop(black_box(Field::new(landform, simd, &points, spacings_rad)));
            times_longer(|| run(&fine), || run(&classic))
        };
        eprintln!("{name}: {:.2} values, {:.2} with all gradients", ratio(&[]), ratio(&[0.0]));
    }
    for shipped in shipped::ALL {
        // Rivers at far-apart points would take all the time.
        let Ok(planet) = shipped.load().map(|planet| Planet { structure: None, ..planet }) else { continue };
        let [fine, classic] = [Precision::Millimetre, Precision::Classic]
            .map(|precision| Terrain::try_new(Arc::new(Planet { precision, ..planet.clone() })).unwrap());
        let ratio = |spacings_rad: &[f64]| {
            let run = |terrain: &Terrain| drop(black_box(terrain.slopes_at(&points.dirs, spacings_rad)));
            times_longer(|| run(&fine), || run(&classic))
        };
        // Values alone; with gradients of a tile seen from space and its parent; with all gradients.
        let [values, far, near] = [&[] as &[f64], &[4e-3, 8e-3], &[0.0]].map(ratio);
        eprintln!("{}: {values:.2} values, {far:.2} with gradients from space, {near:.2} with all", shipped.file);
    }
}
