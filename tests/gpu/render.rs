//! The renderer on a real (software) adapter.

use crate::support::edits::{every_edit, full_planet};
use crate::support::{
    Gpu, SIZE_PX, camera, debug, earth, frame, frame_of, gpu, inside_disc, lights, preset, surface, surface_of, view_of,
};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::param::Stage;
use tellus::planet::{Clouds, Fbm, Layer, Planet, Shape};
use tellus::render::{BodyId, DebugView, Metered, Metering, RenderError, ViewId};
use tellus::sphere::LatLon;

/// Poses from space to the ground, by day, at dusk and at night: altitude, pitch, the sun's longitude.
const POSES: [(f64, f64, f64); 8] = [
    (13e6, -90.0, 0.0),
    (13e6, -90.0, -80.0),
    (400e3, -18.0, 0.0),
    (400e3, -18.0, -100.0),
    (10e3, -12.0, 10.0),
    (100.0, 0.0, -78.0),
    (2.0, 2.0, 0.0),
    (2.0, 90.0, 10.0),
];

#[test]
fn every_pose_is_lit_and_drawn_twice_the_same() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    for (number, quality) in Quality::ALL.into_iter().enumerate() {
        // Each pose at one of the qualities.
        for (altitude_m, pitch, sun_lon) in POSES.into_iter().skip(number).step_by(Quality::ALL.len()) {
            let camera = camera(&planet, 10.0, 10.0, altitude_m, 40.0, pitch);
            let surface = surface(&planet, &camera);
            let mut frame = frame(&surface, &planet, camera, (12.0, sun_lon));
            frame.quality = quality;
            frame.size_px = frame.size_px.map(|side| side / 2);
            let picture = gpu.draw(&frame);
            assert_eq!(picture, gpu.draw(&frame), "{altitude_m} m, {quality:?}");
            // A NaN would be drawn black, and so would every pixel averaged with it.
            let day = sun_lon.abs() < 20.0;
            let disc = inside_disc(&frame, 0.0);
            let black = lights(&picture).iter().zip(&disc).filter(|(light, inside)| **inside && **light < 12).count();
            assert!(!day || black == 0, "{black} black pixels from {altitude_m} m, {quality:?}");
        }
    }
}

/// A target of another size than the view is an error, and stays unchanged.
#[test]
fn a_target_of_another_size_is_refused() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    let camera = camera(&planet, 10.0, 10.0, 13e6, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let frame = frame(&surface, &planet, camera, (12.0, 0.0));
    let [width, height] = frame.size_px;
    for target_px in [[width * 2, height * 2], [width + 1, height], [width, height - 1]] {
        match gpu.draw_into(&frame, target_px) {
            Err(RenderError::TargetSize { target_px: target, picture_px, .. }) => {
                assert_eq!((target, picture_px), (target_px, frame.size_px));
            }
            other => panic!("{target_px:?}: {other:?}"),
        }
    }
    gpu.draw_into(&frame, [width, height]).expect("the right size");
}

#[test]
fn the_surface_has_no_holes() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    for (altitude_m, pitch, _) in POSES {
        let camera = camera(&planet, 40.0, 44.0, altitude_m, 40.0, pitch);
        let surface = surface(&planet, &camera);
        let mut frame = frame(&surface, &planet, camera, (12.0, 0.0));
        frame.debug_view = DebugView::Coverage;
        let picture = gpu.draw(&frame);
        let holes = lights(&picture)
            .iter()
            .zip(inside_disc(&frame, -8000.0))
            .filter(|(light, inside)| *inside && **light != 765)
            .count();
        assert_eq!(holes, 0, "from {altitude_m} m");
        assert!(lights(&picture).iter().all(|&light| light == 0 || light == 765));
    }
}

#[test]
fn clouds_that_cover_nothing_are_no_clouds() {
    let bare = Arc::new(Planet { clouds: None, ..earth() });
    let clear = Planet { clouds: Some(Clouds { coverage: 0.0, veil: 0.0, ..Clouds::default() }), ..earth() };
    let mut gpu = gpu();
    for (altitude_m, pitch, sun_lon) in POSES {
        let camera = camera(&bare, 10.0, 10.0, altitude_m, 40.0, pitch);
        let surface = surface(&bare, &camera);
        let [without, with] = [&*bare, &clear].map(|planet| {
            let mut frame = frame(&surface, planet, camera, (12.0, sun_lon));
            frame.size_px = frame.size_px.map(|side| side / 2);
            gpu.draw(&frame)
        });
        assert_eq!(without, with, "from {altitude_m} m");
    }
}

