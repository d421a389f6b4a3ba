//! Joining layers: against plain formulas, against differences, and with any values that a preset allows.

use crate::support::dice::directions;
use glam::DVec3;
use proptest::prelude::*;
use std::sync::Arc;
use tellus::planet::param::{Choice as _, Curve};
use tellus::planet::{
    Blend, Fbm, HeightMask, LatitudeMask, Layer, LayerMask, Mask, Planet, Shape, SlopeMask, Terraces, validate,
};
use tellus::simd::Simd;
use tellus::terrain::Terrain;

/// Smooth ground with steep slopes.
fn ground(name: &str, seed: u32, wavelength_km: f64, amplitude_m: f64) -> Layer {
    let shape = Shape::Fbm(Fbm { wavelength_km, octaves: 2, ..Fbm::default() });
    Layer { name: name.to_owned(), seed, amplitude_m, shape, ..Layer::default() }
}

fn planet(layers: Vec<Layer>) -> Planet {
    let planet = Planet { radius_km: 100.0, layers, ..Planet::default() };
    assert_eq!(validate::problems(&planet), []);
    planet
}

fn heights(planet: &Planet, dirs: &[DVec3]) -> Vec<f64> {
    Terrain::try_new(Arc::new(planet.clone())).unwrap().heights_m(dirs)
}

/// The noise of a layer: the height of a planet with that layer alone, 1 m high.
fn noise(layer: &Layer, dirs: &[DVec3]) -> Vec<f64> {
    let shape = match &layer.shape {
        Shape::Terraces(Terraces { wavelength_km, octaves, .. }) => {
            Shape::Fbm(Fbm { wavelength_km: *wavelength_km, octaves: *octaves, ..Fbm::default() })
        }
        shape => shape.clone(),
    };
    let alone = Layer { name: "alone".to_owned(), seed: layer.seed, amplitude_m: 1.0, shape, ..Layer::default() };
    heights(&planet(vec![alone]), dirs)
}

fn step(x: f64, from: f64, to: f64, invert: bool) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    let step = 3.0 * t.powi(2) - 2.0 * t.powi(3);
    if invert { 1.0 - step } else { step }
}

/// Interpolation of Fritsch and Carlson, in Hermite form.
fn curve(points: &[[f64; 2]], x: f64) -> f64 {
    let n = points.len();
    if n == 0 {
        return x;
    }
    let d: Vec<f64> = (1..n).map(|k| (points[k][1] - points[k - 1][1]) / (points[k][0] - points[k - 1][0])).collect();
    let mut m = vec![0.0; n];
    (m[0], m[n - 1]) = (d[0], d[n - 2]);
    for k in 1..n - 1 {
        m[k] = if d[k - 1].signum() * d[k].signum() > 0.0 { (d[k - 1] + d[k]) / 2.0 } else { 0.0 };
    }
    for k in 0..n - 1 {
        let length = (m[k] / d[k]).hypot(m[k + 1] / d[k]);
        if d[k] == 0.0 {
            (m[k], m[k + 1]) = (0.0, 0.0);
        } else if length > 3.0 {
            (m[k], m[k + 1]) = (m[k] * 3.0 / length, m[k + 1] * 3.0 / length);
        }
    }
    let k = (0..n - 1).rfind(|&k| x >= points[k][0]).unwrap_or(0);
    if x < points[0][0] {
        return points[0][1] + m[0] * (x - points[0][0]);
    }
    if x > points[n - 1][0] {
        return points[n - 1][1] + m[n - 1] * (x - points[n - 1][0]);
    }
    let w = points[k + 1][0] - points[k][0];
    let t = (x - points[k][0]) / w;
    let (a, b) = ((1.0 + 2.0 * t) * (1.0 - t).powi(2), t * (1.0 - t).powi(2));
    let (c, e) = (t * t * (3.0 - 2.0 * t), t * t * (t - 1.0));
    a * points[k][1] + b * w * m[k] + c * points[k + 1][1] + e * w * m[k + 1]
}

fn blended(layer: &Layer, h: f64, v: f64) -> f64 {
    let (y, soft) = ((v + layer.bias) * layer.amplitude_m, layer.softness_m);
    let round = (soft - (h - y).abs()).max(0.0).powi(2) / (4.0 * soft);
    match layer.blend {
        Blend::Add => h + y,
        Blend::Subtract => h - y,
        Blend::Multiply => h * (v + layer.bias),
        Blend::Max => h.max(y),
        Blend::Min => h.min(y),
        Blend::Replace => y,
        Blend::SmoothMax => h.max(y) + round,
        Blend::SmoothMin => h.min(y) - round,
    }
}

