//! Chords: the line between two vertices of the coarser level that a vertex replaces.
//!
//! A vertex is *born* at the coarsest level that has it. Until it appears, the coarser mesh runs through its location
//! in a straight line: along an edge of a quad or its diagonal (see [`super::stitch`]). Both ends of this chord are
//! vertices of every tile that has the vertex. On the edge of a tile they lie on that edge, so tiles that share a
//! vertex share its chord.

use super::tile::{TILE_QUADS, TILE_SIDE};
use std::sync::LazyLock;

/// Stride of the coarsest grid whose vertices have chords in a tile.
pub const COARSEST_STRIDE: usize = 16;

/// A vertex of a tile and the ends of its chord, as indices into [`super::Tile::vertices`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The vertex in the middle.
    pub vertex: u16,
    /// The end that was born one level before it.
    pub younger: u16,
    /// The other, older end.
    pub elder: u16,
    /// Stride of the grid where it was born, in vertices: 1 for the tile's own level, 2 for its parent's, and so on.
    pub stride: u16,
    /// Whether the elder was born exactly two levels before it.
    pub elder_is_next: bool,
}

/// All chords of a tile, coarse ones first. `odd_node`: whether column plus row of the node is odd, which turns the
/// diagonal of the coarsest quad.
pub fn chords(odd_node: bool) -> &'static [Chord] {
    static CHORDS: LazyLock<[Vec<Chord>; 2]> = LazyLock::new(|| [list(false), list(true)]);
    &CHORDS[usize::from(odd_node)]
}

fn list(odd_node: bool) -> Vec<Chord> {
    let mut all = Vec::new();
    let mut stride = COARSEST_STRIDE;
    while stride > 0 {
        let quads = TILE_QUADS / stride;
        for (x, y) in (0..=quads).flat_map(|y| (0..=quads).map(move |x| (x, y))) {
            let ends = match (x % 2, y % 2) {
                (0, 0) => continue,
                (1, 0) => [(x - 1, y), (x + 1, y)],
                (0, _) => [(x, y - 1), (x, y + 1)],
                _ => {
                    // The diagonal of the coarser quad goes from the middle of a block of two by two quads to its
                    // corner.
                    let turned = (x / 2 + y / 2) % 2 == 1 || (stride == COARSEST_STRIDE && odd_node);
                    if turned { [(x + 1, y - 1), (x - 1, y + 1)] } else { [(x - 1, y - 1), (x + 1, y + 1)] }
                }
            };
            let index = |(x, y): (usize, usize)| (y * stride * TILE_SIDE + x * stride) as u16;
            let born = |(x, y): (usize, usize)| 1_usize << (x | y | quads).trailing_zeros();
            let [a, b] = ends;
            let (younger, elder) = if born(a) <= born(b) { (a, b) } else { (b, a) };
            all.push(Chord {
                vertex: index((x, y)),
                younger: index(younger),
                elder: index(elder),
                stride: stride as u16,
                elder_is_next: born(elder) == 4,
            });
        }
        stride /= 2;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vertex_but_the_corners_has_one_chord_and_its_ends_are_older() {
        for odd in [false, true] {
            let list = chords(odd);
            let mut stride = vec![0_u16; TILE_SIDE * TILE_SIDE];
            for chord in list {
                assert_eq!(stride[usize::from(chord.vertex)], 0, "two chords");
                stride[usize::from(chord.vertex)] = chord.stride;
            }
            let without = stride.iter().filter(|stride| **stride == 0).count();
            assert_eq!(without, 4, "only the corners have none");
            for chord in list {
                let born = |i: u16| match stride[usize::from(i)] {
                    0 => TILE_QUADS as u16,
                    stride => stride,
                };
                assert_eq!(born(chord.younger), 2 * chord.stride, "{chord:?}");
                assert!(born(chord.elder) >= 2 * chord.stride.max(1), "{chord:?}");
                assert_eq!(chord.elder_is_next, born(chord.elder) == 4 * chord.stride, "{chord:?}");
                let place = |i: u16| (i32::from(i) % TILE_SIDE as i32, i32::from(i) / TILE_SIDE as i32);
                let ((x, y), (a, b), (c, d)) = (place(chord.vertex), place(chord.younger), place(chord.elder));
                assert_eq!((2 * x, 2 * y), (a + c, b + d), "{chord:?}");
            }
        }
    }

    #[test]
    fn chords_are_edges_of_the_coarser_triangles() {
        // The tile as its parent draws a quarter of itself: the same triangles at half the resolution.
        let edges: std::collections::HashSet<(u16, u16)> = crate::lod::stitch::triangle_indices(0)
            .chunks(3)
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
            .flat_map(|(a, b)| [(a, b), (b, a)])
            .collect();
        let halved = |i: u16| {
            let (x, y) = (usize::from(i) % TILE_SIDE, usize::from(i) / TILE_SIDE);
            (y / 2 * TILE_SIDE + x / 2) as u16
        };
        for chord in chords(false).iter().filter(|chord| chord.stride == 1) {
            assert!(edges.contains(&(halved(chord.younger), halved(chord.elder))), "{chord:?}");
        }
    }
}
