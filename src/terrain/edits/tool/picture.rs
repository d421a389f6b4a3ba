//! Picture: the ground of a height picture.

use super::{At, Dual, EditTool, Site};
use crate::planet::Key;
use crate::planet::edits::PictureStamp;
use crate::planet::picture::PictureExtent;
use crate::terrain::edits::{path::Arc, reading::Reads, stamp::Stamp, widening::Widening};

impl EditTool for PictureStamp {
    fn change_m(&self, at: &At) -> Dual {
        (at.read.times(self.height_m) * at.weight()).times(at.scale)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        let Some(picture) = self.file.picture(PictureExtent::Place) else { return Widening::default() };
        let (lo, hi) = picture.bounds();
        // The weights of a spline sum to 1 up to rounding.
        let rounding = 1e-9 * (1.0 + lo.abs().max(hi.abs()));
        let (lo, hi) = ((lo - self.level).min(0.0) - rounding, (hi - self.level).max(0.0) + rounding);
        let (a, b) = (self.height_m * lo, self.height_m * hi);
        Widening::by(-a.min(b), a.max(b))
    }

    /// The pixels count, and not where their file is.
    fn key(&self) -> Key {
        Key::of(&("Picture", self.height_m, self.level, self.file.picture(PictureExtent::Place)))
    }

    fn reads(&self, _site: &Site<'_>, arcs: &[Arc]) -> Reads {
        Reads::Picture(Stamp::new(self, arcs))
    }
}
