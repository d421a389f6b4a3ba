//! Joins the layers at a batch of points, chunk by chunk.
//!
//! A joined height depends on the height below, on the layer's noise and on what its masks look at. Its partial
//! derivatives by these are found once for each point, and mix the gradients of each band. A mask by slope counts as
//! the same all around a point: how fast the slope itself changes would take second derivatives of everything below.

use super::lanes::{self, Masking, Output, Shaped};
use super::lanes::{CHUNK, Lane};
use super::{Band, CompiledLayer, CompiledMask, LayerStack, Source, curve, steps};
use crate::planet;
use crate::terrain::field::{Components, Field};
use crate::terrain::landform::MAX_BANDS;
use crate::terrain::points::Points;
use crate::terrain::simd::Simd;
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

/// Heights at a batch of points, with the gradients by the unit direction (metres per radian along the surface, once
/// projected onto the tangent plane).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Heights {
    pub(crate) height_m: Vec<f64>,
    /// One for each of the spacings asked for.
    pub(crate) gradients: Vec<Components>,
}

impl Heights {
    /// The lowest and the greatest height.
    pub(crate) fn range_m(&self, simd: Simd) -> (f64, f64) {
        let (mut lowest_m, mut greatest_m) = (0.0, 0.0);
        lanes::range(simd, &self.height_m, (&mut lowest_m, &mut greatest_m));
        (lowest_m, greatest_m)
    }
}

/// Joins the layers at points. `fields[i]` must be there for every needed layer, with gradients at
/// `spacings_rad` and at what its slopes need; `each(layer, heights_m)` is told the heights of a chunk of points
/// after each layer that is on.
pub(crate) fn combine(
    stack: &LayerStack,
    simd: Simd,
    points: &Points,
    fields: &[Option<Arc<Field>>],
    spacings_rad: &[f64],
    mut each: impl FnMut(usize, &[f64]),
) -> Heights {
    thread_local! {
        static SCRATCH: RefCell<Box<Scratch>> = RefCell::default();
    }
    let wanted = spacings_rad.iter().map(|&spacing_rad| Band { spacing_rad, until: usize::MAX });
    let bands: Vec<Band> = wanted.chain(stack.slope_bands.iter().copied()).take(MAX_BANDS).collect();
    let n = points.len();
    let mut heights = Heights {
        height_m: Vec::with_capacity(n),
        gradients: spacings_rad.iter().map(|_| [(); 3].map(|()| Vec::with_capacity(n))).collect(),
    };
    SCRATCH.with_borrow_mut(|scratch| {
        for start in (0..n).step_by(CHUNK) {
            let range = start..(start + CHUNK).min(n);
            let chunk = Chunk { stack, simd, points, fields, bands: &bands, shown: spacings_rad.len(), range };
            chunk.join(scratch, &mut each);
            chunk.finish(scratch);
            heights.height_m.extend_from_slice(&scratch.height[..chunk.len()]);
            for (components, lanes) in heights.gradients.iter_mut().zip(&scratch.gradients) {
                for (component, lane) in components.iter_mut().zip(lanes) {
                    component.extend_from_slice(&lane[..chunk.len()]);
                }
            }
        }
    });
    heights
}

/// Room to work in, used again and again.
struct Scratch {
    height: Lane<f64>,
    /// Of the height so far, one for each band.
    gradients: [[Lane<f32>; 3]; MAX_BANDS],
    noise: Lane<f64>,
    shaped: Shaped,
    output: Output,
    masking: Masking,
    /// What a mask looks at, where that is not kept elsewhere; the derivative of a curve.
    source: Lane<f64>,
    bent: Lane<f64>,
    /// What a band shows of steps.
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
            masking: Masking { mask: [0.0; CHUNK], step: [0.0; CHUNK], by_source: [[0.0; CHUNK]; planet::MAX_MASKS] },
            source: [0.0; CHUNK],
            bent: [0.0; CHUNK],
            seen: [0.0; CHUNK],
            dirs: [[0.0; CHUNK]; 3],
        }
    }
}

