//! Random numbers by integer hash: the same on every machine.

use crate::planet::random::dice::{GOLDEN_BITS, mix_bits};
use crate::sphere::NodeId;
use glam::DVec3;

/// A sequence of random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dice(u64);

impl Dice {
    /// The sequence of a cell of a population with a seed.
    pub(super) fn of_cell(seed: u64, cell: NodeId) -> Self {
        let node =
            (u64::from(cell.x) << 32 | u64::from(cell.y)) ^ (cell.face as u64) << 61 ^ u64::from(cell.level) << 56;
        Self(mix_bits(seed ^ mix_bits(node)))
    }

    /// The sequence of a candidate, by its number in its cell.
    pub(super) fn lane(self, lane: u32) -> Self {
        Self(mix_bits(self.0 ^ u64::from(lane)))
    }

    /// The sequence of an object that is placed by hand, by its direction.
    pub(super) fn of_place(seed: u64, dir: DVec3) -> Self {
        let words = dir.to_array().map(f64::to_bits);
        Self(words.into_iter().fold(mix_bits(!seed), |hash, word| mix_bits(hash ^ word)))
    }

    /// The hash itself: the id of the candidate.
    pub(super) fn id(self) -> u64 {
        self.0
    }

    /// The next number, from 0 to below 1, a multiple of 2⁻³².
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(GOLDEN_BITS);
        (mix_bits(self.0) >> 32) as f64 / (1_u64 << 32) as f64
    }
}
