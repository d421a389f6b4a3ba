//! Edits that read the ground around a point, as the edits before them left it.

use super::Ground;
use super::gullies::{Carved, Gullies};
use super::memory::{Known, LatticeKey, Memory, Nodes};
use super::smooth::Lattice;
use glam::DVec3;

/// How an edit reads the ground.
#[derive(Clone, Debug)]
pub(super) enum Reader {
    /// Ground without fine detail.
    Smooth(Lattice),
    /// Gullies down the slopes of that ground.
    Gullies(Gullies),
}

/// What was read around some points.
#[derive(Debug)]
pub(super) enum Surroundings {
    Smooth(Known<f64>),
    Gullies(Vec<Known<super::gullies::Cell>>),
}

/// What was read at a point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Read {
    /// The smooth height and its gradient by the direction.
    Smooth(f64, DVec3),
    Carved(Carved),
}

impl Reader {
    /// Angle within which the ground decides about a point.
    pub(super) fn reach_rad(&self) -> f64 {
        match self {
            Reader::Smooth(lattice) => lattice.reach_rad(),
            Reader::Gullies(gullies) => gullies.reach_rad(),
        }
    }

    /// Reads what an edit needs at some points.
    pub(super) fn read(&self, of: ReadBy, dirs: impl Iterator<Item = DVec3>, ground: &Ground<'_>) -> Surroundings {
        match self {
            Reader::Smooth(lattice) => Surroundings::Smooth(heights(lattice, of, dirs, ground)),
            Reader::Gullies(gullies) => Surroundings::Gullies(gullies.read(of, dirs, ground)),
        }
    }

    /// What is at one of those points.
    pub(super) fn at(&self, dir: DVec3, around: &Surroundings) -> Option<Read> {
        match (self, around) {
            (Reader::Smooth(lattice), Surroundings::Smooth(known)) => {
                let (height_m, gradient) = lattice.at(dir, known);
                Some(Read::Smooth(height_m, gradient))
            }
            (Reader::Gullies(gullies), Surroundings::Gullies(known)) => Some(Read::Carved(gullies.at(dir, known))),
            _ => None,
        }
    }
}

/// The edit that reads: its slot, and the key of its lattices.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReadBy {
    pub(super) slot: u32,
    pub(super) lattice: LatticeKey,
}

/// The heights of the nodes of smooth ground around directions, for an edit.
pub(super) fn heights(
    lattice: &Lattice,
    of: ReadBy,
    dirs: impl Iterator<Item = DVec3>,
    ground: &Ground<'_>,
) -> Known<f64> {
    let mut nodes = Nodes::default();
    for dir in dirs {
        lattice.each_node(dir, |node| {
            nodes.insert(node);
        });
    }
    let memory: &Memory = ground.memory;
    let (mut known, missing) = memory.heights.recall(of.lattice, nodes);
    if !missing.is_empty() {
        // No lock is held: the ground may be read there itself.
        let dirs: Vec<DVec3> = missing.iter().map(|node| lattice.dir(*node)).collect();
        let new: Vec<_> = missing.into_iter().zip((ground.before)(of.slot, &dirs)).collect();
        memory.heights.keep(of.lattice, &new);
        known.extend(new);
    }
    known
}
