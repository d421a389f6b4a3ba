//! Where points stand in a lattice of cubic cells: what the kinds share that scatter something in jittered cells.

use crate::terrain::noise::{self, CHUNK, Lane, Octave, Points3};
use crate::terrain::simd::{Simd, for_each_simd};

/// Cell, place within the cell (0 to 1) and unit direction of each point of a chunk.
pub(super) struct Places {
    pub(super) cell: [Lane<u32>; 3],
    pub(super) fraction: [Lane<f32>; 3],
    pub(super) dir: [Lane<f32>; 3],
}

impl Default for Places {
    fn default() -> Self {
        Self { cell: [[0; CHUNK]; 3], fraction: [[0.0; CHUNK]; 3], dir: [[0.0; CHUNK]; 3] }
    }
}

impl Places {
    /// Finds the places of skewed points in the cells of an octave.
    pub(super) fn find(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_places(simd, skewed, octave, self);
    }
}

#[inline(always)]
fn find_places_body(skewed: Points3<'_>, octave: &Octave, places: &mut Places) {
    let [x, y, z] = skewed;
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    for (axis, p) in skewed.into_iter().enumerate() {
        for i in 0..n {
            let unskewed = p[i] - (x[i] + y[i] + z[i]) * (1.0 / 6.0);
            let (cell, fraction) = noise::split(unskewed * octave.frequency + octave.offset[axis]);
            places.cell[axis][i] = cell;
            places.fraction[axis][i] = fraction;
            places.dir[axis][i] = unskewed as f32;
        }
    }
}
for_each_simd!(fn find_places(skewed: Points3<'_>, octave: &Octave, places: &mut Places) = find_places_body);

/// The eight cells around a point, in steps towards the nearer side: its own, and the neighbour along each axis or not.
pub(super) const CORNERS: [[i32; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];

/// The cell so many steps from that of the `i`th point, each axis counted towards the side on which the next cell is
/// nearer; and how many cells it lies from the point's own.
#[inline(always)]
pub(super) fn neighbour(places: &Places, step: [i32; 3], i: usize) -> ([u32; 3], [f32; 3]) {
    // The next cell is nearer below for a point in the lower half of its cell, above for one in the upper.
    let side = |axis: usize| if places.fraction[axis][i] < 0.5 { (u32::MAX, -1.0) } else { (1, 1.0) };
    let ((x, dx), (y, dy), (z, dz)) = (side(0), side(1), side(2));
    let cell = |axis: usize, side: u32| places.cell[axis][i].wrapping_add(side.wrapping_mul(step[axis] as u32));
    let from = [dx * step[0] as f32, dy * step[1] as f32, dz * step[2] as f32];
    ([cell(0, x), cell(1, y), cell(2, z)], from)
}

/// A number from 0 to 1 out of the low ten bits.
#[inline(always)]
pub(super) fn unit(bits: u32) -> f32 {
    (bits & 1023) as f32 * (1.0 / 1023.0)
}
