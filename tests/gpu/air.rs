//! The drawn air: goldens (blessed on Mesa's software driver with `TELLUS_BLESS=1`), continuity over altitude, finite
//! radiance for all parameters, and the tone curves.

use crate::support::{Gpu, camera, frame_of, gpu, surface_of};
use image::RgbImage;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::param::{Domain, ValueMut};
use tellus::planet::{Atmosphere, Fbm, Layer, Planet, STARTING_AIRS, Shape};
use tellus::render::{Metered, Metering, Tone, white_balance};
use tellus::sphere::LatLon;
use tellus::tiles::build_now;

const SIZE_PX: [u32; 2] = [160, 100];

/// Hills under an atmosphere, without water and clouds.
fn under(air: Atmosphere, radius_km: f64, color: [f64; 3]) -> Planet {
    let shape = Shape::Fbm(Fbm { wavelength_km: 400.0, octaves: 10, ..Fbm::default() });
    let hills = Layer { name: "Hills".to_owned(), amplitude_m: 1500.0, shape, ..Layer::default() };
    let mut planet = Planet { radius_km, layers: vec![hills], atmosphere: Some(air), ..Planet::default() };
    for biome in &mut planet.biomes.palette {
        (biome.color, biome.variation) = (color, 0.2);
    }
    planet
}

/// Planets like the Earth, Mars and Titan.
fn planets() -> [(&'static str, Planet); 3] {
    let air = |name: &str| STARTING_AIRS.iter().find(|air| air.name == name).unwrap().make();
    [
        ("earth", under(air("Earth"), 6360.0, [0.12, 0.12, 0.06])),
        ("mars", under(air("Mars"), 3390.0, [0.35, 0.17, 0.08])),
        ("titan", under(air("Titan"), 2575.0, [0.2, 0.13, 0.07])),
    ]
}

/// Altitude (m) and pitch (degrees) of a camera that looks east, and its pictures: name, longitude of the star east of
/// the camera.
type Pose = (f64, f64, &'static [(&'static str, f64)]);

fn poses(planet: &Planet) -> [Pose; 3] {
    let radius_m = planet.radius_m();
    [
        (2.0, 5.0, &[("noon", 25.0), ("sunset", 88.0), ("dusk", 94.0)]),
        (1.9 * radius_m, -90.0, &[("terminator", 100.0), ("disc", 20.0)]),
        (400e3, -19.0, &[("limb", 60.0)]),
    ]
}

