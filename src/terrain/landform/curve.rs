//! A smooth curve through knots without overshoot: monotone cubic Hermite pieces (Fritsch and Butland 1984).
//!
//! It is level at both ends, so that values stay within its bounds. The curves that artists draw (`height::curve`)
//! are linear beyond their ends.

/// Knots in order, with the slope at each; constant beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve(Vec<Knot>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    x: f64,
    y: f64,
    slope: f64,
}

impl Curve {
    /// The curve through points whose coordinates both rise, level at both ends.
    pub(super) fn new(points: &[(f64, f64)]) -> Self {
        let mut knots: Vec<Knot> = points.iter().map(|&(x, y)| Knot { x, y, slope: 0.0 }).collect();
        for i in 1..knots.len().saturating_sub(1) {
            let [before, here, after] = [knots[i - 1], knots[i], knots[i + 1]];
            let (width, next_width) = (here.x - before.x, after.x - here.x);
            let (rise, next_rise) = ((here.y - before.y) / width, (after.y - here.y) / next_width);
            // The weighted harmonic mean of the slopes on both sides keeps each piece monotone.
            let share = (width + 2.0 * next_width) / (3.0 * (width + next_width));
            knots[i].slope = rise * next_rise / (share * next_rise + (1.0 - share) * rise).max(1e-300);
        }
        Self(knots)
    }

    /// Value and derivative.
    pub(super) fn at(&self, x: f64) -> (f64, f64) {
        let after = self.0.partition_point(|knot| knot.x <= x);
        let (Some(a), Some(b)) = (self.0.get(after.wrapping_sub(1)), self.0.get(after)) else {
            let end = if after == 0 { self.0.first() } else { self.0.last() };
            return (end.map_or(0.0, |knot| knot.y), 0.0);
        };
        let width = b.x - a.x;
        let (t, rise) = ((x - a.x) / width, (b.y - a.y) / width);
        // a + t (start + t (bend + t twist)), in units of the width.
        let twist = a.slope + b.slope - 2.0 * rise;
        let bend = rise - a.slope - twist;
        let value = a.y + width * t * (a.slope + t * (bend + t * twist));
        (value, a.slope + t * (2.0 * bend + 3.0 * t * twist))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rises_through_its_knots_without_a_kink() {
        let points = [(-1.0, -2.0), (0.0, -1.9), (0.1, 0.0), (0.9, 0.1), (3.0, 5.0)];
        let curve = Curve::new(&points);
        for (x, y) in points {
            assert!((curve.at(x).0 - y).abs() < 1e-12);
        }
        let mut before = curve.at(-1.2);
        for i in -1199..3200 {
            let x = f64::from(i) * 1e-3;
            let (y, slope) = curve.at(x);
            assert!(y >= before.0 && (-2.0..=5.0).contains(&y) && slope >= 0.0);
            assert!((slope - before.1).abs() < 2.0, "{x}: {slope} after {}", before.1);
            let difference = (curve.at(x + 1e-7).0 - curve.at(x - 1e-7).0) / 2e-7;
            assert!((difference - slope).abs() < 1e-3, "{x}: {difference} {slope}");
            before = (y, slope);
        }
    }
}
