//! Level of detail in pictures: no holes, no popping, mountains beyond the horizon.

use crate::support::dice::Dice;
use crate::support::{LAYERED, camera_over, debug, frame_of, gpu, lights, preset, settled, terrain};
use glam::DVec3;
use std::sync::Arc;
use tellus::lod::morph::shifts_m;
use tellus::lod::range::SHADED_AT;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Fbm, Layer, Planet, Shape, Water, random, shipped};
use tellus::render::{DebugView, Scene};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::tiles::{Builder, Surface, build_now, build_over};

const SIZE_PX: [u32; 2] = [96, 64];

fn draw(frame: &Scene<'_>) -> Vec<u8> {
    gpu().draw(frame)
}

fn sun_dir() -> DVec3 {
    LatLon::from_degrees(30.0, 40.0).direction()
}

/// A planet with nothing in front of the ground.
fn bare(planet: Planet) -> Arc<Planet> {
    Arc::new(Planet { clouds: None, atmosphere: None, water: None, ..planet })
}

/// The ray through a pixel's centre, shifted by `aside` pixels.
fn ray(view: &View, pixel: usize, aside: [f64; 2]) -> DVec3 {
    let [width, height] = view.size_px.map(f64::from);
    let (x, y) = ((pixel as f64 % width).floor(), (pixel as f64 / width).floor());
    let ndc = |at: f64, n: f64| (at + 0.5) / n * 2.0 - 1.0;
    view.camera.ray_dir_planet(ndc(x + aside[0], width), -ndc(y + aside[1], height), view.aspect())
}

/// Pixels that show the background although the rays through and around them hit the ground.
fn holes(view: &View, terrain: &Terrain, picture: &[u8], dice: &mut Dice) -> usize {
    const AROUND: [[f64; 2]; 5] = [[0.0, 0.0], [2.5, 0.0], [-2.5, 0.0], [0.0, 2.5], [0.0, -2.5]];
    let light = lights(picture);
    let [width, height] = view.size_px.map(|side| side as usize);
    let black: Vec<usize> = (0..light.len()).filter(|&i| light[i] == 0).collect();
    let white = |x: usize, y: usize| light[y * width + x] > 0;
    // Ground on all four sides: probably a hole. Of the other pixels, a few suffice.
    let enclosed = |i: usize| {
        let (x, y) = (i % width, i / width);
        (0..x).any(|x| white(x, y))
            && (x + 1..width).any(|x| white(x, y))
            && (0..y).any(|y| white(x, y))
            && (y + 1..height).any(|y| white(x, y))
    };
    let mut suspects: Vec<usize> = black.iter().copied().filter(|&i| enclosed(i)).take(40).collect();
    if !black.is_empty() {
        suspects.extend((0..4).map(|_| black[(dice.roll() * black.len() as f64) as usize]));
    }
    let eye = view.camera.position_planet_m;
    let hit = |i: usize, aside: [f64; 2]| terrain.raycast(eye, ray(view, i, aside)).is_some();
    suspects.into_iter().filter(|&i| AROUND.into_iter().all(|aside| hit(i, aside))).count()
}

/// Looks for holes in pictures of a planet from random poses.
fn look_for_holes(planet: Planet, poses: usize, dice: &mut Dice) {
    let planet = bare(planet);
    let terrain = terrain(&planet);
    for _ in 0..poses {
        let place = dice.place();
        // Rivers and lakes are drawn over the ground: a camera below their surface sees through it.
        let ground = terrain.sample(place.direction());
        let water_m = ground.water_level_m.map_or(0.0, |level_m| (level_m - ground.height_m).max(0.0));
        let altitude_m = water_m + 2.0 * (1.5 * planet.radius_m()).powf(dice.roll());
        // Mostly looks down.
        let (heading, pitch) = (dice.roll() * std::f64::consts::TAU, (dice.roll() - 0.8) * 1.8);
        let camera = camera_over(&terrain, place, altitude_m, [heading, pitch.max(-1.55)]);
        let view = View { camera, size_px: SIZE_PX, quality: Quality::Low };
        let surface = build_over(&terrain, &view);
        let coverage = debug(frame_of(&surface, &planet, view, DVec3::X), DebugView::Coverage);
        let picture = draw(&coverage);
        let holes = holes(&view, &terrain, &picture, dice);
        assert_eq!(holes, 0, "{} from {altitude_m} m, {:?}", planet.name, place.to_degrees());
    }
}

