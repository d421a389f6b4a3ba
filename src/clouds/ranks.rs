//! The distribution of a noise: the rank of a value is the share of the globe where the noise is lower.

/// Intervals of equal shares.
const INTERVALS: usize = 32;
/// The share of the first and of the last sample is not known better than this.
const LEAST: f32 = 0.002;

/// Values at evenly spaced ranks.
#[derive(Clone, Debug)]
pub(super) struct Ranks([f32; INTERVALS + 1]);

impl Ranks {
    /// The distribution of samples of equal areas.
    pub(super) fn of(samples: &mut [f32]) -> Self {
        samples.sort_by(f32::total_cmp);
        let last = samples.len().saturating_sub(1);
        Self(std::array::from_fn(|i| samples.get(i * last / INTERVALS).copied().unwrap_or(i as f32)))
    }

    /// The rank of a value, above 0 and below 1.
    pub(super) fn rank(&self, value: f32) -> f32 {
        let next = self.0.partition_point(|knot| *knot <= value).clamp(1, INTERVALS);
        let (low, high) = (self.0[next - 1], self.0[next]);
        let share = if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        (((next - 1) as f32 + share) / INTERVALS as f32).clamp(LEAST, 1.0 - LEAST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_even() {
        let mut samples: Vec<f32> = (0..4001).map(|i| (i as f32 / 4000.0).powi(3) * 7.0 - 2.0).collect();
        let ranks = Ranks::of(&mut samples);
        for (i, value) in samples.iter().enumerate().step_by(97) {
            let rank = i as f32 / 4000.0;
            assert!((ranks.rank(*value) - rank).abs() < 0.012, "{value}: {} {rank}", ranks.rank(*value));
        }
        assert!(ranks.rank(-9.0) > 0.0 && ranks.rank(9.0) < 1.0);
    }
}
