//! Joins the layers at a batch of points, chunk by chunk.
//!
//! A joined height depends on the height below, on the layer's noise and on the sources of its masks. Its partial
//! derivatives by these are found once for each point and mix the gradients of every band. A slope mask counts as
//! constant around a point: the derivative of the slope would take second derivatives of everything below.

use super::lanes::{self, Masking, Output, Shaped};
use super::lanes::{CHUNK, Lane};
use super::{Band, CompiledCurve, CompiledLayer, CompiledMask, LayerStack, MOST_MASKS, Source, curve, steps};
use crate::planet;
use crate::simd::Simd;
use crate::terrain::field::{Components, Field};
use crate::terrain::landform::MAX_BANDS;
use crate::terrain::points::Points;
use crate::terrain::wet::Water;
use glam::DVec3;
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

/// Heights at a batch of points, with gradients by the unit direction (metres per radian along the ground, once
/// projected onto the tangent plane).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Heights {
    pub(crate) height_m: Vec<f64>,
    /// One for each of the spacings asked for.
    pub(crate) gradients: Vec<Components>,
    /// Water over the ground, at the points of a grid; empty without a structure.
    pub(crate) water: Vec<Water>,
}

impl Heights {
    /// The lowest and the greatest height.
    pub(crate) fn range_m(&self, simd: Simd) -> (f64, f64) {
        let (mut lowest_m, mut greatest_m) = (0.0, 0.0);
        lanes::range(simd, &self.height_m, (&mut lowest_m, &mut greatest_m));
        (lowest_m, greatest_m)
    }

    /// Raises the ground to the water that stands or flows on it, and levels its slopes there. `dirs`: the points, a
    /// grid `spacing_rad` apart. Without a structure nothing happens.
    pub(crate) fn flood(&mut self, dirs: &[DVec3], spacing_rad: f64, sea_m: Option<f64>) {
        for (i, (water, dir)) in std::mem::take(&mut self.water).iter().zip(dirs).enumerate() {
            let by_dir = self.gradients.first().map_or(DVec3::ZERO, |gradient| {
                DVec3::from_array(gradient.each_ref().map(|component| f64::from(component[i])))
            });
            let along = by_dir - *dir * dir.dot(by_dir);
            let wet = water.over(self.height_m[i], along.length() * spacing_rad, sea_m);
            self.height_m[i] += wet.rise_m;
            if wet.slope < 1.0 {
                for component in self.gradients.iter_mut().flatten() {
                    component[i] *= wet.slope as f32;
                }
            }
        }
    }

    /// Makes room for a batch without giving memory back, so that nothing is allocated for the next batch.
    fn clear(&mut self, points: usize, bands: usize) {
        self.height_m.clear();
        self.water.clear();
        self.height_m.reserve(points);
        self.gradients.resize_with(bands.max(self.gradients.len()), Default::default);
        self.gradients.iter_mut().flatten().for_each(Vec::clear);
        self.gradients[..bands].iter_mut().flatten().for_each(|component| component.reserve(points));
    }
}

/// The fields of the layers at one batch of points: kept ones, or ones evaluated when they are asked for.
pub(crate) trait LayerFields {
    /// Makes sure that the field of a layer is there wherever `mask` is not 0; without a mask, at all points. A source
    /// that evaluates fields here is only used for batches of one chunk.
    fn prepare(&mut self, layer: usize, mask: Option<&[f64]>);

    /// The field of a layer that was prepared. Where the mask was 0 its numbers mean nothing.
    fn field(&self, layer: usize) -> Option<&Field>;

    /// Hears of the numbers that the curve of a layer is about to bend, after `prepare` for that layer.
    fn bends(&mut self, _layer: usize, _noise: &[f64]) {}
}

/// Fields that are there already.
pub(crate) struct Kept<'a>(pub(crate) &'a [Option<Arc<Field>>]);

impl LayerFields for Kept<'_> {
    fn prepare(&mut self, _layer: usize, _mask: Option<&[f64]>) {}

    fn field(&self, layer: usize) -> Option<&Field> {
        self.0.get(layer)?.as_deref()
    }
}

