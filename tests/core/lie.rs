//! Life by the lie of the ground: distances from water, ridges and hollows.

use crate::water;
use std::sync::Arc;
use tellus::glam::DVec3;
use tellus::life::{Canopies, Instance};
use tellus::planet::{Biome, Fbm, Layer, Planet, Population, Shape, Table, Water};
use tellus::sphere::{LatLon, geo::east_north};
use tellus::terrain::{CURVATURE_M, Terrain, Wanted};

/// A population that stands anywhere.
fn anywhere() -> Population {
    Population { slope_to_deg: 90.0, shore_m: 0.0, clumping: 0.0, per_hectare: 400.0, ..Population::default() }
}

/// Hills of one biome, half of them under a sea.
fn hills(life: Vec<Population>) -> Terrain {
    let shape = Shape::Fbm(Fbm { wavelength_km: 1.0, octaves: 6, ..Default::default() });
    let layers = vec![Layer { amplitude_m: 120.0, shape, ..Layer::default() }];
    let mut planet = Planet { radius_km: 600.0, layers, life, water: Some(Water::default()), ..Planet::default() };
    planet.biomes.palette = vec![Biome { key: 'a', ..Biome::default() }];
    planet.biomes.table = Table::uniform('a', 4, 3);
    (planet.biomes.beach_m, planet.biomes.snow) = (0.0, false);
    Terrain::try_new(Arc::new(planet)).unwrap()
}

fn with_rivers(life: Vec<Population>) -> Terrain {
    let mut planet = Planet { life, ..water::planet() };
    planet.biomes.palette = vec![Biome { key: 'a', ..Biome::default() }];
    planet.biomes.table = Table::uniform('a', 4, 3);
    (planet.biomes.beach_m, planet.biomes.snow) = (0.0, false);
    Terrain::try_new(Arc::new(planet)).unwrap()
}

/// A place on the course of a river in the middle of the land.
fn by_a_river(terrain: &Terrain) -> DVec3 {
    let rivers = terrain.rivers(100.0);
    let upstream = |share: f64| {
        let points =
            rivers.courses.iter().map(move |course| course.points[(course.points.len() as f64 * share) as usize]);
        points.filter(|point| point.height_m > 50.0 && (100.0..400.0).contains(&point.discharge_m3_s))
    };
    let found = upstream(0.5).map(|point| point.place.direction());
    let is_river = |dir: &DVec3| terrain.sample(*dir).river.is_some_and(|river| river.distance_m < 5.0);
    found.into_iter().find(is_river).unwrap()
}

/// Counts of objects are those of the densities that canopies tell, within three deviations.
fn counts_as_canopies_say(terrain: &Terrain, dir: DVec3, radius_m: f64, found: &[Instance]) {
    let canopies = Canopies::new(terrain);
    let (east, north) = east_north(dir);
    let planet_m = terrain.planet().radius_m();
    let side = 120;
    let at = |number: usize| 2.0 * (number as f64 + 0.5) / side as f64 - 1.0;
    let places = (0..side * side).map(|number| [at(number % side), at(number / side)]);
    let inside: Vec<DVec3> = places
        .filter(|[x, y]| x * x + y * y < 1.0)
        .map(|[x, y]| (dir + (east * x + north * y) * (radius_m / planet_m)).normalize())
        .collect();
    let samples = terrain.samples(&inside, Wanted::ALL);
    let hectares = std::f64::consts::PI * radius_m * radius_m / 10_000.0;
    for population in 0..terrain.planet().life.len() {
        let density = |(dir, sample)| canopies.densities_per_hectare(dir, sample)[population];
        let sum: f64 = inside.iter().copied().zip(&samples).map(density).sum();
        let wanted = sum / inside.len() as f64 * hectares;
        let count = found.iter().filter(|instance| usize::from(instance.population) == population).count() as f64;
        assert!(wanted > 100.0, "{population}: {wanted}");
        // Curvature is interpolated over 22 m.
        let off = 3.0 * wanted.sqrt() + 0.05 * wanted;
        assert!((count - wanted).abs() < off, "{population}: {count} objects, {wanted} by the density");
    }
}

