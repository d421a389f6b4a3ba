//! Canyon: a valley with steep walls along a line.

use super::{At, Compile, Dual, EditTool, Site, beyond, rise};
use crate::planet::edits;
use crate::terrain::edits::widening::Widening;
use std::sync::Arc;

#[derive(Debug)]
struct Canyon {
    depth_m: f64,
    floor: f64,
    softness: f64,
}

impl Compile for edits::Canyon {
    fn compile(&self, site: &Site<'_>) -> Arc<dyn EditTool> {
        Arc::new(Canyon { depth_m: self.depth_m, floor: self.floor, softness: site.edit.softness })
    }
}

impl EditTool for Canyon {
    fn change_m(&self, at: &At) -> Dual {
        let v = beyond(at.t, self.floor);
        let wall = rise(v).times(self.softness) + v.times(1.0 - self.softness) * v;
        wall.plus(-1.0).times(self.depth_m).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(self.depth_m, 0.0)
    }
}
