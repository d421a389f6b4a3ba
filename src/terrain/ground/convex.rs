//! Convex pieces that a capsule meets, the distance between them, and when a capsule that moves touches one.
//!
//! [`Convex`] is all that contacts and sweeps know of what stands in the way: the ground's [`Triangle`]s here, trunks
//! and stones in `life::solid`. Vectors are metres in the planet frame, or in that of an object.

use super::TOUCH_M;
use glam::DVec3;

/// Two things this near each other touch; distances in the planet frame are good for a hundredth of it.
pub(crate) const PRECISE_M: f64 = 1e-7;
/// A motion that brings two things nearer by less than this share of it leaves them apart.
const LEAST_CLOSING: f64 = 1e-7;
/// Most steps of an approach: each squares the error.
const MOST_STEPS: usize = 24;

/// The axis of a capsule.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) from_m: DVec3,
    pub(crate) to_m: DVec3,
}

/// Where an axis and a piece are nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub(crate) on_axis_m: DVec3,
    pub(crate) on_piece_m: DVec3,
    pub(crate) away_m: f64,
}

/// A convex piece of an obstacle.
pub(crate) trait Convex {
    /// Where it is nearest to an axis.
    fn nearest(&self, axis: &Axis) -> Nearest;
}

/// A piece of the ground, anticlockwise from above.
pub(crate) struct Triangle(pub(crate) [DVec3; 3]);

impl Axis {
    pub(crate) fn moved(&self, by_m: DVec3) -> Self {
        Self { from_m: self.from_m + by_m, to_m: self.to_m + by_m }
    }

    pub(crate) fn is_point(&self) -> bool {
        self.from_m == self.to_m
    }

    pub(crate) fn middle_m(&self) -> DVec3 {
        0.5 * (self.from_m + self.to_m)
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.from_m.distance(self.to_m)
    }

    /// The point that is nearest to another.
    pub(crate) fn nearest_to(&self, point_m: DVec3) -> DVec3 {
        nearest_on_segment([self.from_m, self.to_m], point_m)
    }
}

impl Nearest {
    pub(crate) fn between(on_axis_m: DVec3, on_piece_m: DVec3) -> Self {
        Self { on_axis_m, on_piece_m, away_m: on_axis_m.distance(on_piece_m) }
    }

    pub(crate) fn nearer(self, other: Self) -> Self {
        if other.away_m < self.away_m { other } else { self }
    }
}

impl Convex for Triangle {
    fn nearest(&self, axis: &Axis) -> Nearest {
        let [a, b, c] = self.0;
        let (on_face, is_inside) = self.nearest_to(axis.from_m);
        let from = Nearest::between(axis.from_m, on_face);
        if axis.is_point() {
            return from;
        }
        let normal = (b - a).cross(c - a);
        let [from_side, to_side] = [axis.from_m, axis.to_m].map(|end_m| normal.dot(end_m - a));
        // The rest of the axis is farther from the plane on the same side.
        if is_inside && from_side * to_side > 0.0 && to_side.abs() >= from_side.abs() {
            return from;
        }
        if from_side * to_side < 0.0 {
            let crossing_m = axis.from_m.lerp(axis.to_m, from_side / (from_side - to_side));
            if self.nearest_to(crossing_m).1 {
                return Nearest { on_axis_m: crossing_m, on_piece_m: crossing_m, away_m: 0.0 };
            }
        }
        let to = Nearest::between(axis.to_m, self.nearest_to(axis.to_m).0);
        [[a, b], [b, c], [c, a]].into_iter().fold(from.nearer(to), |best, edge| best.nearer(between(axis, edge)))
    }
}

impl Triangle {
    /// The point of the triangle nearest to another (Ericson 2005, "Real-time collision detection", 5.1.5), and whether
    /// it is inside rather than on an edge.
    fn nearest_to(&self, point_m: DVec3) -> (DVec3, bool) {
        let [a, b, c] = self.0;
        let (ab, ac, ap) = (b - a, c - a, point_m - a);
        let (d1, d2) = (ab.dot(ap), ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return (a, false);
        }
        let bp = point_m - b;
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        if d3 >= 0.0 && d4 <= d3 {
            return (b, false);
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return (a + ab * (d1 / (d1 - d3)), false);
        }
        let cp = point_m - c;
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        if d6 >= 0.0 && d5 <= d6 {
            return (c, false);
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return (a + ac * (d2 / (d2 - d6)), false);
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
            return (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), false);
        }
        let scale = 1.0 / (va + vb + vc);
        (a + ab * (vb * scale) + ac * (vc * scale), true)
    }
}

