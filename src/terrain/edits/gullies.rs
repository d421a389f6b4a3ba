//! Gullies down the slopes of smooth ground, evaluated at each point by itself, after the gradient-aligned waves of
//! Clay John (2020) and Rune Skovbo Johansen (2025). The landform `gullies` does the same on noise.
//!
//! In each of the jittered cells around a point stands a wave whose crests follow the slope of smooth ground at the
//! middle of the cell. The waves sum to a phasor; the cosine of its phase is the profile across the gullies. They are
//! as deep as that ground is steep, so they end where it is level. Each finer octave follows the ground with the
//! coarser gullies in it, so that gullies branch, and leaves the crests and beds of those free.

use super::memory::{Known, LatticeKey, Memory, Node, Nodes};
use super::outline::seen;
use super::smooth::Lattice;
use crate::planet::edits::Hydraulic;
use crate::world::noise::mix;
use glam::DVec3;
use std::f64::consts::TAU;

/// Most octaves of gullies.
pub(super) const MOST_OCTAVES: usize = 6;
/// Ground is smooth over this many widths of the largest gullies.
const COARSER: f64 = 2.5;
/// Side of a cell, in widths of a gully: wide cells make long gullies.
const CELL: f64 = 1.6;
/// Reach of a wave, in cells.
const REACH: f64 = 0.8;
/// Greatest distance of a wave from the middle of its cell along each axis, in cells. REACH + JITTER <= 1.
const JITTER: f64 = 0.2;
/// The squared phasor below which gullies fade; where all waves agree it is about 0.4.
const FAINT: f64 = 0.02;
/// Weight of gullies in the slope that leads the next octave: less keeps finer gullies straighter.
const BRANCH: f64 = 0.8;
/// Share of an octave that is left on crests and beds of a coarser one.
const ON_CREST: f64 = 0.15;
/// Points for each gully from which a gradient shows it.
const LEAST_POINTS: f64 = 3.0;
/// Width and depth of the gullies of an octave relative to the one before.
const FINER: f64 = 0.5;
const SHALLOWER: f64 = 0.45;
/// Depth of a gully for each width, at which its flanks are as steep as the ground.
const STEEP: f64 = 0.5;

/// The gullies of an edit.
#[derive(Clone, Debug)]
pub(super) struct Gullies {
    lattice: Lattice,
    octaves: Vec<Octave>,
    radius_m: f64,
    /// The tangent of the slope from which gullies become no deeper.
    most_steep: f64,
}

#[derive(Clone, Debug)]
struct Octave {
    /// Distance between gullies, and side of a cell; the unit is the radius of the planet.
    width: f64,
    size: f64,
    /// Depth of gullies on ground with a slope of 1.
    depth_m: f64,
    seed: u64,
}

/// A wave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Its phase by the direction, across the slope.
    phase: DVec3,
    /// Tangent of the slope.
    steep: f64,
}

/// Cells of each octave: those that are known, and those that are not, with their middles.
#[derive(Debug)]
pub(super) struct Waves {
    known: Vec<Known<Cell>>,
    missing: Vec<Vec<(Node, DVec3)>>,
}

/// The gullies of an octave at a point, each value with its gradient by the direction.
struct Profile {
    /// Across gullies from -1 in the bed to 1 on the crest.
    across: (f64, DVec3),
    /// 1 where the waves agree, 0 where they cancel out.
    clear: (f64, DVec3),
    /// Tangent of the slope of the ground.
    steep: (f64, DVec3),
}

/// The gullies at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carved {
    /// What they add to the height: at most a little, and else less than nothing.
    pub(super) height_m: f64,
    /// Distance between gullies and gradient by the direction, for each octave.
    octaves: [(f64, DVec3); MOST_OCTAVES],
}

impl Carved {
    /// The gradient by the direction that points so far apart can show.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        self.octaves.iter().map(|(size, gradient)| *gradient * seen(*size, spacing_rad, LEAST_POINTS)).sum()
    }
}