/// The eye stands 2 m above the foot of a wall, and so a few centimetres beside it.
#[test]
fn a_wall_close_beside_the_eye_is_not_cut_away() {
    let layer = Layer {
        amplitude_m: 12_000.0,
        shape: Shape::Fbm(Fbm { wavelength_km: 0.4, octaves: 5, ..Fbm::default() }),
        ..Layer::default()
    };
    let planet = bare(Planet { radius_km: 100.0, layers: vec![layer], ..Planet::default() });
    let terrain = terrain(&planet);
    let places =
        (0..4000).map(|i| LatLon::from_degrees(10.0 + 0.0003 * f64::from(i / 60), 20.0 + 0.0007 * f64::from(i % 60)));
    let steep = places
        .map(|place| (place, terrain.sample(place.direction())))
        .max_by(|a, b| a.1.slope_rad.total_cmp(&b.1.slope_rad));
    let (place, ground) = steep.unwrap();
    assert!(ground.slope_rad.to_degrees() > 89.4, "{}", ground.slope_rad.to_degrees());
    let up = place.direction();
    let (east, north) = tellus::sphere::geo::east_north(up);
    let heading = (-ground.normal_planet.dot(east)).atan2(-ground.normal_planet.dot(north));
    let camera = camera_over(&terrain, place, 2.0, [heading, 0.0]);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Low };
    let surface = build_over(&terrain, &view);
    // Whatever stands in the middle is lower than the sky at its sides and above it.
    let is_covered = |frame: &Scene<'_>| {
        let light = lights(&draw(frame));
        let columns = SIZE_PX[0] as usize;
        (0..light.len())
            .filter(|i| (i % columns).abs_diff(48) < 8 && (i / columns).abs_diff(32) < 8)
            .all(|i| light[i] > 0)
    };
    let mut frame = debug(frame_of(&surface, &planet, view, DVec3::X), DebugView::Coverage);
    assert!(is_covered(&frame), "the wall is cut away");
    frame.projection.near_m = Some(0.05);
    assert!(!is_covered(&frame), "it is farther away than a near plane that cuts it");
}

#[test]
fn no_pose_shows_the_background_through_the_ground() {
    // Other tests look at one pose of every shipped planet.
    look_at_poses(3, 1);
}

#[test]
#[ignore = "long: minutes"]
fn no_pose_of_any_planet_shows_the_background_through_the_ground() {
    look_at_poses(1, 3);
}

/// Every `step`th of the shipped planets, and some random ones.
fn look_at_poses(step: usize, randoms: u64) {
    let mut dice = Dice(11);
    // One grid of rivers is enough: four take seconds to solve.
    let coarse = |mut planet: Planet| {
        planet.structure.iter_mut().for_each(|structure| structure.grids = 1);
        planet
    };
    for shipped in shipped::ALL.iter().step_by(step) {
        look_for_holes(coarse(shipped.load().unwrap()), 1, &mut dice);
    }
    for seed in 0..randoms {
        look_for_holes(coarse(random::random(seed)), 1, &mut dice);
    }
}

/// The same surface without morphing: all vertices at their exact positions, shading of each tile's own level.
fn unmorphed(surface: &Surface) -> Surface {
    let mut stiff = surface.clone();
    let ranges = &mut stiff.ranges;
    (ranges.least_spacings, ranges.most_spacings, ranges.shaded_spacings) = (1e12, 1e12, 1e12);
    stiff
}

/// Mean difference of two pictures.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

/// Steps of a descent.
const STEPS: usize = 600;

