//! Properties of every kind: correct gradients, no jumps, bounds, the same bits everywhere.

use super::*;
use crate::planet;
use crate::planet::param::{Domain, ParamPath, Params, Unit, ValueMut};
use crate::simd::Simd;
use crate::terrain::field::{ALL_OCTAVES, Field};
use crate::terrain::points::Points;
use crate::world::cells::Cells;
use crate::world::weather;
use glam::DVec3;
use proptest::prelude::*;
use std::sync::LazyLock;

const RADIUS_KM: f64 = 6371.0;

/// Directions all over the sphere (a Fibonacci lattice), the axes among them.
pub(super) fn directions(n: usize) -> Vec<DVec3> {
    let spiral = (0..n).map(|i| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        let longitude = i as f64 * 2.399_963_229_728_653;
        DVec3::new(libm::cos(longitude), libm::sin(longitude), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    });
    DVec3::AXES.into_iter().chain(DVec3::AXES.map(|axis| -axis)).chain(spiral).collect()
}

fn values(landform: &Landform, dirs: Vec<DVec3>) -> Vec<f64> {
    Field::new(landform, Simd::detect(), &Points::new(dirs), &[]).value
}

/// The plates and the weather of a planet of its own, for landforms that they steer.
struct Steering {
    plates: Plates,
    weather: Arc<Weather>,
}

static STEERING: LazyLock<Steering> = LazyLock::new(|| {
    let [coarse, plates] = [32, 64].map(|side| Plates::solve(&planet::Plates::default(), 3, side, &|| true).unwrap());
    let inputs = weather::Inputs {
        params: &planet::Weather::default(),
        side: 32,
        heights_m: &coarse.rock.risen_m(),
        more_rain_mm: None,
        sea_level_m: Some(0.0),
        equator_c: 28.0,
        pole_c: -26.0,
        lapse_c_per_km: 6.0,
    };
    let weather = Arc::new(Weather::solve(&inputs, &|| true).unwrap());
    Steering { plates, weather }
});

/// A landform with the world maps that it reads.
fn steered(landform: Landform) -> Landform {
    let Steering { plates, weather } = &*STEERING;
    let maps = Maps { plates: Some((Key::of(&1), plates)), weather: Some((Key::of(&2), weather)) };
    landform.with_maps(&maps).unwrap_or(landform)
}

