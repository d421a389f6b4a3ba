//! Terrace: level steps.

use super::{At, Dual, EditTool, rise};
use crate::planet::edits::Terrace;
use crate::terrain::edits::widening::Widening;

impl EditTool for Terrace {
    fn change_m(&self, at: &At) -> Dual {
        // Share of a step that rises.
        let riser = 1.0 - 0.9 * self.sharpness;
        let place = at.ground_m.over(self.step_m);
        let whole = place.v.floor();
        let risen = rise(place.plus(-whole).plus(-0.5).over(riser).plus(0.5));
        at.towards(risen.plus(whole).times(self.step_m), self.strength)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(self.step_m, self.step_m)
    }
}
