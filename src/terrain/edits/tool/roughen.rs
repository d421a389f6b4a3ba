//! Roughen: noise of hills and hollows.

use super::{At, Dual, EditTool, Site};
use crate::planet::edits::Roughen;
use crate::terrain::edits::outline::{self, Noise};
use crate::terrain::edits::{path::Arc, reading::Reads, widening::Widening};

/// Difference of the noise from that of the outline.
const SALT: u32 = 0x5C07;

impl EditTool for Roughen {
    fn change_m(&self, at: &At) -> Dual {
        at.read.times(self.amplitude_m) * at.weight()
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        let most_m = self.amplitude_m * outline::MOST;
        Widening::by(most_m, most_m)
    }

    fn reads(&self, site: &Site<'_>, _arcs: &[Arc]) -> Reads {
        Reads::Noise(Noise::new(site.edit.seed ^ SALT, self.wavelength_km * 1000.0 / site.radius_m))
    }
}
