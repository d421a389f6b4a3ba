//! Smooth: ground without what is finer than a part of the brush.

use super::{At, Dual, EditTool, Site};
use crate::planet::edits::Smooth;
use crate::terrain::edits::reading::{Reader, Reads};
use crate::terrain::edits::{path::Arc, smooth::Lattice, widening::Widening};

impl EditTool for Smooth {
    fn change_m(&self, at: &At) -> Dual {
        at.towards(at.read, self.strength)
    }

    /// Smooth ground is a mean of the ground around; its bounds are those of a larger place.
    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::default()
    }

    fn reads(&self, site: &Site<'_>, _arcs: &[Arc]) -> Reads {
        Reads::Around(Reader::Smooth(Lattice::new(self.size * site.radius_rad())))
    }
}
