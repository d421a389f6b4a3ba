//! Rods: all points within a radius of a segment, as a trunk's section has them, and of a point, as a ball has them.

use crate::terrain::ground::convex::{Axis, Convex, Nearest, between};
use glam::DVec3;

/// A section of a trunk, or a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rod {
    pub(super) ends: [DVec3; 2],
    pub(super) radius: f64,
}

/// The segment in the middle of a rod.
pub(super) struct Core([DVec3; 2]);

impl Rod {
    /// The segment in its middle, `size` times as large.
    pub(super) fn core(&self, size: f64) -> Core {
        Core(self.ends.map(|end| end * size))
    }

    /// How far a point is outside; negative inside.
    pub(super) fn over(&self, point: DVec3) -> f64 {
        let core = Axis { from_m: self.ends[0], to_m: self.ends[1] };
        core.nearest_to(point).distance(point) - self.radius
    }

    /// Where a ray enters it, `size` times as large, or begins in it, between two distances.
    pub(super) fn ray(&self, size: f64, origin_m: DVec3, dir: DVec3, [from_m, to_m]: [f64; 2]) -> Option<(f64, DVec3)> {
        let ([foot_m, top_m], radius_m) = (self.ends.map(|end| end * size), self.radius * size);
        let core = Axis { from_m: foot_m, to_m: top_m };
        let start_m = origin_m + dir * from_m;
        if core.nearest_to(start_m).distance(start_m) <= radius_m {
            return Some((from_m, -dir));
        }
        let (along, rel_m) = (top_m - foot_m, start_m - foot_m);
        let (length2, speed, height) = (along.length_squared(), along.dot(dir), along.dot(rel_m));
        // The side: a point of the ray at the radius from the line of the segment.
        let (a, b) = (length2 - speed * speed, length2 * rel_m.dot(dir) - height * speed);
        let c = length2 * (rel_m.length_squared() - radius_m * radius_m) - height * height;
        let side = if a > 1e-12 * length2 { first(a, b, c) } else { None };
        let side = side.filter(|more_m| (0.0..=length2).contains(&(height + more_m * speed)));
        let ends = [foot_m, top_m].map(|end_m| {
            let rel_m = start_m - end_m;
            first(1.0, rel_m.dot(dir), rel_m.length_squared() - radius_m * radius_m)
        });
        let more_m = [side, ends[0], ends[1]].into_iter().flatten().fold(f64::INFINITY, f64::min);
        let hit_m = start_m + dir * more_m;
        (from_m + more_m <= to_m).then(|| (from_m + more_m, (hit_m - core.nearest_to(hit_m)) / radius_m))
    }
}

/// The lesser root of `a t² + 2 b t + c`, if it is not negative.
fn first(a: f64, b: f64, c: f64) -> Option<f64> {
    let discriminant = b * b - a * c;
    let root = if discriminant >= 0.0 { (-b - discriminant.sqrt()) / a } else { -1.0 };
    (root >= 0.0).then_some(root)
}

impl Convex for Core {
    fn nearest(&self, axis: &Axis) -> Nearest {
        between(axis, self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
        (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn a_ray_hits_the_first_point_at_the_radius(
            ends in [vector(1.0), vector(1.0)], is_ball in any::<bool>(), radius in 0.05..0.6_f64,
            origin_m in vector(3.0), dir in vector(1.0),
        ) {
            prop_assume!(dir.length() > 0.1);
            let ends = if is_ball { [ends[0]; 2] } else { ends };
            let (rod, dir) = (Rod { ends, radius }, dir.normalize());
            let over = |at_m: f64| 2.0 * rod.over((origin_m + dir * at_m) / 2.0);
            let end_m = match rod.ray(2.0, origin_m, dir, [0.0, 20.0]) {
                Some((0.0, _)) => {
                    prop_assert!(over(0.0) <= 1e-9);
                    return Ok(());
                }
                Some((hit_m, normal)) => {
                    prop_assert!(over(hit_m).abs() < 1e-6 && (normal.length() - 1.0).abs() < 1e-6);
                    hit_m
                }
                None => 20.0,
            };
            for i in 0..200 {
                prop_assert!(over(end_m * f64::from(i) / 200.0) > -1e-6);
            }
        }
    }
}
