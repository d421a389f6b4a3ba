//! Drawn shadows of the ground against ray casts with the evaluator, and the cost of horizon angles.

use crate::support::{Gpu, LAYERED, camera_over, frame_of, gpu, lights, preset, settled, surface_of};
use glam::DVec3;
use std::sync::Arc;
use tellus::lod::{Culling, Quality, View};
use tellus::planet::Planet;
use tellus::render::Scene;
use tellus::sphere::{LatLon, geo};
use tellus::terrain::Terrain;
use tellus::tiles::{Builder, Leaf, Surface, lowest_radius_m};

const SIZE_PX: [u32; 2] = [112, 70];

/// A shipped planet as a moon of one colour: dark pixels are in shadow.
fn bare(file: &str) -> Arc<Planet> {
    let mut planet = preset(file);
    (planet.water, planet.atmosphere, planet.clouds) = (None, None, None);
    for biome in &mut planet.biomes.palette {
        (biome.color, biome.variation) = ([0.8; 3], 0.0);
    }
    Arc::new(planet)
}

fn view(planet: &Arc<Planet>, lat_deg: f64, lon_deg: f64, altitude_m: f64, pitch_deg: f64) -> View {
    let (terrain, place) = (Terrain::try_new(planet.clone()).unwrap(), LatLon::from_degrees(lat_deg, lon_deg));
    let camera = camera_over(&terrain, place, altitude_m, [0.6, pitch_deg.to_radians()]);
    View { camera, size_px: SIZE_PX, quality: Quality::Medium }
}

fn frame<'a>(planet: &'a Planet, surface: &'a Surface, view: View, sun_dir_planet: DVec3) -> Scene<'a> {
    let mut scene = frame_of(surface, planet, view, sun_dir_planet);
    scene.post.exposure_ev = 2.0;
    scene
}

/// A picture against ray casts from the ground to the star, without pixels next to a shadow edge: the number of pixels
/// in shadow and lit, the share of shadowed pixels that is drawn lit, and the share of lit pixels that horizon angles
/// darken.
struct Verdict {
    shadowed: usize,
    lit: usize,
    missing: f64,
    wrong: f64,
}

fn verdict(gpu: &mut Gpu, planet: &Arc<Planet>, view: View, sun_dir: DVec3) -> Verdict {
    let mut surface = surface_of(planet, &view);
    let [width, height] = SIZE_PX.map(|side| side as usize);
    let truth: Vec<Option<bool>> = (0..width * height)
        .map(|i| {
            let ndc = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
            let (x, y) = (ndc(i % width, width), -ndc(i / width, height));
            let eye = view.camera.position_planet_m;
            let ray = view.camera.ray_dir_planet(x, y, view.aspect());
            let distance_m = surface.terrain.raycast(eye, ray)?;
            let ground = eye + ray * distance_m;
            // The ray starts slightly above the ground: relief below a pixel affects only shading.
            let from = ground + ground.normalize() * (distance_m * view.pixel_rad() * 0.2);
            Some(surface.terrain.raycast(from, sun_dir).is_none())
        })
        .collect();
    let with = lights(&gpu.draw(&frame(planet, &surface, view, sun_dir)));
    surface.leaves.iter_mut().for_each(|leaf| leaf.horizon = None);
    let without = lights(&gpu.draw(&frame(planet, &surface, view, sun_dir)));
    let is_lit = |light: u32| light > 12;
    let (mut shadowed, mut lit, mut missing, mut wrong) = (0, 0, 0, 0);
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let mut around = (0..9).map(|i| truth[(y + i / 3 - 1) * width + x + i % 3 - 1]);
            let i = y * width + x;
            let Some(sees_star) = truth[i].filter(|_| around.all(|other| other == truth[i])) else { continue };
            if sees_star {
                lit += 1;
                wrong += usize::from(!is_lit(with[i]) && is_lit(without[i]));
            } else {
                shadowed += 1;
                missing += usize::from(is_lit(with[i]));
            }
        }
    }
    let share = |part: usize, all: usize| part as f64 / all.max(1) as f64;
    Verdict { shadowed, lit, missing: share(missing, shadowed), wrong: share(wrong, lit) }
}

