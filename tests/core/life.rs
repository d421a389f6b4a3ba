//! What stands on the ground: density, places, and that lists are the same wherever they are asked for.

use std::collections::HashSet;
use std::sync::Arc;
use tellus::life::{Canopies, Canopy, Instance};
use tellus::planet::{Biome, Layer, Planet, Population, Shape, Table, Water};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

/// Rolling ground, half of it under a sea.
fn planet(life: Vec<Population>) -> Planet {
    let mut planet = Planet { radius_km: 600.0, life, water: Some(Water::default()), ..Planet::default() };
    planet.layers = vec![Layer {
        amplitude_m: 60.0,
        shape: Shape::Fbm(tellus::planet::Fbm { wavelength_km: 4.0, octaves: 9, ..Default::default() }),
        ..Layer::default()
    }];
    let biome = |key| Biome { key, ..Biome::default() };
    planet.biomes.palette = vec![biome('a'), biome('b')];
    planet.biomes.table = Table::uniform('a', 4, 3);
    planet.biomes.beach_m = 0.0;
    planet.biomes.snow = false;
    planet
}

fn trees() -> Population {
    Population { per_hectare: 300.0, shore_m: 0.5, ..Population::default() }
}

fn terrain(life: Vec<Population>) -> Terrain {
    Terrain::try_new(Arc::new(planet(life))).unwrap()
}

fn around(terrain: &Terrain, lat_deg: f64, lon_deg: f64, radius_m: f64) -> Vec<Instance> {
    terrain.instances(LatLon::from_degrees(lat_deg, lon_deg).direction(), radius_m).unwrap()
}

#[test]
fn objects_stand_on_the_ground_that_queries_answer_and_never_in_water() {
    let terrain = terrain(vec![trees()]);
    let found = around(&terrain, 20.0, 30.0, 3000.0);
    assert!(found.len() > 10_000, "{}", found.len());
    for instance in &found {
        assert_eq!(instance.ground_m, terrain.height_m(instance.dir_planet));
        assert!(instance.ground_m >= 0.5 && instance.base_m <= instance.ground_m);
        assert!((instance.axis_planet.length() - 1.0).abs() < 1e-9 && (0.0..1.0).contains(&instance.rank));
    }
    let ids: HashSet<u64> = found.iter().map(|instance| instance.id).collect();
    assert_eq!(ids.len(), found.len());
    assert!(found.is_sorted_by_key(|instance| instance.id));
}

#[test]
fn a_part_has_the_objects_that_the_whole_has_there() {
    let grass = Population { per_hectare: 20_000.0, seed: 5, ..trees() };
    let terrain = terrain(vec![trees(), grass]);
    let whole = around(&terrain, 20.0, 30.0, 150.0);
    let part = around(&terrain, 20.0005, 30.0005, 60.0);
    let far = |instance: &Instance| {
        let middle = LatLon::from_degrees(20.0005, 30.0005).direction();
        (instance.dir_planet - middle).length() * 600_000.0 > 60.0
    };
    let wanted: Vec<_> = whole.iter().filter(|instance| !far(instance)).copied().collect();
    assert!(part.len() > 1000);
    assert_eq!(part, wanted);
}

#[test]
fn counts_follow_the_density_within_three_deviations() {
    // Flat dry ground: every place suits.
    for (per_hectare, clumping) in [(0.5, 0.0), (40.0, 0.0), (900.0, 0.0), (900.0, 0.6)] {
        let life = vec![Population { per_hectare, clumping, clump_m: 15.0, ..trees() }];
        let bare = Planet { layers: Vec::new(), water: None, ..planet(life) };
        let terrain = Terrain::try_new(Arc::new(bare)).unwrap();
        for (lat_deg, lon_deg) in [(0.0, 0.0), (35.0, 44.0), (88.0, 10.0)] {
            let radius_m = (3000.0 / per_hectare * 10_000.0 / std::f64::consts::PI).sqrt();
            let count = around(&terrain, lat_deg, lon_deg, radius_m).len() as f64;
            // Groups that the circle cuts differ by more than single objects.
            let deviation = 3000_f64.sqrt() * (1.0 + 3.0 * clumping);
            assert!((count - 3000.0).abs() < 3.0 * deviation, "{per_hectare} {clumping} {lat_deg}: {count}");
        }
    }
}

#[test]
fn a_rank_below_a_half_leaves_every_second_object_evenly() {
    let terrain = terrain(vec![trees()]);
    let found = around(&terrain, 20.0, 30.0, 2000.0);
    let half = found.iter().filter(|instance| instance.rank < 0.5).count() as f64;
    let deviation = (found.len() as f64 / 4.0).sqrt();
    assert!((half - found.len() as f64 / 2.0).abs() < 4.0 * deviation, "{half} of {}", found.len());
}

