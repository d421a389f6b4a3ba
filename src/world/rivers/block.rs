//! A block: the pieces of all reaches near a square of cells, listed for each bucket of that square. Most blocks have
//! places of their own in their level; those of a point that stands alone are as small as the point needs.

use super::grid::{Cell, FacePlace, Grid, RATIO};
use super::reach::{Line, Piece, Stream};
use crate::sphere::raster::cube_direction;
use glam::{DVec2, DVec3};

/// Cells along the side of a block.
pub(super) const BLOCK: usize = 16;

/// A square of cells of one level and face. It may reach beyond the right and the lower edge of the face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) face: usize,
    pub(super) left: usize,
    pub(super) top: usize,
    /// Cells along its side.
    pub(super) side: usize,
}

/// The pieces that the ground of a square of cells depends on. Their order is the same in every block: by level, then
/// by cell, then along the reach.
#[derive(Debug)]
pub(super) struct Block {
    /// The lines of the pieces, and apart from them, because few points ask for it, what flows there.
    pub(super) lines: Vec<Line>,
    streams: Vec<Stream>,
    /// For each bucket the start of its list; the last one ends all.
    starts: Vec<u32>,
    lists: Vec<u16>,
    face: usize,
    /// Buckets along the side of the face; the first of this block, and how many it has along its side.
    side: usize,
    corner: [usize; 2],
    buckets: usize,
}

/// The block that holds a cell: its number among the blocks of a level.
pub(super) fn block_of(grid: &Grid, cell: Cell) -> u64 {
    let side = grid.side.div_ceil(BLOCK);
    ((cell.face * side + cell.y / BLOCK) * side + cell.x / BLOCK) as u64
}

impl Square {
    /// The cells of a block.
    pub(super) fn of_block(grid: &Grid, block: u64) -> Self {
        let (side, block) = (grid.side.div_ceil(BLOCK), block as usize);
        Self { face: block / (side * side), left: block % side * BLOCK, top: block / side % side * BLOCK, side: BLOCK }
    }

    pub(super) fn of_cell(cell: Cell) -> Self {
        Self { face: cell.face, left: cell.x, top: cell.y, side: 1 }
    }

    /// The square of the level before that holds this one with some rings around it. None if those leave the face.
    pub(super) fn parents(&self, grid: &Grid, rings: usize) -> Option<Self> {
        let [left, top] = [self.left.checked_sub(rings)? / RATIO, self.top.checked_sub(rings)? / RATIO];
        let last = self.left.max(self.top) + self.side + rings;
        let end = |first: usize| (first + self.side - 1 + rings) / RATIO + 1;
        let side = (end(self.left) - left).max(end(self.top) - top);
        (last <= grid.side).then_some(Self { face: self.face, left, top, side })
    }

    /// Its cells, row by row.
    pub(super) fn cells(self, grid: &Grid) -> impl Iterator<Item = Cell> {
        let Self { face, left, top, side } = self;
        let [right, bottom] = [left, top].map(|first| (first + side).min(grid.side));
        (top..bottom).flat_map(move |y| (left..right).map(move |x| Cell { face, x, y }))
    }
}

impl Block {
    /// Sorts pieces into buckets. Those that reach no bucket are left out.
    pub(super) fn new(grid: &Grid, square: &Square, all: &[Piece]) -> Self {
        let touch = Touch::new(grid, square);
        let buckets = touch.buckets;
        let (mut lines, mut streams) = (Vec::with_capacity(all.len()), Vec::with_capacity(all.len()));
        let mut starts = vec![0_u32; buckets * buckets + 1];
        let mut found: Vec<(u32, u16)> = Vec::with_capacity(16 * all.len());
        for piece in all {
            let Some(strip) = touch.strip(piece, 1.0) else { continue };
            let (number, before) = (lines.len() as u16, found.len());
            strip.each_bucket(|x, y| {
                let bucket = (y - touch.corner[1]) * buckets + x - touch.corner[0];
                starts[bucket + 1] += 1;
                found.push((bucket as u32, number));
            });
            if found.len() > before {
                lines.push(piece.line);
                streams.push(piece.stream);
            }
            if lines.len() > usize::from(u16::MAX) {
                break;
            }
        }
        for bucket in 0..buckets * buckets {
            starts[bucket + 1] += starts[bucket];
        }
        let mut next = starts.clone();
        let mut lists = vec![0; found.len()];
        for (bucket, number) in found {
            let slot = &mut next[bucket as usize];
            lists[*slot as usize] = number;
            *slot += 1;
        }
        lines.shrink_to_fit();
        streams.shrink_to_fit();
        let Touch { face, side, corner, .. } = touch;
        Self { lines, streams, starts, lists, face, side, corner, buckets }
    }

    /// One bucket of this block alone. Its pieces keep their order.
    pub(super) fn cropped(&self, [x, y]: [usize; 2]) -> Self {
        let within = |at: usize, corner: usize| at.saturating_sub(corner).min(self.buckets - 1);
        let numbers = self.list(within(y, self.corner[1]) * self.buckets + within(x, self.corner[0]));
        let count = numbers.len() as u16;
        Self {
            lines: numbers.iter().map(|&number| self.lines[usize::from(number)]).collect(),
            streams: numbers.iter().map(|&number| self.streams[usize::from(number)]).collect(),
            starts: vec![0, u32::from(count)],
            lists: (0..count).collect(),
            corner: [x, y],
            buckets: 1,
            ..*self
        }
    }

