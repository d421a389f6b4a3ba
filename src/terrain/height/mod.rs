//! From layer fields to height: amplitude, bias, curves, blends and masks, with gradients by the chain rule.
//!
//! - [`LayerStack`]: the layers of a planet, compiled
//! - `join`: heights at a batch of points, chunk by chunk; `lanes`: its loops
//! - `steps`: terraces
//! - `curve`: curves through points
//! - `bounds`: the range of heights
//!
//! No noise is evaluated here: an edit of an amplitude, a blend or a mask runs this stage alone. A slope mask needs
//! more: the gradients of the layers before it at the spacing `over_m`, whatever tile or query asks.

mod bounds;
mod curve;
mod join;
mod lanes;
mod steps;

pub use curve::curve_at;
pub(crate) use join::{Batch, Heights, LayerFields, Scratch, combine};

use super::edits::{Edits, MaskId};
use super::field::Spacings;
use super::landform::{Landform, Maps, Reads};
use crate::planet::{self, Key, Layer, MAX_MASKS, Mask, Planet, Shape};
use crate::world::carved::Carved;
use curve::CompiledCurve;
use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

/// The layers of a planet, compiled.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LayerStack {
    /// With a structure, the first one is its carved ground; the layers of the preset follow, and after these the masks
    /// that are painted by hand and, with a structure, its riversides, as layers that are off.
    pub(crate) layers: Vec<CompiledLayer>,
    has_structure: bool,
    /// The spacings over which slope masks measure.
    slope_bands: Vec<Band>,
    height_curve: Option<CompiledCurve>,
    /// Whether a layer reads the direction itself: terraces, and masks by slope or latitude.
    looks_at_directions: bool,
    radius_m: f64,
}

/// A layer, compiled.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CompiledLayer {
    /// Its noise. Equal landforms have equal fields, so this is the key of a kept field.
    pub(crate) landform: Arc<Landform>,
    /// Whether its field is needed: it is enabled, or an enabled layer is masked by it.
    pub(crate) needed: bool,
    /// Whether an enabled layer is masked by it.
    pub(crate) masks_others: bool,
    /// Spacings of the gradients that slope masks need of its field.
    slope_spacings_rad: Vec<f64>,
    enabled: bool,
    steps: Option<Steps>,
    curve: Option<CompiledCurve>,
    blend: Blend,
    masks: Vec<CompiledMask>,
}

/// The gradients of one spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Band {
    spacing_rad: f64,
    /// They are needed up to this layer.
    until: usize,
}

/// How a layer joins the height below it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Blend {
    kind: planet::Blend,
    bias: f64,
    amplitude_m: f64,
    softness_m: f64,
}

/// How terraces are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Steps {
    height_m: f64,
    sharpness: f64,
    waviness: f64,
}

/// A smoothstep of a source.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CompiledMask {
    source: Source,
    edge: Edge,
}

/// What a mask is a function of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// The noise of a layer.
    Layer(usize),
    /// The height so far, metres.
    Height,
    /// The sine of the slope so far, measured over this spacing.
    Slope { spacing_rad: f64 },
    /// The sine of the latitude; its absolute value if both hemispheres are alike.
    Latitude { both: bool },
}

/// From 0 at `from` to 1 at `to`, which may be the lesser.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    from: f64,
    to: f64,
    invert: bool,
}

/// Most masks of a layer: those of the preset, and the riversides.
const MOST_MASKS: usize = MAX_MASKS + 1;

/// Smallest height of a step and of a soft corner.
const LEAST_M: f64 = 1e-3;

impl LayerStack {
    /// Compiles the layers of a valid planet. Masks that name no layer are left out.
    pub(crate) fn new(planet: &Planet, edits: Option<&Arc<Edits>>) -> Self {
        let has_structure = planet.structure.is_some();
        let mut layers: Vec<CompiledLayer> = Vec::new();
        layers.extend(has_structure.then(CompiledLayer::structure));
        layers.extend(planet.layers.iter().map(|layer| {
            let compiled = CompiledLayer::new(planet, layer);
            CompiledLayer { enabled: layer.enabled && !(has_structure && layer.under), ..compiled }
        }));
        layers.extend(painted_masks(planet).map(|mask| CompiledLayer::painted(mask, edits)));
        layers.extend(has_structure.then(CompiledLayer::riverside));
        Self::of(planet, layers, has_structure, CompiledCurve::new(&planet.height_curve))
    }

    /// Compiles the layers that lie under the structure of a planet. None if there are none.
    pub(crate) fn under(planet: &Planet, edits: Option<&Arc<Edits>>) -> Option<Self> {
        let is_under = |layer: &Layer| layer.enabled && layer.under;
        planet.structure.as_ref()?;
        planet.layers.iter().find(|layer| is_under(layer))?;
        let compiled = |layer| CompiledLayer { enabled: is_under(layer), ..CompiledLayer::new(planet, layer) };
        let masks = painted_masks(planet).map(|mask| CompiledLayer::painted(mask, edits));
        Some(Self::of(planet, planet.layers.iter().map(compiled).chain(masks).collect(), false, None))
    }

