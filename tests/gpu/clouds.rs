//! Clouds over time, drafts of their maps, and their cover against the field that queries answer from.

use crate::support::{Gpu, SIZE_PX, camera, earth, frame, gpu, inside_disc, lights, preset, surface};
use glam::DVec3;
use std::sync::Arc;
use tellus::clouds::CloudField;
use tellus::lod::Quality;
use tellus::planet::edits::CloudPaint;
use tellus::planet::{Clouds, EditPoint, GroundEdit, Planet, Tool};
use tellus::sphere::{LatLon, spread};
use tellus::terrain::Terrain;

const HOUR_SECS: f64 = 3600.0;

fn cloudy(clouds: Clouds) -> Arc<Planet> {
    Arc::new(Planet { clouds: Some(clouds), ..earth() })
}

/// Mean difference of two pictures, of 255.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.len() as f64
}

/// Clouds move, smoothly, also from one keyframe to the next; a renderer that has seen the time before draws what a new
/// one draws.
#[test]
fn time_moves_clouds_without_a_jump() {
    let planet = cloudy(Clouds { storms: 1.0, wind_km_h: 0.0, ..Clouds::default() });
    let camera = camera(&planet, 10.0, 10.0, 13e6, 40.0, -90.0);
    let surface = surface(&planet, &camera);
    let mut gpu = gpu();
    let draw = |gpu: &mut Gpu, hours: f64| {
        let mut frame = frame(&surface, &planet, camera, (12.0, 0.0));
        frame.time_secs = hours * HOUR_SECS;
        gpu.draw(&frame)
    };
    let before = draw(&mut gpu, 1.99);
    let after = draw(&mut gpu, 2.01);
    let next = draw(&mut gpu, 3.01);
    let day = draw(&mut gpu, 26.0);
    assert!(difference(&before, &after) < 0.3, "{}", difference(&before, &after));
    assert!(difference(&before, &day) > 2.0 * difference(&before, &after).max(0.5), "{}", difference(&before, &day));
    assert_eq!(next, draw(&mut Gpu::new(), 3.01));
}

/// While a slider is dragged the maps are coarse; afterwards they are those of a new renderer.
#[test]
fn a_draft_becomes_the_picture_proper() {
    let [old, new] = [2, 3].map(|seed| cloudy(Clouds { seed, ..Clouds::default() }));
    let camera = camera(&old, 10.0, 10.0, 13e6, 40.0, -90.0);
    let surface = surface(&old, &camera);
    let mut gpu = gpu();
    let draw = |gpu: &mut Gpu, planet: &Arc<Planet>, drafts: bool| {
        let mut frame = frame(&surface, planet, camera, (12.0, 0.0));
        frame.drafts = drafts;
        gpu.draw(&frame)
    };
    let first = draw(&mut gpu, &old, true);
    let draft = draw(&mut gpu, &new, true);
    let proper = draw(&mut gpu, &new, false);
    let fresh = draw(&mut Gpu::new(), &new, false);
    assert_eq!(proper, fresh);
    assert_eq!(proper, draw(&mut gpu, &new, true), "what is whole stays whole");
    let [to_draft, to_old] = [&draft, &first].map(|picture| difference(&proper, picture));
    assert!(to_draft > 0.0 && to_draft < 0.5 * to_old, "{to_draft} {to_old}");
}

/// A stroke of painted clouds is drawn while it grows, and gone when it is undone; what is drawn is what a new renderer
/// draws.
#[test]
fn painted_clouds_come_and_go() {
    let planet = cloudy(Clouds::default());
    let stroke = GroundEdit {
        tool: Tool::Clouds(CloudPaint { amount: -1.0 }),
        radius_km: 3000.0,
        points: [EditPoint { latitude_deg: 10.0, longitude_deg: 10.0, ..EditPoint::default() }].into_iter().collect(),
        ..GroundEdit::default()
    };
    let painted = Arc::new(Planet { edits: [stroke].into_iter().collect(), ..Planet::clone(&planet) });
    let camera = camera(&planet, 10.0, 10.0, 13e6, 0.0, -90.0);
    let mut gpu = gpu();
    let draw = |gpu: &mut Gpu, planet: &Arc<Planet>, drafts: bool| {
        let surface = surface(planet, &camera);
        let mut frame = frame(&surface, planet, camera, (12.0, 0.0));
        frame.drafts = drafts;
        gpu.draw(&frame)
    };
    let before = draw(&mut gpu, &planet, false);
    let draft = draw(&mut gpu, &painted, true);
    let proper = draw(&mut gpu, &painted, false);
    assert_eq!(proper, draw(&mut Gpu::new(), &painted, false));
    // The draft is coarse everywhere, but the sky is clear in the middle.
    let [width, height] = SIZE_PX.map(|side| side as usize);
    let middle = |picture: &[u8]| {
        let rows = picture.chunks(4 * width).skip(3 * height / 8).take(height / 4);
        let bytes: Vec<u8> = rows.flat_map(|row| row[width / 2 * 3..width / 2 * 5].to_vec()).collect();
        bytes.iter().map(|byte| f64::from(*byte)).sum::<f64>() / bytes.len() as f64
    };
    let [before_mean, draft_mean, proper_mean] = [&before, &draft, &proper].map(|picture| middle(picture));
    assert!(before_mean > proper_mean + 4.0, "{before_mean} {proper_mean}");
    assert!((draft_mean - proper_mean).abs() < 0.2 * (before_mean - proper_mean), "{draft_mean} {proper_mean}");
    assert_eq!(draw(&mut gpu, &planet, false), before);
}

