//! OpenEXR files, block by block. Only the wanted channels are kept: that with the heights, or those of colours.
//!
//! The header is checked before any block is read, because block sizes bound what a decoder allocates. Blocks are
//! decoded in groups on all cores; panics are contained ([`super::contain`]).

use super::budget::{Budget, MAX_WORK_BYTES};
use super::canvas::{Canvas, Size};
use super::contain::contained;
use super::pixels::{Picture, PictureExtent, Texels};
use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::Reader;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use rayon::prelude::*;
use std::io::{BufRead, Read as _, Seek};

/// Greatest absolute value of a float picture: metres at an amplitude of 1, far more than any planet needs.
const MAX_VALUE: f32 = 1e6;
/// Most bytes of all headers together.
const MAX_HEADER_BYTES: u64 = 16 << 20;
/// Most bytes of a block of all channels, unpacked.
const MAX_BLOCK_BYTES: usize = 64 << 20;
/// Most bytes of blocks that are decoded at the same time; a single block may be larger.
const MAX_GROUP_BYTES: usize = 128 << 20;
/// Least size counted for a block in bytes: a smaller block takes as long as one of this size.
const LEAST_BLOCK_WORK: u64 = 32 << 10;
/// Most blocks of a picture.
const MAX_BLOCKS: u64 = MAX_WORK_BYTES / LEAST_BLOCK_WORK;

/// The channels that are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::planet) enum Wanted {
    /// The one that says how bright a pixel is.
    Grey,
    /// Red, green and blue; of a picture without them, the brightness thrice.
    Colors,
}

/// Reads a picture; takes what it needs from the budget.
pub(super) fn read(file: impl BufRead + Seek, extent: PictureExtent, budget: &mut Budget) -> Result<Picture, String> {
    let (file, about) = opened(file)?;
    let source = Source::find(&about, Wanted::Grey, |sides| Size::checked(sides, extent))?;
    let bytes = source.size.pixels() * size_of::<f32>() as u64;
    budget.take(bytes, source.work_bytes)?;
    let canvas = Canvas::new(source.size, extent).and_then(|mut canvas| {
        let mut put = |row: usize, column: usize, channels: &[&[f32]]| canvas.put(row, column, channels[0]);
        contained(|| blocks(file, &source, &mut put)).map(|()| canvas)
    });
    let (raster, hash) = canvas.inspect_err(|_| budget.give_back(bytes))?.finish(|texel| u64::from(texel.to_bits()));
    Ok(Picture { texels: Texels::Float(raster), hash, bytes })
}

/// Reads numbers from left to right, in an order of the file's own. `checked` looks at width and height and makes what
/// gets the numbers: row, first column, and as many numbers of each wanted channel.
pub(in crate::planet) fn each_run<S>(
    file: impl BufRead + Seek,
    wanted: Wanted,
    budget: &mut Budget,
    checked: impl FnOnce([usize; 2]) -> Result<S, String>,
    mut put: impl FnMut(&mut S, usize, usize, &[&[f32]]),
) -> Result<S, String> {
    let (file, about) = opened(file)?;
    let mut sink = None;
    let source = Source::find(&about, wanted, |[width, height]| {
        sink = Some(checked([width, height])?);
        Ok(Size { width, height })
    })?;
    budget.take(0, source.work_bytes)?;
    let mut sink = sink.ok_or("has no pixels")?;
    contained(|| blocks(file, &source, &mut |row, column, channels| put(&mut sink, row, column, channels)))?;
    Ok(sink)
}

/// The headers of a file, which is at its start again.
fn opened<F: BufRead + Seek>(mut file: F) -> Result<(F, MetaData), String> {
    let about = contained(|| {
        MetaData::read_from_buffered(file.by_ref().take(MAX_HEADER_BYTES), false).map_err(|error| broken(&error))
    })?;
    file.rewind().map_err(|error| format!("cannot be read: {error}"))?;
    Ok((file, about))
}

/// A channel that is kept.
struct Channel {
    sample: SampleType,
    /// Bytes of a pixel in the channels before it.
    bytes_before: usize,
}

/// The location of the wanted numbers in the file.
struct Source {
    layer: usize,
    size: Size,
    channels: Vec<Channel>,
    /// Bytes of a pixel in all channels.
    pixel_bytes: usize,
    /// Width and height of a block.
    block: [usize; 2],
    work_bytes: u64,
}

