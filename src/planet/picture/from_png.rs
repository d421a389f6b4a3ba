//! PNG files, row by row: 8 and 16 bits, grey or coloured, plain or interlaced.

use super::budget::Budget;
use super::canvas::{Canvas, Size};
use super::pixels::{Picture, PictureExtent, Texels};
use std::io::{BufRead, Seek};

/// First column and row of each pass of an interlaced picture, and the steps from pixel to pixel and row to row.
const PASSES: [[usize; 4]; 7] =
    [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

/// Reads a picture; takes what it needs from the budget.
pub(super) fn read(file: impl BufRead + Seek, extent: PictureExtent, budget: &mut Budget) -> Result<Picture, String> {
    let mut decoder = png::Decoder::new(file);
    // Palettes become colours; fewer bits become 8.
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(|error| broken(&error))?;
    let size = Size::checked([header.width as usize, header.height as usize], extent)?;
    let bytes = size.pixels() * size_of::<u16>() as u64;
    budget.take(bytes, size.pixels() * header.bytes_per_pixel() as u64)?;
    let canvas = rows(decoder, size, extent).inspect_err(|_| budget.give_back(bytes))?;
    let (raster, hash) = canvas.finish(u64::from);
    Ok(Picture { texels: Texels::Grey16(raster), hash, bytes })
}

fn rows(decoder: png::Decoder<impl BufRead + Seek>, size: Size, extent: PictureExtent) -> Result<Canvas<u16>, String> {
    let mut canvas = Canvas::new(size, extent)?;
    let mut reader = decoder.read_info().map_err(|error| broken(&error))?;
    let (color, depth) = reader.output_color_type();
    let (channels, wide) = (color.samples(), depth == png::BitDepth::Sixteen);
    let sample = |pixel: &[u8], channel: usize| match wide {
        true => u32::from(u16::from_be_bytes([pixel[2 * channel], pixel[2 * channel + 1]])),
        false => u32::from(pixel[channel]) * 257,
    };
    // Colours count by luminance (BT.709); alpha is ignored.
    let grey = |pixel: &[u8]| match channels {
        1 | 2 => sample(pixel, 0) as u16,
        _ => ((sample(pixel, 0) * 2126 + sample(pixel, 1) * 7152 + sample(pixel, 2) * 722 + 5000) / 10_000) as u16,
    };
    let pixel_bytes = channels * if wide { 2 } else { 1 };
    let interlaced = reader.info().interlaced;
    let mut greys: Vec<u16> = Vec::with_capacity(size.width);
    let mut next = |wanted: usize, greys: &mut Vec<u16>| {
        let row = reader
            .next_row()
            .map_err(|error| broken(&error))?
            .ok_or("is broken: rows are missing; save the picture anew")?;
        greys.clear();
        greys.extend(row.data().chunks_exact(pixel_bytes).take(wanted).map(grey));
        Ok::<(), String>(())
    };
    if !interlaced {
        for row in 0..size.height {
            next(size.width, &mut greys)?;
            canvas.put(row, 0, &greys);
        }
    } else {
        for [first_column, first_row, step, row_step] in PASSES {
            let columns = size.width.saturating_sub(first_column).div_ceil(step);
            if columns == 0 {
                continue;
            }
            for row in (first_row..size.height).step_by(row_step) {
                next(columns, &mut greys)?;
                for (i, grey) in greys.iter().enumerate() {
                    canvas.put(row, first_column + i * step, std::slice::from_ref(grey));
                }
            }
        }
    }
    // Chunks after the last row are checked, too.
    reader.next_row().map_err(|error| broken(&error))?;
    Ok(canvas)
}

fn broken(error: &png::DecodingError) -> String {
    format!("is broken: {error}; save the picture anew")
}
