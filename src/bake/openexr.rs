//! Maps as OpenEXR, block by block: scan lines, ZIP compression of 16 lines, channels `Y` or `R`, `G`, `B`.

use super::format::{Format, Shape, Source};
use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::compression::Compression;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::header::Header;
use exr::prelude::{Error, SmallVec, f16};
use std::io::{self, BufWriter, Seek, Write};

/// Writes a picture of floats.
pub(super) fn write(out: impl Write + Seek, shape: &Shape, rows: &mut dyn Source) -> io::Result<()> {
    let is_half = shape.format == Format::Exr16;
    let sample = if is_half { SampleType::F16 } else { SampleType::F32 };
    // The format sorts channels by their names. The number is the channel of the map.
    let channels: &[(&str, usize)] = if shape.channels == 3 { &[("B", 2), ("G", 1), ("R", 0)] } else { &[("Y", 0)] };
    let described = channels.iter().map(|(name, _)| ChannelDescription::named(*name, sample)).collect::<SmallVec<_>>();
    let mut header = Header::new(Text::from("map"), (shape.width as usize, shape.height as usize), described)
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing);
    header.own_attributes.layer_name = None;
    let headers = [header];
    let blocks: Vec<_> = enumerate_ordered_header_block_indices(&headers).collect();
    let [header] = headers;
    let mut failed = None;
    let written = exr::block::write(BufWriter::new(out), SmallVec::from_iter([header]), true, |meta, writer| {
        use exr::block::writer::ChunksWriter as _;
        let mut values = Vec::new();
        for (number, index) in blocks {
            if let Err(error) = rows.read(index.pixel_size.height() as u32, &mut values) {
                failed = Some(error);
                return Err(Error::Aborted);
            }
            let mut data = Vec::with_capacity(values.len() * sample.bytes_per_sample());
            for row in values.chunks(shape.row()) {
                for (_, channel) in channels {
                    let values = row.iter().skip(*channel).step_by(shape.channels);
                    if is_half {
                        data.extend(values.flat_map(|&value| f16::from_f32(value).to_ne_bytes()));
                    } else {
                        data.extend(values.flat_map(|value| value.to_ne_bytes()));
                    }
                }
            }
            let block = UncompressedBlock { index, data };
            writer.write_chunk(number, block.compress_to_chunk(&meta.headers)?)?;
        }
        Ok(())
    });
    match (written, failed) {
        (_, Some(error)) | (Err(Error::Io(error)), None) => Err(error),
        (Err(error), None) => Err(io::Error::other(error.to_string())),
        (Ok(()), None) => Ok(()),
    }
}
