//! Rivers wind: on each finer level the pieces of coarser reaches are cut anew, bent a little, and their width varies.

use super::grid::RATIO;
use super::reach::Piece;
use crate::world::noise::mix;

/// Pieces of a piece of the level before.
pub(super) const REFINED: usize = 4;
/// How far a piece bends to one side when it is refined, by its length, and the length in widths of the river from
/// which it does: rivers wind at about eleven widths (Leopold and Wolman 1960).
const BEND: f64 = 0.09;
const BENDS_FROM: f64 = 4.0;
/// How much wider or narrower a river is between the ends of a piece than at them, by its width.
const SWELL: f64 = 0.3;

/// Cuts a piece of the level before into those of the next level, bent to one side as rivers wind. Its ends keep their
/// places and widths.
pub(super) fn refine(piece: &Piece, each: &mut impl FnMut(Piece)) {
    let length = 1.0 / piece.line.per_length2.sqrt();
    let widths = length / (2.0 * piece.stream.channel.bank_rad + 1e-30);
    // The banks of a piece shorter than the river is wide would be ragged.
    let free = ((widths - BENDS_FROM) / BENDS_FROM).clamp(0.0, 1.0);
    let [aside, swelling] = numbers_of(piece);
    piece.refined(REFINED, RATIO as f64, [BEND * free * aside, SWELL * free * swelling], each);
}

/// Two numbers from -1 to 1: a pure function of the start of a piece.
fn numbers_of(piece: &Piece) -> [f64; 2] {
    let [x, y, z] = piece.line.start.to_array().map(f64::to_bits);
    let bits = mix(mix(mix(x) ^ y) ^ z);
    [bits, mix(bits)].map(|bits| (bits >> 11) as f64 * (2.0 / (1_u64 << 53) as f64) - 1.0)
}