/// The difference to the golden of this name, if it exceeds the tolerance.
fn against_golden(name: &str, drawn: &[u8]) -> Option<String> {
    let file = format!("air_{name}.png");
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/goldens").join(&file);
    let rgb: Vec<u8> = drawn.chunks(4).flat_map(|p| p[..3].to_vec()).collect();
    let save = |path: &PathBuf| RgbImage::from_raw(SIZE_PX[0], SIZE_PX[1], rgb.clone()).unwrap().save(path).unwrap();
    if std::env::var_os("TELLUS_BLESS").is_some() {
        save(&path);
        return None;
    }
    let golden = image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8();
    let difference: f64 = rgb.iter().zip(golden.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    let mean = difference / rgb.len() as f64;
    (mean > 1.5).then(|| {
        let seen = std::env::temp_dir().join(file);
        save(&seen);
        format!("{}: differs by {mean:.2} of 255; see {}", path.display(), seen.display())
    })
}

#[test]
fn airs_look_as_they_did_and_sunsets_are_red_on_earth_and_blue_on_mars() {
    let mut gpu = gpu();
    gpu.post.metering = Metering::Instant;
    let mut problems = Vec::new();
    for (name, planet) in planets() {
        let planet = Arc::new(planet);
        for (altitude_m, pitch, pictures) in poses(&planet) {
            let camera = camera(&planet, 5.0, 10.0, altitude_m, 90.0, pitch);
            let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
            let surface = surface_of(&planet, &view);
            for (pose, east) in pictures {
                let sun = LatLon::from_degrees(5.0, 10.0 + east).direction();
                let drawn = gpu.draw(&frame_of(&surface, &planet, view, sun));
                problems.extend(against_golden(&format!("{name}_{pose}"), &drawn));
                if *pose != "sunset" {
                    continue;
                }
                // Beside the star, slightly above the horizon.
                let [red, _, blue] = mean_radiance(&gpu, 60..72, 52..56);
                match name {
                    "earth" => assert!(red > 1.5 * blue, "{name} {red} {blue}"),
                    "mars" => assert!(blue > 1.1 * red, "{name} {red} {blue}"),
                    _ => assert!(red > 2.0 * blue, "{name} {red} {blue}"),
                }
            }
        }
    }
    assert!(problems.is_empty(), "on {}:\n{}", gpu.adapter, problems.join("\n"));
}

/// Mean radiance of a part of the newest frame.
fn mean_radiance(gpu: &Gpu, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> [f64; 3] {
    let ([width, _], pixels) = gpu.renderer.radiance().unwrap();
    let mut sum = [0.0; 3];
    for y in rows.clone() {
        for pixel in &pixels[y * width as usize..][columns.clone()] {
            (0..3).for_each(|k| sum[k] += f64::from(pixel[k]));
        }
    }
    sum.map(|c| c / (rows.len() * columns.len()) as f64)
}

#[test]
fn a_climb_to_space_has_no_jump() {
    let mut gpu = gpu();
    let (_, mut planet) = planets()[0].clone();
    planet.layers.clear();
    let planet = Arc::new(planet);
    // Looks at the sky above the horizon, away from the star. The ground is smooth, so that no relief appears or
    // disappears.
    const STEPS: usize = 80;
    let mut last: Option<Vec<[f32; 3]>> = None;
    let mut changes: Vec<(f64, f64)> = Vec::new();
    for step in 0..STEPS {
        let altitude_m = 1.7 * (400e3_f64 / 1.7).powf(step as f64 / (STEPS - 1) as f64);
        let camera = camera(&planet, 5.0, 10.0, altitude_m, 200.0, 12.0);
        let view = View { camera, size_px: [64, 40], quality: Quality::Medium };
        let surface = build_now(&planet, &View { quality: Quality::Low, ..view }).unwrap();
        gpu.draw(&frame_of(&surface, &planet, view, LatLon::from_degrees(20.0, 50.0).direction()));
        let (_, pixels) = gpu.renderer.radiance().unwrap();
        if let Some(last) = &last {
            let light = |p: &[f32; 3]| f64::from(p[0] + p[1] + p[2]);
            // Stars are moving points.
            let each = pixels.iter().zip(last).map(|(a, b)| (light(a) - light(b)).abs().min(0.2));
            let mean = each.clone().sum::<f64>() / pixels.len() as f64;
            let mut sorted: Vec<f64> = each.collect();
            sorted.sort_by(f64::total_cmp);
            changes.push((mean, sorted[sorted.len() * 99 / 100]));
        }
        last = Some(pixels);
    }
    // No step changes the picture much more than its neighbours.
    for (i, (mean, most)) in changes.iter().enumerate() {
        let around = &changes[i.saturating_sub(4)..(i + 5).min(changes.len())];
        let others = |k: fn(&(f64, f64)) -> f64| {
            let mut all: Vec<f64> = around.iter().map(k).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        };
        assert!(*mean < 3.0 * others(|c| c.0) + 0.002, "step {i}: mean {mean} among {around:?}");
        assert!(*most < 3.0 * others(|c| c.1) + 0.01, "step {i}: 99 in 100 {most} among {around:?}");
    }
}

/// An atmosphere with every parameter at a given share of its range, 0 to 1.
fn air_at(places: &[f64]) -> Atmosphere {
    let (mut planet, mut next) = (Planet { atmosphere: Some(Atmosphere::default()), ..Planet::default() }, 0);
    planet.each(&mut |path, param, value| {
        if !path.to_string().starts_with("atmosphere") {
            return;
        }
        let mut place = || {
            next += 1;
            places[(next - 1) % places.len()]
        };
        let between = |min: f64, max: f64, place: f64| match param.domain {
            Domain::Number { logarithmic: true, .. } => {
                let min = min.max(max * 1e-6);
                min * (max / min).powf(place)
            }
            _ => min + (max - min) * place,
        };
        match (value, param.domain) {
            (ValueMut::Number(number), Domain::Number { min, max, .. }) => *number = between(min, max, place()),
            (ValueMut::Triple(triple), Domain::Triple { max, .. }) => {
                // Most atmospheres are thin; the cube gives more samples to small values.
                *triple = [(); 3].map(|()| max * place().powi(3));
            }
            (ValueMut::Triple(triple), _) => *triple = [(); 3].map(|()| place()),
            _ => {}
        }
    });
    planet.atmosphere.unwrap()
}

#[test]
fn whatever_the_air_every_radiance_is_a_number() {
    let gpu = RefCell::new(gpu());
    let mut runner = TestRunner::new(Config { cases: 40, max_shrink_iters: 60, ..Config::default() });
    let places = prop::collection::vec(0.0..=1.0_f64, 24);
    let cases = (places, 0.0..1.0_f64, -90.0..90.0_f64, -180.0..180.0_f64);
    let result = runner.run(&cases, |(places, altitude, pitch, sun_lon)| {
        let mut planet = under(air_at(&places), 6360.0, [0.2; 3]);
        // Hills alone suffice: they lie above and below the reference sphere.
        planet.layers[0].shape = Shape::Fbm(Fbm { wavelength_km: 400.0, octaves: 2, ..Fbm::default() });
        let planet = Arc::new(planet);
        let altitude_m = 2.0 * 1e7_f64.powf(altitude);
        let camera = camera(&planet, 5.0, 10.0, altitude_m, 90.0, pitch);
        let view = View { camera, size_px: [48, 32], quality: Quality::Medium };
        let surface = build_now(&planet, &View { quality: Quality::Low, ..view }).unwrap();
        let mut gpu = gpu.borrow_mut();
        gpu.draw(&frame_of(&surface, &planet, view, LatLon::from_degrees(8.0, sun_lon).direction()));
        let (_, pixels) = gpu.renderer.radiance().unwrap();
        prop_assert!(!pixels.is_empty());
        for (i, pixel) in pixels.iter().enumerate() {
            prop_assert!(pixel.iter().all(|c| c.is_finite() && *c >= 0.0), "pixel {} is {:?}", i, pixel);
        }
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn the_curves_of_the_shader_are_those_of_the_reference() {
    let mut gpu = gpu();
    let (_, planet) = planets()[1].clone();
    let planet = Arc::new(planet);
    let camera = camera(&planet, 5.0, 10.0, 2.0, 90.0, 5.0);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let (white, mut compared) = (white_balance(&planet), 0);
    (gpu.post.smooth_edges, gpu.post.bloom) = (false, 0.0);
    for tone in Tone::ALL {
        gpu.post.tone = tone;
        for (east, exposure_ev, beyond_ev) in [(25.0, 0.0, 0.0), (70.0, 3.0, 0.3), (85.0, -1.0, 4.0)] {
            let sun = LatLon::from_degrees(5.0, 10.0 + east).direction();
            let mut scene = frame_of(&surface, &planet, view, sun);
            scene.post.exposure_ev = exposure_ev;
            gpu.post.metering = Metering::Fixed(Metered { ev: 0.0, beyond_ev, fill_ev: 0.0 });
            let drawn = gpu.draw(&scene);
            let (_, pixels) = gpu.renderer.radiance().unwrap();
            for (pixel, shown) in pixels.iter().zip(drawn.chunks(4)) {
                let light = [0, 1, 2].map(|k| f64::from(pixel[k]) * white[k] * exposure_ev.exp2());
                let wanted = tone.shown(light, beyond_ev);
                for k in 0..3 {
                    let c = wanted[k];
                    let encoded = if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
                    // One code for the dither, half a code for rounding, and a little for f32.
                    let off = (f64::from(shown[k]) - encoded * 255.0).abs();
                    assert!(off < 2.0, "{tone:?}: {pixel:?} is {:?}, not {wanted:?}", &shown[..3]);
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100_000);
}

/// Mean luminance over the middle third of each row of the newest frame.
fn row_luminance(gpu: &Gpu) -> Vec<f64> {
    let ([width, _], pixels) = gpu.renderer.radiance().unwrap();
    let third = width as usize / 3;
    let light = |p: &[f32; 3]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
    let rows = pixels.chunks(width as usize);
    rows.map(|row| row[third..2 * third].iter().map(light).sum::<f64>() / third as f64).collect()
}

/// Below the horizon, luminance changes steadily on a smooth planet: no row of sky shows through.
#[test]
fn no_band_of_sky_lies_across_the_ground() {
    let mut gpu = gpu();
    let (_, mut planet) = planets()[0].clone();
    // A plateau, so that the ground is not the reference sphere.
    (planet.layers[0].amplitude_m, planet.layers[0].curve) = (1200.0, vec![[-1.0, 1.0], [1.0, 1.0]]);
    for biome in &mut planet.biomes.palette {
        (biome.variation, biome.detail_strength) = (0.0, 0.0);
    }
    let planet = Arc::new(planet);
    for (number, quality) in Quality::ALL.into_iter().enumerate() {
        // Each altitude at one of the qualities, and those where something begins or ends at all of them.
        let altitudes_m = [2.0, 100.0, 900.0, 10e3, 60e3, 400e3, 3e6].into_iter().skip(number).step_by(3);
        for altitude_m in altitudes_m.chain([110e3]) {
            let radius_m = planet.radius_m();
            let dip_rad = ((radius_m + 1200.0) / (radius_m + 1200.0 + altitude_m)).acos();
            // The horizon lies in the upper half of the picture.
            let camera = camera(&planet, 5.0, 10.0, altitude_m, 45.0, -dip_rad.to_degrees() - 12.0);
            let view = View { camera, size_px: [90, 240], quality };
            let surface = build_now(&planet, &View { quality: Quality::Low, ..view }).unwrap();
            gpu.draw(&frame_of(&surface, &planet, view, LatLon::from_degrees(10.0, 40.0).direction()));
            let rows = row_luminance(&gpu);
            let elevation = |row: usize| {
                let y = 1.0 - (row as f64 + 0.5) / rows.len() as f64 * 2.0;
                let dir = camera.ray_dir_planet(0.0, y, view.aspect());
                dir.dot(camera.position_planet_m.normalize()).asin()
            };
            // The limb lies between two rows.
            let first = (0..rows.len()).find(|&row| elevation(row) < -dip_rad).unwrap() + 4;
            for (i, three) in rows[first..].windows(3).enumerate() {
                let kink = (three[0] - 2.0 * three[1] + three[2]).abs() / three[1];
                assert!(kink < 0.25, "{quality:?} from {altitude_m} m: {three:?} at row {}", first + i);
            }
        }
    }
}

/// The glow of the star decreases steadily outwards, at any exposure.
#[test]
fn the_glare_of_the_star_has_no_edge() {
    let mut gpu = gpu();
    let planet = Arc::new(Planet { atmosphere: None, ..under(Atmosphere::default(), 6360.0, [0.2; 3]) });
    let camera = camera(&planet, 5.0, 10.0, 1e7, 90.0, 30.0);
    let view = View { camera, size_px: [240, 136], quality: Quality::Medium };
    let surface = build_now(&planet, &View { quality: Quality::Low, ..view }).unwrap();
    // The star is at the left edge of the middle row.
    let sun = camera.ray_dir_planet(-0.97, 0.0, view.aspect());
    (gpu.post.tone, gpu.post.smooth_edges) = (Tone::Plain, false);
    for (exposure_ev, most) in [(0.0, 1.0), (-4.0, 0.4)] {
        gpu.post.exposure_ev = exposure_ev;
        let drawn = gpu.draw(&frame_of(&surface, &planet, view, sun));
        // The darkest of three rows has hardly a star.
        let row: Vec<u8> = (0..240).map(|x| (67..70).map(|y| drawn[(y * 240 + x) * 4 + 1]).min().unwrap()).collect();
        // Outwards from the smooth edge of the disc.
        let first = row.iter().rposition(|light| *light == 255).unwrap();
        let after: Vec<f64> =
            row[first + 2..].iter().map(|light| f64::from(*light)).take_while(|l| *l > 20.0).collect();
        assert!(after.len() > 12, "{row:?}");
        let steepest = after.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max);
        assert!(after.windows(2).all(|pair| pair[1] <= pair[0] + 2.0) && steepest < 255.0 * most, "{after:?}");
    }
}

/// In a clear night sky, stars are visible, and the sky is brighter near the horizon than at the zenith.
#[test]
fn the_night_sky_has_stars_and_is_not_flat() {
    let mut gpu = gpu();
    gpu.post.metering = Metering::Instant;
    let (_, planet) = planets()[0].clone();
    let planet = Arc::new(planet);
    let camera = camera(&planet, 5.0, 10.0, 2.0, 90.0, 30.0);
    let view = View { camera, size_px: [320, 200], quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let drawn = gpu.draw(&frame_of(&surface, &planet, view, LatLon::from_degrees(5.0, 190.0).direction()));
    let luma = |p: &[u8]| (u32::from(p[0]) + 2 * u32::from(p[1]) + u32::from(p[2])) / 4;
    let sky: Vec<u32> = drawn.chunks(4).take(320 * 150).map(luma).collect();
    let median = |of: &[u32]| {
        let mut all = of.to_vec();
        all.sort_unstable();
        all[all.len() / 2]
    };
    let background = median(&sky);
    let stars = sky.iter().filter(|light| **light > background + 25).count();
    assert!((80..6000).contains(&stars), "{stars} pixels of stars over a sky of {background}");
    let rows = row_luminance(&gpu);
    assert!(rows[130] > 1.3 * rows[10], "near the horizon {}, overhead {}", rows[130], rows[10]);
}

/// While a slider is dragged the LUTs are drafts, without the sums over directions; afterwards they are those of a new
/// renderer.
#[test]
fn a_draft_of_the_air_becomes_the_picture_proper() {
    let [_, (_, old), _] = planets();
    let mut dusty = old.clone();
    dusty.atmosphere.as_mut().unwrap().mie_scattering_per_km = [0.05; 3];
    let camera = camera(&old, 0.0, 0.0, 3000.0, 90.0, 5.0);
    let draw = |gpu: &mut Gpu, planet: &Planet, drafts: bool| {
        let planet = Arc::new(planet.clone());
        let view = View { camera, size_px: SIZE_PX, quality: Quality::Low };
        let surface = surface_of(&planet, &view);
        let mut scene = frame_of(&surface, &planet, view, LatLon::from_degrees(0.0, 60.0).direction());
        scene.drafts = drafts;
        gpu.draw(&scene)
    };
    let mut gpu = Gpu::new();
    let first = draw(&mut gpu, &old, true);
    assert!(first == draw(&mut Gpu::new(), &old, false), "the first LUTs are no drafts");
    let draft = draw(&mut gpu, &dusty, true);
    let proper = draw(&mut gpu, &dusty, false);
    assert!(proper == draw(&mut Gpu::new(), &dusty, false), "a draft is left");
    assert!(proper == draw(&mut gpu, &dusty, true), "what is whole stays whole");
    let off = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum::<u64>();
    let (to_draft, to_old) = (off(&draft, &proper), off(&first, &proper));
    assert!(to_draft > 0 && 2 * to_draft < to_old, "{to_draft} of {to_old}");
}
