//! Wall: a rampart or dam with a level top along a line.

use super::{At, Dual, EditTool, falloff};
use crate::planet::edits::Wall;
use crate::terrain::edits::widening::Widening;

impl EditTool for Wall {
    fn change_m(&self, at: &At) -> Dual {
        falloff(at.t, self.top).times(self.height_m).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(0.0, self.height_m)
    }

    fn bare(&self, _core: f64) -> Option<f64> {
        Some(self.top)
    }
}
