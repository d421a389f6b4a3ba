//! What strokes clear and plant is seen from afar, too, where objects are not drawn one by one.

use crate::support::{SIZE_PX, camera, debug, frame_of, gpu, surface_of};
use glam::DVec3;
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::edits::{EditPoint, GroundEdit, LifePaint, Road, Tool};
use tellus::planet::life::Stone;
use tellus::planet::{Biome, Form, Planet, Population, Table};
use tellus::render::DebugView;
use tellus::sphere::LatLon;

const LAT_DEG: f64 = 10.0;
const LON_DEG: f64 = 20.0;
const RADIUS_M: f64 = 500_000.0;

fn at(lat_deg: f64, lon_deg: f64) -> EditPoint {
    EditPoint { latitude_deg: lat_deg, longitude_deg: lon_deg, ..EditPoint::default() }
}

/// An even grey sphere with red stones, and blue ones that stand nowhere by rule.
fn planet() -> Planet {
    let stones = |name: &str, seed, biomes: &str, color| Population {
        name: name.to_owned(),
        seed,
        biomes: biomes.to_owned(),
        per_hectare: 300.0,
        height_m: 8.0,
        clumping: 0.0,
        color,
        leaf_color: color,
        form: Form::Stone(Stone { flatness: 0.0, stretch: 1.0, ..Stone::default() }),
        ..Population::default()
    };
    let life = vec![stones("Red", 1, "", [0.9, 0.05, 0.05]), stones("Blue", 2, "z", [0.05, 0.05, 0.9])];
    let mut planet = Planet { radius_km: RADIUS_M / 1000.0, life, ..Planet::default() };
    planet.biomes.palette = vec![Biome { color: [0.3; 3], variation: 0.0, ..Biome::default() }];
    planet.biomes.table = Table::uniform('a', 2, 2);
    (planet.biomes.snow, planet.biomes.beach_m) = (false, 0.0);
    planet
}

fn edit(tool: Tool, radius_m: f64, points: &[EditPoint]) -> GroundEdit {
    let points = points.iter().copied().collect();
    GroundEdit { tool, radius_km: radius_m / 1000.0, softness: 0.0, points, ..GroundEdit::default() }
}

fn stroke(population: &str, density: f64, radius_m: f64, middle: EditPoint) -> GroundEdit {
    edit(Tool::Life(LifePaint { population: population.to_owned(), density }), radius_m, &[middle])
}

/// Albedo of each pixel of a view in which no object is drawn alone, and the direction that the pixel shows.
fn canopy(planet: &Planet, altitude_m: f64, heading_deg: f64) -> Vec<([f32; 3], DVec3)> {
    let planet = Arc::new(planet.clone());
    let camera = camera(&planet, LAT_DEG, LON_DEG, altitude_m, heading_deg, -80.0);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
    let mut surface = surface_of(&planet, &view);
    surface.scenery.cells.clear();
    surface.scenery.reach_m.fill(0.0);
    let sun = LatLon::from_degrees(LAT_DEG, LON_DEG).direction();
    let drawn = gpu().radiance(&debug(frame_of(&surface, &planet, view, sun), DebugView::Albedo));
    drawn.into_iter().enumerate().filter_map(|(i, pixel)| Some((pixel, shown(&camera, i)?))).collect()
}

/// The direction of the ground at a pixel.
fn shown(camera: &Camera, pixel: usize) -> Option<DVec3> {
    let [wide, high] = SIZE_PX.map(|side| side as usize);
    let at = |n: usize, count: usize| (n as f64 + 0.5) / count as f64 * 2.0 - 1.0;
    let aspect = wide as f64 / high as f64;
    let ray = camera.ray_dir_planet(at(pixel % wide, wide), -at(pixel / wide, high), aspect);
    let eye_m = camera.position_planet_m;
    let along_m = -ray.dot(eye_m);
    let inside = along_m * along_m - eye_m.length_squared() + RADIUS_M * RADIUS_M;
    (inside > 0.0).then(|| (eye_m + ray * (along_m - inside.sqrt())).normalize())
}