#[test]
fn closed_clouds_hide_the_ground_from_above_beneath_and_within() {
    let clouds = Clouds { coverage: 1.0, density: 20.0, ..Clouds::default() };
    let dark = Planet { clouds: Some(clouds), ..earth() };
    let mut gpu = gpu();
    // The two planets differ only behind the clouds.
    for (altitude_m, pitch) in [(2000e3, -90.0), (10e3, -60.0), (4e3, 0.0)] {
        let camera = camera(&dark, 10.0, 10.0, altitude_m, 40.0, pitch);
        let bright = Planet { water: None, ..dark.clone() };
        let planet = Arc::new(dark.clone());
        let surface = surface(&planet, &camera);
        let one = lights(&gpu.draw(&frame(&surface, &planet, camera, (12.0, 10.0))));
        let other = lights(&gpu.draw(&frame(&surface, &bright, camera, (12.0, 10.0))));
        let disc = inside_disc(&frame(&surface, &planet, camera, (12.0, 10.0)), 0.0);
        let most = one.iter().zip(&other).zip(disc).filter(|(_, inside)| *inside);
        let most = most.map(|((a, b), _)| a.abs_diff(*b)).max().unwrap_or(0);
        assert!(most <= 12, "the ground shows through by {most} from {altitude_m} m");
    }
}

#[test]
fn the_night_side_of_a_moon_is_black() {
    let moon = Arc::new(Planet { water: None, atmosphere: None, clouds: None, ..earth() });
    let mut gpu = gpu();
    // Antialiasing would blend a star beside the limb into the disc.
    gpu.post.smooth_edges = false;
    let camera = camera(&moon, 0.0, 0.0, 13e6, 0.0, -90.0);
    let surface = surface(&moon, &camera);
    let night = frame(&surface, &moon, camera, (0.0, 180.0));
    let disc = inside_disc(&night, -5000.0);
    let brightest = lights(&gpu.draw(&night)).into_iter().zip(&disc).filter(|(_, i)| **i).map(|(l, _)| l).max();
    assert_eq!(brightest, Some(0));
    let day = lights(&gpu.draw(&frame(&surface, &moon, camera, (0.0, 0.0))));
    let center = day[90 * 320 + 160];
    assert!(center > 60, "{center}");
}

