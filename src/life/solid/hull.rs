//! Convex hulls of points, as pieces that capsules and rays meet. They are made here, and not by a library of physics,
//! because queries must have the same bits on every machine and in every version.

use crate::terrain::ground::convex::{Axis, Convex, Nearest, Triangle};
use glam::DVec3;
use std::collections::HashSet;

/// Points nearer to a face than this are on it; a hull is about 1 high.
const FLAT: f64 = 1e-9;
/// Faces with less area than this have no direction.
const LEAST_AREA: f64 = 1e-9;
/// Corners lie behind the planes of all faces by no less than this.
const SOUND: f64 = 1e-6;

/// A convex hull.
#[derive(Clone, Debug)]
pub(super) struct Hull {
    faces: Vec<Face>,
}

/// A triangle of a hull, anticlockwise from outside.
#[derive(Clone, Debug)]
struct Face {
    indices: [usize; 3],
    corners: [DVec3; 3],
    normal: DVec3,
    /// Height of the plane over the origin.
    away: f64,
}

impl Face {
    /// The face of three corners; None if it has no direction.
    fn new(points: &[DVec3], indices: [usize; 3]) -> Option<Self> {
        let corners = indices.map(|index| points[index]);
        let [a, b, c] = corners;
        let area = (b - a).cross(c - a);
        (area.length() > LEAST_AREA).then(|| {
            let normal = area.normalize();
            Self { indices, corners, normal, away: normal.dot(a) }
        })
    }

    fn over(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.away
    }

    fn edges(&self) -> [[usize; 2]; 3] {
        let [a, b, c] = self.indices;
        [[a, b], [b, c], [c, a]]
    }
}

impl Hull {
    /// Hull of points, of at most `most_corners` corners. With corners enough, no point is outside by more than
    /// `tolerance`. None for points in a plane. The method is quickhull (Barber, Dobkin and Huhdanpaa 1996): from four
    /// points on, the point farthest outside is the next corner.
    pub(super) fn new(points: &[DVec3], tolerance: f64, most_corners: usize) -> Option<Self> {
        let mut hull = Self { faces: first_faces(points)? };
        let mut outside: Vec<DVec3> = points.to_vec();
        let mut corners = points.to_vec();
        for _ in 4..most_corners {
            outside.retain(|point| hull.over(*point) > tolerance);
            let over = outside.iter().map(|point| hull.over(*point));
            let farthest = over.enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
            let Some((farthest, _)) = farthest else { break };
            corners.push(outside.swap_remove(farthest));
            hull.add(&corners);
        }
        hull.is_sound().then_some(hull)
    }

    /// How far a point is over the face that it is farthest over; negative inside, where it is the distance to the
    /// surface.
    pub(super) fn over(&self, point: DVec3) -> f64 {
        self.faces.iter().map(|face| face.over(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Corners of all faces.
    pub(super) fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.faces.iter().flat_map(|face| face.corners)
    }

    /// Takes the last of the points as a corner, unless a face would have no direction.
    fn add(&mut self, points: &[DVec3]) {
        let last = points.len() - 1;
        let (seen, hidden): (Vec<Face>, Vec<Face>) =
            self.faces.iter().cloned().partition(|face| face.over(points[last]) > FLAT);
        let edges: HashSet<[usize; 2]> = seen.iter().flat_map(Face::edges).collect();
        let rim = seen.iter().flat_map(Face::edges).filter(|[from, to]| !edges.contains(&[*to, *from]));
        let new: Option<Vec<Face>> = rim.map(|[from, to]| Face::new(points, [from, to, last])).collect();
        if let Some(new) = new {
            self.faces = hidden;
            self.faces.extend(new);
        }
    }

    /// Whether it is convex: rounding has led to no fold.
    fn is_sound(&self) -> bool {
        self.corners().all(|corner| self.over(corner) < SOUND)
    }

    /// The hull `size` times as large.
    pub(super) fn scaled(&self, size: f64) -> Sized<'_> {
        Sized { hull: self, size }
    }
}

/// The faces of four points that are far apart.
fn first_faces(points: &[DVec3]) -> Option<Vec<Face>> {
    let farthest = |away: &dyn Fn(DVec3) -> f64| {
        let away = points.iter().map(|point| away(*point)).enumerate();
        away.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))).map(|(index, _)| index)
    };
    let a = farthest(&|point| -point.x)?;
    let b = farthest(&|point| point.distance_squared(points[a]))?;
    let along = points[b] - points[a];
    let c = farthest(&|point| along.cross(point - points[a]).length_squared())?;
    let base = Face::new(points, [a, b, c])?;
    let d = farthest(&|point| base.over(point).abs())?;
    let over = base.over(points[d]);
    if over.abs() < SOUND {
        return None;
    }
    let [b, c] = if over > 0.0 { [c, b] } else { [b, c] };
    [[a, b, c], [a, d, b], [b, d, c], [c, d, a]].into_iter().map(|indices| Face::new(points, indices)).collect()
}

