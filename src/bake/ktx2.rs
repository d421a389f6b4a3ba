//! Maps as KTX2 textures with all mip levels (Khronos, "KTX file format specification, version 2.0"), level by level
//! while rows come: each row of a level is written at its place, and two rows make one of the next level.
//!
//! A texel of a coarser level is the mean of four, of a map of numbers (biomes) the first of the four. The six faces of
//! a cube are one texture. One channel has 16 bits; vectors have 16 bits in four channels, colours 8 bits as sRGB, with
//! an alpha of 1.

use super::format::{Shape, Source};
use super::maps::{Map, Range};
use std::fs::File;
use std::io::{self, Seek as _, SeekFrom, Write as _};

const IDENTIFIER: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";
/// Bytes of the identifier, the header and the index before the levels.
const HEAD: u64 = 12 + 9 * 4 + 4 * 4 + 2 * 8;
/// Bytes of a level in the index.
const LEVEL: u64 = 3 * 8;

/// A kind of texel: what Vulkan calls it, its bytes, channels and bits.
struct Texel {
    vk_format: u32,
    channels: u32,
    bits: u32,
    is_srgb: bool,
    is_uint: bool,
}

impl Texel {
    fn of(map: Map, shape: &Shape) -> Self {
        let is_uint = map.range() == Range::Numbers;
        match (shape.channels, shape.steps.is_srgb()) {
            // VK_FORMAT_R8G8B8A8_SRGB, R16G16B16A16_UNORM, R16_UINT, R16_UNORM
            (3, true) => Self { vk_format: 43, channels: 4, bits: 8, is_srgb: true, is_uint },
            (3, false) => Self { vk_format: 91, channels: 4, bits: 16, is_srgb: false, is_uint },
            _ if is_uint => Self { vk_format: 74, channels: 1, bits: 16, is_srgb: false, is_uint },
            _ => Self { vk_format: 70, channels: 1, bits: 16, is_srgb: false, is_uint },
        }
    }

    fn bytes(&self) -> u64 {
        u64::from(self.channels * self.bits / 8)
    }

