//! Pictures of any size as squares of [`SIDE`] texels: means over the area of each texel. The pixels may come in any
//! order. Fewer pixels than texels are interpolated, wrapping at the borders.

use super::SIDE;

/// Three numbers of a pixel: a colour, a normal, or one number thrice.
pub(super) type Pixel = [f32; 3];

/// Sums over the area of each texel.
pub(super) struct Shrink {
    columns: Side,
    rows: Side,
    sums: Vec<Pixel>,
    /// Sums of a row, along the columns.
    line: Vec<Pixel>,
}

/// One side of the picture and of the square.
struct Side {
    pixels: usize,
    texels: usize,
}

impl Side {
    fn new(pixels: usize) -> Self {
        Self { pixels, texels: pixels.min(SIDE) }
    }

    /// The texels that a pixel touches, with the shares of the texel that it covers: two at most, for there are no
    /// more texels than pixels.
    fn covered(&self, pixel: usize) -> [(usize, f32); 2] {
        let (from, to) = (pixel * self.texels, (pixel + 1) * self.texels);
        let first = from / self.pixels;
        let border = ((first + 1) * self.pixels).min(to);
        let share = |length: usize| length as f32 / self.pixels as f32;
        [(first, share(border - from)), ((first + 1).min(self.texels - 1), share(to - border))]
    }
}

impl Shrink {
    /// For a picture of this width and height, neither 0.
    pub(super) fn new([width, height]: [usize; 2]) -> Self {
        let (columns, rows) = (Side::new(width), Side::new(height));
        let (line, sums) = (vec![[0.0; 3]; columns.texels], vec![[0.0; 3]; columns.texels * rows.texels]);
        Self { columns, rows, sums, line }
    }

    /// Adds pixels of a row, from a column on, `step` columns apart.
    pub(super) fn add(&mut self, row: usize, column: usize, step: usize, pixels: impl Iterator<Item = Pixel>) {
        if row >= self.rows.pixels {
            return;
        }
        self.line.fill([0.0; 3]);
        for (column, pixel) in (column..self.columns.pixels).step_by(step).zip(pixels) {
            for (texel, share) in self.columns.covered(column) {
                let sum = &mut self.line[texel];
                *sum = std::array::from_fn(|i| sum[i] + share * pixel[i]);
            }
        }
        let width = self.columns.texels;
        for (texel, share) in self.rows.covered(row).into_iter().filter(|(_, share)| *share > 0.0) {
            for (sum, added) in self.sums[texel * width..][..width].iter_mut().zip(&self.line) {
                *sum = std::array::from_fn(|i| sum[i] + share * added[i]);
            }
        }
    }

    /// The texels, row by row.
    pub(super) fn finish(self) -> Vec<Pixel> {
        let (width, height) = (self.columns.texels, self.rows.texels);
        if (width, height) == (SIDE, SIDE) {
            return self.sums;
        }
        let (across, down) = (between(width), between(height));
        let mixed = |a: Pixel, b: Pixel, share: f32| -> Pixel { std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share) };
        let mut texels = Vec::with_capacity(SIDE * SIDE);
        for &(y, next_y, v) in &down {
            let [row, next] = [y, next_y].map(|y| &self.sums[y * width..][..width]);
            texels.extend(
                across
                    .iter()
                    .map(|&(x, next_x, u)| mixed(mixed(row[x], row[next_x], u), mixed(next[x], next[next_x], u), v)),
            );
        }
        texels
    }
}

/// For each texel of a side, the two of fewer between whose middles it lies, and its way from the first to the second.
fn between(few: usize) -> Vec<(usize, usize, f32)> {
    let place = |texel: usize| {
        let at = (texel as f32 + 0.5) * few as f32 / SIDE as f32 - 0.5 + few as f32;
        (at as usize % few, (at as usize + 1) % few, at.fract())
    };
    (0..SIDE).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of noise, and its mean.
    fn noise([width, height]: [usize; 2]) -> (Vec<Pixel>, f64) {
        let number = |i: usize| ((i as u32).wrapping_mul(2_654_435_761) >> 8) as f32 / 16_777_216.0;
        let pixels: Vec<Pixel> = (0..width * height).map(|i| [number(i), 0.5, 1.0]).collect();
        let mean = pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / pixels.len() as f64;
        (pixels, mean)
    }

    fn shrunk(size: [usize; 2], pixels: &[Pixel]) -> Vec<Pixel> {
        let mut shrink = Shrink::new(size);
        // From the last row to the first, each in two runs.
        for (row, line) in pixels.chunks_exact(size[0]).enumerate().rev() {
            shrink.add(row, 1, 2, line.iter().copied().skip(1).step_by(2));
            shrink.add(row, 0, 2, line.iter().copied().step_by(2));
        }
        shrink.finish()
    }

    #[test]
    fn any_size_keeps_its_mean() {
        for size in [[1, 1], [3, 2], [7, 700], [512, 512], [513, 511], [1000, 333], [1024, 64], [1537, 1025]] {
            let (pixels, mean) = noise(size);
            let texels = shrunk(size, &pixels);
            assert_eq!(texels.len(), SIDE * SIDE);
            let [first, second, third] =
                [0, 1, 2].map(|i| texels.iter().map(|texel| f64::from(texel[i])).sum::<f64>() / (SIDE * SIDE) as f64);
            // Interpolation between few pixels counts some of them a little more.
            assert!((first - mean).abs() < 2e-3, "{size:?}: {first} instead of {mean}");
            assert!((second - 0.5).abs() < 1e-5 && (third - 1.0).abs() < 1e-5, "{size:?}: {second} {third}");
        }
    }

    #[test]
    fn texels_are_means_of_their_pixels() {
        let size = [2 * SIDE, SIDE];
        let pixels: Vec<Pixel> = (0..size[0] * size[1]).map(|i| [(i % 2) as f32, (i % size[0]) as f32, 0.0]).collect();
        let texels = shrunk(size, &pixels);
        for (i, texel) in texels.iter().enumerate() {
            assert!((texel[0] - 0.5).abs() < 1e-6, "{i}: {texel:?}");
            assert!((texel[1] - (2 * (i % SIDE)) as f32 - 0.5).abs() < 1e-3, "{i}: {texel:?}");
        }
    }
}
