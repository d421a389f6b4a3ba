//! Objects of a terrain around a place, for games and exports: the objects that are drawn.

use super::grid::angle;
use super::placement::{Placement, PlacementScratch};
use super::soil::Soils;
use super::solid::ObjectId;
use crate::sphere::{NodeId, geo};
use crate::terrain::Terrain;
use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Cells that are placed at a time: it bounds the memory of their soil.
const PART_CELLS: usize = 4096;

/// Cells of one population and soil that are placed together.
const RUN_CELLS: usize = 16;

/// An object that stands on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Instance {
    /// Id, unique within the population: the same wherever and whenever the object is asked for, while the seeds of the
    /// planet and the population, its density, its clumping and the planet's radius stay.
    pub id: u64,
    /// Index of its population in [`Planet::life`](crate::planet::Planet::life).
    pub population: u16,
    /// Seed of its population.
    pub seed: u32,
    /// Unit vector from the planet's centre through the place.
    pub dir_planet: DVec3,
    /// Height of the ground there above the reference sphere, metres: that of [`Terrain::height_m`], to the bit.
    pub ground_m: f64,
    /// Height of the foot of the form above the reference sphere, metres: it may be sunk into the ground.
    pub base_m: f64,
    /// Unit vector from the foot to the top, in the planet frame.
    pub axis_planet: DVec3,
    /// Turn about the axis, radians, against the clock as seen from the top: at 0 the form's x axis points east.
    pub turn_rad: f64,
    /// Height of the form along its axis, metres.
    pub size_m: f64,
    /// Variant of the form, below [`Form::VARIANTS`](crate::planet::Form::VARIANTS).
    pub variant: u8,
    /// Factor on the population's colours.
    pub brightness: f64,
    /// Rank among the objects of its density, 0 to 1: a coarser level of detail keeps those of low rank, whose
    /// density is as even.
    pub rank: f64,
    /// Place in its cell, 0 to 1.
    pub(crate) place: [f64; 2],
}

impl Instance {
    /// Its name among all objects of the planet.
    pub fn object(&self) -> ObjectId {
        ObjectId { seed: self.seed, id: self.id }
    }

    /// Foot of the form in the planet frame, on a planet of a radius.
    pub fn foot_planet_m(&self, planet_radius_m: f64) -> DVec3 {
        self.dir_planet * (planet_radius_m + self.base_m)
    }

    /// Matrix that turns the form (z up) into the planet frame; its columns are the form's axes.
    pub fn planet_from_form(&self) -> DMat3 {
        let axis = self.axis_planet;
        let (east, _) = geo::east_north(self.dir_planet);
        let x = (east - axis * axis.dot(east)).normalize_or(axis.any_orthonormal_vector());
        let y = axis.cross(x);
        let (sin, cos) = libm::sincos(self.turn_rad);
        DMat3::from_cols(x * cos + y * sin, y * cos - x * sin, axis)
    }

    /// Turns the form (x, y and z up) into the directions east, north and up at its place: the lean and the turn
    /// together, as engines take them. A unit quaternion with `w` at least 0.
    pub fn local_from_form(&self) -> DQuat {
        let up = self.dir_planet;
        let (east, north) = geo::east_north(up);
        let local_from_planet = DMat3::from_cols(east, north, up).transpose();
        let turn = DQuat::from_mat3(&(local_from_planet * self.planet_from_form())).normalize();
        if turn.w < 0.0 { -turn } else { turn }
    }
}

/// A query for more objects than it may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("up to {candidates} objects are there; ask for a smaller part, for at most {most}")]
pub struct TooMany {
    /// Objects that may stand there.
    pub candidates: u64,
    /// Most of one query.
    pub most: u64,
}

impl TooMany {
    /// Refuses a part in which too many objects of populations may stand.
    pub(super) fn check(placements: &[Placement], radius_m: f64) -> Result<(), Self> {
        let candidates = placements.iter().map(|placement| placement.most_within(radius_m)).sum::<f64>() as u64;
        let most = Terrain::MOST_INSTANCES;
        if candidates > most { Err(Self { candidates, most }) } else { Ok(()) }
    }
}

impl Terrain {
    /// Most objects of one query of [`Terrain::instances`]: 1.4 GB of them.
    pub const MOST_INSTANCES: u64 = 10_000_000;