fn is_grey([red, green, blue]: [f32; 3]) -> bool {
    [red, green, blue].iter().all(|channel| (channel - 0.3).abs() < 0.01)
}

#[test]
fn a_clearing_and_a_planted_disc_are_seen_from_any_height_where_they_are() {
    let bare = planet();
    for (altitude_m, heading_deg) in [(300.0, 0.0), (300.0, 60.0), (20_000.0, 30.0), (200_000.0, 0.0)] {
        let radius_m = 0.2 * altitude_m;
        // Ahead, so that both are in the picture.
        let ahead_deg = (2.4 * radius_m / RADIUS_M).to_degrees();
        let (sin, cos) = f64::to_radians(heading_deg).sin_cos();
        let other = at(LAT_DEG + ahead_deg * cos, LON_DEG + ahead_deg * sin / f64::to_radians(LAT_DEG).cos());
        let middle = at(LAT_DEG, LON_DEG);
        let mut painted = bare.clone();
        painted.edits.push(stroke("", 0.0, radius_m, middle));
        painted.edits.push(stroke("", 0.0, radius_m, other));
        painted.edits.push(stroke("Blue", 1.0, radius_m, other));
        let (before, after) = (canopy(&bare, altitude_m, heading_deg), canopy(&painted, altitude_m, heading_deg));
        // Single crowns are seen, with ground between them: means tell what stands there.
        let (mut cleared, mut planted, mut rest) = (Seen::default(), Seen::default(), Seen::default());
        for ((old, dir), (new, _)) in before.iter().zip(&after) {
            let radii = |point: EditPoint| dir.angle_between(point.direction()) * RADIUS_M / radius_m;
            let told = format!("{altitude_m} m, {:.2} and {:.2} radii: {old:?} {new:?}", radii(middle), radii(other));
            if radii(middle) < 0.7 {
                cleared.add(*new);
                assert!(is_grey(*new), "{told}");
            } else if radii(other) < 0.7 {
                planted.add(*new);
                assert!(new[0] < 0.31, "nothing red: {told}");
            } else if radii(middle) > 1.3 && radii(other) > 1.3 {
                rest.add(*new);
                assert!((0..3).all(|c| (new[c] - old[c]).abs() < 0.01), "{told}");
            }
        }
        let told = format!("{altitude_m} m: {cleared:?} {planted:?} {rest:?}");
        assert!(cleared.count > 50.0 && planted.count > 50.0 && rest.count > 500.0, "{told}");
        assert!(planted.sum[2] > 1.2 * planted.sum[0] && rest.sum[0] > 1.2 * rest.sum[2], "{told}");
    }
}

/// Pixels of a place.
#[derive(Debug, Default)]
struct Seen {
    count: f32,
    sum: [f32; 3],
}

impl Seen {
    fn add(&mut self, pixel: [f32; 3]) {
        self.count += 1.0;
        self.sum = std::array::from_fn(|c| self.sum[c] + pixel[c]);
    }
}

#[test]
fn a_road_through_a_forest_is_seen_from_afar() {
    let mut planet = planet();
    let line = [at(LAT_DEG - 0.05, LON_DEG), at(LAT_DEG + 0.05, LON_DEG)];
    planet.edits.push(edit(Tool::Road(Road::default()), 60.0, &line));
    let (mut on_bed, mut beside) = (0, Seen::default());
    for (pixel, dir) in canopy(&planet, 400.0, 20.0) {
        let (lat, lon) = LatLon::from_direction(dir).to_degrees();
        let away_m = (lon - LON_DEG).abs().to_radians() * lat.to_radians().cos() * RADIUS_M;
        if away_m < 24.0 {
            on_bed += 1;
            assert!(is_grey(pixel), "{away_m} m: {pixel:?}");
        } else if away_m > 110.0 {
            beside.add(pixel);
        }
    }
    assert!(on_bed > 100 && beside.count > 500.0 && beside.sum[0] > 1.2 * beside.sum[2], "{on_bed} {beside:?}");
}
