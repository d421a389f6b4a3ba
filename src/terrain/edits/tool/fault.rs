//! Fault: a step in the ground along a line.

use super::{At, Dual, EditTool, rise};
use crate::planet::edits::Fault;
use crate::terrain::edits::widening::Widening;

impl EditTool for Fault {
    fn change_m(&self, at: &At) -> Dual {
        let left = at.t.rest().at_least(0.0);
        let risen = rise(at.t.times(at.side).over(self.scarp).plus(0.5));
        at.read.times(self.throw_m) * risen.plus(-self.drop) * (left * left)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(self.throw_m.abs(), self.throw_m.abs())
    }

    /// Slip: most in the middle; a closed line slips evenly.
    fn value_of_sides(&self) -> Option<fn([f64; 2], f64) -> f64> {
        Some(|[from, to], _| match from + to {
            length if length == f64::INFINITY => 1.0,
            length => 4.0 * from * to / (length * length).max(1e-30),
        })
    }
}