/// File, latitude, longitude, altitude, pitch; elevation and azimuth of the star in degrees.
type Shady = (&'static str, f64, f64, f64, f64, (f64, f64));

/// Several cube faces, from orbit to the ground.
const SHADY: [Shady; 4] = [
    ("pallor.ron", 10.0, 20.0, 300e3, -90.0, (5.0, 80.0)),
    (LAYERED, 30.0, 10.0, 50e3, -50.0, (6.0, 130.0)),
    ("pallor.ron", -35.0, 140.0, 20e3, -60.0, (6.0, 250.0)),
    ("pallor.ron", 75.0, -100.0, 400e3, -90.0, (4.0, 10.0)),
];

#[test]
fn what_is_dark_is_what_cannot_see_the_star() {
    compare_shadows(&SHADY[1..2]);
}

#[test]
#[ignore = "long: half a minute"]
fn what_is_dark_at_all_places_is_what_cannot_see_the_star() {
    compare_shadows(&SHADY);
}

fn compare_shadows(places: &[Shady]) {
    let mut gpu = gpu();
    for &(file, lat, lon, altitude_m, pitch, (height_deg, azimuth_deg)) in places {
        let planet = bare(file);
        let view = view(&planet, lat, lon, altitude_m, pitch);
        let up = LatLon::from_degrees(lat, lon).direction();
        let (east, north) = geo::east_north(up);
        let (sin, cos) = azimuth_deg.to_radians().sin_cos();
        let (rise, along) = height_deg.to_radians().sin_cos();
        let found = verdict(&mut gpu, &planet, view, up * rise + (north * cos + east * sin) * along);
        let Verdict { shadowed, lit, missing, wrong } = found;
        let told = format!(
            "{file} from {altitude_m} m: of {shadowed} in shadow {missing:.3} are lit, of {lit} others {wrong:.3} are dark"
        );
        assert!(shadowed > 100 && lit > 200, "{told}");
        // Ground at grazing light is dim: without horizon angles some of it counts as lit.
        assert!(missing < 0.08 && wrong < 0.08, "{told}");
    }
}

/// What a game asks about the shadow of the ground: horizon angles agree with rays, and a tower's top sees more.
#[test]
fn the_shadow_of_the_ground_at_a_point_is_told_by_horizons_and_by_rays() {
    let (file, lat, lon, altitude_m, pitch, (height_deg, azimuth_deg)) = SHADY[1];
    let planet = bare(file);
    let view = view(&planet, lat, lon, altitude_m, pitch);
    let surface = surface_of(&planet, &view);
    let terrain = &surface.terrain;
    let up = LatLon::from_degrees(lat, lon).direction();
    let (east, north) = geo::east_north(up);
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    let (rise, along) = height_deg.to_radians().sin_cos();
    let (sun_dir, radius_rad) = (up * rise + (north * cos + east * sin) * along, 0.0047);
    let eye_m = view.camera.position_planet_m;
    let picture = lights(&gpu().draw(&frame(&planet, &surface, view, sun_dir)));
    let (mut dark, mut lit, mut apart, mut unlike) = (0, 0, 0, 0);
    let mut seconds = [0.0; 2];
    let [width, height] = SIZE_PX.map(f64::from);
    for (x, y) in (2..SIZE_PX[0]).step_by(5).flat_map(|x| (2..SIZE_PX[1]).step_by(5).map(move |y| (x, y))) {
        let [u, v] = [(f64::from(x) + 0.5) / width * 2.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / height * 2.0];
        let ray = view.camera.ray_dir_planet(u, v, view.aspect());
        let Some(distance_m) = terrain.raycast(eye_m, ray) else { continue };
        // Slightly above the ground: tiles seen from afar do not have its finest relief.
        let ground_m = eye_m + ray * distance_m;
        let place_m = ground_m + ground_m.normalize() * (distance_m * view.pixel_rad() * 0.2);
        let begin = std::time::Instant::now();
        let by_rays = terrain.sun_share(place_m, sun_dir, radius_rad);
        seconds[0] += begin.elapsed().as_secs_f64();
        let begin = std::time::Instant::now();
        let by_horizon = surface.sun_share(place_m, sun_dir, radius_rad).unwrap();
        seconds[1] += begin.elapsed().as_secs_f64();
        assert!((0.0..=1.0).contains(&by_rays) && (0.0..=1.0).contains(&by_horizon), "{by_rays} {by_horizon}");
        // The middle of the disc decides for a disc without width.
        let middle = terrain.sun_share(place_m, sun_dir, 0.0);
        assert!((by_rays - 0.5).abs() < 0.05 || (by_rays > 0.5) == (middle > 0.5), "{by_rays} {middle}");
        *(if by_rays > 0.5 { &mut lit } else { &mut dark }) += 1;
        apart += usize::from((by_rays - by_horizon).abs() > 0.5);
        let is_drawn_lit = picture[(y * SIZE_PX[0] + x) as usize] > 12;
        unlike += usize::from((by_horizon - 0.5).abs() > 0.45 && (by_horizon > 0.5) != is_drawn_lit);
        // From high enough every point is lit.
        assert_eq!(terrain.sun_share(place_m * 1.01, sun_dir, radius_rad), 1.0);
    }
    let told = format!(
        "{lit} lit, {dark} dark; {apart} where horizons and rays are apart, {unlike} where the picture is unlike the \
         horizons; {seconds:.4?} s by rays and by horizons"
    );
    eprintln!("{told}");
    // Rays and horizons are apart along the edges of shadows; ground at grazing light is dim.
    assert!(lit > 50 && dark > 30 && apart * 7 < lit + dark && unlike * 12 < lit + dark, "{told}");
    // At night there is no sun.
    assert_eq!(terrain.sun_share(up * terrain.planet().radius_m(), -up, radius_rad), 0.0);
    assert_eq!(surface.sun_share(up * terrain.planet().radius_m(), -up, radius_rad), Some(0.0));
}

#[test]
fn at_noon_nothing_is_in_shadow() {
    let mut gpu = gpu();
    let planet = bare("pallor.ron");
    let view = view(&planet, 10.0, 20.0, 100e3, -90.0);
    let mut surface = surface_of(&planet, &view);
    let noon = LatLon::from_degrees(10.0, 20.0).direction();
    let with = lights(&gpu.draw(&frame(&planet, &surface, view, noon)));
    surface.leaves.iter_mut().for_each(|leaf| leaf.horizon = None);
    let without = lights(&gpu.draw(&frame(&planet, &surface, view, noon)));
    // Of 3 x 255; light reflected between slopes remains.
    let most = with.iter().zip(&without).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most < Some(60), "{most:?}");
}

