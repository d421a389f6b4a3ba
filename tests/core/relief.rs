//! Biome relief: the same in every query, without cliffs, with the slopes of the ground; and the edits that rebuild
//! heights because of it.

use crate::support::edits::{every_edit, full_planet};
use glam::DVec3;
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::param::{Stage, Stages};
use tellus::planet::{Biome, Biomes, Fbm, Layer, Planet, Shape, Table};
use tellus::simd::Simd;
use tellus::sphere::{LatLon, spread};
use tellus::terrain::Terrain;
use tellus::tiles::{Builder, build_now};

/// Rolling ground, with hummocks in one half of the biome table.
fn hummocky() -> Planet {
    let biome = |key, relief_m, relief_size_m| Biome { key, relief_m, relief_size_m, ..Biome::default() };
    let mut table = Table::uniform('a', 4, 4);
    for row in 0..4 {
        table.set_key(2, row, 'b');
        table.set_key(3, row, 'c');
    }
    let layer = Layer {
        name: "Hills".to_owned(),
        amplitude_m: 2000.0,
        shape: Shape::Fbm(Fbm { wavelength_km: 40.0, octaves: 3, ..Fbm::default() }),
        ..Layer::default()
    };
    Planet {
        radius_km: 500.0,
        layers: vec![layer],
        biomes: Biomes {
            palette: vec![biome('a', 0.0, 50.0), biome('b', 20.0, 400.0), biome('c', 12.0, 150.0)],
            table,
            ..Biomes::default()
        },
        ..Planet::default()
    }
}

fn without(planet: &Planet) -> Planet {
    let mut flat = planet.clone();
    flat.biomes.palette.iter_mut().for_each(|biome| biome.relief_m = 0.0);
    flat
}

#[test]
fn relief_lies_where_its_biome_does_and_within_the_bounds() {
    let planet = hummocky();
    let (with, flat) =
        (Terrain::try_new(Arc::new(planet.clone())).unwrap(), Terrain::try_new(Arc::new(without(&planet))).unwrap());
    let dirs: Vec<DVec3> = spread(4000).collect();
    let (mut bare, mut raised) = (0, 0);
    for ((dir, height_m), below_m) in dirs.iter().zip(with.heights_m(&dirs)).zip(flat.heights_m(&dirs)) {
        let relief_m = (height_m - below_m).abs();
        let moisture = flat.sample(*dir).moisture;
        if moisture < 0.37 {
            assert_eq!(relief_m, 0.0, "no relief at moisture {moisture}");
            bare += 1;
        } else if moisture > 0.6 {
            raised += u32::from(relief_m > 0.5);
        }
        assert!(relief_m <= 20.0 * 1.2, "{relief_m}");
        let (lo, hi) = with.height_bounds_near_m(*dir, 1e-3);
        assert!(lo <= height_m && height_m <= hi, "{lo} {height_m} {hi}");
    }
    assert!(bare > 100 && raised > 200, "{bare} {raised}");
}

#[test]
fn slopes_are_those_of_the_raised_ground() {
    let planet = hummocky();
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let radius_m = planet.radius_m();
    for dir in spread(1500) {
        let sample = terrain.sample(dir);
        let east = dir.cross(DVec3::Z).normalize();
        let h = 1e-6;
        for tangent in [east, dir.cross(east)] {
            let at = |w: f64| terrain.height_m((dir + tangent * w).normalize());
            let slope = (at(h) - at(-h)) / (2.0 * h * (radius_m + sample.height_m));
            let normal = sample.normal_planet;
            let analytic = -normal.dot(tangent) / normal.dot(dir);
            // The gradient leaves out how the blend follows climate noise; the difference is over 1 m of 150 m waves.
            assert!((slope - analytic).abs() < 2e-3 + 2e-3 * slope.abs(), "{slope} {analytic} at {dir}");
        }
    }
}