impl Source {
    /// Checks everything that a decoder relies on.
    fn find(
        about: &MetaData,
        wanted: Wanted,
        checked: impl FnOnce([usize; 2]) -> Result<Size, String>,
    ) -> Result<Self, String> {
        let usable = |header: &Header| !header.deep && !header.channels.list.is_empty();
        let layer = about.headers.iter().position(usable).ok_or("has no channel of plain pixels")?;
        let header = &about.headers[layer];
        let size = checked([header.layer_size.width(), header.layer_size.height()])?;
        for header in &about.headers {
            check_blocks(header)?;
        }
        let block = block_size(header);
        let pixel_bytes = pixel_bytes(header);
        let blocks = (size.width.div_ceil(block[0]) * size.height.div_ceil(block[1])) as u64;
        if blocks > MAX_BLOCKS {
            let [width, height] = block;
            return Err(format!(
                "is cut into {blocks} blocks of {width} x {height} pixels; save it in scan lines, or in larger tiles \
                 of which {MAX_BLOCKS} suffice"
            ));
        }
        let work_bytes = (size.pixels() * pixel_bytes as u64).max(blocks * LEAST_BLOCK_WORK);
        if header.channels.list.iter().any(|channel| channel.sampling != exr::math::Vec2(1, 1)) {
            return Err(
                "has a channel with fewer numbers than pixels; save the picture anew, without subsampling".to_owned()
            );
        }
        // Channels are in alphabetical order: the first of RGBA would be A.
        let channels = &header.channels.list;
        let named = |name: &str| channels.iter().position(|channel| channel.name.eq_case_insensitive(name));
        let grey = || vec![["Y", "L", "R"].into_iter().find_map(named).unwrap_or(0)];
        let kept = match wanted {
            Wanted::Grey => grey(),
            Wanted::Colors => ["R", "G", "B"].map(named).into_iter().collect::<Option<_>>().unwrap_or_else(grey),
        };
        let bytes_before =
            |kept: usize| channels[..kept].iter().map(|other| other.sample_type.bytes_per_sample()).sum();
        let kept =
            kept.into_iter().map(|at| Channel { sample: channels[at].sample_type, bytes_before: bytes_before(at) });
        Ok(Self { layer, size, channels: kept.collect(), pixel_bytes, block, work_bytes })
    }

    /// Whether a block contains wanted numbers in full resolution.
    fn wants(&self, chunk: &Chunk) -> bool {
        let finest = match &chunk.compressed_block {
            CompressedBlock::Tile(tile) => tile.coordinates.is_largest_resolution_level(),
            _ => true,
        };
        chunk.layer_index == self.layer && finest
    }

    /// The numbers of a channel in a block, row by row.
    fn numbers(&self, block: &UncompressedBlock, channel: &Channel) -> Result<Vec<f32>, String> {
        let width = block.index.pixel_size.width();
        let row_bytes = width * self.pixel_bytes;
        let bytes = channel.sample.bytes_per_sample();
        let of_channel = channel.bytes_before * width..(channel.bytes_before + bytes) * width;
        let number = |bytes: &[u8]| match (channel.sample, bytes) {
            (SampleType::F16, &[a, b]) => half::f16::from_ne_bytes([a, b]).to_f32(),
            (SampleType::F32, &[a, b, c, d]) => f32::from_ne_bytes([a, b, c, d]),
            (SampleType::U32, &[a, b, c, d]) => u32::from_ne_bytes([a, b, c, d]) as f32,
            _ => f32::NAN,
        };
        let rows = block.data.chunks_exact(row_bytes);
        let numbers: Vec<f32> = rows.flat_map(|row| row[of_channel.clone()].chunks_exact(bytes).map(number)).collect();
        if let Some(at) = numbers.iter().position(|number| !number.is_finite() || number.abs() > MAX_VALUE) {
            let (column, row) =
                (block.index.pixel_position.x() + at % width, block.index.pixel_position.y() + at / width);
            return Err(format!("holds {} at pixel ({column}, {row}); use numbers from -1e6 to 1e6", numbers[at]));
        }
        Ok(numbers)
    }
}

fn pixel_bytes(header: &Header) -> usize {
    header.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample()).sum()
}

/// Width and height of the largest block.
fn block_size(header: &Header) -> [usize; 2] {
    match header.blocks {
        BlockDescription::ScanLines => [header.layer_size.width(), header.compression.scan_lines_per_block()],
        BlockDescription::Tiles(tiles) => [tiles.tile_size.width(), tiles.tile_size.height()],
    }
}

