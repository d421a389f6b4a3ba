//! Random planets worth opening: several are scouted from afar, and the best is shown from its best side.
//!
//! The score of a disc is the spread of its colours, with a bonus for land beside sea. Clouds and air are left out.

use super::opening::{OPENING_ALTITUDE_RADII, OPENING_LAT_DEG, OPENING_LON_FROM_STAR_DEG};
use crate::planet::Planet;
use crate::planet::random::{self, Kind};
use crate::sphere::{LatLon, spread};
use crate::terrain::coarse::CellFields;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use crate::world::MapWork;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;

/// Planets scouted for one seed, at most.
const CANDIDATES: u64 = 5;
/// The score from which a planet is taken without another look. Half of all random planets reach it.
const ENOUGH: f64 = 0.2;
/// Directions sampled over a planet: about 300 of them are on a disc.
const DIRECTIONS: usize = 1024;
/// Sides of the planet that are compared.
const SIDES: usize = 24;
/// Weight of land beside sea against the spread of colours.
const COAST_WEIGHT: f64 = 0.12;

/// The best of several random planets, with its star over its best side. The same seed gives the same planet. `kind`:
/// None leaves it to chance.
pub fn random_planet(kind: Option<Kind>, seed: u64) -> Planet {
    let random = |seed| random::random_of(kind, seed);
    // The candidates of one seed are none of the next one's.
    let seeds = (0..CANDIDATES).map(|i| if i == 0 { seed } else { seed.rotate_left(32) ^ i });
    let mut best: Option<(f64, Planet)> = None;
    for seed in seeds {
        let mut planet = random(seed);
        let score = turn_to_best_side(&mut planet);
        if best.as_ref().is_none_or(|(most, _)| score > *most) {
            best = Some((score, planet));
        }
        if score >= ENOUGH {
            break;
        }
    }
    best.map_or_else(|| random(seed), |(_, planet)| planet)
}

/// Puts the star where the opening view shows the planet's best side. The answer is the score of that side, 0 to 1.
pub fn turn_to_best_side(planet: &mut Planet) -> f64 {
    let looks = look(planet);
    let step_deg = 360.0 / SIDES as f64;
    let side = |i: usize| i as f64 * step_deg - 180.0;
    let scores = (0..SIDES).map(|i| (score(&looks, planet.star.latitude_deg, side(i)), side(i)));
    let (best, star_lon_deg) = scores.fold((-1.0, 0.0), |best, next| if next.0 > best.0 { next } else { best });
    planet.star.longitude_deg = star_lon_deg;
    best
}

/// One direction of a planet as seen from afar.
struct Look {
    dir_planet: DVec3,
    /// Albedo, as the square root of linear sRGB: about as far apart as the eye sees it.
    color: DVec3,
    land: bool,
}

fn look(planet: &Planet) -> Vec<Look> {
    let dirs: Vec<DVec3> = spread(DIRECTIONS).collect();
    let Ok(terrain) = Terrain::builder(Arc::new(planet.clone())).draft() else { return Vec::new() };
    // Drafts of the maps show where the land lies, and take a tenth of the time of the first maps proper.
    let terrain = terrain.with_draft_maps(&CellFields::default(), &mut MapWork::default()).unwrap_or(terrain);
    let mut samples = vec![Sample::default(); DIRECTIONS];
    let spacing_rad = (4.0 * PI / DIRECTIONS as f64).sqrt();
    terrain.samples_spaced_into(&dirs, spacing_rad, Wanted::HEIGHT.and_biome(), &mut samples, &mut Scratch::default());
    let sea = planet.water.as_ref();
    let looks = dirs.into_iter().zip(samples).map(|(dir_planet, sample)| {
        let drowned = sea.filter(|sea| sample.height_m < sea.level_m);
        let ground = planet.biomes.palette.get(sample.biome).map(|biome| biome.color);
        let color = drowned.map(|sea| sea.color).or(ground).unwrap_or_default();
        Look { dir_planet, color: DVec3::from(color.map(|c| c.max(0.0).sqrt())), land: drowned.is_none() }
    });
    looks.collect()
}

/// Score of the opening view with the star over a longitude, 0 to about 1.
fn score(looks: &[Look], star_lat_deg: f64, star_lon_deg: f64) -> f64 {
    let star = LatLon::from_degrees(star_lat_deg, star_lon_deg).direction();
    let eye = LatLon::from_degrees(OPENING_LAT_DEG, star_lon_deg + OPENING_LON_FROM_STAR_DEG).direction();
    let limb = 1.0 / (1.0 + OPENING_ALTITUDE_RADII);
    let weighed = || {
        looks.iter().filter_map(move |look| {
            // Area on the screen, times light.
            let (seen, lit) = (look.dir_planet.dot(eye) - limb, look.dir_planet.dot(star));
            (seen > 0.0 && lit > 0.0).then_some((seen * lit, look))
        })
    };
    let total: f64 = weighed().map(|(weight, _)| weight).sum();
    if total <= 0.0 {
        return 0.0;
    }
    let mean = weighed().map(|(weight, look)| look.color * weight).sum::<DVec3>() / total;
    let spread2 = weighed().map(|(weight, look)| look.color.distance_squared(mean) * weight).sum::<f64>() / total;
    let land = weighed().map(|(weight, look)| if look.land { weight } else { 0.0 }).sum::<f64>() / total;
    // Most for two parts of land beside three of sea; none for open sea.
    let coast = (1.0 - ((land - 0.4) / 0.4).powi(2)).max(0.0);
    spread2.sqrt() + COAST_WEIGHT * coast
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::validate;

    #[test]
    fn random_planets_show_their_best_side() {
        let mut better = 0;
        for seed in 0..6 {
            let planet = random_planet(None, seed);
            assert!(validate::problems(&planet).is_empty());
            assert_eq!(planet, random_planet(None, seed), "the same seed");
            let looks = look(&planet);
            let shown = score(&looks, planet.star.latitude_deg, planet.star.longitude_deg);
            let back = score(&looks, planet.star.latitude_deg, planet.star.longitude_deg + 150.0);
            assert!(shown >= back, "seed {seed}: {shown} {back}");
            let plain = random::random(seed);
            let unturned = score(&look(&plain), plain.star.latitude_deg, plain.star.longitude_deg);
            assert!(shown >= unturned, "seed {seed}: {shown} {unturned}");
            better += usize::from(shown > unturned + 0.02);
        }
        assert!(better >= 3, "{better} of 6");
    }

    /// What scores: coasts and colours more than one colour.
    #[test]
    fn a_coast_scores_more_than_open_sea() {
        let looks = |land: fn(DVec3) -> bool| -> Vec<Look> {
            let look = |dir_planet: DVec3| {
                let land = land(dir_planet);
                Look { dir_planet, color: if land { DVec3::splat(0.5) } else { DVec3::ZERO }, land }
            };
            spread(512).map(look).collect()
        };
        let (sea, coast) = (score(&looks(|_| false), 0.0, 0.0), score(&looks(|dir| dir.y > 0.5), 0.0, 0.0));
        assert!(sea.abs() < 1e-12 && coast > 0.2, "{sea} {coast}");
    }
}
