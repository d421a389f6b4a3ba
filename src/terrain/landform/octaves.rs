//! Series of octaves: the same noise, finer and weaker each time.

use crate::planet::Precision;
use crate::terrain::noise::Octave;
use crate::world::noise::mix;

/// Which octaves are evaluated in f64. The rounding of f32 is up to a millimetre in a few kilometres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Arithmetic {
    /// None but those that always were: presets before version 3 keep their bits.
    Classic,
    /// The strongest, so that heights of 8 km are within a millimetre of f64 throughout.
    Fine,
    /// All: the reference for the others.
    #[cfg(test)]
    Full,
}

impl From<Precision> for Arithmetic {
    fn from(precision: Precision) -> Self {
        match precision {
            Precision::Classic => Self::Classic,
            Precision::Millimetre => Self::Fine,
        }
    }
}

impl Arithmetic {
    /// How many octaves to evaluate in f64: in `Fine`, enough that the others weigh no more than `rest`.
    pub(super) fn f64_count(self, weights: impl Iterator<Item = f32> + Clone, rest: f64) -> usize {
        match self {
            Self::Classic => 0,
            Self::Fine => {
                let mut left: f64 = weights.clone().map(f64::from).sum();
                weights.take_while(|weight| (left > rest, left -= f64::from(*weight)).0).count()
            }
            #[cfg(test)]
            Self::Full => weights.count(),
        }
    }

    /// The same for a series.
    pub(super) fn f64_octaves(self, octaves: &[Weighted], rest: f64) -> usize {
        self.f64_count(octaves.iter().map(|octave| octave.weight), rest)
    }
}

/// An octave and its weight; the weights of a series sum to 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weighted {
    pub(super) octave: Octave,
    pub(super) weight: f32,
}

/// A series of `count` octaves, the first with `frequency` cells per planet radius, each `lacunarity` times finer and
/// `gain` times as strong as the one before.
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
            let random = |k: u64| mix(mix(seed).wrapping_add(i as u64 * 4 + k));
            let offset = |k: u64| (random(k) >> 40) as f64 / 4096.0;
            let octave = Octave { frequency, offset: [offset(1), offset(2), offset(3)], seed: random(0) as u32 };
            Weighted { octave, weight: (gain / total) as f32 }
        })
        .collect()
}
