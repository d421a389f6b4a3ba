//! Sine, cosine and arctangent by polynomials in f32, for the hot loops. They are bit-identical on every instruction
//! set, which neither the platform's functions nor a vector library promise.
//!
//! Angles are in turns (1 is a full circle), because f32 subtracts whole turns without rounding. The polynomials
//! interpolate at Chebyshev nodes; approximation and rounding errors are each about 1e-7.

use super::jet::Real;
use super::scalar::Scalar;
use std::f64::consts::TAU;

/// An angle in turns reduced to -0.5 to 0.5. It must be below 2^22 in size.
#[inline(always)]
pub(crate) fn wrap<S: Scalar>(turns: S) -> S {
    turns - turns.whole()
}

/// A polynomial; `c` holds the coefficient of the highest power last.
#[inline(always)]
fn polynomial<S: Scalar, const N: usize>(c: [f32; N], x: S) -> S {
    let mut sum = S::from_f32(c[N - 1]);
    for k in (0..N - 1).rev() {
        sum = S::from_f32(c[k]) + x * sum;
    }
    sum
}

/// Sine of an angle of at most a quarter turn either way.
#[inline(always)]
fn sin_quarter<S: Scalar>(turns: S) -> S {
    const C: [f32; 5] = [TAU as f32, -41.341_68, 81.602_48, -76.581_17, 39.759_827];
    turns * polynomial(C, turns * turns)
}

/// Sine and cosine of an angle in turns, which must be below 2^22 in size.
#[inline(always)]
pub(crate) fn sin_cos<S: Scalar>(turns: S) -> (S, S) {
    let quarter = S::of(0.25);
    let wrapped = wrap(turns);
    let size = wrapped.abs();
    // Beyond a quarter turn the sine falls again.
    let folded = quarter - (size - quarter).abs();
    (sin_quarter(if wrapped < S::default() { -folded } else { folded }), sin_quarter(quarter - size))
}

/// The angle of a vector in turns, -0.5 to 0.5. The zero vector has the angle 0 and no gradient.
#[inline(always)]
pub(crate) fn atan2<R: Real>(y: R, x: R) -> R {
    const C: [f32; 8] = [
        0.159_154_92,
        -0.053_049_23,
        0.031_778_407,
        -0.022_286_93,
        0.015_706_787,
        -0.009_363_046,
        0.003_784_787,
        -0.000_725_713,
    ];
    let (zero, one) = (R::S::default(), R::S::of(1.0));
    let (height, width) = (y.value().abs(), x.value().abs());
    let steep = height > width;
    let (small, large) = if steep { (width, height) } else { (height, width) };
    // The quotient of the zero vector would be NaN.
    let t = small / large.max(R::S::LEAST);
    let octant = t * polynomial(C, t * t);
    let quarter = if steep { R::S::of(0.25) - octant } else { octant };
    let half = if x.value() < zero { R::S::of(0.5) - quarter } else { quarter };
    let angle = if y.value() < zero { -half } else { half };
    let square = (x.value() * x.value() + y.value() * y.value()).max(R::S::LEAST);
    (y.times(x.value()) - x.times(y.value())).chain(angle, one / (R::S::of(TAU) * square))
}

#[cfg(test)]
mod tests {
    use super::super::jet::Jet;
    use super::*;

    #[test]
    fn they_agree_with_libm_and_know_their_derivatives() {
        let tau = std::f64::consts::TAU;
        for i in -40_000..40_000_i32 {
            let turns = i as f32 * 1.37e-4;
            let (sin, cos) = sin_cos(turns);
            let exact = libm::sincos(f64::from(turns) * tau);
            assert!((f64::from(sin) - exact.0).abs() < 4e-7 && (f64::from(cos) - exact.1).abs() < 4e-7, "{turns}");

            let radius = 0.01 + (i + 40_000) as f32;
            let angle = atan2(sin * radius, cos * radius);
            let exact = libm::atan2(f64::from(sin), f64::from(cos)) / tau;
            assert!((f64::from(angle) - exact).abs() < 2e-7, "{turns}: {angle} {exact}");

            let turn = Jet { v: turns, d: [1.0, -2.0, 0.0] };
            let tau = TAU as f32;
            let back = atan2(turn.chain(sin, tau * cos), turn.chain(cos, -tau * sin));
            let wide = sin_cos(f64::from(turns));
            assert!((wide.0 - f64::from(sin)).abs() < 4e-7 && (wide.1 - f64::from(cos)).abs() < 4e-7, "{turns}");
            assert!((back.d[0] - 1.0).abs() < 1e-5 && (back.d[1] + 2.0).abs() < 1e-5 && back.d[2] == 0.0, "{back:?}");
        }
        assert_eq!(atan2(0.0, 0.0), 0.0);
    }
}
