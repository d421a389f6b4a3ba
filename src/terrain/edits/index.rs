//! Which pieces of edits are near: a quadtree over the squares of the sphere. Each cell lists the pieces that touch it,
//! in the order in which they act; a leaf has few, or cannot be split with profit.

use crate::planet::Key;
use crate::sphere::NodeId;
use crate::sphere::cube::face_point;
use glam::DVec3;
use std::ops::Range;

/// Pieces that a leaf may have before it is split.
const LEAF: usize = 12;
/// Finest level of a leaf.
const FINEST: u8 = 18;
/// A cell is not split if its quarters together would list more than this many times its pieces.
const WORTH: usize = 3;
/// Cells count as larger than they are: tiles read the ground a little beyond their edges.
const MARGIN: f64 = 1.1;

/// Some arcs of an edit, within a disc that also holds all ground that they change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The edit, by its place in the order.
    pub(super) edit: u32,
    /// Its arcs among those of the edit.
    pub(super) first: u32,
    pub(super) count: u32,
    /// Middle of the disc.
    pub(super) middle: DVec3,
    /// Chord from the middle to the edge of the disc.
    pub(super) chord: f64,
    /// Hash of all that the piece does.
    pub(super) hash: u128,
}

impl Piece {
    /// Whether a point lies in the disc.
    #[inline]
    pub(super) fn holds(&self, dir: DVec3) -> bool {
        self.middle.distance_squared(dir) <= self.chord * self.chord
    }

    /// Whether the disc may touch another one.
    pub(super) fn touches(&self, dir: DVec3, chord: f64) -> bool {
        may_touch((self.middle, self.chord), (dir, chord))
    }
}

/// Chord of an angle, a little larger, for rounding. That of half a turn and more reaches everywhere.
pub(super) fn chord_of(angle_rad: f64) -> f64 {
    if angle_rad >= std::f64::consts::PI {
        return 3.0;
    }
    2.0 * libm::sin(0.5 * angle_rad) * (1.0 + 1e-9) + 1e-12
}

/// Whether two discs may touch: the chord of a sum of angles is at most the sum of their chords.
fn may_touch(a: (DVec3, f64), b: (DVec3, f64)) -> bool {
    let sum = a.1 + b.1;
    a.0.distance_squared(b.0) <= sum * sum
}

/// The disc around a node: its middle, and the chord to its edge.
fn disc_of(id: NodeId) -> (DVec3, f64) {
    let middle = id.direction(0.5, 0.5);
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    let chord2 = corners.map(|(u, v)| id.direction(u, v).distance_squared(middle)).into_iter().fold(0.0, f64::max);
    (middle, chord2.sqrt() * MARGIN)
}

/// A cell and its list.
#[derive(Clone, Debug)]
struct Cell {
    /// Its four quarters; 0 for a leaf.
    quarters: u32,
    list: Range<u32>,
}

/// The quadtree.
#[derive(Debug)]
pub(super) struct Index {
    pieces: Vec<Piece>,
    /// The six faces first.
    cells: Vec<Cell>,
    lists: Vec<u32>,
}

impl Index {
    pub(super) fn new(pieces: Vec<Piece>) -> Self {
        let mut index = Self { pieces, cells: Vec::new(), lists: Vec::new() };
        let all: Vec<u32> = (0..index.pieces.len() as u32).collect();
        let mut open: Vec<(NodeId, usize)> = Vec::new();
        for id in NodeId::roots() {
            let list = index.touching(id, &all);
            open.push((id, index.add(&list)));
        }
        while let Some((id, cell)) = open.pop() {
            let list = index.list(cell).to_vec();
            if list.len() <= LEAF || id.level >= FINEST {
                continue;
            }
            let quarters = id.children().map(|child| index.touching(child, &list));
            if quarters.iter().map(Vec::len).sum::<usize>() > WORTH * list.len() {
                continue;
            }
            let numbers = quarters.map(|list| index.add(&list));
            index.cells[cell].quarters = numbers[0] as u32;
            open.extend(id.children().into_iter().zip(numbers));
        }
        index
    }

    fn touching(&self, id: NodeId, list: &[u32]) -> Vec<u32> {
        let (middle, chord) = disc_of(id);
        list.iter().copied().filter(|piece| self.piece(*piece).touches(middle, chord)).collect()
    }

    fn add(&mut self, list: &[u32]) -> usize {
        let start = self.lists.len() as u32;
        self.lists.extend_from_slice(list);
        self.cells.push(Cell { quarters: 0, list: start..self.lists.len() as u32 });
        self.cells.len() - 1
    }

