//! Positions of points in a lattice of cubic cells, for kinds that scatter features in jittered cells.

use crate::simd::{Simd, for_each_simd};
use crate::terrain::lane::{CHUNK, Lane, Points3};
use crate::terrain::noise::{self, Octave};
use crate::terrain::scalar::Scalar;

/// Cell, position within the cell (0 to 1) and unit direction of each point of a chunk.
pub(super) struct Places<S = f32> {
    pub(super) cell: [Lane<u32>; 3],
    pub(super) fraction: [Lane<S>; 3],
    pub(super) dir: [Lane<S>; 3],
}

impl<S: Scalar> Default for Places<S> {
    fn default() -> Self {
        Self { cell: [[0; CHUNK]; 3], fraction: [[S::default(); CHUNK]; 3], dir: [[S::default(); CHUNK]; 3] }
    }
}

impl<S: Scalar> Places<S> {
    /// Finds the positions of skewed points in the cells of an octave.
    pub(super) fn find(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_places(simd, skewed, octave, self);
    }
}

#[inline(always)]
fn find_places_body<S: Scalar>(skewed: Points3<'_>, octave: &Octave, places: &mut Places<S>) {
    let [x, y, z] = skewed;
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    for (axis, p) in skewed.into_iter().enumerate() {
        for i in 0..n {
            let unskewed = p[i] - (x[i] + y[i] + z[i]) * (1.0 / 6.0);
            let (cell, fraction) = noise::split(unskewed * octave.frequency + octave.offset[axis]);
            places.cell[axis][i] = cell;
            places.fraction[axis][i] = fraction;
            places.dir[axis][i] = S::of(unskewed);
        }
    }
}
for_each_simd!(fn find_places<S: Scalar>(skewed: Points3<'_>, octave: &Octave, places: &mut Places<S>) = find_places_body);

/// The eight cells around a point, in steps towards the nearer side: its own cell and the neighbours along each axis.
pub(super) const CORNERS: [[i32; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];

/// The cell at a number of steps from that of the `i`th point, each axis counted towards the side on which the next
/// cell is nearer; and its offset from the point's own cell.
#[inline(always)]
pub(super) fn neighbour<S: Scalar>(places: &Places<S>, step: [i32; 3], i: usize) -> ([u32; 3], [S; 3]) {
    // For a point in the lower half of its cell the nearer neighbour is below, in the upper half above.
    let side = |axis: usize| match places.fraction[axis][i] < S::of(0.5) {
        true => (u32::MAX, S::of(-1.0)),
        false => (1, S::of(1.0)),
    };
    let ((x, dx), (y, dy), (z, dz)) = (side(0), side(1), side(2));
    let cell = |axis: usize, side: u32| places.cell[axis][i].wrapping_add(side.wrapping_mul(step[axis] as u32));
    let steps = step.map(S::from_i32);
    let from = [dx * steps[0], dy * steps[1], dz * steps[2]];
    ([cell(0, x), cell(1, y), cell(2, z)], from)
}

/// A number from 0 to 1 from the lowest ten bits.
#[inline(always)]
pub(super) fn unit<S: Scalar>(bits: u32) -> S {
    // Rounded to f32 for every scalar, or a crater would exist in f64 and not in f32.
    S::from_f32((bits & 1023) as f32 * (1.0 / 1023.0))
}
