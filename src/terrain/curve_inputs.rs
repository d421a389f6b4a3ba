//! The numbers that the curves of a preset bend, at points: what an editor draws behind a curve.

use super::Terrain;
use super::effects::{Step, Watched};
use super::lane::CHUNK;
use super::points::unit;
use super::query::with_scratch;
use glam::DVec3;
use rayon::prelude::*;

/// A number that a curve bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveInput {
    /// The number: a layer's noise after its terraces, or a height in metres.
    pub number: f64,
    /// How much it counts: the product of the layer's masks there, 1 for a height. Never 0.
    pub weight: f64,
}

/// The numbers that the curves of a preset bend, at the points of a batch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveInputs {
    /// What the height curve bends: heights after all layers, whether the preset has such a curve or not.
    pub heights: Vec<CurveInput>,
    /// For each layer of the preset what its curve bends, where its masks let it act. Empty for a layer that is off or
    /// has no curve.
    pub layers: Vec<Vec<CurveInput>>,
}

impl Terrain {
    /// What the curves of the preset bend under unit directions, on all cores. `spacing_rad`: angle between the points;
    /// valleys of a structure that they would not show are left out, which is far faster. 0 is all detail.
    pub fn curve_inputs(&self, dirs_planet: &[DVec3], spacing_rad: f64) -> CurveInputs {
        let spacing_rad = self.river_spacing_rad().map_or(0.0, |coarsest_rad| spacing_rad.clamp(0.0, coarsest_rad));
        let parts = dirs_planet.par_chunks(CHUNK).map(|dirs| self.curve_inputs_of_chunk(dirs, spacing_rad));
        let mut all = self.no_inputs();
        for part in parts.collect::<Vec<_>>() {
            all.heights.extend(part.heights);
            all.layers.iter_mut().zip(part.layers).for_each(|(all, part)| all.extend(part));
        }
        all
    }

    fn no_inputs(&self) -> CurveInputs {
        CurveInputs { heights: Vec::new(), layers: vec![Vec::new(); self.planet().layers.len()] }
    }

    fn curve_inputs_of_chunk(&self, dirs: &[DVec3], spacing_rad: f64) -> CurveInputs {
        let mut found = self.no_inputs();
        let before = self.stack.layers_before();
        let layers = &mut found.layers;
        let mut masks: Vec<Option<Vec<f64>>> = vec![None; layers.len()];
        let told = |layer: usize, step: Step<'_>| {
            let Some(index) = layer.checked_sub(before).filter(|index| *index < layers.len()) else { return };
            match step {
                Step::Masked(mask) => masks[index] = Some(mask.to_vec()),
                Step::Bends(noise) => {
                    let weight = |i: usize| masks[index].as_ref().map_or(1.0, |mask| mask[i]);
                    let inputs =
                        noise.iter().enumerate().map(|(i, noise)| CurveInput { number: *noise, weight: weight(i) });
                    layers[index] = inputs.filter(|input| input.weight > 0.0).collect();
                }
            }
        };
        // Without any layer the ground is level.
        let mut heights_m = vec![0.0; dirs.len()];
        with_scratch(|scratch| {
            let scratch = &mut scratch.0;
            scratch.points.refill(dirs.iter().map(|&dir| unit(dir)), spacing_rad);
            self.evaluate_through(
                scratch,
                |inputs| Watched { inputs, told },
                |_, joined_m| heights_m.copy_from_slice(&joined_m[..dirs.len()]),
            );
        });
        found.heights = heights_m.into_iter().map(|number| CurveInput { number, weight: 1.0 }).collect();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, shipped};
    use crate::sphere::spread;
    use std::sync::Arc;

    const SHIFTED: &str = r#"(version: 3, name: "Bent", radius_km: 1000.0,
        layers: [
            (name: "Plain", amplitude_m: 1000.0, shape: Fbm(wavelength_km: 900.0, octaves: 3)),
            (name: "Bent", amplitude_m: 1000.0, shape: Fbm(wavelength_km: 700.0, octaves: 3),
             curve: [(-1.0, -0.5), (0.0, 0.1), (1.0, 0.8)]),
        ])"#;

    fn dirs() -> Vec<DVec3> {
        spread(1000).collect()
    }

    fn terrain(planet: Planet) -> Terrain {
        Terrain::try_new(Arc::new(planet)).unwrap()
    }

    fn preset(text: &str) -> Planet {
        Planet::from_text("test", text).unwrap()
    }

    #[test]
    fn a_curve_of_its_inputs_is_what_the_layer_does() {
        let planet = preset(SHIFTED);
        let curve = planet.layers[1].curve.clone();
        let bent = terrain(planet.clone());
        let inputs = bent.curve_inputs(&dirs(), 0.0);
        assert!(inputs.layers[0].is_empty(), "it has no curve");
        assert_eq!(inputs.layers[1].len(), 1000);
        for (dir, input) in dirs().into_iter().zip(&inputs.layers[1]) {
            let made_m = super::super::curve_at(&curve, input.number) * 1000.0;
            assert!((made_m - bent.layers_m(dir)[1]).abs() < 1e-6, "{made_m}");
            assert_eq!(input.weight, 1.0);
        }
    }

    #[test]
    fn the_height_curve_bends_heights_and_sees_them_before_it_is_there() {
        let mut planet = preset(SHIFTED);
        let plain = terrain(planet.clone());
        let before = plain.curve_inputs(&dirs(), 0.0).heights;
        planet.height_curve = vec![[-5000.0, -1000.0], [0.0, 0.0], [5000.0, 9000.0]];
        assert_eq!(terrain(planet).curve_inputs(&dirs(), 0.0).heights, before);
        for (dir, input) in dirs().into_iter().zip(&before) {
            assert!((input.number - plain.height_m(dir)).abs() < 1e-6);
        }
    }

    #[test]
    fn masked_points_count_as_far_as_the_mask_is_on() {
        let mut planet = shipped::layered();
        for layer in &mut planet.layers {
            layer.curve = vec![[-1.0, -1.0], [0.0, 0.1], [1.0, 1.0]];
        }
        let index = planet.layers.iter().position(|layer| layer.enabled && !layer.masks.is_empty()).unwrap();
        let terrain = terrain(planet);
        let inputs = terrain.curve_inputs(&dirs(), 0.0).layers.swap_remove(index);
        let acts = terrain.layer_effects(&dirs(), index, 0.0).iter().filter(|effect| effect.mask > 0.0).count();
        assert!(acts > 50 && acts < 1000, "{acts}");
        assert_eq!(inputs.len(), acts);
        assert!(inputs.iter().any(|input| input.weight < 1.0));
    }
}
