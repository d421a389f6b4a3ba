//! Sine, cosine and arctangent by polynomials in f32, for the hot loops: the same bits on every instruction set, which
//! neither the platform's functions nor a vector library promise.
//!
//! Angles are in turns (1 is a full circle): a turn more or less is then a whole number, which f32 takes away without
//! error. The polynomials interpolate at Chebyshev nodes; their errors, like the rounding, are about 1e-7.

use super::jet::Real;
use std::f32::consts::TAU;

/// Adding and subtracting this rounds an f32 below 2^22 to a whole number.
const ROUNDER: f32 = 12_582_912.0;

/// An angle in turns without its whole turns: -0.5 to 0.5. The angle must be below 2^22.
#[inline(always)]
pub(crate) fn wrap(turns: f32) -> f32 {
    turns - ((turns + ROUNDER) - ROUNDER)
}

/// Sine of an angle of at most a quarter turn either way.
#[inline(always)]
fn sin_quarter(turns: f32) -> f32 {
    const C: [f32; 5] = [TAU, -41.341_68, 81.602_48, -76.581_17, 39.759_827];
    let square = turns * turns;
    turns * (C[0] + square * (C[1] + square * (C[2] + square * (C[3] + square * C[4]))))
}

/// Sine and cosine of an angle in turns, which must be below 2^22.
#[inline(always)]
pub(crate) fn sin_cos<R: Real>(turns: R) -> (R, R) {
    let wrapped = wrap(turns.value());
    let size = wrapped.abs();
    // Beyond a quarter turn the sine comes down again.
    let folded = 0.25 - (size - 0.25).abs();
    let sin = sin_quarter(if wrapped < 0.0 { -folded } else { folded });
    let cos = sin_quarter(0.25 - size);
    (turns.chain(sin, TAU * cos), turns.chain(cos, -TAU * sin))
}

/// The angle of a vector in turns, -0.5 to 0.5; zero, with no gradient, for the zero vector.
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
    let (height, width) = (y.value().abs(), x.value().abs());
    let steep = height > width;
    let (small, large) = if steep { (width, height) } else { (height, width) };
    // At the zero vector the quotient would not be a number.
    let t = small / large.max(f32::MIN_POSITIVE);
    let s = t * t;
    let series = C[4] + s * (C[5] + s * (C[6] + s * C[7]));
    let octant = t * (C[0] + s * (C[1] + s * (C[2] + s * (C[3] + s * series))));
    let quarter = if steep { 0.25 - octant } else { octant };
    let half = if x.value() < 0.0 { 0.5 - quarter } else { quarter };
    let angle = if y.value() < 0.0 { -half } else { half };
    let square = (x.value() * x.value() + y.value() * y.value()).max(f32::MIN_POSITIVE);
    (y.scale(x.value()) - x.scale(y.value())).chain(angle, 1.0 / (TAU * square))
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

            let (sin_jet, cos_jet) = sin_cos(Jet { v: turns, d: [1.0, -2.0, 0.0] });
            assert_eq!((sin_jet.v.to_bits(), cos_jet.v.to_bits()), (sin.to_bits(), cos.to_bits()));
            let back = atan2(sin_jet, cos_jet);
            assert!((back.d[0] - 1.0).abs() < 1e-5 && (back.d[1] + 2.0).abs() < 1e-5 && back.d[2] == 0.0, "{back:?}");
        }
        assert_eq!(atan2(0.0, 0.0), 0.0);
    }
}
