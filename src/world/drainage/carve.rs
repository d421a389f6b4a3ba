//! Heights of river beds after a finite age of uplift and stream-power erosion, in closed form.
//!
//! After Tzathas et al. 2024 (Computer Graphics Forum 43): along a way from its outlet, `response` is the time in
//! which erosion runs up from the outlet, and `raised` the height of a steady bed. Where the response is shorter than
//! the age, the bed is steady. Elsewhere it is the bed as it was at the start, at the point from which erosion has
//! run up since, plus what has been raised between. The exponent of the drainage area is 1/2, so that a planet's size
//! drops out, and a square root is all it takes.
//!
//! Rivers lay down what they carry where the bed would be flatter than a slope that falls with the discharge
//! (Pelletier 2021); ground never stands steeper than the talus.

use super::route::{Jumps, Routes};
use super::{DISCHARGE_UNIT, Level, YEAR_S};
use crate::planet::Rivers as Params;
use crate::world::EARTH_KM;
use rayon::prelude::*;
use std::ops::Range;

/// Erodibility of the mean rock of the Earth, for the exponent 1/2 and a runoff of [`MEAN_RUNOFF_M`], a year.
const ERODIBILITY: f64 = 7.5e-7;

/// The mean runoff of the Earth's land in metres a year.
const MEAN_RUNOFF_M: f64 = 0.35;

/// Area that wears a cell besides its discharge, as a share of the cell.
const HILLSLOPE: f64 = 0.2;

/// Slope of the bed that a river of 1 m³/s lays down.
const ALLUVIAL_SLOPE: f64 = 5e-4;

/// The Earth's radius in metres.
const EARTH_M: f64 = 1000.0 * EARTH_KM;

/// Discharge in m³/s on a planet of the Earth's size.
pub(super) fn earthly_m3_s(units: u64) -> f64 {
    units as f64 * (DISCHARGE_UNIT * EARTH_M * EARTH_M / YEAR_S)
}

/// How slowly rock is carved. `softness`: the logarithm of how easily, against the planet's mean.
pub(super) fn slowness(params: &Params, softness: f64) -> f64 {
    1.0 / (ERODIBILITY * params.erodibility * libm::exp(softness))
}

/// The way down from a cell.
#[derive(Clone, Copy)]
struct Way {
    /// Years in which erosion runs up from the outlet.
    response: f64,
    raised_m: f64,
    /// The ground at the start without pits; the outlet, and how far it rises itself, as the bottom of a closed basin
    /// does.
    start_m: f64,
    outlet_m: f64,
    rise_m: f64,
}

/// Heights of the beds along the routes, by position.
pub(super) fn beds_m(level: &Level<'_>, routes: &Routes, discharge: &[u64]) -> Vec<f64> {
    routes.groups.par_iter().map(|group| group_m(level, routes, discharge, group)).collect::<Vec<_>>().concat()
}

/// Heights of the beds of a group of basins.
fn group_m(level: &Level<'_>, routes: &Routes, discharge: &[u64], group: &Range<usize>) -> Vec<f64> {
    let params = level.params;
    let age_yr = params.age_myr * 1e6;
    let (order, discharge) = (&routes.order[group.clone()], &discharge[group.clone()]);
    let step_rad = &routes.step_rad[group.clone()];
    let below: Vec<u32> = routes.below[group.clone()].iter().map(|to| to - group.start as u32).collect();
    // Where a way ends in the sea.
    let mouth = |cell: usize| Way {
        response: 0.0,
        raised_m: 0.0,
        start_m: level.start_m[routes.receiver[cell] as usize],
        outlet_m: level.base_m,
        rise_m: 0.0,
    };
    let is_sink = |cell: usize| routes.receiver[cell] as usize == cell;
    let mut ways: Vec<Way> = Vec::with_capacity(order.len());
    for (at, &cell) in order.iter().enumerate() {
        let (cell, to) = (cell as usize, below[at] as usize);
        if is_sink(cell) {
            let (outlet_m, rise_m) = (level.sink_m(cell), level.uplift_m[cell]);
            ways.push(Way { response: 0.0, raised_m: 0.0, start_m: outlet_m - rise_m, outlet_m, rise_m });
            continue;
        }
        let way = if to == at { mouth(cell) } else { ways[to] };
        // Slopes wear where it is dry too: the term for hillslopes of the paper.
        let area = discharge[at] as f64 * (DISCHARGE_UNIT / MEAN_RUNOFF_M) + HILLSLOPE * level.areas_sr[cell];
        let years = step_rad[at] * level.slowness[cell] / area.sqrt();
        ways.push(Way {
            response: way.response + years,
            raised_m: way.raised_m + (level.uplift_m[cell] - way.rise_m) * (years / age_yr),
            start_m: f64::max(level.start_m[cell], way.start_m),
            ..way
        });
    }
    let jumps = Jumps::new(&below);
    let talus = libm::tan(params.talus_deg.to_radians()) * level.radius_km * 1000.0;
    let mut beds_m: Vec<f64> = Vec::with_capacity(order.len());
    for (at, &cell) in order.iter().enumerate() {
        let (cell, to, way) = (cell as usize, below[at] as usize, ways[at]);
        let mut bed_m = way.outlet_m + way.raised_m;
        if way.response > age_yr {
            let limit = way.response - age_yr;
            let (last, next) = jumps.search(&below, |at| ways[at].response, limit, at);
            let upper = ways[last];
            let lower = if next == last { mouth(order[last] as usize) } else { ways[next] };
            let share = (limit - lower.response) / (upper.response - lower.response).max(1e-9);
            let start_m = lower.start_m + (upper.start_m - lower.start_m) * share;
            let raised_m = lower.raised_m + (upper.raised_m - lower.raised_m) * share;
            bed_m = start_m + way.rise_m + way.raised_m - raised_m;
        }
        if !is_sink(cell) {
            let below_m = if to == at { level.base_m } else { beds_m[to] };
            // The power -3/8 of the discharge, by square roots.
            let root = earthly_m3_s(discharge[at]).max(0.5).sqrt().sqrt();
            let laid = params.deposition * ALLUVIAL_SLOPE / (root * root.sqrt()) * EARTH_M;
            let steepest_m = below_m + step_rad[at] * talus;
            // No river lays down more than a little above the rock as it was.
            let laid_m = f64::min(below_m + step_rad[at] * laid, level.surface_m(cell) + 20.0);
            bed_m = f64::max(bed_m, laid_m).min(steepest_m).max(below_m + 0.01);
        }
        beds_m.push(bed_m);
    }
    beds_m
}
