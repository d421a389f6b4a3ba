//! Readers of baked files that share no code with their writers: PNG (RFC 2083), OpenEXR scan lines with ZIP
//! compression, TIFF 6.0 strips without compression, and raw numbers. They read what the baker writes, and no more.

use std::collections::BTreeMap;
use zune_inflate::DeflateDecoder;

/// The numbers of a file, those of a pixel together, row by row from the top.
pub(crate) struct Picture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) channels: usize,
    pub(crate) numbers: Vec<f64>,
}

impl Picture {
    pub(crate) fn at(&self, x: usize, y: usize) -> &[f64] {
        &self.numbers[(y * self.width + x) * self.channels..][..self.channels]
    }
}

fn inflated(bytes: &[u8]) -> Vec<u8> {
    DeflateDecoder::new(bytes).decode_zlib().unwrap()
}

fn u32_be(bytes: &[u8], at: usize) -> usize {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

fn u32_le(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

fn u16_le(bytes: &[u8], at: usize) -> usize {
    usize::from(u16::from_le_bytes(bytes[at..at + 2].try_into().unwrap()))
}

/// A picture, and the names of its chunks.
pub(crate) fn png(bytes: &[u8]) -> (Picture, Vec<String>) {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let (mut at, mut packed, mut names) = (8, Vec::new(), Vec::new());
    while at < bytes.len() {
        let (length, name) = (u32_be(bytes, at), &bytes[at + 4..at + 8]);
        if name == b"IDAT" {
            packed.extend_from_slice(&bytes[at + 8..at + 8 + length]);
        }
        names.push(String::from_utf8(name.to_vec()).unwrap());
        at += length + 12;
    }
    let (width, height, deep, color) = (u32_be(bytes, 16), u32_be(bytes, 20), bytes[24] == 16, bytes[25]);
    let channels = match color {
        0 => 1,
        2 => 3,
        other => panic!("colour type {other}"),
    };
    let pixel = channels * if deep { 2 } else { 1 };
    let (row, rows) = (pixel * width, inflated(&packed));
    let mut plain = vec![0_u8; row * height];
    for y in 0..height {
        let (kind, line) = (rows[y * (row + 1)], &rows[y * (row + 1) + 1..][..row]);
        for x in 0..row {
            let left = if x >= pixel { plain[y * row + x - pixel] } else { 0 };
            let up = if y > 0 { plain[(y - 1) * row + x] } else { 0 };
            let corner = if x >= pixel && y > 0 { plain[(y - 1) * row + x - pixel] } else { 0 };
            let guess = match kind {
                0 => 0,
                1 => left,
                2 => up,
                3 => ((u16::from(left) + u16::from(up)) / 2) as u8,
                4 => paeth(left, up, corner),
                other => panic!("filter {other}"),
            };
            plain[y * row + x] = line[x].wrapping_add(guess);
        }
    }
    let numbers = if deep {
        plain.as_chunks().0.iter().map(|&pair| f64::from(u16::from_be_bytes(pair))).collect()
    } else {
        plain.into_iter().map(f64::from).collect()
    };
    (Picture { width, height, channels, numbers }, names)
}

fn paeth(a: u8, b: u8, c: u8) -> u8 {
    let guess = i16::from(a) + i16::from(b) - i16::from(c);
    let far = |x: u8| (guess - i16::from(x)).abs();
    if far(a) <= far(b) && far(a) <= far(c) {
        a
    } else if far(b) <= far(c) {
        b
    } else {
        c
    }
}

pub(crate) fn r16(bytes: &[u8], width: usize, height: usize) -> Picture {
    assert_eq!(bytes.len(), 2 * width * height);
    let numbers = bytes.as_chunks().0.iter().map(|&pair| f64::from(u16::from_le_bytes(pair))).collect();
    Picture { width, height, channels: 1, numbers }
}

/// Channels are given in the order R, G, B.
pub(crate) fn exr(bytes: &[u8]) -> Picture {
    assert_eq!((u32_le(bytes, 0), bytes[4]), (20_000_630, 2));
    let text = |at: &mut usize| {
        let start = *at;
        while bytes[*at] != 0 {
            *at += 1;
        }
        *at += 1;
        String::from_utf8(bytes[start..*at - 1].to_vec()).unwrap()
    };
    let (mut at, mut attributes) = (8, BTreeMap::new());
    while bytes[at] != 0 {
        let (name, _kind) = (text(&mut at), text(&mut at));
        let length = u32_le(bytes, at);
        attributes.insert(name, at + 4..at + 4 + length);
        at += 4 + length;
    }
    at += 1;
    let mut names = Vec::new();
    let (mut place, mut half) = (attributes["channels"].start, false);
    while bytes[place] != 0 {
        names.push(text(&mut place));
        half = u32_le(bytes, place) == 1;
        place += 16;
    }
    assert_eq!(bytes[attributes["compression"].start], 3, "ZIP of 16 lines");
    let window = attributes["dataWindow"].start;
    assert_eq!((u32_le(bytes, window), u32_le(bytes, window + 4)), (0, 0));
    let (width, height) = (u32_le(bytes, window + 8) + 1, u32_le(bytes, window + 12) + 1);
    let (channels, size) = (names.len(), if half { 2 } else { 4 });
    let mut numbers = vec![0.0; width * height * channels];
    for block in 0..height.div_ceil(16) {
        let start = u32_le(bytes, at + 8 * block);
        let (top, length) = (u32_le(bytes, start), u32_le(bytes, start + 4));
        let lines = 16.min(height - top);
        let packed = &bytes[start + 8..start + 8 + length];
        let raw_length = lines * width * channels * size;
        let raw = if length == raw_length { packed.to_vec() } else { unmixed(inflated(packed)) };
        assert_eq!(raw.len(), raw_length);
        for (i, chunk) in raw.chunks(size).enumerate() {
            let (line, channel, x) = (i / (width * channels), i / width % channels, i % width);
            let channel = channels - 1 - channel;
            let number = if half { half_float(u16_le(chunk, 0)) } else { f64::from(float(chunk)) };
            numbers[((top + line) * width + x) * channels + channel] = number;
        }
    }
    assert!(names == ["Y"] || names == ["B", "G", "R"], "{names:?}");
    Picture { width, height, channels, numbers }
}

fn float(bytes: &[u8]) -> f32 {
    f32::from_le_bytes(bytes.try_into().unwrap())
}

fn half_float(bits: usize) -> f64 {
    let (sign, exponent, fraction) = (bits >> 15, (bits >> 10 & 31) as i32, (bits & 1023) as f64);
    let value =
        if exponent == 0 { fraction * 2.0_f64.powi(-24) } else { (1024.0 + fraction) * 2.0_f64.powi(exponent - 25) };
    if sign == 1 { -value } else { value }
}

/// Undoes the differences and the two halves of OpenEXR's ZIP.
fn unmixed(mut bytes: Vec<u8>) -> Vec<u8> {
    for i in 1..bytes.len() {
        bytes[i] = bytes[i - 1].wrapping_add(bytes[i]).wrapping_sub(128);
    }
    let (first, second) = bytes.split_at(bytes.len().div_ceil(2));
    (0..bytes.len()).map(|i| if i % 2 == 0 { first[i / 2] } else { second[i / 2] }).collect()
}

/// A picture, and its tags with their numbers.
pub(crate) fn tiff(bytes: &[u8]) -> (Picture, BTreeMap<usize, Vec<f64>>) {
    assert_eq!(&bytes[..4], b"II*\0");
    let start = u32_le(bytes, 4);
    let mut tags = BTreeMap::new();
    for entry in 0..u16_le(bytes, start) {
        let at = start + 2 + 12 * entry;
        let (tag, kind, count) = (u16_le(bytes, at), u16_le(bytes, at + 2), u32_le(bytes, at + 4));
        let size = match kind {
            1 | 2 => 1,
            3 => 2,
            4 => 4,
            5 | 12 => 8,
            other => panic!("type {other}"),
        };
        let place = if size * count <= 4 { at + 8 } else { u32_le(bytes, at + 8) };
        let number = |k: usize| match kind {
            1 | 2 => f64::from(bytes[place + k]),
            3 => u16_le(bytes, place + 2 * k) as f64,
            4 => u32_le(bytes, place + 4 * k) as f64,
            12 => f64::from_le_bytes(bytes[place + 8 * k..][..8].try_into().unwrap()),
            _ => f64::NAN,
        };
        tags.insert(tag, (0..count).map(number).collect::<Vec<_>>());
    }
    let one = |tag: usize| tags[&tag][0] as usize;
    let (width, height, channels, bits) = (one(256), one(257), one(277), one(258));
    assert_eq!(one(259), 1, "no compression");
    assert_eq!(one(339), if bits == 32 { 3 } else { 1 }, "floats, or whole numbers");
    let mut numbers = Vec::new();
    for (start, length) in tags[&273].iter().zip(&tags[&279]) {
        for chunk in bytes[*start as usize..][..*length as usize].chunks(bits / 8) {
            numbers.push(if bits == 32 { f64::from(float(chunk)) } else { u16_le(chunk, 0) as f64 });
        }
    }
    assert_eq!(numbers.len(), width * height * channels);
    (Picture { width, height, channels, numbers }, tags)
}
