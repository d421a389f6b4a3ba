//! Every landform alone: the same bits everywhere and in every version, correct gradients, finite values.
#![allow(clippy::unwrap_used, missing_docs)]

use glam::DVec3;
use proptest::prelude::*;
use std::fmt::Write as _;
use std::sync::Arc;
use tellus::planet::param::{Choice, Domain, Params, ValueMut};
use tellus::planet::{Layer, Planet, Precision, Shape};
use tellus::simd::Simd;
use tellus::sphere::NodeId;
use tellus::terrain::Terrain;

/// A planet of one layer, of usual height for its size.
fn planet(shape: Shape) -> Arc<Planet> {
    precise_planet(shape, Precision::default())
}

fn precise_planet(shape: Shape, precision: Precision) -> Arc<Planet> {
    let amplitude_m = if matches!(shape, Shape::Dunes(_)) { 10.0 } else { 1000.0 };
    Arc::new(Planet { precision, layers: vec![Layer { shape, amplitude_m, ..Layer::default() }], ..Planet::default() })
}

/// The name of a kind.
fn kind(shape: &Shape) -> &'static str {
    Shape::NAMES[shape.index()]
}

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

fn directions(n: usize, mut state: u64) -> Vec<DVec3> {
    let mut next = || 2.0 * random(&mut state) - 1.0;
    (0..n).map(|_| DVec3::new(next(), next(), next()).normalize_or(DVec3::X)).collect()
}