/// Some of the points, and what there is of them.
struct Chunk<'a> {
    stack: &'a LayerStack,
    simd: Simd,
    points: &'a Points,
    fields: &'a [Option<Arc<Field>>],
    bands: &'a [Band],
    /// So many of them, the first, are asked for; the rest are what masks look at.
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
    fn join(&self, scratch: &mut Scratch, each: &mut impl FnMut(usize, &[f64])) {
        let n = self.len();
        scratch.height[..n].fill(0.0);
        for lane in scratch.gradients.iter_mut().take(self.bands.len()).flatten() {
            lane[..n].fill(0.0);
        }
        if self.stack.looks_at_directions() {
            for (i, dir) in self.points.dirs[self.range.clone()].iter().enumerate() {
                (scratch.dirs[0][i], scratch.dirs[1][i], scratch.dirs[2][i]) = (dir.x, dir.y, dir.z);
            }
        }
        for (index, layer) in self.stack.layers.iter().enumerate() {
            if let (true, Some(field)) = (layer.enabled, &self.fields[index]) {
                self.add_layer(index, layer, field, scratch);
                each(index, &scratch.height[..n]);
            }
        }
    }

    fn add_layer(&self, index: usize, layer: &CompiledLayer, field: &Field, scratch: &mut Scratch) {
        let (simd, n) = (self.simd, self.len());
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

        if reshaped {
            self.reshape(layer, field, slopes, scratch);
        }
        self.mask(layer, slopes, scratch);
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
                            let source = self.fields[layer].as_ref().and_then(|field| self.gradient(field, band));
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

    /// The layer's noise as terraces and the curve leave it.
    fn reshape(&self, layer: &CompiledLayer, field: &Field, slopes: bool, scratch: &mut Scratch) {
        let (simd, n) = (self.simd, self.len());
        let Scratch { height, noise, shaped, source, bent, .. } = scratch;
        noise[..n].copy_from_slice(&field.value[self.range.clone()]);
        match &layer.steps {
            Some(cut) => steps::cut(simd, slopes, n, cut, height, noise, shaped),
            None => {
                shaped.by_noise[..n].fill(1.0);
                shaped.by_height[..n].fill(0.0);
            }
        }
        if let Some(curve) = &layer.curve {
            curve::bend(simd, n, curve, noise, bent, source);
            noise[..n].copy_from_slice(&bent[..n]);
            lanes::reshape(simd, n, source, shaped);
        }
    }

    /// The product of the layer's masks.
    fn mask(&self, layer: &CompiledLayer, slopes: bool, scratch: &mut Scratch) {
        let (simd, n) = (self.simd, self.len());
        let Scratch { height, gradients, masking, source, dirs, .. } = scratch;
        masking.mask[..n].fill(1.0);
        for (number, CompiledMask { source: looks_at, edge }) in layer.masks.iter().enumerate() {
            let source: &[f64] = match *looks_at {
                Source::Layer(layer) => match &self.fields[layer] {
                    Some(field) => &field.value[self.range.clone()],
                    None => continue,
                },
                Source::Height => &height[..n],
                Source::Slope { spacing_rad } => {
                    let band = self.bands.iter().rposition(|band| band.spacing_rad == spacing_rad).unwrap_or(0);
                    lanes::steepness(simd, n, self.stack.radius_m, dirs, &gradients[band], source);
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
        }
    }

    /// The curve over all, and limits.
    fn finish(&self, scratch: &mut Scratch) {
        let (simd, n) = (self.simd, self.len());
        let Scratch { height, gradients, source: slope, bent, .. } = scratch;
        match &self.stack.height_curve {
            Some(curve) => {
                curve::bend(simd, n, curve, height, bent, slope);
                height[..n].copy_from_slice(&bent[..n]);
            }
            None => slope[..n].fill(1.0),
        }
        lanes::limit(simd, n, self.stack.limits_m(), height, slope);
        for gradient in gradients.iter_mut().take(self.shown) {
            lanes::finish(simd, n, slope, gradient);
        }
    }
}
