//! A layer's noise and its gradient at a batch of points, before amplitude, blend and masks.
//!
//! Values hold every octave, always: the height that is drawn is the height that is queried. Gradients come in bands
//! for shading, each octave faded out as its wavelength nears the spacing of the points: a tile shows no relief that it
//! cannot carry, and next to it what its parent would show.

use super::landform::{Chunk, Landform, Scratch};
use super::noise::CHUNK;
use super::points::Points;
use super::simd::Simd;
use std::cell::RefCell;

/// Three components, each an array.
pub(crate) type Components = [Vec<f32>; 3];

/// The spacing that keeps every octave, for queries.
pub(crate) const EXACT: &[f64] = &[0.0];

/// A layer's noise at a batch of points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    /// The noise, about -1 to 1.
    pub(crate) value: Vec<f64>,
    /// Gradients by the unit direction, each with the spacing of points that can show it.
    gradients: Vec<(f64, Components)>,
}

impl Field {
    /// Evaluates a landform at points, with gradients as points so far apart (as angles) can show them; with
    /// no spacing, values alone.
    pub(crate) fn new(landform: &Landform, simd: Simd, points: &Points, spacings_rad: &[f64]) -> Field {
        Self::evaluate(landform, simd, points, spacings_rad, false)
    }

    /// The same for shading: values may lack what no spacing shows.
    pub(crate) fn seen_only(landform: &Landform, simd: Simd, points: &Points, spacings_rad: &[f64]) -> Field {
        Self::evaluate(landform, simd, points, spacings_rad, true)
    }

    fn evaluate(landform: &Landform, simd: Simd, points: &Points, spacings_rad: &[f64], seen_only: bool) -> Field {
        thread_local! {
            static SCRATCH: RefCell<Box<Scratch>> = RefCell::default();
        }
        SCRATCH.with_borrow_mut(|scratch| {
            let n = points.len();
            let mut field = Field {
                value: Vec::with_capacity(n),
                gradients: spacings_rad.iter().map(|&s| (s, [(); 3].map(|()| Vec::with_capacity(n)))).collect(),
            };
            for start in (0..n).step_by(CHUNK) {
                let end = (start + CHUNK).min(n);
                let chunk = Chunk {
                    simd,
                    skewed: [&points.x[start..end], &points.y[start..end], &points.z[start..end]],
                    dirs: &points.dirs[start..end],
                    spacings_rad,
                    seen_only,
                };
                landform.chunk(&chunk, scratch);
                field.value.extend_from_slice(&scratch.sums.value[..end - start]);
                for ((_, components), lanes) in field.gradients.iter_mut().zip(&scratch.sums.gradients) {
                    for (component, lane) in components.iter_mut().zip(lanes) {
                        component.extend_from_slice(&lane[..end - start]);
                    }
                }
            }
            field
        })
    }

    /// The gradient that points so far apart can show, if it was asked for.
    pub(crate) fn gradient(&self, spacing_rad: f64) -> Option<&Components> {
        self.gradients.iter().find(|(spacing, _)| *spacing == spacing_rad).map(|(_, components)| components)
    }

    /// Whether it has gradients for all these spacings.
    pub(crate) fn has(&self, spacings_rad: &[f64]) -> bool {
        spacings_rad.iter().all(|spacing| self.gradient(*spacing).is_some())
    }

    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        self.value.len() * (size_of::<f64>() + self.gradients.len() * size_of::<[f32; 3]>())
    }
}
