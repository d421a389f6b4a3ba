//! A layer's field: the value and gradient of its landform at a batch of points, before amplitude, blend and masks.
//!
//! Values hold every octave, whatever the spacing of the points, so that a height does not depend on who asks.
//! Gradients come in bands, one for each point spacing: an octave fades out as its wavelength nears the spacing, so
//! that a tile is not shaded by slopes that its mesh cannot show.

use super::landform::{Chunk, Landform, MAX_BANDS, Scratch};
use super::lane::CHUNK;
use super::points::Points;
use super::wet::Water;
use crate::simd::Simd;
use std::cell::RefCell;
use std::ops::Deref;

/// Three components, each an array.
pub(crate) type Components = [Vec<f32>; 3];

/// The spacing that keeps every octave, for queries.
pub(crate) const ALL_OCTAVES: &[f64] = &[0.0];

/// Point spacings (angles in radians) at which gradients are wanted: at most [`MAX_BANDS`], without allocating.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spacings {
    all: [f64; MAX_BANDS],
    count: usize,
}

impl Spacings {
    /// The first [`MAX_BANDS`] of some spacings.
    pub(crate) fn new(spacings_rad: impl Iterator<Item = f64>) -> Self {
        let mut spacings = Self::default();
        for (slot, spacing_rad) in spacings.all.iter_mut().zip(spacings_rad) {
            *slot = spacing_rad;
            spacings.count += 1;
        }
        spacings
    }
}

impl Deref for Spacings {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.all[..self.count]
    }
}

/// A landform at a batch of points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Field {
    /// The values, about -1 to 1.
    pub(crate) value: Vec<f64>,
    spacings_rad: Spacings,
    /// Gradients by the unit direction, one for each spacing; any more are spare memory.
    gradients: Vec<Components>,
    /// Water at the points. Only the structure of a planet has it, at the points of a grid.
    pub(crate) water: Vec<Water>,
}

impl PartialEq for Field {
    fn eq(&self, other: &Self) -> bool {
        *self.spacings_rad == *other.spacings_rad
            && self.value == other.value
            && self.water == other.water
            && self.spacings_rad.iter().all(|&spacing| self.gradient(spacing) == other.gradient(spacing))
    }
}

impl Field {
    /// Evaluates a landform at points, with one gradient for each spacing.
    pub(crate) fn new(landform: &Landform, simd: Simd, points: &Points, spacings_rad: &[f64]) -> Field {
        Self::evaluate(landform, simd, points, spacings_rad, false)
    }

    /// As [`Field::new`], but values omit the octaves that no band shows: for shading and coarse maps.
    pub(crate) fn seen_only(landform: &Landform, simd: Simd, points: &Points, spacings_rad: &[f64]) -> Field {
        Self::evaluate(landform, simd, points, spacings_rad, true)
    }

    fn evaluate(landform: &Landform, simd: Simd, points: &Points, spacings_rad: &[f64], seen_only: bool) -> Field {
        thread_local! {
            static SCRATCH: RefCell<Box<Scratch>> = RefCell::default();
        }
        let mut field = Field::default();
        field.reserve(points.len(), spacings_rad.len());
        SCRATCH.with_borrow_mut(|scratch| field.refill(landform, simd, points, spacings_rad, seen_only, scratch));
        field
    }

    fn reserve(&mut self, points: usize, bands: usize) {
        self.value.reserve(points);
        self.gradients.resize_with(bands.max(self.gradients.len()), Default::default);
        self.gradients[..bands].iter_mut().flatten().for_each(|component| component.reserve(points));
    }

    /// Evaluates a landform at points, in the memory that the field has.
    pub(crate) fn refill(
        &mut self,
        landform: &Landform,
        simd: Simd,
        points: &Points,
        spacings_rad: &[f64],
        seen_only: bool,
        scratch: &mut Scratch,
    ) {
        self.clear(spacings_rad);
        let n = points.len();
        for start in (0..n).step_by(CHUNK) {
            let end = (start + CHUNK).min(n);
            let chunk = Chunk {
                simd,
                skewed: [&points.x[start..end], &points.y[start..end], &points.z[start..end]],
                dirs: &points.dirs[start..end],
                point_spacing_rad: points.spacing_rad,
                spacings_rad,
                seen_only,
                squeeze: 1.0,
            };
            landform.chunk(&chunk, scratch);
            self.value.extend_from_slice(&scratch.sums.value[..end - start]);
            self.water.extend_from_slice(&scratch.sums.water);
            for (components, lanes) in self.gradients.iter_mut().zip(scratch.sums.gradients()) {
                for (component, lane) in components.iter_mut().zip(lanes) {
                    component.extend_from_slice(&lane[..end - start]);
                }
            }
        }
    }

    /// Copies the numbers of a field at some of the points to their positions among `n` points; the others become 0.
    /// Layers with masks have no water.
    pub(crate) fn scatter(&mut self, some: &Field, n: usize, is_there: impl Fn(usize) -> bool) {
        self.clear(&some.spacings_rad);
        self.value.resize(n, 0.0);
        let bands = some.spacings_rad.len();
        for (components, from) in self.gradients.iter_mut().zip(&some.gradients).take(bands) {
            for (component, from) in components.iter_mut().zip(from) {
                component.resize(n, 0.0);
                for (i, value) in (0..n).filter(|&i| is_there(i)).zip(from) {
                    component[i] = *value;
                }
            }
        }
        for (i, value) in (0..n).filter(|&i| is_there(i)).zip(&some.value) {
            self.value[i] = *value;
        }
    }

    fn clear(&mut self, spacings_rad: &[f64]) {
        self.spacings_rad = Spacings::new(spacings_rad.iter().copied());
        self.reserve(0, self.spacings_rad.len());
        self.value.clear();
        self.water.clear();
        self.gradients.iter_mut().flatten().for_each(Vec::clear);
    }

    /// The gradient of a spacing, if it was asked for.
    pub(crate) fn gradient(&self, spacing_rad: f64) -> Option<&Components> {
        let band = self.spacings_rad.iter().position(|spacing| *spacing == spacing_rad)?;
        self.gradients.get(band)
    }

    /// Whether it has gradients for all these spacings.
    pub(crate) fn has(&self, spacings_rad: &[f64]) -> bool {
        spacings_rad.iter().all(|spacing| self.gradient(*spacing).is_some())
    }

    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        self.value.len() * (size_of::<f64>() + self.spacings_rad.len() * size_of::<[f32; 3]>())
            + self.water.len() * size_of::<Water>()
    }
}
