//! The crust as rivers read it, and on finer grids than those on which it is solved.

use super::{Crust, Layout};
use crate::sphere::raster::Raster;
use crate::world::cells::Cells;
use crate::world::noise::{fbm_row, fbm3_row, hash, ramp};
use glam::DVec3;
use rayon::prelude::*;

/// How far detail moves places sideways, in cells of the coarser grid.
const ASIDE: f64 = 0.6;

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

    /// Height of the ground halfway through its rise, if no river had carved it.
    pub(crate) fn risen_m(&self) -> Vec<f64> {
        self.base_m.iter().zip(&self.uplift_m).map(|(base_m, uplift_m)| base_m + 0.5 * uplift_m).collect()
    }

    /// The crust on the grid of twice the side. Detail is added that the coarser grid could not hold: places are moved
    /// sideways, which makes steep coasts as ragged as flat ones, and heights up and down.
    pub(crate) fn finer(&self, layout: &Layout) -> Self {
        let side = 2 * self.side;
        let fine = Cells::of(side);
        let seed = hash(layout.seed, 41 + side as u32);
        let frequency = 0.22 * side as f64;
        let rasters = [&self.base_m, &self.uplift_m, &self.softness]
            .map(|values| Raster::cube(self.side, values.iter().map(|value| *value as f32).collect()));
        let aside_rad = ASIDE * 2.0 / self.side as f64;
        let rows = fine.dirs.par_chunks(side).map(|row| {
            let shifts = fbm3_row(row, frequency, 2, 0.6, hash(seed, 1));
            let moved = |(dir, shift): (&DVec3, DVec3)| {
                let place = rasters[0].place((*dir + shift * aside_rad).normalize());
                rasters.each_ref().map(|raster| raster.value(&place, 0))
            };
            let values: Vec<[f64; 3]> = row.iter().zip(shifts).map(moved).collect();
            (values, fbm_row(row, frequency, 2, 0.6, seed))
        });
        let rows: Vec<(Vec<[f64; 3]>, Vec<f64>)> = rows.collect();
        let detail = rows.iter().flat_map(|(_, detail)| detail);
        let value =
            |k: usize| rows.iter().flat_map(move |(values, _)| values.iter().map(move |value| value[k])).collect();
        let [mut base_m, mut uplift_m, softness]: [Vec<f64>; 3] = [0, 1, 2].map(value);
        let amplitude = 128.0 / side as f64;
        for (cell, detail) in detail.enumerate() {
            // Most where a little height moves the coast.
            let shallow = ramp(-900.0, -100.0, base_m[cell]);
            base_m[cell] += detail * amplitude * (60.0 + 130.0 * shallow);
            uplift_m[cell] *= (1.0 + 0.5 * amplitude * detail).max(0.2);
        }
        Self { side, base_m, uplift_m, softness }
    }
}
