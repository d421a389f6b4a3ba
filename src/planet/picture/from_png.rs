//! PNG files, row by row: 8 and 16 bits, grey or coloured, plain or interlaced.

use super::budget::Budget;
use super::canvas::{Canvas, Size};
use super::pixels::{Picture, PictureExtent, Texels};
use std::io::{BufRead, Seek};

/// First column and row of each pass of an interlaced picture, and the steps from pixel to pixel and row to row.
const PASSES: [[usize; 4]; 7] =
    [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

/// A row of decoded pixels, or a part of them that lies `step` columns apart.
pub(in crate::planet) struct Run<'a> {
    /// The row.
    pub(in crate::planet) row: usize,
    /// The column of the first pixel.
    pub(in crate::planet) column: usize,
    /// Columns from one to the next.
    pub(in crate::planet) step: usize,
    data: &'a [u8],
    channels: usize,
    is_wide: bool,
}

impl Run<'_> {
    /// Red, green and blue of each pixel, from 0 to 65535. Alpha is ignored.
    pub(in crate::planet) fn colors(&self) -> impl Iterator<Item = [u16; 3]> {
        let sample = |pixel: &[u8], channel: usize| match self.is_wide {
            true => u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]]),
            false => u16::from(pixel[channel]) * 257,
        };
        let pixels = self.data.chunks_exact(self.channels * if self.is_wide { 2 } else { 1 });
        pixels.map(move |pixel| match self.channels {
            1 | 2 => [sample(pixel, 0); 3],
            _ => std::array::from_fn(|channel| sample(pixel, channel)),
        })
    }
}

/// Reads a picture; takes what it needs from the budget.
pub(super) fn read(file: impl BufRead + Seek, extent: PictureExtent, budget: &mut Budget) -> Result<Picture, String> {
    let (decoder, sides, work_bytes) = opened(file)?;
    let size = Size::checked(sides, extent)?;
    let bytes = size.pixels() * size_of::<u16>() as u64;
    budget.take(bytes, work_bytes)?;
    // Colours count by luminance (BT.709).
    let grey = |[r, g, b]: [u16; 3]| match r == g && g == b {
        true => r,
        false => ((u32::from(r) * 2126 + u32::from(g) * 7152 + u32::from(b) * 722 + 5000) / 10_000) as u16,
    };
    let canvas = Canvas::new(size, extent).and_then(|mut canvas| {
        let mut greys: Vec<u16> = Vec::with_capacity(size.width);
        runs(decoder, sides, |run| {
            greys.clear();
            greys.extend(run.colors().map(grey));
            if run.step == 1 {
                canvas.put(run.row, run.column, &greys);
            } else {
                for (i, grey) in greys.iter().enumerate() {
                    canvas.put(run.row, run.column + i * run.step, std::slice::from_ref(grey));
                }
            }
        })?;
        Ok(canvas)
    });
    let (raster, hash) = canvas.inspect_err(|_| budget.give_back(bytes))?.finish(u64::from);
    Ok(Picture { texels: Texels::Grey16(raster), hash, bytes })
}

/// Reads colours. `checked` looks at width and height and makes what gets the runs.
pub(in crate::planet) fn each_run<S>(
    file: impl BufRead + Seek,
    budget: &mut Budget,
    checked: impl FnOnce([usize; 2]) -> Result<S, String>,
    mut put: impl FnMut(&mut S, &Run<'_>),
) -> Result<S, String> {
    let (decoder, sides, work_bytes) = opened(file)?;
    let mut sink = checked(sides)?;
    budget.take(0, work_bytes)?;
    runs(decoder, sides, |run| put(&mut sink, run))?;
    Ok(sink)
}

/// A decoder that has read the header; width and height; bytes of the unpacked picture.
fn opened<F: BufRead + Seek>(file: F) -> Result<(png::Decoder<F>, [usize; 2], u64), String> {
    let mut decoder = png::Decoder::new(file);
    // Palettes become colours; fewer bits become 8.
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(|error| broken(&error))?;
    let pixels = u64::from(header.width) * u64::from(header.height);
    let work_bytes = pixels.saturating_mul(header.bytes_per_pixel() as u64);
    let sides = [header.width as usize, header.height as usize];
    Ok((decoder, sides, work_bytes))
}

fn runs(
    decoder: png::Decoder<impl BufRead + Seek>,
    [width, height]: [usize; 2],
    mut put: impl FnMut(&Run<'_>),
) -> Result<(), String> {
    let mut reader = decoder.read_info().map_err(|error| broken(&error))?;
    let (color, depth) = reader.output_color_type();
    let (channels, is_wide) = (color.samples(), depth == png::BitDepth::Sixteen);
    let pixel_bytes = channels * if is_wide { 2 } else { 1 };
    let plain = [[0, 0, 1, 1]];
    let passes: &[[usize; 4]] = if reader.info().interlaced { &PASSES } else { &plain };
    for &[column, first_row, step, row_step] in passes {
        let columns = width.saturating_sub(column).div_ceil(step);
        if columns == 0 {
            continue;
        }
        for row in (first_row..height).step_by(row_step) {
            let read = reader.next_row().map_err(|error| broken(&error))?;
            let read = read.ok_or("is broken: rows are missing; save the picture anew")?;
            let data = read.data();
            let data = &data[..data.len().min(columns * pixel_bytes)];
            put(&Run { row, column, step, data, channels, is_wide });
        }
    }
    // Chunks after the last row are checked, too.
    reader.next_row().map_err(|error| broken(&error))?;
    Ok(())
}

fn broken(error: &png::DecodingError) -> String {
    format!("is broken: {error}; save the picture anew")
}
