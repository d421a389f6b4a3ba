//! Points by the leaves of the index that hold them. Points sink through the quadtree together, so that cells are
//! looked at once for all points in them.

use super::index::{Cell, Index};
use crate::sphere::cube::face_point;
use glam::DVec3;

/// A point on its face.
#[derive(Clone, Copy, Debug)]
struct Spot {
    face: u8,
    point: u32,
    s: f64,
    t: f64,
}

/// Memory for points on their way to their leaves.
#[derive(Debug, Default)]
pub(super) struct Sinking {
    spots: Vec<Spot>,
    points: Vec<u32>,
}

impl Sinking {
    /// Calls `each` with each leaf that has pieces and holds some of the points, and with the numbers of those points.
    /// The order of leaves and of the points in a leaf is unspecified.
    pub(super) fn each_leaf(&mut self, index: &Index, dirs: &[DVec3], mut each: impl FnMut(&Cell, &[u32])) {
        let spot = |(point, dir): (usize, &DVec3)| {
            let (face, s, t) = face_point(*dir);
            Spot { face: face as u8, point: point as u32, s, t }
        };
        self.spots.clear();
        self.spots.extend(dirs.iter().enumerate().map(spot));
        let first = self.spots.first().map_or(0, |spot| spot.face);
        if self.spots.iter().any(|spot| spot.face != first) {
            self.spots.sort_unstable_by_key(|spot| spot.face);
        }
        let points = &mut self.points;
        for spots in self.spots.chunk_by_mut(|a, b| a.face == b.face) {
            let face = usize::from(spots.first().map_or(0, |spot| spot.face));
            sink(index.face(face), Square::FACE, spots, &mut |leaf, spots| {
                points.clear();
                points.extend(spots.iter().map(|spot| spot.point));
                each(leaf, points);
            });
        }
    }
}

/// The square of a cell on its face.
#[derive(Clone, Copy)]
struct Square {
    low: [f64; 2],
    width: f64,
}

impl Square {
    const FACE: Self = Self { low: [-1.0, -1.0], width: 2.0 };
}

fn sink(cell: &Cell, square: Square, spots: &mut [Spot], found: &mut dyn FnMut(&Cell, &[Spot])) {
    if spots.is_empty() {
        return;
    }
    let Some(quarters) = cell.quarters() else {
        if !cell.listed().is_empty() {
            found(cell, spots);
        }
        return;
    };
    let width = 0.5 * square.width;
    let middle = square.low.map(|low| low + width);
    let upper = part(spots, |spot| spot.t < middle[1]);
    let (below, above) = spots.split_at_mut(upper);
    for (row, spots) in [below, above].into_iter().enumerate() {
        let right = part(spots, |spot| spot.s < middle[0]);
        let (left, right) = spots.split_at_mut(right);
        for (column, spots) in [left, right].into_iter().enumerate() {
            let low =
                [if column > 0 { middle[0] } else { square.low[0] }, if row > 0 { middle[1] } else { square.low[1] }];
            sink(&quarters[column + 2 * row], Square { low, width }, spots, found);
        }
    }
}

/// Moves those that are first to the front. Returns how many are.
fn part(spots: &mut [Spot], is_first: impl Fn(&Spot) -> bool) -> usize {
    let mut count = 0;
    for i in 0..spots.len() {
        if is_first(&spots[i]) {
            spots.swap(i, count);
            count += 1;
        }
    }
    count
}