    fn list(&self, cell: usize) -> &[u32] {
        let Range { start, end } = self.cells[cell].list;
        &self.lists[start as usize..end as usize]
    }

    #[inline]
    pub(super) fn piece(&self, number: u32) -> &Piece {
        &self.pieces[number as usize]
    }

    /// Looks leaves up, point after point.
    pub(super) fn walk(&self) -> Walk<'_> {
        Walk { index: self, face: usize::MAX, s: 1.0..0.0, t: 1.0..0.0, cell: 0 }
    }

    /// The key of all pieces.
    pub(super) fn key_of_all(&self) -> Key {
        Key::of(&self.hash(0..self.pieces.len() as u32))
    }

    /// The key of the pieces that touch a node; None if none does.
    pub(super) fn key_near(&self, id: NodeId) -> Option<Key> {
        let mut cell = id.face as usize;
        for level in 0..id.level {
            let quarters = self.cells[cell].quarters;
            if quarters == 0 {
                break;
            }
            let shift = id.level - 1 - level;
            cell = quarters as usize + (id.x >> shift & 1) as usize + 2 * (id.y >> shift & 1) as usize;
        }
        // The list may be that of a larger cell.
        let near = self.touching(id, self.list(cell));
        (!near.is_empty()).then(|| Key::of(&self.hash(near)))
    }

    /// A hash of pieces in order, by what they do. Where one edit ends and the next begins counts, too.
    fn hash(&self, pieces: impl IntoIterator<Item = u32>) -> u128 {
        let (mut hash, mut last) = (Hash::default(), u32::MAX);
        for piece in pieces.into_iter().map(|piece| self.piece(piece)) {
            hash.add(u64::from(piece.edit != last));
            hash.add(piece.hash as u64);
            hash.add((piece.hash >> 64) as u64);
            last = piece.edit;
        }
        hash.0
    }

    /// Calls `found` with the list of each leaf that may touch a disc, given by its middle and chord (None: of every
    /// leaf).
    pub(super) fn each_leaf(&self, near: Option<(DVec3, f64)>, found: &mut dyn FnMut(&[u32])) {
        let mut open: Vec<(NodeId, usize)> = NodeId::roots().into_iter().zip(0..).collect();
        while let Some((id, cell)) = open.pop() {
            let is_near = near.is_none_or(|disc| may_touch(disc_of(id), disc));
            if self.cells[cell].list.is_empty() || !is_near {
                continue;
            }
            match self.cells[cell].quarters as usize {
                0 => found(self.list(cell)),
                first => open.extend(id.children().into_iter().zip(first..)),
            }
        }
    }
}

/// Looks leaves up. Neighbouring points mostly lie in one leaf.
pub(super) struct Walk<'a> {
    index: &'a Index,
    /// The leaf that was found last: its face, its sides, its cell.
    face: usize,
    s: Range<f64>,
    t: Range<f64>,
    cell: usize,
}

impl<'a> Walk<'a> {
    /// The pieces that may change the ground at a direction.
    #[inline]
    pub(super) fn leaf(&mut self, dir: DVec3) -> &'a [u32] {
        let (face, s, t) = face_point(dir);
        let face = face as usize;
        if self.face != face || !self.s.contains(&s) || !self.t.contains(&t) {
            self.descend(face, s, t);
        }
        self.index.list(self.cell)
    }

    fn descend(&mut self, face: usize, s: f64, t: f64) {
        let (mut cell, mut low, mut width) = (face, [-1.0, -1.0], 2.0);
        while self.index.cells[cell].quarters > 0 {
            width *= 0.5;
            let (right, upper) = (s >= low[0] + width, t >= low[1] + width);
            cell = self.index.cells[cell].quarters as usize + usize::from(right) + 2 * usize::from(upper);
            low = [low[0] + if right { width } else { 0.0 }, low[1] + if upper { width } else { 0.0 }];
        }
        (self.face, self.cell) = (face, cell);
        (self.s, self.t) = (low[0]..low[0] + width, low[1]..low[1] + width);
    }
}

/// A hash of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hash(pub(super) u128);

impl Default for Hash {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Hash {
    /// Adds a number.
    pub(super) fn add(&mut self, word: u64) {
        let mixed = (self.0 ^ u128::from(word)).wrapping_mul(0x2360_ED05_1FC6_5DA4_4385_DF64_9FCC_F645);
        self.0 = mixed ^ (mixed >> 71);
    }

    /// Adds a number by its bits.
    pub(super) fn add_f64(&mut self, value: f64) {
        self.add(value.to_bits());
    }
}
