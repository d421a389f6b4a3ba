//! Binary glTF 2.0 (Khronos 2021, "glTF 2.0 specification"): numbers of the specification, and the chunks of a file.

use serde_json::Value;
use std::io::{self, Write};

/// Types of numbers.
pub(super) const FLOAT: u32 = 5126;
pub(super) const UNSIGNED_INT: u32 = 5125;
pub(super) const UNSIGNED_SHORT: u32 = 5123;
pub(super) const BYTE: u32 = 5120;
/// Uses of a part of the binary chunk.
pub(super) const ARRAY_BUFFER: u32 = 34_962;
pub(super) const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
/// Bytes of the header of a file and of a chunk.
const HEAD: usize = 12;
const CHUNK_HEAD: usize = 8;

/// Writes a file: a document, and a binary chunk of `length` bytes, a multiple of four, that `parts` writes. `instead`:
/// what the message of a file that would be too long advises.
pub(super) fn encode<W: Write>(
    mut out: W,
    document: &Value,
    length: usize,
    instead: &str,
    parts: impl FnOnce(&mut W) -> io::Result<()>,
) -> io::Result<()> {
    let mut json = serde_json::to_vec(document)?;
    json.resize(padded(json.len()), b' ');
    // A chunk without bytes is left out.
    let chunk = if length > 0 { CHUNK_HEAD + length } else { 0 };
    let number = |length: usize| {
        u32::try_from(length).map(u32::to_le_bytes).map_err(|_| {
            let message = format!("a GLB holds 4 GiB; use {instead}");
            io::Error::new(io::ErrorKind::InvalidInput, message)
        })
    };
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&number(HEAD + CHUNK_HEAD + json.len() + chunk)?)?;
    out.write_all(&number(json.len())?)?;
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    if length > 0 {
        out.write_all(&number(length)?)?;
        out.write_all(b"BIN\0")?;
        parts(&mut out)?;
    }
    out.flush()
}

/// Writes the bytes between a part of some length and the next one.
pub(super) fn padding(out: &mut impl Write, length: usize) -> io::Result<()> {
    out.write_all(&[0; 3][..padded(length) - length])
}

/// The next multiple of four: chunks and numbers begin there.
pub(super) fn padded(length: usize) -> usize {
    length.next_multiple_of(4)
}

pub(super) fn floats(out: &mut impl Write, values: &[f32]) -> io::Result<()> {
    values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

pub(super) fn shorts(out: &mut impl Write, values: &[u16]) -> io::Result<()> {
    values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

/// Shares, 0 to 1, as whole numbers of 16 bits.
pub(super) fn share_shorts<const N: usize>(shares: [f32; N]) -> [u16; N] {
    shares.map(|share| (share * 65_535.0).round() as u16)
}
