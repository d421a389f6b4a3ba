//! The layout of a raster that covers a place: a rectangle of texels, flat.

use super::spline::bicubic;
use super::texels::Texel;

pub(super) struct Flat<T> {
    pub(super) width: usize,
    pub(super) texels: Vec<T>,
    /// Texels from the middle to the longer edge.
    half: f64,
}

impl<T: Texel> Flat<T> {
    pub(super) fn new(width: usize, texels: Vec<T>) -> Self {
        let longer = width.max(texels.len() / width.max(1));
        Self { width, texels, half: 0.5 * longer as f64 }
    }

    /// Side of a texel, where the longer side is 2.
    pub(super) fn texel(&self) -> f64 {
        1.0 / self.half
    }

    /// The value at a position, x to the right and y up from the middle, and its derivatives. Beyond an edge the
    /// texels of the edge go on.
    #[inline(always)]
    pub(super) fn sample(&self, x: f64, y: f64) -> (f64, f64, f64) {
        let (width, height) = (self.width as isize, (self.texels.len() / self.width) as isize);
        let row = |row: isize, column: isize| {
            let row = row.clamp(0, height - 1) * width;
            std::array::from_fn(|i| self.texels[(row + (column + i as isize).clamp(0, width - 1)) as usize].get())
        };
        let (middle_x, middle_y) = (0.5 * width as f64, 0.5 * height as f64);
        let (value, by_x, by_y) = bicubic(middle_x + x * self.half, middle_y - y * self.half, row);
        (value, by_x * self.half, -by_y * self.half)
    }
}
