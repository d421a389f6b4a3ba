//! Curves through points: monotone cubic interpolation (Fritsch and Carlson 1980), linear beyond the ends.
//!
//! Between two points the curve stays within the range of their values, so that it has no wiggles.

use super::lanes::{CHUNK, Lane};
use crate::simd::for_each_simd;

/// The value of a curve at `x`. A curve without points is the identity.
pub fn curve_at(points: &[[f64; 2]], x: f64) -> f64 {
    CompiledCurve::new(points).map_or(x, |curve| curve.at(x).0)
}

/// A curve, compiled.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CompiledCurve {
    /// From left to right; the first also holds to the left of its start.
    pieces: Vec<Piece>,
}

/// A cubic `y + t (c1 + t (c2 + t c3))` with `t` counted from its start, `x`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    x: f64,
    y: f64,
    c: [f64; 3],
}

impl Piece {
    /// Value and derivative.
    #[inline(always)]
    fn at(&self, x: f64) -> (f64, f64) {
        let t = x - self.x;
        let [c1, c2, c3] = self.c;
        (self.y + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + t * (3.0 * c3)))
    }
}

impl CompiledCurve {
    /// `None` for a curve that changes nothing: without points, or with points out of order.
    pub(super) fn new(points: &[[f64; 2]]) -> Option<Self> {
        let rises = |pair: &[[f64; 2]]| pair[1][0] > pair[0][0];
        let [[first_x, first_y], .., [last_x, last_y]] = *points else { return None };
        if !points.windows(2).all(rises) {
            return None;
        }
        let secants: Vec<f64> = points.windows(2).map(|p| (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])).collect();
        let slopes = slopes(&secants);
        let mut pieces = vec![Piece { x: first_x, y: first_y, c: [slopes[0], 0.0, 0.0] }];
        for (k, pair) in points.windows(2).enumerate() {
            let (width, secant, from, to) = (pair[1][0] - pair[0][0], secants[k], slopes[k], slopes[k + 1]);
            let c2 = (3.0 * secant - 2.0 * from - to) / width;
            let c3 = (from + to - 2.0 * secant) / (width * width);
            pieces.push(Piece { x: pair[0][0], y: pair[0][1], c: [from, c2, c3] });
        }
        pieces.push(Piece { x: last_x, y: last_y, c: [slopes[secants.len()], 0.0, 0.0] });
        Some(Self { pieces })
    }

    /// Value and derivative.
    pub(super) fn at(&self, x: f64) -> (f64, f64) {
        let piece = self.pieces.iter().rev().find(|piece| x >= piece.x).or(self.pieces.first());
        piece.map_or((x, 1.0), |piece| piece.at(x))
    }

    /// Lowest and greatest value between two positions.
    pub(super) fn range(&self, lo: f64, hi: f64) -> (f64, f64) {
        let inner = self.pieces.iter().filter(|piece| piece.x > lo && piece.x < hi).map(|piece| piece.y);
        inner.chain([self.at(lo).0, self.at(hi).0]).fold((f64::MAX, f64::MIN), |(lo, hi), y| (lo.min(y), hi.max(y)))
    }
}

/// The slope at each point, such that every piece is monotone.
fn slopes(secants: &[f64]) -> Vec<f64> {
    let ends = (secants.first().copied().unwrap_or(1.0), secants.last().copied().unwrap_or(1.0));
    let inner = secants.windows(2).map(|d| if d[0] * d[1] > 0.0 { 0.5 * (d[0] + d[1]) } else { 0.0 });
    let mut slopes: Vec<f64> = std::iter::once(ends.0).chain(inner).chain([ends.1]).collect();
    for (k, &secant) in secants.iter().enumerate() {
        if secant == 0.0 {
            (slopes[k], slopes[k + 1]) = (0.0, 0.0);
            continue;
        }
        let (a, b) = (slopes[k] / secant, slopes[k + 1] / secant);
        let square = a * a + b * b;
        if square > 9.0 {
            let shrink = 3.0 / square.sqrt();
            (slopes[k], slopes[k + 1]) = (shrink * a * secant, shrink * b * secant);
        }
    }
    slopes
}

/// The value and derivative of the curve at each number.
#[inline(always)]
fn bend_body(n: usize, curve: &CompiledCurve, x: &Lane<f64>, y: &mut Lane<f64>, slope: &mut Lane<f64>) {
    let (mut lowest, mut greatest) = (f64::MAX, f64::MIN);
    for x in &x[..n.min(CHUNK)] {
        lowest = if *x < lowest { *x } else { lowest };
        greatest = if *x > greatest { *x } else { greatest };
    }
    for (number, piece) in curve.pieces.iter().enumerate() {
        // A later piece replaces the earlier ones from its start on. Numbers that lie close together need few pieces.
        let from = if number == 0 { f64::MIN } else { piece.x };
        let is_passed = curve.pieces.get(number + 1).is_some_and(|next| next.x <= lowest);
        if from > greatest || is_passed {
            continue;
        }
        for i in 0..n.min(CHUNK) {
            let (value, derivative) = piece.at(x[i]);
            let here = x[i] >= from;
            y[i] = if here { value } else { y[i] };
            slope[i] = if here { derivative } else { slope[i] };
        }
    }
}
for_each_simd!(pub(super) fn bend(n: usize, curve: &CompiledCurve, x: &Lane<f64>, y: &mut Lane<f64>, slope: &mut Lane<f64>) = bend_body);
