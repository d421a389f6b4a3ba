//! Planets with a structure: the same bits everywhere, layers over and under it, what an edit solves again.

use glam::DVec3;
use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use tellus::lod::{Camera, Quality, Vertex, View};
use tellus::planet::param::{Stage, Stages};
use tellus::planet::{Dunes, Fbm, GROUND_VERSION, Layer, Planet, Ridged, Shape, Structure, Water};
use tellus::simd::Simd;
use tellus::sphere::{LatLon, spread};
use tellus::terrain::{Revision, Terrain, Wanted};
use tellus::tiles::{Builder, Surface, build_now};

/// Points over the globe: each is among rivers that nobody has asked for.
const POINTS: usize = 250;

/// A planet of the coarsest grid: quick to solve.
fn planet() -> Planet {
    let structure = Some(Structure { grids: 1, ..Structure::default() });
    Planet { structure, water: Some(Water::default()), atmosphere: None, ..Planet::default() }
}

fn terrain(planet: &Planet) -> Terrain {
    Terrain::try_new(Arc::new(planet.clone())).unwrap()
}

fn hills() -> Layer {
    let shape = Shape::Fbm(Fbm { wavelength_km: 900.0, octaves: 2, ..Fbm::default() });
    Layer { name: "Hills".to_owned(), amplitude_m: 700.0, shape, ..Layer::default() }
}

/// The same with layers that folds and the wind steer, one of them under the structure.
fn steered_planet() -> Planet {
    let layer = |name: &str, folding, shape| Layer {
        name: name.to_owned(),
        amplitude_m: 400.0,
        folding,
        shape,
        ..Layer::default()
    };
    let dunes = Dunes { wavelength_km: 40.0, follow_wind: true, ..Dunes::default() };
    let under = Layer { under: true, folding: 2.0, ..hills() };
    let layers =
        vec![layer("Ridges", 3.0, Shape::Ridged(Ridged::default())), layer("Dunes", 0.0, Shape::Dunes(dunes)), under];
    Planet { layers, ..planet() }
}

fn heights_m(terrain: &Terrain) -> Vec<f64> {
    terrain.heights_m(&spread(POINTS).collect::<Vec<DVec3>>())
}

#[test]
fn it_has_land_and_sea_of_the_same_bits_for_any_number_of_threads_and_instruction_set() {
    let planet = steered_planet();
    let alone = heights_m(&terrain(&planet));
    let land = alone.iter().filter(|height_m| **height_m > 0.0).count();
    assert!((POINTS / 6..POINTS / 2).contains(&land), "{land} of {POINTS} points are land");
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(|| heights_m(&terrain(&planet))), alone, "{threads} threads");
    }
    for simd in Simd::available() {
        assert_eq!(heights_m(&terrain(&planet).with_simd(simd)), alone, "{simd:?}");
    }
}

/// From far away a ray leaves valleys out, but it ends on the ground that queries know.
#[test]
fn rays_from_orbit_end_on_the_ground() {
    let planet = steered_planet();
    let (terrain, radius_m) = (terrain(&planet), planet.radius_m());
    let mut land = 0;
    for dir in spread(40) {
        let from = dir * (radius_m + 400_000.0);
        for aim in [-dir, dir.any_orthonormal_vector() * 1.5 - dir] {
            let hit = from + aim.normalize() * terrain.raycast(from, aim).unwrap();
            let ground_m = terrain.height_m(hit).max(planet.sea_level_m().unwrap());
            assert!((hit.length() - radius_m - ground_m).abs() < 0.01, "{hit}: {ground_m}");
            land += usize::from(ground_m > 1.0);
        }
    }
    assert!(land > 8, "{land}");
}

#[test]
fn a_layer_over_it_is_added_and_one_under_it_is_carved() {
    let bare = planet();
    let mut over = planet();
    over.layers.push(hills());
    let mut under = over.clone();
    under.layers[0].under = true;
    let no_structure = Planet { structure: None, ..over.clone() };
    let [bare_m, over_m, under_m, hills_m] =
        [bare, over, under, no_structure].map(|planet| heights_m(&terrain(&planet)));
    let added = |all: &[f64], i: usize| all[i] - bare_m[i];
    // It stands aside for rivers and lakes.
    let shares: Vec<f64> = (0..POINTS).map(|i| added(&over_m, i) / hills_m[i]).collect();
    assert!(shares.iter().all(|share| (-1e-6..1.0 + 1e-6).contains(share)), "{shares:?}");
    let whole = shares.iter().filter(|share| **share > 1.0 - 1e-6).count();
    assert!(whole * 10 > POINTS * 8, "{whole} of {POINTS}");
    // Land and sea floor rise where the hills do, but on land not by all of it.
    let sum: f64 = (0..POINTS).map(|i| added(&under_m, i) * hills_m[i]).sum();
    let most: f64 = hills_m.iter().map(|m| m * m).sum();
    assert!(sum > 0.3 * most && sum < 0.99 * most, "{} of the layer under the structure shows", sum / most);
}