fn nearest_on_segment([from_m, to_m]: [DVec3; 2], point_m: DVec3) -> DVec3 {
    let along = to_m - from_m;
    let length2 = along.length_squared();
    let share = if length2 > 0.0 { ((point_m - from_m).dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    from_m + along * share
}

/// Where an axis and an edge are nearest (Ericson 2005, 5.1.9).
pub(crate) fn between(axis: &Axis, edge: [DVec3; 2]) -> Nearest {
    let (along, across, apart) = (axis.to_m - axis.from_m, edge[1] - edge[0], axis.from_m - edge[0]);
    let (a, e, f) = (along.length_squared(), across.length_squared(), across.dot(apart));
    let (b, c) = (along.dot(across), along.dot(apart));
    let denominator = a * e - b * b;
    // Parallel ones are nearest all along.
    let share = if denominator > 1e-12 * a * e { ((b * f - c * e) / denominator).clamp(0.0, 1.0) } else { 0.0 };
    let on_edge_m = nearest_on_segment(edge, axis.from_m + along * share);
    Nearest::between(axis.nearest_to(on_edge_m), on_edge_m)
}

/// How far a capsule goes until it touches a piece, at most `most_m`, and where they are nearest then. None if it does
/// not: also if it touches already and leaves, or slides along.
///
/// It stops [`TOUCH_M`] before a piece that it would meet, so that rounding never lets it in.
pub(crate) fn impact(
    piece: &impl Convex,
    axis: &Axis,
    dir: DVec3,
    most_m: f64,
    radius_m: f64,
) -> Option<(f64, Nearest)> {
    approach(piece, axis, dir, most_m, radius_m)?;
    approach(piece, axis, dir, most_m, radius_m + TOUCH_M)
}

/// As [`impact`], until the distance of the axis is `radius_m`: by the distance over the speed with which it falls
/// (conservative advancement; Mirtich 1996). Of two convex things neither can be nearer than their plane of separation
/// says, so it never goes too far, and one that does not fall now never will.
fn approach(piece: &impl Convex, axis: &Axis, dir: DVec3, most_m: f64, radius_m: f64) -> Option<(f64, Nearest)> {
    let mut gone_m = 0.0;
    let mut near = piece.nearest(axis);
    for _ in 0..MOST_STEPS {
        if near.away_m <= PRECISE_M {
            break;
        }
        let closing = -dir.dot(near.on_axis_m - near.on_piece_m) / near.away_m;
        if closing <= LEAST_CLOSING {
            return None;
        }
        if near.away_m - radius_m <= PRECISE_M {
            break;
        }
        gone_m += (near.away_m - radius_m) / closing;
        if gone_m > most_m {
            return None;
        }
        near = piece.nearest(&axis.moved(dir * gone_m));
    }
    Some((gone_m, near))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        (-2.0..2.0_f64, -2.0..2.0_f64, -2.0..2.0_f64).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn nothing_of_an_axis_and_a_triangle_is_nearer(
            corners in [vector(), vector(), vector()], from_m in vector(), to_m in vector(),
        ) {
            let (triangle, axis) = (Triangle(corners), Axis { from_m, to_m });
            let near = triangle.nearest(&axis);
            prop_assert!((near.on_axis_m.distance(near.on_piece_m) - near.away_m).abs() < 1e-9);
            prop_assert!(axis.nearest_to(near.on_axis_m).distance(near.on_axis_m) < 1e-9);
            let [a, b, c] = corners;
            for i in 0..=20 {
                for j in 0..=20 - i {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    let point_m = a + (b - a) * u + (c - a) * v;
                    prop_assert!(axis.nearest_to(point_m).distance(point_m) > near.away_m - 1e-9);
                }
            }
        }

        #[test]
        fn an_impact_is_the_first_touch(
            corners in [vector(), vector(), vector()], from_m in vector(), to_m in vector(), motion in vector(),
            radius_m in 0.05..0.5_f64,
        ) {
            let (triangle, axis) = (Triangle(corners), Axis { from_m, to_m });
            prop_assume!(triangle.nearest(&axis).away_m > radius_m + TOUCH_M && motion.length() > 0.1);
            let (dir, length_m) = (motion.normalize(), motion.length());
            let away_m = |gone_m: f64| triangle.nearest(&axis.moved(dir * gone_m)).away_m;
            let end_m = match impact(&triangle, &axis, dir, length_m, radius_m) {
                Some((gone_m, near)) => {
                    prop_assert!((near.away_m - radius_m - TOUCH_M).abs() < 1e-6, "{}", near.away_m);
                    gone_m
                }
                None => length_m,
            };
            for i in 0..=50 {
                prop_assert!(away_m(end_m * f64::from(i) / 50.0) > radius_m - 1e-6);
            }
        }
    }

    #[test]
    fn what_touches_may_leave_and_slide() {
        let floor = Triangle([DVec3::ZERO, DVec3::X * 9.0, DVec3::Y * 9.0]);
        let ball = Axis { from_m: DVec3::new(2.0, 2.0, 0.5), to_m: DVec3::new(2.0, 2.0, 0.5) };
        assert!(impact(&floor, &ball, DVec3::Z, 5.0, 0.5).is_none());
        assert!(impact(&floor, &ball, DVec3::X, 5.0, 0.5).is_none());
        let (gone_m, near) = impact(&floor, &ball, -DVec3::Z, 5.0, 0.5).unwrap();
        assert!(gone_m == 0.0 && near.on_piece_m.distance(DVec3::new(2.0, 2.0, 0.0)) < 1e-12);
        // Nor does an edge of a floor stop a ball that rolls over it as near as a sweep leaves it.
        let from_m = DVec3::new(-1.0, 2.0, 0.5 + 0.5 * TOUCH_M);
        let rolling = Axis { from_m, to_m: from_m };
        assert!(impact(&floor, &rolling, DVec3::X, 5.0, 0.5).is_none());
    }
}