impl Octave {
    /// Calls `found` with the cells whose waves reach a direction, and with the way from the wave to there.
    fn each_cell(&self, dir: DVec3, mut found: impl FnMut(Node, DVec3)) {
        let most = REACH * self.size * REACH * self.size;
        // Two cubic lattices, each in the middle of the other; odd nodes are those of the second.
        for odd in 0..2 {
            let first = (dir / self.size - 0.5 * odd as f64).floor();
            for corner in 0..8_i64 {
                let at = first.to_array().map(|x| x as i64);
                let node: Node = std::array::from_fn(|axis| 2 * (at[axis] + (corner >> axis & 1)) + odd);
                let away = dir - self.middle(node);
                if away.length_squared() < most {
                    found(node, away);
                }
            }
        }
    }

    /// Where the wave of a cell stands.
    fn middle(&self, node: Node) -> DVec3 {
        let hash = node.iter().fold(self.seed, |hash, x| mix(hash ^ *x as u64));
        let jitter =
            |axis: u32| (f64::from((hash >> (21 * axis)) as u32 & 0x1F_FFFF) / f64::from(0x10_0000) - 1.0) * JITTER;
        DVec3::from_array(std::array::from_fn(|axis| (0.5 * node[axis] as f64 + jitter(axis as u32)) * self.size))
    }

    fn at(&self, dir: DVec3, cells: &Known<Cell>) -> Profile {
        let per_reach2 = 1.0 / (REACH * self.size * REACH * self.size);
        let (mut real, mut imaginary, mut sum, mut steep) = (0.0, 0.0, 1e-9, 0.0);
        let [mut real_by, mut imaginary_by, mut sum_by, mut steep_by] = [DVec3::ZERO; 4];
        self.each_cell(dir, |node, away| {
            let Some(cell) = cells.get(&node) else { return };
            let left = 1.0 - away.length_squared() * per_reach2;
            let (weight, weight_by) = (left * left * left, away * (-6.0 * left * left * per_reach2));
            let (sin, cos) = libm::sincos(away.dot(cell.phase));
            real += weight * cos;
            imaginary += weight * sin;
            sum += weight;
            steep += weight * cell.steep;
            real_by += weight_by * cos - cell.phase * (weight * sin);
            imaginary_by += weight_by * sin + cell.phase * (weight * cos);
            sum_by += weight_by;
            steep_by += weight_by * cell.steep;
        });
        let squared = real * real + imaginary * imaginary;
        let squared_by = (real_by * real + imaginary_by * imaginary) * 2.0;
        let whole = squared + FAINT;
        let root = whole.sqrt();
        let steep = steep / sum;
        Profile {
            across: (real / root, real_by / root - squared_by * (0.5 * real / (whole * root))),
            clear: (squared / whole, squared_by * (FAINT / (whole * whole))),
            steep: (steep, (steep_by - sum_by * steep) / sum),
        }
    }
}

/// The height of the gullies of octaves from the coarsest on, each with its gradient by the direction.
fn carve<'a>(
    octaves: impl Iterator<Item = (&'a Octave, &'a Known<Cell>)>,
    dir: DVec3,
) -> impl Iterator<Item = (f64, DVec3)> {
    // The share of finer octaves, and its gradient.
    let mut free = (1.0, DVec3::ZERO);
    octaves.map(move |(octave, cells)| {
        let Profile { across, clear, steep } = octave.at(dir, cells);
        // Crests keep their height, whether they are clear or not.
        let carved = (0.5 * (across.0 - clear.0), (across.1 - clear.1) * 0.5);
        let deep = (carved.0 * steep.0, carved.1 * steep.0 + steep.1 * carved.0);
        let height = (deep.0 * free.0, deep.1 * free.0 + free.1 * deep.0);
        let flank = 1.0 - (1.0 - ON_CREST) * across.0 * across.0;
        let flank_by = across.1 * (-2.0 * (1.0 - ON_CREST) * across.0);
        free = (free.0 * flank, free.1 * flank + flank_by * free.0);
        (height.0 * octave.depth_m, height.1 * octave.depth_m)
    })
}

/// The cells of an octave, for the edit whose lattices have this key.
pub(super) fn lattice_of(edit: LatticeKey, octave: usize) -> LatticeKey {
    edit.wrapping_add((octave as u128 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15_F39C_C060_5CED_C835))
}

