//! What must hold for every kind of layer.

use super::*;
use crate::planet::param::{Domain, ParamPath, Params, Unit, ValueMut};
use crate::terrain::field::{EXACT, Field};
use crate::terrain::points::Points;
use proptest::prelude::*;

const RADIUS_KM: f64 = 6371.0;

/// Directions spread evenly over the sphere (a Fibonacci lattice).
fn directions(n: usize) -> Vec<DVec3> {
    (0..n)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / n as f64;
            let longitude = i as f64 * 2.399_963_229_728_653;
            DVec3::new(libm::cos(longitude), libm::sin(longitude), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
        })
        .collect()
}

fn values(landform: &Landform, dirs: Vec<DVec3>) -> Vec<f64> {
    Field::new(landform, Simd::detect(), &Points::new(dirs), &[]).value
}

/// Each kind by its name, with at most so many octaves, and the size of its smallest feature as an angle.
fn kinds(most_octaves: u32) -> Vec<(&'static str, Landform, f64)> {
    let kind = |(mut shape, name): (Shape, &'static str)| {
        let (mut smallest_km, mut octave_count) = (f64::MAX, 1);
        shape.each_param(&mut ParamPath::default(), &mut |_, param, value| match value {
            ValueMut::Count(octaves) if param.name == "octaves" => {
                *octaves = most_octaves.min(*octaves);
                octave_count = *octaves;
            }
            ValueMut::Number(size_km) if param.unit == Unit::Kilometres => smallest_km = smallest_km.min(*size_km),
            _ => {}
        });
        let smallest_rad = smallest_km / RADIUS_KM * 0.5_f64.powi(octave_count as i32 - 1);
        (name, Landform::new(&shape, 7, RADIUS_KM), smallest_rad)
    };
    // A height map without a picture is flat; `heightmap` tests those that have one.
    let has_relief = |shape: &Shape| !matches!(shape, Shape::HeightMap(_));
    let all = Shape::all().into_iter().zip(Shape::NAMES.iter().copied());
    all.filter(|(shape, _)| has_relief(shape)).map(kind).collect()
}

#[test]
fn gradients_match_central_differences() {
    for (name, landform, smallest_rad) in kinds(3) {
        let step = 4e-4 * smallest_rad;
        let dirs = directions(3000);
        let gradients = Field::new(&landform, Simd::detect(), &Points::new(dirs.clone()), EXACT);
        let gradients = gradients.gradient(0.0).unwrap();
        let along: Vec<DVec3> = dirs.iter().map(|d| d.any_orthonormal_vector()).collect();
        let at = |k: f64| values(&landform, dirs.iter().zip(&along).map(|(d, a)| (*d + *a * k).normalize()).collect());
        let (lo, hi) = (at(-step), at(step));
        let (mut errors, mut slopes): (Vec<f64>, Vec<f64>) = (0..dirs.len())
            .map(|i| {
                let gradient = DVec3::new(gradients[0][i].into(), gradients[1][i].into(), gradients[2][i].into());
                let difference = (hi[i] - lo[i]) / (2.0 * step);
                ((difference - gradient.dot(along[i])).abs(), difference.abs())
            })
            .unzip();
        errors.sort_by(f64::total_cmp);
        slopes.sort_by(f64::total_cmp);
        let (typical, most) = (slopes[dirs.len() * 95 / 100], dirs.len() * 97 / 100);
        // The few that straddle a crease have no slope to compare.
        assert!(errors[most] < 4e-3 * typical, "{name}: off by {:e} where slopes are {typical:e}", errors[most]);
    }
}

#[test]
fn values_keep_within_their_bounds_and_use_them() {
    for (name, landform, _) in kinds(24) {
        let values = values(&landform, directions(20_000));
        let (lo, hi) = landform.bounds();
        let (least, greatest) = values.iter().fold((f64::MAX, f64::MIN), |(lo, hi), &v| (lo.min(v), hi.max(v)));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let deviation = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64).sqrt();
        assert!(lo <= least && greatest <= hi, "{name}: {least} to {greatest} is beyond {lo} to {hi}");
        assert!(greatest - least > 0.25 * (hi - lo), "{name}: {least} to {greatest} of {lo} to {hi}");
        assert!(mean.abs() < 0.75 && (0.02..0.8).contains(&deviation), "{name}: {mean} +- {deviation}");
    }
}

#[test]
fn heights_have_the_same_bits_with_and_without_gradients_on_every_instruction_set() {
    let points = Points::new(directions(1000));
    for (name, landform, _) in kinds(24) {
        let plain = values(&landform, points.dirs.clone());
        let exact = Field::new(&landform, Simd::detect(), &points, EXACT);
        assert_eq!(plain, exact.value, "{name}");
        for simd in Simd::available() {
            assert!(exact == Field::new(&landform, simd, &points, EXACT), "{name}: {}", simd.name());
            // Bands that see some octaves, and none.
            assert_eq!(plain, Field::new(&landform, simd, &points, &[1e-3, 3e-2, 9.0]).value, "{name}");
        }
    }
}

proptest! {
    #[test]
    fn bounds_near_a_direction_hold_around_it(
        seed: u64, x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in 0.1..1.0_f64, log_angle in -12.0..0.0_f64,
    ) {
        let (dir, angle_rad) = (DVec3::new(x, y, z).normalize(), 10.0_f64.powf(log_angle));
        let (a, b) = dir.any_orthonormal_pair();
        let around = (0..64).map(|i| {
            let (turn, share) = (f64::from(i) * 2.4, (f64::from(i) / 64.0).sqrt());
            (dir + (a * turn.cos() + b * turn.sin()) * (angle_rad * share * 0.99).tan()).normalize()
        });
        let points = Points::new(around.collect());
        for shape in Shape::all() {
            let landform = Landform::new(&shape, seed, 6371.0);
            let (lo, hi) = landform.bounds_near(dir, angle_rad);
            for v in Field::new(&landform, Simd::detect(), &points, &[]).value {
                prop_assert!(lo <= v && v <= hi, "{shape:?}: {v} not in {lo}..{hi} within {angle_rad}");
            }
        }
    }
}

#[test]
fn every_valid_parameter_gives_finite_numbers_within_bounds() {
    let points = Points::new(directions(64));
    for shape in Shape::all() {
        for (radius_km, choice) in [1.0, 6371.0, 100_000.0].into_iter().flat_map(|r| (0..32_u64).map(move |c| (r, c))) {
            let (mut shape, mut random) = (shape.clone(), choice);
            shape.each_param(&mut ParamPath::default(), &mut |_, param, value| {
                random = super::super::noise::mix(random);
                let high = if choice < 2 { choice == 1 } else { random & 1 == 1 };
                match (value, param.domain) {
                    (ValueMut::Number(v), Domain::Number { min, max, .. }) => *v = if high { max } else { min },
                    (ValueMut::Count(v), Domain::Count { min, max }) => *v = if high { max } else { min },
                    _ => {}
                }
            });
            let landform = Landform::new(&shape, 3, radius_km);
            let field = Field::new(&landform, Simd::detect(), &points, EXACT);
            let (lo, hi) = landform.bounds();
            assert!(field.value.iter().all(|v| (lo..=hi).contains(v)), "{shape:?} on {radius_km} km");
            assert!(
                field.gradient(0.0).unwrap().iter().flatten().all(|d| d.is_finite()),
                "{shape:?} on {radius_km} km"
            );
        }
    }
}
