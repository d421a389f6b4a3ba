//! Rivers wind: on each finer level the pieces of coarser reaches are cut anew and bent a little.

use super::grid::RATIO;
use super::reach::Piece;
use crate::world::noise::mix;

/// Pieces of a piece of the level before.
pub(super) const REFINED: usize = 4;
/// How far a piece bends to one side when it is refined, by its length, and the length in widths of the river from
/// which it does: rivers wind at about eleven widths (Leopold and Wolman 1960).
const BEND: f64 = 0.09;
const BENDS_FROM: f64 = 4.0;

/// Cuts a piece of the level before into those of the next level, bent to one side as rivers wind.
pub(super) fn refine(piece: &Piece, each: &mut impl FnMut(Piece)) {
    let length = 1.0 / piece.line.per_length2.sqrt();
    let widths = length / (2.0 * piece.stream.channel.bank_rad + 1e-30);
    let bend = BEND * bend_of(piece) * ((widths - BENDS_FROM) / BENDS_FROM).clamp(0.0, 1.0);
    piece.refined(REFINED, RATIO as f64, bend, each);
}

/// How far a piece bends, from -1 to 1: a pure function of its start.
fn bend_of(piece: &Piece) -> f64 {
    let [x, y, z] = piece.line.start.to_array().map(f64::to_bits);
    let bits = mix(mix(mix(x) ^ y) ^ z);
    (bits >> 11) as f64 * (2.0 / (1_u64 << 53) as f64) - 1.0
}
