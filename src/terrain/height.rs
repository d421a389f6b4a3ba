//! From layer fields to height: amplitude, bias, blend and masks, with the gradient carried along by the chain rule.
//!
//! No noise is evaluated here; an edit of an amplitude, a blend or a mask runs this stage alone.

use super::field::Field;
use super::landform::Landform;
use crate::planet::{Blend, Layer, Mask, Planet};
use glam::DVec3;
use std::sync::Arc;

/// A layer, ready to be evaluated and combined.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CompiledLayer {
    /// Its noise; equal shapes have equal fields, so this is the key under which a field is kept.
    pub(crate) landform: Arc<Landform>,
    /// Whether its field is needed: it is on, or a layer that is on is masked by it.
    pub(crate) needed: bool,
    enabled: bool,
    amplitude_m: f64,
    bias: f64,
    blend: Blend,
    masks: Vec<CompiledMask>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct CompiledMask {
    layer: usize,
    from: f64,
    to: f64,
    invert: bool,
}

/// Heights at a batch of points, with the gradients by the unit direction (metres per radian along the surface, once
/// projected onto the tangent plane).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Heights {
    pub(crate) height_m: Vec<f64>,
    /// One list for each of the bands asked for.
    pub(crate) gradients: Vec<Vec<DVec3>>,
}

/// Compiles the layers of a valid planet; masks that name no layer are left out.
pub(crate) fn compile(planet: &Planet) -> Vec<CompiledLayer> {
    let index_of = |name: &str| planet.layers.iter().position(|layer| layer.name == name);
    let mut layers: Vec<CompiledLayer> = planet
        .layers
        .iter()
        .map(|layer: &Layer| CompiledLayer {
            landform: Arc::new(Landform::new(
                &layer.shape,
                u64::from(planet.seed) << 32 | u64::from(layer.seed),
                planet.radius_km,
            )),
            needed: layer.enabled,
            enabled: layer.enabled,
            amplitude_m: layer.amplitude_m,
            bias: layer.bias,
            blend: layer.blend,
            masks: layer
                .masks
                .iter()
                .filter_map(|mask| {
                    let Mask::Layer(mask) = mask else { return None };
                    let layer = index_of(&mask.layer)?;
                    Some(CompiledMask { layer, from: mask.from, to: mask.to, invert: mask.invert })
                })
                .collect(),
        })
        .collect();
    let masking: Vec<usize> =
        layers.iter().filter(|l| l.enabled).flat_map(|l| l.masks.iter().map(|m| m.layer)).collect();
    for index in masking {
        layers[index].needed = true;
    }
    layers
}

/// Most bands that heights are combined in: a tile's own and its parent's.
const BANDS: usize = 2;

/// A value with its gradients in the bands.
#[derive(Clone, Copy)]
struct Dual {
    v: f64,
    d: [DVec3; BANDS],
}

impl Dual {
    const ZERO: Dual = Dual { v: 0.0, d: [DVec3::ZERO; BANDS] };
    const ONE: Dual = Dual { v: 1.0, ..Dual::ZERO };

    fn of(field: &Field, point: usize, bands: usize) -> Dual {
        let at = |c: &[Vec<f32>; 3]| DVec3::new(f64::from(c[0][point]), f64::from(c[1][point]), f64::from(c[2][point]));
        let mut dual = Dual { v: field.value[point], ..Dual::ZERO };
        for (d, gradient) in dual.d.iter_mut().zip(&field.gradients[..bands]) {
            *d = at(gradient);
        }
        dual
    }

    /// `scale * self + shift`
    fn scaled(self, scale: f64, shift: f64) -> Dual {
        Dual { v: self.v * scale + shift, d: self.d.map(|d| d * scale) }
    }

    fn plus(self, o: Dual) -> Dual {
        Dual { v: self.v + o.v, d: std::array::from_fn(|k| self.d[k] + o.d[k]) }
    }

    fn minus(self, o: Dual) -> Dual {
        self.plus(o.scaled(-1.0, 0.0))
    }

    fn times(self, o: Dual) -> Dual {
        Dual { v: self.v * o.v, d: std::array::from_fn(|k| self.d[k] * o.v + o.d[k] * self.v) }
    }

    /// Smoothstep from `from` (0) to `to` (1); the ends may stand either way round.
    fn smoothstep(self, from: f64, to: f64) -> Dual {
        let span = to - from;
        let t = ((self.v - from) / span).clamp(0.0, 1.0);
        let slope = 6.0 * t * (1.0 - t) / span;
        Dual { v: t * t * (3.0 - 2.0 * t), d: self.d.map(|d| d * slope) }
    }
}

