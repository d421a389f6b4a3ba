//! One texture layer from the pictures of a set.

use super::decode::luminance;
use super::layer::{Layer, Texel, slopes_of};
use super::set::TextureSet;
use super::shrink::Pixel;
use crate::planet::key::fnv1a;
use std::path::PathBuf;

/// Height of white over black in a height map, as a share of the side of the pattern.
pub(super) const RELIEF: f32 = 0.05;
/// Least part of a normal out of the ground: one that lies flat, or points into it, is of no surface seen from above.
const LEAST_UP: f32 = 0.05;

/// The pictures of a set, shrunk.
pub(super) struct Maps {
    colors: Vec<Pixel>,
    /// Normals as they are stored, 0 to 1, and whether y is down the picture.
    pub(super) normals: Option<(Vec<Pixel>, bool)>,
    pub(super) roughness: Option<Vec<f32>>,
    pub(super) heights: Option<Vec<f32>>,
    pub(super) occlusion: Option<Vec<f32>>,
}

impl Maps {
    /// Colours alone.
    pub(super) fn new(colors: Vec<Pixel>) -> Self {
        Self { colors, normals: None, roughness: None, heights: None, occlusion: None }
    }

    /// The set. `others`: the files beside that of the colours.
    pub(super) fn composed(self, others: Vec<PathBuf>) -> TextureSet {
        let count = self.colors.len().max(1);
        let mut color = [0.0_f64; 3];
        for pixel in &self.colors {
            color.iter_mut().zip(pixel).for_each(|(sum, part)| *sum += f64::from(part.clamp(0.0, 1.0)) / count as f64);
        }
        let slopes = self.slopes();
        // What is bright is high where nothing else says so: it decides which of two biomes shows, and tilts nothing.
        let heights = self.heights.unwrap_or_else(|| self.colors.iter().map(|color| luminance(*color)).collect());
        let mean = |numbers: &[f32]| numbers.iter().map(|n| f64::from(*n)).sum::<f64>() / numbers.len().max(1) as f64;
        let mean_roughness = self.roughness.as_deref().map_or(0.0, mean) as f32;
        let texel = |i: usize| {
            let light = self.occlusion.as_ref().map_or(1.0, |light| light[i].clamp(0.0, 1.0));
            let roughness = self.roughness.as_ref().map_or(0.0, |roughness| roughness[i] - mean_roughness);
            Texel { tint: self.colors[i].map(|part| part.max(0.0) * light), height: heights[i], roughness, glow: 0.0 }
        };
        let texels = (0..self.colors.len()).map(texel).collect();
        let layer = Layer::of_set(texels, slopes);
        let mut bytes: Vec<u8> = color.iter().flat_map(|part| part.to_le_bytes()).collect();
        layer.finest().iter().for_each(|texels| bytes.extend_from_slice(texels.as_flattened()));
        let hash = fnv1a(&bytes);
        TextureSet { color, layer, others, hash }
    }

    /// Rise over run along both sides: of the normals, or of the heights.
    fn slopes(&self) -> Vec<[f32; 2]> {
        match (&self.normals, &self.heights) {
            (Some((normals, is_directx)), _) => {
                let down = if *is_directx { -1.0 } else { 1.0 };
                let slope = |normal: &Pixel| {
                    let [x, y, z] = normal.map(|part| 2.0 * part - 1.0);
                    // Rows go down the picture, and y of OpenGL goes up: what faces up the picture rises along them.
                    [-x / z.max(LEAST_UP), down * y / z.max(LEAST_UP)]
                };
                normals.iter().map(slope).collect()
            }
            (None, Some(heights)) => slopes_of(&heights.iter().map(|height| RELIEF * height).collect::<Vec<_>>()),
            (None, None) => vec![[0.0; 2]; self.colors.len()],
        }
    }
}
