//! Crater: a bowl with a rim, a central peak and ejecta.

use super::{At, Dual, EditTool, beyond, rise};
use crate::planet::edits::Crater;
use crate::terrain::edits::widening::Widening;

/// Radii to which the ejecta reach.
const EJECTA: f64 = 2.0;
/// Radius of the central peak, in radii of the crater.
const PEAK: f64 = 0.3;

impl EditTool for Crater {
    fn change_m(&self, at: &At) -> Dual {
        let Self { depth_m, rim_m, floor, peak_m } = *self;
        if at.t.v >= 1.0 {
            let left = at.t.chain(EJECTA - at.t.v, -1.0).at_least(0.0);
            return (left.times(rim_m) * left * left).times(at.scale);
        }
        let v = beyond(at.t, floor);
        let bowl_m = (v.times(depth_m + rim_m) * v).plus(-depth_m);
        (bowl_m + rise(at.t.over(PEAK)).rest().times(peak_m)).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(self.depth_m, self.rim_m + self.peak_m)
    }

    fn reach(&self) -> f64 {
        EJECTA
    }
}
