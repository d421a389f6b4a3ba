//! Pictures of a set in PNG, JPEG or OpenEXR, as squares of [`SIDE`](super::SIDE) texels in linear numbers.

use super::shrink::{Pixel, Shrink};
use crate::planet::mesh::linear_from_srgb;
use crate::planet::picture::contain::contained;
use crate::planet::picture::{Budget, Wanted, exr_runs, png_runs};
use std::io::{BufRead, Seek};
use std::sync::OnceLock;

/// Most pixels along a side of a picture of a texture set.
pub const MAX_TEXTURE_SIDE: usize = 8192;

/// The meaning of the numbers of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbers {
    /// Colours: sRGB in PNG and JPEG, linear in OpenEXR.
    Colors,
    /// Three numbers, such as those of a normal.
    Plain,
    /// One number: that of a grey picture, the luminance of another.
    Grey,
}

/// Reads a picture. Its work is taken from the budget of the planet.
pub(super) fn texels(
    mut file: impl BufRead + Seek,
    numbers: Numbers,
    budget: &mut Budget,
) -> Result<Vec<Pixel>, String> {
    let mut start = [0; 4];
    let known = file.read_exact(&mut start).and_then(|()| file.rewind()).is_ok();
    let shrink = match start {
        [0x89, b'P', b'N', b'G'] if known => contained(|| png(file, numbers, budget)),
        [0xff, 0xd8, ..] if known => contained(|| jpeg(file, numbers, budget)),
        [0x76, 0x2f, 0x31, 0x01] if known => exr(file, numbers, budget),
        _ => Err("is neither PNG, JPEG nor OpenEXR; save the picture as one of them".to_owned()),
    }?;
    let mut texels = shrink.finish();
    if numbers == Numbers::Grey {
        texels.iter_mut().for_each(|texel| *texel = [luminance(*texel); 3]);
    }
    Ok(texels)
}

/// Luminance of a linear colour (BT.709).
pub(super) fn luminance([r, g, b]: Pixel) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn checked(size: [usize; 2]) -> Result<Shrink, String> {
    let [width, height] = size;
    if width.max(height) > MAX_TEXTURE_SIDE || width.min(height) == 0 {
        return Err(format!("is {width} x {height} pixels; use 1 to {MAX_TEXTURE_SIDE} along a side"));
    }
    Ok(Shrink::new(size))
}

/// Linear numbers of those of 16 bits.
fn table(numbers: Numbers) -> &'static [f32] {
    static TABLES: [OnceLock<Vec<f32>>; 2] = [const { OnceLock::new() }; 2];
    let is_srgb = numbers == Numbers::Colors;
    TABLES[usize::from(is_srgb)].get_or_init(|| {
        let share = |number: u16| f32::from(number) / 65535.0;
        (0..=u16::MAX).map(|number| if is_srgb { linear_from_srgb(share(number)) } else { share(number) }).collect()
    })
}

fn png(file: impl BufRead + Seek, numbers: Numbers, budget: &mut Budget) -> Result<Shrink, String> {
    let table = table(numbers);
    png_runs(file, budget, checked, |shrink, run| {
        let pixels = run.colors().map(|color| color.map(|number| table[usize::from(number)]));
        shrink.add(run.row, run.column, run.step, pixels);
    })
}

fn jpeg(file: impl BufRead + Seek, numbers: Numbers, budget: &mut Budget) -> Result<Shrink, String> {
    let broken = |why: &dyn std::fmt::Display| format!("is broken: {why}; save the picture anew");
    let mut decoder = zune_jpeg::JpegDecoder::new(file);
    decoder.decode_headers().map_err(|error| broken(&error))?;
    let (width, height) = decoder.dimensions().ok_or("is broken; save the picture anew")?;
    let mut shrink = checked([width, height])?;
    budget.take(0, 3 * (width * height) as u64)?;
    let raw = decoder.decode().map_err(|error| broken(&error))?;
    let table = table(numbers);
    let channels = raw.len() / (width * height);
    for (row, line) in raw.chunks_exact((width * channels).max(1)).enumerate() {
        let pixels = line.chunks_exact(channels.max(1)).map(|pixel| {
            let linear = |byte: u8| table[usize::from(byte) * 257];
            match *pixel {
                [r, g, b, ..] => [r, g, b].map(linear),
                [grey, ..] => [linear(grey); 3],
                [] => [0.0; 3],
            }
        });
        shrink.add(row, 0, 1, pixels);
    }
    Ok(shrink)
}

fn exr(file: impl BufRead + Seek, numbers: Numbers, budget: &mut Budget) -> Result<Shrink, String> {
    let wanted = if numbers == Numbers::Grey { Wanted::Grey } else { Wanted::Colors };
    exr_runs(file, wanted, budget, checked, |shrink, row, column, channels| match channels {
        [r, g, b] => {
            let pixels = r.iter().zip(*g).zip(*b).map(|((r, g), b)| [*r, *g, *b]);
            shrink.add(row, column, 1, pixels);
        }
        [grey, ..] => shrink.add(row, column, 1, grey.iter().map(|grey| [*grey; 3])),
        [] => {}
    })
}
