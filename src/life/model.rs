//! Models: the meshes of a population's form, in all variants and levels of detail.

use super::form::{self, Mesh};
use crate::planet::{Form, Key, Population};
use rayon::prelude::*;

/// The meshes of a population.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Model {
    /// Content key of the form and the seed.
    pub key: Key,
    /// For each variant, its levels of detail, nearest first. Height 1, z up, the foot at the origin.
    pub variants: Vec<[Mesh; form::LEVELS]>,
    /// For each level of detail, a factor on its light that makes all of them equally bright.
    pub level_light: [f64; form::LEVELS],
    /// Distance from the foot within which every mesh lies, in heights.
    pub reach: f64,
    /// Size by which its level of detail is chosen, in heights.
    pub seen_size: f64,
}

impl Model {
    /// The key of the model of a population.
    pub(super) fn key_of(population: &Population) -> Key {
        Key::of(&(&population.form, population.seed))
    }

    /// Makes the meshes of a population, on all cores.
    pub fn new(population: &Population) -> Self {
        // Objects of one shape are made once.
        let count = if population.form.has_variants() { Form::VARIANTS } else { 1 };
        let variants = (0..count).into_par_iter();
        let variants = variants.map(|variant| form::meshes(&population.form, seed(population, variant)));
        let variants: Vec<_> = variants.collect();
        let variants: Vec<_> = variants.iter().cycle().take(Form::VARIANTS as usize).cloned().collect();
        // Variants differ little: one is measured.
        let level_light = variants.first().map_or([1.0; form::LEVELS], form::level_light);
        let vertices = variants.iter().flatten().flat_map(|mesh| &mesh.vertices);
        let reach = vertices.map(|vertex| f64::from(vertex.position.length())).fold(0.0, f64::max);
        Self { key: Self::key_of(population), variants, level_light, reach, seen_size: population.form.seen_size() }
    }

    /// Mesh of one variant of a population's form at the nearest level of detail; see [`form::mesh`].
    pub fn nearest(population: &Population, variant: u8) -> Mesh {
        form::mesh(&population.form, seed(population, variant.into()), 0)
    }
}

/// Seed of a variant of a population's form. The lowest two bits differ from variant to variant.
pub(super) fn seed(population: &Population, variant: u32) -> u32 {
    population.seed.wrapping_mul(0x9E37_79B1) ^ variant.wrapping_mul(0x85EB_CA77)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_of_variants_differ_in_their_lowest_bits() {
        for own in [0, 1, 77, u32::MAX] {
            let population = Population { seed: own, ..Population::default() };
            let mut lowest: Vec<u32> = (0..Form::VARIANTS).map(|v| seed(&population, v) % Form::VARIANTS).collect();
            lowest.sort_unstable();
            assert_eq!(lowest, [0, 1, 2, 3], "{own}");
        }
    }
}
