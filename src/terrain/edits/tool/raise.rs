//! Raise: the ground rises or falls by an amount.

use super::{At, Dual, EditTool};
use crate::planet::edits::Raise;
use crate::terrain::edits::widening::Widening;

impl EditTool for Raise {
    fn change_m(&self, at: &At) -> Dual {
        at.weight().times(self.amount_m).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(-self.amount_m.min(0.0), self.amount_m.max(0.0))
    }
}
