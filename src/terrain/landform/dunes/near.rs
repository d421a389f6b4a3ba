//! Bounds of dunes near a direction.
//!
//! The sum of waves is written as one carrier, the wave of the wind there, times a complex number that varies slowly.
//! The carrier advances the phase evenly; the range of the other factor follows from its derivatives.

use super::{Dunes, FAINT, JITTER, Profile, REACH, Size, WAVES, wave};
use crate::simd::Simd;
use crate::terrain::landform::places::Places;
use crate::terrain::landform::varying::{Around, Point, Varying};
use crate::terrain::noise;
use glam::DVec3;
use std::f64::consts::TAU;

/// Greatest distance in cells for which bounds are known: waves come from the cells next to the direction's own, and
/// the phase soon turns full circle.
const FARTHEST: f64 = 0.3;
const _: () = assert!(1.5 - JITTER as f64 > REACH as f64 + FARTHEST);

impl Size {
    /// Bounds of dunes of one size around a direction.
    pub(super) fn near(&self, around: Around, dunes: &Dunes) -> Varying {
        let frequency = self.lattices[0].frequency;
        let reach = around.angle_rad * frequency * (1.0 + 1e-9) + 1e-7;
        if reach > FARTHEST {
            return Varying::between(around, -1.0, 1.0);
        }
        let sum = self.sum(around, reach, dunes);
        let faint = f64::from(FAINT);
        let square = sum.along.square() + sum.across.square();
        let strength = square.map(
            |v| (v / (v + faint), faint / ((v + faint) * (v + faint))),
            2.0 * faint / (square.range().0 + faint).powi(3),
            (share(square.range().0), share(square.range().1)),
        );
        let height = match sum.phase() {
            Some(phase) => {
                let bends = Point::new(around).noise(&self.bends).scale(f64::from(dunes.waviness));
                dunes.profile.near(around, phase + bends)
            }
            None => Varying::between(around, 0.0, 2.0),
        };
        (height * strength).plus(-1.0)
    }

    /// The sum of waves within a distance of a direction, in cells.
    fn sum(&self, around: Around, reach: f64, dunes: &Dunes) -> Sum {
        let (dir_planet, frequency) = (around.dir_planet, self.lattices[0].frequency);
        let wave_vector = |along: [f64; 3]| DVec3::from_array(along) * (TAU * f64::from(WAVES));
        let carrier = wave_vector(dunes.wind.at(dir_planet.to_array()));
        let skewed = noise::skew(dir_planet.to_array());
        let within = f64::from(REACH * REACH);
        let (mut sum, mut gradients, mut weights, mut bend) = ([0.0; 2], [DVec3::ZERO; 2], 0.0, 0.0);
        let mut places = Places::<f64>::default();
        for octave in &self.lattices {
            places.find(Simd::detect(), skewed.each_ref().map(std::slice::from_ref), octave);
            for corner in (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]) {
                let wave = wave(&places, corner, octave, |from| dunes.wind.at(from), 0);
                let (to, waves) = (DVec3::from_array(wave.to), wave_vector(wave.along));
                let distance = to.length();
                let (nearest, farthest) = ((distance - reach).max(0.0), (distance + reach).min(f64::from(REACH)));
                if nearest >= f64::from(REACH) {
                    continue;
                }
                // How the weight, and the phase relative to the carrier, change from the direction on.
                let near = (1.0 - distance * distance / within).max(0.0);
                let weight = near.powi(3);
                let fall = to * (6.0 * near * near / within);
                let turn = waves - carrier;
                let (sin, cos) = libm::sincos(wave.start * TAU - to.dot(waves));
                sum = [sum[0] + weight * cos, sum[1] + weight * sin];
                gradients[0] += fall * cos - turn * (weight * sin);
                gradients[1] += fall * sin + turn * (weight * cos);
                // Bound of the bend of the sum on the way.
                let most = 1.0 - nearest * nearest / within;
                let steepest = 6.0 * most * most * farthest / within;
                let curved = (24.0 * most * farthest * farthest / (within * within)).max(6.0 * most * most / within);
                let turn = turn.length();
                bend += curved + 2.0 * steepest * turn + most.powi(3) * turn * turn;
                weights += most.powi(3);
            }
        }
        let length = libm::hypot(sum[0], sum[1]);
        let (cos, sin) = if length > 1e-9 { (sum[0] / length, sum[1] / length) } else { (1.0, 0.0) };
        let error = 0.5 * bend * reach * reach + 2e-6;
        let part = |value: f64, gradient: DVec3| {
            Varying::new(around, value, gradient * frequency, error, (-weights - 1e-5, weights + 1e-5))
        };
        let even = carrier * (frequency / TAU);
        let most = even.length() * around.angle_rad + 1e-7;
        let start = libm::atan2(sin, cos) / TAU;
        Sum {
            along: part(length, gradients[0] * cos + gradients[1] * sin),
            across: part(0.0, gradients[1] * cos - gradients[0] * sin),
            carrier: Varying::new(around, start, even, 1e-7, (start - most, start + most)),
        }
    }
}

/// The share of their height that dunes have at this squared sum.
fn share(square: f64) -> f64 {
    square / (square + f64::from(FAINT))
}

/// The sum of waves relative to the carrier: along the sum at the direction, and across it.
struct Sum {
    along: Varying,
    across: Varying,
    /// The phase of the carrier relative to that of the sum at the direction, in turns.
    carrier: Varying,
}

impl Sum {
    /// The phase in turns; `None` where it may be any.
    fn phase(&self) -> Option<Varying> {
        if self.along.range().0 < 1e-3 {
            return None;
        }
        let tangent = self.across * self.along.recip();
        let angle = |t: f64| (libm::atan(t) / TAU, 1.0 / ((1.0 + t * t) * TAU));
        let (lo, hi) = tangent.range();
        Some(self.carrier + tangent.map(angle, 0.65 / TAU, (angle(lo).0, angle(hi).0)))
    }
}

impl Profile {
    /// [`Profile::height`] at phases in turns.
    fn near(self, around: Around, phase: Varying) -> Varying {
        let (lo, hi) = phase.range();
        if hi - lo >= 1.0 {
            return Varying::between(around, 0.0, 2.0);
        }
        let whole = lo.floor();
        let inside = |at: f64| [whole + at, whole + at + 1.0].iter().any(|at| (lo..=hi).contains(at));
        let (trough, crest) = (inside(0.0), inside(f64::from(self.windward)));
        let (a, b) = (self.section(lo).0, self.section(hi).0);
        let range = (if trough { 0.0 } else { a.min(b) }, if crest { 2.0 } else { a.max(b) });
        if trough || crest {
            return Varying::between(around, range.0, range.1);
        }
        let windward = phase.value() - whole < f64::from(self.windward);
        let run = if windward { 1.0 / f64::from(self.windward) } else { 1.0 / (1.0 - f64::from(self.windward)) };
        phase.map(|turns| self.section(turns), 12.0 * run * run, range)
    }
}
