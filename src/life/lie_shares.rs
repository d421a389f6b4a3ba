//! Lie shares: what the distance from water and the curvature of the ground leave of populations, which pixels do not
//! know, on grids that are fixed to the planet. The planting map takes them from here.

use super::suitability::Suitability;
use crate::planet::Key;
use crate::sphere::NodeId;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// Levels from a tile to its samples: 16 along a side.
const DEEPER: u8 = 4;
const SIDE: usize = 1 << DEEPER;
/// Samples along a side of a part of a tile whose mean curvature share counts where samples are far apart.
const PART: usize = 4;
/// Distance between samples, metres, from which they are: hollows and ridges are finer.
const COARSE_M: f64 = 200.0;
/// Distances from water within a sample whose mean its share is.
const STEPS: u32 = 8;
/// Most tiles that are kept.
const MOST_KEPT: usize = 4096;

/// Shares of some populations in a node: population by population, row by row.
#[derive(Debug)]
struct Tile {
    key: Key,
    shares: Vec<f32>,
}

/// Tiles of earlier maps.
#[derive(Debug, Default)]
pub(super) struct LieShares(HashMap<NodeId, Tile>);

/// The level of samples that are at most this far apart.
pub(super) fn sample_level(radius_m: f64, apart_m: f64) -> u8 {
    let level = (FRAC_PI_2 * radius_m / apart_m).log2().ceil();
    level.clamp(f64::from(DEEPER), f64::from(NodeId::MAX_LEVEL)) as u8
}

/// The tile of a sample.
pub(super) fn tile_of(sample: NodeId) -> NodeId {
    NodeId { level: sample.level - DEEPER, x: sample.x >> DEEPER, y: sample.y >> DEEPER, ..sample }
}

impl LieShares {
    /// Makes tiles that are not kept, in rounds, while `keep_going` says yes. Whether all are there now. `asks`: the
    /// populations, in the order of [`Self::at`].
    pub(super) fn find(
        &mut self,
        terrain: &Terrain,
        asks: &[Suitability],
        tiles: &[NodeId],
        keep_going: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let rules = Key::of(&asks.iter().map(|one| one.population.placed()).collect::<Vec<_>>());
        let keyed = tiles.par_iter().map(|tile| (*tile, Key::of(&(rules, terrain.tile_keys_at(*tile)))));
        let keyed: Vec<(NodeId, Key)> = keyed.collect();
        if self.0.len() + keyed.len() > MOST_KEPT {
            self.0.clear();
        }
        let lacking = keyed.into_iter().filter(|(tile, key)| self.0.get(tile).is_none_or(|kept| kept.key != *key));
        let lacking: Vec<(NodeId, Key)> = lacking.collect();
        lacking.chunks(4 * rayon::current_num_threads().max(1)).all(|round| {
            if !keep_going() {
                return false;
            }
            let made = round.par_iter().map_init(Scratch::default, |scratch, (tile, key)| {
                (*tile, Tile { key: *key, shares: shares(terrain, asks, *tile, scratch) })
            });
            self.0.extend(made.collect::<Vec<_>>());
            true
        })
    }

    /// The share of a population at a sample; 1 where it is not known.
    pub(super) fn at(&self, population: usize, sample: NodeId) -> f64 {
        let place = [sample.x, sample.y].map(|at| at as usize % SIDE);
        let number = (population * SIDE + place[1]) * SIDE + place[0];
        self.0.get(&tile_of(sample)).and_then(|tile| tile.shares.get(number)).map_or(1.0, |share| f64::from(*share))
    }
}

/// The shares in a tile.
fn shares(terrain: &Terrain, asks: &[Suitability], tile: NodeId, scratch: &mut Scratch) -> Vec<f32> {
    let middle = |at: usize| (at as f64 + 0.5) / SIDE as f64;
    let dirs: Vec<_> = (0..SIDE * SIDE).map(|i| tile.direction(middle(i % SIDE), middle(i / SIDE))).collect();
    let radius_m = terrain.planet().radius_m();
    let apart_m = FRAC_PI_2 * radius_m * 0.5_f64.powi(i32::from(tile.level + DEEPER));
    let wanted = Wanted::HEIGHT.and_for_life(terrain.planet());
    let mut samples = vec![Sample::default(); dirs.len()];
    terrain.samples_spaced_into(&dirs, apart_m / radius_m, wanted, &mut samples, scratch);
    let of_population = |one: &Suitability| {
        let curved: Vec<f64> = samples.iter().map(|sample| one.population.by_curvature(sample.curvature)).collect();
        let curved_at = |number: usize| {
            if apart_m < COARSE_M {
                return curved[number];
            }
            let first = [number % SIDE, number / SIDE].map(|at| at / PART * PART);
            let around = (0..PART * PART).map(|i| curved[(first[1] + i / PART) * SIDE + first[0] + i % PART]);
            around.sum::<f64>() / (PART * PART) as f64
        };
        let share = |number: usize| (curved_at(number) * by_bank(one, &samples[number], apart_m)) as f32;
        (0..SIDE * SIDE).map(share).collect::<Vec<f32>>()
    };
    asks.iter().flat_map(of_population).collect()
}

/// Mean share over the distances from water that a sample stands for: half of it lies nearer, half farther. What would
/// lie in the water is none of it, unless the population stands there.
fn by_bank(one: &Suitability, sample: &Sample, apart_m: f64) -> f64 {
    if !one.population.asks_bank() {
        return 1.0;
    }
    let bank_m = sample.bank_m.unwrap_or(f64::INFINITY);
    let share = |step: u32| {
        let at_m = bank_m + apart_m * ((f64::from(step) + 0.5) / f64::from(STEPS) - 0.5);
        if at_m >= 0.0 || one.population.in_water { one.population.by_bank(at_m.max(0.0)) } else { 0.0 }
    };
    (0..STEPS).map(share).sum::<f64>() / f64::from(STEPS)
}
