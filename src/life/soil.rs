//! Soil: what the ground offers on a grid of points in a node, from which populations take their density.
//!
//! A population that is denser than a few objects in a node reads this grid and interpolates; only where an object
//! stands is the ground evaluated once more.

use super::grid::place_in;
use super::suitability::Suitability;
use crate::planet::Planet;
use crate::sphere::NodeId;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// Points along a side of a node.
const SIDE: usize = 5;
/// Longest side of a node, metres.
const NODE_M: f64 = 90.0;
/// Metres from a river beyond its banks within which single objects are checked for water.
const NEAR_RIVER_M: f64 = 40.0;
/// Metres over the sea within which single objects are checked for water.
const NEAR_SEA_M: f64 = 25.0;

/// Soil that is kept for single questions: a quarter of a megabyte.
const MOST_KEPT: usize = 48;

/// What the ground offers in a node.
#[derive(Clone, Debug)]
pub(super) struct Soil {
    id: NodeId,
    samples: Vec<Sample>,
    /// Whether no water is near, so that objects need not be checked for it.
    pub(super) is_dry: bool,
}

impl Soil {
    /// The level of nodes whose soil is known.
    pub(super) fn level(planet: &Planet) -> u8 {
        let mut side_m = FRAC_PI_2 * planet.radius_m();
        let mut level = 0;
        while side_m > NODE_M && level < NodeId::MAX_LEVEL {
            (level, side_m) = (level + 1, 0.5 * side_m);
        }
        level
    }

    /// Samples the ground of a node.
    pub(super) fn new(terrain: &Terrain, id: NodeId, scratch: &mut Scratch) -> Self {
        let share = |number: usize| number as f64 / (SIDE - 1) as f64;
        let dirs: Vec<_> = (0..SIDE * SIDE).map(|i| id.direction(share(i % SIDE), share(i / SIDE))).collect();
        let mut samples = vec![Sample::default(); dirs.len()];
        let wanted = Wanted::HEIGHT.and_normal().and_biome().and_for_life(terrain.planet());
        terrain.samples_spaced_into(&dirs, 0.0, wanted, &mut samples, scratch);
        let sea_m = terrain.planet().sea_level_m();
        let is_dry = samples.iter().all(|sample| {
            let by_river = sample.river.is_some_and(|river| river.distance_m < 0.5 * river.width_m + NEAR_RIVER_M);
            let by_sea = sea_m.is_some_and(|sea_m| sample.height_m < sea_m + NEAR_SEA_M);
            sample.water_level_m.is_none() && !by_river && !by_sea
        });
        Self { id, samples, is_dry }
    }

    /// Normal of the ground around a direction in the node, over some twenty metres. `planet_m`: radius of the planet.
    pub(super) fn normal(&self, dir: DVec3, planet_m: f64) -> DVec3 {
        let last = (SIDE - 1) as f64;
        let [x, y] = place_in(self.id, dir).map(|share| ((share * last) as usize).min(SIDE - 2));
        let point = |across: usize, up: usize| {
            let [u, v] = [x + across, y + up].map(|number| number as f64 / last);
            self.id.direction(u, v) * (planet_m + self.samples[(y + up) * SIDE + x + across].height_m)
        };
        let normal = (point(1, 1) - point(0, 0)).cross(point(0, 1) - point(1, 0)).normalize_or(dir);
        if normal.dot(dir) < 0.0 { -normal } else { normal }
    }

    /// What a population finds in the node; None if it stands nowhere there.
    ///
    /// Distances from water are shorter than the points are apart: they are left to the places of single objects, where
    /// they may suit at all.
    pub(super) fn offered(&self, suitability: &Suitability) -> Option<Offer> {
        let shares: Vec<f64> = self.samples.iter().map(|sample| suitability.in_soil(sample)).collect();
        let farthest_m = suitability.population.farthest_bank_m();
        let least_banks_m = least_banks_m(&self.samples, farthest_m);
        let is_near = least_banks_m.as_ref().is_none_or(|least_m| least_m.iter().any(|least_m| *least_m < farthest_m));
        let is_any = is_near && shares.iter().any(|share| *share > 0.0);
        is_any.then_some(Offer { id: self.id, shares, least_banks_m, farthest_m })
    }
}