#[test]
fn an_edit_reaches_heights_and_climate_and_no_texture() {
    let before = Revision::try_new(Arc::new(planet())).unwrap();
    let mut edited = planet();
    if let Some(structure) = &mut edited.structure {
        structure.rivers.age_myr *= 2.0;
    }
    let changes = Revision::try_new(Arc::new(edited)).unwrap().changes_since(&before);
    assert_eq!(changes, Stages::of(&[Stage::Field, Stage::Height, Stage::Climate]));
    let mut edited = planet();
    if let Some(structure) = &mut edited.structure {
        structure.weather_share = 0.5;
    }
    let changes = Revision::try_new(Arc::new(edited)).unwrap().changes_since(&before);
    assert_eq!(changes, Stages::of(&[Stage::Climate, Stage::CloudMap]), "the solved weather stays");
}

#[test]
fn the_builder_ends_with_the_surface_that_a_build_from_nothing_gives() {
    let camera = Camera::over(LatLon::from_degrees(10.0, 20.0), 2.2 * 6.371e6, 0.3, -1.4, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [240, 160], quality: Quality::Low };
    let builder = Builder::new(|| {});
    let mut planet = steered_planet();
    for step in 0..2 {
        planet.layers.resize(3 + step, Layer { name: "More hills".to_owned(), ..hills() });
        if let Some(structure) = &mut planet.structure {
            structure.grids = 2;
            structure.rivers.seed = step as u32;
        }
        let planet = Arc::new(planet.clone());
        builder.request(&planet, &view).unwrap();
        while !builder.has_all_tiles() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let (built, alone) = (builder.surface().unwrap(), build_now(&planet, &view).unwrap());
        assert!(built.complete && built.leaves.len() == alone.leaves.len());
        for (a, b) in built.leaves.iter().zip(&alone.leaves) {
            assert!(a.tile.id == b.tile.id && a.tile.vertices == b.tile.vertices, "{:?}", a.tile.id);
        }
    }
}

/// While a slider is dragged, drafts show what it does; in the end there is nothing left of them.
#[test]
fn an_edit_of_the_structure_shows_a_draft_first() {
    let camera = Camera::over(LatLon::from_degrees(10.0, 20.0), 2.2 * 6.371e6, 0.3, -1.4, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [240, 160], quality: Quality::Low };
    // After each surface the builder waits for the test to look at it.
    let (bell, surfaces) = sync_channel(0);
    let builder = Builder::new(move || {
        let _ = bell.send(()).and_then(|()| bell.send(()));
    });
    let mut planet = planet();
    let mut all_surfaces = |edit: &dyn Fn(&mut Structure)| {
        planet.structure.iter_mut().for_each(edit);
        let planet = Arc::new(planet.clone());
        builder.request(&planet, &view).unwrap();
        let mut seen = Vec::new();
        while !builder.has_all_tiles() {
            surfaces.recv().unwrap();
            seen.extend(builder.surface());
            surfaces.recv().unwrap();
        }
        seen.retain(|surface| *surface.terrain.planet() == planet);
        (seen, build_now(&planet, &view).unwrap())
    };
    let (first, _) = all_surfaces(&|_| ());
    assert!(first.iter().any(|surface| surface.stats.maps.drafts == 1 && surface.stats.maps.runs == 0), "from nothing");
    let bits = |surface: &Surface| -> Vec<Vec<Vertex>> {
        surface.leaves.iter().map(|leaf| leaf.tile.vertices.clone()).collect()
    };
    let before = bits(&first[first.len() - 1]);
    for edit in [|s: &mut Structure| s.rivers.erodibility *= 3.0, |s: &mut Structure| s.plates.seed += 1] {
        let (seen, alone) = all_surfaces(&edit);
        assert_eq!(seen[0].stats.maps.drafts, 0, "the first surface waits for nothing");
        let draft = seen.iter().find(|surface| surface.stats.maps.drafts == 1).unwrap();
        assert!(draft.stats.maps.runs == 0 && !draft.complete && bits(draft) != before);
        let last = &seen[seen.len() - 1];
        assert_eq!((last.stats.maps.drafts, last.complete), (1, true));
        assert!(bits(last) == bits(&alone) && bits(draft) != bits(last));
    }
    drop(surfaces);
}

#[test]
fn the_weather_decides_the_climate_as_much_as_its_share_says() {
    let mut planet = planet();
    let dirs: Vec<DVec3> = spread(POINTS).collect();
    let mut moisture = |share: f64| -> Vec<f64> {
        if let Some(structure) = &mut planet.structure {
            structure.weather_share = share;
        }
        terrain(&planet).samples(&dirs, Wanted::HEIGHT.and_climate()).iter().map(|sample| sample.moisture).collect()
    };
    let [zonal, half, solved] = [0.0, 0.5, 1.0].map(&mut moisture);
    let differs = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / POINTS as f64;
    assert!(differs(&zonal, &solved) > 0.05, "{}", differs(&zonal, &solved));
    assert!(differs(&zonal, &half) < differs(&zonal, &solved));
}

/// If this fails, planets with a structure have other ground than when [`GROUND_VERSION`] was set: increase it, say
/// there what changed, and set the new numbers.
#[test]
fn the_ground_changes_only_with_its_version() {
    let heights_m = heights_m(&terrain(&steered_planet()));
    let bits = heights_m.iter().fold(0_u64, |hash, height_m| hash.rotate_left(5) ^ height_m.to_bits());
    assert_eq!((GROUND_VERSION, bits), (5, 10_902_952_415_016_614_367));
}