/// Height of the nearest tread of the terraces, less the position between treads, in steps.
fn terraced(params: &Terraces, step_m: f64, h: f64, v: f64) -> f64 {
    let place = h / step_m + params.waviness * v;
    let t = place - place.floor();
    let riser = 0.5 - 0.4 * params.sharpness;
    params.sharpness * (step(t, 0.5 - riser, 0.5 + riser, false) - t)
}

/// Heights by the plainest formulas, without slope masks.
fn reference(planet: &Planet, dirs: &[DVec3]) -> Vec<f64> {
    let noises: Vec<Vec<f64>> = planet.layers.iter().map(|layer| noise(layer, dirs)).collect();
    let place = |i: usize| {
        let mut h = 0.0;
        for (number, layer) in planet.layers.iter().enumerate().filter(|(_, layer)| layer.enabled) {
            let mut v = noises[number][i];
            if let Shape::Terraces(params) = &layer.shape {
                v = terraced(params, layer.amplitude_m, h, v);
            }
            let target = blended(layer, h, curve(&layer.curve, v));
            let mask: f64 = layer.masks.iter().map(|mask| masked(planet, mask, &noises, i, h, dirs[i])).product();
            h += (target - h) * mask;
        }
        curve(&planet.height_curve, h)
    };
    (0..dirs.len()).map(place).collect()
}

fn masked(planet: &Planet, mask: &Mask, noises: &[Vec<f64>], i: usize, h: f64, dir: DVec3) -> f64 {
    match mask {
        Mask::Layer(LayerMask { layer, from, to, invert }) => {
            let number = planet.layers.iter().position(|l| l.name == *layer).unwrap();
            step(noises[number][i], *from, *to, *invert)
        }
        Mask::Height(HeightMask { from_m, to_m, invert }) => step(h, *from_m, *to_m, *invert),
        Mask::Latitude(LatitudeMask { from_deg, to_deg, both, invert }) => {
            let sine = if *both { dir.z.abs() } else { dir.z };
            step(sine, from_deg.to_radians().sin(), to_deg.to_radians().sin(), *invert)
        }
        Mask::Slope(_) | Mask::Painted(_) => unreachable!("left out"),
    }
}

/// A planet for every blend, mask, curve and reshaping, each with a name.
fn cases() -> Vec<(String, Planet)> {
    let base = || ground("Base", 1, 90.0, 1500.0);
    let other = |blend| Layer { bias: 0.1, blend, softness_m: 400.0, ..ground("Other", 2, 60.0, 1200.0) };
    let bend: Curve = vec![[-0.6, -0.2], [-0.1, -0.15], [0.0, 0.1], [0.2, 0.1], [0.3, 0.5], [0.9, -0.2]];
    let mut cases: Vec<(String, Planet)> =
        Blend::ALL.iter().map(|&blend| (format!("{blend:?}"), planet(vec![base(), other(blend)]))).collect();
    for invert in [false, true] {
        let masks = [
            Mask::Layer(LayerMask { layer: "Base".to_owned(), from: 0.3, to: -0.2, invert }),
            Mask::Height(HeightMask { from_m: -300.0, to_m: 500.0, invert }),
            Mask::Latitude(LatitudeMask { from_deg: 10.0, to_deg: 70.0, both: true, invert }),
            Mask::Latitude(LatitudeMask { from_deg: -70.0, to_deg: 40.0, both: false, invert }),
        ];
        for mask in &masks {
            let layer = Layer { masks: vec![mask.clone()], ..other(Blend::SmoothMax) };
            cases.push((format!("{mask:?}"), planet(vec![base(), layer])));
        }
        let layer = Layer { masks: masks.to_vec(), curve: bend.clone(), ..other(Blend::Multiply) };
        cases.push(("all masks".to_owned(), planet(vec![base(), layer, ground("Last", 3, 70.0, 900.0)])));
    }
    let layer = Layer { curve: bend, ..other(Blend::Add) };
    cases.push(("curve".to_owned(), planet(vec![base(), layer.clone()])));
    let height_curve = vec![[-900.0, -100.0], [0.0, 0.0], [400.0, 900.0], [1000.0, 950.0]];
    cases.push(("height curve".to_owned(), Planet { height_curve, ..planet(vec![base(), layer]) }));
    let params = Terraces { sharpness: 0.7, waviness: 1.5, wavelength_km: 50.0, octaves: 2 };
    let terraces = Layer { shape: Shape::Terraces(params), ..ground("Terraces", 4, 1.0, 700.0) };
    let by_height = vec![Mask::Height(HeightMask { from_m: -500.0, to_m: 200.0, invert: false })];
    let bent = Layer { curve: vec![[-0.5, -0.2], [0.5, 0.7]], masks: by_height, bias: 0.3, ..terraces.clone() };
    cases.push(("terraces".to_owned(), planet(vec![base(), terraces])));
    cases.push(("bent terraces".to_owned(), planet(vec![base(), bent, other(Blend::Min)])));
    cases
}

