//! Flatten: the ground comes to one height.

use super::{At, Dual, EditTool};
use crate::planet::edits::Flatten;
use crate::terrain::edits::widening::Widening;

impl EditTool for Flatten {
    fn change_m(&self, at: &At) -> Dual {
        at.towards(Dual::constant(self.height_m), self.strength)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::to(self.height_m, self.height_m)
    }
}
