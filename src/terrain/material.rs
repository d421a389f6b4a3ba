//! The ground at a point as one walks on it: the pattern that the picture shows there from near.
//!
//! `material.wgsl` follows the same rules with soft edges; a rule decides here at the middle of its edge.

use super::{Sample, Terrain};
use crate::noise_tile::NoiseTile;
use crate::planet::{Biome, Biomes, Detail};
use glam::DVec3;

/// Length in metres by which positions are wrapped before shaders read the noise of patches. Its periods divide it.
pub(crate) const WRAP_FAR_M: f64 = 1_048_576.0;
/// Features of the noise of patches are about a quarter of its tile in size.
const PATCHES_PER_TILE: f64 = 4.0;

/// Period in metres of the noise that makes the patches of a biome.
pub(crate) fn patch_tile_m(biome: &Biome) -> f64 {
    WRAP_FAR_M / (WRAP_FAR_M / (PATCHES_PER_TILE * biome.patch_m)).round().max(1.0)
}

/// The ground at a point, for footsteps, tyres and dust.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GroundMaterial<'a> {
    /// Close-up pattern of the ground.
    pub detail: Detail,
    /// Texture set that is shown in place of the pattern: its path, as the preset has it. None while it is not loaded.
    pub textures: Option<&'a str>,
    /// Whether the point lies in a patch of its biome, which has the second colour.
    pub is_patch: bool,
    /// Whether steep ground shows the rock that biomes share.
    pub is_rock: bool,
}

/// The materials of a planet's ground, ready to be asked for at many points.
pub struct GroundMaterials {
    biomes: Biomes,
    radius_m: f64,
    /// The noise of patches, where there are any.
    noise: Option<NoiseTile>,
}

impl GroundMaterials {
    /// Takes some 90 ms of one core where biomes have patches.
    pub fn new(terrain: &Terrain) -> Self {
        let planet = terrain.planet();
        let has_patches = planet.biomes.palette.iter().any(|biome| biome.patches > 0.0);
        Self {
            biomes: planet.biomes.clone(),
            radius_m: planet.radius_m(),
            noise: has_patches.then(NoiseTile::of_ground),
        }
    }

    /// The material at a point. `sample`: the sample in this direction, with its height and biome.
    pub fn at(&self, dir_planet: DVec3, sample: &Sample) -> GroundMaterial<'_> {
        let none = GroundMaterial { detail: Detail::None, textures: None, is_patch: false, is_rock: sample.is_rock };
        if sample.is_rock {
            return GroundMaterial { detail: self.biomes.cliff_detail, ..none };
        }
        let Some(biome) = self.biomes.palette.get(sample.biome) else { return none };
        let is_patch = self.noise.as_ref().is_some_and(|noise| {
            let at = dir_planet * (self.radius_m + sample.height_m) / patch_tile_m(biome);
            biome.patches > 0.0 && noise.ground_at(DVec3::new(at.z, at.x, at.y), 0.0) < biome.patches
        });
        let has_own = is_patch && biome.patch_detail != Detail::None;
        let textures = biome.textures.set().filter(|_| !has_own).map(|_| biome.textures.path());
        let detail = if is_patch { biome.detail_of_patches() } else { biome.detail };
        GroundMaterial { detail, textures, is_patch, ..none }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::textures::{SIDE, TextureSet, TextureSetFile};
    use crate::planet::{Fbm, Layer, Planet, Shape, Steep, Table};
    use crate::sphere::LatLon;
    use std::sync::Arc;

    /// Moss in a third of the needles, on hills steep enough for granite.
    fn hills() -> Terrain {
        let biome = Biome {
            detail: Detail::Needles,
            patches: 0.3,
            patch_detail: Detail::Moss,
            patch_m: 20.0,
            steep: Steep::Rock,
            ..Biome::default()
        };
        let table = Table::uniform(biome.key, 2, 2);
        let biomes = Biomes { palette: vec![biome], table, cliff_detail: Detail::Granite, ..Biomes::default() };
        let shape = Shape::Fbm(Fbm { wavelength_km: 15.0, octaves: 6, ..Fbm::default() });
        let layers = vec![Layer { amplitude_m: 3000.0, shape, ..Layer::default() }];
        Terrain::try_new(Arc::new(Planet { biomes, layers, water: None, ..Planet::default() })).unwrap()
    }

    #[test]
    fn patches_have_their_share_and_steep_ground_has_rock() {
        let terrain = hills();
        let materials = GroundMaterials::new(&terrain);
        let (mut patches, mut rocks, mut rest) = (0, 0, 0);
        for i in 0..20_000 {
            let i = f64::from(i);
            let dir = LatLon::from_degrees(-60.0 + 0.006 * i, 137.508 * i % 360.0 - 180.0).direction();
            let sample = terrain.sample(dir);
            let material = materials.at(dir, &sample);
            assert_eq!(material.textures, None);
            let expected = match (material.is_rock, material.is_patch) {
                (true, _) => Detail::Granite,
                (false, true) => Detail::Moss,
                (false, false) => Detail::Needles,
            };
            assert_eq!(material.detail, expected);
            assert!(!material.is_rock || sample.slope_rad > 0.5, "rock on {} rad", sample.slope_rad);
            rocks += u32::from(material.is_rock);
            patches += u32::from(material.is_patch);
            rest += u32::from(!material.is_rock);
        }
        let share = f64::from(patches) / f64::from(rest);
        // Between texels the noise is nearer to its mean, so rare patches are a little rarer.
        assert!((share - 0.3).abs() < 0.03, "{patches} of {rest} in patches");
        assert!(rocks > 20 && rest > 10_000, "{rocks} on rock, {rest} elsewhere");
    }

    #[test]
    fn a_texture_set_is_named_where_it_is_shown() {
        let set = TextureSet::of_colors(vec![[0.5; 3]; SIDE * SIDE]);
        let biome = Biome { detail: Detail::Sand, textures: TextureSetFile::holding(set), ..Biome::default() };
        let patches =
            [Detail::None, Detail::Moss].map(|patch_detail| Biome { patch_detail, patches: 1.0, ..biome.clone() });
        let missing = Biome { textures: "gone.png".to_owned().into(), ..biome.clone() };
        let shown = [Some("rock_albedo.png"), Some("rock_albedo.png"), None, None];
        let details = [Detail::Sand, Detail::Sand, Detail::Moss, Detail::Sand];
        let biomes = [biome].into_iter().chain(patches).chain([missing]);
        for ((biome, shown), detail) in biomes.zip(shown).zip(details) {
            let table = Table::uniform(biome.key, 2, 2);
            let biomes = Biomes { palette: vec![biome], table, ..Biomes::default() };
            let terrain = Terrain::try_new(Arc::new(Planet { biomes, water: None, ..Planet::default() })).unwrap();
            let (materials, dir) = (GroundMaterials::new(&terrain), LatLon::from_degrees(3.0, 4.0).direction());
            let material = materials.at(dir, &terrain.sample(dir));
            assert_eq!((material.textures, material.detail), (shown, detail));
        }
    }
}