/// Metres by which the distance from a bank may differ at a place from that at the nearest point: points are at most
/// 23 m apart.
const BETWEEN_M: f64 = 25.0;
/// The same where it is ten times a height: for each unit of slope, and in any case.
const BETWEEN_SHORE_M: [f64; 2] = [320.0, 20.0];

/// Distances from water that places near the points of a node have at least; None if the population asks for no
/// greatest distance.
fn least_banks_m(samples: &[Sample], farthest_m: f64) -> Option<Vec<f64>> {
    let least_m = |sample: &Sample| {
        let by_height_m = BETWEEN_SHORE_M[0] * libm::tan(sample.slope_rad) + BETWEEN_SHORE_M[1];
        let between_m = if sample.bank_by_height { by_height_m } else { BETWEEN_M };
        sample.bank_m.map_or(f64::INFINITY, |bank_m| bank_m - between_m)
    };
    (farthest_m < f64::INFINITY).then(|| samples.iter().map(least_m).collect())
}

/// The share of its density that a population has at the points of a node.
pub(super) struct Offer {
    id: NodeId,
    shares: Vec<f64>,
    least_banks_m: Option<Vec<f64>>,
    farthest_m: f64,
}

impl Offer {
    /// The part of the node that a cell in it takes.
    pub(super) fn part(&self, cell: NodeId) -> [f64; 3] {
        cell.within(self.id)
    }

    /// The share at a place of a part of the node, between the points; 0 where water is certainly too far.
    pub(super) fn at(&self, [width, x, y]: [f64; 3], place: [f64; 2]) -> f64 {
        let last = (SIDE - 1) as f64;
        let at = [x + place[0] * width, y + place[1] * width].map(|share| (share * last).clamp(0.0, last));
        let corner = at.map(|at| (at as usize).min(SIDE - 2));
        let part = [at[0] - corner[0] as f64, at[1] - corner[1] as f64];
        let number = |across: usize, up: usize| (corner[1] + up) * SIDE + corner[0] + across;
        let corners = [number(0, 0), number(1, 0), number(0, 1), number(1, 1)];
        let is_far = |least_m: &Vec<f64>| corners.iter().all(|number| least_m[*number] >= self.farthest_m);
        if self.least_banks_m.as_ref().is_some_and(is_far) {
            return 0.0;
        }
        let share = |across: usize, up: usize| self.shares[number(across, up)];
        let row = |up: usize| share(0, up) + (share(1, up) - share(0, up)) * part[0];
        row(0) + (row(1) - row(0)) * part[1]
    }
}

/// The soil of many nodes.
#[derive(Default)]
pub(super) struct Soils(HashMap<NodeId, Soil>);

impl Soils {
    /// Adds the soil of nodes that are not there yet, on all cores.
    pub(super) fn add(&mut self, terrain: &Terrain, nodes: impl Iterator<Item = NodeId>) {
        let mut missing: Vec<NodeId> = nodes.filter(|node| !self.0.contains_key(node)).collect();
        missing.sort_unstable();
        missing.dedup();
        let made = missing.par_iter().map_init(Scratch::default, |scratch, id| (*id, Soil::new(terrain, *id, scratch)));
        self.0.extend(made.collect::<Vec<_>>());
    }

    /// Adds the soil of a node, on the calling thread; forgets all others if there are many.
    pub(super) fn add_one(&mut self, terrain: &Terrain, node: NodeId, scratch: &mut Scratch) {
        if self.0.len() > MOST_KEPT && !self.0.contains_key(&node) {
            self.0.clear();
        }
        self.0.entry(node).or_insert_with(|| Soil::new(terrain, node, scratch));
    }

    /// The soil of a node.
    pub(super) fn get(&self, node: Option<NodeId>) -> Option<&Soil> {
        self.0.get(&node?)
    }
}
