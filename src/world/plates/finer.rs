//! The crust as rivers read it, and on finer grids than those on which it is solved.

use super::{Crust, Layout};
use crate::world::cells::Cells;
use crate::world::grid::refined;
use crate::world::noise::{fbm, hash, ramp};
use rayon::prelude::*;

/// What rivers read of the crust, at the cells of a grid.
#[derive(Clone)]
pub(crate) struct Rock {
    pub(crate) side: usize,
    /// See [`Crust::base_m`].
    pub(crate) base_m: Vec<f64>,
    /// See [`Crust::uplift_m`].
    pub(crate) uplift_m: Vec<f64>,
    /// See [`Crust::softness`].
    pub(crate) softness: Vec<f64>,
}

impl Rock {
    pub(super) fn new(side: usize, crust: &[Crust]) -> Self {
        let each = |value: fn(&Crust) -> f64| crust.iter().map(value).collect();
        Self {
            side,
            base_m: each(|crust| crust.base_m),
            uplift_m: each(|crust| crust.uplift_m),
            softness: each(|crust| crust.softness),
        }
    }

    /// The crust on the grid of twice the side: detail is added that the coarser grid could not hold.
    pub(crate) fn finer(&self, layout: &Layout) -> Self {
        let (coarse, side) = (Cells::of(self.side), 2 * self.side);
        let fine = Cells::of(side);
        let frequency = 0.22 * side as f64;
        let detail: Vec<f64> =
            fine.dirs.par_iter().map(|dir| fbm(*dir, frequency, 2, 0.6, hash(layout.seed, 41 + side as u32))).collect();
        let amplitude = 128.0 / side as f64;
        let mut base_m = refined(&coarse, &self.base_m);
        let mut uplift_m = refined(&coarse, &self.uplift_m);
        let softness = refined(&coarse, &self.softness);
        for (cell, detail) in detail.iter().enumerate() {
            // Most where a little height moves the coast.
            let shallow = ramp(-900.0, -100.0, base_m[cell]);
            base_m[cell] += detail * amplitude * (60.0 + 130.0 * shallow);
            uplift_m[cell] *= (1.0 + 0.5 * amplitude * detail).max(0.2);
        }
        Self { side, base_m, uplift_m, softness }
    }
}
