//! Octaves: the same noise finer and weaker, again and again.

use crate::terrain::noise::{self, Octave};

/// An octave and how much it counts; the weights of a series sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weighted {
    pub(super) octave: Octave,
    pub(super) weight: f32,
}

/// A series of octaves: `count` of them, from `frequency` cells to the planet's radius on, each `lacunarity` times
/// finer and `gain` times as strong as the one before.
pub(super) fn series(seed: u64, frequency: f64, count: u32, gain: f64, lacunarity: f64) -> Vec<Weighted> {
    // The lattice must stay within what f64 can split; finer octaves would be below a nanometre.
    let frequencies: Vec<f64> = std::iter::successors(Some(frequency), |f| Some(f * lacunarity))
        .take(count as usize)
        .take_while(|f| *f < 1e14)
        .collect();
    let gains: Vec<f64> = std::iter::successors(Some(1.0), |a| Some(a * gain)).take(frequencies.len()).collect();
    let total: f64 = gains.iter().sum();
    frequencies
        .iter()
        .zip(&gains)
        .enumerate()
        .map(|(i, (&frequency, gain))| {
            let random = |k: u64| noise::mix(noise::mix(seed).wrapping_add(i as u64 * 4 + k));
            let offset = |k: u64| (random(k) >> 40) as f64 / 4096.0;
            let octave = Octave { frequency, offset: [offset(1), offset(2), offset(3)], seed: random(0) as u32 };
            Weighted { octave, weight: (gain / total) as f32 }
        })
        .collect()
}
