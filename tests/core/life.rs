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

#[test]
fn what_falls_from_trees_colours_the_ground_between_them() {
    let colours = |litter: f64| {
        let wood = Population { litter, color: [0.2, 0.15, 0.1], leaf_color: [0.2, 0.15, 0.1], ..trees() };
        let terrain = terrain(vec![wood]);
        let canopies = Canopies::new(&terrain);
        let middle = LatLon::from_degrees(20.0, 30.0).direction();
        let (east, _) = middle.any_orthonormal_pair();
        let dirs = (0..400).map(|i| (middle + east * (f64::from(i) * 1e-5)).normalize());
        let all = dirs.map(|dir| {
            (canopies.at(dir, &terrain.sample(dir)).cover, canopies.albedo(dir, &terrain.sample(dir), [1.0; 3]))
        });
        let on_land: Vec<_> = all.filter(|(cover, _)| *cover > 0.2).collect();
        assert!(on_land.len() > 100, "{}", on_land.len());
        on_land
    };
    for ((cover, bare), (_, littered)) in colours(0.0).into_iter().zip(colours(0.8)) {
        let floor = |seen: [f64; 3]| std::array::from_fn(|c| (seen[c] - cover * [0.2, 0.15, 0.1][c]) / (1.0 - cover));
        let (bare, littered): ([f64; 3], [f64; 3]) = (floor(bare), floor(littered));
        assert!(bare.iter().all(|channel| (channel - 1.0).abs() < 1e-9), "{bare:?}");
        // Brown, never more than the share of it, and all the more the more the crowns close.
        assert!(
            littered[2] < littered[0] && littered[2] > 0.2 && littered[0] < 1.0 - 0.8 * 0.8 * cover,
            "{littered:?}"
        );
    }
}

#[test]
fn the_nearest_object_is_the_nearest_of_the_list() {
    let sparse = Population { name: "Sparse".to_owned(), seed: 9, per_hectare: 0.02, ..trees() };
    let terrain = terrain(vec![trees(), sparse]);
    for (lat_deg, lon_deg) in [(20.0, 30.0), (-5.0, 100.0), (71.0, -3.0)] {
        let dir = LatLon::from_degrees(lat_deg, lon_deg).direction();
        let all = around(&terrain, lat_deg, lon_deg, 6000.0);
        let away_m = |instance: &Instance| (instance.dir_planet - dir).length() * 600_000.0;
        for only in [&[][..], &[0], &[1]] {
            let of_kind = all.iter().filter(|one| only.is_empty() || only.contains(&one.population));
            let wanted = of_kind.clone().min_by(|a, b| away_m(a).total_cmp(&away_m(b))).unwrap();
            let found = terrain.nearest_object(dir, 6000.0, only, &|_| true).unwrap().unwrap();
            assert_eq!(found.instance, *wanted);
            assert!((found.away_m - away_m(wanted)).abs() < 1e-3);
            // The next one, if a game has taken that.
            let next = terrain.nearest_object(dir, 6000.0, only, &|one| one.id != wanted.id).unwrap().unwrap();
            let second = of_kind.filter(|one| one.id != wanted.id).min_by(|a, b| away_m(a).total_cmp(&away_m(b)));
            assert_eq!(Some(&next.instance), second);
            // Just not within reach.
            assert_eq!(terrain.nearest_object(dir, found.away_m * 0.999, only, &|_| true), Ok(None));
        }
    }
}

#[test]
fn a_search_for_objects_has_an_end() {
    let all = terrain(vec![trees(), Population { enabled: false, seed: 2, ..trees() }]);
    let dir = LatLon::from_degrees(20.0, 30.0).direction();
    let error = all.nearest_object(dir, 1e9, &[0], &|_| false).unwrap_err();
    assert!(error.to_string().contains("ask for a smaller part"), "{error}");
    for (within_m, only) in [(f64::NAN, 0), (-3.0, 0), (0.0, 0), (500.0, 1), (500.0, 7)] {
        assert_eq!(all.nearest_object(dir, within_m, &[only], &|_| true), Ok(None));
    }
    assert_eq!(terrain(Vec::new()).nearest_object(dir, 1e9, &[], &|_| true), Ok(None));
    assert!(all.nearest_object(glam::DVec3::NAN, 1e4, &[], &|_| true).is_ok());
}
