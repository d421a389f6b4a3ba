//! Affine intervals: numbers that vary around a direction, for bounds near it.
//!
//! Each number is known in two ways. As a line, `value + gradient . d` plus or minus an error for a step `d` of the
//! unit direction, so that slopes of parts cancel (a Taylor model of first order: Makino and Berz 2003). And as an
//! interval, which is tighter where the number bends too much for a line. Formulas of such numbers are conservative.

use super::octaves::Weighted;
use crate::terrain::noise::{self, Octave};
use glam::DVec3;
use std::ops::{Add, Mul, Neg, Sub};

/// All directions within an angle of one, or points near a point above or below that direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub(super) dir_planet: DVec3,
    /// How far the points lie aside at most, in radii.
    pub(super) angle_rad: f64,
    /// Distance of the middle from the centre of the planet, in radii, and how far the points lie above and below a
    /// sphere through it.
    pub(super) from_centre: f64,
    pub(super) rise: f64,
}

impl Around {
    /// The directions within an angle of one.
    pub(super) fn new(dir_planet: DVec3, angle_rad: f64) -> Self {
        Self { dir_planet, angle_rad, from_centre: 1.0, rise: 0.0 }
    }

    /// Greatest distance along the central direction.
    fn upward(&self) -> f64 {
        0.5 * self.angle_rad * self.angle_rad + self.rise
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Varying {
    around: Around,
    value: f64,
    gradient: DVec3,
    error: f64,
    lo: f64,
    hi: f64,
}

impl Varying {
    /// `value + gradient . d` plus or minus `error`, and in any case between `lo` and `hi`.
    pub(super) fn new(around: Around, value: f64, gradient: DVec3, error: f64, (lo, hi): (f64, f64)) -> Self {
        let number = Self { around, value, gradient, error, lo, hi };
        let reach = number.reach();
        let (lo, hi) = (lo.max(value - reach), hi.min(value + reach));
        // Where the line is little tighter than the interval, it is made level.
        if reach < 0.6 * (hi - lo) && (lo..=hi).contains(&value) {
            Self { lo, hi, ..number }
        } else {
            Self { value: 0.5 * (lo + hi), gradient: DVec3::ZERO, error: 0.5 * (hi - lo), lo, hi, ..number }
        }
    }

    /// Anything between two numbers.
    pub(super) fn between(around: Around, lo: f64, hi: f64) -> Self {
        Self::new(around, 0.5 * (lo + hi), DVec3::ZERO, 0.5 * (hi - lo), (lo, hi))
    }

    /// The same everywhere.
    pub(super) fn constant(around: Around, value: f64) -> Self {
        Self { around, value, gradient: DVec3::ZERO, error: 0.0, lo: value, hi: value }
    }

    /// Lowest and highest.
    pub(super) fn range(self) -> (f64, f64) {
        (self.lo, self.hi)
    }

    /// The value at the central direction, up to the error.
    pub(super) fn value(self) -> f64 {
        self.value
    }

    /// Greatest rise or fall of the line and its error: steps follow the ground, which curves down a little.
    fn reach(self) -> f64 {
        let Around { dir_planet, angle_rad, .. } = self.around;
        let up = self.gradient.dot(dir_planet);
        let along = (self.gradient.length_squared() - up * up).max(0.0).sqrt();
        along * angle_rad + up.abs() * self.around.upward() + self.error
    }

    /// Times a number.
    pub(super) fn scale(self, k: f64) -> Self {
        let (a, b) = (self.lo * k, self.hi * k);
        let (value, gradient, error) = (self.value * k, self.gradient * k, self.error * k.abs());
        Self { value, gradient, error, lo: a.min(b), hi: a.max(b), ..self }
    }

    /// Plus a number.
    pub(super) fn plus(self, k: f64) -> Self {
        Self { value: self.value + k, lo: self.lo + k, hi: self.hi + k, ..self }
    }

    /// A function of it: `line` gives value and derivative; `bend` bounds its second derivative.
    pub(super) fn map(self, line: impl Fn(f64) -> (f64, f64), bend: f64, range: (f64, f64)) -> Self {
        let ((value, slope), reach) = (line(self.value), self.reach());
        let error = slope.abs() * self.error + 0.5 * bend * reach * reach;
        Self::new(self.around, value, self.gradient * slope, error, range)
    }

    pub(super) fn square(self) -> Self {
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let least = if self.lo < 0.0 && self.hi > 0.0 { 0.0 } else { a.min(b) };
        self.map(|v| (v * v, 2.0 * v), 2.0, (least, a.max(b)))
    }

    pub(super) fn abs(self) -> Self {
        match self {
            Self { lo, .. } if lo >= 0.0 => self,
            Self { hi, .. } if hi <= 0.0 => -self,
            Self { around, lo, hi, .. } => Self::between(around, 0.0, hi.max(-lo)),
        }
    }

    /// The reciprocal of a positive number.
    pub(super) fn recip(self) -> Self {
        let f = |v: f64| (1.0 / v, -1.0 / (v * v));
        self.map(f, 2.0 / (self.lo * self.lo * self.lo), (1.0 / self.hi, 1.0 / self.lo))
    }

    /// The reciprocal of the root of a positive number.
    pub(super) fn recip_sqrt(self) -> Self {
        let f = |v: f64| (1.0 / v.sqrt(), -0.5 / (v * v.sqrt()));
        self.map(f, 0.75 / (self.lo * self.lo * self.lo.sqrt()), (f(self.hi).0, f(self.lo).0))
    }

    /// The greater of it and a number, below which it lies by rounding only.
    pub(super) fn at_least(self, low: f64) -> Self {
        Self { lo: self.lo.max(low), hi: self.hi.max(low), value: self.value.max(low), ..self }
    }

    /// Smoothstep: 0 up to `from`, 1 from `to` on.
    pub(super) fn smoothstep(self, from: f64, to: f64) -> Self {
        let span = 1.0 / (to - from);
        let step = |v: f64| {
            let t = ((v - from) * span).clamp(0.0, 1.0);
            (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) * span)
        };
        self.map(step, 6.0 * span * span, (step(self.lo).0, step(self.hi).0))
    }
}

impl Add for Varying {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let (value, gradient) = (self.value + o.value, self.gradient + o.gradient);
        Self::new(self.around, value, gradient, self.error + o.error, (self.lo + o.lo, self.hi + o.hi))
    }
}

