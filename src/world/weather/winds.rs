//! The wind of a season: belts that the rotation turns, and monsoons.

use super::Ground;
use crate::planet::{Rotation, Weather as Params};
use crate::sphere::geo::east_north;
use crate::world::noise::ramp;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The wind of a season, and where air rises.
pub(super) struct Season {
    /// Tangent vectors in m/s.
    pub(super) wind_m_s: Vec<DVec3>,
    /// 1 where air rises most (rain), -1 where it sinks most (deserts).
    pub(super) rising: Vec<f64>,
}

/// 1 if the planet rotates to the east, -1 if to the west.
pub(super) fn turn(params: &Params) -> f64 {
    if params.rotation == Rotation::Westward { -1.0 } else { 1.0 }
}

impl Season {
    /// `sign` is 1 in the northern summer and -1 in the southern.
    pub(super) fn new(ground: &Ground<'_>, sign: f64) -> Self {
        let params = ground.inputs.params;
        let cells = ground.cells;
        // Land is warmer than the sea in summer and colder in winter; air flows to where it is warm.
        let warmth: Vec<f64> =
            cells.dirs.iter().zip(&ground.land).map(|(dir, land)| sign * dir.z * land * params.seasons).collect();
        let wind = |cell: usize| {
            let dir = cells.dirs[cell];
            let (east, north) = east_north(dir);
            let (x, side) = belt(params, dir, ground.land[cell], sign);
            let wave = libm::sin(PI * x);
            let zonal = -wave - 0.35 * ramp(0.8, 0.0, x);
            let meridional = -side * wave * 0.45;
            let belts = east * (zonal * turn(params)) + north * meridional;
            // The rotation turns flow to the right north of the equator, and to the left south of it.
            let inflow = ground.slope(&warmth, cell);
            let angle = turn(params) * 1.1 * ramp(0.0, 0.5, dir.z.abs()) * -dir.z.signum();
            let (sin, cos) = libm::sincos(angle);
            let monsoon = (inflow * cos + dir.cross(inflow) * sin) * 0.22;
            let free = belts + monsoon;
            // Wind goes around what it cannot climb.
            let climb = ground.slope(&ground.height_km, cell) * 0.022;
            let steep = climb.length();
            let against = free.dot(climb).max(0.0) / steep.max(1e-9);
            (free - climb * (against / steep.max(1e-9) * (0.35 * steep).min(0.5))) * params.wind_m_s
        };
        let rising = |cell: usize| {
            let (x, _) = belt(params, cells.dirs[cell], ground.land[cell], sign);
            libm::cos(PI * x) + 0.8 * warmth[cell]
        };
        Self {
            wind_m_s: (0..cells.dirs.len()).into_par_iter().map(wind).collect(),
            rising: (0..cells.dirs.len()).into_par_iter().map(rising).collect(),
        }
    }
}

/// The place between the thermal equator (0) and the pole in belts of wind, and the side of the thermal equator.
/// The thermal equator follows the sun, further over land than over the sea.
fn belt(params: &Params, dir: DVec3, land: f64, sign: f64) -> (f64, f64) {
    let latitude = libm::asin(dir.z.clamp(-1.0, 1.0)) * (2.0 / PI);
    // A season is half a year: the sun stands at 0.64 of its greatest latitude in the mean.
    let shift = sign * params.seasons * (0.036 + 0.064 * land);
    let from = latitude - shift * (1.0 - latitude * latitude);
    let x = from.abs() * params.belts;
    (x, if from < 0.0 { -1.0 } else { 1.0 })
}
