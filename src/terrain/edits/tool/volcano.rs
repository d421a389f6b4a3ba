//! Volcano: a cone or a shield with a caldera.

use super::{At, Dual, EditTool, cone, dome};
use crate::planet::edits::Volcano;
use crate::terrain::edits::widening::Widening;

impl EditTool for Volcano {
    fn change_m(&self, at: &At) -> Dual {
        let Self { height_m, steepness, caldera, caldera_m } = *self;
        if at.t.v >= caldera {
            return cone(at.t, steepness).times(height_m).times(at.scale);
        }
        let edge = cone(Dual::constant(caldera), steepness);
        (edge.times(height_m) - dome(at.t.over(caldera)).times(caldera_m)).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(self.caldera_m, self.height_m)
    }
}