#[test]
fn reeds_stand_at_the_bank_of_a_river_and_a_gallery_wood_along_it() {
    let reeds = Population { per_hectare: 8000.0, bank_to_m: 6.0, seed: 1, ..anywhere() };
    let wood = Population { bank_from_m: 4.0, bank_to_m: 40.0, seed: 2, ..anywhere() };
    let away = Population { bank_from_m: 60.0, seed: 3, ..anywhere() };
    let terrain = with_rivers(vec![reeds, wood, away]);
    let dir = by_a_river(&terrain);
    let found = terrain.instances(dir, 250.0).unwrap();
    for instance in &found {
        let sample = terrain.sample(instance.dir_planet);
        let bank_m = sample.bank_m.unwrap();
        assert!(sample.water_level_m.is_none_or(|level_m| level_m <= sample.height_m));
        let ends = [(0.0, 9.5), (1.0, 52.0), (43.0, f64::INFINITY)][usize::from(instance.population)];
        assert!((ends.0..=ends.1).contains(&bank_m), "{}: {bank_m}", instance.population);
    }
    counts_as_canopies_say(&terrain, dir, 250.0, &found);
    let part = terrain.instances(dir, 150.0).unwrap();
    let is_in = |instance: &&Instance| part.contains(instance);
    assert!(part.len() > 50 && found.iter().filter(is_in).count() == part.len(), "{}", part.len());
}

#[test]
fn the_bank_is_where_the_water_of_a_river_ends_and_is_known_far_beyond() {
    let terrain = with_rivers(Vec::new());
    let dir = by_a_river(&terrain);
    let (east, north) = east_north(dir);
    let flow = terrain.sample(dir).river.unwrap().flow_planet;
    let aside = flow.cross(dir).normalize();
    assert!(aside.dot(east).hypot(aside.dot(north)) > 0.99);
    let at = |away_m: f64| terrain.sample((dir + aside * (away_m / terrain.planet().radius_m())).normalize());
    let mut exact = 0;
    for away_m in (0..400).map(f64::from) {
        let sample = at(away_m);
        let bank_m = sample.bank_m.unwrap();
        if sample.water_level_m.is_some() {
            assert_eq!(bank_m, 0.0);
        } else if let Some(river) = sample.river {
            exact += 1;
            assert!(bank_m <= river.distance_m - 0.5 * river.width_m + 0.5, "{away_m}: {bank_m} {river:?}");
        }
        assert!(bank_m <= away_m + 1.0, "{away_m}: {bank_m}");
    }
    assert!(exact > 10, "{exact}");
    // No point knows another distance alone than among others.
    let dirs: Vec<DVec3> = (0..50).map(|i| (dir + aside * (f64::from(i) * 1e-6)).normalize()).collect();
    let together = terrain.samples(&dirs, Wanted::ALL);
    dirs.iter().zip(together).for_each(|(dir, sample)| assert_eq!(terrain.sample(*dir), sample));
}

#[test]
fn ridges_and_hollows_bound_a_population_and_shores_do() {
    let ridge = Population { curvature_from: 0.03, seed: 1, ..anywhere() };
    let hollow = Population { curvature_to: -0.03, seed: 2, ..anywhere() };
    let shore = Population { bank_to_m: 100.0, seed: 3, ..anywhere() };
    let sparse = Population { curvature_from: 0.03, per_hectare: 0.05, seed: 4, ..anywhere() };
    let terrain = hills(vec![ridge, hollow, shore, sparse]);
    let dir = LatLon::from_degrees(20.0, 30.0).direction();
    let found = terrain.instances(dir, 1500.0).unwrap();
    let mut sums = [(0.0, 0.0); 2];
    for instance in &found {
        let sample = terrain.sample(instance.dir_planet);
        match instance.population {
            2 => assert!(sample.height_m < 12.7 && sample.bank_m == Some(10.0 * sample.height_m)),
            3 => assert!(sample.curvature > 0.01, "{}", sample.curvature),
            // Between the samples of the soil it varies.
            of => {
                let (sum, count) = &mut sums[usize::from(of)];
                (*sum, *count) = (*sum + sample.curvature, *count + 1.0);
            }
        }
    }
    let [ridge, hollow] = sums.map(|(sum, count)| sum / count);
    assert!(ridge > 0.04 && hollow < -0.04, "{ridge} {hollow}");
    counts_as_canopies_say(&hills(terrain.planet().life[..3].to_vec()), dir, 700.0, &{
        let mut near = terrain.instances(dir, 700.0).unwrap();
        near.retain(|instance| instance.population < 3);
        near
    });
}

#[test]
fn curvature_is_the_height_over_the_mean_around() {
    let terrain = hills(Vec::new());
    let planet_m = terrain.planet().radius_m();
    for (lat_deg, lon_deg) in [(20.0, 30.0), (0.0, 45.0), (-35.2, 179.999), (89.99, 5.0)] {
        let dir = LatLon::from_degrees(lat_deg, lon_deg).direction();
        let (east, north) = east_north(dir);
        let around = [east, -east, north, -north].map(|to| terrain.height_m(dir + to * (CURVATURE_M / planet_m)));
        let wanted = (terrain.height_m(dir) - around.iter().sum::<f64>() / 4.0) / CURVATURE_M;
        assert!((terrain.sample(dir).curvature - wanted).abs() < 1e-9, "{wanted}");
    }
}