/// Blocks must not be empty, nor take unreasonable memory: decoders allocate what the header says.
fn check_blocks(header: &Header) -> Result<(), String> {
    let [width, height] = block_size(header);
    let bytes = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(pixel_bytes(header)));
    match bytes {
        Some(1..=MAX_BLOCK_BYTES) => Ok(()),
        Some(0) => Err("is broken: its blocks are empty; save the picture anew".to_owned()),
        _ => Err(format!(
            "has blocks of {width} x {height} pixels in {} channels, which is more than {} MiB each; save it in \
             smaller tiles or in scan lines, with ZIP compression, or with fewer channels",
            header.channels.list.len(),
            MAX_BLOCK_BYTES >> 20
        )),
    }
}

/// Gives all blocks to `put`, line by line: row, first column, numbers of each channel.
fn blocks(
    file: impl BufRead + Seek,
    source: &Source,
    put: &mut impl FnMut(usize, usize, &[&[f32]]),
) -> Result<(), String> {
    let reader = Reader::read_from_buffered(file, false).map_err(|error| broken(&error))?;
    let about = reader.meta_data().clone();
    let mut chunks = reader.all_chunks(false).map_err(|error| broken(&error))?;
    let [block_width, block_height] = source.block;
    let columns = source.size.width.div_ceil(block_width);
    let mut seen = vec![false; columns * source.size.height.div_ceil(block_height)];
    let at_once = (MAX_GROUP_BYTES / (block_width * block_height * source.pixel_bytes))
        .clamp(1, 4 * rayon::current_num_threads().max(1));
    let mut missing = seen.len();
    while missing > 0 {
        let wanted = chunks.by_ref().filter(|chunk| chunk.as_ref().map_or(true, |chunk| source.wants(chunk)));
        let group: Vec<Chunk> = wanted.take(at_once).collect::<Result<_, _>>().map_err(|error| broken(&error))?;
        if group.is_empty() {
            return Err("is broken: blocks are missing; save the picture anew".to_owned());
        }
        let decoded: Vec<(BlockIndex, Vec<Vec<f32>>)> =
            group.into_par_iter().map(|chunk| contained(|| decode(chunk, &about, source))).collect::<Result<_, _>>()?;
        for (index, numbers) in decoded {
            let (column, row) = (index.pixel_position.x(), index.pixel_position.y());
            let number = row / block_height * columns + column / block_width;
            match seen.get_mut(number) {
                Some(seen) if !*seen => *seen = true,
                _ => return Err("is broken: a block is there twice; save the picture anew".to_owned()),
            }
            missing -= 1;
            let width = index.pixel_size.width();
            for line in 0..index.pixel_size.height() {
                let of_line: Vec<&[f32]> =
                    numbers.iter().map(|numbers| &numbers[line * width..(line + 1) * width]).collect();
                put(row + line, column, &of_line);
            }
        }
    }
    Ok(())
}

fn decode(chunk: Chunk, about: &MetaData, source: &Source) -> Result<(BlockIndex, Vec<Vec<f32>>), String> {
    check_dwa(&chunk, &about.headers[source.layer])?;
    let block = UncompressedBlock::decompress_chunk(chunk, about, false).map_err(|error| broken(&error))?;
    let numbers = source.channels.iter().map(|channel| source.numbers(&block, channel)).collect::<Result<_, _>>()?;
    Ok((block.index, numbers))
}

/// Blocks compressed with DWA begin with the sizes of their sections, and the decoder allocates them.
fn check_dwa(chunk: &Chunk, header: &Header) -> Result<(), String> {
    if !matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return Ok(());
    }
    let bytes = match &chunk.compressed_block {
        CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &block.compressed_pixels_le,
        _ => return Ok(()),
    };
    let number = |i: usize| bytes.get(8 * i..8 * i + 8).and_then(|b| b.try_into().ok()).map_or(0, u64::from_le_bytes);
    let [width, height] = block_size(header).map(|side| side.next_multiple_of(8) as u64);
    let samples = width * height * header.channels.list.len() as u64;
    let bytes = samples * 4;
    // Bytes of unchanged channels; packed and unpacked run lengths; coefficients of squares of 8 by 8, and their means.
    let limits = [(1, bytes), (6, 2 * bytes), (7, bytes), (8, samples), (9, samples)];
    match limits.into_iter().find(|&(i, most)| number(i) > most) {
        Some(_) => Err("is broken: a block is larger than it may be; save the picture anew".to_owned()),
        None => Ok(()),
    }
}

fn broken(error: &exr::error::Error) -> String {
    match error {
        exr::error::Error::NotSupported(what) => {
            format!("cannot be read ({what}); save it with ZIP, PIZ or no compression, in plain layers")
        }
        error => format!("is broken: {error}; save the picture anew"),
    }
}
