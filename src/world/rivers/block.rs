//! A block: the pieces of all reaches near a square of cells, listed for each bucket of that square.

use super::grid::{Cell, Grid, RATIO};
use super::reach::Piece;
use crate::sphere::raster::{cube_direction, cube_point};
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
        let blocks = grid.side.div_ceil(BLOCK);
        let (face, number) = (block as usize / (blocks * blocks), block as usize);
        let corner = [number % blocks * BUCKETS, number / blocks % blocks * BUCKETS];
        let side = grid.side * RATIO;
        let (mut pieces, mut boxes) = (Vec::new(), Vec::new());
        for piece in all {
            let Some(touched) = touched(&piece, face, side, corner) else { continue };
            boxes.push(touched);
            pieces.push(piece);
        }
        let mut starts = vec![0_u32; BUCKETS * BUCKETS + 1];
        let each = |[x0, y0, x1, y1]: [usize; 4]| (y0..y1).flat_map(move |y| (x0..x1).map(move |x| y * BUCKETS + x));
        let near = |piece: &Piece, bucket: usize| {
            let (x, y) = (corner[0] + bucket % BUCKETS, corner[1] + bucket / BUCKETS);
            let middle = cube_direction(face, side, x as f64 + 0.5, y as f64 + 0.5);
            let v = middle - piece.start;
            let foot = v - piece.along * (v.dot(piece.along) * piece.per_length2).clamp(0.0, 1.0);
            // Half the diagonal of a bucket: its sides are at most as wide as the face's inner bucket.
            let depth = middle.abs().max_element() + 2.0 / side as f64;
            let reach = 1.0 / piece.per_influence2.sqrt() + 1.5 / side as f64 * depth;
            foot.dot(foot) <= reach * reach
        };
        let mut found: Vec<(u32, u16)> = Vec::new();
        for (number, (piece, touched)) in pieces.iter().zip(&boxes).enumerate().take(usize::from(u16::MAX)) {
            for bucket in each(*touched).filter(|bucket| near(piece, *bucket)) {
                starts[bucket + 1] += 1;
                found.push((bucket as u32, number as u16));
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
        Self { pieces, starts, lists, side, corner }
    }

    /// The pieces that the ground at a direction of the block depends on, in their order.
    #[inline(always)]
    pub(super) fn near(&self, dir: DVec3) -> impl Iterator<Item = &Piece> {
        let (_, x, y) = cube_point(dir, self.side);
        let at = |w: f64, corner: usize| (w as usize).saturating_sub(corner).min(BUCKETS - 1);
        let bucket = at(y, self.corner[1]) * BUCKETS + at(x, self.corner[0]);
        let range = match self.starts.get(bucket..bucket + 2) {
            Some(ends) => ends[0] as usize..ends[1] as usize,
            None => 0..0,
        };
        self.lists[range].iter().map(|&number| &self.pieces[usize::from(number)])
    }
}

/// The rectangle of buckets, within the block, that a piece with its influence touches.
fn touched(piece: &Piece, face: usize, side: usize, corner: [usize; 2]) -> Option<[usize; 4]> {
    let influence = 1.0 / piece.per_influence2.sqrt();
    let mut bounds = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
    let [out, right, up] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)].map(|at| on_face(face, at));
    for end in [piece.start, piece.start + piece.along] {
        let depth = end.dot(out);
        if depth < 0.25 {
            return None;
        }
        let (s, t) = (end.dot(right) / depth, -end.dot(up) / depth);
        // A step of an angle moves a point on the face by at most its distance from the eye, squared.
        let reach = influence * (1.0 + s * s + t * t) * 1.3;
        bounds = [
            bounds[0].min(s - reach),
            bounds[1].min(t - reach),
            bounds[2].max(s + reach),
            bounds[3].max(t + reach),
        ];
    }
    let bucket = |w: f64, corner: usize| ((w + 1.0) * 0.5 * side as f64).floor() - corner as f64;
    let low = |w: f64, corner| bucket(w, corner).clamp(0.0, BUCKETS as f64) as usize;
    let high = |w: f64, corner| (bucket(w, corner) + 1.0).clamp(0.0, BUCKETS as f64) as usize;
    let found = [
        low(bounds[0], corner[0]),
        low(bounds[1], corner[1]),
        high(bounds[2], corner[0]),
        high(bounds[3], corner[1]),
    ];
    (found[0] < found[2] && found[1] < found[3]).then_some(found)
}

/// A vector given by its parts outwards, to the right and up on a face.
fn on_face(face: usize, (out, right, up): (f64, f64, f64)) -> DVec3 {
    // The middle of the face, and steps from there: the map of a face is linear before it is made a unit vector.
    let middle = cube_direction(face, 2, 1.0, 1.0);
    let step = |x: f64, y: f64| {
        let p = cube_direction(face, 2, x, y);
        p / p.dot(middle) - middle
    };
    middle * out + step(2.0, 1.0) * right + step(1.0, 0.0) * up
}
