//! Heights on a grid of far-apart points, without what such points cannot show.
//!
//! The fields of the layers are kept from one planet to the next, as those of tiles are: an edit of an amplitude, a blend
//! or a mask evaluates no noise here either, and one of a layer's shape that layer alone.

use super::field::Field;
use super::height::{self, CompiledLayer, LayerStack};
use super::kept::KeptFields;
use super::points::Points;
use super::simd::Simd;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;

/// The fields behind the heights, batch by batch.
#[derive(Clone, Debug, Default)]
pub(crate) struct CoarseFields {
    batches: Vec<KeptFields>,
    /// Octaves of noise times points that were evaluated for them, beyond what was there before.
    pub(crate) octave_samples: usize,
}

impl CoarseFields {
    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        self.batches.iter().map(KeptFields::bytes).sum()
    }

    /// Forgets the fields.
    pub(crate) fn forget(&mut self) {
        self.batches.clear();
    }

    /// The same, for which nothing had to be evaluated.
    pub(crate) fn as_known(&self) -> Self {
        Self { octave_samples: 0, ..self.clone() }
    }
}

/// Heights at batches of points `spacing_rad` apart, in order, and the fields they are made of; on all cores. Fields that
/// `before` has are taken from there: it must be of the same points and spacing.
pub(crate) fn coarse_heights_m(
    stack: &LayerStack,
    simd: Simd,
    batches: &[Points],
    spacing_rad: f64,
    before: Option<&CoarseFields>,
) -> (Vec<f64>, CoarseFields) {
    let now = Instant::now();
    let batch = |(number, points): (usize, &Points)| {
        let mut kept = before.and_then(|before| before.batches.get(number)).cloned().unwrap_or_default();
        let mut octave_samples = 0;
        let mut field = |layer: &CompiledLayer| {
            let spacings_rad = layer.spacings_rad(&[spacing_rad]);
            kept.find(&layer.landform, &spacings_rad).unwrap_or_else(|| {
                octave_samples += layer.landform.octave_count() * points.len();
                Arc::new(Field::seen_only(&layer.landform, simd, points, &spacings_rad))
            })
        };
        let fields: Vec<_> = stack.layers.iter().map(|layer| layer.needed.then(|| field(layer))).collect();
        let heights = height::combine(stack, simd, points, &fields, &[], |_, _| {});
        kept.adopt(&stack.layers, &fields, now);
        (heights.height_m, kept, octave_samples)
    };
    let found: Vec<(Vec<f64>, KeptFields, usize)> = batches.par_iter().enumerate().map(batch).collect();
    let (mut heights_m, mut coarse) = (Vec::new(), CoarseFields::default());
    for (of_batch_m, kept, octave_samples) in found {
        heights_m.extend(of_batch_m);
        coarse.batches.push(kept);
        coarse.octave_samples += octave_samples;
    }
    (heights_m, coarse)
}