    fn of(
        planet: &Planet,
        mut layers: Vec<CompiledLayer>,
        has_structure: bool,
        height_curve: Option<CompiledCurve>,
    ) -> Self {
        if has_structure {
            // Masks know layers by their places in the preset.
            for mask in layers.iter_mut().flat_map(|layer| &mut layer.masks) {
                if let Source::Layer(layer) = &mut mask.source {
                    *layer += 1;
                }
            }
            let riverside = Source::Layer(layers.len() - 1);
            for layer in layers.iter_mut().skip(1).take(planet.layers.len()) {
                layer.masks.push(CompiledMask { source: riverside, edge: Edge { from: 0.0, to: 1.0, invert: false } });
            }
        }
        let radius_m = planet.radius_m();
        let mut stack =
            Self { layers, has_structure, slope_bands: Vec::new(), height_curve, looks_at_directions: false, radius_m };
        stack.find_slope_bands();
        stack.find_needed();
        stack.looks_at_directions = stack.layers.iter().any(CompiledLayer::looks_at_directions);
        stack
    }

    /// Sets the carved ground of a planet that has a structure.
    pub(crate) fn set_structure(&mut self, carved: Option<(Key, &Carved)>) {
        if let [first, .., last] = &mut *self.layers
            && self.has_structure
        {
            first.landform = Arc::new(Landform::structure(carved));
            last.landform = Arc::new(Landform::riverside(carved));
        }
    }

    /// The place of the riversides among the layers. None without a structure.
    pub(crate) fn riverside(&self) -> Option<usize> {
        self.layers.len().checked_sub(1).filter(|_| self.has_structure)
    }

    /// A height of the structure as the curve over all heights leaves it, metres.
    pub(crate) fn bent_m(&self, height_m: f64) -> f64 {
        self.height_curve.as_ref().map_or(height_m, |curve| curve.at(height_m).0)
    }

    /// Hands world maps to the layers that read them.
    pub(crate) fn set_maps(&mut self, maps: &Maps<'_>) {
        for layer in &mut self.layers {
            if let Some(landform) = layer.landform.with_maps(maps) {
                layer.landform = Arc::new(landform);
            }
        }
    }

    /// Which world maps the layers that are needed read, besides those of the structure.
    pub(crate) fn reads(&self) -> Reads {
        let each = self.layers.iter().filter(|layer| layer.needed).map(|layer| layer.landform.reads());
        each.fold(Reads::default(), |all, one| Reads {
            plates: all.plates || one.plates,
            weather: all.weather || one.weather,
        })
    }

    /// The key of the paint of the masks that layers read. None if there is none, or if no layer reads it.
    pub(crate) fn painted_key(&self) -> Option<Key> {
        self.layers.iter().filter(|layer| layer.needed).find_map(|layer| layer.landform.painted_key())
    }

    /// How many layers stand before those of the preset.
    pub(crate) fn layers_before(&self) -> usize {
        usize::from(self.has_structure)
    }

    /// Content keys of the fields that are needed, with the spacings of their gradients.
    pub(crate) fn field_keys(&self) -> impl Iterator<Item = Key> {
        self.layers.iter().filter(|layer| layer.needed).map(CompiledLayer::field_key)
    }

    /// Everything that heights follow from but paint of masks, to be hashed. Layers that are not needed leave only a
    /// gap, so that masks by index still tell layers apart.
    pub(crate) fn joined(&self) -> impl fmt::Debug {
        let layers: Vec<_> = self.layers.iter().map(|layer| layer.needed.then(|| Key::of(layer))).collect();
        (layers, self.slope_bands.clone(), self.height_curve.clone(), self.radius_m)
    }

    /// Finds the spacings of slope masks, and the layers below the last mask of each.
    fn find_slope_bands(&mut self) {
        for (until, layer) in self.layers.iter().enumerate().filter(|(_, layer)| layer.enabled) {
            for mask in &layer.masks {
                let Source::Slope { spacing_rad } = mask.source else { continue };
                match self.slope_bands.iter_mut().find(|band| band.spacing_rad == spacing_rad) {
                    Some(band) => band.until = until,
                    None => self.slope_bands.push(Band { spacing_rad, until }),
                }
            }
        }
    }

    /// Finds which fields are needed, and the spacings of their gradients.
    fn find_needed(&mut self) {
        if let Some(riverside) = self.riverside() {
            // Biome relief stands aside for rivers, too.
            self.layers[riverside].needed = true;
            self.layers[riverside].masks_others = true;
        }
        for index in 0..self.layers.len() {
            let layer = &self.layers[index];
            if !layer.enabled {
                continue;
            }
            let masking = layer.masks.iter().filter_map(|mask| match mask.source {
                Source::Layer(layer) => Some(layer),
                _ => None,
            });
            let needed: Vec<usize> = std::iter::once(index).chain(masking).collect();
            for needed in needed {
                let layer = &mut self.layers[needed];
                layer.needed = true;
                layer.masks_others |= needed != index;
                for band in self.slope_bands.iter().filter(|band| band.until > index) {
                    if !layer.slope_spacings_rad.contains(&band.spacing_rad) {
                        layer.slope_spacings_rad.push(band.spacing_rad);
                    }
                }
            }
        }
    }

