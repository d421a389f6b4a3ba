//! What one layer does at points: how far its masks let it act, and by how much it changes the height.

use super::Terrain;
use super::climate::ClimateInputs;
use super::field::Field;
use super::height::LayerFields;
use super::lane::CHUNK;
use super::points::unit;
use super::query::with_scratch;
use super::relief;
use glam::DVec3;
use rayon::prelude::*;

/// What a layer does at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct LayerEffect {
    /// Product of the layer's masks: 0 is off, 1 is on. 0 for a layer that is off.
    pub mask: f64,
    /// By how much it changes the height, in metres.
    pub change_m: f64,
}

/// A step of a layer on the way to a height, at the points of a chunk.
pub(super) enum Step<'a> {
    /// The product of the masks of a layer that has any.
    Masked(&'a [f64]),
    /// The numbers that the curve of the layer is about to bend.
    Bends(&'a [f64]),
}

/// Inputs that tell an observer of the steps of each layer.
pub(super) struct Watched<T, F> {
    pub(super) inputs: T,
    pub(super) told: F,
}

impl<T: LayerFields, F: FnMut(usize, Step<'_>)> LayerFields for Watched<T, F> {
    fn prepare(&mut self, layer: usize, mask: Option<&[f64]>) {
        // Without a mask, the call may come from another layer whose mask reads the noise of this one.
        if let Some(mask) = mask {
            (self.told)(layer, Step::Masked(mask));
        }
        self.inputs.prepare(layer, mask);
    }

    fn field(&self, layer: usize) -> Option<&Field> {
        self.inputs.field(layer)
    }

    fn bends(&mut self, layer: usize, noise: &[f64]) {
        (self.told)(layer, Step::Bends(noise));
    }
}

impl<T: relief::Inputs, F: FnMut(usize, Step<'_>)> relief::Inputs for Watched<T, F> {
    fn climate(&mut self) -> ClimateInputs<'_> {
        self.inputs.climate()
    }

    fn prepare_relief(&mut self, noise: usize) {
        self.inputs.prepare_relief(noise);
    }

    fn relief(&self, noise: usize) -> Option<&Field> {
        self.inputs.relief(noise)
    }
}

impl Terrain {
    /// What the layer of the preset at `index` does under unit directions, on all cores. All zeros if there is no such
    /// layer, or if it is off. `spacing_rad`: angle between the points; valleys of a structure that they would not show
    /// are left out, which is far faster. 0 is all detail.
    pub fn layer_effects(&self, dirs_planet: &[DVec3], index: usize, spacing_rad: f64) -> Vec<LayerEffect> {
        let spacing_rad = self.river_spacing_rad().map_or(0.0, |coarsest_rad| spacing_rad.clamp(0.0, coarsest_rad));
        let is_everywhere =
            self.planet().layers.get(index).is_some_and(|layer| layer.enabled && layer.masks.is_empty());
        let mask = if is_everywhere { 1.0 } else { 0.0 };
        let mut effects = vec![LayerEffect { mask, change_m: 0.0 }; dirs_planet.len()];
        let layer = self.stack.layers_before() + index;
        effects.par_chunks_mut(CHUNK).zip(dirs_planet.par_chunks(CHUNK)).for_each(|(effects, dirs)| {
            with_scratch(|scratch| {
                let mut before_m = vec![0.0; dirs.len()];
                let mut changes_m = vec![0.0; dirs.len()];
                let scratch = &mut scratch.0;
                scratch.points.refill(dirs.iter().map(|&dir| unit(dir)), spacing_rad);
                let told = |told: usize, step: Step<'_>| {
                    if let Step::Masked(mask) = step
                        && told == layer
                    {
                        effects.iter_mut().zip(mask).for_each(|(effect, mask)| effect.mask = *mask);
                    }
                };
                self.evaluate_through(
                    scratch,
                    |inputs| Watched { inputs, told },
                    |joined, heights_m| {
                        if joined == layer {
                            for ((change_m, before_m), height_m) in changes_m.iter_mut().zip(&before_m).zip(heights_m) {
                                *change_m = height_m - before_m;
                            }
                        }
                        before_m.copy_from_slice(&heights_m[..dirs.len()]);
                    },
                );
                for (effect, change_m) in effects.iter_mut().zip(changes_m) {
                    effect.change_m = change_m;
                }
            });
        });
        effects
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Layer, Mask, Planet, shipped};
    use crate::sphere::LatLon;
    use std::sync::Arc;

    fn dirs() -> Vec<DVec3> {
        (0..500).map(|i| LatLon::from_degrees(f64::from(i) * 0.35 - 87.0, f64::from(i) * 37.7).direction()).collect()
    }

    #[test]
    fn changes_are_those_of_the_pointer_and_masks_lie_between_off_and_on() {
        let terrain = Terrain::try_new(Arc::new(shipped::layered())).unwrap();
        let mut partly = 0;
        for index in 0..terrain.planet().layers.len() {
            let effects = terrain.layer_effects(&dirs(), index, 0.0);
            for (dir, effect) in dirs().into_iter().zip(effects) {
                assert_eq!(effect.change_m, terrain.layers_m(dir)[index]);
                assert!((0.0..=1.0).contains(&effect.mask));
                partly += usize::from(effect.mask > 0.0 && effect.mask < 1.0);
                assert!(effect.mask > 0.0 || effect.change_m == 0.0);
            }
        }
        assert!(partly > 20, "{partly}");
    }

    #[test]
    fn a_mask_by_latitude_is_on_beyond_its_upper_end_and_a_layer_that_is_off_does_nothing() {
        let mut layer = Layer { amplitude_m: 100.0, bias: 1.0, ..Layer::default() };
        let mask = Mask::all().into_iter().find(|mask| matches!(mask, Mask::Latitude(_))).unwrap();
        layer.masks = vec![mask];
        let effects = |layer: Layer| {
            let planet = Planet { layers: vec![layer], ..Planet::default() };
            Terrain::try_new(Arc::new(planet)).unwrap().layer_effects(&dirs(), 0, 0.0)
        };
        for (dir, effect) in dirs().into_iter().zip(effects(layer.clone())) {
            let lat_deg = LatLon::from_direction(dir).to_degrees().0.abs();
            assert!(!(lat_deg > 60.1 && effect.mask != 1.0 || lat_deg < 49.9 && effect.mask != 0.0), "{lat_deg}");
        }
        layer.enabled = false;
        assert!(effects(layer).iter().all(|effect| *effect == LayerEffect::default()));
    }
}