    /// The data format descriptor (Khronos, "Khronos data format specification, version 1.3", chapter 5).
    fn descriptor(&self) -> Vec<u8> {
        let (block, linear_alpha, alpha) = (24 + 16 * self.channels, 0x10, 15);
        let (model_rgbsda, primaries_bt709) = (1, 1);
        let mut words = vec![
            4 + block,
            0,
            2 | block << 16,
            model_rgbsda | primaries_bt709 << 8 | if self.is_srgb { 2 } else { 1 } << 16,
            0,
            self.bytes() as u32,
            0,
        ];
        for channel in 0..self.channels {
            let kind = match channel {
                3 if self.is_srgb => alpha | linear_alpha,
                3 => alpha,
                other => other,
            };
            let most = if self.is_uint { 1 } else { (1 << self.bits) - 1 };
            words.extend([(channel * self.bits) | ((self.bits - 1) << 16) | (kind << 24), 0, 0, most]);
        }
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// One mip level.
struct Level {
    width: usize,
    height: usize,
    /// Where the first face is in the file.
    start: u64,
    /// The row that waits for the next one.
    waiting: Option<Vec<f32>>,
    /// Rows of this face that are written.
    rows: usize,
}

/// Writes a texture of one picture, or of six faces.
pub(super) fn write(file: &mut File, map: Map, shape: &Shape, faces: &mut [impl Source]) -> io::Result<()> {
    let texel = Texel::of(map, shape);
    let (mut levels, head) = layout(&texel, shape, faces.len() as u64);
    file.write_all(&head)?;
    let mut row = Vec::new();
    for (number, face) in faces.iter_mut().enumerate() {
        for level in &mut levels {
            (level.rows, level.waiting) = (0, None);
        }
        for _ in 0..shape.height {
            face.read(1, &mut row)?;
            put(file, &mut levels, &row, number as u64, &texel, shape)?;
        }
    }
    Ok(())
}

/// The levels, the largest first, and the bytes before them. The file has the smallest level first.
fn layout(texel: &Texel, shape: &Shape, faces: u64) -> (Vec<Level>, Vec<u8>) {
    let count = shape.width.max(shape.height).ilog2() + 1;
    let descriptor = texel.descriptor();
    let written_by = concat!("KTXwriter\0tellus ", env!("CARGO_PKG_VERSION"), "\0");
    let mut pairs = Vec::new();
    for pair in ["KTXorientation\0rd\0", written_by] {
        pairs.extend((pair.len() as u32).to_le_bytes());
        pairs.extend(pair.bytes());
        pairs.resize(pairs.len().next_multiple_of(4), 0);
    }
    let descriptor_start = HEAD + LEVEL * u64::from(count);
    let pairs_start = descriptor_start + descriptor.len() as u64;
    let mut levels = Vec::new();
    let mut start = pairs_start + pairs.len() as u64;
    for level in (0..count).rev() {
        let [width, height] = [shape.width, shape.height].map(|side| (side >> level).max(1) as usize);
        start = start.next_multiple_of(texel.bytes().max(4));
        levels.push(Level { width, height, start, waiting: None, rows: 0 });
        start += (width * height) as u64 * texel.bytes() * faces;
    }
    levels.reverse();
    let bytes_of_number = if texel.bits == 16 { 2 } else { 1 };
    let header = [texel.vk_format, bytes_of_number, shape.width, shape.height, 0, 0, faces as u32, count, 0]
        .map(u32::to_le_bytes);
    let index = [descriptor_start as u32, descriptor.len() as u32, pairs_start as u32, pairs.len() as u32];
    let mut head =
        [&IDENTIFIER[..], header.as_flattened(), index.map(u32::to_le_bytes).as_flattened(), &[0; 16]].concat();
    for level in &levels {
        let length = (level.width * level.height) as u64 * texel.bytes() * faces;
        head.extend([level.start, length, length].map(u64::to_le_bytes).as_flattened());
    }
    head.extend(descriptor);
    head.extend(pairs);
    (levels, head)
}

/// Writes a row of the first of some levels, and the rows of coarser ones that it completes.
fn put(file: &mut File, levels: &mut [Level], row: &[f32], face: u64, texel: &Texel, shape: &Shape) -> io::Result<()> {
    let [level, coarser @ ..] = levels else { return Ok(()) };
    let mut bytes = Vec::with_capacity(level.width * texel.bytes() as usize);
    for values in row.chunks(shape.channels) {
        let numbers = values.iter().map(|&value| shape.steps.number(value));
        for number in numbers.chain((texel.channels == 4).then_some(u16::MAX)) {
            let [low, high] = number.to_le_bytes();
            bytes.push(low);
            if texel.bits == 16 {
                bytes.push(high);
            }
        }
    }
    let width = level.width as u64 * texel.bytes();
    let place = level.start + (face * level.height as u64 + level.rows as u64) * width;
    file.seek(SeekFrom::Start(place))?;
    file.write_all(&bytes)?;
    level.rows += 1;
    let Some(next) = coarser.first() else { return Ok(()) };
    // The last row of an odd number belongs to no row of the next level.
    if next.rows == next.height {
        return Ok(());
    }
    let halves = match level.waiting.take() {
        Some(above) => halved(&above, row, next.width, texel, shape.channels),
        None if level.height == 1 => halved(row, row, next.width, texel, shape.channels),
        None => {
            level.waiting = Some(row.to_vec());
            return Ok(());
        }
    };
    put(file, coarser, &halves, face, texel, shape)
}

/// A row of the next level of two rows.
fn halved(above: &[f32], below: &[f32], width: usize, texel: &Texel, channels: usize) -> Vec<f32> {
    let last = above.len() / channels - 1;
    let mut halves = Vec::with_capacity(width * channels);
    for x in 0..width {
        for channel in 0..channels {
            let [left, right] = [2 * x, (2 * x + 1).min(last)].map(|x| x * channels + channel);
            let mean = 0.25 * (above[left] + above[right] + below[left] + below[right]);
            halves.push(if texel.is_uint { above[left] } else { mean });
        }
    }
    halves
}
