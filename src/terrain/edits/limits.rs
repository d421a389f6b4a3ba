//! Heights to which an edit is limited: land, the sea floor, above or below a level.

use super::index::Hash;
use super::tool::{Change, rise};
use crate::planet::edits::MOST_LIMIT_M;
use crate::planet::{GroundEdit, Limit};

/// Least height over which an edit that is limited to heights begins at its limit.
const LEAST_RAMP_M: f64 = 1.0;

/// Heights at which an edit ends, and whether it acts above each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits([Option<(f64, bool)>; 3]);

impl Limits {
    /// Those of an edit on a planet with a sea at this level.
    pub(super) fn new(edit: &GroundEdit, sea_m: Option<f64>) -> Self {
        let sea_limit = match edit.limit {
            Limit::Everywhere => None,
            Limit::AboveSea => Some((sea_m.unwrap_or(0.0), true)),
            Limit::BelowSea => Some((sea_m.unwrap_or(0.0), false)),
        };
        Self([
            sea_limit,
            (edit.above_m > -MOST_LIMIT_M).then_some((edit.above_m, true)),
            (edit.below_m < MOST_LIMIT_M).then_some((edit.below_m, false)),
        ])
    }

    pub(super) fn hash(&self, hash: &mut Hash) {
        for limit in self.0 {
            let (level_m, above) = limit.unwrap_or((f64::MAX, true));
            hash.add_f64(level_m);
            hash.add(u64::from(above));
        }
    }

    /// What they leave of a change of ground at a height.
    pub(super) fn applied(&self, change: Change, ground_m: f64) -> Change {
        let limits = self.0.into_iter().flatten();
        limits.fold(change, |change, (level_m, above)| limited(change, ground_m, level_m, above))
    }
}

/// A change of the ground above or below a level alone. It begins at the level, over as much height as it changes, so
/// that no coast becomes a cliff.
fn limited(change: Change, ground_m: f64, level_m: f64, above: bool) -> Change {
    let over_m = if above { ground_m - level_m } else { level_m - ground_m };
    if over_m <= 0.0 {
        return Change::default();
    }
    let size_m = change.change_m.abs();
    let ramp_m = size_m.max(LEAST_RAMP_M);
    let (share, by_share) = rise(over_m / ramp_m);
    let sign = if above { 1.0 } else { -1.0 };
    // The ramp grows with the change.
    let grows = if size_m > LEAST_RAMP_M { change.change_m.signum() } else { 0.0 };
    let by_ramp = -change.change_m * by_share * over_m / (ramp_m * ramp_m) * grows;
    let by_change = share + by_ramp;
    Change {
        change_m: change.change_m * share,
        by_ground: change.by_ground * by_change + change.change_m * by_share * sign / ramp_m,
        by_t: change.by_t * by_change,
        by_noise: change.by_noise * by_change,
        by_line: change.by_line * by_change,
        by_strength: change.by_strength * by_change,
    }
}