/// Landforms that world maps steer.
fn steered_shapes() -> [(&'static str, Shape, f64); 4] {
    let dunes = planet::Dunes { follow_wind: true, ..Default::default() };
    [
        ("Folded ridges", Shape::Ridged(planet::Ridged::default()), 3.0),
        ("Folded swirls", Shape::Warped(planet::Warped::default()), 2.0),
        ("Folded mountains", Shape::Gullies(planet::Gullies::default()), 2.0),
        ("Dunes in the wind", Shape::Dunes(dunes), 0.0),
    ]
}

/// Gradients with every octave.
pub(super) fn gradients(landform: &Landform, dirs: &[DVec3]) -> Vec<DVec3> {
    let field = Field::new(landform, Simd::detect(), &Points::new(dirs.to_vec()), ALL_OCTAVES);
    let [x, y, z] = field.gradient(0.0).unwrap();
    (0..dirs.len()).map(|i| DVec3::new(x[i].into(), y[i].into(), z[i].into())).collect()
}

/// The craters of a moon: of all ages, some with floors and peaks.
pub(super) fn moon() -> planet::Craters {
    planet::Craters {
        octaves: 3,
        density: 0.4,
        power: 2.4,
        floor: 0.5,
        peak: 0.4,
        age: 0.9,
        fresh: 0.1,
        ..Default::default()
    }
}

/// Each kind with a name: with defaults, in its other styles, and with parameters that the defaults leave at 0.
pub(super) fn shapes() -> Vec<(&'static str, Shape)> {
    let cells = |style| Shape::Cells(planet::Cells { style, width: 0.4, octaves: 2, ..Default::default() });
    let more = [
        ("Craters of a moon", Shape::Craters(moon())),
        ("Plates", cells(planet::CellStyle::Plates)),
        ("Cracks", cells(planet::CellStyle::Cracks)),
        ("Bumps", cells(planet::CellStyle::Bumps)),
    ];
    // A height map without a picture is flat; `heightmap` tests those with one.
    let has_relief = |(_, shape): &(&'static str, Shape)| !matches!(shape, Shape::HeightMap(_));
    let plain = Shape::NAMES.iter().copied().zip(Shape::all()).filter(has_relief);
    plain.chain(more).collect()
}

/// The same compiled, with a limit on octaves, and the angle of the smallest feature.
fn kinds(most_octaves: u32) -> Vec<(&'static str, Landform, f64)> {
    let kind = |(name, mut shape): (&'static str, Shape)| {
        let (mut smallest_km, mut octave_count) = (f64::MAX, 1);
        shape.each_param(&mut ParamPath::default(), &mut |_, param, value| match value {
            ValueMut::Count(octaves) if param.name.ends_with("octaves") => {
                *octaves = most_octaves.min(*octaves);
                octave_count = octave_count.max(*octaves);
            }
            ValueMut::Number(size_km) if param.unit == Unit::Kilometres => smallest_km = smallest_km.min(*size_km),
            _ => {}
        });
        let smallest_rad = smallest_km / RADIUS_KM * 0.5_f64.powi(octave_count as i32 - 1);
        (name, Landform::new(&shape, 7, RADIUS_KM, Arithmetic::Fine), smallest_rad)
    };
    let steered = steered_shapes().map(|(name, shape, folding)| {
        let (name, landform, smallest_rad) = kind((name, shape));
        (name, steered(landform.folding(folding)), smallest_rad / (1.0 + folding))
    });
    shapes().into_iter().map(kind).chain(steered).collect()
}

#[test]
fn gradients_match_central_differences() {
    for (name, landform, smallest_rad) in kinds(3) {
        let step = 4e-4 * smallest_rad;
        let dirs = directions(4000);
        let gradients = gradients(&landform, &dirs);
        assert!(gradients.iter().all(|g| g.is_finite()), "{name}");
        let along: Vec<DVec3> = dirs.iter().map(|d| d.any_orthonormal_vector()).collect();
        let at = |k: f64| values(&landform, dirs.iter().zip(&along).map(|(d, a)| (*d + *a * k).normalize()).collect());
        let (lo, hi) = (at(-step), at(step));
        let (mut errors, mut slopes): (Vec<f64>, Vec<f64>) = (0..dirs.len())
            .map(|i| {
                let difference = (hi[i] - lo[i]) / (2.0 * step);
                ((difference - gradients[i].dot(along[i])).abs(), difference.abs())
            })
            .unzip();
        errors.sort_by(f64::total_cmp);
        slopes.sort_by(f64::total_cmp);
        let steepest = gradients.iter().zip(&dirs).map(|(g, d)| g.reject_from(*d).length()).fold(0.0, f64::max);
        let (typical, most) = (slopes[dirs.len() * 95 / 100], dirs.len() * 98 / 100);
        // The few that straddle a crease have no slope to compare; but nothing jumps.
        assert!(errors[most] < 4e-3 * typical, "{name}: off by {:e} where slopes are {typical:e}", errors[most]);
        assert!(slopes.iter().all(|slope| *slope < 1.1 * steepest), "{name}: steeper than {steepest:e}");
    }
}

#[test]
fn values_keep_within_their_bounds_and_use_them() {
    // The meaning of an amplitude depends on it: no kind is much flatter or higher than the others.
    for (name, landform, _) in kinds(24) {
        let values = values(&landform, directions(20_000));
        let (lo, hi) = landform.bounds();
        let (least, greatest) = values.iter().fold((f64::MAX, f64::MIN), |(lo, hi), &v| (lo.min(v), hi.max(v)));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let deviation = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64).sqrt();
        assert!(lo <= least && greatest <= hi, "{name}: {least} to {greatest} is beyond {lo} to {hi}");
        assert!(greatest - least > 0.3 * (hi - lo), "{name}: {least} to {greatest} of {lo} to {hi}");
        assert!(mean.abs() < 0.5 && (0.05..0.6).contains(&deviation), "{name}: {mean} +- {deviation}");
    }
}

#[test]
fn heights_have_the_same_bits_with_and_without_gradients_on_every_instruction_set() {
    let points = Points::new(directions(4000));
    let bits = |field: &Field| field.value.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    for (name, landform, _) in kinds(24) {
        let exact = Field::new(&landform, Simd::detect(), &points, ALL_OCTAVES);
        for simd in Simd::available() {
            let of = |spacings_rad: &[f64]| Field::new(&landform, simd, &points, spacings_rad);
            assert!(exact == of(ALL_OCTAVES), "{name}: {}", simd.name());
            // Values alone; bands that show all, some and no octaves; one that shows none.
            for spacings_rad in [&[] as &[f64], &[0.0, 1e-3, 3e-2, 1e9], &[1e9]] {
                let same = of(spacings_rad);
                assert_eq!(bits(&same), bits(&exact), "{name}: {}, {spacings_rad:?}", simd.name());
                assert!(same.gradient(0.0).is_none_or(|g| Some(g) == exact.gradient(0.0)), "{name}: {}", simd.name());
            }
        }
    }
}

/// Ridges on folded rock are longer along the folds than across; elsewhere they have no direction.
#[test]
fn folds_draw_ridges_out_along_them() {
    let (plates, dirs) = (&STEERING.plates, &Cells::of(64).dirs);
    let shape = Shape::Ridged(planet::Ridged { wavelength_km: 60.0, octaves: 2, ..Default::default() });
    let landform = steered(Landform::new(&shape, 1, RADIUS_KM, Arithmetic::Fine).folding(3.0));
    let gradients = gradients(&landform, dirs);
    let ratio = |is_chosen: &dyn Fn(f64) -> bool| {
        let chosen = (0..dirs.len()).filter(|&cell| is_chosen(plates.folds[cell].1));
        let [along, across] = chosen.fold([0.0; 2], |[a, b], cell| {
            let fold = plates.folds[cell].0;
            let aside = dirs[cell].cross(fold);
            [a + gradients[cell].dot(fold).powi(2), b + gradients[cell].dot(aside).powi(2)]
        });
        (across / along).sqrt()
    };
    let (folded, plain) = (ratio(&|share| share > 0.5), ratio(&|share| share < 0.02));
    assert!(folded > 1.4 && (0.8..1.2).contains(&plain), "{folded} {plain}");
}

/// Dunes rise and fall with the wind of the weather.
#[test]
fn dunes_lie_across_the_wind() {
    let dirs = directions(4000);
    let params =
        planet::Dunes { wavelength_km: 50.0, octaves: 1, waviness: 0.0, follow_wind: true, ..Default::default() };
    let landform = steered(Landform::new(&Shape::Dunes(params), 7, RADIUS_KM, Arithmetic::Fine));
    let [mut with, mut across] = [0.0; 2];
    for (dir, gradient) in dirs.iter().zip(gradients(&landform, &dirs)) {
        let wind = STEERING.weather.wind_at(*dir).normalize();
        with += gradient.dot(wind).powi(2);
        across += gradient.dot(dir.cross(wind)).powi(2);
    }
    assert!(with > 9.0 * across, "{with} {across}");
}

/// Prints million octave samples a second for each instruction set, on one core.
#[test]
#[ignore = "prints figures"]
fn speed() {
    let points = Points::new(directions(1 << 15));
    for (name, landform, _) in kinds(24) {
        for simd in Simd::available() {
            let rate = |spacings_rad: &[f64]| {
                let start = std::time::Instant::now();
                let mut samples = 0;
                while start.elapsed().as_secs_f64() < 0.2 {
                    std::hint::black_box(Field::new(&landform, simd, &points, spacings_rad));
                    samples += points.len() * landform.octave_count();
                }
                samples as f64 / start.elapsed().as_secs_f64() * 1e-6
            };
            eprintln!(
                "{name} {}: {:.1} M octave samples/s, {:.1} with gradients",
                simd.name(),
                rate(&[]),
                rate(ALL_OCTAVES)
            );
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
        let plain = shapes().into_iter().map(|(_, shape)| (shape, 0.0));
        for (shape, folding) in plain.chain(steered_shapes().map(|(_, shape, folding)| (shape, folding))) {
            let landform = steered(Landform::new(&shape, seed, RADIUS_KM, Arithmetic::Fine).folding(folding));
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
                random = crate::world::noise::mix(random);
                let high = if choice < 2 { choice == 1 } else { random & 1 == 1 };
                match (value, param.domain) {
                    (ValueMut::Number(v), Domain::Number { min, max, .. }) => *v = if high { max } else { min },
                    (ValueMut::Count(v), Domain::Count { min, max }) => *v = if high { max } else { min },
                    _ => {}
                }
            });
            let landform = Landform::new(&shape, 3, radius_km, Arithmetic::Fine);
            let field = Field::new(&landform, Simd::detect(), &points, ALL_OCTAVES);
            let (lo, hi) = landform.bounds();
            assert!(field.value.iter().all(|v| (lo..=hi).contains(v)), "{shape:?} on {radius_km} km");
            assert!(
                field.gradient(0.0).unwrap().iter().flatten().all(|d| d.is_finite()),
                "{shape:?} on {radius_km} km"
            );
        }
    }
}
