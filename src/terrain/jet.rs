//! Numbers that carry their gradient, so that a landform's formula is written once.
//!
//! A formula generic over [`Real`] is compiled for `f32` (values alone), for [`Jet`] (values with gradients, by
//! forward differentiation) and for `f64` (values to the millimetre). The value of a jet takes the same operations as
//! the plain `f32` and has the same bits.

use super::lane::{CHUNK, Lane};
use super::noise::Noise;
use super::scalar::Scalar;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value with its derivatives: of landforms by the coordinates of the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jet<S = f32, const N: usize = 3> {
    pub(crate) v: S,
    pub(crate) d: [S; N],
}

/// Values and gradients at a chunk of points.
pub(crate) struct Jets<S = f32> {
    pub(crate) value: Lane<S>,
    pub(crate) gradient: [Lane<S>; 3],
}

impl<S: Scalar> Default for Jets<S> {
    fn default() -> Self {
        Self { value: [S::default(); CHUNK], gradient: [[S::default(); CHUNK]; 3] }
    }
}

impl<S: Scalar> Jets<S> {
    /// Sets the first `n` values, with gradients of 0.
    pub(crate) fn fill(&mut self, n: usize, value: S) {
        self.value[..n].fill(value);
        for lane in &mut self.gradient {
            lane[..n].fill(S::default());
        }
    }

    /// The greatest of the first `n` values.
    pub(crate) fn greatest(&self, n: usize) -> S {
        self.value[..n].iter().fold(-S::MOST, |greatest, value| greatest.max(*value))
    }
}

impl Jets {
    /// Rounds the first `n` values from f64; gradients stay.
    pub(crate) fn round_from(&mut self, n: usize, wide: &Jets<f64>) {
        for (value, wide) in self.value[..n].iter_mut().zip(&wide.value) {
            *value = *wide as f32;
        }
    }
}

/// A number with or without its gradient.
pub(crate) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The scalar type of value and gradient.
    type S: Scalar;
    /// A number from its value and gradient.
    fn of(v: Self::S, gradient: [Self::S; 3]) -> Self;
    /// The value alone.
    fn value(self) -> Self::S;
    /// A function of this number, from its value and its derivative here.
    fn chain(self, value: Self::S, derivative: Self::S) -> Self;
    /// Selects one of two without a branch.
    fn select(condition: bool, yes: Self, no: Self) -> Self;
    /// Reads the `i`th number of a chunk.
    fn load(jets: &Jets<Self::S>, i: usize) -> Self;
    /// Writes the `i`th number of a chunk.
    fn store(self, jets: &mut Jets<Self::S>, i: usize);
    /// The noise at the `i`th point.
    fn noise(noise: &Noise<Self::S>, i: usize) -> Self;
    /// The gradient of the noise at the `i`th point, itself with gradients. Plain numbers need [`Noise::gradients`],
    /// jets [`Noise::curvatures`].
    fn noise_gradient(noise: &Noise<Self::S>, i: usize) -> [Self; 3];

    /// A number whose gradient is 0.
    #[inline(always)]
    fn constant(v: f32) -> Self {
        Self::of(Self::S::from_f32(v), [Self::S::default(); 3])
    }
    /// Product with a scalar.
    #[inline(always)]
    fn times(self, k: Self::S) -> Self {
        self.chain(self.value() * k, k)
    }
    /// Product with a parameter.
    #[inline(always)]
    fn scale(self, k: f32) -> Self {
        self.times(Self::S::from_f32(k))
    }
    /// Sum with a parameter.
    #[inline(always)]
    fn plus(self, k: f32) -> Self {
        self.chain(self.value() + Self::S::from_f32(k), Self::S::of(1.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let one = Self::S::of(1.0);
        self.chain(self.value().abs(), if self.value() < Self::S::default() { -one } else { one })
    }
    /// The greater of it and a parameter.
    #[inline(always)]
    fn at_least(self, low: f32) -> Self {
        let low = Self::S::from_f32(low);
        self.chain(self.value().max(low), if self.value() > low { Self::S::of(1.0) } else { Self::S::default() })
    }
    /// The lesser of it and a parameter.
    #[inline(always)]
    fn at_most(self, high: f32) -> Self {
        let high = Self::S::from_f32(high);
        self.chain(self.value().min(high), if self.value() < high { Self::S::of(1.0) } else { Self::S::default() })
    }
    #[inline(always)]
    fn square(self) -> Self {
        self.chain(self.value() * self.value(), Self::S::of(2.0) * self.value())
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let r = Self::S::of(1.0) / self.value();
        self.chain(r, -r * r)
    }
    /// Square root. Its derivative at 0 counts as 0.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.chain(root, if root > Self::S::default() { Self::S::of(0.5) / root } else { Self::S::default() })
    }
    /// Smoothstep: 0 up to `from`, 1 from `to` on (`from < to`).
    #[inline(always)]
    fn smoothstep(self, from: f32, to: f32) -> Self {
        let of = Self::S::of;
        let span = Self::S::from_f32(1.0 / (to - from));
        let t = ((self.value() - Self::S::from_f32(from)) * span).clamp(of(0.0), of(1.0));
        self.chain(t * t * (of(3.0) - of(2.0) * t), of(6.0) * t * (of(1.0) - t) * span)
    }
}

