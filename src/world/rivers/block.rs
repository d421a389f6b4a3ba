//! A block: the pieces of all reaches near a square of cells, listed for each bucket of that square.

use super::grid::{Cell, FacePlace, Grid, RATIO};
use super::reach::{Line, Piece};
use crate::sphere::raster::cube_direction;
use glam::DVec3;

/// Cells along the side of a block.
pub(super) const BLOCK: usize = 8;
/// Buckets along the side of a block.
const BUCKETS: usize = BLOCK * RATIO;

/// The pieces that the ground of a square of cells depends on. Their order is the same in every block: by level, then
/// by cell, then along the reach.
#[derive(Debug, Default)]
pub(super) struct Block {
    pub(super) pieces: Vec<Piece>,
    /// The lines of the pieces, close together.
    pub(super) lines: Vec<Line>,
    /// For each bucket the start of its list; the last one ends all.
    starts: Vec<u32>,
    lists: Vec<u16>,
    /// Buckets along the side of a face, and the first of this block.
    side: usize,
    corner: [usize; 2],
}

/// The block that holds a cell: its number among the blocks of a level.
pub(super) fn block_of(grid: &Grid, cell: Cell) -> u64 {
    let side = grid.side.div_ceil(BLOCK);
    ((cell.face * side + cell.y / BLOCK) * side + cell.x / BLOCK) as u64
}

/// The cells of a block.
pub(super) fn cells_of(grid: &Grid, block: u64) -> impl Iterator<Item = Cell> {
    let (side, block, end) = (grid.side.div_ceil(BLOCK), block as usize, grid.side);
    let (face, left, top) = (block / (side * side), block % side * BLOCK, block / side % side * BLOCK);
    (top..(top + BLOCK).min(end)).flat_map(move |y| (left..(left + BLOCK).min(end)).map(move |x| Cell { face, x, y }))
}

impl Block {
    /// Sorts pieces into buckets. Those that reach no bucket are left out.
    pub(super) fn new(grid: &Grid, block: u64, all: impl Iterator<Item = Piece>) -> Self {
        let touch = Touch::new(grid, block);
        let Touch { face, side, corner, .. } = touch;
        let middle = |bucket: usize| {
            let (x, y) = (corner[0] + bucket % BUCKETS, corner[1] + bucket / BUCKETS);
            cube_direction(face, side, x as f64 + 0.5, y as f64 + 0.5)
        };
        let middles: Vec<DVec3> = (0..BUCKETS * BUCKETS).map(middle).collect();
        let mut pieces = Vec::new();
        let mut starts = vec![0_u32; BUCKETS * BUCKETS + 1];
        let mut found: Vec<(u32, u16)> = Vec::new();
        for piece in all {
            let Some([x0, y0, x1, y1]) = touch.bounds(&piece, 1.0) else { continue };
            // Half the diagonal of a bucket: its sides are at most as wide as those in the middle of the face.
            let depth =
                piece.line.start.abs().max_element() + 4.0 / side as f64 + 1.0 / piece.line.per_influence2.sqrt();
            let reach = 1.0 / piece.line.per_influence2.sqrt() + 1.5 / side as f64 * depth.min(1.0);
            let (number, before) = (pieces.len() as u16, found.len());
            for bucket in (y0..y1).flat_map(|y| (x0..x1).map(move |x| y * BUCKETS + x)) {
                let v = middles[bucket] - piece.line.start;
                let foot = v - piece.line.along * (v.dot(piece.line.along) * piece.line.per_length2).clamp(0.0, 1.0);
                if foot.dot(foot) <= reach * reach {
                    starts[bucket + 1] += 1;
                    found.push((bucket as u32, number));
                }
            }
            if found.len() > before {
                pieces.push(piece);
            }
            if pieces.len() > usize::from(u16::MAX) {
                break;
            }
        }
        for bucket in 0..BUCKETS * BUCKETS {
            starts[bucket + 1] += starts[bucket];
        }
        let mut next = starts.clone();
        let mut lists = vec![0; found.len()];
        for (bucket, number) in found {
            let slot = &mut next[bucket as usize];
            lists[*slot as usize] = number;
            *slot += 1;
        }
        let lines = pieces.iter().map(|piece| piece.line).collect();
        Self { pieces, lines, starts, lists, side, corner }
    }

    /// Numbers of the pieces that the ground at a place of the block depends on, in their order.
    #[inline(always)]
    pub(super) fn near(&self, place: &FacePlace) -> &[u16] {
        let at = |w: f64, corner: usize| ((w * self.side as f64) as usize).saturating_sub(corner).min(BUCKETS - 1);
        let bucket = at(place.y, self.corner[1]) * BUCKETS + at(place.x, self.corner[0]);
        match self.starts.get(bucket..bucket + 2) {
            Some(ends) => &self.lists[ends[0] as usize..ends[1] as usize],
            None => &[],
        }
    }
}

/// Tells which buckets of a block a piece touches.
pub(super) struct Touch {
    face: usize,
    /// Buckets along the side of a face, and the first of the block.
    side: usize,
    corner: [usize; 2],
    /// Outwards, to the right and down on the face.
    axes: [DVec3; 3],
}

impl Touch {
    pub(super) fn new(grid: &Grid, block: u64) -> Self {
        let (blocks, number) = (grid.side.div_ceil(BLOCK), block as usize);
        let face = number / (blocks * blocks);
        // The map of a face is linear before it is made a unit vector.
        let out = cube_direction(face, 2, 1.0, 1.0);
        let step = |x: f64, y: f64| {
            let p = cube_direction(face, 2, x, y);
            p / p.dot(out) - out
        };
        let corner = [number % blocks * BUCKETS, number / blocks % blocks * BUCKETS];
        Self { face, side: grid.side * RATIO, corner, axes: [out, step(2.0, 1.0), step(1.0, 2.0)] }
    }

    /// The rectangle of buckets, within the block, that a piece touches with its influence divided by `finer`.
    pub(super) fn bounds(&self, piece: &Piece, finer: f64) -> Option<[usize; 4]> {
        let influence = 1.0 / (piece.line.per_influence2.sqrt() * finer);
        // A bent piece keeps this close to the straight one.
        let aside = if finer > 1.0 { 0.25 / piece.line.per_length2.sqrt() } else { 0.0 };
        let mut bounds = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
        let [out, right, down] = self.axes;
        for end in [piece.line.start, piece.line.start + piece.line.along] {
            let depth = end.dot(out);
            if depth < 0.25 {
                return None;
            }
            let (s, t) = (end.dot(right) / depth, end.dot(down) / depth);
            // A step of an angle moves a point on the face by at most its distance from the eye, squared.
            let reach = (influence + aside) * (1.0 + s * s + t * t) * 1.2;
            bounds = [
                bounds[0].min(s - reach),
                bounds[1].min(t - reach),
                bounds[2].max(s + reach),
                bounds[3].max(t + reach),
            ];
        }
        let bucket = |w: f64, corner: usize| ((w + 1.0) * 0.5 * self.side as f64).floor() - corner as f64;
        let clamped = |bucket: f64| bucket.clamp(0.0, BUCKETS as f64) as usize;
        let [left, top] = self.corner;
        let [x0, y0] = [clamped(bucket(bounds[0], left)), clamped(bucket(bounds[1], top))];
        let [x1, y1] = [clamped(bucket(bounds[2], left) + 1.0), clamped(bucket(bounds[3], top) + 1.0)];
        (x0 < x1 && y0 < y1).then_some([x0, y0, x1, y1])
    }
}