    /// Lowest and greatest height that a planet may have, so that no sum of layers turns it inside out: nine tenths
    /// of the way to the centre, ten radii out.
    pub(crate) fn limits_m(&self) -> (f64, f64) {
        (-0.9 * self.radius_m, 10.0 * self.radius_m)
    }
}

impl CompiledLayer {
    fn new(planet: &Planet, layer: &Layer) -> Self {
        let seed = u64::from(planet.seed) << 32 | u64::from(layer.seed);
        let steps = match &layer.shape {
            Shape::Terraces(planet::Terraces { sharpness, waviness, .. }) => {
                let height_m = layer.amplitude_m.max(LEAST_M);
                Some(Steps { height_m, sharpness: *sharpness, waviness: *waviness })
            }
            _ => None,
        };
        let landform = Landform::new(&layer.shape, seed, planet.radius_km, planet.precision.into());
        let folding = if planet.structure.is_some() { layer.folding } else { 0.0 };
        Self {
            landform: Arc::new(landform.folding(folding)),
            needed: false,
            masks_others: false,
            slope_spacings_rad: Vec::new(),
            enabled: layer.enabled,
            steps,
            curve: CompiledCurve::new(&layer.curve),
            blend: Blend {
                kind: layer.blend,
                bias: layer.bias,
                amplitude_m: layer.amplitude_m,
                softness_m: layer.softness_m.max(LEAST_M),
            },
            masks: layer.masks.iter().filter_map(|mask| CompiledMask::new(planet, mask)).take(MAX_MASKS).collect(),
        }
    }

    /// The carved ground of a structure, before its world map is solved.
    fn structure() -> Self {
        Self {
            landform: Arc::new(Landform::structure(None)),
            needed: false,
            masks_others: false,
            slope_spacings_rad: Vec::new(),
            enabled: true,
            steps: None,
            curve: None,
            blend: Blend { kind: planet::Blend::Add, bias: 0.0, amplitude_m: 1.0, softness_m: LEAST_M },
            masks: Vec::new(),
        }
    }

    /// The riversides of the structure, before its world map is solved.
    fn riverside() -> Self {
        Self { landform: Arc::new(Landform::riverside(None)), enabled: false, ..Self::structure() }
    }

    /// A mask that is painted by hand.
    fn painted(mask: MaskId, edits: Option<&Arc<Edits>>) -> Self {
        let landform = Arc::new(Landform::painted(mask, edits));
        Self { landform, enabled: false, ..Self::structure() }
    }

    fn field_key(&self) -> Key {
        Key::of(&(&self.landform, &self.slope_spacings_rad))
    }

    fn looks_at_directions(&self) -> bool {
        let mask = |mask: &CompiledMask| matches!(mask.source, Source::Slope { .. } | Source::Latitude { .. });
        self.enabled && (self.steps.is_some() || self.masks.iter().any(mask))
    }

    /// The spacings of the gradients of its field: those asked for, and those of slope masks.
    pub(crate) fn spacings_rad(&self, asked_rad: &[f64]) -> Spacings {
        let more = self.slope_spacings_rad.iter().filter(|spacing| !asked_rad.contains(spacing));
        Spacings::new(asked_rad.iter().chain(more).copied())
    }
}

/// The masks of a planet that are painted by hand, each once.
fn painted_masks(planet: &Planet) -> impl Iterator<Item = MaskId> {
    let masks = planet.layers.iter().flat_map(|layer| &layer.masks).filter_map(|mask| match mask {
        Mask::Painted(mask) => Some(MaskId::of(&mask.mask)),
        _ => None,
    });
    masks.collect::<BTreeSet<MaskId>>().into_iter()
}

impl CompiledMask {
    fn new(planet: &Planet, mask: &Mask) -> Option<Self> {
        // The sine rises evenly enough with the angle, and needs no arc function at each point.
        let sine = |degrees: f64| libm::sin(degrees.to_radians());
        let (source, from, to, invert) = match mask {
            Mask::Layer(mask) => {
                let layer = planet.layers.iter().position(|layer| layer.name == mask.layer)?;
                (Source::Layer(layer), mask.from, mask.to, mask.invert)
            }
            Mask::Painted(mask) => {
                let id = MaskId::of(&mask.mask);
                let place = painted_masks(planet).position(|other| other == id)?;
                (Source::Layer(planet.layers.len() + place), mask.from_share, mask.to_share, mask.invert)
            }
            Mask::Height(mask) => (Source::Height, mask.from_m, mask.to_m, mask.invert),
            Mask::Slope(mask) => {
                let source = Source::Slope { spacing_rad: mask.over_m / planet.radius_m() };
                (source, sine(mask.from_deg), sine(mask.to_deg), mask.invert)
            }
            Mask::Latitude(mask) => {
                (Source::Latitude { both: mask.both }, sine(mask.from_deg), sine(mask.to_deg), mask.invert)
            }
        };
        Some(Self { source, edge: Edge { from, to, invert } })
    }
}
