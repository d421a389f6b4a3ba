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
use super::{DISCHARGE_UNIT, Level};
use rayon::prelude::*;

/// Erodibility of the mean rock of the Earth, for the exponent 1/2 and a runoff of [`MEAN_RUNOFF_M`], a year.
const ERODIBILITY: f64 = 7.5e-7;

/// The mean runoff of the Earth's land in metres a year.
const MEAN_RUNOFF_M: f64 = 0.35;

/// Area that wears a cell besides its discharge, as a share of the cell.
const HILLSLOPE: f64 = 0.2;

/// Slope of the bed that a river of 1 m³/s lays down.
const ALLUVIAL_SLOPE: f64 = 5e-4;

/// The Earth's radius in metres, and seconds in a year.
const EARTH_M: f64 = 6.371e6;
const YEAR_S: f64 = 3.156e7;

/// Discharge in m³/s on a planet of the Earth's size.
pub(super) fn earthly_m3_s(units: u64) -> f64 {
    units as f64 * (DISCHARGE_UNIT * EARTH_M * EARTH_M / YEAR_S)
}

/// Heights of the beds along the routes.
pub(super) fn beds_m(level: &Level<'_>, routes: &Routes, discharge: &[u64]) -> Vec<f64> {
    let params = level.params;
    let age_yr = params.age_myr * 1e6;
    let receiver = &routes.receiver;
    // Years in which erosion runs over the step below each cell.
    let years = |cell: usize| {
        let rock = libm::exp(params.rock_variation * level.softness[cell]);
        // Slopes wear where it is dry too: the term for hillslopes of the paper.
        let area = discharge[cell] as f64 * (DISCHARGE_UNIT / MEAN_RUNOFF_M) + HILLSLOPE * level.areas_sr[cell];
        routes.step_rad[cell] / (ERODIBILITY * params.erodibility * rock * area.sqrt())
    };
    let years: Vec<f64> =
        (0..receiver.len()).into_par_iter().map(|c| if level.is_sea[c] { 0.0 } else { years(c) }).collect();
    let mut response = vec![0.0; receiver.len()];
    let mut raised = vec![0.0; receiver.len()];
    // The ground at the start without pits; the outlet of each cell, and how far it rises itself, as the bottom of a
    // closed basin does.
    let mut start_m = level.start_m.clone();
    let mut outlet_m = vec![level.base_m; receiver.len()];
    let mut rise_m = vec![0.0; receiver.len()];
    for &cell in &routes.order {
        let (cell, to) = (cell as usize, receiver[cell as usize] as usize);
        if to == cell {
            outlet_m[cell] = level.sink_m(cell);
            rise_m[cell] = level.uplift_m[cell];
            start_m[cell] = outlet_m[cell] - rise_m[cell];
            continue;
        }
        response[cell] = response[to] + years[cell];
        rise_m[cell] = rise_m[to];
        raised[cell] = raised[to] + (level.uplift_m[cell] - rise_m[cell]) * (years[cell] / age_yr);
        start_m[cell] = f64::max(start_m[cell], start_m[to]);
        outlet_m[cell] = outlet_m[to];
    }
    let jumps = Jumps::new(routes);
    let free = |cell: usize| {
        if response[cell] <= age_yr {
            return outlet_m[cell] + raised[cell];
        }
        let limit = response[cell] - age_yr;
        let (above, below) = jumps.search(receiver, &response, limit, cell as u32);
        let (above, below) = (above as usize, below as usize);
        let share = (limit - response[below]) / (response[above] - response[below]).max(1e-9);
        let between = |values: &[f64]| values[below] + (values[above] - values[below]) * share;
        between(&start_m) + rise_m[cell] + raised[cell] - between(&raised)
    };
    let mut beds_m: Vec<f64> =
        (0..receiver.len()).into_par_iter().map(|c| if level.is_sea[c] { level.base_m } else { free(c) }).collect();
    let talus = libm::tan(params.talus_deg.to_radians()) * level.radius_km * 1000.0;
    for &cell in &routes.order {
        let (cell, to) = (cell as usize, receiver[cell as usize] as usize);
        if to == cell {
            continue;
        }
        let step = routes.step_rad[cell];
        // The power -3/8 of the discharge, by square roots.
        let root = earthly_m3_s(discharge[cell]).max(0.5).sqrt().sqrt();
        let laid = params.deposition * ALLUVIAL_SLOPE / (root * root.sqrt()) * EARTH_M;
        let steepest_m = beds_m[to] + step * talus;
        // No river lays down more than a little above the rock as it was.
        let laid_m = f64::min(beds_m[to] + step * laid, level.surface_m(cell) + 20.0);
        beds_m[cell] = f64::max(beds_m[cell], laid_m).min(steepest_m).max(beds_m[to] + 0.01);
    }
    beds_m
}
