//! The ground as world maps read it: heights of the layers at far-apart points, without detail that such points cannot
//! show and without biome relief.
//!
//! The fields of the layers are kept from one revision to the next, as those of tiles are. An edit of an amplitude, a
//! blend or a mask evaluates no noise here, and an edit of a layer's shape that layer alone.

use super::edits::Edits;
use super::field::Field;
use super::height::{self, CompiledLayer, LayerStack};
use super::kept::KeptFields;
use super::points::Points;
use crate::simd::Simd;
use crate::world::cells::Cells;
use crate::world::{DrawnCourse, Ground, Inputs, KeepGoing, Sculpted};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Points evaluated at a time: few enough for the fields of all layers to stay in the second-level cache.
const BATCH: usize = 768;

/// The layer fields at the cells of world maps, kept for the next revision.
#[derive(Debug, Default)]
pub(crate) struct CellFields {
    /// Batch by batch, for each side of a cube of cells.
    sides: Mutex<BTreeMap<usize, Vec<KeptFields>>>,
    octave_samples: AtomicUsize,
}

impl CellFields {
    fn lock(&self) -> MutexGuard<'_, BTreeMap<usize, Vec<KeptFields>>> {
        self.sides.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        self.lock().values().flatten().map(KeptFields::bytes).sum()
    }

    /// Drops all fields.
    pub(crate) fn clear(&self) {
        self.lock().clear();
    }

    /// Octaves of noise times points evaluated since the last call.
    pub(crate) fn take_octave_samples(&self) -> usize {
        self.octave_samples.swap(0, Ordering::Relaxed)
    }
}

/// The layers of a planet as world maps read them.
pub(crate) struct LayerGround<'a> {
    pub(crate) inputs: &'a Inputs,
    pub(crate) stack: &'a LayerStack,
    pub(crate) under: Option<&'a LayerStack>,
    pub(crate) edits: Option<&'a Edits>,
    pub(crate) simd: Simd,
    /// Where fields are taken from and kept.
    pub(crate) fields: &'a CellFields,
}

impl Ground for LayerGround<'_> {
    fn inputs(&self) -> &Inputs {
        self.inputs
    }

    fn heights_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
        self.heights_of(self.stack, cells, keep_going)
    }

    fn under_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
        match self.under {
            Some(under) => self.heights_of(under, cells, keep_going),
            None => Some(vec![0.0; cells.dirs.len()]),
        }
    }

    fn sculpted(&self, cells: &Cells) -> Option<Sculpted> {
        self.edits?.sculpted(&cells.dirs)
    }

    fn courses(&self) -> &[DrawnCourse] {
        self.edits.map_or(&[], Edits::courses)
    }
}

impl LayerGround<'_> {
    fn heights_of(&self, stack: &LayerStack, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
        let mut kept = self.fields.lock().remove(&cells.side).unwrap_or_default();
        kept.resize_with(cells.dirs.len().div_ceil(BATCH), KeptFields::default);
        let batches = cells.dirs.par_chunks(BATCH).zip(&mut kept);
        let heights_m = batches.map(|(dirs, kept)| {
            keep_going().then(|| {
                let points = Points::spaced(dirs.to_vec(), cells.spacing_rad());
                self.batch_heights_m(stack, &points, kept)
            })
        });
        let heights_m: Option<Vec<Vec<f64>>> = heights_m.collect();
        self.fields.lock().insert(cells.side, kept);
        heights_m.map(|batches| batches.concat())
    }

    fn batch_heights_m(&self, stack: &LayerStack, points: &Points, kept: &mut KeptFields) -> Vec<f64> {
        let spacing_rad = points.spacing_rad;
        let field = |layer: &CompiledLayer| {
            let spacings_rad = layer.spacings_rad(&[spacing_rad]);
            kept.find(&layer.landform, &spacings_rad).unwrap_or_else(|| {
                let octave_samples = layer.landform.octave_count() * points.len();
                self.fields.octave_samples.fetch_add(octave_samples, Ordering::Relaxed);
                Arc::new(Field::seen_only(&layer.landform, self.simd, points, &spacings_rad))
            })
        };
        let layers = &stack.layers;
        let fields: Vec<_> = layers.iter().map(|layer| layer.needed.then(|| field(layer))).collect();
        kept.adopt(layers, &fields, Instant::now());
        height::combine(stack, self.simd, points, &fields, &[], |_, _| {}).height_m
    }
}
