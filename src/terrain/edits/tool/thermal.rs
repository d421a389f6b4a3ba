//! Thermal erosion: what stands out crumbles, and hollows fill.

use super::{At, Compile, Dual, EditTool, Site};
use crate::planet::edits;
use crate::terrain::edits::reading::{Reader, Reads};
use crate::terrain::edits::{path, smooth::Lattice, widening::Widening};
use std::sync::Arc;

#[derive(Debug)]
struct Thermal {
    size: f64,
    strength: f64,
    /// Height in metres by which forms may stand out.
    most_m: f64,
}

impl Compile for edits::Thermal {
    fn compile(&self, site: &Site<'_>) -> Arc<dyn EditTool> {
        let half_m = 0.5 * self.size * site.edit.radius_km * 1000.0;
        let most_m = half_m * libm::tan(self.talus_deg.to_radians());
        Arc::new(Thermal { size: self.size, strength: self.strength, most_m })
    }
}

impl EditTool for Thermal {
    fn change_m(&self, at: &At) -> Dual {
        let out = (at.ground_m - at.read).over(self.most_m);
        let left = libm::tanh(out.v);
        let left = out.chain(left, 1.0 - left * left);
        at.towards(at.read + left.times(self.most_m), self.strength)
    }

    /// Smooth ground is a mean of the ground around; its bounds are those of a larger place.
    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::default()
    }

    fn reads(&self, site: &Site<'_>, _arcs: &[path::Arc]) -> Reads {
        Reads::Around(Reader::Smooth(Lattice::new(self.size * site.radius_rad())))
    }
}
