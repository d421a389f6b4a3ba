//! Numbers that carry their gradient, so that a landform's formula is written once.
//!
//! A formula generic over [`Real`] is compiled for `f32` (heights alone) and for [`Jet`] (heights with gradients, by
//! forward differentiation). The value of a jet goes through the very operations of the plain number: the same bits.

use super::noise::{CHUNK, Lane, Noise};
use std::ops::{Add, Mul, Neg, Sub};

/// A value and its gradient by the point's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jet {
    pub(crate) v: f32,
    pub(crate) d: [f32; 3],
}

/// Values, and with them gradients, at a chunk of points.
pub(crate) struct Jets {
    pub(crate) value: Lane<f32>,
    pub(crate) gradient: [Lane<f32>; 3],
}

impl Default for Jets {
    fn default() -> Self {
        Self { value: [0.0; CHUNK], gradient: [[0.0; CHUNK]; 3] }
    }
}

impl Jets {
    /// The same number at the first `n` points.
    pub(crate) fn fill(&mut self, n: usize, value: f32) {
        self.value[..n].fill(value);
        for lane in &mut self.gradient {
            lane[..n].fill(0.0);
        }
    }
}

/// A plain number or one with its gradient.
pub(crate) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// A number that is the same everywhere.
    fn constant(v: f32) -> Self;
    /// A number whose gradient was found by hand.
    fn of(v: f32, gradient: [f32; 3]) -> Self;
    /// The number without its gradient.
    fn value(self) -> f32;
    /// A function of this number: its value, and its derivative here.
    fn chain(self, value: f32, derivative: f32) -> Self;
    /// One of two, without a branch.
    fn select(condition: bool, yes: Self, no: Self) -> Self;
    /// The `i`th of a chunk.
    fn load(jets: &Jets, i: usize) -> Self;
    /// Puts it at the `i`th place of a chunk.
    fn store(self, jets: &mut Jets, i: usize);
    /// The noise at the `i`th point.
    fn noise(noise: &Noise, i: usize) -> Self;
    /// The gradient of the noise at the `i`th point, itself with gradients; needs [`Noise::gradients`] for plain
    /// numbers and [`Noise::curvatures`] for jets.
    fn noise_gradient(noise: &Noise, i: usize) -> [Self; 3];

    /// Times a plain number.
    #[inline(always)]
    fn scale(self, k: f32) -> Self {
        self.chain(self.value() * k, k)
    }
    /// Plus a plain number.
    #[inline(always)]
    fn plus(self, k: f32) -> Self {
        self.chain(self.value() + k, 1.0)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.chain(self.value().abs(), if self.value() < 0.0 { -1.0 } else { 1.0 })
    }
    /// The greater of it and a plain number.
    #[inline(always)]
    fn at_least(self, low: f32) -> Self {
        self.chain(self.value().max(low), if self.value() > low { 1.0 } else { 0.0 })
    }
    /// The lesser of it and a plain number.
    #[inline(always)]
    fn at_most(self, high: f32) -> Self {
        self.chain(self.value().min(high), if self.value() < high { 1.0 } else { 0.0 })
    }
    #[inline(always)]
    fn square(self) -> Self {
        self.chain(self.value() * self.value(), 2.0 * self.value())
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let r = 1.0 / self.value();
        self.chain(r, -r * r)
    }
    /// Square root; the derivative at zero is taken as zero.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, if root > 0.0 { 0.5 / root } else { 0.0 })
    }
    /// 0 at and below `from`, 1 at and above `to` (`from < to`), smooth between.
    #[inline(always)]
    fn smoothstep(self, from: f32, to: f32) -> Self {
        let span = 1.0 / (to - from);
        let t = ((self.value() - from) * span).clamp(0.0, 1.0);
        self.chain(t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) * span)
    }
}

