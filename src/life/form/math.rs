//! Functions of numbers and vectors that give the same bits on every machine.

use glam::Vec3;

/// Full turn in radians.
pub(super) const TURN: f32 = std::f32::consts::TAU;

/// Golden angle in radians: it spreads directions evenly.
pub(super) const GOLDEN: f32 = 2.399_963;

/// Sine.
pub(super) fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine.
pub(super) fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Power of a number that is not negative.
pub(super) fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x.max(0.0), y)
}

/// Exponential.
pub(super) fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm.
pub(super) fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Blend from `a` to `b`.
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Smooth step from 0 at `a` to 1 at `b`.
pub(super) fn smooth(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Horizontal unit vector at an angle from the x axis.
pub(super) fn around(angle: f32) -> Vec3 {
    Vec3::new(cos(angle), sin(angle), 0.0)
}

/// Vector turned about a unit axis (Rodrigues).
pub(super) fn turn(v: Vec3, axis: Vec3, angle: f32) -> Vec3 {
    let (s, c) = (sin(angle), cos(angle));
    v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1.0 - c))
}