/// The more cover queries report, the brighter the disc.
#[test]
fn pictures_show_the_cover_that_queries_report() {
    let mut gpu = gpu();
    let mut seen = Vec::new();
    for coverage in [0.1, 0.4, 0.8] {
        let planet = cloudy(Clouds { coverage, veil: 0.0, ..Clouds::default() });
        let camera = camera(&planet, 10.0, 10.0, 13e6, 40.0, -90.0);
        let surface = surface(&planet, &camera);
        let frame = frame(&surface, &planet, camera, (10.0, 10.0));
        let picture = gpu.draw(&frame);
        let disc = inside_disc(&frame, -0.2 * planet.radius_m());
        let bright: Vec<_> = lights(&picture).into_iter().zip(disc).filter(|(_, inside)| *inside).collect();
        let mean = bright.iter().map(|(light, _)| f64::from(*light)).sum::<f64>() / bright.len() as f64;
        let field = CloudField::new(&Terrain::try_new(planet).unwrap());
        let cover = spread(400).map(|dir| field.cover(dir, 0.0).low).sum::<f64>() / 400.0;
        assert!((cover - coverage).abs() < 0.05, "{cover} {coverage}");
        seen.push(mean);
    }
    assert!(seen[1] > seen[0] + 10.0 && seen[2] > seen[1] + 10.0, "{seen:?}");
}

/// Low quality has the same heaps of cloud as medium quality, from below them and from their own height.
#[test]
fn low_quality_loses_no_puffs() {
    let planet = Arc::new(preset("maren.ron"));
    let mut gpu = gpu();
    let mut found = Vec::new();
    for (altitude_m, pitch) in [(300.0, 20.0), (3000.0, 8.0)] {
        let camera = camera(&planet, 5.0, -120.0, altitude_m, 90.0, pitch);
        let surface = surface(&planet, &camera);
        // Red light: the sky has little of it. One mean for each pixel of low quality.
        let mut reds = |quality: Quality| {
            let mut scene = frame(&surface, &planet, camera, (5.0, -150.0));
            scene.quality = quality;
            gpu.draw_only(&scene, 1);
            let ([width, _], light) = gpu.renderer.radiance().unwrap();
            let block = width / (SIZE_PX[0] / 2);
            let place = |i: u32| (i % (SIZE_PX[0] / 2) * block, i / (SIZE_PX[0] / 2) * block);
            let mean = |(x, y): (u32, u32)| {
                let inside = (0..block * block).map(|i| (y + i / block) * width + x + i % block);
                inside.map(|i| f64::from(light[i as usize][0])).sum::<f64>() / f64::from(block * block)
            };
            (0..SIZE_PX[0] * SIZE_PX[1] / 4).map(place).map(mean).collect::<Vec<_>>()
        };
        let (low, medium) = (reds(Quality::Low), reds(Quality::Medium));
        let mean = medium.iter().sum::<f64>() / medium.len() as f64;
        let spread = medium.iter().map(|red| (red - mean).powi(2)).sum::<f64>();
        let off = low.iter().zip(&medium).map(|(low, medium)| (low - medium).powi(2)).sum::<f64>();
        found.push((off / spread).sqrt());
    }
    assert!(found.iter().all(|unlike| *unlike < 0.45), "shares of what the skies vary by: {found:?}");
}

