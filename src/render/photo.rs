//! Photographs: pictures of any size, drawn in tiles, with many samples to a pixel, through a lens that has a focus.

use super::{Metering, RenderError, Renderer, Scene, ViewId, read_texture, texture};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Side of a tile in pixels, and rows around it that are drawn and cut off: smooth edges look at neighbours.
const TILE_PX: u32 = 1024;
const APRON_PX: u32 = 12;
/// Longer side in pixels of the small picture that gives all tiles their exposure and bloom.
const METERED_PX: u32 = 768;
/// The view of photographs.
const VIEW: ViewId = ViewId(u32::MAX);
/// Format of a tile as it is shown.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// A lens of a width. What is not in focus is a disc as wide as real lenses make it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Diameter in metres: 0.01 for a camera in the hand. A kilometre makes a model of a continent.
    pub diameter_m: f64,
    /// Distance along the view axis that is sharp, metres.
    pub focus_m: f64,
}

/// Values of a photograph.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Develop {
    /// Linear display values from 0 to 1, after exposure and tone curve.
    #[default]
    Shown,
    /// Radiance before both, 1 for white ground at noon, without stars.
    Radiance,
}

/// How a photograph is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Photo {
    /// Samples along each side of a pixel, 1 to 16. From 2 on edges are smooth by themselves.
    pub samples: u32,
    /// The lens; without, all is sharp.
    pub lens: Option<Lens>,
    /// What the pixels hold.
    pub develop: Develop,
}

impl Default for Photo {
    fn default() -> Self {
        Self { samples: 1, lens: None, develop: Develop::Shown }
    }
}

/// A part of a picture, pixels: left, top, width, height.
type Part = [u32; 4];

impl Photo {
    /// The longest side of what is drawn at a time, pixels: the device must allow textures of this size.
    pub const MOST_TILE_PX: u32 = 2 * TILE_PX;

    /// Draws a scene of any size. `progress` hears the share that is done and says whether to go on.
    ///
    /// The scene's surfaces should be built for its camera. Gives the pixels row by row from the top, or none if
    /// `progress` said no.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn take(
        &self,
        renderer: &mut Renderer,
        scene: &Scene<'_>,
        progress: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Option<Vec<[f32; 3]>>, RenderError> {
        let result = self.draw(renderer, scene, progress);
        renderer.forget_view(VIEW);
        result
    }

