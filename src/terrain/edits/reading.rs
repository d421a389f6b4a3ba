//! Edits that read the ground around a point, as the edits before them left it.

use super::Ground;
use super::gullies::{Carved, Gullies};
use super::memory::{Known, Memory, Nodes};
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

    /// Reads what the edit in a slot needs at some points.
    pub(super) fn read(&self, slot: u32, dirs: impl Iterator<Item = DVec3>, ground: &Ground<'_>) -> Surroundings {
        match self {
            Reader::Smooth(lattice) => Surroundings::Smooth(heights(lattice, slot, dirs, ground)),
            Reader::Gullies(gullies) => Surroundings::Gullies(gullies.read(slot, dirs, ground)),
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

/// The heights of the nodes of smooth ground around directions, for the edit in a slot.
pub(super) fn heights(
    lattice: &Lattice,
    slot: u32,
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
    let (mut known, missing) = memory.heights.recall(slot, nodes);
    if !missing.is_empty() {
        // No lock is held: the ground may be read there itself.
        let dirs: Vec<DVec3> = missing.iter().map(|node| lattice.dir(*node)).collect();
        let new: Vec<_> = missing.into_iter().zip((ground.before)(slot, &dirs)).collect();
        memory.heights.keep(slot, &new);
        known.extend(new);
    }
    known
}