#[test]
fn the_sea_lies_where_the_ground_is_below_its_level() {
    // No clouds, no ice, and no blue air that could be taken for water.
    let mut planet = Planet { clouds: None, atmosphere: None, ..earth() };
    planet.climate.pole_c = 20.0;
    let planet = Arc::new(planet);
    let mut gpu = gpu();
    let camera = camera(&planet, 0.0, 0.0, 13e6, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let frame = frame(&surface, &planet, camera, (20.0, 0.0));
    let picture = gpu.draw(&frame);
    let (mut seas, mut lands) = (0, 0);
    for (x, y) in (50..130).step_by(4).flat_map(|y| (120..200).step_by(4).map(move |x| (x, y))) {
        let ndc = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
        let dir = camera.ray_dir_planet(ndc(x, 320), -ndc(y, 180), view_of(&frame).aspect());
        let Some(away_m) = surface.terrain.raycast(camera.position_planet_m, dir) else { continue };
        let height_m = surface.terrain.height_m(camera.position_planet_m + dir * away_m);
        let [red, _, blue] = [0, 1, 2].map(|c| picture[(y * 320 + x) * 4 + c]);
        // Shallow water shows the sand, and a pixel may contain a coast.
        if height_m < -400.0 {
            seas += 1;
            assert!(blue > red, "{height_m} m at {x} {y}: {red} {blue}");
        } else if height_m > 900.0 {
            lands += 1;
            assert!(red > blue, "{height_m} m at {x} {y}: {red} {blue}");
        }
    }
    assert!(seas > 20 && lands > 20, "{seas} {lands}");
}

#[test]
fn exposure_lights_dusk_and_lets_night_be_read() {
    let planet = Arc::new(Planet { clouds: None, ..earth() });
    let mut gpu = gpu();
    let camera = camera(&planet, 0.0, 0.0, 200.0, 90.0, -8.0);
    let surface = surface(&planet, &camera);
    let mut mean = |sun_lon: f64, metering: Metering| {
        gpu.post.metering = metering;
        let mut frame = frame(&surface, &planet, camera, (0.0, sun_lon));
        frame.size_px = frame.size_px.map(|side| side / 2);
        let light = lights(&gpu.draw(&frame));
        f64::from(light.iter().sum::<u32>()) / light.len() as f64 / 3.0
    };
    let [noon, sunset, dusk, night] = [0.0, 91.0, 96.0, 150.0].map(|lon| mean(lon, Metering::Instant));
    assert!(noon > 60.0 && sunset > 40.0 && dusk > 12.0, "{noon} {sunset} {dusk}");
    assert!(noon > dusk && dusk > 1.5 * night && (8.0..40.0).contains(&night), "{noon} {dusk} {night}");
    assert!(mean(91.0, Metering::Manual) < sunset && mean(96.0, Metering::Manual) < dusk);
    // Adapts gradually from noon to sunset.
    mean(0.0, Metering::Instant);
    let steps = [0.4; 15].map(|secs| mean(91.0, Metering::Adapting { secs }));
    assert!(steps[0] < steps[2] && (steps[14] - sunset).abs() < 1.0, "{steps:?} {sunset}");
}

/// Looking at a low star through dust, the sky is bright but not burnt out, and the ground before it can be read.
#[test]
fn a_dusty_sky_around_a_low_star_keeps_its_colour() {
    let planet = Arc::new(preset("cinnabar.ron"));
    let mut gpu = gpu();
    gpu.post.metering = Metering::Instant;
    let camera = camera(&planet, 13.0, 114.0, 2.0, 270.0, 3.0);
    for (quality, sun_lon) in [(Quality::Low, 28.0), (Quality::High, 28.0), (Quality::Low, 50.0)] {
        let view = View { camera, size_px: [160, 90], quality };
        let surface = surface_of(&planet, &view);
        let sun_dir_planet = LatLon::from_degrees(0.0, sun_lon).direction();
        let light = lights(&gpu.draw(&frame_of(&surface, &planet, view, sun_dir_planet)));
        let share = |counts: &dyn Fn(u32) -> bool| {
            light.iter().filter(|light| counts(**light)).count() as f64 / light.len() as f64
        };
        let (burnt, bright, black) = (share(&|l| l > 3 * 250), share(&|l| l > 3 * 120), share(&|l| l < 3 * 14));
        assert!(burnt < 0.01 && bright > 0.15 && black < 0.05, "{quality:?}, {sun_lon}: {burnt} {bright} {black}");
    }
}

/// As by a graduated filter: the sky stays as it is, and neither daylight nor night nor a view from space has any.
#[test]
fn dark_ground_before_a_bright_sky_is_lifted() {
    let planet = Arc::new(preset("cinnabar.ron"));
    let mut gpu = gpu();
    let draw = |gpu: &mut Gpu, altitude_m: f64, pitch_deg: f64, sun_lon: f64, metering: Metering| {
        gpu.post.metering = metering;
        let camera = camera(&planet, 5.0, 60.0, altitude_m, 90.0, pitch_deg);
        let view = View { camera, size_px: [96, 54], quality: Quality::Low };
        let surface = surface_of(&planet, &view);
        let light =
            lights(&gpu.draw(&frame_of(&surface, &planet, view, LatLon::from_degrees(0.0, sun_lon).direction())));
        (light, gpu.renderer.metered(ViewId::default()).unwrap())
    };
    let (dusk, metered) = draw(&mut gpu, 200.0, 3.0, 146.0, Metering::Instant);
    let (unfilled, _) = draw(&mut gpu, 200.0, 3.0, 146.0, Metering::Fixed(Metered { fill_ev: 0.0, ..metered }));
    let mean = |light: &[u32]| light.iter().sum::<u32>() as f64 / light.len() as f64 / 3.0;
    let (sky, ground) = (..8 * 96, 27 * 96..);
    let raised = [mean(&dusk[ground.clone()]), mean(&unfilled[ground])];
    assert!(metered.fill_ev > 1.0 && raised[0] > 1.5 * raised[1] && raised[0] > 35.0, "{metered:?} {raised:?}");
    let [with, without] = [mean(&dusk[sky]), mean(&unfilled[sky])];
    assert!((0.0..6.0).contains(&(with - without)), "{with} {without}");
    for (altitude_m, pitch_deg, sun_lon) in [(200.0, 3.0, 60.0), (200.0, 3.0, 190.0), (3e6, -60.0, 146.0)] {
        let (_, metered) = draw(&mut gpu, altitude_m, pitch_deg, sun_lon, Metering::Instant);
        assert!(metered.fill_ev < 0.1, "{altitude_m} m, sun {sun_lon}: {metered:?}");
    }
}

/// However great the difference, a frame of a 60th of a second changes the exposure by a fifth of a stop at most.
#[test]
fn exposure_never_jumps() {
    let planet = Arc::new(Planet { clouds: None, ..earth() });
    let mut gpu = gpu();
    let camera = camera(&planet, 0.0, 0.0, 200.0, 90.0, -8.0);
    let surface = surface(&planet, &camera);
    let mut metered_ev = |sun_lon: f64, metering: Metering| {
        gpu.post.metering = metering;
        let mut frame = frame(&surface, &planet, camera, (0.0, sun_lon));
        frame.size_px = [64, 36];
        gpu.draw_only(&frame, 1);
        gpu.renderer.metered(ViewId::default()).unwrap().ev
    };
    let night_ev = metered_ev(150.0, Metering::Instant);
    let noon_ev = metered_ev(0.0, Metering::Instant);
    assert!(night_ev - noon_ev > 6.0, "{noon_ev} {night_ev}");
    let mut before_ev = noon_ev;
    for _ in 0..3 {
        let now_ev = metered_ev(150.0, Metering::Adapting { secs: 1.0 / 60.0 });
        assert!((now_ev - before_ev - 0.2).abs() < 0.01, "{before_ev} {now_ev}");
        before_ev = now_ev;
    }
}

/// With and without air: ridges stand out against the sky, and the ground is not black.
#[test]
fn at_night_the_ground_is_lit_by_the_sky() {
    let layer = Layer {
        amplitude_m: 3000.0,
        shape: Shape::Fbm(Fbm { wavelength_km: 20.0, ..Fbm::default() }),
        ..Layer::default()
    };
    let mut aired = Planet { water: None, clouds: None, layers: vec![layer], ..earth() };
    aired.biomes.palette.iter_mut().for_each(|biome| biome.color = [0.15; 3]);
    let airless = Planet { atmosphere: None, ..aired.clone() };
    let mut gpu = gpu();
    for planet in [aired, airless].map(Arc::new) {
        let camera = camera(&planet, 0.0, 0.0, 500.0, 90.0, 0.0);
        let surface = surface(&planet, &camera);
        let night = frame(&surface, &planet, camera, (0.0, 150.0));
        let is_ground: Vec<bool> = {
            let seen = gpu.draw(&debug(frame(&surface, &planet, camera, (0.0, 0.0)), DebugView::Coverage));
            lights(&seen).iter().map(|light| *light > 0).collect()
        };
        gpu.post.metering = Metering::Instant;
        let light = lights(&gpu.draw(&night));
        let median = |of: bool| {
            let mut all: Vec<u32> =
                light.iter().zip(&is_ground).filter(|(_, ground)| **ground == of).map(|(l, _)| l / 3).collect();
            all.sort_unstable();
            all[all.len() / 2]
        };
        let (ground, sky) = (median(true), median(false));
        assert!((6..60).contains(&ground) && sky > ground + ground / 4 && sky < 90, "ground {ground}, sky {sky}");
        // Antialiasing would blend a star beside a ridge into the ground.
        (gpu.post.metering, gpu.post.smooth_edges) = (Metering::Manual, false);
        let by_day = lights(&gpu.draw(&night));
        gpu.post.smooth_edges = true;
        let most = by_day.iter().zip(&is_ground).filter(|(_, ground)| **ground).map(|(l, _)| *l).max().unwrap_or(0);
        assert!(most < 12, "exposed for the day the night is black, not {most}");
    }
}

#[test]
fn each_parameter_makes_the_tables_it_declares_and_no_others() {
    let planet = Arc::new(full_planet());
    let mut gpu = gpu();
    // Among the clouds all of their parameters count.
    let camera = camera(&planet, 10.0, 10.0, 3e3, 40.0, -90.0);
    // LUTs depend on the planet, not on tiles, so one surface and a very small picture suffice.
    let surface = surface(&planet, &camera);
    let view = View { camera, size_px: [32, 18], quality: Quality::Low };
    let mut draw = |planet: &Planet| {
        // At a later time, wind and length of day have an effect.
        let sun = planet.star.place(1000.0).direction();
        let mut scene = frame_of(&surface, planet, view, sun);
        scene.time_secs = 1000.0;
        let before = gpu.renderer.lut_runs(BodyId::default());
        gpu.draw_only(&scene, 1);
        let after = gpu.renderer.lut_runs(BodyId::default());
        [
            after.uniforms - before.uniforms,
            after.biomes - before.biomes,
            after.weather - before.weather,
            after.optical_depth - before.optical_depth,
            after.air - before.air,
        ]
    };
    draw(&planet);
    // An invalid planet has no revision to draw.
    for edit in every_edit(&planet).into_iter().filter(|edit| edit.planet.check().is_ok()) {
        let stages = [Stage::Uniform, Stage::Material, Stage::CloudMap, Stage::OpticalDepth, Stage::AirTables];
        let mut declared = stages.map(|stage| u64::from(edit.declared.contains(stage)));
        // Renaming a biome's key everywhere changes nothing that is drawn, nor does the name of a texture set that is
        // not there.
        if edit.path.ends_with("].key") || edit.path.ends_with("].textures") {
            declared[1] = 0;
        }
        let drawn = draw(&edit.planet);
        // Another field may have the same mean cover.
        if edit.declared.contains(Stage::CloudMap) {
            declared[0] = drawn[0];
        }
        // New tiles may change uniforms that depend on them.
        if edit.declared.touches_tiles() && declared[0] == 0 {
            declared[0] = drawn[0];
        }
        assert_eq!(drawn, declared, "uniforms, biomes, weather, optical depth, air: {}", edit.path);
        draw(&planet);
    }
}

#[test]
fn a_surface_uploaded_ahead_is_there_when_it_is_drawn() {
    let planet = Arc::new(earth());
    let mut fresh = Gpu::new();
    let camera = camera(&planet, 10.0, 10.0, 13e6, 40.0, -90.0);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Low };
    let surface = surface_of(&planet, &view);
    let tile_bytes = (surface.leaves[0].tile.vertices.len() * size_of::<tellus::lod::Vertex>()) as u64;
    let (mut done, mut rounds, mut before) = (false, 0, 0);
    while !done {
        done = fresh.renderer.upload(BodyId::default(), &surface, 5 * tile_bytes);
        let bytes = fresh.renderer.uploaded_bytes() - before;
        assert!(done || (bytes > 0 && bytes <= 5 * tile_bytes), "{bytes}");
        (before, rounds) = (before + bytes, rounds + 1);
    }
    // Tiles, horizon angles and detail textures.
    let all = fresh.renderer.uploaded_bytes();
    assert!(rounds > 5 && all > surface.leaves.len() as u64 * tile_bytes, "{rounds} {all}");
    let ahead = fresh.draw(&frame(&surface, &planet, camera, (12.0, 0.0)));
    assert_eq!(fresh.renderer.uploaded_bytes(), all, "nothing is uploaded twice");
    let resident = fresh.renderer.resident_bytes();
    assert!(resident > all && resident < 1 << 30, "{resident}");
    fresh.renderer.forget_body(BodyId::default());
    assert!(fresh.renderer.resident_bytes() + all < resident, "what is forgotten takes no memory");
    assert_eq!(fresh.renderer.uploaded_bytes(), all, "what was uploaded stays counted");
    assert_eq!(ahead, gpu().draw(&frame(&surface, &planet, camera, (12.0, 0.0))));
}