/// Plain numbers. The optimiser drops the derivatives.
macro_rules! plain {
    ($number:ty) => {
        impl Real for $number {
            type S = $number;
            #[inline(always)]
            fn of(v: $number, _gradient: [$number; 3]) -> Self {
                v
            }
            #[inline(always)]
            fn value(self) -> $number {
                self
            }
            #[inline(always)]
            fn chain(self, value: $number, _derivative: $number) -> Self {
                value
            }
            #[inline(always)]
            fn select(condition: bool, yes: Self, no: Self) -> Self {
                if condition { yes } else { no }
            }
            #[inline(always)]
            fn load(jets: &Jets<$number>, i: usize) -> Self {
                jets.value[i]
            }
            #[inline(always)]
            fn store(self, jets: &mut Jets<$number>, i: usize) {
                jets.value[i] = self;
            }
            #[inline(always)]
            fn noise(noise: &Noise<$number>, i: usize) -> Self {
                noise.value[i]
            }
            #[inline(always)]
            fn noise_gradient(noise: &Noise<$number>, i: usize) -> [Self; 3] {
                [noise.gradient[0][i], noise.gradient[1][i], noise.gradient[2][i]]
            }
        }
    };
}
plain!(f32);
plain!(f64);

impl Real for Jet {
    type S = f32;
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

impl<S: Scalar, const N: usize> Add for Jet<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, o: Self) -> Self {
        self.v = self.v + o.v;
        for (d, o) in self.d.iter_mut().zip(&o.d) {
            *d = *d + *o;
        }
        self
    }
}

impl<S: Scalar, const N: usize> Sub for Jet<S, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, o: Self) -> Self {
        self.v = self.v - o.v;
        for (d, o) in self.d.iter_mut().zip(&o.d) {
            *d = *d - *o;
        }
        self
    }
}

impl<S: Scalar, const N: usize> Mul for Jet<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, o: Self) -> Self {
        for (d, by_o) in self.d.iter_mut().zip(&o.d) {
            *d = *d * o.v + *by_o * self.v;
        }
        self.v = self.v * o.v;
        self
    }
}

impl<S: Scalar, const N: usize> Neg for Jet<S, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        self.v = -self.v;
        for d in &mut self.d {
            *d = -*d;
        }
        self
    }
}

impl<const N: usize> Div for Jet<f64, N> {
    type Output = Self;
    #[inline(always)]
    fn div(mut self, o: Self) -> Self {
        self.v /= o.v;
        for (d, by_o) in self.d.iter_mut().zip(&o.d) {
            *d = (*d - *by_o * self.v) / o.v;
        }
        self
    }
}

/// Formulas in f64 whose derivatives are by variables of their own.
impl<const N: usize> Jet<f64, N> {
    /// A number whose derivatives are 0.
    #[inline(always)]
    pub(crate) fn constant(v: f64) -> Self {
        Self { v, d: [0.0; N] }
    }

    /// The variable of a number, 0 to N - 1.
    #[inline(always)]
    pub(crate) fn variable(v: f64, number: usize) -> Self {
        let mut jet = Self::constant(v);
        jet.d[number] = 1.0;
        jet
    }

    /// A function of this number, from its value and its derivative here.
    #[inline(always)]
    pub(crate) fn chain(mut self, v: f64, k: f64) -> Self {
        self.v = v;
        for d in &mut self.d {
            *d *= k;
        }
        self
    }

    /// Sum with a parameter.
    #[inline(always)]
    pub(crate) fn plus(self, k: f64) -> Self {
        Self { v: self.v + k, ..self }
    }

    /// Product with a parameter.
    #[inline(always)]
    pub(crate) fn times(self, k: f64) -> Self {
        self.chain(self.v * k, k)
    }

    /// Quotient by a parameter.
    #[inline(always)]
    pub(crate) fn over(self, k: f64) -> Self {
        self.chain(self.v / k, 1.0 / k)
    }

    /// The greater of it and a parameter.
    #[inline(always)]
    pub(crate) fn at_least(self, low: f64) -> Self {
        if self.v > low { self } else { Self::constant(low) }
    }

    /// 1 less the number.
    #[inline(always)]
    pub(crate) fn rest(self) -> Self {
        self.chain(1.0 - self.v, -1.0)
    }
}
