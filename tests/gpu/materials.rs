//! Biomes as materials: colour near and far, and queried against drawn biomes.

use crate::support::{Gpu, SIZE_PX, camera, frame, frame_of, gpu, surface_of, view_of};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Biome, Biomes, Detail, Fbm, Layer, Planet, Shape, Steep, Table};
use tellus::render::DebugView;
use tellus::sphere::LatLon;
use tellus::terrain::GroundMaterials;
use tellus::tiles::Surface;

pub(crate) const PLACE: (f64, f64) = (37.0, 20.0);

/// A bare ball of one biome.
pub(crate) fn ball(biome: Biome) -> Planet {
    let table = Table::uniform(biome.key, 2, 2);
    Planet {
        biomes: Biomes { palette: vec![biome], table, ..Biomes::default() },
        water: None,
        atmosphere: None,
        clouds: None,
        ..Planet::default()
    }
}

pub(crate) fn grey(albedo: f64) -> Biome {
    Biome { color: [albedo; 3], variation: 0.0, specular: 0.0, ..Biome::default() }
}

fn surface(planet: &Arc<Planet>, camera: &Camera) -> Surface {
    surface_of(planet, &View { camera: *camera, size_px: SIZE_PX, quality: Quality::Low })
}

/// The middle pixels of a picture straight down from `altitude_m`.
pub(crate) fn middle(gpu: &mut Gpu, planet: &Planet, altitude_m: f64, sun_lon: f64) -> Vec<[u8; 3]> {
    let planet = Arc::new(planet.clone());
    let camera = camera(&planet, PLACE.0, PLACE.1, altitude_m, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let mut frame = frame(&surface, &planet, camera, (PLACE.0, sun_lon));
    frame.size_px = SIZE_PX.map(|side| side / 2);
    let picture = gpu.draw(&frame);
    let [width, height] = frame.size_px.map(|side| side as usize);
    let pixel = |x: usize, y: usize| std::array::from_fn(|c| picture[(y * width + x) * 4 + c]);
    (height / 4..height * 3 / 4).flat_map(|y| (width / 4..width * 3 / 4).map(move |x| pixel(x, y))).collect()
}

/// For each display code, the albedo of level grey ground that shows it from orbit.
pub(crate) fn albedo_by_byte(gpu: &mut Gpu, sun_lon: f64) -> Vec<f64> {
    const STEPS: u32 = 14;
    let mut known: Vec<(f64, f64)> = vec![(0.0, 0.0)];
    for step in 1..=STEPS {
        let albedo = (f64::from(step) / f64::from(STEPS)).powi(2);
        let pixels = middle(gpu, &ball(grey(albedo)), 2e4, sun_lon);
        let byte = pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64;
        known.push((byte, albedo));
    }
    (0..256)
        .map(|byte| {
            let byte = f64::from(byte);
            let above = known.iter().position(|(b, _)| *b >= byte).unwrap_or(known.len() - 1).max(1);
            let ((b0, a0), (b1, a1)) = (known[above - 1], known[above]);
            a0 + (a1 - a0) * (byte - b0) / (b1 - b0).max(1e-9)
        })
        .collect()
}

/// The colour from orbit equals the colour on the ground within 3%, for each pattern, under a high sun and under low
/// suns from both sides: the ground in view may lie on the slope of a bump.
#[test]
#[ignore = "long: minutes"]
fn every_pattern_is_as_bright_from_orbit_as_from_near() {
    compare_patterns(Detail::ALL, &[vec![PLACE.1], vec![PLACE.1 + 50.0, PLACE.1 - 50.0]]);
}

#[test]
fn gravel_is_as_bright_from_orbit_as_from_near() {
    compare_patterns(&[Detail::Gravel], &[vec![PLACE.1]]);
}

fn compare_patterns(kinds: &[Detail], suns: &[Vec<f64>]) {
    let mut gpu = gpu();
    let mut problems = Vec::new();
    let planets = kinds.iter().filter(|kind| **kind != Detail::None);
    let planets: Vec<_> =
        planets.map(|kind| (*kind, ball(Biome { detail: *kind, detail_m: 1.0, ..grey(0.25) }))).collect();
    for suns in suns {
        let mut sums = vec![[0.0; 2]; planets.len()];
        for sun_lon in suns {
            let albedo = albedo_by_byte(&mut gpu, *sun_lon);
            let mut mean = |planet: &Planet, altitude_m: f64| {
                let pixels = middle(&mut gpu, planet, altitude_m, *sun_lon);
                pixels.iter().map(|p| p.iter().map(|&byte| albedo[usize::from(byte)]).sum::<f64>() / 3.0).sum::<f64>()
                    / pixels.len() as f64
            };
            for ((_, planet), sum) in planets.iter().zip(&mut sums) {
                sum[0] += mean(planet, 6.0) / suns.len() as f64;
                sum[1] += mean(planet, 2e4) / suns.len() as f64;
            }
        }
        for ((kind, _), [near, far]) in planets.iter().zip(sums) {
            println!("{kind:?}: {near:.4} from near, {far:.4} from orbit, suns {suns:?}");
            if (far / 0.25 - 1.0).abs() > 0.03 || (near / far - 1.0).abs() > 0.03 {
                problems.push(format!("{kind:?}: {near} from near, {far} from orbit, suns {suns:?}"));
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}

/// A pattern is visible up close and not from orbit.
#[test]
fn patterns_show_from_near_and_fade_away() {
    let mut gpu = gpu();
    let planet = ball(Biome { detail: Detail::Gravel, ..grey(0.25) });
    let mut spread = |altitude_m: f64| {
        let pixels = middle(&mut gpu, &planet, altitude_m, PLACE.1 + 30.0);
        let mean = pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64;
        (pixels.iter().map(|p| (f64::from(p[1]) - mean).powi(2)).sum::<f64>() / pixels.len() as f64).sqrt()
    };
    let (near, far) = (spread(3.0), spread(2e4));
    assert!(near > 12.0 && far < 5.5, "{near} {far}");
}

/// How much pixels beside each other differ on gravel seen at a slant from 2 m, by their mean, at the size that low
/// quality draws.
fn graininess(gpu: &mut Gpu, quality: Quality) -> f64 {
    let planet = Arc::new(ball(Biome { detail: Detail::Gravel, ..grey(0.25) }));
    let camera = camera(&planet, PLACE.0, PLACE.1, 2.0, 0.0, -10.0);
    let surface = surface(&planet, &camera);
    let mut frame = frame(&surface, &planet, camera, (PLACE.0 + 20.0, PLACE.1 + 30.0));
    frame.quality = quality;
    gpu.draw_only(&frame, 1);
    let ([width, _], light) = gpu.renderer.radiance().unwrap();
    let block = width / (SIZE_PX[0] / 2);
    let at = |x: u32, y: u32| {
        let inside = (0..block * block).map(|i| (x * block + i % block, y * block + i / block));
        inside.map(|(x, y)| f64::from(light[(y * width + x) as usize][1])).sum::<f64>()
    };
    // Ground 8 to 25 m away.
    let rows = SIZE_PX[1] / 4..SIZE_PX[1] / 3;
    let pairs = || rows.clone().flat_map(|y| (1..SIZE_PX[0] / 2).map(move |x| (x, y)));
    let differences: f64 = pairs().map(|(x, y)| (at(x, y) - at(x - 1, y)).abs()).sum();
    differences / pairs().map(|(x, y)| at(x, y)).sum::<f64>()
}

/// Seen at a slant, pixels are long: low quality, too, shows the pattern there and not stripes of its mean.
#[test]
fn the_ground_before_the_feet_is_not_smeared() {
    let mut gpu = gpu();
    let [low, medium] = [Quality::Low, Quality::Medium].map(|quality| graininess(&mut gpu, quality));
    assert!(low > 0.65 * medium && low < 1.6 * medium, "{low} at low, {medium} at medium quality");
}

/// Light of grey ground with a pattern right below the eye, under a sun of an elevation: each pixel of the picture.
fn light_below(gpu: &mut Gpu, detail: Detail, sun_deg: f64, quality: Quality) -> Vec<f64> {
    let planet = Arc::new(ball(Biome { detail, detail_m: 1.5, ..grey(0.25) }));
    let camera = camera(&planet, PLACE.0, PLACE.1, 1.2, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let mut frame = frame(&surface, &planet, camera, (PLACE.0 - (90.0 - sun_deg), PLACE.1));
    frame.quality = quality;
    gpu.draw_only(&frame, 1);
    let (_, light) = gpu.renderer.radiance().unwrap();
    light.iter().map(|light| f64::from(light[1])).collect()
}

/// Near the eye stones hide the sun from one another under a low sun, and the ground stays as bright as level ground.
#[test]
fn stones_of_a_pattern_cast_shadows_on_one_another() {
    let mut gpu = gpu();
    let mean = |light: &[f64]| light.iter().sum::<f64>() / light.len() as f64;
    let dark = |light: &[f64], whole: f64| {
        light.iter().filter(|light| **light < 0.12 * whole).count() as f64 / light.len() as f64
    };
    for quality in [Quality::Medium, Quality::High] {
        let level = mean(&light_below(&mut gpu, Detail::None, 20.0, quality));
        for detail in [Detail::Cobbles, Detail::Scree] {
            let low = light_below(&mut gpu, detail, 20.0, quality);
            let high = light_below(&mut gpu, detail, 70.0, quality);
            let shares = [dark(&low, level), dark(&high, mean(&high))];
            let ratio = mean(&low) / level;
            println!("{detail:?}, {quality:?}: dark {shares:?}, light {ratio}");
            assert!(shares[0] > 0.1 && shares[1] < 0.02, "{detail:?}, {quality:?}: {shares:?} in shadow");
            assert!((ratio - 1.0).abs() < 0.1, "{detail:?}, {quality:?}: {ratio} as bright as level ground");
        }
    }
}

/// Greatest correlation of the fine structure of a picture with itself, moved by 0.7 to 1.5 times `period_px` in any
/// direction.
fn repetition(picture: &[f64], width: usize, period_px: f64) -> f64 {
    let height = picture.len() / width;
    // What is finer than blocks of an eighth of the period: the light of bumps is broader.
    let block = (0.125 * period_px) as usize;
    let around = |middle: usize, end: usize| middle.saturating_sub(block)..(middle + block + 1).min(end);
    let away: Vec<f64> = (0..picture.len())
        .map(|i| {
            let (columns, rows) = (around(i % width, width), around(i / width, height));
            let count = columns.len() * rows.len();
            let sum: f64 = rows.map(|row| picture[row * width..][columns.clone()].iter().sum::<f64>()).sum();
            picture[i] - sum / count as f64
        })
        .collect();
    let variance = away.iter().map(|w| w * w).sum::<f64>() / away.len() as f64;
    let reach = (1.5 * period_px) as usize;
    let correlation = |x: usize, y: usize, mirrored: bool| {
        let (columns, rows) = (width - x, height - y);
        let pairs = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let sum: f64 = pairs
            .map(|(row, column)| {
                let (a, b) = if mirrored { (column + x, column) } else { (column, column + x) };
                away[row * width + a] * away[(row + y) * width + b]
            })
            .sum();
        sum / (columns * rows) as f64 / variance
    };
    let places = (0..=reach).flat_map(|y| (0..=reach).map(move |x| (x, y)));
    let around = places.filter(|(x, y)| (0.7..=1.5).contains(&((*x as f64).hypot(*y as f64) / period_px)));
    around.map(|(x, y)| correlation(x, y, false).max(correlation(x, y, true))).fold(0.0, f64::max)
}

/// Gravel from above over a dozen periods: no part of it is seen again beside itself.
#[test]
fn patterns_do_not_repeat() {
    let mut gpu = gpu();
    let detail_m = 2.0;
    let planet = Arc::new(ball(Biome { detail: Detail::Gravel, detail_m, ..grey(0.25) }));
    let camera = camera(&planet, PLACE.0, PLACE.1, 14.0, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let mut frame = frame(&surface, &planet, camera, (PLACE.0 + 20.0, PLACE.1 + 30.0));
    frame.quality = Quality::Medium;
    gpu.draw_only(&frame, 1);
    let ([width, height], light) = gpu.renderer.radiance().unwrap();
    let ground_m = 2.0 * 14.0 * (0.5 * camera.fov_y_rad).tan();
    let picture: Vec<f64> = light.iter().map(|pixel| f64::from(pixel[1])).collect();
    let found = repetition(&picture, width as usize, detail_m / ground_m * f64::from(height));
    println!("repetition: {found:.3}");
    assert!(found < 0.45, "{found}: the period of the pattern is seen");
}

/// Patches have a pattern of their own: gravel in patches on even ground.
#[test]
fn patches_have_their_own_pattern() {
    let mut gpu = gpu();
    let even = Biome { patches: 0.5, patch_color: [0.25; 3], patch_m: 2.0, ..grey(0.25) };
    let mut rough_blocks = |patch_detail: Detail| {
        let planet = Arc::new(ball(Biome { patch_detail, ..even.clone() }));
        let camera = camera(&planet, PLACE.0, PLACE.1, 6.0, 0.0, -90.0);
        let surface = surface(&planet, &camera);
        let frame = frame(&surface, &planet, camera, (PLACE.0 + 20.0, PLACE.1 + 30.0));
        gpu.draw_only(&frame, 1);
        let ([width, height], light) = gpu.renderer.radiance().unwrap();
        // How much pixels beside each other differ in blocks of 12 x 12, by their mean.
        let contrast = |column: u32, row: u32| {
            let at = |x: u32, y: u32| f64::from(light[((12 * row + y) * width + 12 * column + x) as usize][1]);
            let inside = || (0..12).flat_map(|y| (1..12).map(move |x| (x, y)));
            let differences: f64 = inside().map(|(x, y)| (at(x, y) - at(x - 1, y)).abs()).sum();
            differences / inside().map(|(x, y)| at(x, y)).sum::<f64>()
        };
        let blocks = (0..height / 12).flat_map(|row| (0..width / 12).map(move |column| (column, row)));
        let rough = blocks.clone().filter(|(column, row)| contrast(*column, *row) > 0.04).count();
        rough as f64 / blocks.count() as f64
    };
    let (without, with) = (rough_blocks(Detail::None), rough_blocks(Detail::Gravel));
    println!("rough: {without:.3} without, {with:.3} with gravel in the patches");
    assert!(without < 0.05 && with > 0.3 && with < 0.8, "{without} without, {with} with gravel in the patches");
}

/// The material of a query is the one in the picture: dark sand, and bright gravel in patches.
#[test]
fn the_material_of_a_query_is_the_one_in_the_picture() {
    let mut gpu = gpu();
    let patches =
        Biome { patches: 0.4, patch_color: [0.6; 3], patch_m: 2.0, patch_detail: Detail::Gravel, ..grey(0.03) };
    let planet = Arc::new(ball(Biome { detail: Detail::Beach, ..patches }));
    let camera = camera(&planet, PLACE.0, PLACE.1, 6.0, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let frame = frame(&surface, &planet, camera, PLACE);
    gpu.draw_only(&frame, 1);
    let ([width, height], light) = gpu.renderer.radiance().unwrap();
    let mut brightness: Vec<f32> = light.iter().map(|pixel| pixel[1]).collect();
    brightness.sort_by(f32::total_cmp);
    let (dark, bright) = (brightness[brightness.len() / 10], brightness[brightness.len() * 9 / 10]);
    assert!(bright > 5.0 * dark, "{dark} and {bright}");
    let materials = GroundMaterials::new(&surface.terrain);
    let (mut right, mut points, mut in_patches) = (0, 0, 0);
    for (x, y) in (2..height).step_by(5).flat_map(|y| (2..width).step_by(5).map(move |x| (x, y))) {
        let ndc = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
        let dir = camera.ray_dir_planet(ndc(x, width), -ndc(y, height), view_of(&frame).aspect());
        let away_m = surface.terrain.raycast(camera.position_planet_m, dir).unwrap();
        let point = (camera.position_planet_m + dir * away_m).normalize();
        let material = materials.at(point, &surface.terrain.sample(point));
        assert_eq!(material.detail, if material.is_patch { Detail::Gravel } else { Detail::Beach });
        // Half way between the two, a little lower: gaps in gravel are dark.
        let is_bright = light[(y * width + x) as usize][1] > 0.4 * (dark + bright);
        points += 1;
        in_patches += u32::from(material.is_patch);
        right += u32::from(is_bright == material.is_patch);
    }
    println!("{right} of {points} agree, {in_patches} in patches");
    assert!(f64::from(right) > 0.92 * f64::from(points), "{right} of {points} agree");
    assert!(f64::from(in_patches) > 0.2 * f64::from(points), "{in_patches} of {points} in patches");
}

/// Lava glows at night, and flowing lava moves.
#[test]
fn lava_glows_and_flows() {
    let mut gpu = gpu();
    let lava = Biome { detail: Detail::Lava, glow: 3.0, flow_m_s: 0.2, ..grey(0.05) };
    // It flows downhill.
    let hills = Shape::Fbm(Fbm { wavelength_km: 0.1, octaves: 2, ..Fbm::default() });
    let layers = vec![Layer { amplitude_m: 20.0, shape: hills, ..Layer::default() }];
    let hilly = |biome: Biome| Planet { layers: layers.clone(), ..ball(biome) };
    let planet = Arc::new(hilly(lava.clone()));
    let camera = camera(&planet, PLACE.0, PLACE.1, 4.0, 0.0, -60.0);
    let surface = surface(&planet, &camera);
    let night = (-PLACE.0, PLACE.1 + 180.0);
    let mut draw = |planet: &Planet, time_secs: f64| {
        let mut scene = frame(&surface, planet, camera, night);
        scene.time_secs = time_secs;
        gpu.draw(&scene)
    };
    let first = draw(&planet, 0.0);
    let red = first.chunks(4).filter(|p| p[0] > 60 && p[0] > p[2]).count();
    assert!(red > 500, "{red} pixels glow");
    assert_ne!(first, draw(&planet, 3.0), "it flows");
    let cold = hilly(Biome { glow: 0.0, ..lava.clone() });
    assert!(draw(&cold, 0.0).chunks(4).all(|p| p[0] < 4), "without glow the night is dark");
    let still = hilly(Biome { flow_m_s: 0.0, ..lava });
    assert_eq!(draw(&still, 0.0), draw(&still, 3.0), "without flow it stands");
}

/// The queried biome is the one in the debug view, including the surface rules. Near borders, the width of a pixel
/// decides.
#[test]
fn the_biome_of_a_query_is_the_one_in_the_picture() {
    let mut planet = crate::support::earth();
    planet.clouds = None;
    let colors = [[0.9, 0.1, 0.1], [0.1, 0.9, 0.1], [0.1, 0.1, 0.9], [0.9, 0.9, 0.1], [0.1, 0.9, 0.9]];
    for (biome, color) in planet.biomes.palette.iter_mut().zip(colors) {
        biome.color = color;
        biome.steep = Steep::Biome;
        biome.steep_key = 't';
        (biome.steep_from_deg, biome.steep_to_deg) = (14.0, 22.0);
    }
    (planet.biomes.beach_m, planet.biomes.beach_key) = (40.0, 's');
    (planet.biomes.snow, planet.biomes.snow_key, planet.biomes.snow_below_c) = (true, 'w', 6.0);
    let planet = Arc::new(planet);
    let mut gpu = gpu();
    let (mut right, mut points, mut seen) = (0, 0, std::collections::BTreeSet::new());
    let key_of = |color: [u8; 3]| {
        let distance = |c: &[f64; 3]| -> f64 {
            let shown = color.map(|byte| f64::from(byte) / 255.0);
            // Only the order of the channels matters: the tone curve is monotonic.
            c.iter().zip(shown).map(|(c, s)| if (*c > 0.5) == (s > 0.5) { 0.0 } else { 1.0 }).sum()
        };
        colors.iter().position(|c| distance(c) == 0.0)
    };
    for (lat, lon) in (0..24).map(|i| (-62.0 + 5.3 * f64::from(i), 37.0 * f64::from(i))) {
        let camera = camera(&planet, lat, lon, 2500.0, 0.0, -90.0);
        let surface = surface(&planet, &camera);
        let mut frame = frame(&surface, &planet, camera, (lat, lon));
        frame.debug_view = DebugView::Biome;
        let picture = gpu.draw(&frame);
        let at = |x: usize, y: usize| -> [u8; 3] { std::array::from_fn(|c| picture[(y * 320 + x) * 4 + c]) };
        for (x, y) in (8..180).step_by(16).flat_map(|y| (8..320).step_by(16).map(move |x| (x, y))) {
            let ndc = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
            let dir = camera.ray_dir_planet(ndc(x, 320), -ndc(y, 180), view_of(&frame).aspect());
            let Some(away_m) = surface.terrain.raycast(camera.position_planet_m, dir) else { continue };
            let sample = surface.terrain.sample(camera.position_planet_m + dir * away_m);
            if planet.sea_level_m().is_some_and(|sea_m| sample.height_m < sea_m) {
                continue;
            }
            points += 1;
            seen.insert(sample.biome);
            let around = [(0, 0), (1, 0), (0, 1), (2, 1), (1, 2), (2, 2), (0, 2), (2, 0), (1, 1)];
            let shown = around.iter().any(|(dx, dy)| key_of(at(x + dx - 1, y + dy - 1)) == Some(sample.biome));
            right += u32::from(shown);
        }
    }
    assert!(points > 1500 && seen.len() >= 4, "{points} points of the biomes {seen:?}");
    assert!(f64::from(right) >= 0.99 * f64::from(points), "{right} of {points} agree");
}

/// Prints milliseconds of a frame from 2 m with and without patterns.
#[test]
#[ignore = "long: a report of figures"]
fn report_what_patterns_cost() {
    let mut gpu = gpu();
    for (name, kind) in [("none", Detail::None), ("gravel", Detail::Gravel)] {
        let planet = Arc::new(ball(Biome { detail: kind, ..grey(0.25) }));
        let camera = camera(&planet, PLACE.0, PLACE.1, 2.0, 0.0, -10.0);
        let surface = surface(&planet, &camera);
        for quality in tellus::lod::Quality::ALL {
            let mut frame = frame(&surface, &planet, camera, PLACE);
            frame.quality = quality;
            gpu.draw_only(&frame, 2);
            let best = (0..8).map(|_| {
                let begun = std::time::Instant::now();
                gpu.draw_only(&frame, 1);
                begun.elapsed().as_secs_f64() * 1e3
            });
            println!("{name}, {quality:?}: {:.1} ms", best.fold(f64::MAX, f64::min));
        }
    }
}

/// With the sun behind the eye, half vector and view direction are equal: rounding must not take a root of less than 0.
#[test]
fn a_full_moon_has_no_dots() {
    let mut gpu = gpu();
    let planet = Arc::new(ball(Biome { specular: 0.5, roughness: 0.9, variation: 0.0, ..Biome::default() }));
    let altitude_m = 40.0 * planet.radius_m();
    let mut camera = camera(&planet, 0.0, 0.0, altitude_m, 0.0, -90.0);
    camera.fov_y_rad = 2.2 / 41.0;
    let surface = surface(&planet, &camera);
    let frame = frame(&surface, &planet, camera, (0.0, 0.0));
    let picture = gpu.draw(&frame);
    let [width, height] = SIZE_PX.map(|side| side as usize);
    let level = |x: usize, y: usize| i32::from(picture[(y * width + x) * 4 + 1]);
    let reach = height * 3 / 10;
    let (left, top) = (width / 2 - reach, height / 2 - reach);
    for y in top..top + 2 * reach {
        for x in left..left + 2 * reach {
            let (here, before) = (level(x, y), level(x - 1, y));
            assert!(here > 40 && (here - before).abs() < 25, "{here} beside {before} at {x}, {y}");
        }
    }
}

/// Size of a picture of ground some 50 m away through a long lens, whose pixels are as wide as those of a window.
const LONG_LENS_PX: [u32; 2] = [96, 64];
const LONG_LENS_FOV_DEG: f64 = 4.2;

/// Contrast of gravel 40 to 65 m away, seen from 2 m: standard deviation over mean along rows. A pixel is the mean of
/// `samples` x `samples`.
fn contrast_at_50_m(gpu: &mut Gpu, quality: Quality, samples: u32) -> f64 {
    let planet = Arc::new(ball(Biome { detail: Detail::Gravel, ..grey(0.25) }));
    let camera = camera(&planet, PLACE.0, PLACE.1, 2.0, 0.0, -2.3);
    let camera = Camera { fov_y_rad: LONG_LENS_FOV_DEG.to_radians(), ..camera };
    let view = View { camera, size_px: LONG_LENS_PX.map(|side| side * samples), quality };
    let surface = surface_of(&planet, &view);
    let sun = LatLon::from_degrees(PLACE.0 + 20.0, PLACE.1 + 40.0).direction();
    let light = gpu.radiance(&frame_of(&surface, &planet, view, sun));
    let [width, _] = view.size_px;
    let pixel = |x: u32, y: u32| {
        let inside = (0..samples * samples).map(|i| (x * samples + i % samples, y * samples + i / samples));
        inside.map(|(x, y)| f64::from(light[(y * width + x) as usize][1])).sum::<f64>() / f64::from(samples.pow(2))
    };
    let rows = LONG_LENS_PX[1] * 2 / 5..LONG_LENS_PX[1] * 3 / 5;
    let contrasts: Vec<f64> = rows
        .map(|y| {
            let row: Vec<f64> = (0..LONG_LENS_PX[0]).map(|x| pixel(x, y)).collect();
            let mean = row.iter().sum::<f64>() / row.len() as f64;
            (row.iter().map(|light| (light - mean).powi(2)).sum::<f64>() / row.len() as f64).sqrt() / mean
        })
        .collect();
    contrasts.iter().sum::<f64>() / contrasts.len() as f64
}

/// Ground 50 m away has most of the contrast of a picture with 64 samples a pixel, and no more: it is neither smeared
/// nor does it sparkle.
#[test]
fn patterns_at_a_slant_keep_their_contrast() {
    let mut gpu = gpu();
    for quality in [Quality::Medium, Quality::High] {
        let [shown, truth] = [1, 8].map(|samples| contrast_at_50_m(&mut gpu, quality, samples));
        println!("{quality:?}: {shown:.4} shown, {truth:.4} with 64 samples");
        assert!(truth > 0.01, "{truth}: nothing is seen of the pattern");
        assert!(shown > 0.6 * truth && shown < 1.3 * truth, "{quality:?}: {shown} shown, {truth} with 64 samples");
    }
}