/// The colour at a percentile of brightness: `share` of the pixels are brighter.
fn brightest(picture: &[u8], inside: &[bool], share: f64) -> [u8; 3] {
    let mut pixels: Vec<[u8; 3]> =
        picture.chunks(4).zip(inside).filter(|(_, inside)| **inside).map(|(p, _)| [p[0], p[1], p[2]]).collect();
    pixels.sort_by_key(|p| u32::from(p[0]) + u32::from(p[1]) + u32::from(p[2]));
    pixels[((1.0 - share) * pixels.len() as f64) as usize - 1]
}

/// A thin crescent is exposed for its lit part: neither overexposed nor dim.
#[test]
fn a_thin_crescent_keeps_its_colours() {
    let planet = Arc::new(Planet { clouds: None, ..earth() });
    let mut gpu = gpu();
    gpu.post.metering = Metering::Instant;
    let camera = camera(&planet, 10.0, 30.0, 12e6, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let frame = frame(&surface, &planet, camera, (10.0, 185.0));
    let picture = gpu.draw(&frame);
    let disc = inside_disc(&frame, -20_000.0);
    let [top, lit] = [0.001, 0.01].map(|share| brightest(&picture, &disc, share));
    assert!(top.iter().all(|c| *c < 250), "blown out: {top:?}");
    assert!(lit.iter().any(|c| *c > 30), "too dim: {lit:?}");
}

/// Rough ground under a low sun behind the camera has neither fireflies nor black pixels.
#[test]
fn ground_under_a_low_star_has_neither_fireflies_nor_blots() {
    let planet = Arc::new(tellus::planet::shipped::ALL[2].load().expect("Cinnabar"));
    assert_eq!(planet.name, "Cinnabar");
    let mut gpu = gpu();
    let camera = camera(&planet, 13.0, 114.0, 2.0, 60.0, -3.0);
    let sun = tellus::sphere::LatLon::from_degrees(10.0, 37.0).direction();
    for quality in [Quality::Low, Quality::Medium] {
        let view = View { camera, size_px: [320, 200], quality };
        let surface = surface_of(&planet, &view);
        gpu.draw_only(&crate::support::frame_of(&surface, &planet, view, sun), 1);
        let ([width, height], pixels) = gpu.renderer.radiance().expect("radiance");
        let ground = &pixels[(width * height * 55 / 100) as usize..];
        let mut light: Vec<f32> = ground.iter().map(|p| p[0] + p[1] + p[2]).collect();
        light.sort_by(f32::total_cmp);
        let at = |share: f64| light[((light.len() - 1) as f64 * share) as usize];
        assert!(at(1.0) < 3.0 * at(0.98), "{quality:?}: {} beside {}", at(1.0), at(0.98));
        let is_dotted = quality == Quality::Low && at(0.01) < 0.18 * at(0.5);
        assert!(!is_dotted, "{quality:?}: {} beside {}", at(0.01), at(0.5));
    }
}

/// Inside a closed cloud layer, luminance changes steadily from row to row: the horizon is not visible as a line.
#[test]
fn the_horizon_is_no_line_inside_clouds() {
    let clouds = Clouds { coverage: 1.0, density: 12.0, altitude_km: 4.5, thickness_km: 3.0, ..Clouds::default() };
    let planet = Arc::new(Planet { clouds: Some(clouds), layers: Vec::new(), ..earth() });
    let mut gpu = gpu();
    let camera = camera(&planet, 5.0, -5.0, 5000.0, 90.0, -2.0);
    let surface = surface(&planet, &camera);
    let view = View { camera, size_px: [64, 360], quality: Quality::Medium };
    gpu.draw_only(&frame_of(&surface, &planet, view, LatLon::from_degrees(5.0, 50.0).direction()), 1);
    let (_, pixels) = gpu.renderer.radiance().expect("radiance");
    let rows: Vec<f32> = pixels.chunks(64).map(|row| row.iter().map(|p| p[1]).sum::<f32>() / 64.0).collect();
    // A line would differ from the rows ten above and ten below it.
    for (i, at) in rows.windows(21).enumerate() {
        let line = (at[10] - 0.5 * (at[0] + at[20])).abs() / at[10];
        assert!(line < 0.014, "row {}: {line}", i + 10);
    }
}

/// The sea from 1 km is close to the mean of sixteen samples per pixel.
#[test]
fn waves_make_no_moire() {
    // Deep water, so that there is no foam.
    let water = tellus::planet::Water { level_m: 2000.0, ..tellus::planet::Water::default() };
    let planet = Arc::new(Planet { clouds: None, layers: Vec::new(), water: Some(water), ..earth() });
    let mut gpu = gpu();
    gpu.post.smooth_edges = false;
    let camera = camera(&planet, 15.0, 38.4, 1000.0, 60.0, -10.0);
    let surface = surface(&planet, &camera);
    let mut radiance = |size_px: [u32; 2]| {
        let view = View { camera, size_px, quality: Quality::Medium };
        gpu.draw_only(&frame_of(&surface, &planet, view, LatLon::from_degrees(15.0, 85.0).direction()), 1);
        let (_, pixels) = gpu.renderer.radiance().expect("radiance");
        // Perceived brightness, so that glints do not dominate.
        pixels.iter().map(|p| p[1].min(1.0).sqrt()).collect::<Vec<_>>()
    };
    let (width, height) = (160, 100);
    let coarse = radiance([width as u32, height as u32]);
    let fine = radiance([4 * width as u32, 4 * height as u32]);
    let (mut error, mut count) = (0.0, 0.0);
    for y in height / 2..height {
        for x in 0..width {
            let mean = (0..16).map(|i| fine[(4 * y + i / 4) * 4 * width + 4 * x + i % 4]).sum::<f32>() / 16.0;
            error += (coarse[y * width + x] - mean).powi(2);
            count += 1.0;
        }
    }
    let error = (error / count).sqrt();
    assert!(error < 0.0105, "{error}");
}