    fn draw(
        &self,
        renderer: &mut Renderer,
        scene: &Scene<'_>,
        progress: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Option<Vec<[f32; 3]>>, RenderError> {
        let count = self.samples.clamp(1, 16).pow(2);
        let parts = parts(scene.size_px);
        let is_one = parts.len() == 1 && count == 1;
        let metering = match self.develop {
            // Neither exposure nor bloom is in the radiance.
            Develop::Radiance => Metering::Manual,
            Develop::Shown if is_one => scene.post.metering,
            Develop::Shown => metered(renderer, scene)?,
        };
        let [wide, high] = scene.size_px.map(|side| side as usize);
        let mut pixels = vec![[0.0; 3]; wide * high];
        for (number, part) in parts.iter().enumerate() {
            let mut sum = vec![[0.0; 3]; (part.drawn[2] * part.drawn[3]) as usize];
            for sample in 0..count {
                let done = (number as f64 + f64::from(sample) / f64::from(count)) / parts.len() as f64;
                if !progress(done) {
                    return Ok(None);
                }
                let mut tile = tile(scene, part.drawn);
                if !is_one {
                    tile.whole.get_or_insert(scene.projection);
                }
                tile.post.metering = metering;
                tile.post.smooth_edges &= count == 1;
                self.aim(&mut tile, sample, count);
                let drawn = self.expose(renderer, &tile)?;
                sum.par_iter_mut().zip(&drawn).for_each(|(sum, pixel)| {
                    (0..3).for_each(|band| sum[band] += pixel[band] / count as f32);
                });
            }
            let [left, top, width, height] = part.kept.map(|px| px as usize);
            let (dx, dy) = (left - part.drawn[0] as usize, top - part.drawn[1] as usize);
            for row in 0..height {
                let from = (row + dy) * part.drawn[2] as usize + dx;
                let to = (row + top) * wide + left;
                pixels[to..to + width].copy_from_slice(&sum[from..from + width]);
            }
        }
        progress(1.0);
        Ok(Some(pixels))
    }

    /// Moves the eye on the lens, and the picture within a pixel, for a sample of `count`.
    fn aim(&self, scene: &mut Scene<'_>, sample: u32, count: u32) {
        let along = f64::from(self.samples.clamp(1, 16));
        let place = |n: u32| (f64::from(n) + 0.5) / along - 0.5;
        let (column, row) = (sample % along as u32, sample / along as u32);
        scene.projection.jitter_px = [place(column), place(row)];
        let Some(lens) = self.lens else { return };
        // Evenly spread over the disc (Vogel 1979), in an order that has nothing to do with the place in the pixel.
        let number = f64::from(sample * stride(count) % count);
        let radius_m = 0.5 * lens.diameter_m * ((number + 0.5) / f64::from(count)).sqrt();
        let (sin, cos) = (number * GOLDEN_ANGLE_RAD).sin_cos();
        let [right_m, up_m] = [radius_m * cos, radius_m * sin];
        let aside = scene.scene_from_view * DVec3::new(right_m, up_m, 0.0);
        for body in &mut scene.bodies {
            body.position_m -= aside;
        }
        // The plane in focus stays where it is.
        let [x, y] = [right_m, up_m].map(|m| m / lens.focus_m);
        let [left, right, bottom, top] = scene.projection.tangents;
        scene.projection.tangents = [left - x, right - x, bottom - y, top - y];
    }

    /// Draws one tile once.
    fn expose(&self, renderer: &mut Renderer, tile: &Scene<'_>) -> Result<Vec<[f32; 3]>, RenderError> {
        let target = texture(&renderer.device, "photograph", tile.size_px, FORMAT);
        renderer.render(&target.create_view(&wgpu::TextureViewDescriptor::default()), tile)?;
        match self.develop {
            Develop::Shown => {
                let bytes = read_texture(&renderer.device, &renderer.queue, &target)?;
                let value = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
                Ok(bytes.par_chunks_exact(16).map(|texel| [0, 4, 8].map(|at| value(&texel[at..]))).collect())
            }
            Develop::Radiance => {
                let (drawn_px, drawn) = renderer.radiance()?;
                Ok(resized(&drawn, drawn_px, tile.size_px))
            }
        }
    }
}

/// The golden angle.
const GOLDEN_ANGLE_RAD: f64 = TAU * 0.381_966_011_250_105;

/// A number near the golden section of `count` that has no divisor in common with it.
fn stride(count: u32) -> u32 {
    let gcd = |mut a: u32, mut b: u32| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let first = (f64::from(count) * 0.618) as u32;
    (first.max(1)..=count).find(|n| gcd(*n, count) == 1).unwrap_or(1)
}

/// A tile of the picture: what is drawn of it, and what is kept.
struct Tile {
    drawn: Part,
    kept: Part,
}

/// The tiles of a picture, row by row; one for a picture that is not much larger than a tile.
fn parts([width, height]: [u32; 2]) -> Vec<Tile> {
    if width.max(height) <= Photo::MOST_TILE_PX {
        let whole = [0, 0, width, height];
        return vec![Tile { drawn: whole, kept: whole }];
    }
    let spans = |length: u32| {
        (0..length.div_ceil(TILE_PX)).map(move |n| {
            let (from, to) = (n * TILE_PX, ((n + 1) * TILE_PX).min(length));
            let (first, last) = (from.saturating_sub(APRON_PX), (to + APRON_PX).min(length));
            ([first, last - first], [from, to - from])
        })
    };
    let rows = spans(height).map(|(drawn, kept)| spans(width).map(move |of| (of, (drawn, kept))));
    rows.flatten()
        .map(|((drawn_x, kept_x), (drawn_y, kept_y))| Tile {
            drawn: [drawn_x[0], drawn_y[0], drawn_x[1], drawn_y[1]],
            kept: [kept_x[0], kept_y[0], kept_x[1], kept_y[1]],
        })
        .collect()
}

/// The scene of a tile: a part of the frustum. Tiles of the ground are those of the whole picture.
fn tile<'a>(scene: &Scene<'a>, [x, y, width, height]: Part) -> Scene<'a> {
    let mut tile = scene.clone();
    for body in &mut tile.bodies {
        body.frozen.get_or_insert(scene.view_of(body.position_m, body.scene_from_body));
    }
    let [left, right, bottom, top] = scene.projection.tangents;
    let [wide, high] = scene.size_px.map(f64::from);
    let across = |px: u32| left + (right - left) * f64::from(px) / wide;
    let down = |px: u32| top + (bottom - top) * f64::from(px) / high;
    tile.projection.tangents = [across(x), across(x + width), down(y + height), down(y)];
    tile.projection.near_m = Some(scene.matrices().near_m);
    tile.size_px = [width, height];
    tile.view_id = VIEW;
    tile
}

