//! The objects of a cell: the candidates that stand, on the ground of the evaluator.

use super::grid::{Candidate, Grid};
use super::query::Instance;
use super::soil::{Offer, Soil};
use super::suitability::Suitability;
use crate::planet::{Form, Key, Planet, Population};
use crate::sphere::NodeId;
use crate::terrain::edits::{Edits, Placed, Planting, PopulationId};
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use std::collections::HashSet;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Levels from a group of cells down to a cell.
const GROUP_LEVELS: u8 = 2;

/// A population of a planet, ready to be placed.
#[derive(Clone, Debug)]
pub(super) struct Placement {
    pub(super) grid: Grid,
    /// Index in the planet's list.
    pub(super) index: u16,
    /// Its name, as edits know it.
    id: PopulationId,
    suitability: Suitability,
    radius_m: f64,
    seed: u32,
    soil_level: u8,
}

/// A candidate that may stand, as far as the soil tells.
#[derive(Clone, Copy)]
struct Likely {
    candidate: Candidate,
    /// Share that the soil offers, the distance from water apart; 1 without soil.
    offered: f64,
    /// The most that the share can be before groups.
    most: f64,
    /// Share that groups leave.
    clumping: f64,
    planting: Planting,
}

/// Memory for placing on one thread.
#[derive(Default)]
pub(super) struct PlacementScratch {
    candidates: Vec<Likely>,
    planted: Vec<Planting>,
    /// Directions of the candidates.
    dirs: Vec<DVec3>,
    clumpings: Vec<f64>,
    samples: Vec<Sample>,
    scratch: Scratch,
}

impl Placement {
    /// The populations of a planet that are on.
    pub(super) fn all(planet: &Planet) -> Vec<Self> {
        let populations = planet.life.iter().enumerate().filter(|(_, population)| population.enabled);
        populations.map(|(index, population)| Self::new(planet, population, index as u16)).collect()
    }

    /// Populations of a planet that are on: some, by their indices, or all if none is named.
    pub(super) fn of(planet: &Planet, populations: &[u16]) -> Vec<Self> {
        let mut all = Self::all(planet);
        all.retain(|placement| populations.is_empty() || populations.contains(&placement.index));
        all
    }

    fn new(planet: &Planet, population: &Population, index: u16) -> Self {
        Self {
            grid: Grid::new(planet, population),
            id: PopulationId::of(&population.name),
            suitability: Suitability::new(planet, population),
            index,
            radius_m: planet.radius_m(),
            seed: planet.seed.rotate_left(16) ^ population.seed,
            soil_level: Soil::level(planet),
        }
    }

    pub(super) fn population(&self) -> &Population {
        &self.suitability.population
    }

    /// Objects on a square metre where everything suits them, groups apart.
    pub(super) fn most_per_m2(&self) -> f64 {
        self.population().per_hectare / super::grid::HECTARE_M2
    }

    /// The node whose soil decides about a cell; None for the large cells of a sparse population.
    pub(super) fn soil_node(&self, cell: NodeId) -> Option<NodeId> {
        let mut node = cell;
        while node.level > self.soil_level {
            node = node.parent()?;
        }
        (node.level == self.soil_level).then_some(node)
    }

    /// Level of the nodes that hold what is left of the cells in them, where that is a sixteenth: that of the cells for
    /// a sparse population.
    pub(super) fn group_level(&self) -> u8 {
        self.grid.level.saturating_sub(GROUP_LEVELS).max(self.soil_level).min(self.grid.level)
    }

    /// Adds the objects of cells that share their soil: those of each cell in the order of its candidates, and last
    /// those that are placed by hand. `soil`: that of [`Placement::soil_node`]. Cells that are placed together take
    /// less time than one by one.
    pub(super) fn place(
        &self,
        terrain: &Terrain,
        cells: &[NodeId],
        soil: Option<&Soil>,
        memory: &mut PlacementScratch,
        placed: &mut Vec<Instance>,
    ) {
        self.place_below(1.0, terrain, cells, soil, memory, placed);
    }