/// Joins the layers at points. `fields[i]` must be there for every needed layer, with gradients at `spacings_rad` and
/// at the spacings of its slope masks; `each(layer, heights_m)` is told the heights of a chunk after each enabled
/// layer.
pub(crate) fn combine(
    stack: &LayerStack,
    simd: Simd,
    points: &Points,
    fields: &[Option<Arc<Field>>],
    spacings_rad: &[f64],
    each: impl FnMut(usize, &[f64]),
) -> Heights {
    thread_local! {
        static SCRATCH: RefCell<Box<Scratch>> = RefCell::default();
    }
    let mut heights = Heights::default();
    SCRATCH.with_borrow_mut(|scratch| {
        let batch = Batch { stack, simd, points, spacings_rad };
        batch.join(&mut Kept(fields), scratch, &mut heights, each);
    });
    heights
}

/// A batch of points whose layers are to be joined.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    pub(crate) stack: &'a LayerStack,
    pub(crate) simd: Simd,
    pub(crate) points: &'a Points,
    /// One gradient is wanted for each.
    pub(crate) spacings_rad: &'a [f64],
}

impl Batch<'_> {
    /// As [`combine`], with fields from any source and memory that is used again.
    pub(crate) fn join(
        &self,
        fields: &mut impl LayerFields,
        scratch: &mut Scratch,
        heights: &mut Heights,
        mut each: impl FnMut(usize, &[f64]),
    ) {
        let wanted = self.spacings_rad.iter().map(|&spacing_rad| Band { spacing_rad, until: usize::MAX });
        let mut bands = [Band { spacing_rad: 0.0, until: 0 }; MAX_BANDS];
        let mut count = 0;
        for (slot, band) in bands.iter_mut().zip(wanted.chain(self.stack.slope_bands.iter().copied())) {
            *slot = band;
            count += 1;
        }
        let n = self.points.len();
        heights.clear(n, self.spacings_rad.len());
        for start in (0..n).step_by(CHUNK) {
            let range = start..(start + CHUNK).min(n);
            let chunk = Chunk { batch: *self, bands: &bands[..count], shown: self.spacings_rad.len(), range };
            chunk.join(fields, scratch, &mut each);
            chunk.finish(scratch);
            heights.height_m.extend_from_slice(&scratch.height[..chunk.len()]);
            for (components, lanes) in heights.gradients.iter_mut().zip(&scratch.gradients).take(chunk.shown) {
                for (component, lane) in components.iter_mut().zip(lanes) {
                    component.extend_from_slice(&lane[..chunk.len()]);
                }
            }
        }
        if self.stack.has_structure
            && let Some(field) = fields.field(0)
        {
            heights.water.extend_from_slice(&field.water);
            if self.stack.height_curve.is_some() {
                for (water, &height_m) in heights.water.iter_mut().zip(&field.value) {
                    *water = water.bent(height_m, |height_m| self.stack.bent_m(height_m));
                }
            }
        }
    }
}

/// Memory for one chunk, used again and again.
pub(crate) struct Scratch {
    height: Lane<f64>,
    /// Of the height so far, one for each band.
    gradients: [[Lane<f32>; 3]; MAX_BANDS],
    noise: Lane<f64>,
    shaped: Shaped,
    output: Output,
    masking: Masking,
    /// The source of a mask that is stored nowhere else; the derivative of a curve.
    source: Lane<f64>,
    bent: Lane<f64>,
    /// The share of steps that a band shows.
    seen: Lane<f32>,
    dirs: [Lane<f64>; 3],
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            height: [0.0; CHUNK],
            gradients: [[[0.0; CHUNK]; 3]; MAX_BANDS],
            noise: [0.0; CHUNK],
            shaped: Shaped { by_noise: [0.0; CHUNK], by_height: [0.0; CHUNK] },
            output: Output {
                target: [0.0; CHUNK],
                by_height: [0.0; CHUNK],
                by_noise: [0.0; CHUNK],
                by_steps: [0.0; CHUNK],
            },
            masking: Masking { mask: [0.0; CHUNK], step: [0.0; CHUNK], by_source: [[0.0; CHUNK]; MOST_MASKS] },
            source: [0.0; CHUNK],
            bent: [0.0; CHUNK],
            seen: [0.0; CHUNK],
            dirs: [[0.0; CHUNK]; 3],
        }
    }
}

/// Some of the points of a batch.
struct Chunk<'a> {
    batch: Batch<'a>,
    bands: &'a [Band],
    /// How many of the bands, the first, are asked for; the others serve slope masks.
    shown: usize,
    range: Range<usize>,
}