/// Popping on a descent: at some of its steps, the largest difference between two pictures of one pose, one with the
/// tiles of the step before and one with its own; with and without morphing, for the shaded view and for normals.
/// Without morphing it stops when the difference exceeds five times the one with morphing.
fn fly_down(planet: Planet, steps: impl Iterator<Item = usize>) -> [[f64; 2]; 2] {
    let planet = bare(planet);
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let builder = Builder::new(|| {});
    let place = LatLon::from_degrees(35.0, -5.0);
    let view = |step: usize| {
        let part = step as f64 / STEPS as f64;
        let altitude_m = 2.0 * (3.0 * planet.radius_m() / 2.0).powf(1.0 - part);
        let pitch = -1.5 + 1.2 * part;
        let camera = camera_over(&terrain, place, altitude_m, [0.5, pitch]);
        // Large enough for a realistic ratio of texels to pixels.
        View { camera, size_px: [480, 320], quality: Quality::Medium }
    };
    let mut most = [[0.0_f64; 2]; 2];
    for step in steps {
        let before = settled(&builder, &planet, &view(step - 1));
        let after = settled(&builder, &planet, &view(step));
        let nodes = |surface: &Surface| -> Vec<_> {
            surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.detail.as_ref().map(|detail| detail.id))).collect()
        };
        if nodes(&before) == nodes(&after) {
            continue;
        }
        for (most, debug_view) in most.iter_mut().zip([DebugView::Shaded, DebugView::Normal]) {
            let draw = |surface: &Surface| draw(&debug(frame_of(surface, &planet, view(step), sun_dir()), debug_view));
            most[0] = most[0].max(difference(&draw(&before), &draw(&after)));
            let unclear = !is_gentle(*most);
            if unclear {
                most[1] = most[1].max(difference(&draw(&unmorphed(&before)), &draw(&unmorphed(&after))));
            }
            if std::env::var_os("TELLUS_PRINT").is_some() {
                println!(
                    "{} {step} {debug_view:?}: at most {:.4} with morphing, {:.4} without",
                    planet.name, most[0], most[1]
                );
            }
        }
    }
    most
}

/// Whether morphing reduces the largest difference at least to a fifth, and there was one to reduce.
fn is_gentle([with, without]: [f64; 2]) -> bool {
    without > 0.02 && 5.0 * with < without
}

#[test]
#[ignore = "long: minutes"]
fn a_way_down_shows_no_level_change() {
    // Among them the steps with the most popping when there is no morphing.
    let steps = [8, 34, 59, 121, 215, 301, 401, 433, 501];
    for most in fly_down(preset(LAYERED), steps.into_iter()) {
        assert!(is_gentle(most), "{most:?} with morphing and without");
    }
}

/// A thousand poses over the shipped planets, a hundred over random planets, and descents to all planets.
mod thorough {
    use super::*;

    fn down(name: &str, every: usize) {
        for most in fly_down(preset(name), (1..=STEPS).step_by(every)) {
            println!("{name}: {most:?} with morphing and without");
            assert!(is_gentle(most), "{name}: {most:?} with morphing and without");
        }
    }

    #[test]
    #[ignore = "long: minutes"]
    fn a_thousand_poses_over_the_shipped_planets() {
        let poses = 1000_usize.div_ceil(shipped::ALL.len());
        for (seed, shipped) in (21..).zip(shipped::ALL) {
            look_for_holes(shipped.load().unwrap(), poses, &mut Dice(seed));
        }
        println!("counted: {} poses over {} planets without a hole", poses * shipped::ALL.len(), shipped::ALL.len());
    }

    #[test]
    #[ignore = "long: minutes"]
    fn a_pose_over_each_of_a_hundred_random_planets() {
        let mut dice = Dice(26);
        (0..100).for_each(|seed| look_for_holes(random::random(seed), 1, &mut dice));
    }

    #[test]
    #[ignore = "long: minutes"]
    fn every_third_step_of_the_way_down() {
        down(LAYERED, 3);
    }