    /// All objects whose place is within `radius_m` of a direction, along the reference sphere; on all cores, in
    /// ascending order of their ids.
    ///
    /// # Errors
    /// [`TooMany`]: the part is so large that more than [`Terrain::MOST_INSTANCES`] may stand there.
    pub fn instances(&self, dir_planet: DVec3, radius_m: f64) -> Result<Vec<Instance>, TooMany> {
        let (dir, planet_m) = (dir_planet.normalize_or(DVec3::Z), self.planet().radius_m());
        let is_within = WithinAngle::new(radius_m / planet_m);
        self.instances_where(dir, radius_m, &[], &|at| is_within.holds(at, dir))
    }

    /// The objects of some populations, or of all if none is named, within `radius_m` of a direction whose place a
    /// filter takes.
    pub(crate) fn instances_where(
        &self,
        dir: DVec3,
        radius_m: f64,
        populations: &[u16],
        takes: &(dyn Fn(DVec3) -> bool + Sync),
    ) -> Result<Vec<Instance>, TooMany> {
        let radius_m = if radius_m > 0.0 { radius_m } else { 0.0 };
        let placements = Placement::of(self.planet(), populations);
        TooMany::check(&placements, radius_m)?;
        let cells = placements.iter().flat_map(|placement| {
            placement.grid.cells_within(dir, radius_m).into_iter().map(move |cell| (placement, cell))
        });
        let mut found: Vec<Instance> = Vec::new();
        self.place_cells(cells.collect(), &|instance| takes(instance.dir_planet), &mut |part| found.extend(part));
        found.sort_by_cached_key(|instance| (instance.id, instance.population));
        Ok(found)
    }

    /// Places the objects of cells, on all cores, and calls with those that a filter takes, part by part.
    pub(super) fn place_cells(
        &self,
        cells: Vec<(&Placement, NodeId)>,
        takes: &(dyn Fn(&Instance) -> bool + Sync),
        each: &mut dyn FnMut(Vec<Instance>),
    ) {
        let with_soil = cells.into_iter().map(|(placement, cell)| (placement.soil_node(cell), placement, cell));
        let mut cells: Vec<(Option<NodeId>, &Placement, NodeId)> = with_soil.collect();
        // Cells of one soil stand together, so that the soil of a part serves no other.
        cells.sort_by_key(|(soil, ..)| *soil);
        for part in cells.chunks(PART_CELLS) {
            let mut soils = Soils::default();
            soils.add(self, part.iter().filter_map(|(soil, ..)| *soil));
            let runs: Vec<_> = part.chunk_by(|a, b| a.0 == b.0 && a.1.index == b.1.index).collect();
            let runs: Vec<_> = runs.into_iter().flat_map(|run| run.chunks(RUN_CELLS)).collect();
            let placed = runs.par_iter().map_init(Placing::default, |Placing { memory, cells }, run| {
                let mut placed = Vec::new();
                if let [(soil, placement, _), ..] = run {
                    cells.clear();
                    cells.extend(run.iter().map(|(.., cell)| *cell));
                    placement.place(self, cells, soils.get(*soil), memory, &mut placed);
                    placed.retain(takes);
                }
                placed
            });
            placed.collect::<Vec<_>>().into_iter().for_each(&mut *each);
        }
    }
}

/// Memory for placing runs of cells.
#[derive(Default)]
struct Placing {
    memory: PlacementScratch,
    cells: Vec<NodeId>,
}

/// Whether two unit vectors are at most an angle apart. Few need the angle itself.
struct WithinAngle {
    most_rad: f64,
    /// Squares of the chords that are certainly within it, and all but certainly beyond.
    chords2: [f64; 2],
}

impl WithinAngle {
    fn new(most_rad: f64) -> Self {
        let chord = 2.0 * libm::sin(0.5 * most_rad.clamp(0.0, PI));
        Self { most_rad, chords2: [1.0 - 1e-9, 1.0 + 1e-9].map(|share| chord * chord * share) }
    }

    fn holds(&self, a: DVec3, b: DVec3) -> bool {
        let chord2 = a.distance_squared(b);
        let [within, beyond] = self.chords2;
        chord2 < within || chord2 <= beyond && angle(a, b) <= self.most_rad
    }
}
