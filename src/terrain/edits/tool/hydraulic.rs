//! Hydraulic erosion: gullies down the slopes.

use super::{At, Compile, Dual, EditTool, Site};
use crate::planet::edits::Hydraulic;
use crate::terrain::edits::reading::{Reader, Reads};
use crate::terrain::edits::{gullies::Gullies, path, widening::Widening};
use std::sync::Arc;

impl Compile for Hydraulic {
    fn compile(&self, site: &Site<'_>) -> Arc<dyn EditTool> {
        Arc::new(Gullies::new(self, site.edit.seed, site.radius_rad(), site.radius_m))
    }
}

impl EditTool for Gullies {
    fn change_m(&self, at: &At) -> Dual {
        (at.read * at.weight()).times(at.scale)
    }

    /// Crests that are not clear rise by an eighth at most.
    fn range(&self, _line_m: (f64, f64)) -> Widening {
        let depth_m = self.depth_m();
        Widening::by(depth_m, 0.125 * depth_m)
    }

    fn reads(&self, _site: &Site<'_>, _arcs: &[path::Arc]) -> Reads {
        Reads::Around(Reader::Gullies(self.clone()))
    }
}