    #[test]
    #[ignore = "long: minutes"]
    fn ways_down_to_the_other_planets() {
        ["maren.ron", "cinnabar.ron", "hoarfrost.ron", "pallor.ron"].into_iter().for_each(|name| down(name, 20));
    }
}

#[test]
fn a_peak_of_eight_kilometres_shows_from_250_km_across_the_sea() {
    let shape = Shape::Fbm(Fbm { wavelength_km: 240.0, octaves: 3, ..Fbm::default() });
    let layer = Layer { amplitude_m: 9000.0, shape, ..Layer::default() };
    let mut planet = Planet {
        radius_km: 6371.0,
        layers: vec![layer],
        atmosphere: None,
        clouds: None,
        water: None,
        ..Planet::default()
    };
    // The highest of many points; the sea level is 8 km below it.
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let mut dice = Dice(3);
    let dirs: Vec<DVec3> = (0..200_000)
        .map(|_| LatLon { lat_rad: (dice.roll() - 0.5) * 2.0, lon_rad: dice.roll() * 6.0 - 3.0 }.direction())
        .collect();
    let heights_m = terrain.heights_m(&dirs);
    let (peak, height_m) =
        dirs.iter().zip(&heights_m).max_by(|a, b| a.1.total_cmp(b.1)).map(|(dir, height_m)| (*dir, *height_m)).unwrap();
    let sea_m = height_m - 8000.0;
    planet.water = Some(Water { level_m: sea_m, ..Water::default() });
    let planet = Arc::new(planet);
    let radius_m = planet.radius_m() + sea_m;
    let wet = Terrain::try_new(planet.clone()).unwrap();
    let (tangent, other) = peak.any_orthonormal_pair();
    let angle = 250e3 / radius_m;
    // A direction from which no other ground hides the peak.
    let eye = (0..360)
        .map(|degrees| tangent * f64::from(degrees).to_radians().cos() + other * f64::from(degrees).to_radians().sin())
        .map(|aside| (peak * angle.cos() + aside * angle.sin()) * (radius_m + 2.0))
        .find(|eye| {
            let top = peak * (radius_m + 7900.0);
            let away_m = wet.raycast(*eye, (top - *eye).normalize());
            wet.height_m(*eye) < sea_m - 100.0 && away_m.is_some_and(|away_m| (away_m - 250e3).abs() < 10e3)
        })
        .expect("a free way");
    let up = eye.normalize();
    let forward = (peak - up * peak.dot(up)).normalize();
    let camera = Camera::looking(eye, forward, up, 6_f64.to_radians());
    let view = View { camera, size_px: [192, 128], quality: Quality::Medium };
    let surface = build_now(&planet, &view).unwrap();
    let picture = draw(&debug(frame_of(&surface, &planet, view, DVec3::X), DebugView::Coverage));
    let light = lights(&picture);
    // For each column: the row of the highest ground beyond the sea's horizon.
    let tan_y = (camera.fov_y_rad * 0.5).tan();
    let horizon_px = 64.0 + (2.0 * 2.0 / radius_m).sqrt() / tan_y * 64.0;
    let mut there = 0;
    for column in 0..192 {
        let aside = ((f64::from(column) + 0.5) / 96.0 - 1.0) * tan_y * view.aspect();
        let away = (forward + forward.cross(up) * aside).normalize();
        let dirs: Vec<DVec3> =
            (200..4000).map(|i| f64::from(i) * 100.0 / radius_m).map(|a| up * a.cos() + away * a.sin()).collect();
        let points =
            dirs.iter().zip(wet.heights_m(&dirs)).map(|(dir, h)| *dir * (planet.radius_m() + h.max(sea_m)) - eye);
        let highest = points.map(|rel| rel.dot(up) / rel.dot(forward)).fold(f64::MIN, f64::max);
        let top_px = 64.0 - highest / tan_y * 64.0;
        let drawn_px = (0..128).find(|y| light[y * 192 + column as usize] > 0).unwrap_or(128) as f64;
        if top_px < horizon_px - 3.0 {
            there += 1;
            assert!((drawn_px - top_px).abs() < 2.0, "column {column}: drawn from {drawn_px}, ought to be {top_px}");
        }
    }
    assert!(there > 20, "too little to see: {there} columns");
}