    /// Whether a place lies in it.
    #[inline(always)]
    pub(super) fn covers(&self, place: &FacePlace) -> bool {
        let is_within = |w: f64, corner: usize| {
            ((w * self.side as f64) as usize).min(self.side - 1).wrapping_sub(corner) < self.buckets
        };
        self.face == place.face && is_within(place.x, self.corner[0]) && is_within(place.y, self.corner[1])
    }

    fn list(&self, bucket: usize) -> &[u16] {
        match self.starts.get(bucket..bucket + 2) {
            Some(ends) => &self.lists[ends[0] as usize..ends[1] as usize],
            None => &[],
        }
    }

    /// A piece by its number.
    #[inline(always)]
    pub(super) fn piece(&self, number: u16) -> Piece {
        Piece { line: self.lines[usize::from(number)], stream: self.streams[usize::from(number)] }
    }

    /// What flows along a piece.
    #[inline(always)]
    pub(super) fn stream(&self, number: u16) -> &Stream {
        &self.streams[usize::from(number)]
    }

    /// All pieces.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        self.lines.iter().zip(&self.streams).map(|(line, stream)| Piece { line: *line, stream: *stream })
    }

    /// Resident size.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.lines.len() * (size_of::<Line>() + size_of::<Stream>())
            + 4 * self.starts.len()
            + 2 * self.lists.len()
    }

    /// Numbers of the pieces that the ground at a place of the block depends on, in their order.
    #[inline(always)]
    pub(super) fn near(&self, place: &FacePlace) -> &[u16] {
        let at = |w: f64, corner: usize| ((w * self.side as f64) as usize).saturating_sub(corner).min(self.buckets - 1);
        self.list(at(place.y, self.corner[1]) * self.buckets + at(place.x, self.corner[0]))
    }
}

/// Tells which buckets of a square a piece touches. The buckets of a piece are the same in each square.
pub(super) struct Touch {
    face: usize,
    /// Buckets along the side of a face, the first of the square, and how many it has along its side.
    side: usize,
    corner: [usize; 2],
    buckets: usize,
    /// Outwards, to the right and down on the face.
    axes: [DVec3; 3],
}

/// A piece on the plane of a face, where great circles are straight, with all that it influences: in buckets from the
/// corner of the face.
struct Strip {
    start: DVec2,
    along: DVec2,
    reach: f64,
    /// The rectangle of buckets around it within the square: left, top, right, bottom.
    bounds: [usize; 4],
}

impl Touch {
    pub(super) fn new(grid: &Grid, square: &Square) -> Self {
        let face = square.face;
        // The map of a face is linear before it is made a unit vector.
        let out = cube_direction(face, 2, 1.0, 1.0);
        let step = |x: f64, y: f64| {
            let p = cube_direction(face, 2, x, y);
            p / p.dot(out) - out
        };
        let corner = [square.left * RATIO, square.top * RATIO];
        Self {
            face,
            side: grid.side * RATIO,
            corner,
            buckets: square.side * RATIO,
            axes: [out, step(2.0, 1.0), step(1.0, 2.0)],
        }
    }

    /// Whether a piece touches the block with its influence divided by `finer`.
    pub(super) fn reaches(&self, piece: &Piece, finer: f64) -> bool {
        self.strip(piece, finer).is_some()
    }

    /// None if the piece, with its influence divided by `finer`, lies beyond the block.
    fn strip(&self, piece: &Piece, finer: f64) -> Option<Strip> {
        let influence = 1.0 / (piece.line.per_influence2.sqrt() * finer);
        // A bent piece keeps this close to the straight one.
        let aside = if finer > 1.0 { 0.25 / piece.line.per_length2.sqrt() } else { 0.0 };
        let [out, right, down] = self.axes;
        let half = 0.5 * self.side as f64;
        let mut steepest = 1.0_f64;
        let mut place = |dir: DVec3| {
            let depth = dir.dot(out);
            let (s, t) = (dir.dot(right) / depth, dir.dot(down) / depth);
            steepest = steepest.max(1.0 + s * s + t * t);
            (depth > 0.25).then(|| DVec2::new((s + 1.0) * half, (t + 1.0) * half))
        };
        let (start, end) = (place(piece.line.start)?, place(piece.line.start + piece.line.along)?);
        // A step of an angle moves a point on the face by at most its distance from the eye, squared.
        let reach = (influence + aside) * steepest * 1.2 * half;
        let clamped = |bucket: f64, axis: usize| {
            let corner = self.corner[axis] as f64;
            bucket.clamp(corner, corner + self.buckets as f64) as usize
        };
        let (least, most) = (start.min(end) - reach, start.max(end) + reach);
        let bounds = [clamped(least.x, 0), clamped(least.y, 1), clamped(most.x + 1.0, 0), clamped(most.y + 1.0, 1)];
        (bounds[0] < bounds[2] && bounds[1] < bounds[3]).then_some(Strip { start, along: end - start, reach, bounds })
    }
}

impl Strip {
    /// Calls with the column and row of each bucket that the strip touches.
    fn each_bucket(&self, mut call: impl FnMut(usize, usize)) {
        // Half the diagonal of a bucket.
        let reach = self.reach + 0.7072;
        let per_length2 = 1.0 / self.along.length_squared().max(1e-30);
        let [left, top, right, bottom] = self.bounds;
        for y in top..bottom {
            for x in left..right {
                let v = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - self.start;
                let foot = v - self.along * (v.dot(self.along) * per_length2).clamp(0.0, 1.0);
                if foot.length_squared() <= reach * reach {
                    call(x, y);
                }
            }
        }
    }
}