impl Chunk<'_> {
    fn len(&self) -> usize {
        self.range.len()
    }

    /// The gradient of a field in a band.
    fn gradient<'f>(&self, field: &'f Field, band: &Band) -> Option<[&'f [f32]; 3]> {
        let [x, y, z] = field.gradient(band.spacing_rad)?;
        Some([&x[self.range.clone()], &y[self.range.clone()], &z[self.range.clone()]])
    }

    /// Heights and gradients after all layers.
    fn join(&self, fields: &mut impl LayerFields, scratch: &mut Scratch, each: &mut impl FnMut(usize, &[f64])) {
        let (n, stack) = (self.len(), self.batch.stack);
        scratch.height[..n].fill(0.0);
        for lane in scratch.gradients.iter_mut().take(self.bands.len()).flatten() {
            lane[..n].fill(0.0);
        }
        if stack.looks_at_directions {
            for (i, dir) in self.batch.points.dirs[self.range.clone()].iter().enumerate() {
                (scratch.dirs[0][i], scratch.dirs[1][i], scratch.dirs[2][i]) = (dir.x, dir.y, dir.z);
            }
        }
        for (index, layer) in stack.layers.iter().enumerate().filter(|(_, layer)| layer.enabled) {
            self.add_layer(index, layer, fields, scratch);
            each(index, &scratch.height[..n]);
        }
    }

    fn add_layer(&self, index: usize, layer: &CompiledLayer, fields: &mut impl LayerFields, scratch: &mut Scratch) {
        let (simd, n) = (self.batch.simd, self.len());
        let bands = || self.bands.iter().enumerate().filter(|(_, band)| band.until > index);
        let reshaped = layer.steps.is_some() || layer.curve.is_some();
        // The gradient of a plain sum needs no derivatives at each point.
        let plain = !reshaped && layer.masks.is_empty();
        let scale = match layer.blend.kind {
            planet::Blend::Add if plain => Some(layer.blend.amplitude_m),
            planet::Blend::Subtract if plain => Some(-layer.blend.amplitude_m),
            _ => None,
        };
        let slopes = scale.is_none() && bands().next().is_some();

        if !self.mask(layer, slopes, fields, scratch) {
            return;
        }
        fields.prepare(index, (!layer.masks.is_empty()).then_some(&scratch.masking.mask[..n]));
        if reshaped {
            let Some(field) = fields.field(index) else { return };
            self.cut_steps(layer, field, slopes, scratch);
        }
        if let Some(curve) = &layer.curve {
            fields.bends(index, &scratch.noise[..n]);
            self.bend(curve, scratch);
        }
        let Some(field) = fields.field(index) else { return };
        let Scratch { height, gradients, noise, shaped, output, masking, seen, dirs, .. } = scratch;
        let noise: &[f64] = if reshaped { &noise[..n] } else { &field.value[self.range.clone()] };
        lanes::blend(simd, slopes, n, &layer.blend, height, noise, output);
        if layer.masks.is_empty() {
            height[..n].copy_from_slice(&output.target[..n]);
        } else {
            lanes::join(simd, slopes, n, layer.masks.len(), masking, output, height);
        }

        if let Some(scale) = scale {
            for (number, band) in bands() {
                if let Some(noise) = self.gradient(field, band) {
                    lanes::add_scaled(simd, n, scale as f32, &noise, &mut gradients[number]);
                }
            }
        } else if slopes {
            if reshaped {
                lanes::through(simd, n, shaped, output);
            }
            for (mask, by_source) in layer.masks.iter().zip(&mut masking.by_source) {
                match mask.source {
                    Source::Height => lanes::add(simd, n, by_source, &mut output.by_height),
                    Source::Latitude { both: true } => lanes::mirror(simd, n, &dirs[2], by_source),
                    _ => {}
                }
            }
            for (number, band) in bands() {
                let gradient = &mut gradients[number];
                if let Some(noise) = self.gradient(field, band) {
                    // Masks make heights, and those do not depend on what can be seen.
                    match layer.steps.as_ref().filter(|_| number < self.shown) {
                        Some(cut) => {
                            steps::seen(simd, n, (cut, band.spacing_rad), dirs, gradient, &noise, seen);
                            steps::mix(simd, n, seen, output, &noise, gradient);
                        }
                        None => lanes::mix(simd, n, output, &noise, gradient),
                    }
                }
                for (mask, by_source) in layer.masks.iter().zip(&masking.by_source) {
                    match mask.source {
                        Source::Layer(layer) => {
                            let source = fields.field(layer).and_then(|field| self.gradient(field, band));
                            if let Some(source) = source {
                                lanes::add_source(simd, n, by_source, &source, gradient);
                            }
                        }
                        Source::Latitude { .. } => lanes::add(simd, n, by_source, &mut gradient[2]),
                        Source::Height | Source::Slope { .. } => {}
                    }
                }
            }
        }
    }

    /// The layer's noise as terraces leave it.
    fn cut_steps(&self, layer: &CompiledLayer, field: &Field, slopes: bool, scratch: &mut Scratch) {
        let (simd, n) = (self.batch.simd, self.len());
        let Scratch { height, noise, shaped, .. } = scratch;
        noise[..n].copy_from_slice(&field.value[self.range.clone()]);
        match &layer.steps {
            Some(cut) => steps::cut(simd, slopes, n, cut, height, noise, shaped),
            None => {
                shaped.by_noise[..n].fill(1.0);
                shaped.by_height[..n].fill(0.0);
            }
        }
    }

    /// That noise as the layer's curve leaves it.
    fn bend(&self, curve: &CompiledCurve, scratch: &mut Scratch) {
        let (simd, n) = (self.batch.simd, self.len());
        let Scratch { noise, shaped, source, bent, .. } = scratch;
        curve::bend(simd, n, curve, noise, bent, source);
        noise[..n].copy_from_slice(&bent[..n]);
        lanes::reshape(simd, n, source, shaped);
    }

    /// The product of the layer's masks. False if the layer changes nothing here, because the product is 0 everywhere:
    /// then its noise is not needed, nor the sources of the masks that remain.
    fn mask(&self, layer: &CompiledLayer, slopes: bool, fields: &mut impl LayerFields, scratch: &mut Scratch) -> bool {
        let (simd, n) = (self.batch.simd, self.len());
        let Scratch { height, gradients, masking, source, dirs, .. } = scratch;
        // Adding 0 would turn a height of -0 into one of 0.
        let keeps_bits = height[..n].iter().all(|h| *h != 0.0 || h.is_sign_positive());
        masking.mask[..n].fill(1.0);
        for (number, CompiledMask { source: looks_at, edge }) in layer.masks.iter().enumerate() {
            let source: &[f64] = match *looks_at {
                Source::Layer(layer) => {
                    fields.prepare(layer, None);
                    match fields.field(layer) {
                        Some(field) => &field.value[self.range.clone()],
                        None => continue,
                    }
                }
                Source::Height => &height[..n],
                Source::Slope { spacing_rad } => {
                    let band = self.bands.iter().rposition(|band| band.spacing_rad == spacing_rad).unwrap_or(0);
                    lanes::steepness(simd, n, self.batch.stack.radius_m, dirs, &gradients[band], source);
                    &source[..n]
                }
                Source::Latitude { both: false } => &dirs[2][..n],
                Source::Latitude { both: true } => {
                    for (sine, z) in source.iter_mut().zip(&dirs[2][..n]) {
                        *sine = z.abs();
                    }
                    &source[..n]
                }
            };
            lanes::mask(simd, slopes, n, edge, number, source, masking);
            if keeps_bits && masking.mask[..n].iter().all(|mask| *mask == 0.0) {
                return false;
            }
        }
        true
    }

    /// The curve over all, and limits.
    fn finish(&self, scratch: &mut Scratch) {
        let (simd, n) = (self.batch.simd, self.len());
        let Scratch { height, gradients, source: slope, bent, .. } = scratch;
        match &self.batch.stack.height_curve {
            Some(curve) => {
                curve::bend(simd, n, curve, height, bent, slope);
                height[..n].copy_from_slice(&bent[..n]);
            }
            None => slope[..n].fill(1.0),
        }
        lanes::limit(simd, n, self.batch.stack.limits_m(), height, slope);
        for gradient in gradients.iter_mut().take(self.shown) {
            lanes::finish(simd, n, slope, gradient);
        }
    }
}