#[test]
fn heights_are_those_of_the_plain_formulas() {
    let dirs = directions(7, 1500);
    for (name, planet) in cases() {
        let mut changed = 0;
        let alone = heights(&Planet { layers: planet.layers[..1].to_vec(), ..planet.clone() }, &dirs);
        for ((found, right), alone) in heights(&planet, &dirs).iter().zip(reference(&planet, &dirs)).zip(alone) {
            assert!((found - right).abs() < 1e-8, "{name}: {found} is not {right}");
            changed += usize::from((found - alone).abs() > 1.0);
        }
        assert!(changed > dirs.len() / 20, "{name} changes little: {changed}");
    }
}

#[test]
fn normals_match_central_differences_for_every_way_of_joining() {
    for (name, planet) in cases() {
        let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
        let radius_m = terrain.planet().radius_m();
        let mut angles: Vec<f64> = Vec::new();
        for dir in directions(7, 400) {
            let sample = terrain.sample(dir);
            let (a, b) = dir.any_orthonormal_pair();
            // Far enough for the rounding of the noise not to matter.
            let step = 5.0 / radius_m;
            let at = |d: DVec3| d.normalize() * (radius_m + terrain.height_m(d));
            let u = at(dir + a * step) - at(dir - a * step);
            let v = at(dir + b * step) - at(dir - b * step);
            angles.push(u.cross(v).normalize().angle_between(sample.normal_planet));
        }
        angles.sort_by(f64::total_cmp);
        // Max and Min have edges, where a difference is the slope of neither side.
        let edges = if name == "Max" || name == "Min" || name == "bent terraces" { 4 } else { 0 };
        let (most, worst) = (angles[angles.len() * 9 / 10], angles[angles.len() - 1 - edges]);
        assert!(most < 2e-4 && worst < 2e-3, "{name}: {most} {worst} rad");
    }
}

/// A planet whose second layer is masked by the slope of the first.
fn on_slopes(over_m: f64, invert: bool) -> Planet {
    let slope = SlopeMask { from_deg: 4.0, to_deg: 12.0, over_m, invert };
    let scree =
        Layer { masks: vec![Mask::Slope(slope)], blend: Blend::Add, bias: 2.0, ..ground("Scree", 2, 30.0, 50.0) };
    planet(vec![ground("Base", 1, 40.0, 1500.0), scree])
}

#[test]
fn masks_by_slope_find_the_slope_of_the_ground_below() {
    let below = Terrain::try_new(Arc::new(planet(vec![ground("Base", 1, 40.0, 1500.0)]))).unwrap();
    let dirs = directions(7, 1000);
    for invert in [false, true] {
        // Over a metre every octave counts: the slope is that of a sample, at the reference radius.
        let terrain = Terrain::try_new(Arc::new(on_slopes(1.0, invert))).unwrap();
        let scree = noise(&terrain.planet().layers[1], &dirs);
        for (dir, scree) in dirs.iter().zip(scree) {
            let sample = below.sample(*dir);
            let rise = sample.slope_rad.tan() * (1.0 + sample.height_m / terrain.planet().radius_m());
            let sine = rise / rise.hypot(1.0);
            let mask = step(sine, 4.0_f64.to_radians().sin(), 12.0_f64.to_radians().sin(), invert);
            let right = sample.height_m + (scree + 2.0) * 50.0 * mask;
            assert!((terrain.height_m(*dir) - right).abs() < 0.01, "{} {right}", terrain.height_m(*dir));
        }
    }
    // Over 100 km, the ground is flat.
    let smooth = heights(&on_slopes(100_000.0, false), &dirs);
    assert_eq!(smooth, below.heights_m(&dirs));
}

