//! What stands in for a vertex before it appears: the chord between two vertices of the next coarser level.
//!
//! A vertex is *born* at the coarsest level that has it. Until it shows, the mesh of the level before runs through its place in a
//! straight line: along an edge of a quad, or along the diagonal that is drawn there (see [`super::stitch`]). Both ends are vertices
//! of every tile that has the middle one and, on an edge of the tile, lie on that edge: whoever shares a vertex knows its chord.

use super::tile::{TILE_QUADS, TILE_SIDE};
use std::sync::LazyLock;

/// The coarsest grid whose vertices a tile knows chords of: every so many vertices.
pub const COARSEST_STRIDE: usize = 16;

/// One vertex of a tile between two others; indices into [`super::Tile::vertices`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chord {
    /// The one in the middle.
    pub vertex: u16,
    /// The end that was born one level before it.
    pub younger: u16,
    /// The end that is older still.
    pub elder: u16,
    /// Vertices to the neighbours on the grid where it was born: 1 for the tile's own level, 2 for its parent's...
    pub stride: u16,
    /// Whether the elder was born exactly two levels before it.
    pub elder_is_next: bool,
}

/// All chords of a tile, coarse ones first. `odd_node`: whether the node's column and row add up to an odd number, which turns the
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
                    // The coarser quad's diagonal goes from the middle of a block of two by two to its corner.
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
