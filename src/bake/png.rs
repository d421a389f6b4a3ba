//! Maps as PNG, row by row.

use super::format::{Format, Shape, Source};
use std::io::{self, BufWriter, Write};

/// Writes a picture of 8 or 16 bits.
pub(super) fn write(out: impl Write, shape: &Shape, rows: &mut dyn Source) -> io::Result<()> {
    let mut encoder = png::Encoder::new(BufWriter::new(out), shape.width, shape.height);
    let is_color = shape.channels == 3;
    encoder.set_color(if is_color { png::ColorType::Rgb } else { png::ColorType::Grayscale });
    let is_deep = shape.format == Format::Png16;
    encoder.set_depth(if is_deep { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    encoder.set_compression(png::Compression::Fast);
    if shape.steps.is_srgb() {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    let mut file = encoder.write_header()?;
    let mut writer = file.stream_writer()?;
    let (mut values, mut bytes) = (Vec::new(), Vec::with_capacity(shape.row() * 2));
    for _ in 0..shape.height {
        rows.read(1, &mut values)?;
        bytes.clear();
        for &value in &values {
            let [high, low] = shape.steps.number(value).to_be_bytes();
            if is_deep {
                bytes.push(high);
            }
            bytes.push(low);
        }
        writer.write_all(&bytes)?;
    }
    writer.finish()?;
    Ok(file.finish()?)
}