/// Any layer, with ends of ranges and odd combinations. `names` are the layers that masks may name.
fn any_layer(number: usize, names: usize) -> impl Strategy<Value = Layer> {
    let shape = (0..Shape::NAMES.len(), prop::sample::select(vec![0.5, 30.0, 4000.0]), any::<bool>());
    let numbers = (prop::sample::select(vec![0.0, 1e-3, 70.0, 3000.0, 1e5]), -2.0..=2.0_f64, 0.0..5000.0_f64);
    let masks = prop::collection::vec(any_mask(number, names), 0..4);
    (shape, numbers, 0..Blend::ALL.len(), any::<u32>(), any_curve(4.0, 0.01), masks).prop_map(
        move |((kind, size_km, smooth), (amplitude_m, bias, softness_m), blend, seed, curve, masks)| {
            let mut shape = Shape::default();
            if let Shape::Fbm(fbm) = &mut shape {
                (fbm.wavelength_km, fbm.octaves) = (size_km, if smooth { 1 } else { 6 });
            }
            shape.set_index(kind);
            Layer {
                name: format!("Layer {number}"),
                seed,
                shape,
                amplitude_m,
                bias,
                softness_m: if smooth { 0.0 } else { softness_m },
                blend: Blend::ALL[blend],
                curve,
                masks,
                enabled: seed % 7 > 0,
                under: false,
                folding: 0.0,
            }
        },
    )
}

fn any_mask(number: usize, names: usize) -> impl Strategy<Value = Mask> {
    (0..4_usize, 0..names, -2.0..=2.0_f64, 0.01..2.0_f64, any::<bool>(), any::<bool>()).prop_map(
        move |(kind, other, from, span, both, invert)| {
            let to = if from > 0.0 { from - span } else { from + span };
            let layer = format!("Layer {}", if other == number { (other + 1) % names } else { other });
            match kind {
                0 => Mask::Layer(LayerMask { layer, from, to, invert }),
                1 => Mask::Height(HeightMask { from_m: from * 2000.0, to_m: to * 2000.0, invert }),
                2 => Mask::Slope(SlopeMask {
                    from_deg: from.abs() * 45.0,
                    to_deg: if from.abs() > 1.0 { 0.0 } else { 90.0 },
                    over_m: if both { 30.0 } else { 20_000.0 },
                    invert,
                }),
                _ => Mask::Latitude(LatitudeMask { from_deg: from * 45.0, to_deg: to * 45.0, both, invert }),
            }
        },
    )
}

fn any_curve(most: f64, least_step: f64) -> impl Strategy<Value = Curve> {
    let points = prop::collection::vec((-1.0..=1.0_f64, -1.0..=1.0_f64), 0..=16);
    (points, any::<bool>()).prop_map(move |(mut points, none)| {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut curve = Curve::new();
        for (x, y) in points {
            if curve.last().is_none_or(|last| x * most - last[0] >= least_step) {
                curve.push([x * most, y * most]);
            }
        }
        if none || curve.len() < 2 { Curve::new() } else { curve }
    })
}

fn any_planet() -> impl Strategy<Value = Planet> {
    let layers = (2..7_usize).prop_flat_map(|n| (0..n).map(|i| any_layer(i, n)).collect::<Vec<_>>());
    let radius_km = prop::sample::select(vec![1.0, 200.0, 6371.0, 100_000.0]);
    (layers, radius_km, any_curve(100_000.0, 1.0)).prop_map(|(layers, radius_km, height_curve)| Planet {
        layers,
        radius_km,
        height_curve,
        ..Planet::default()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_layers_make_finite_ground_within_its_bounds_and_the_same_everywhere(planet in any_planet()) {
        prop_assert_eq!(validate::problems(&planet), []);
        let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
        let dirs = directions(7, 333);
        let heights = terrain.heights_m(&dirs);
        let bits = |heights: &[f64]| -> Vec<u64> { heights.iter().map(|h| h.to_bits()).collect() };
        for simd in Simd::available() {
            prop_assert_eq!(bits(&terrain.clone().with_simd(simd).heights_m(&dirs)), bits(&heights), "{}", simd.name());
        }
        prop_assert_eq!(bits(&terrain.heights_m(&dirs[5..22])), bits(&heights[5..22]));
        let (lo, hi) = terrain.height_bounds_m();
        for (i, (&dir, &height_m)) in dirs.iter().zip(&heights).enumerate() {
            prop_assert!(height_m.is_finite() && lo <= height_m && height_m <= hi, "{} in {}..{}", height_m, lo, hi);
            if i % 16 == 0 {
                let sample = terrain.sample(dir);
                prop_assert_eq!(sample.height_m.to_bits(), height_m.to_bits());
                prop_assert!((sample.normal_planet.length() - 1.0).abs() < 1e-9);
                let angle_rad = 0.3 * f64::from(i as u32 + 1) / 333.0;
                let (near_lo, near_hi) = terrain.height_bounds_near_m(dir, angle_rad);
                prop_assert!(lo <= near_lo && near_hi <= hi);
                for (other, height_m) in dirs.iter().zip(&heights) {
                    if dir.angle_between(*other) <= angle_rad {
                        prop_assert!(near_lo <= *height_m && *height_m <= near_hi, "{}..{}", near_lo, near_hi);
                    }
                }
            }
        }
    }
}