    /// Adds the objects of cells whose rank is below a limit, as [`Placement::place`] does, bit for bit. Objects
    /// above it cost little: the rank of a candidate is known before its ground, and what does not suit it raises
    /// the rank.
    pub(super) fn place_below(
        &self,
        limit: f64,
        terrain: &Terrain,
        cells: &[NodeId],
        soil: Option<&Soil>,
        memory: &mut PlacementScratch,
        placed: &mut Vec<Instance>,
    ) {
        let offer = soil.and_then(|soil| soil.offered(&self.suitability));
        let edits = terrain.life_edits();
        let edits_at = |cell: NodeId| edits.filter(|edits| edits.touches_life(cell, self.id));
        memory.candidates.clear();
        memory.dirs.clear();
        for &cell in cells {
            let edits = edits_at(cell);
            // Without an offer it stands nowhere in the node.
            if soil.is_none() || offer.is_some() || edits.is_some() {
                self.find_likely((cell, limit), soil.map(|_| offer.as_ref()), edits, memory);
            }
        }
        self.thin_out(limit, terrain, memory);
        self.stand(limit, terrain, soil, memory, placed);
        for &cell in cells {
            if let Some(edits) = edits_at(cell) {
                placed.extend(self.placed_by_hand(terrain, edits, cell, memory));
            }
        }
    }

    /// Adds the candidates of a cell that the soil leaves. `limit`: of their ranks among the objects. `offer`: what the
    /// soil offers, if there is soil.
    fn find_likely(
        &self,
        (cell, limit): (NodeId, f64),
        offer: Option<Option<&Offer>>,
        edits: Option<&Arc<Edits>>,
        memory: &mut PlacementScratch,
    ) {
        let PlacementScratch { candidates, planted, dirs, .. } = memory;
        self.find_planted(edits, cell, planted);
        let part = offer.flatten().map(|offer| (offer, offer.part(cell)));
        let likely = self.grid.candidates(cell).enumerate().filter_map(|(number, candidate)| {
            // No share is more than 1.
            if limit < 1.0 && candidate.rank >= limit {
                return None;
            }
            let planting = planted.get(number).copied().unwrap_or(Planting::NONE);
            let (offered, most) = match offer {
                Some(_) => {
                    let offered = part.map_or(0.0, |(offer, part)| offer.at(part, candidate.place));
                    // Water suits at most wholly.
                    (offered, planting.of(offered))
                }
                None => (1.0, 1.0),
            };
            (candidate.rank < most * limit).then_some(Likely { candidate, offered, most, clumping: 1.0, planting })
        });
        let before = candidates.len();
        candidates.extend(likely);
        dirs.extend(candidates[before..].iter().map(|likely| {
            let [u, v] = likely.candidate.place;
            cell.direction(u, v)
        }));
    }

    /// Drops the candidates that stand between groups.
    fn thin_out(&self, limit: f64, terrain: &Terrain, memory: &mut PlacementScratch) {
        let PlacementScratch { candidates, dirs, clumpings, .. } = memory;
        if !self.suitability.has_groups() {
            return;
        }
        clumpings.clear();
        clumpings.resize(dirs.len(), 1.0);
        self.suitability.find_clumpings(terrain.simd(), dirs, (self.radius_m, self.seed), clumpings);
        let mut kept = 0;
        for number in 0..dirs.len() {
            let likely = Likely { clumping: clumpings[number], ..candidates[number] };
            if likely.candidate.rank < likely.most * likely.clumping * limit {
                (candidates[kept], dirs[kept]) = (likely, dirs[number]);
                kept += 1;
            }
        }
        candidates.truncate(kept);
        dirs.truncate(kept);
    }

    /// Adds the objects that stand on the ground at their places. The ground is dear: it is asked for last.
    fn stand(
        &self,
        limit: f64,
        terrain: &Terrain,
        soil: Option<&Soil>,
        memory: &mut PlacementScratch,
        placed: &mut Vec<Instance>,
    ) {
        let PlacementScratch { candidates, dirs, samples, scratch, .. } = memory;
        // Each is written as a whole.
        samples.resize(dirs.len(), Sample::default());
        let (population, asks_bank) = (self.population(), self.population().asks_bank());
        let wanted = match soil {
            Some(soil) => {
                let water = !soil.is_dry || asks_bank;
                Wanted { normal: population.upright < 1.0, water, bank: asks_bank, ..Wanted::HEIGHT }
            }
            None => Wanted { bank: asks_bank, curvature: population.asks_curvature(), ..Wanted::ALL },
        };
        terrain.samples_spaced_into(dirs, 0.0, wanted, samples, scratch);
        placed.extend(candidates.iter().zip(&*dirs).zip(&*samples).filter_map(|((likely, dir), sample)| {
            let Likely { candidate, offered, clumping, planting, .. } = likely;
            let density = match soil {
                Some(_) if self.suitability.is_dry(sample) => {
                    planting.of(offered * self.suitability.by_bank(sample)) * clumping
                }
                Some(_) => 0.0,
                None => offered * clumping * self.suitability.planted(sample, *planting),
            };
            (candidate.rank < density * limit).then(|| self.instance(candidate, *dir, density, sample))
        }));
    }