/// The pixel of a point, which must be in front of the camera.
fn pixel_of(view: &View, place_planet_m: DVec3) -> [f64; 2] {
    let camera = &view.camera;
    let in_view = camera.planet_from_view.conjugate() * (place_planet_m - camera.position_planet_m);
    let tan = (0.5 * camera.fov_y_rad).tan() * -in_view.z;
    let [width, height] = view.size_px.map(f64::from);
    [(in_view.x / (tan * view.aspect()) + 1.0) * 0.5 * width, (1.0 - in_view.y / tan) * 0.5 * height]
}

/// Whether the pixels around a point are all lit or all dark; `None` if mixed.
fn state(lit: &[bool], [width, height]: [usize; 2], [x, y]: [f64; 2]) -> Option<bool> {
    let inside = |at: f64, side: usize| (at >= 1.0 && at < side as f64 - 1.0).then_some(at as usize);
    let (x, y) = (inside(x, width)?, inside(y, height)?);
    let mut around = (0..9).map(|i| lit[(y + i / 3 - 1) * width + x + i % 3 - 1]);
    let first = around.next()?;
    around.all(|other| other == first).then_some(first)
}

#[test]
fn shadows_stay_where_they_are_while_the_camera_moves() {
    const FRAMES: usize = 16;
    let mut gpu = gpu();
    let planet = bare(LAYERED);
    let (lat, lon) = (30.0, 10.0);
    let up = LatLon::from_degrees(lat, lon).direction();
    let (east, north) = geo::east_north(up);
    let (rise, along) = 9.0_f64.to_radians().sin_cos();
    let sun_dir = up * rise + (north * 0.6 + east * 0.8) * along;
    // A descent from 90 km to 20 km with a sideways motion: tiles split all over the picture.
    let views: Vec<View> = (0..FRAMES)
        .map(|i| view(&planet, lat, lon + 0.012 * i as f64, 90e3 * 0.905_f64.powi(i as i32), -80.0))
        .collect();
    let builder = Builder::new(|| {});
    let (mut pictures, mut levels) = (Vec::new(), Vec::new());
    for view in &views {
        let surface = settled(&builder, &planet, view);
        assert!(builder.has_all_tiles());
        levels.push(surface.leaves.iter().map(|leaf| leaf.tile.id.level).max().unwrap());
        let drawn = lights(&gpu.draw(&frame(&planet, &surface, *view, sun_dir)));
        pictures.push(drawn.into_iter().map(|light| light > 12).collect::<Vec<bool>>());
    }
    assert!(levels.last() >= levels.first().map(|level| level + 2).as_ref(), "{levels:?}");

    // Points seen in the last picture are in all pictures.
    let (last, terrain) = (views[FRAMES - 1], Terrain::try_new(planet.clone()).unwrap());
    let (mut seen, mut dark, mut jumped, mut back) = (0, 0, 0, 0);
    for i in 0..40 * 25 {
        let [x, y] = [(f64::from(i % 40) + 0.5) / 20.0 - 1.0, 1.0 - (f64::from(i / 40) + 0.5) / 12.5];
        let eye = last.camera.position_planet_m;
        let ray = last.camera.ray_dir_planet(x, y, last.aspect());
        let Some(distance_m) = terrain.raycast(eye, ray) else { continue };
        let place = eye + ray * distance_m;
        let size = SIZE_PX.map(|side| side as usize);
        let states: Vec<Option<bool>> =
            views.iter().zip(&pictures).map(|(v, lit)| state(lit, size, pixel_of(v, place))).collect();
        // All dark, then all lit in the next frame: a shadow edge jumped more than two pixels.
        let jumps = states.windows(2).filter(|pair| matches!(pair, [Some(a), Some(b)] if a != b)).count();
        let known: Vec<bool> = states.into_iter().flatten().collect();
        let changes = known.windows(2).filter(|pair| pair[0] != pair[1]).count();
        seen += usize::from(known.len() > FRAMES / 3);
        dark += usize::from(known.last() == Some(&false));
        jumped += usize::from(jumps > 0);
        back += usize::from(changes > 1);
    }
    let told = format!("of {seen} places, {dark} of them dark, {jumped} changed at once, {back} and back");
    eprintln!("{told}");
    assert!(seen > 500 && dark > 100 && dark < seen - 100, "{told}");
    assert!(jumped * 100 < seen && back * 500 < seen, "{told}");
}

