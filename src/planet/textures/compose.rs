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
        let height = if self.heights.is_some() { RELIEF } else { 0.0 };
        let heights = self.heights.unwrap_or_else(|| self.colors.iter().map(|color| luminance(*color)).collect());
        let mean = |numbers: &[f32]| numbers.iter().map(|n| f64::from(*n)).sum::<f64>() / numbers.len().max(1) as f64;
        let mean_roughness = self.roughness.as_deref().map_or(0.0, mean) as f32;
        let texel = |i: usize| {
            let light = self.occlusion.as_ref().map_or(1.0, |light| light[i].clamp(0.0, 1.0));
            let roughness = self.roughness.as_ref().map_or(0.0, |roughness| roughness[i] - mean_roughness);
            Texel { tint: self.colors[i].map(|part| part.max(0.0) * light), height: heights[i], roughness, glow: 0.0 }
        };
        let texels = (0..self.colors.len()).map(texel).collect();
        let layer = Layer::of_set(texels, slopes, height);
        let mut bytes: Vec<u8> = color.iter().flat_map(|part| part.to_le_bytes()).collect();
        layer.finest().iter().for_each(|texels| bytes.extend_from_slice(texels.as_flattened()));
        bytes.extend(layer.relief.to_le_bytes());
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

#[cfg(test)]
mod tests {
    use super::super::SIDE;
    use super::*;

    /// A dome in the upper left: heights, 0 to 1, and the slopes of its relief along x and along rows.
    fn dome() -> (Vec<f32>, Vec<[f32; 2]>) {
        const RADIUS: f32 = 0.2;
        let texel = |i: usize| {
            let [x, y] = [i % SIDE, i / SIDE].map(|at| (at as f32 + 0.5) / SIDE as f32 - 0.3);
            let away = x.hypot(y);
            if away >= RADIUS {
                return (0.0, [0.0; 2]);
            }
            let turn = std::f32::consts::PI / RADIUS;
            let down = -0.5 * RELIEF * turn * (turn * away).sin() / away.max(1e-6);
            (0.5 + 0.5 * (turn * away).cos(), [down * x, down * y])
        };
        (0..SIDE * SIDE).map(texel).unzip()
    }

    /// Normals as an OpenGL or a DirectX map stores them.
    fn normals(slopes: &[[f32; 2]], is_directx: bool) -> Vec<Pixel> {
        let normal = |[along, down]: &[f32; 2]| {
            let length = (1.0 + along * along + down * down).sqrt();
            // Up the picture is against the rows.
            let up = if is_directx { -down } else { *down };
            [-along / length, up / length, 1.0 / length].map(|part| 0.5 + 0.5 * part)
        };
        slopes.iter().map(normal).collect()
    }

    fn surface(maps: Maps) -> Vec<[u8; 4]> {
        maps.composed(Vec::new()).layer.finest()[1].clone()
    }

    fn even() -> Maps {
        Maps::new(vec![[0.5; 3]; SIDE * SIDE])
    }

    #[test]
    fn normals_and_heights_of_a_dome_have_the_same_slopes() {
        let (heights, slopes) = dome();
        let by_height = surface(Maps { heights: Some(heights), ..even() });
        let most = by_height.iter().map(|texel| texel[0].abs_diff(128)).max().unwrap();
        assert!(most > 20, "the dome is flat: {most}");
        for is_directx in [false, true] {
            let by_normal = surface(Maps { normals: Some((normals(&slopes, is_directx), is_directx)), ..even() });
            for (i, (a, b)) in by_height.iter().zip(&by_normal).enumerate() {
                let away = [a[0].abs_diff(b[0]), a[1].abs_diff(b[1])];
                assert!(away[0] <= 1 && away[1] <= 1, "{i}: {a:?} by height, {b:?} by normal, {is_directx}");
            }
            let flipped = surface(Maps { normals: Some((normals(&slopes, !is_directx), is_directx)), ..even() });
            let differs = flipped.iter().zip(&by_normal).any(|(a, b)| a[1].abs_diff(b[1]) > 20);
            assert!(differs && flipped.iter().zip(&by_normal).all(|(a, b)| a[0] == b[0]));
        }
    }

    #[test]
    fn colours_alone_are_flat_and_neutral_at_every_level() {
        let stripes = (0..SIDE * SIDE).map(|i| if i % 32 < 8 { [0.5, 0.02, 0.0] } else { [0.1, 0.01, 0.0] });
        let set = Maps::new(stripes.collect()).composed(Vec::new());
        for (found, right) in set.color.into_iter().zip([0.2, 0.0125, 0.0]) {
            assert!((found - right).abs() < 1e-6, "{:?}", set.color);
        }
        for (level, texels) in set.layer.tint.iter().enumerate() {
            for channel in 0..3 {
                let sum: f64 = texels.iter().map(|texel| f64::from(texel[channel])).sum();
                let mean = sum / texels.len() as f64 / 127.5;
                assert!((mean - 1.0).abs() < 0.01, "level {level}, channel {channel}: {mean}");
            }
        }
        let [tint, surface] = set.layer.finest();
        assert!(
            set.layer.relief == 0.0 && surface.iter().all(|texel| *texel == [128, 128, 128, 0]),
            "{:?}",
            surface[0]
        );
        // What is bright is high.
        assert!(tint[0][3] > 200 && tint[20][3] < 120, "{:?} {:?}", tint[0], tint[20]);
    }

    #[test]
    fn roughness_is_a_change_and_occlusion_darkens() {
        let half = |a: f32, b: f32| (0..SIDE * SIDE).map(|i| if i % 16 < 8 { a } else { b }).collect::<Vec<_>>();
        let set = Maps { roughness: Some(half(0.9, 0.5)), occlusion: Some(half(1.0, 0.5)), ..even() };
        let set = set.composed(Vec::new());
        let [tint, surface] = set.layer.finest();
        let changes = [surface[0][2], surface[8][2]].map(|byte| (f32::from(byte) / 255.0 - 0.5) * 2.0 * 0.5);
        assert!((changes[0] - 0.2).abs() < 0.01 && (changes[1] + 0.2).abs() < 0.01, "{changes:?}");
        assert!((f32::from(tint[0][0]) / f32::from(tint[8][0]) - 2.0).abs() < 0.05);
        assert_eq!(set.color, [0.5; 3], "occlusion is no colour");
    }
}