/// Middle clouds are fields of cells of 0.3 to 1 km, at every quality: the light varies over such lengths. The bars lie
/// under the contrasts of such fields, 29.6 and 31.9. With the blur of other clouds they are 18.4 and 30.7.
#[test]
fn middle_clouds_are_fields_of_cells() {
    let clouds = Clouds { coverage: 0.0, middle: 0.6, layering: -1.0, veil: 0.0, fog: 0.0, ..Clouds::default() };
    let bare = Planet { water: None, atmosphere: None, layers: Vec::new(), ..Planet::default() };
    let planet = Arc::new(Planet { clouds: Some(clouds.clone()), ..bare });
    let field = CloudField::new(&Terrain::try_new(Arc::clone(&planet)).unwrap());
    let is_half = |dir: &DVec3| (0.5..0.7).contains(&field.cover(*dir, 0.0).middle) && dir.z.abs() < 0.5;
    let place = spread(4000).find(is_half).map(LatLon::from_direction).unwrap();
    let top_m = 1e3 * (clouds.altitude_km + clouds.thickness_km + clouds.middle_gap_km + clouds.middle_thickness_km);
    let [lat, lon] = [place.lat_rad, place.lon_rad].map(f64::to_degrees);
    let mut gpu = gpu();
    for (quality, least) in [(Quality::Low, 28.0), (Quality::Medium, 31.3)] {
        // At a slant, steps through the thin layer are longer than cells are wide.
        let camera = camera(&planet, lat, lon, top_m + 3e3, 0.0, -28.0);
        let surface = surface(&planet, &camera);
        let mut scene = frame(&surface, &planet, camera, (lat, lon - 30.0));
        scene.quality = quality;
        scene.post.tone = tellus::render::Tone::Plain;
        let greens: Vec<f64> = gpu.draw(&scene).chunks(4).map(|pixel| f64::from(pixel[1])).collect();
        // A pixel in the middle is 33 m wide and 70 m long at the top of the clouds.
        let [width, height] = SIZE_PX.map(|side| side as usize);
        let mean = |x: usize, y: usize, reach: usize| {
            let rows = greens.chunks(width).skip(y - reach).take(2 * reach + 1);
            let sum: f64 = rows.map(|row| row[x - reach..=x + reach].iter().sum::<f64>()).sum();
            sum / ((2 * reach + 1) as f64).powi(2)
        };
        let places = (16..height - 16).step_by(4).flat_map(|y| (16..width - 16).step_by(4).map(move |x| (x, y)));
        let (mut cells, mut count) = (0.0, 0.0);
        for (x, y) in places {
            // Lengths from 150 m to 2 km.
            cells += (mean(x, y, 2) - mean(x, y, 16)).powi(2);
            count += 1.0;
        }
        let contrast = (cells / count).sqrt();
        println!("{quality:?}: {contrast}");
        assert!(contrast > least, "{quality:?}: a contrast of {contrast} codes");
    }
}

/// No cover draws what no clouds draw, to the bit.
#[test]
fn no_cover_is_no_clouds() {
    let none = Arc::new(Planet { clouds: None, ..earth() });
    let clear = cloudy(Clouds { coverage: 0.0, veil: 0.0, ..Clouds::default() });
    let mut gpu = gpu();
    for altitude_m in [2000.0, 13e6] {
        let camera = camera(&none, 10.0, 10.0, altitude_m, 40.0, -40.0);
        let surface = surface(&none, &camera);
        let [without, with] = [&none, &clear].map(|planet| gpu.draw(&frame(&surface, planet, camera, (30.0, 40.0))));
        assert!(without == with, "differs at {altitude_m} m");
    }
}

/// Where the layer becomes thinner than a pixel the march changes, and the mean brightness does not step.
#[test]
fn the_hand_over_shows_no_step() {
    let planet = cloudy(Clouds { coverage: 0.5, storms: 0.5, ..Clouds::default() });
    let mut gpu = gpu();
    let mut mean = |altitude_m: f64| {
        let camera = camera(&planet, 10.0, 10.0, altitude_m, 0.0, -90.0);
        let surface = surface(&planet, &camera);
        let mut scene = frame(&surface, &planet, camera, (40.0, 40.0));
        scene.post.tone = tellus::render::Tone::Plain;
        let lights = lights(&gpu.draw(&scene));
        f64::from(lights.iter().sum::<u32>()) / lights.len() as f64
    };
    // At this altitude a pixel of 180 rows is half as wide as the layer is thick.
    let clouds = Clouds::default();
    let pixel_rad = 2.0 * (0.5 * tellus::lod::Camera::DEFAULT_FOV_Y_RAD).tan() / 180.0;
    for render_scale in [0.5, 1.0, 2.0] {
        let away_m = 0.5 * clouds.thickness_km * 1e3 / pixel_rad * render_scale;
        let altitude_m = away_m + 1e3 * (clouds.altitude_km + clouds.thickness_km);
        let [near, far] = [0.97, 1.03].map(|share| mean(altitude_m * share));
        let step = (near / far - 1.0).abs();
        assert!(step < 0.04, "{near} below {altitude_m} m, {far} above: a step of {step}");
    }
}
