//! The objects of a cell: the candidates that stand, on the ground of the evaluator.

use super::grid::{Candidate, Grid};
use super::query::Instance;
use super::soil::Soil;
use super::suitability::Suitability;
use crate::planet::{Form, Key, Planet, Population};
use crate::sphere::NodeId;
use crate::terrain::edits::{Edits, Placed, Planting, PopulationId};
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use std::collections::HashSet;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

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
struct Likely {
    candidate: Candidate,
    /// Share that the soil offers, the distance from water apart; 1 without soil.
    offered: f64,
    /// Share that groups leave.
    clumping: f64,
    planting: Planting,
}

/// Memory for placing on one thread.
#[derive(Default)]
pub(super) struct PlacementScratch {
    candidates: Vec<Likely>,
    planted: Vec<Planting>,
    dirs: Vec<DVec3>,
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

    /// The objects of a cell, in the order of its candidates. `soil`: that of [`Placement::soil_node`].
    pub(super) fn place(
        &self,
        terrain: &Terrain,
        cell: NodeId,
        soil: Option<&Soil>,
        memory: &mut PlacementScratch,
    ) -> Vec<Instance> {
        let PlacementScratch { candidates, planted, dirs, samples, scratch } = memory;
        let offer = soil.and_then(|soil| soil.offered(&self.suitability));
        let edits = terrain.life_edits().filter(|edits| edits.touches_life(cell, self.id));
        // It stands nowhere in the node.
        if soil.is_some() && offer.is_none() && edits.is_none() {
            return Vec::new();
        }
        self.find_planted(edits, cell, dirs, planted);
        candidates.clear();
        // The ground is dear: it is asked for last.
        candidates.extend(self.grid.candidates(cell).enumerate().filter_map(|(number, candidate)| {
            let planting = planted.get(number).copied().unwrap_or(Planting::NONE);
            let offered = offer.as_ref().map_or(0.0, |offer| offer.at(cell, candidate.place));
            let offered = if soil.is_some() { offered } else { 1.0 };
            // Water suits at most wholly.
            let most = if soil.is_some() { planting.of(offered) } else { 1.0 };
            if candidate.rank >= most {
                return None;
            }
            let clumping = self.suitability.clumping(candidate.dir, self.radius_m, self.seed);
            (candidate.rank < most * clumping).then_some(Likely { candidate, offered, clumping, planting })
        }));
        dirs.clear();
        dirs.extend(candidates.iter().map(|likely| likely.candidate.dir));
        samples.clear();
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
        let placed = candidates.iter().zip(&*samples).filter_map(|(likely, sample)| {
            let Likely { candidate, offered, clumping, planting } = likely;
            let density = match soil {
                Some(_) if self.suitability.is_dry(sample) => {
                    planting.of(offered * self.suitability.by_bank(sample)) * clumping
                }
                Some(_) => 0.0,
                None => offered * clumping * self.suitability.planted(sample, *planting),
            };
            (candidate.rank < density).then(|| self.instance(candidate, density, sample))
        });
        let mut placed: Vec<Instance> = placed.collect();
        if let Some(edits) = edits {
            placed.extend(self.placed_by_hand(terrain, edits, cell, memory));
        }
        placed
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
            Instance { turn_rad: placed.turn_rad, size_m, base_m, ..self.instance(candidate, 1.0, sample) }
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
    fn find_planted(
        &self,
        edits: Option<&Arc<Edits>>,
        cell: NodeId,
        dirs: &mut Vec<DVec3>,
        planted: &mut Vec<Planting>,
    ) {
        planted.clear();
        if let Some(edits) = edits {
            dirs.clear();
            dirs.extend(self.grid.candidates(cell).map(|candidate| candidate.dir));
            edits.planted(Some(self.id), dirs, planted);
        }
    }

    fn instance(&self, candidate: &Candidate, density: f64, sample: &Sample) -> Instance {
        let (population, mut dice) = (self.population(), candidate.dice);
        let turn_rad = TAU * dice.next();
        let scale = 1.0 + population.height_spread * (2.0 * dice.next() - 1.0);
        let brightness = 1.0 + 0.6 * population.color_spread * (2.0 * dice.next() - 1.0);
        let variant = (dice.next() * f64::from(Form::VARIANTS)) as u8;
        let (lean, lean_to) = (population.lean_deg.to_radians() * dice.next(), TAU * dice.next());
        let up = candidate.dir;
        let along = up.lerp(sample.normal_planet, 1.0 - population.upright).normalize_or(up);
        let (east, north) = along.any_orthonormal_pair();
        let aside = east * libm::cos(lean_to) + north * libm::sin(lean_to);
        let size_m = population.height_m * scale;
        Instance {
            id: candidate.id,
            population: self.index,
            seed: population.seed,
            dir_planet: up,
            ground_m: sample.height_m,
            base_m: sample.height_m - population.sunk * size_m,
            axis_planet: (along * libm::cos(lean) + aside * libm::sin(lean)).normalize_or(along),
            turn_rad,
            size_m,
            variant,
            brightness,
            rank: candidate.rank / density,
            place: candidate.place,
        }
    }
}