/// FNV-1a over the bits of numbers.
fn hash(numbers: impl Iterator<Item = f64>) -> u64 {
    numbers
        .flat_map(|h| h.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// Bits of heights and normals, on each instruction set, one point at a time and many, on one thread and on all.
#[test]
fn heights_and_normals_keep_their_bits() {
    // Presets of versions 1 and 2 keep the first.
    keep_their_bits(Precision::Classic, include_str!("../goldens/landforms.txt"));
    keep_their_bits(Precision::Millimetre, include_str!("../goldens/landforms_millimetre.txt"));
}

fn keep_their_bits(precision: Precision, golden: &str) {
    let dirs = directions(1500, 7);
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut report = String::new();
    for shape in Shape::all() {
        let name = kind(&shape);
        let terrain = Terrain::try_new(precise_planet(shape, precision)).unwrap();
        let mut hashes = Vec::new();
        for simd in Simd::available() {
            let terrain = terrain.clone().with_simd(simd);
            let heights_m = terrain.heights_m(&dirs);
            assert_eq!(heights_m, one_thread.install(|| terrain.heights_m(&dirs)), "{name}: threads");
            for (dir, height_m) in dirs.iter().zip(&heights_m).step_by(13) {
                assert_eq!(terrain.height_m(*dir).to_bits(), height_m.to_bits(), "{name}: one point");
                assert_eq!(terrain.sample(*dir).height_m.to_bits(), height_m.to_bits(), "{name}: with gradients");
            }
            let normals = dirs.iter().step_by(5).flat_map(|dir| terrain.sample(*dir).normal_planet.to_array());
            hashes.push((simd.name(), hash(heights_m.iter().copied()), hash(normals)));
        }
        for (simd, heights, normals) in &hashes {
            assert_eq!((*heights, *normals), (hashes[0].1, hashes[0].2), "{name}: {simd} has other bits");
        }
        writeln!(report, "{name} {:016x} {:016x}", hashes[0].1, hashes[0].2).unwrap();
    }
    assert_eq!(report, golden, "a kind's default planet changed: presets in use would look different");
}

/// Fewer octaves, so that a difference over a short distance is meaningful.
fn smooth(mut shape: Shape) -> Shape {
    shape.each_param(&mut Default::default(), &mut |_, param, value| {
        if let (ValueMut::Count(count), true) = (value, param.name.ends_with("octaves")) {
            *count = (*count).min(3);
        }
    });
    shape
}

/// Where a kind is steep, a few points may straddle a crease; the others must agree.
#[test]
fn normals_match_central_differences() {
    for shape in Shape::all() {
        let name = kind(&shape);
        let terrain = Terrain::try_new(planet(smooth(shape))).unwrap();
        let radius_m = terrain.planet().radius_m();
        let mut angles: Vec<f64> = directions(400, 11)
            .into_iter()
            .map(|dir| {
                let (a, b) = dir.any_orthonormal_pair();
                let step = 4.0 / radius_m;
                let at = |d: DVec3| d.normalize() * (radius_m + terrain.height_m(d));
                let u = at(dir + a * step) - at(dir - a * step);
                let v = at(dir + b * step) - at(dir - b * step);
                u.cross(v).normalize().angle_between(terrain.sample(dir).normal_planet)
            })
            .collect();
        angles.sort_by(f64::total_cmp);
        let [median, nearly_all] = [angles[200], angles[392]];
        assert!(median < 1e-3 && nearly_all < 0.01, "{name}: {median} rad, 98% within {nearly_all} rad");
    }
}

/// The direction alone decides: across an edge or corner of the cube, both faces give the same value.
#[test]
fn faces_meet_without_a_seam() {
    for shape in Shape::all() {
        let name = kind(&shape);
        let terrain = Terrain::try_new(planet(shape)).unwrap();
        let step_rad = 1e-9;
        for node in NodeId::roots() {
            for i in 0..=16 {
                let along = f64::from(i) / 16.0;
                for edge in [(along, 0.0), (along, 1.0), (0.0, along), (1.0, along)] {
                    let dir = node.direction(edge.0, edge.1);
                    let across = dir.any_orthonormal_vector();
                    let heights_m = terrain.heights_m(&[dir, (dir + across * step_rad).normalize()]);
                    let slope = terrain.sample(dir).slope_rad.tan().max(1.0);
                    let change_m = (heights_m[1] - heights_m[0]).abs();
                    assert!(change_m < 0.01 + 2.0 * slope * step_rad * 6.4e6, "{name}: {change_m} m at {dir}");
                }
            }
        }
    }
}

/// Any allowed value of each parameter, most often its ends.
fn anywhere(shape: &mut Shape, state: &mut u64) {
    shape.each_param(&mut Default::default(), &mut |_, param, value| {
        let pick = random(state);
        let share = if pick < 0.2 {
            0.0
        } else if pick > 0.8 {
            1.0
        } else {
            (pick - 0.2) / 0.6
        };
        match (value, param.domain) {
            (ValueMut::Number(v), Domain::Number { min, max, logarithmic }) => {
                let low = if min > 0.0 { min } else { max * 1e-6 };
                let log = low * (max / low).powf(share);
                *v = if !logarithmic {
                    min + (max - min) * share
                } else if share == 0.0 {
                    min
                } else {
                    log.min(max)
                };
            }
            (ValueMut::Count(v), Domain::Count { min, max }) => {
                *v = min + ((max - min) as f64 * share) as u32;
            }
            (ValueMut::Count(v), _) => *v = (share * f64::from(u32::MAX)) as u32,
            (ValueMut::Flag(v), _) => *v = share > 0.5,
            (ValueMut::Choice(choice), _) if param.name != "shape" => {
                choice.set_index((share * choice.names().len() as f64) as usize);
            }
            _ => {}
        }
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn nothing_leaves_its_bounds_over_the_whole_parameter_space(mut state: u64, radius_km in prop::sample::select(vec![1.0, 50.0, 6371.0, 100_000.0])) {
        for mut shape in Shape::all() {
            anywhere(&mut shape, &mut state);
            let planet = Planet {
                layers: vec![Layer { shape: shape.clone(), amplitude_m: 500.0, ..Layer::default() }],
                radius_km,
                ..Planet::default()
            };
            let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
            let (lo, hi) = terrain.height_bounds_m();
            for dir in directions(12, state) {
                let sample = terrain.sample(dir);
                prop_assert!((lo..=hi).contains(&sample.height_m), "{shape:?}: {} not in {lo}..{hi}", sample.height_m);
                prop_assert!(sample.normal_planet.is_finite() && sample.slope_rad.is_finite(), "{shape:?}");
            }
        }
    }
}
