//! Ridge: a crest along a line.

use super::{At, Compile, Dual, EditTool, Site, cone};
use crate::planet::edits;
use crate::terrain::edits::widening::Widening;
use std::sync::Arc;

#[derive(Debug)]
struct Ridge {
    height_m: f64,
    softness: f64,
}

impl Compile for edits::Ridge {
    fn compile(&self, site: &Site<'_>) -> Arc<dyn EditTool> {
        Arc::new(Ridge { height_m: self.height_m, softness: site.edit.softness })
    }
}

impl EditTool for Ridge {
    fn change_m(&self, at: &At) -> Dual {
        cone(at.t, 1.0 - self.softness).times(self.height_m).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        Widening::by(0.0, self.height_m)
    }
}
