//! Coast: a shore along a line, land on one side and sea on the other.

use super::{At, Compile, Dual, EditTool, Site, rise_of};
use crate::planet::edits;
use crate::terrain::edits::widening::Widening;
use std::sync::Arc;

#[derive(Debug)]
struct Coast {
    sea_m: f64,
    land_m: f64,
    depth_m: f64,
    flip: bool,
}

impl Compile for edits::Coast {
    fn compile(&self, site: &Site<'_>) -> Arc<dyn EditTool> {
        let edits::Coast { land_m, depth_m, flip } = *self;
        Arc::new(Coast { sea_m: site.sea_m, land_m, depth_m, flip })
    }
}

impl EditTool for Coast {
    fn change_m(&self, at: &At) -> Dual {
        let left = at.t.rest().at_least(0.0);
        let size_m = if (at.side > 0.0) != self.flip { self.land_m } else { -self.depth_m };
        let shore_m = (left * left).rest().times(size_m).plus(self.sea_m);
        (shore_m - at.ground_m) * at.weight() * at.read
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::to(self.sea_m - self.depth_m, self.sea_m + self.land_m)
    }

    /// Share of the coast: it begins and ends within a radius.
    fn value_of_sides(&self) -> Option<fn([f64; 2], f64) -> f64> {
        Some(|[from, to], radius_rad| rise_of(from.min(to) / radius_rad).0)
    }
}
