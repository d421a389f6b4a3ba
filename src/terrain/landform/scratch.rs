//! Memory that one thread reuses for every chunk of every landform.
//!
//! Nothing is cleared between chunks: a loop that reads the first `n` numbers of a lane has written them before.

use super::chunk::Sums;
use super::places::Places;
use crate::terrain::jet::Jets;
use crate::terrain::lane::{CHUNK, Lane};
use crate::terrain::noise::Noise;
use crate::terrain::scalar::Scalar;

/// Lanes for intermediate results: as many as damped noise, which takes the most.
pub(super) const JETS: usize = 8;

/// Memory for one chunk.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) sums: Sums,
    pub(super) noise: Noise,
    pub(super) jets: [Jets; JETS],
    pub(super) places: Places,
    pub(super) displaced: Displaced,
    pub(super) carving: Carving,
    /// Points that folds displace. Taken out while a landform is evaluated there.
    pub(super) folded: Option<Box<Folded>>,
    /// The direction of the wind at each point.
    pub(super) wind: Vectors,
    pub(super) in_f64: Scratch64,
}

/// Memory for the octaves that are evaluated in f64.
#[derive(Default)]
pub(super) struct Scratch64 {
    pub(super) noise: Noise<f64>,
    pub(super) jets: [Jets<f64>; JETS],
    pub(super) places: Places<f64>,
    pub(super) jacobian: Jacobian64,
    pub(super) carving: Carving<f64>,
    pub(super) wind: Vectors<f64>,
}

/// A vector at each point of a chunk.
pub(super) struct Vectors<S = f32>(pub(super) [Lane<S>; 3]);

impl<S: Scalar> Default for Vectors<S> {
    fn default() -> Self {
        Self([[S::default(); CHUNK]; 3])
    }
}

/// The points of a chunk as folds displace them.
#[derive(Default)]
pub(super) struct Folded {
    pub(super) displaced: Displaced,
    /// The derivatives of the displaced points in f64.
    pub(super) jacobian: Jacobian64,
}

/// The points of a chunk displaced by a warp.
pub(super) struct Displaced {
    /// Their skewed coordinates.
    pub(super) skewed: [Lane<f64>; 3],
    /// For each band the derivatives of the displaced point by the point: `[coordinate displaced][coordinate]`.
    pub(super) jacobians: Vec<[[Lane<f32>; 3]; 3]>,
    /// How many of the Jacobians belong to the chunk.
    pub(super) bands: usize,
    /// Second derivatives of each coordinate displaced, in the order of [`Noise::curvature`].
    pub(super) curvatures: [[Lane<f32>; 6]; 3],
}

impl Default for Displaced {
    fn default() -> Self {
        Self { skewed: [[0.0; CHUNK]; 3], jacobians: Vec::new(), bands: 0, curvatures: [[[0.0; CHUNK]; 6]; 3] }
    }
}

/// The derivatives of displaced points by the points in f64: `[coordinate displaced][coordinate]`.
pub(super) struct Jacobian64(pub(super) [[Lane<f64>; 3]; 3]);

impl Default for Jacobian64 {
    fn default() -> Self {
        Self([[[0.0; CHUNK]; 3]; 3])
    }
}

/// The state of gullies from one octave to the next.
#[derive(Default)]
pub(super) struct Carving<S: Scalar = f32> {
    /// The slope that leads the gullies, in noise heights per cell of the coarsest noise octave.
    pub(super) guide: [Jets<S>; 3],
    /// A vector along the ground and across the slope; the shorter, the flatter the ground.
    pub(super) side: [Jets<S>; 3],
    /// Real and imaginary part of the sum of waves, then the same for the sum of waves each times the vector to its
    /// centre: the gradients of the first two.
    pub(super) waves: [Jets<S>; 4],
    /// The share of its depth that the next octave has.
    pub(super) share: Jets<S>,
    /// The height that replaces the rest of that depth.
    pub(super) target: Jets<S>,
    pub(super) gully: Jets<S>,
}