/// Decodes an octahedral unit vector.
fn from_octahedral(oct: [i16; 2]) -> DVec3 {
    let [x, y] = oct.map(|v| (f64::from(v) / 32767.0).max(-1.0));
    let z = 1.0 - x.abs() - y.abs();
    let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = if z < 0.0 { [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)] } else { [x, y] };
    DVec3::new(x, y, z).normalize()
}

/// The normal of a pixel in the debug view.
fn shown_normal(pixel: &[u8]) -> DVec3 {
    let part = |i: usize| {
        let encoded = f64::from(pixel[i]) / 255.0;
        let linear = if encoded < 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
        2.0 * linear.powf(1.0 / 2.2) - 1.0
    };
    DVec3::new(part(0), part(1), part(2)).normalize()
}

#[test]
fn normals_change_from_a_level_to_the_next_as_the_vertices_have_them() {
    // Rough at all scales, so that levels differ.
    let shape = Shape::Fbm(Fbm { wavelength_km: 60.0, octaves: 16, ..Fbm::default() });
    let planet =
        bare(Planet { layers: vec![Layer { amplitude_m: 6000.0, shape, ..Layer::default() }], ..Planet::default() });
    let camera = crate::support::camera(&planet, 35.0, -5.0, 4000.0, 20.0, -50.0);
    let view = View { camera, size_px: [480, 320], quality: Quality::Medium };
    // Without detail textures, so that normals come from the vertices alone.
    let surface = build_now(&planet, &view).unwrap();
    let picture = draw(&debug(frame_of(&surface, &planet, view, sun_dir()), DebugView::Normal));
    let (eye, turn) = (camera.position_planet_m, camera.planet_from_view.inverse());
    let tan_y = (camera.fov_y_rad * 0.5).tan();
    // Distance of a pixel's normal from the blend, from the tile's own normal and from its parent's, where these two
    // differ.
    let (mut off, mut off_own, mut off_parents) = (Vec::new(), Vec::new(), Vec::new());
    for leaf in &surface.leaves {
        let end_m = surface.ranges.always_m(leaf.tile.id.level);
        let shifts_m = shifts_m(&leaf.tile, leaf.finer_edges, eye, &surface.ranges);
        for (vertex, shift_m) in leaf.tile.vertices.iter().zip(shifts_m) {
            let position = vertex.position_planet_m();
            let parents = ((position.distance(eye) / end_m - SHADED_AT) / (1.0 - SHADED_AT)).clamp(0.0, 1.0);
            let at = turn * (position + position.normalize() * f64::from(shift_m) - eye);
            let [x, y] = [1.0 + at.x / (-at.z * tan_y * view.aspect()), 1.0 - at.y / (-at.z * tan_y)];
            let [x, y] = [x * 240.0, y * 160.0];
            let inside = at.z < 0.0 && x > 1.0 && x < 479.0 && y > 1.0 && y < 319.0;
            let (own, parent) = (from_octahedral(vertex.normal_oct), from_octahedral(vertex.parent_normal_oct));
            if !inside || !(0.3..0.7).contains(&parents) || own.distance(parent) < 0.05 {
                continue;
            }
            let pixel = (y as usize * 480 + x as usize) * 4;
            let shown = shown_normal(&picture[pixel..pixel + 4]);
            off.push(shown.distance(own.lerp(parent, parents).normalize()));
            off_own.push(shown.distance(own));
            off_parents.push(shown.distance(parent));
        }
    }
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(f64::MAX)
    };
    let many = off.len();
    let [off, own, parents] = [&mut off, &mut off_own, &mut off_parents].map(median);
    assert!(many > 100 && off < 0.02 && 1.5 * off < own.min(parents), "{many}: {off}, {own} {parents}");
}
