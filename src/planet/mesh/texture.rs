//! Pictures of colours, made small: a mesh keeps the mean colour around each corner, and no picture.

use glam::{Vec2, Vec3, Vec4};
use std::io::Cursor;

/// Most pixels along a side of a picture.
const MOST_SIDE: usize = 8192;
/// Texels along a side that are kept, at most.
const KEPT_SIDE: usize = 128;

/// A small picture: linear sRGB times alpha, and alpha.
pub(super) struct Texture {
    width: usize,
    texels: Vec<Vec4>,
}

impl Texture {
    /// Reads a PNG or a JPEG. `left`: pixels that the pictures of the file may still have.
    pub(super) fn new(bytes: &[u8], left: &mut usize) -> Result<Self, String> {
        let (size, pixels) = match bytes {
            [0x89, b'P', b'N', b'G', ..] => png(bytes, left)?,
            [0xff, 0xd8, ..] => jpeg(bytes, left)?,
            _ => return Err("is neither PNG nor JPEG; save it as one of them".to_owned()),
        };
        Ok(Self::shrunk(size, &pixels))
    }

    /// Means of blocks of pixels: four bytes each, sRGB and alpha.
    fn shrunk([width, height]: [usize; 2], pixels: &[u8]) -> Self {
        let linear: [f32; 256] = std::array::from_fn(|byte| linear(byte as f32 / 255.0));
        let [across, down] = [width, height].map(|side| side.clamp(1, KEPT_SIDE));
        let mut sums = vec![(Vec4::ZERO, 0.0_f32); across * down];
        for (row, line) in pixels.chunks_exact(4 * width.max(1)).enumerate() {
            for (column, pixel) in line.chunks_exact(4).enumerate() {
                let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(|byte| linear[usize::from(byte)]);
                let alpha = f32::from(pixel[3]) / 255.0;
                let (sum, count) = &mut sums[row * down / height * across + column * across / width];
                *sum += Vec4::new(r * alpha, g * alpha, b * alpha, alpha);
                *count += 1.0;
            }
        }
        Self { width: across, texels: sums.into_iter().map(|(sum, count)| sum / count.max(1.0)).collect() }
    }

    /// The texel at a place, which repeats: linear sRGB times alpha, and alpha.
    fn at(&self, place: Vec2) -> Vec4 {
        let height = self.texels.len() / self.width;
        let step = |along: f32, side: usize| {
            let share = if along.is_finite() { along - along.floor() } else { 0.0 };
            ((share * side as f32) as usize).min(side.saturating_sub(1))
        };
        self.texels[step(place.y, height) * self.width + step(place.x, self.width)]
    }

    /// Mean colour over a triangle, by alpha, and mean alpha.
    pub(super) fn mean(&self, corners: [Vec2; 3]) -> (Vec3, f32) {
        const STEPS: usize = 5;
        let (mut sum, mut count) = (Vec4::ZERO, 0.0);
        for i in 0..STEPS {
            for j in 0..STEPS - i {
                let [a, b] = [i, j].map(|step| (step as f32 + 1.0 / 3.0) / STEPS as f32);
                sum += self.at(corners[0] * (1.0 - a - b) + corners[1] * a + corners[2] * b);
                count += 1.0;
            }
        }
        (sum.truncate() / sum.w.max(1e-3), sum.w / count)
    }
}

/// Linear part of an sRGB one.
pub(in crate::planet) fn linear(part: f32) -> f32 {
    if part <= 0.040_45 { part / 12.92 } else { libm::powf((part + 0.055) / 1.055, 2.4) }
}

fn checked(width: usize, height: usize, left: &mut usize) -> Result<[usize; 2], String> {
    if width.max(height) > MOST_SIDE || width.min(height) == 0 {
        return Err(format!("has {width} x {height} pixels; use at most {MOST_SIDE} along a side"));
    }
    *left = left.checked_sub(width * height).ok_or("is one of too many; use fewer or smaller pictures")?;
    Ok([width, height])
}

fn broken(why: &dyn std::fmt::Display) -> String {
    format!("is broken: {why}; save it anew")
}

fn png(bytes: &[u8], left: &mut usize) -> Result<([usize; 2], Vec<u8>), String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(|error| broken(&error))?;
    let size = checked(header.width as usize, header.height as usize, left)?;
    let mut reader = decoder.read_info().map_err(|error| broken(&error))?;
    let mut raw = vec![0; reader.output_buffer_size().ok_or("is too large")?];
    reader.next_frame(&mut raw).map_err(|error| broken(&error))?;
    Ok((size, rgba(&raw, reader.output_color_type().0.samples())))
}

fn jpeg(bytes: &[u8], left: &mut usize) -> Result<([usize; 2], Vec<u8>), String> {
    let mut decoder = zune_jpeg::JpegDecoder::new(Cursor::new(bytes));
    decoder.decode_headers().map_err(|error| broken(&error))?;
    let (width, height) = decoder.dimensions().ok_or("is broken; save it anew")?;
    let size = checked(width, height, left)?;
    let raw = decoder.decode().map_err(|error| broken(&error))?;
    Ok((size, rgba(&raw, raw.len() / (width * height))))
}

/// Pixels of one to four bytes as such of four.
fn rgba(raw: &[u8], channels: usize) -> Vec<u8> {
    let pixel = |pixel: &[u8]| match *pixel {
        [grey] => [grey, grey, grey, 255],
        [grey, alpha] => [grey, grey, grey, alpha],
        [r, g, b] => [r, g, b, 255],
        [r, g, b, alpha, ..] => [r, g, b, alpha],
        [] => [255; 4],
    };
    raw.chunks_exact(channels.max(1)).flat_map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of 2 x 1 pixels: opaque red, and green of which nothing shows.
    fn pair() -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(png::ColorType::Rgba);
        let pixels = [255, 0, 0, 255, 0, 255, 0, 0];
        encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
        bytes
    }

    #[test]
    fn what_is_transparent_gives_no_colour() {
        let texture = Texture::new(&pair(), &mut 99).unwrap();
        let over = |from: f32, to: f32| texture.mean([Vec2::new(from, 0.1), Vec2::new(to, 0.1), Vec2::new(to, 0.9)]);
        let (whole, alpha) = over(0.0, 1.0);
        assert!(whole.abs_diff_eq(Vec3::X, 1e-6) && (0.2..0.6).contains(&alpha), "{whole} {alpha}");
        // Places repeat.
        assert_eq!(over(2.05, 2.45), over(-0.95, -0.55));
        assert_eq!(over(2.05, 2.45), (Vec3::X, 1.0));
    }

    #[test]
    fn other_files_are_refused() {
        assert!(Texture::new(&pair(), &mut 1).err().unwrap().contains("one of too many"));
        assert!(Texture::new(b"RIFF", &mut 99).err().unwrap().contains("neither PNG nor JPEG"));
        assert!(Texture::new(&pair()[..40], &mut 99).err().unwrap().starts_with("is broken"));
        assert!(Texture::new(&[0xff, 0xd8, 0xff], &mut 99).err().unwrap().starts_with("is broken"));
    }
}
