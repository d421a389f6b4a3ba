//! The noise of one octave near a point, for bounds: value, derivatives, and how far the noise can be from them.

use super::{BOUND, Octave, split, value_gradient_curvature};
use glam::{DMat3, DVec3};

/// Bounds of the length of the gradient and of the second and third derivatives along any direction, by lattice
/// coordinates. They add up the greatest contributions of four corners with the worst gradients; true values are far
/// smaller.
pub(crate) const SLOPE_BOUND: f64 = 11.4;
pub(crate) const CURVATURE_BOUND: f64 = 131.0;
pub(crate) const TWIST_BOUND: f64 = 1380.0;

/// Bound of the rounding of the f32 kernels.
const ROUNDING: f64 = 3e-6;

/// The noise near a point; derivatives are by lattice coordinates.
pub(crate) struct Nearby {
    pub(crate) value: f64,
    pub(crate) gradient: DVec3,
    pub(crate) curvature: DMat3,
    /// Bound of the distance of the noise from `value + gradient . d`.
    pub(crate) bend: f64,
    /// Bound of the distance of its gradient from `gradient + curvature d`.
    pub(crate) twist: f64,
    /// Lowest and highest noise.
    pub(crate) range: (f64, f64),
    /// Bound of the change of each component of the gradient.
    pub(crate) turn: f64,
}

/// The noise of an octave within a distance of a skewed point (in the units of the point). Conservative.
pub(crate) fn near(point_skewed: [f64; 3], octave: &Octave, distance: f64) -> Nearby {
    let [(ix, x), (iy, y), (iz, z)] =
        [0, 1, 2].map(|axis| split::<f64>(point_skewed[axis] * octave.frequency + octave.offset[axis]));
    let (value, gradient, [xx, yy, zz, yz, zx, xy]) = value_gradient_curvature([ix, iy, iz], [x, y, z], octave.seed);
    let curvature = DMat3::from_cols_array_2d(&[[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]);
    let cells = distance * octave.frequency;
    let curved = curvature.to_cols_array().iter().map(|c| c * c).sum::<f64>().sqrt();
    let bend = (0.5 * curved + TWIST_BOUND / 6.0 * cells).min(0.5 * CURVATURE_BOUND) * cells * cells;
    let rise = SLOPE_BOUND * cells;
    Nearby {
        value,
        gradient: DVec3::from_array(gradient),
        curvature,
        bend: bend + ROUNDING,
        twist: 0.5 * TWIST_BOUND * cells * cells + ROUNDING,
        range: ((value - rise).max(-BOUND) - ROUNDING, (value + rise).min(BOUND) + ROUNDING),
        turn: (curved + 0.5 * TWIST_BOUND * cells).min(CURVATURE_BOUND) * cells + ROUNDING,
    }
}