/// Lowest and greatest height that a planet of this radius may have, so that no sum of layers turns it inside out: nine tenths
/// of the way to the centre, ten radii out.
pub(crate) fn limits_m(radius_m: f64) -> (f64, f64) {
    (-0.9 * radius_m, 10.0 * radius_m)
}

/// Joins the layers at each point of a planet of a radius. `fields[i]` must be there for every needed layer, with gradients
/// in at least the first `bands` bands; `each(layer, point, change_m)` is told what each layer that is on changes.
pub(crate) fn combine(
    layers: &[CompiledLayer],
    radius_m: f64,
    fields: &[Option<Arc<Field>>],
    points: usize,
    bands: usize,
    mut each: impl FnMut(usize, usize, f64),
) -> Heights {
    let mut heights = Heights {
        height_m: Vec::with_capacity(points),
        gradients: (0..bands).map(|_| Vec::with_capacity(points)).collect(),
    };
    let (lowest_m, highest_m) = limits_m(radius_m);
    for point in 0..points {
        let mut height = Dual::ZERO;
        for (index, layer) in layers.iter().enumerate() {
            let (true, Some(field)) = (layer.enabled, &fields[index]) else { continue };
            let noise = Dual::of(field, point, bands).scaled(1.0, layer.bias);
            let mut mask = Dual::ONE;
            for m in &layer.masks {
                let Some(masking) = &fields[m.layer] else { continue };
                let step = Dual::of(masking, point, bands).smoothstep(m.from, m.to);
                mask = mask.times(if m.invert { step.scaled(-1.0, 1.0) } else { step });
            }
            let output = noise.scaled(layer.amplitude_m, 0.0);
            let target = match layer.blend {
                Blend::Add => height.plus(output),
                Blend::Subtract => height.minus(output),
                Blend::Multiply => height.times(noise),
                Blend::SmoothMax | Blend::SmoothMin => height,
                Blend::Max if output.v > height.v => output,
                Blend::Min if output.v < height.v => output,
                Blend::Max | Blend::Min => height,
                Blend::Replace => output,
            };
            let joined = if layer.masks.is_empty() { target } else { height.plus(target.minus(height).times(mask)) };
            each(index, point, joined.v - height.v);
            height = joined;
        }
        if height.v < lowest_m || height.v > highest_m {
            height = Dual { v: height.v.clamp(lowest_m, highest_m), ..Dual::ZERO };
        }
        heights.height_m.push(height.v);
        for (list, d) in heights.gradients.iter_mut().zip(height.d) {
            list.push(d);
        }
    }
    heights
}

/// Bounds of the height over the whole planet: each layer's noise may be anywhere in its range. Conservative.
pub(crate) fn bounds_m(layers: &[CompiledLayer], radius_m: f64) -> (f64, f64) {
    let (mut lo, mut hi) = (0.0_f64, 0.0_f64);
    for layer in layers.iter().filter(|layer| layer.enabled) {
        let (v_lo, v_hi) = layer.landform.bounds();
        let (v_lo, v_hi) = (v_lo + layer.bias, v_hi + layer.bias);
        let (y_lo, y_hi) = (v_lo * layer.amplitude_m, v_hi * layer.amplitude_m);
        let (new_lo, new_hi) = match layer.blend {
            Blend::Add => (lo + y_lo, hi + y_hi),
            Blend::Subtract => (lo - y_hi, hi - y_lo),
            Blend::Multiply => {
                let corners = [lo * v_lo, lo * v_hi, hi * v_lo, hi * v_hi];
                (corners.iter().copied().fold(f64::MAX, f64::min), corners.iter().copied().fold(f64::MIN, f64::max))
            }
            Blend::Max => (lo.max(y_lo), hi.max(y_hi)),
            Blend::Min => (lo.min(y_lo), hi.min(y_hi)),
            Blend::Replace => (y_lo, y_hi),
            Blend::SmoothMax | Blend::SmoothMin => (lo, hi),
        };
        // A mask can leave what was there.
        (lo, hi) = if layer.masks.is_empty() { (new_lo, new_hi) } else { (lo.min(new_lo), hi.max(new_hi)) };
    }
    let (lowest_m, highest_m) = limits_m(radius_m);
    (lo.clamp(lowest_m, highest_m), hi.clamp(lowest_m, highest_m))
}
