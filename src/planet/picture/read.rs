//! PNG and OpenEXR files, and their unfolding into rasters.

use super::{Picture, PictureLayout, Texels};
use crate::sphere::raster::{Raster, Texel};
use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek as _};
use std::path::Path;

/// Most pixels of a picture: 32768 x 16384.
const MAX_PIXELS: usize = 1 << 29;
/// Fewest pixels on the side of a cube's face, and on the height of an equirectangular picture.
const LEAST_SIDE: usize = 4;
/// Greatest number a float picture may hold: metres at an amplitude of 1, and far more than any planet bears.
const MAX_VALUE: f32 = 1e6;

/// Reads a picture in a layout; says what is wrong with it and what would be right.
pub(super) fn read(path: &Path, layout: PictureLayout) -> Result<Picture, String> {
    let shown = path.display();
    if path.is_dir() {
        return Err(format!("{shown} is a folder; name a PNG or EXR picture in it"));
    }
    let mut file = match File::open(path) {
        Ok(file) => BufReader::new(file),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(format!("there is no file {shown}; put the picture there or correct the path"));
        }
        Err(error) => return Err(format!("{shown} cannot be read: {error}")),
    };
    let mut start = [0; 4];
    let known = file.read_exact(&mut start).and_then(|()| file.rewind()).is_ok();
    let picture = match start {
        [0x89, b'P', b'N', b'G'] if known => png(file, layout),
        [0x76, 0x2f, 0x31, 0x01] if known => exr(file, layout),
        _ => Err("is neither PNG nor OpenEXR; save the picture as one of them".to_owned()),
    };
    picture.map_err(|problem| format!("{shown} {problem}"))
}

fn png(file: BufReader<File>, layout: PictureLayout) -> Result<Picture, String> {
    let broken = |error: png::DecodingError| format!("is broken: {error}; save the picture anew");
    let mut decoder = png::Decoder::new(file);
    // Palettes become colours, fewer bits become 8.
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let size = [reader.info().width as usize, reader.info().height as usize];
    check_size(size, layout)?;
    let (color, depth) = reader.output_color_type();
    let mut bytes = vec![0; reader.output_buffer_size().ok_or("is too large for this machine's memory")?];
    reader.next_frame(&mut bytes).map_err(broken)?;
    let channels = color.samples();
    let sample = |pixel: &[u8], channel: usize| match depth {
        png::BitDepth::Sixteen => u32::from(u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]])),
        _ => u32::from(pixel[channel]) * 257,
    };
    // Colours count by their luminance (BT.709); how opaque they are counts nothing.
    let grey = |pixel: &[u8]| match channels {
        1 | 2 => sample(pixel, 0) as u16,
        _ => ((sample(pixel, 0) * 2126 + sample(pixel, 1) * 7152 + sample(pixel, 2) * 722 + 5000) / 10_000) as u16,
    };
    let bytes_per_pixel = channels * if depth == png::BitDepth::Sixteen { 2 } else { 1 };
    let texels: Vec<u16> = bytes.chunks_exact(bytes_per_pixel).map(grey).collect();
    drop(bytes);
    let hash = hash(layout, size, texels.iter().map(|&t| u64::from(t)));
    Ok(Picture { texels: Texels::Grey16(raster(texels, size, layout)), hash })
}

fn exr(file: BufReader<File>, layout: PictureLayout) -> Result<Picture, String> {
    use exr::prelude::*;
    let broken = |error: exr::error::Error| format!("is broken: {error}; save the picture anew");
    let mut file = file;
    let about = MetaData::read_from_buffered(&mut file, false).map_err(broken)?;
    file.rewind().map_err(|error| format!("cannot be read: {error}"))?;
    let size = about.headers.first().map_or(Vec2(0, 0), |header| header.layer_size);
    let size = [size.width(), size.height()];
    check_size(size, layout)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(file)
        .map_err(broken)?;
    let channels = &image.layer_data.channel_data.list;
    // Channels stand in the order of the alphabet: the first of RGBA would be A.
    let named = |name: &str| channels.iter().find(|channel| channel.name.eq_case_insensitive(name));
    let channel = ["Y", "L", "R"].into_iter().find_map(named).or(channels.first()).ok_or("has no channel")?;
    let texels: Vec<f32> = channel.sample_data.values_as_f32().collect();
    drop(image);
    if texels.len() != size[0] * size[1] {
        return Err(
            "has fewer numbers than pixels in its channel; save the picture anew, without subsampling".to_owned()
        );
    }
    if let Some(at) = texels.iter().position(|t| !t.is_finite() || t.abs() > MAX_VALUE) {
        let (column, row) = (at % size[0], at / size[0]);
        return Err(format!("holds {} at pixel ({column}, {row}); use numbers from -1e6 to 1e6", texels[at]));
    }
    let hash = hash(layout, size, texels.iter().map(|t| u64::from(t.to_bits())));
    Ok(Picture { texels: Texels::Float(raster(texels, size, layout)), hash })
}

fn check_size([width, height]: [usize; 2], layout: PictureLayout) -> Result<(), String> {
    let (right, words) = match layout {
        PictureLayout::Equirectangular => {
            (width == 2 * height && height >= LEAST_SIDE, "an equirectangular picture is twice as wide as high")
        }
        PictureLayout::CubeCross => {
            (width * 3 == height * 4 && width >= 4 * LEAST_SIDE, "a cube cross is 4 squares wide and 3 high")
        }
        PictureLayout::CubeStrip => (
            (width == 6 * height || height == 6 * width) && width.min(height) >= LEAST_SIDE,
            "a cube strip is 6 squares in a row or a column",
        ),
    };
    if width.saturating_mul(height) > MAX_PIXELS {
        return Err(format!("is {width} x {height} pixels; use at most as many as 32768 x 16384"));
    }
    if !right {
        return Err(format!("is {width} x {height} pixels; {words}, with squares of at least {LEAST_SIDE} pixels"));
    }
    Ok(())
}

fn raster<T: Texel>(texels: Vec<T>, [width, height]: [usize; 2], layout: PictureLayout) -> Raster<T> {
    // The column and row of each face in squares, in the order of the faces.
    let (side, squares) = match layout {
        PictureLayout::Equirectangular => return Raster::globe(height, texels),
        PictureLayout::CubeCross => (height / 3, [(1, 1), (3, 1), (2, 1), (0, 1), (1, 0), (1, 2)]),
        PictureLayout::CubeStrip if width > height => (height, std::array::from_fn(|face| (face, 0))),
        PictureLayout::CubeStrip => (width, std::array::from_fn(|face| (0, face))),
    };
    let mut faces = Vec::with_capacity(6 * side * side);
    for (column, row) in squares {
        for line in row * side..(row + 1) * side {
            faces.extend_from_slice(&texels[line * width + column * side..][..side]);
        }
    }
    drop(texels);
    Raster::cube(side, faces)
}

/// Sixty-four bits that differ for different pictures.
fn hash(layout: PictureLayout, size: [usize; 2], texels: impl Iterator<Item = u64>) -> u64 {
    let start = [layout as u64, size[0] as u64, size[1] as u64].into_iter();
    start.chain(texels).fold(0xcbf2_9ce4_8422_2325, |hash, number| {
        let mixed = (hash ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    })
}
