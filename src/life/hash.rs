//! Random numbers by integer hash: the same on every machine.

use crate::sphere::NodeId;

/// A sequence of random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dice(u64);

/// SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014).
fn mix(bits: u64) -> u64 {
    let z = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Dice {
    /// The sequence of a candidate: number `lane` of a cell of a population with a seed.
    pub(super) fn new(seed: u64, cell: NodeId, lane: u32) -> Self {
        let node =
            (u64::from(cell.x) << 32 | u64::from(cell.y)) ^ (cell.face as u64) << 61 ^ u64::from(cell.level) << 56;
        Self(mix(mix(seed ^ mix(node)) ^ u64::from(lane)))
    }

    /// The hash itself: the id of the candidate.
    pub(super) fn id(self) -> u64 {
        self.0
    }

    /// The next number, from 0 to below 1, a multiple of 2⁻³².
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (mix(self.0) >> 32) as f64 / (1_u64 << 32) as f64
    }
}
