//! Heights to which an edit is limited: land, the sea floor, above or below a level.

use super::index::Hash;
use super::tool::{Dual, rise};
use crate::planet::edits::MOST_LIMIT_M;
use crate::planet::{GroundEdit, Limit};

/// Least height over which an edit that is limited to heights begins at its limit.
const LEAST_RAMP_M: f64 = 1.0;

/// Heights at which an edit ends, and whether it acts above each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits([Option<(f64, bool)>; 3]);

impl Limits {
    /// Limits of an edit, on a planet with a sea at this height in metres; 0 without a sea.
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

    /// The part of a change in metres that they leave, of ground at a height.
    pub(super) fn applied(&self, change_m: Dual, ground_m: Dual) -> Dual {
        let limits = self.0.into_iter().flatten();
        limits.fold(change_m, |change_m, (level_m, above)| limited(change_m, ground_m, level_m, above))
    }
}

/// A change of the ground above or below a level alone. It begins at the level, over as much height as it changes, so
/// that no coast becomes a cliff.
fn limited(change_m: Dual, ground_m: Dual, level_m: f64, above: bool) -> Dual {
    let over_m = if above { ground_m.plus(-level_m) } else { (-ground_m).plus(level_m) };
    if over_m.v <= 0.0 {
        return Dual::constant(0.0);
    }
    let size_m = if change_m.v < 0.0 { -change_m } else { change_m };
    change_m * rise(over_m / size_m.at_least(LEAST_RAMP_M))
}
