//! Moisture that the wind carries, and the rain that falls from it.
//!
//! Each round gives every cell the moisture of the cells from which its wind comes, less what has rained out on the
//! way. After as many rounds as it takes to cross a continent the moisture is steady.

use super::winds::Season;
use super::{Ground, tangent};
use crate::world::EARTH_KM;
use crate::world::map::KeepGoing;
use crate::world::noise::ramp;
use glam::DVec2;
use rayon::prelude::*;

/// Distance in km over which the air takes up moisture from the sea.
const UPTAKE_KM: f64 = 900.0;

/// Share of the rain on land that evaporates again and goes on with the wind: where air sinks, and what is added where
/// it rises most. Forests near the equator give back most of their rain.
const RECYCLED: [f64; 2] = [0.4, 0.42];

/// Share of the moisture that is lost for each km of climb, as an exponent.
const CLIMB: f64 = 0.75;

/// Rain in mm a year where saturated air of 27 °C loses a thousandth of its moisture a km at the mean wind.
const RAIN_MM: f64 = 8200.0;

/// What a cell does with the air that comes to it.
struct Step {
    /// Share of the air that comes from each neighbour.
    from: [f64; 8],
    km: f64,
    /// Share of what the air lacks that it takes up over the sea.
    taken: f64,
    /// Share of the moisture that rains out.
    lost: f64,
    /// Share of that rain that evaporates again.
    recycled: f64,
    /// Moisture of saturated air here; 1 at 27 °C.
    most: f64,
    speed: f64,
}

/// Moisture of saturated air: it doubles with every 11 °C.
fn saturated(temperature_c: f64) -> f64 {
    libm::exp(0.063 * (temperature_c.clamp(-60.0, 45.0) - 27.0))
}

/// Rain of a season in mm a year. None if `keep_going` said no.
pub(super) fn rain_mm(ground: &Ground<'_>, season: &Season, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
    let count = ground.cells.dirs.len();
    let steps: Vec<Step> = (0..count).into_par_iter().map(|cell| Step::new(ground, season, cell)).collect();
    let mut carried: Vec<f64> =
        steps.iter().zip(&ground.is_sea).map(|(step, sea)| step.most * if *sea { 0.8 } else { 0.25 }).collect();
    let before = |carried: &[f64], cell: usize| {
        let around = ground.cells.around(cell);
        steps[cell].from.iter().zip(around).map(|(share, other)| share * carried[other as usize]).sum::<f64>()
    };
    for _ in 0..ground.cells.side {
        if !keep_going() {
            return None;
        }
        let after = |cell: usize| {
            let (step, from) = (&steps[cell], before(&carried, cell));
            if ground.is_sea[cell] {
                from * (1.0 - 0.4 * step.lost) + (0.85 * step.most - from).max(0.0) * step.taken
            } else {
                (from * (1.0 - step.lost * (1.0 - step.recycled))).min(1.15 * step.most)
            }
        };
        carried = (0..count).into_par_iter().map(after).collect();
    }
    let rain = |cell: usize| {
        let (step, from) = (&steps[cell], before(&carried, cell));
        // What the air cannot hold any more falls too.
        let excess = if ground.is_sea[cell] { 0.0 } else { (from * (1.0 - step.lost) - 1.15 * step.most).max(0.0) };
        let lost = from * step.lost + 0.5 * excess;
        let mm = RAIN_MM * lost * (1000.0 / step.km) * (0.35 + 0.65 * step.speed);
        // The rain of a very steep cell falls on its neighbours too.
        ground.inputs.params.wetness * mm / (1.0 + mm / 9000.0)
    };
    Some((0..count).into_par_iter().map(rain).collect())
}

impl Step {
    fn new(ground: &Ground<'_>, season: &Season, cell: usize) -> Self {
        let params = ground.inputs.params;
        let wind = season.wind_m_s[cell];
        let speed = wind.length() / params.wind_m_s.max(1e-6);
        let (from, away) = upwind(&ground.around[cell], tangent(ground.cells.dirs[cell], wind));
        let km = away * EARTH_KM;
        let others = from.iter().zip(ground.cells.around(cell));
        let climb_km: f64 =
            others.map(|(share, other)| share * (ground.height_km[cell] - ground.height_km[other as usize])).sum();
        // Rising air rains; sinking air, and air that flows downhill, keeps its moisture.
        let lift = ramp(-1.05, 1.1, season.rising[cell]);
        let rising = 0.12 + 1.25 * lift;
        let downhill = libm::exp((1.8 * params.rain_shadow * climb_km).min(0.0));
        let uphill = CLIMB * params.rain_shadow * climb_km.max(0.0) * (0.45 + 0.55 * rising);
        let lost = 1.0 - libm::exp(-(km / params.reach_km * rising * downhill + uphill));
        Self {
            from,
            km,
            taken: 1.0 - libm::exp(-km / UPTAKE_KM),
            lost,
            recycled: RECYCLED[0] + RECYCLED[1] * lift,
            most: saturated(ground.temperature_c[cell]),
            speed: speed.min(2.0),
        }
    }
}

/// The share of the air of a cell that comes from each neighbour, and the mean distance that it comes from.
/// `around`: the neighbours in the tangent plane.
///
/// The mean of the shares lies exactly upwind, however the grid is turned. Otherwise wind would drift towards the lines
/// of the grid, which have a kink at the edges of the cube, and rain would change there.
fn upwind(around: &[DVec2; 8], wind: DVec2) -> ([f64; 8], f64) {
    let ahead = wind / wind.length().max(1e-12);
    let shares = around.map(|way| {
        let along = (-way.dot(ahead) / way.length().max(1e-12)).max(0.0);
        // Some air comes from all around: weather is never as steady as its mean.
        0.012 + along * along * along
    });
    // In a square grid the mean square of the distances to the eight neighbours is 1.5 cells.
    let cell = libm::sqrt(around.iter().map(|way| way.length_squared()).sum::<f64>() / 12.0);
    // Nearer than the nearest neighbours, or some shares would have to be negative.
    let away = 0.9 * cell;
    let mean = ahead * -away;
    // Shares (1 + turn . way) have this mean: two linear equations.
    let (mut sum, mut first, mut squares, mut across) = (0.0, DVec2::ZERO, DVec2::ZERO, 0.0);
    for (way, share) in around.iter().zip(shares) {
        sum += share;
        first += *way * share;
        squares += *way * *way * share;
        across += way.x * way.y * share;
    }
    let right = mean * sum - first;
    let (xx, xy) = (squares.x - mean.x * first.x, across - mean.x * first.y);
    let (yx, yy) = (across - mean.y * first.x, squares.y - mean.y * first.y);
    let scale = xx * yy - xy * yx;
    let turn = DVec2::new(right.x * yy - right.y * xy, right.y * xx - right.x * yx) / scale;
    let mut from = [0.0; 8];
    for ((from, way), share) in from.iter_mut().zip(around).zip(shares) {
        *from = share * (1.0 + turn.dot(*way)).max(0.0);
    }
    let all: f64 = from.iter().sum();
    (from.map(|share| share / all), away)
}
