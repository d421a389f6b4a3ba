//! Files of pictures: PNG of 8 or 16 bits, and OpenEXR; names of the frames of a film.

use crate::render::{Develop, srgb_from_linear};
use crate::world::noise::{hash, unit};
use exr::prelude::{Image, SpecificChannels, WritableImage as _, f16};
use rayon::prelude::*;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// Display values of 8 bits, dithered.
    Png8,
    /// Display values of 16 bits.
    Png16,
    /// Linear radiance, floats of 16 bits.
    Exr,
}

impl FileKind {
    /// The kind of a file by its ending. `bits`: of a PNG.
    ///
    /// # Errors
    /// Which endings there are.
    pub fn of(path: &Path, bits: Option<u8>) -> Result<Self, String> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
        match (ending.as_str(), bits) {
            ("png", None | Some(8)) => Ok(Self::Png8),
            ("png", _) => Ok(Self::Png16),
            ("exr", None) => Ok(Self::Exr),
            ("exr", Some(_)) => Err("--bits is for .png; an .exr has floats of 16 bits".to_owned()),
            _ => Err(format!("{}: no kind of picture; use a name that ends in .png or .exr", path.display())),
        }
    }

    /// What its pixels are.
    pub fn develop(self) -> Develop {
        if self == Self::Exr { Develop::Radiance } else { Develop::Shown }
    }

    /// The bytes of a file of pixels, row by row from the top.
    ///
    /// # Errors
    /// What the encoder says.
    pub fn encode(self, pixels: &[[f32; 3]], size_px: [u32; 2]) -> Result<Vec<u8>, String> {
        match self {
            Self::Png8 => {
                let numbered = pixels.par_iter().enumerate();
                let texels = numbered.map(|(i, pixel)| pixel.map(|value| dithered(srgb(value), i as u32)));
                let texels: Vec<[u8; 3]> = texels.collect();
                png(texels.as_flattened(), png::BitDepth::Eight, size_px)
            }
            Self::Png16 => {
                let deep = |value: f32| ((srgb(value) * 65_535.0).round() as u16).to_be_bytes();
                let texels: Vec<[[u8; 2]; 3]> = pixels.par_iter().map(|pixel| pixel.map(deep)).collect();
                png(texels.as_flattened().as_flattened(), png::BitDepth::Sixteen, size_px)
            }
            Self::Exr => {
                let size = size_px.map(|side| side as usize);
                let channels = SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
                    let [r, g, b] = pixels[at.y() * size[0] + at.x()].map(f16::from_f32);
                    (r, g, b)
                });
                let mut bytes = Cursor::new(Vec::new());
                let image = Image::from_channels((size[0], size[1]), channels);
                image.write().to_buffered(&mut bytes).map_err(|error| format!("cannot encode the picture: {error}"))?;
                Ok(bytes.into_inner())
            }
        }
    }
}

/// The file of a frame of a film, counted from 1: `film.png` gives `film-0001.png`.
pub fn frame_path(film: &Path, number: usize) -> PathBuf {
    let stem = film.file_stem().unwrap_or_default().to_string_lossy();
    let ending = film.extension().unwrap_or_default().to_string_lossy();
    film.with_file_name(format!("{stem}-{number:04}.{ending}"))
}

/// Encodes a linear value as sRGB, cut off at 0 and 1.
fn srgb(value: f32) -> f32 {
    srgb_from_linear(f64::from(value)) as f32
}

/// Eight bits of a value from 0 to 1. Triangular noise with the amplitude of one step hides the steps; none on black.
fn dithered(value: f32, pixel: u32) -> u8 {
    let [a, b] = [0, 1].map(|number| unit(hash(pixel, number)) as f32);
    let noise = a - b;
    (value * 255.0 + noise * (value * 255.0).min(1.0)).round().clamp(0.0, 255.0) as u8
}

/// A PNG file of red, green and blue.
fn png(bytes: &[u8], depth: png::BitDepth, [width, height]: [u32; 2]) -> Result<Vec<u8>, String> {
    let failed = |error: png::EncodingError| format!("cannot encode the picture: {error}");
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(bytes).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_tells_the_kind() {
        let of = |name: &str, bits| FileKind::of(Path::new(name), bits);
        assert_eq!(of("a.PNG", None), Ok(FileKind::Png8));
        assert_eq!(of("a.png", Some(16)), Ok(FileKind::Png16));
        assert_eq!(of("a.exr", None), Ok(FileKind::Exr));
        assert!(of("a.exr", Some(16)).unwrap_err().contains("floats"));
        for name in ["a.jpg", "a", ".png"] {
            assert!(of(name, None).unwrap_err().contains(".png or .exr"), "{name}");
        }
    }

    #[test]
    fn frames_are_numbered() {
        assert_eq!(frame_path(Path::new("a/way.png"), 7), Path::new("a/way-0007.png"));
    }

    #[test]
    fn files_hold_the_values() {
        let pixels = [[0.0, 0.5, 1.0], [0.25, 2.0, -1.0]];
        let deep = image::load_from_memory(&FileKind::Png16.encode(&pixels, [2, 1]).unwrap()).unwrap().to_rgb16();
        let wanted = [0, 48_192, 65_535, 35_199, 65_535, 0];
        assert!(deep.as_raw().iter().zip(wanted).all(|(a, b)| a.abs_diff(b) < 40), "{:?}", deep.as_raw());
        let plain = image::load_from_memory(&FileKind::Png8.encode(&pixels, [2, 1]).unwrap()).unwrap().to_rgb8();
        let wanted = [0, 188, 255, 137, 255, 0_u8];
        assert!(plain.as_raw().iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 1), "{:?}", plain.as_raw());
        let bytes = FileKind::Exr.encode(&[[0.0, 0.5, 40.0], [0.25, 2.0, 1.0]], [2, 1]).unwrap();
        use exr::prelude::{ReadChannels as _, ReadLayers as _, read};
        let read = read().no_deep_data().largest_resolution_level().rgba_channels(
            |_, _| Vec::new(),
            |all: &mut Vec<[f32; 4]>, _, (r, g, b, a): (f32, f32, f32, f32)| all.push([r, g, b, a]),
        );
        let found = read.first_valid_layer().all_attributes().from_buffered(Cursor::new(bytes)).unwrap();
        let found = found.layer_data.channel_data.pixels;
        assert_eq!(found.iter().map(|p| [p[0], p[1], p[2]]).collect::<Vec<_>>(), [[0.0, 0.5, 40.0], [0.25, 2.0, 1.0]]);
    }
}