/// A hull in the size of an object; vectors are metres in the frame of the object.
pub(super) struct Sized<'a> {
    hull: &'a Hull,
    size: f64,
}

impl Sized<'_> {
    /// The least way along a face's normal that takes an axis out: its length, the normal, and the point of the face.
    pub(super) fn way_out(&self, axis: &Axis) -> (f64, DVec3, DVec3) {
        let mut least = (f64::INFINITY, DVec3::Z, axis.from_m);
        for face in &self.hull.faces {
            let [from_m, to_m] = [axis.from_m, axis.to_m].map(|end_m| face.away * self.size - face.normal.dot(end_m));
            let (depth_m, deepest_m) = if from_m >= to_m { (from_m, axis.from_m) } else { (to_m, axis.to_m) };
            if depth_m < least.0 {
                least = (depth_m, face.normal, deepest_m + face.normal * depth_m);
            }
        }
        least
    }

    /// Where a ray enters it, or begins in it, between two distances: the distance, and the normal there.
    pub(super) fn ray(&self, origin_m: DVec3, dir: DVec3, [from_m, to_m]: [f64; 2]) -> Option<(f64, DVec3)> {
        let (mut enter_m, mut leave_m, mut normal) = (from_m, to_m, -dir);
        for face in &self.hull.faces {
            let (over_m, speed) = (face.normal.dot(origin_m) - face.away * self.size, face.normal.dot(dir));
            if speed < 0.0 {
                let at_m = -over_m / speed;
                if at_m > enter_m {
                    (enter_m, normal) = (at_m, face.normal);
                }
            } else if speed > 0.0 {
                leave_m = leave_m.min(-over_m / speed);
            } else if over_m > 0.0 {
                return None;
            }
            if enter_m > leave_m {
                return None;
            }
        }
        Some((enter_m, normal))
    }
}

impl Convex for Sized<'_> {
    fn nearest(&self, axis: &Axis) -> Nearest {
        let mut best = Nearest { on_axis_m: axis.from_m, on_piece_m: axis.from_m, away_m: f64::INFINITY };
        for face in &self.hull.faces {
            let plane_m = face.away * self.size;
            let [from_m, to_m] = [axis.from_m, axis.to_m].map(|end_m| face.normal.dot(end_m) - plane_m);
            // The nearest point is on a face that is seen from the axis, and no nearer than its plane.
            if from_m.max(to_m) <= 0.0 || from_m.min(to_m) > best.away_m {
                continue;
            }
            best = best.nearer(Triangle(face.corners.map(|corner| corner * self.size)).nearest(axis));
        }
        if best.away_m.is_infinite() {
            return Nearest { away_m: 0.0, ..best };
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::spread;
    use proptest::prelude::*;

    fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
        (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn a_hull_holds_its_points_and_nothing_of_it_is_nearer(
            points in prop::collection::vec(vector(1.0), 4..60), from_m in vector(4.0), to_m in vector(4.0),
        ) {
            let Some(hull) = Hull::new(&points, 0.0, 200) else { return Ok(()) };
            for point in &points {
                prop_assert!(hull.over(*point) < 1e-6);
            }
            let (sized, axis) = (hull.scaled(2.0), Axis { from_m, to_m });
            let near = sized.nearest(&axis);
            // Each pair of points is a point of the hull.
            for (a, b) in points.iter().zip(points.iter().skip(1)) {
                let inside_m = (*a + *b) * 1.0;
                prop_assert!(axis.nearest_to(inside_m).distance(inside_m) > near.away_m - 1e-6);
            }
            if near.away_m > 1e-3 {
                prop_assert!((hull.over(near.on_piece_m / 2.0)).abs() < 1e-6);
                let dir = (near.on_piece_m - near.on_axis_m) / near.away_m;
                // A ray may touch a pointed corner and pass.
                if let Some((hit_m, _)) = sized.ray(near.on_axis_m, dir, [0.0, 20.0]) {
                    prop_assert!((hit_m - near.away_m).abs() < 1e-5, "{hit_m} {}", near.away_m);
                }
            } else if near.away_m == 0.0 {
                let (depth_m, normal, _) = sized.way_out(&axis);
                let moved = axis.moved(normal * (depth_m + 1e-6));
                prop_assert!(sized.nearest(&moved).away_m > 0.0);
            }
        }
    }

    #[test]
    fn points_of_a_ball_make_a_ball_and_those_of_a_plane_nothing() {
        let ball: Vec<DVec3> = spread(500).collect();
        let hull = Hull::new(&ball, 0.02, 200).unwrap();
        assert!(spread(300).all(|dir| hull.over(dir) < 0.03 && hull.over(dir * 0.9) < 0.0));
        let flat: Vec<DVec3> = ball.iter().map(|point| DVec3::new(point.x, point.y, 0.0)).collect();
        assert!(Hull::new(&flat, 0.0, 200).is_none() && Hull::new(&[], 0.0, 9).is_none());
    }
}
