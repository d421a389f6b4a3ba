//! Index permutations: one triangle list for each combination of parent edges, without T-junctions or cracks.
//!
//! On a parent edge every second vertex is left out. A tile chooses one of the 16 lists by its edge mask.

use crate::lod::tile::{TILE_QUADS, TILE_SIDE};
use crate::sphere::Edge;

/// The triangle list (anticlockwise from outside) of a tile with parent edges `coarser_edges` (bits of [`Edge::bit`]),
/// as indices into the vertices of the tile.
///
/// Each block of two by two quads is a fan around its middle vertex; its rim omits the middle vertex of each stitched
/// side.
pub fn triangle_indices(coarser_edges: u8) -> Vec<u16> {
    let mut indices = Vec::with_capacity(TILE_QUADS * TILE_QUADS * 6);
    let vertex = |x: usize, y: usize| (y * TILE_SIDE + x) as u16;
    for y in (0..TILE_QUADS).step_by(2) {
        for x in (0..TILE_QUADS).step_by(2) {
            let stitched = |edge: Edge| {
                coarser_edges & edge.bit() != 0
                    && match edge {
                        Edge::Left => x == 0,
                        Edge::Right => x + 2 == TILE_QUADS,
                        Edge::Bottom => y == 0,
                        Edge::Top => y + 2 == TILE_QUADS,
                    }
            };
            // The rim, anticlockwise from the lower left corner; the middle of a side names its edge.
            let rim = [
                (x, y, None),
                (x + 1, y, Some(Edge::Bottom)),
                (x + 2, y, None),
                (x + 2, y + 1, Some(Edge::Right)),
                (x + 2, y + 2, None),
                (x + 1, y + 2, Some(Edge::Top)),
                (x, y + 2, None),
                (x, y + 1, Some(Edge::Left)),
            ];
            let rim: Vec<u16> = rim
                .into_iter()
                .filter(|(_, _, edge)| !edge.is_some_and(&stitched))
                .map(|(x, y, _)| vertex(x, y))
                .collect();
            let middle = vertex(x + 1, y + 1);
            for (i, &corner) in rim.iter().enumerate() {
                indices.extend([middle, corner, rim[(i + 1) % rim.len()]]);
            }
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn every_permutation_is_a_closed_patch_whose_rim_skips_exactly_the_stitched_vertices() {
        for mask in 0..16_u8 {
            let indices = triangle_indices(mask);
            let mut directed: HashMap<(u16, u16), usize> = HashMap::new();
            for t in indices.chunks(3) {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    *directed.entry((a, b)).or_default() += 1;
                }
            }
            assert!(directed.values().all(|&n| n == 1), "an edge is used twice in one direction");
            let rim: Vec<_> = directed.keys().filter(|(a, b)| !directed.contains_key(&(*b, *a))).collect();
            let stitched = mask.count_ones() as usize;
            assert_eq!(rim.len(), 4 * TILE_QUADS - stitched * TILE_QUADS / 2, "mask {mask}");
            let area: f64 = indices
                .chunks(3)
                .map(|t| {
                    let p = |i: u16| ((i as usize % TILE_SIDE) as f64, (i as usize / TILE_SIDE) as f64);
                    let (a, b, c) = (p(t[0]), p(t[1]), p(t[2]));
                    let area = 0.5 * ((b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1));
                    assert!(area > 0.0, "a triangle faces inwards");
                    area
                })
                .sum();
            assert_eq!(area, (TILE_QUADS * TILE_QUADS) as f64, "mask {mask}");
        }
    }
}
