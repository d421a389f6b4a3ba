//! Pictures with changed bytes, for readers of files of strangers.
#![allow(dead_code, unreachable_pub)]

use super::dice::Dice;

/// A number below a count.
pub fn pick(dice: &mut Dice, count: usize) -> usize {
    ((dice.roll() * count as f64) as usize).min(count.saturating_sub(1))
}

/// Bytes of a PNG with some changed. Checksums are made right again, or nothing but checksums would be tested.
pub fn changed_png(png: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = png.to_vec();
    for _ in 0..1 + pick(dice, 4) {
        let at = 8 + pick(dice, bytes.len().saturating_sub(8));
        match pick(dice, 4) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..(at + 1 + pick(dice, 8)).min(bytes.len()))),
            _ => bytes[at.min(png.len() - 1)] = (dice.roll() * 256.0) as u8,
        }
        if bytes.len() < 16 {
            return bytes;
        }
    }
    let mut at = 8;
    while let Some(length) = bytes.get(at..at + 4).map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]]) as usize) {
        let end = at.saturating_add(8).saturating_add(length);
        if end + 4 > bytes.len() {
            break;
        }
        let sum = crc(&bytes[at + 4..end]).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&sum);
        at = end + 4;
    }
    bytes
}

/// The checksum of PNG (ISO 3309).
fn crc(bytes: &[u8]) -> u32 {
    let step = |sum: u32, byte: &u8| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| if sum & 1 == 1 { 0xEDB8_8320 ^ (sum >> 1) } else { sum >> 1 })
    };
    !bytes.iter().fold(!0, step)
}