#[test]
fn only_another_ground_makes_other_horizons() {
    let planet = bare("pallor.ron");
    let view = view(&planet, 10.0, 20.0, 400e3, -90.0);
    let builder = Builder::new(|| {});
    let settled = |planet: &Planet| settled(&builder, &Arc::new(planet.clone()), &view);
    let first = settled(&planet);
    let culling = Culling::new(&view, lowest_radius_m(&first.terrain));
    let seen: Vec<&Leaf> = first.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)).collect();
    assert!(!seen.is_empty() && first.stats.horizons.tiles >= seen.len());
    assert!(seen.iter().all(|leaf| leaf.horizon.as_ref().unwrap().id == leaf.tile.id));
    assert!(builder.memory().horizons >= first.stats.horizons.tiles);

    let mut dusk = Planet::clone(&planet);
    dusk.star.longitude_deg += 40.0;
    dusk.star.latitude_deg = 3.0;
    let moved = settled(&dusk).stats;
    assert_eq!((moved.tiles_built, moved.horizons.tiles), (0, 0), "the star");
    let mut warmer = dusk.clone();
    warmer.climate.equator_c += 5.0;
    let stats = settled(&warmer).stats;
    assert!(stats.tiles_built > 0);
    assert_eq!(stats.horizons.tiles, 0, "the climate");
    let mut rougher = warmer.clone();
    rougher.layers[0].amplitude_m *= 1.1;
    assert_eq!(settled(&rougher).stats.horizons.tiles, first.stats.horizons.tiles, "heights");
}