impl Real for f32 {
    #[inline(always)]
    fn constant(v: f32) -> Self {
        v
    }
    #[inline(always)]
    fn of(v: f32, _gradient: [f32; 3]) -> Self {
        v
    }
    #[inline(always)]
    fn value(self) -> f32 {
        self
    }
    #[inline(always)]
    fn chain(self, value: f32, _derivative: f32) -> Self {
        value
    }
    #[inline(always)]
    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }
    #[inline(always)]
    fn load(jets: &Jets, i: usize) -> Self {
        jets.value[i]
    }
    #[inline(always)]
    fn store(self, jets: &mut Jets, i: usize) {
        jets.value[i] = self;
    }
    #[inline(always)]
    fn noise(noise: &Noise, i: usize) -> Self {
        noise.value[i]
    }
    #[inline(always)]
    fn noise_gradient(noise: &Noise, i: usize) -> [Self; 3] {
        [noise.gradient[0][i], noise.gradient[1][i], noise.gradient[2][i]]
    }
}

impl Real for Jet {
    #[inline(always)]
    fn constant(v: f32) -> Self {
        Jet { v, d: [0.0; 3] }
    }
    #[inline(always)]
    fn of(v: f32, d: [f32; 3]) -> Self {
        Jet { v, d }
    }
    #[inline(always)]
    fn value(self) -> f32 {
        self.v
    }
    #[inline(always)]
    fn chain(self, v: f32, k: f32) -> Self {
        Jet { v, d: [self.d[0] * k, self.d[1] * k, self.d[2] * k] }
    }
    #[inline(always)]
    fn select(condition: bool, yes: Self, no: Self) -> Self {
        let pick = |a: f32, b: f32| if condition { a } else { b };
        Jet { v: pick(yes.v, no.v), d: [pick(yes.d[0], no.d[0]), pick(yes.d[1], no.d[1]), pick(yes.d[2], no.d[2])] }
    }
    #[inline(always)]
    fn load(jets: &Jets, i: usize) -> Self {
        let [x, y, z] = &jets.gradient;
        Jet { v: jets.value[i], d: [x[i], y[i], z[i]] }
    }
    #[inline(always)]
    fn store(self, jets: &mut Jets, i: usize) {
        let [x, y, z] = &mut jets.gradient;
        jets.value[i] = self.v;
        x[i] = self.d[0];
        y[i] = self.d[1];
        z[i] = self.d[2];
    }
    #[inline(always)]
    fn noise(noise: &Noise, i: usize) -> Self {
        let [x, y, z] = &noise.gradient;
        Jet { v: noise.value[i], d: [x[i], y[i], z[i]] }
    }
    #[inline(always)]
    fn noise_gradient(noise: &Noise, i: usize) -> [Self; 3] {
        let [x, y, z] = &noise.gradient;
        let [xx, yy, zz, yz, zx, xy] = &noise.curvature;
        [
            Jet { v: x[i], d: [xx[i], xy[i], zx[i]] },
            Jet { v: y[i], d: [xy[i], yy[i], yz[i]] },
            Jet { v: z[i], d: [zx[i], yz[i], zz[i]] },
        ]
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Jet { v: self.v + o.v, d: [self.d[0] + o.d[0], self.d[1] + o.d[1], self.d[2] + o.d[2]] }
    }
}

impl Sub for Jet {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Jet { v: self.v - o.v, d: [self.d[0] - o.d[0], self.d[1] - o.d[1], self.d[2] - o.d[2]] }
    }
}

impl Mul for Jet {
    type Output = Self;
    // The product rule is a sum.
    #[allow(clippy::suspicious_arithmetic_impl)]
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let d = |i: usize| self.d[i] * o.v + o.d[i] * self.v;
        Jet { v: self.v * o.v, d: [d(0), d(1), d(2)] }
    }
}

impl Neg for Jet {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Jet { v: -self.v, d: [-self.d[0], -self.d[1], -self.d[2]] }
    }
}
