//! Mesa: a table mountain with cliffs over talus.

use super::{At, Dual, EditTool, beyond, rise};
use crate::planet::edits::Mesa;
use crate::terrain::edits::widening::Widening;

/// Share of the flank that is cliff.
const CLIFF: f64 = 0.25;

impl EditTool for Mesa {
    fn change_m(&self, at: &At) -> Dual {
        let v = beyond(at.t, at.core);
        let left = v.rest().at_least(0.0);
        let flank = rise(v.over(CLIFF)).rest().times(1.0 - self.talus) + left.times(self.talus) * left;
        flank.times(self.height_m).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(0.0, self.height_m)
    }
}
