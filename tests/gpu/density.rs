//! The density of a population on the planet: the colours of the picture are those of the query.

use crate::support::{SIZE_PX, camera, debug, frame_of, gpu, surface_of};
use glam::DVec3;
use std::sync::Arc;
use tellus::life::Canopies;
use tellus::lod::{Quality, View};
use tellus::planet::edits::{EditPoint, GroundEdit, LifePaint, Road, Tool};
use tellus::planet::{Biome, Fbm, Layer, Planet, Population, Shape, Table, Water};
use tellus::render::{DebugView, Legend};
use tellus::sphere::LatLon;

const LAT_DEG: f64 = 20.0;
const LON_DEG: f64 = 30.0;

/// A stroke of life, or a road, around a place beside the middle.
fn edit(tool: Tool, radius_m: f64, north_deg: f64, east_deg: f64) -> GroundEdit {
    let at = |north_deg: f64| EditPoint {
        latitude_deg: LAT_DEG + north_deg,
        longitude_deg: LON_DEG + east_deg,
        ..EditPoint::default()
    };
    let points = match &tool {
        Tool::Road(_) => vec![at(north_deg - 0.5), at(north_deg + 0.5)],
        _ => vec![at(north_deg)],
    };
    let points = points.into_iter().collect();
    GroundEdit { tool, radius_km: radius_m / 1000.0, softness: 0.0, points, ..GroundEdit::default() }
}

fn stroke(population: &str, density: f64, radius_m: f64, north_deg: f64, east_deg: f64) -> GroundEdit {
    let paint = LifePaint { population: population.to_owned(), density };
    edit(Tool::Life(paint), radius_m, north_deg, east_deg)
}

fn hills(wavelength_km: f64, amplitude_m: f64) -> Layer {
    let shape = Fbm { wavelength_km, octaves: 5, ..Fbm::default() };
    Layer { name: format!("{wavelength_km} km"), amplitude_m, shape: Shape::Fbm(shape), ..Layer::default() }
}

/// A planet of these populations, with hills and a biome table of two kinds.
fn planet(life: Vec<Population>, layers: Vec<Layer>, edits: Vec<GroundEdit>) -> Planet {
    let mut planet = Planet { radius_km: 500.0, life, layers, ..Planet::default() };
    let biome = |key, name: &str| Biome { key, name: name.to_owned(), ..Biome::default() };
    planet.biomes.palette = vec![biome('a', "Dry"), biome('b', "Wet")];
    planet.biomes.table = Table::uniform('a', 8, 8);
    for (column, row) in (4..8).flat_map(|column| (0..8).map(move |row| (column, row))) {
        planet.biomes.table.set_key(column, row, 'b');
    }
    (planet.biomes.snow, planet.biomes.beach_m) = (false, 0.0);
    for edit in edits {
        planet.edits.push(edit);
    }
    planet
}

/// The share that a colour of the density view stands for, with its light: nearest colour of the legend.
fn share_of(pixel: [f32; 3], scale: &[[f64; 3]], light: f64) -> f64 {
    const STEPS: usize = 400;
    let color = |share: f64| {
        let at = share * (scale.len() - 1) as f64;
        let below = (at as usize).min(scale.len() - 2);
        let part = at - below as f64;
        [0, 1, 2].map(|c| (scale[below][c] + (scale[below + 1][c] - scale[below][c]) * part) * light)
    };
    let off = |share: f64| -> f64 { (0..3).map(|c| (color(share)[c] - f64::from(pixel[c])).powi(2)).sum() };
    let shares = (0..=STEPS).map(|step| step as f64 / STEPS as f64);
    shares.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap()
}

/// Shares of a population as the picture and as the query have them, at pixels over land.
fn shares(planet: &Planet, population: usize, altitude_m: f64) -> Vec<(f64, f64)> {
    let planet = Arc::new(planet.clone());
    let camera = camera(&planet, LAT_DEG, LON_DEG, altitude_m, 20.0, -75.0);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let mut scene = debug(frame_of(&surface, &planet, view, DVec3::X), DebugView::Density);
    scene.population = population;
    let drawn = gpu().radiance(&scene);
    let Legend::Ramp { colors, .. } = Legend::of_density(&planet.life[population]) else { panic!("a ramp") };
    let (terrain, canopies) = (&surface.terrain, Canopies::new(&surface.terrain));
    let [wide, high] = SIZE_PX.map(|side| side as usize);
    let at = |n: usize, count: usize| (n as f64 + 0.5) / count as f64 * 2.0 - 1.0;
    let mut found = Vec::new();
    for (number, pixel) in drawn.iter().enumerate().step_by(7) {
        let ray = camera.ray_dir_planet(at(number % wide, wide), -at(number / wide, high), wide as f64 / high as f64);
        let Some(distance_m) = terrain.raycast(camera.position_planet_m, ray) else { continue };
        let dir = (camera.position_planet_m + ray * distance_m).normalize();
        let sample = terrain.sample(dir);
        if sample.height_m < planet.sea_level_m().unwrap_or(f64::MIN) + 1.0 {
            continue;
        }
        let asked = canopies.densities_per_hectare(dir, &sample)[population] / planet.life[population].per_hectare;
        let light = 0.5 + 0.5 * (0.35 + 0.65 * sample.normal_planet.dot(-ray).clamp(0.0, 1.0));
        found.push((share_of(*pixel, &colors, light), asked));
    }
    found
}

