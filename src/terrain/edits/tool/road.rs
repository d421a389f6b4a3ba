//! Road: a bed along a line, at the heights of its points.

use super::{At, Dual, EditTool, Site};
use crate::planet::edits::Road;
use crate::terrain::edits::{path::Arc, reading::Reads, widening::Widening};

impl EditTool for Road {
    fn change_m(&self, at: &At) -> Dual {
        at.towards(at.read, self.strength)
    }

    fn range(&self, line_m: (f64, f64)) -> Widening {
        Widening::to(line_m.0, line_m.1)
    }

    fn reads(&self, _site: &Site<'_>, _arcs: &[Arc]) -> Reads {
        Reads::Heights
    }

    /// The bed and its sides half-way down.
    fn bare(&self, core: f64) -> Option<f64> {
        Some(0.5 * (1.0 + core))
    }
}
