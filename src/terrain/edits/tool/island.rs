//! Island: land that rises out of the sea.

use super::{At, Compile, Dual, EditTool, Site, dome, falloff};
use crate::planet::edits;
use crate::terrain::edits::widening::Widening;
use std::sync::Arc;

/// Distance in radii where the shore begins to blend into the sea floor.
const SHORE: f64 = 0.75;
/// Share of the height over which the foot blends into the sea floor.
const FOOT: f64 = 0.05;

#[derive(Debug)]
struct Island {
    sea_m: f64,
    height_m: f64,
    foot_m: f64,
}

impl Compile for edits::Island {
    fn compile(&self, site: &Site<'_>) -> Arc<dyn EditTool> {
        Arc::new(Island { sea_m: site.sea_m, height_m: self.height_m, foot_m: self.foot_m })
    }
}

impl EditTool for Island {
    fn change_m(&self, at: &At) -> Dual {
        let (top_m, foot_m) = (self.sea_m + self.height_m * at.scale, self.sea_m - self.foot_m * at.scale);
        let size_m = top_m - foot_m;
        let over_m = dome(at.t).times(size_m).plus(foot_m) - at.ground_m;
        let soft_m = FOOT * size_m;
        // The greater of the two grounds, with a rounded corner.
        let rise_m = if over_m.v >= soft_m {
            over_m
        } else if over_m.v > -soft_m {
            let sum_m = over_m.plus(soft_m);
            (sum_m * sum_m).over(4.0 * soft_m)
        } else {
            Dual::constant(0.0)
        };
        rise_m * falloff(at.t, SHORE)
    }

    fn range(&self, _line_m: (f64, f64)) -> Widening {
        let Self { sea_m, height_m, foot_m } = *self;
        Widening::to(f64::INFINITY, sea_m + height_m).then(Widening::by(0.0, FOOT * (height_m + foot_m)))
    }
}