/// Checks the shares of a population from several heights: their mean, and single pixels apart from edges.
fn check(planet: &Planet, population: usize, altitudes_m: &[f64]) {
    let name = &planet.life[population].name;
    for altitude_m in altitudes_m {
        let shares = shares(planet, population, *altitude_m);
        let count = shares.len() as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| shares.iter().map(of).sum::<f64>() / count;
        let (seen, asked) = (mean(&|pair| pair.0), mean(&|pair| pair.1));
        let off = shares.iter().filter(|(seen, asked)| (seen - asked).abs() > 0.15).count() as f64 / count;
        println!("{name} from {altitude_m} m: {count} pixels, seen {seen:.3}, asked {asked:.3}, off {off:.3}");
        assert!(count > 300.0 && (seen - asked).abs() < 0.03 && off < 0.08, "{name} {altitude_m} m");
        assert!(asked > 0.03 && asked < 0.97, "{name} {altitude_m} m: it stands in a part of the picture: {asked}");
    }
}

#[test]
fn a_population_that_is_no_part_of_the_canopy_shows_its_density_with_strokes() {
    let everywhere = |name: &str, seed| Population {
        name: name.to_owned(),
        seed,
        slope_to_deg: 90.0,
        per_hectare: 400.0,
        height_m: 20.0,
        ..Population::default()
    };
    let low = Population { per_hectare: 3.0, height_m: 0.1, ..everywhere("Low", 9) };
    let low = Population { slope_to_deg: 6.0, height_to_m: 250.0, ..low };
    // Four that cover more: the canopy of a biome has room for no other.
    let mut life: Vec<Population> = (1..5).map(|seed| everywhere(&format!("Tree {seed}"), seed)).collect();
    life.push(low);
    let edits = vec![
        stroke("Low", 0.0, 200.0, 0.0, -0.03),
        stroke("Low", 0.6, 200.0, 0.05, 0.02),
        edit(Tool::Road(Road::default()), 60.0, 0.0, 0.05),
        stroke("Low", 0.3, 9_000.0, 2.0, 1.0),
    ];
    let planet = planet(life, vec![hills(12.0, 300.0)], edits);
    check(&planet, 4, &[600.0, 20_000.0]);
}

#[test]
fn what_asks_for_shores_ridges_and_a_biome_shows_its_density_from_the_ground_and_from_afar() {
    let life = vec![
        Population {
            name: "Ridge".to_owned(),
            slope_to_deg: 90.0,
            curvature_from: 0.0,
            per_hectare: 5.0,
            ..Population::default()
        },
        Population {
            name: "Wet".to_owned(),
            seed: 2,
            biomes: "b".to_owned(),
            slope_to_deg: 90.0,
            per_hectare: 50.0,
            ..Population::default()
        },
    ];
    let edits = vec![stroke("Wet", 0.5, 150.0, 0.0, 0.0), stroke("", 0.0, 30_000.0, 8.0, 4.0)];
    let mut planet = planet(life, vec![hills(300.0, 500.0), hills(1.0, 60.0)], edits);
    planet.water = Some(Water::default());
    check(&planet, 1, &[400.0, 150_000.0]);
    // The lie of the ground is known in squares of some texels: means are compared.
    let shares = shares(&planet, 0, 400.0);
    let mean = |of: fn(&(f64, f64)) -> f64| shares.iter().map(of).sum::<f64>() / shares.len() as f64;
    let (seen, asked) = (mean(|pair| pair.0), mean(|pair| pair.1));
    println!("Ridge: seen {seen:.3}, asked {asked:.3}");
    assert!((seen - asked).abs() < 0.05 && asked > 0.1 && asked < 0.9);
}

/// One that is off stands nowhere, and no picture is drawn of one that is not there.
#[test]
fn what_is_off_or_not_there_has_no_density() {
    let off = Population { enabled: false, ..Population::default() };
    let planet = Arc::new(planet(vec![off], Vec::new(), Vec::new()));
    let view =
        View { camera: camera(&planet, LAT_DEG, LON_DEG, 1e6, 0.0, -90.0), size_px: SIZE_PX, quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let sun = LatLon::from_degrees(LAT_DEG, LON_DEG).direction();
    for population in [0, 7] {
        let mut scene = debug(frame_of(&surface, &planet, view, sun), DebugView::Density);
        scene.population = population;
        let drawn = gpu().radiance(&scene);
        let middle = drawn[(SIZE_PX[1] / 2 * SIZE_PX[0] + SIZE_PX[0] / 2) as usize];
        assert!(middle[0] > 0.03 && middle[1] < 0.01, "violet: {middle:?}");
    }
}