impl Gullies {
    /// The gullies of an edit of this radius.
    pub(super) fn new(edit: &Hydraulic, seed: u32, radius_rad: f64, radius_m: f64) -> Self {
        let width = edit.spacing * radius_rad;
        let octave = |k: usize| {
            let width_here = width * libm::pow(FINER, k as f64);
            let depth_m = STEEP * edit.depth * width * radius_m * libm::pow(SHALLOWER, k as f64);
            let seed = mix(mix(u64::from(seed)).wrapping_add(k as u64));
            Octave { width: width_here, size: CELL * width_here, depth_m, seed }
        };
        Self {
            lattice: Lattice::new(COARSER * width),
            octaves: (0..(edit.octaves as usize).min(MOST_OCTAVES)).map(octave).collect(),
            radius_m,
            most_steep: libm::tan(edit.steepest_deg.to_radians()),
        }
    }

    /// The lattice of the smooth ground that they follow.
    pub(super) fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// How deep gullies are at most.
    pub(super) fn depth_m(&self) -> f64 {
        self.octaves.iter().map(|octave| octave.depth_m * self.most_steep).sum()
    }

    /// Chord within which the ground decides about a point: that around its cells, and around the coarser cells of
    /// those.
    pub(super) fn reach_rad(&self) -> f64 {
        let cells: f64 = self.octaves.iter().map(|octave| octave.size).sum();
        self.lattice.reach_rad() + 1.1 * cells
    }

    /// Adds the cells around a direction, for each octave.
    pub(super) fn ask(&self, dir: DVec3, cells: &mut Vec<Nodes>) {
        cells.resize_with(self.octaves.len(), Nodes::default);
        for (octave, cells) in self.octaves.iter().zip(cells) {
            octave.each_cell(dir, |node, _| {
                cells.insert(node);
            });
        }
    }

    /// What is known of cells that an edit needs. Adds the nodes whose heights the others need.
    pub(super) fn recall(&self, key: LatticeKey, mut cells: Vec<Nodes>, nodes: &mut Nodes, memory: &Memory) -> Waves {
        let count = self.octaves.len();
        cells.resize_with(count, Nodes::default);
        let (mut known, mut missing) = (vec![Known::default(); count], vec![Vec::new(); count]);
        // From the finest on: a new cell needs the coarser cells around it.
        for (k, octave) in self.octaves.iter().enumerate().rev() {
            let (found, lacking) = memory.cells.recall(lattice_of(key, k), std::mem::take(&mut cells[k]));
            known[k] = found;
            missing[k] = lacking.into_iter().map(|node| (node, octave.middle(node).normalize_or(DVec3::Z))).collect();
            for (_, middle) in &missing[k] {
                for (coarser, cells) in self.octaves[..k].iter().zip(&mut cells) {
                    coarser.each_cell(*middle, |node, _| {
                        cells.insert(node);
                    });
                }
                self.lattice.ask(*middle, nodes);
            }
        }
        Waves { known, missing }
    }

    /// The waves of all cells, from the heights of those nodes.
    pub(super) fn finish(
        &self,
        key: LatticeKey,
        Waves { mut known, missing }: Waves,
        heights: &Known<f64>,
        memory: &Memory,
    ) -> Vec<Known<Cell>> {
        for (k, (octave, new)) in self.octaves.iter().zip(missing).enumerate() {
            let cell = |(node, middle): (Node, DVec3)| {
                let coarser = self.octaves[..k].iter().zip(&known);
                let coarser: DVec3 = carve(coarser, middle).map(|(_, gradient)| gradient).sum();
                let slope = self.lattice.at(middle, heights).1;
                let [slope, led] = [slope, slope + coarser * BRANCH].map(|slope| slope - middle * middle.dot(slope));
                let steep = (slope.length() / self.radius_m).min(self.most_steep);
                (node, Cell { phase: middle.cross(led).normalize_or_zero() * (TAU / octave.width), steep })
            };
            let new: Vec<(Node, Cell)> = new.into_iter().map(cell).collect();
            memory.cells.keep(lattice_of(key, k), &new);
            known[k].extend(new);
        }
        known
    }

    /// The gullies at one of those directions.
    pub(super) fn at(&self, dir: DVec3, known: &[Known<Cell>]) -> Carved {
        let mut carved = Carved { height_m: 0.0, octaves: [(1.0, DVec3::ZERO); MOST_OCTAVES] };
        let heights = carve(self.octaves.iter().zip(known), dir);
        for ((octave, (height_m, gradient)), into) in self.octaves.iter().zip(heights).zip(&mut carved.octaves) {
            carved.height_m += height_m;
            *into = (octave.width, gradient);
        }
        carved
    }
}