#[test]
fn biomes_slopes_heights_and_climate_bound_a_population() {
    let steep = Population { slope_from_deg: 6.0, ..trees() };
    let high = Population { height_from_m: 20.0, height_to_m: 30.0, ..trees() };
    let elsewhere = Population { biomes: "b".to_owned(), ..trees() };
    let cold = Population { temperature_to_c: -150.0, ..trees() };
    let terrain = terrain(vec![steep, high, elsewhere, cold]);
    let found = around(&terrain, 20.0, 30.0, 3000.0);
    let of = |index: u16| found.iter().filter(move |instance| instance.population == index);
    assert!(of(0).count() > 100 && of(1).count() > 100);
    let slope_deg = |instance: &Instance| -> f64 { terrain.sample(instance.dir_planet).slope_rad.to_degrees() };
    // Between the samples of the soil slopes and heights vary.
    let mean_deg = of(0).map(slope_deg).sum::<f64>() / of(0).count() as f64;
    assert!(mean_deg > 3.5, "{mean_deg}");
    assert!(of(1).all(|instance| instance.ground_m > 1.0 && instance.ground_m < 50.0));
    assert_eq!((of(2).count(), of(3).count()), (0, 0));
}

#[test]
fn too_large_a_part_is_refused() {
    let terrain = terrain(vec![trees()]);
    let error = terrain.instances(glam::DVec3::X, 400_000.0).unwrap_err();
    assert!(error.to_string().contains("ask for a smaller part"), "{error}");
    assert!(terrain.instances(glam::DVec3::NAN, f64::NAN).unwrap().is_empty());
}

/// Lists must be the same on every machine.
#[test]
fn the_list_of_a_place_is_pinned() {
    let terrain = terrain(vec![trees()]);
    let found = around(&terrain, 20.0, 30.0, 500.0);
    let hash = found.iter().fold(0_u64, |hash, instance| {
        let place = instance.dir_planet.to_array().into_iter().chain([instance.base_m, instance.size_m, instance.rank]);
        let bits = place.chain([instance.turn_rad]).chain(instance.axis_planet.to_array()).map(f64::to_bits);
        bits.chain([instance.id, u64::from(instance.variant)])
            .fold(hash, |hash, bits| (hash ^ bits).wrapping_mul(0x0100_0000_01b3).rotate_left(7))
    });
    assert_eq!((found.len(), hash), (11_873, 16_820_276_421_146_807_046));
}

#[test]
fn canopies_have_the_densities_of_objects_and_none_in_the_sea() {
    let terrain = terrain(vec![trees(), Population { enabled: false, ..trees() }]);
    let canopies = Canopies::new(&terrain);
    let middle = LatLon::from_degrees(20.0, 30.0).direction();
    let (east, north) = middle.any_orthonormal_pair();
    let radius_m = 1500.0;
    let spot = |x: i32, y: i32| [x, y].map(|at| (f64::from(at) + 0.5) / 40.0);
    let spots = (-40..40).flat_map(|x| (-40..40).map(move |y| spot(x, y)));
    let inside: Vec<_> = spots.filter(|[x, y]| x.hypot(*y) < 1.0).collect();
    let (mut density, mut in_sea) = (0.0, 0);
    for [x, y] in &inside {
        let dir = (middle + (east * *x + north * *y) * (radius_m / 600_000.0)).normalize();
        let sample = terrain.sample(dir);
        let (densities, canopy) = (canopies.densities_per_hectare(dir, &sample), canopies.at(dir, &sample));
        assert_eq!(densities[1], 0.0);
        assert!((0.0..1.0).contains(&canopy.cover) && (canopy.cover > 0.0) == (densities[0] > 0.0));
        if sample.height_m < 0.5 {
            in_sea += 1;
            assert_eq!(canopy, Canopy::default());
            assert_eq!(canopies.albedo(dir, &sample, [0.5, 0.4, 0.3]), [0.5, 0.4, 0.3]);
        } else {
            assert!((5.0..15.0).contains(&canopy.height_m) || canopy.cover == 0.0, "{canopy:?}");
        }
        density += densities[0] / inside.len() as f64;
    }
    assert!(in_sea > 100 && in_sea < inside.len() - 100, "{in_sea} of {}", inside.len());
    let counted = around(&terrain, 20.0, 30.0, radius_m).len() as f64;
    let wanted = density * std::f64::consts::PI * radius_m * radius_m / 10_000.0;
    assert!((counted / wanted - 1.0).abs() < 0.03, "{counted} objects, not {wanted}");
}