    /// The objects of a cell that are placed by hand.
    fn placed_by_hand(
        &self,
        terrain: &Terrain,
        edits: &Edits,
        cell: NodeId,
        memory: &mut PlacementScratch,
    ) -> Vec<Instance> {
        let PlacementScratch { dirs, samples, scratch, .. } = memory;
        let mut seen = HashSet::new();
        let placed = edits.placed(cell, (self.id, self.index == 0)).into_iter();
        let placed = placed.map(|placed| (self.grid.placed(cell, placed.dir), placed));
        // Two at one place are one.
        let placed: Vec<(Candidate, Placed)> = placed.filter(|(candidate, _)| seen.insert(candidate.id)).collect();
        dirs.clear();
        dirs.extend(placed.iter().map(|(_, placed)| placed.dir));
        samples.clear();
        samples.resize(dirs.len(), Sample::default());
        terrain.samples_spaced_into(dirs, 0.0, Wanted::HEIGHT.and_normal(), samples, scratch);
        let instance = |((candidate, placed), sample): (&(Candidate, Placed), &Sample)| {
            let size_m = self.population().height_m * placed.size;
            let base_m = sample.height_m - self.population().sunk * size_m;
            Instance { turn_rad: placed.turn_rad, size_m, base_m, ..self.instance(candidate, placed.dir, 1.0, sample) }
        };
        placed.iter().zip(&*samples).map(instance).collect()
    }

    /// Objects that may stand within a distance, and at least as many as cells are looked at: what a search costs.
    pub(super) fn most_within(&self, radius_m: f64) -> f64 {
        // A disc of the sphere has at most the area of a flat one, and never more than the sphere's.
        let area_m2 = (PI * radius_m * radius_m).min(4.0 * PI * self.radius_m * self.radius_m);
        area_m2 * self.most_per_m2().max(1.0 / self.grid.mean_cell_m2())
    }

    /// The key of the edits that change where the population stands in a cell. None if none does.
    pub(super) fn edits_key(&self, terrain: &Terrain, cell: NodeId) -> Option<Key> {
        terrain.life_edits()?.life_key_near(cell, self.id)
    }

    /// What edits make of the share at each candidate of a cell; nothing if none is near any.
    fn find_planted(&self, edits: Option<&Arc<Edits>>, cell: NodeId, planted: &mut Vec<Planting>) {
        planted.clear();
        if let Some(edits) = edits {
            let places = self.grid.candidates(cell).map(|candidate| candidate.place);
            let dirs: Vec<DVec3> = places.map(|[u, v]| cell.direction(u, v)).collect();
            edits.planted(Some(self.id), &dirs, planted);
        }
    }

    fn instance(&self, candidate: &Candidate, up: DVec3, density: f64, sample: &Sample) -> Instance {
        let (population, mut dice) = (self.population(), candidate.dice);
        let turn_rad = TAU * dice.next();
        let scale = 1.0 + population.height_spread * (2.0 * dice.next() - 1.0);
        let brightness = 1.0 + 0.6 * population.color_spread * (2.0 * dice.next() - 1.0);
        let variant = (dice.next() * f64::from(Form::VARIANTS)) as u8;
        let (lean, lean_to) = (population.lean_deg.to_radians() * dice.next(), TAU * dice.next());
        let along = up.lerp(sample.normal_planet, 1.0 - population.upright).normalize_or(up);
        let (east, north) = along.any_orthonormal_pair();
        let ((sin_to, cos_to), (sin, cos)) = (libm::sincos(lean_to), libm::sincos(lean));
        let aside = east * cos_to + north * sin_to;
        let size_m = population.height_m * scale;
        Instance {
            id: candidate.id,
            population: self.index,
            seed: population.seed,
            dir_planet: up,
            ground_m: sample.height_m,
            base_m: sample.height_m - population.sunk * size_m,
            axis_planet: (along * cos + aside * sin).normalize_or(along),
            turn_rad,
            size_m,
            variant,
            brightness,
            rank: candidate.rank / density,
            place: candidate.place,
        }
    }
}
