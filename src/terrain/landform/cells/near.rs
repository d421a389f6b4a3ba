//! Bounds of cells near a direction, from the centres that can be nearest there.

use super::{HORIZON, centre, neighbourhood};
use crate::simd::Simd;
use crate::terrain::landform::places::{Places, unit};
use crate::terrain::noise::{self, Octave};
use glam::DVec3;

/// The centres around a direction, for bounds within a distance of it.
pub(super) struct Near {
    /// Distance in cells and level of the plate, nearest first.
    centres: Vec<(f64, f64)>,
    /// The distance in cells.
    reach: f64,
}

impl Near {
    pub(super) fn new(octave: &Octave, jitter: f32, dir_planet: DVec3, angle_rad: f64) -> Self {
        let [x, y, z] = noise::skew(dir_planet.to_array());
        let mut places = Places::<f64>::default();
        places.find(Simd::detect(), [&[x], &[y], &[z]], octave);
        let centre = |step: [i32; 3]| {
            let (square, random) = centre::<f64>(&places, step, octave.seed, jitter, 0);
            (square.sqrt(), f64::from(2.0 * unit::<f32>(noise::scramble(random)) - 1.0))
        };
        let mut centres: Vec<(f64, f64)> = neighbourhood().map(centre).collect();
        centres.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A little more for the rounding of f32.
        Self { centres, reach: angle_rad * octave.frequency + 1e-5 }
    }

    /// Bounds of a squared distance.
    fn squares(&self, distance: f64) -> (f64, f64) {
        ((distance - self.reach).max(0.0).powi(2), (distance + self.reach).powi(2))
    }

    /// Bounds of the difference of two squared distances. It changes by at most twice the distance between the two
    /// centres.
    fn beyond(&self, distance: f64, first: f64) -> (f64, f64) {
        let change = 2.0 * (distance + first + 2.0 * self.reach) * self.reach;
        let beyond = distance * distance - first * first;
        ((beyond - change).max(0.0), beyond + change)
    }

    pub(super) fn bumps(&self) -> (f64, f64) {
        let (least, most) = self.squares(self.centres[0].0);
        ((1.0 - 2.0 * most).max(-1.0), (1.0 - 2.0 * least).max(-1.0))
    }

    pub(super) fn cracks(&self, width: f64) -> (f64, f64) {
        let (low, high) = self.beyond(self.centres[1].0, self.centres[0].0);
        let step = |x: f64| {
            let t = (x / width).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t) - 1.0
        };
        (step(low), step(high))
    }

    /// `None` where centres beyond those known may count.
    pub(super) fn plates(&self, width: f64) -> Option<(f64, f64)> {
        let first = self.centres[0].0;
        let ((_, farthest), horizon) = (self.squares(first), f64::from(HORIZON));
        if (horizon.sqrt() - self.reach).max(0.0).powi(2) < farthest + width {
            return None;
        }
        let share = |beyond: f64| (1.0 - beyond / width).max(0.0).powi(2);
        let shares: Vec<(f64, f64, f64)> = self
            .centres
            .iter()
            .map(|&(distance, level)| {
                let (low, high) = self.beyond(distance, first);
                (share(high), share(low), level)
            })
            .filter(|share| share.1 > 0.0)
            .collect();
        // A mean is greatest with the greatest share of the highest and the least of the others.
        let greatest = |sign: f64| {
            let mean = |from: f64| {
                let weight = |&(least, most, level): &(f64, f64, f64)| if sign * level >= from { most } else { least };
                let total: f64 = shares.iter().map(weight).sum();
                shares.iter().map(|share| weight(share) * sign * share.2).sum::<f64>() / total
            };
            shares.iter().map(|share| mean(sign * share.2)).fold(f64::MIN, f64::max)
        };
        Some((-greatest(-1.0), greatest(1.0)))
    }
}