/// Draws a small picture of the whole, whose exposure and bloom all tiles have.
fn metered(renderer: &mut Renderer, scene: &Scene<'_>) -> Result<Metering, RenderError> {
    let longer = scene.size_px[0].max(scene.size_px[1]).max(1);
    let mut small = tile(scene, [0, 0, scene.size_px[0], scene.size_px[1]]);
    let shrunk = |side: u32| (u64::from(side) * u64::from(METERED_PX.min(longer)) / u64::from(longer)).max(1) as u32;
    small.size_px = scene.size_px.map(shrunk);
    let given = match scene.post.metering {
        given @ (Metering::Manual | Metering::Fixed(_)) => Some(given),
        Metering::Instant | Metering::Adapting { .. } => None,
    };
    if let (Some(given), true) = (given, scene.post.bloom <= 0.0) {
        return Ok(given);
    }
    small.post.metering = given.unwrap_or(Metering::Instant);
    let target = texture(&renderer.device, "metered photograph", small.size_px, FORMAT);
    renderer.render(&target.create_view(&wgpu::TextureViewDescriptor::default()), &small)?;
    match given {
        Some(given) => Ok(given),
        None => Ok(Metering::Fixed(renderer.metered(VIEW)?)),
    }
}

/// A picture at another size: the mean of the pixels that fall into each.
fn resized(drawn: &[[f32; 3]], [wide, high]: [u32; 2], [width, height]: [u32; 2]) -> Vec<[f32; 3]> {
    let span = |n: u32, of: u32, all: u32| {
        let from = (u64::from(n) * u64::from(all) / u64::from(of)) as u32;
        let to = (u64::from(n + 1) * u64::from(all) / u64::from(of)) as u32;
        from..to.max(from + 1).min(all)
    };
    let pixel = |i: u32| {
        let (columns, rows) = (span(i % width, width, wide), span(i / width, height, high));
        let share = 1.0 / (columns.len() * rows.len()).max(1) as f32;
        let mut mean = [0.0; 3];
        for at in rows.flat_map(|y| columns.clone().map(move |x| (y * wide + x) as usize)) {
            (0..3).for_each(|band| mean[band] += drawn[at][band] * share);
        }
        mean
    };
    (0..width * height).into_par_iter().map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_picture_once() {
        for size in [[100, 50], [2048, 2048], [2049, 10], [5000, 3100]] {
            let mut covered = vec![0_u8; (size[0] * size[1]) as usize];
            for tile in parts(size) {
                let ([x, y, w, h], [dx, dy, dw, dh]) = (tile.kept, tile.drawn);
                assert!(dx <= x && dy <= y && x + w <= dx + dw && y + h <= dy + dh);
                assert!(dx + dw <= size[0] && dy + dh <= size[1]);
                for row in y..y + h {
                    (x..x + w).for_each(|column| covered[(row * size[0] + column) as usize] += 1);
                }
            }
            assert!(covered.iter().all(|times| *times == 1), "{size:?}");
        }
    }

    #[test]
    fn each_place_on_the_lens_is_used_once() {
        for along in 1..=16_u32 {
            let count = along * along;
            let mut places: Vec<u32> = (0..count).map(|n| n * stride(count) % count).collect();
            places.sort_unstable();
            assert_eq!(places, (0..count).collect::<Vec<_>>());
        }
    }
}
