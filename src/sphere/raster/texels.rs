//! Texels: stored numbers, and whole grids of them.

use rayon::prelude::*;

/// A stored number.
pub trait Texel: Copy + Send + Sync + Default + 'static {
    /// Its value.
    fn get(self) -> f64;
    /// The nearest number that can be stored.
    fn of(value: f64) -> Self;
}

impl Texel for u16 {
    #[inline(always)]
    fn get(self) -> f64 {
        f64::from(self)
    }
    fn of(value: f64) -> Self {
        (value + 0.5) as u16
    }
}

impl Texel for f32 {
    #[inline(always)]
    fn get(self) -> f64 {
        f64::from(self)
    }
    fn of(value: f64) -> Self {
        value as f32
    }
}

/// A smaller grid, each texel the mean of those it covers.
pub(super) fn shrunk<T: Texel>(texels: &[T], from: [usize; 2], to: [usize; 2]) -> Vec<T> {
    let mut out = vec![T::default(); to[0] * to[1]];
    out.par_chunks_mut(to[0]).enumerate().for_each(|(row, out)| {
        let rows = row * from[1] / to[1]..(row + 1) * from[1] / to[1];
        for (column, out) in out.iter_mut().enumerate() {
            let columns = column * from[0] / to[0]..(column + 1) * from[0] / to[0];
            let count = rows.len() * columns.len();
            let row_sum = |r: usize| texels[r * from[0]..][columns.clone()].iter().map(|t| t.get()).sum::<f64>();
            *out = T::of(rows.clone().map(row_sum).sum::<f64>() / count as f64);
        }
    });
    out
}

pub(super) fn range<T: Texel>(texels: &[T]) -> (f64, f64) {
    let both = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    let one = |part: &[T]| part.iter().fold((f64::MAX, f64::MIN), |range, t| both(range, (t.get(), t.get())));
    texels.par_chunks(1 << 16).map(one).reduce(|| (f64::MAX, f64::MIN), both)
}