#[test]
fn no_cliff_stands_where_a_relief_ends() {
    let planet = hummocky();
    let (with, flat) =
        (Terrain::try_new(Arc::new(planet.clone())).unwrap(), Terrain::try_new(Arc::new(without(&planet))).unwrap());
    // Steps of half a metre, across borders between cells of the table.
    let dirs: Vec<DVec3> =
        (0..60_000).map(|i| LatLon { lat_rad: 0.4, lon_rad: f64::from(i) * 1e-6 }.direction()).collect();
    let relief: Vec<f64> =
        with.heights_m(&dirs).iter().zip(flat.heights_m(&dirs)).map(|(raised, below)| raised - below).collect();
    let steepest = relief.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    let step_m = dirs[0].distance(dirs[1]) * planet.radius_m();
    assert!(steepest > 0.0, "the line crosses no relief");
    // Waves of 400 m and 20 m height, and their octaves, are not steeper.
    assert!(steepest / step_m < 0.9, "{}", steepest / step_m);
}

#[test]
fn every_instruction_set_batch_and_tile_gives_the_same_bits() {
    let planet = Arc::new(hummocky());
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let dirs: Vec<DVec3> = spread(700).collect();
    let heights = terrain.heights_m(&dirs);
    for simd in Simd::available().iter().copied() {
        let other = Terrain::try_new(planet.clone()).unwrap().with_simd(simd);
        assert_eq!(other.heights_m(&dirs), heights, "{simd:?}");
        assert_eq!(other.sample(dirs[5]), terrain.sample(dirs[5]), "{simd:?}");
    }
    for (dir, height_m) in dirs.iter().zip(&heights) {
        assert_eq!(terrain.height_m(*dir), *height_m);
        assert_eq!(terrain.sample(*dir).height_m, *height_m);
    }
    let camera = Camera::over(LatLon::from_degrees(30.0, 40.0), planet.radius_m() * 1.02, 0.0, -1.2, 0.8);
    let surface = build_now(&planet, &View { camera, size_px: [160, 100], quality: Quality::Low }).unwrap();
    for leaf in &surface.leaves {
        for (x, y) in [(0, 0), (32, 16), (5, 31), (1, 1)] {
            let dir = leaf.tile.id.direction(f64::from(x) / 32.0, f64::from(y) / 32.0);
            let vertex = leaf.tile.vertices[(y * 33 + x) as usize];
            assert_eq!(vertex.height_m, terrain.height_m(dir) as f32);
        }
    }
}

/// With biome relief, edits of the table and of the climate rebuild heights; without, edits of the table rebuild
/// nothing.
#[test]
fn heights_follow_the_biomes_only_where_one_has_a_relief() {
    let mut planet = full_planet();
    planet.biomes.palette[1].relief_m = 5.0;
    planet.biomes.palette[1].relief_size_m = 30_000.0;
    let camera = Camera::over(LatLon::from_degrees(20.0, 30.0), 4.5e6, 0.3, -1.4, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [320, 200], quality: Quality::Low };
    let builder = Builder::new(|| {});
    let ask = |planet: &Planet| {
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        while !builder.has_all_tiles() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        builder.surface().unwrap().stats
    };
    ask(&planet);
    let mut painted = 0;
    for edit in every_edit(&planet) {
        if !["biomes", "climate", "water"].iter().any(|part| edit.path.starts_with(part)) {
            continue;
        }
        let stats = ask(&edit.planet);
        assert_eq!(stats.ran(), edit.declared.within(Stages::OF_TILES), "{}", edit.path);
        if edit.path == "biomes.table" {
            painted = stats.stage(Stage::Height).runs;
        }
        ask(&planet);
    }
    // A cell of the biome without relief becomes one of the biome with relief.
    assert!(painted > 0);
    let mut plain = without(&planet);
    ask(&plain);
    plain.biomes.table.set_key(0, 0, 'b');
    assert_eq!(ask(&plain).tiles_built, 0);
}