impl Neg for Varying {
    type Output = Self;
    fn neg(self) -> Self {
        self.scale(-1.0)
    }
}

impl Sub for Varying {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Varying {
    type Output = Self;
    // The product rule is a sum.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn mul(self, o: Self) -> Self {
        let (a, b) = (self.value, o.value);
        let error = a.abs() * o.error + b.abs() * self.error + self.reach() * o.reach();
        let ends = [self.lo * o.lo, self.lo * o.hi, self.hi * o.lo, self.hi * o.hi];
        let range = ends.iter().fold((f64::MAX, f64::MIN), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
        Self::new(self.around, a * b, self.gradient * b + o.gradient * a, error, range)
    }
}

/// The images of the directions: themselves, or displaced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    around: Around,
    pub(super) coordinates: [Varying; 3],
    /// Greatest distance of an image from that of the central direction.
    distance: f64,
}

impl Point {
    /// The directions themselves.
    pub(super) fn new(around: Around) -> Self {
        let reach = around.angle_rad + around.rise;
        let coordinate = |axis: usize| {
            let at = around.dir_planet[axis] * around.from_centre;
            Varying { around, value: at, gradient: DVec3::AXES[axis], error: 0.0, lo: at - reach, hi: at + reach }
        };
        Self { around, coordinates: [0, 1, 2].map(coordinate), distance: reach * (1.0 + 1e-9) + 1e-15 }
    }

    /// The directions displaced.
    pub(super) fn displaced(around: Around, coordinates: [Varying; 3]) -> Self {
        let Around { dir_planet, angle_rad, .. } = around;
        let (s, t) = dir_planet.any_orthonormal_pair();
        let along = |axis: DVec3| DVec3::from_array(coordinates.map(|c| c.gradient.dot(axis)));
        let (s, t, up) = (along(s), along(t), along(dir_planet));
        // Greatest stretch of a unit step along the ground: the greater singular value.
        let (mean, half) = (0.5 * (s.dot(s) + t.dot(t)), 0.5 * (s.dot(s) - t.dot(t)));
        let stretch = (mean + libm::hypot(half, s.dot(t))).sqrt();
        let error = DVec3::from_array(coordinates.map(|c| c.error)).length();
        let distance = stretch * angle_rad + up.length() * around.upward() + error;
        Self { around, coordinates, distance: distance * (1.0 + 1e-9) + 1e-13 }
    }

    fn near(&self, octave: &Octave) -> noise::Nearby {
        noise::near(noise::skew(self.coordinates.map(|c| c.value)), octave, self.distance)
    }

    /// The gradient by the direction of a number whose gradient by lattice coordinates is `slope`, and its error from
    /// the errors of the coordinates.
    fn pulled_back(&self, slope: DVec3, frequency: f64) -> (DVec3, f64) {
        let (mut gradient, mut error) = (DVec3::ZERO, 0.0);
        for (coordinate, slope) in self.coordinates.iter().zip(slope.to_array()) {
            gradient += coordinate.gradient * (slope * frequency);
            error += coordinate.error * (slope * frequency).abs();
        }
        (gradient, error)
    }

    /// The noise of an octave.
    pub(super) fn noise(&self, octave: &Octave) -> Varying {
        self.varying(octave, &self.near(octave))
    }

    fn varying(&self, octave: &Octave, near: &noise::Nearby) -> Varying {
        let (gradient, error) = self.pulled_back(near.gradient, octave.frequency);
        Varying::new(self.around, near.value, gradient, near.bend + error, near.range)
    }

    /// The noise of an octave and its gradient by the lattice.
    pub(super) fn noise_and_slope(&self, octave: &Octave) -> (Varying, [Varying; 3]) {
        let near = self.near(octave);
        let slope = |axis: usize| {
            let (gradient, error) = self.pulled_back(near.curvature.col(axis), octave.frequency);
            let (at, most) = (near.gradient[axis], noise::SLOPE_BOUND);
            let range = ((at - near.turn).max(-most), (at + near.turn).min(most));
            Varying::new(self.around, at, gradient, near.twist + error, range)
        };
        (self.varying(octave, &near), [0, 1, 2].map(slope))
    }

    /// A sum of octaves.
    pub(super) fn sum(&self, octaves: &[Weighted]) -> Varying {
        // For the rounding of weights in f32.
        octaves.iter().fold(Varying::between(self.around, -1e-6, 1e-6), |sum, Weighted { octave, weight }| {
            sum + self.noise(octave).scale(f64::from(*weight))
        })
    }
}
