//! The heights of a node and its surroundings on one grid, so that a march is plain arithmetic on rows.

use super::pyramid::{Ground, Pyramid};
use crate::lod::tile::{TILE_QUADS, TILE_SIDE};
use crate::sphere::{NodeId, cube};

/// Heights on the vertices of a node and on the same grid beyond its edges.
pub(super) struct Patch {
    /// Row by row.
    pub(super) height_m: Vec<f32>,
    /// Vertices beyond each edge.
    pub(super) margin: usize,
    /// Vertices along a side.
    pub(super) side: usize,
}

impl Patch {
    /// The patch of a known node with a margin of at most the width of the node. Beyond the node, each point has the
    /// height of the finest known node there that is no finer than this one.
    pub(super) fn new(pyramid: &Pyramid, id: NodeId, margin: usize) -> Option<Self> {
        profiling::scope!("patch");
        let margin = margin.min(TILE_QUADS);
        let side = TILE_SIDE + 2 * margin;
        let mut patch = Self { height_m: vec![0.0; side * side], margin, side };
        let nodes_along = 1_i64 << id.level;
        let steps = [-1_i64, 0, 1];
        let blocks = || steps.into_iter().flat_map(|up| steps.into_iter().map(move |right| (right, up)));
        let beside = |(right, up): (i64, i64)| {
            let (x, y) = (i64::from(id.x) + right, i64::from(id.y) + up);
            let on_face = (0..nodes_along).contains(&x) && (0..nodes_along).contains(&y);
            on_face.then_some(NodeId { x: x as u32, y: y as u32, ..id })
        };
        // In order: other faces, coarser ground, known nodes. On a common border the finest wins, for every node that
        // asks.
        for block in blocks().filter(|block| beside(*block).is_none()) {
            patch.fill(block, |x, y| across(pyramid, id, x, y));
        }
        for block in blocks() {
            if let Some(other) = beside(block).filter(|other| pyramid.get(*other).is_none()) {
                let (coarse, ground) = pyramid.deepest(other)?;
                patch.fill(block, |x, y| {
                    let (u, v) = (x as f64 / TILE_QUADS as f64, y as f64 / TILE_QUADS as f64);
                    let scale = 1.0 / f64::from(1_u32 << (id.level - coarse.level));
                    let within = |own: u32, coarse: u32, w: f64| (f64::from(own) + w) * scale - f64::from(coarse);
                    interpolated(ground, within(id.x, coarse.x, u), within(id.y, coarse.y, v))
                });
            }
        }
        for block in blocks() {
            if let Some(ground) = beside(block).and_then(|other| pyramid.get(other)) {
                let local = |w: i64, block: i64| (w - block * TILE_QUADS as i64) as usize;
                patch.fill(block, |x, y| ground.height_m[local(y, block.1) * TILE_SIDE + local(x, block.0)]);
            }
        }
        Some(patch)
    }

    /// Fills the part that lies in one of the nine nodes, borders included, by the number of the vertex.
    fn fill(&mut self, (right, up): (i64, i64), height_m: impl Fn(i64, i64) -> f32) {
        let (quads, margin) = (TILE_QUADS as i64, self.margin as i64);
        let range = |block: i64| (block * quads).max(-margin)..=(block * quads + quads).min(quads + margin);
        for y in range(up) {
            for x in range(right) {
                self.height_m[(y + margin) as usize * self.side + (x + margin) as usize] = height_m(x, y);
            }
        }
    }
}

/// The height beyond the edge of the face, at its extended coordinates.
fn across(pyramid: &Pyramid, id: NodeId, x: i64, y: i64) -> f32 {
    let dir = id.direction(x as f64 / TILE_QUADS as f64, y as f64 / TILE_QUADS as f64);
    let (_, s, t) = cube::face_point(dir);
    let Some((found, ground)) = pyramid.deepest(NodeId::containing(dir, id.level)) else { return 0.0 };
    let scale = 0.5 * f64::from(1_u32 << found.level);
    interpolated(ground, (s + 1.0) * scale - f64::from(found.x), (t + 1.0) * scale - f64::from(found.y))
}

/// The height at a point of a node, 0 to 1 along both sides.
fn interpolated(ground: &Ground, u: f64, v: f64) -> f32 {
    let place = |w: f64| {
        let w = (w * TILE_QUADS as f64).clamp(0.0, TILE_QUADS as f64);
        let i = (w as usize).min(TILE_QUADS - 1);
        (i, (w - i as f64) as f32)
    };
    let ((x, u), (y, v)) = (place(u), place(v));
    let row = |y: usize| {
        let [a, b] = [0, 1].map(|dx| ground.height_m[y * TILE_SIDE + x + dx]);
        a + (b - a) * u
    };
    let [a, b] = [row(y), row(y + 1)];
    a + (b - a) * v
}
