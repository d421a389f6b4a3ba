//! Edits that read the ground around a point, as the edits before them left it.

use super::context::Source;
use super::gullies::{Carved, Gullies};
use super::memory::{Known, LatticeKey, Memory, Node, Nodes};
use super::roster::Roster;
use super::smooth::Lattice;
use super::{Begun, Ground};
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
    /// The lattice at whose nodes it reads heights.
    pub(super) fn lattice(&self) -> &Lattice {
        match self {
            Reader::Smooth(lattice) => lattice,
            Reader::Gullies(gullies) => gullies.lattice(),
        }
    }

    /// Angle within which the ground decides about a point.
    pub(super) fn reach_rad(&self) -> f64 {
        match self {
            Reader::Smooth(lattice) => lattice.reach_rad(),
            Reader::Gullies(gullies) => gullies.reach_rad(),
        }
    }

    /// Reads what an edit needs at some points.
    pub(super) fn read(&self, of: ReadBy<'_>, dirs: impl Iterator<Item = DVec3>, ground: &Ground<'_>) -> Surroundings {
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

/// The edit that reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReadBy<'a> {
    pub(super) slot: u32,
    /// The key of its lattices.
    pub(super) lattice: LatticeKey,
    /// Earlier edits with the same lattice.
    pub(super) sources: &'a [Source],
    pub(super) roster: &'a Roster,
}

/// The heights of the nodes of smooth ground around directions, for an edit.
///
/// What is not known is evaluated from where the latest source knows it, with the edits from that one on. So edits that
/// lie over one another by the hundred cost what each does to its nodes, not the square of it; the heights are the same
/// to the bit.
pub(super) fn heights(
    lattice: &Lattice,
    of: ReadBy<'_>,
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
    let (mut known, mut missing) = memory.heights.recall(of.lattice, nodes);
    // No lock is held: the ground may be read there itself.
    let mut evaluate = |nodes: Vec<Node>, from: Option<&Begun>| {
        let dirs: Vec<DVec3> = nodes.iter().map(|node| lattice.dir(*node)).collect();
        let new: Vec<(Node, f64)> = nodes.into_iter().zip((ground.before)(of.slot, &dirs, from)).collect();
        memory.heights.keep(of.lattice, &new);
        known.extend(new);
    };
    for source in of.sources {
        if missing.is_empty() {
            break;
        }
        let Some(earlier) = of.roster.edit(source.slot) else { continue };
        let (begun, rest) = memory.heights.recall(source.lattice, missing);
        let (begun, strange): (Vec<_>, Vec<_>) =
            begun.into_iter().partition(|(node, _)| earlier.surrounds(lattice.dir(*node)));
        missing = rest;
        missing.extend(strange.into_iter().map(|(node, _)| node));
        if !begun.is_empty() {
            let (nodes, heights_m): (Vec<Node>, Vec<f64>) = begun.into_iter().unzip();
            evaluate(nodes, Some(&Begun { slot: source.slot, heights_m }));
        }
    }
    if !missing.is_empty() {
        evaluate(missing, None);
    }
    known
}
