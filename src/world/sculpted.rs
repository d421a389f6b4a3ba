//! What ground edits change of a structure: rock that rises, hard rock, rain, and the courses of rivers.

use super::cells::Cells;
use super::map::Job;
use super::noise::{fbm, hash};
use super::plates::Rock;
use glam::DVec3;
use rayon::prelude::*;

/// Paint of the structure at the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sculpted {
    /// Height in metres by which rock rises further; below 0 it sinks.
    pub(crate) uplift_m: Vec<f64>,
    /// What is taken from the logarithm of how easily rock is carved.
    pub(crate) hardness: Vec<f64>,
    /// Rain and snow that are added, in mm a year.
    pub(crate) rain_mm: Vec<f64>,
}

impl Sculpted {
    /// No paint.
    pub(crate) fn none(cells: usize) -> Self {
        Self { uplift_m: vec![0.0; cells], hardness: vec![0.0; cells], rain_mm: vec![0.0; cells] }
    }
}

/// A river whose course is drawn by hand.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawnCourse {
    /// Unit directions from the spring to the mouth.
    pub(crate) points: Vec<DVec3>,
    /// About how far the river strays from the straight way between points, as an angle.
    pub(crate) wander_rad: f64,
    pub(crate) seed: u32,
    /// Water of the spring in m³/s on this planet.
    pub(crate) spring_m3_s: f64,
    /// How far it has cut down, 0 to 1.
    pub(crate) cut: f64,
}

/// Rise that is painted varies by about this share, as that of natural ranges does: a fractal sum of
/// [`RISE_OCTAVES`], of which the first has this many waves in a radius.
const RISE_VARIES: f64 = 0.55;
const RISE_FREQUENCY: f64 = 9.0;
const RISE_OCTAVES: u32 = 6;

/// The crust with its paint, as rivers read it. Its softness is multiplied by the variation of rock.
pub(super) fn rock_of(job: &Job<'_>, rock: &Rock) -> Rock {
    let variation = job.inputs().structure.as_ref().map_or(0.0, |structure| structure.rivers.rock_variation);
    let softness = rock.softness.iter().map(|softness| variation * softness).collect();
    let mut shaped = Rock { softness, ..rock.clone() };
    let cells = Cells::of(rock.side);
    let Some(paint) = job.ground.sculpted(&cells) else { return shaped };
    let seed = hash(job.inputs().structure.as_ref().map_or(0, |structure| structure.seed), 0x0117F);
    let varied = |(dir, paint_m): (&DVec3, &f64)| {
        let varied = || 1.0 + RISE_VARIES * fbm(*dir, RISE_FREQUENCY, RISE_OCTAVES, 0.55, seed);
        if *paint_m == 0.0 { 0.0 } else { paint_m * varied().max(0.1) }
    };
    let uplift_m: Vec<f64> = cells.dirs.par_iter().zip(&paint.uplift_m).with_min_len(1024).map(varied).collect();
    for (cell, paint_m) in uplift_m.into_iter().enumerate() {
        let uplift_m = shaped.uplift_m[cell] + paint_m;
        // Nothing rises by less than nothing: the ground lies lower.
        if paint_m < 0.0 {
            shaped.base_m[cell] += uplift_m.min(0.0);
        }
        if paint_m != 0.0 {
            shaped.uplift_m[cell] = uplift_m.max(0.0);
        }
        shaped.softness[cell] -= paint.hardness[cell];
    }
    shaped
}
