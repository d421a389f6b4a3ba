//! Cube faces and the mapping between the square of a face and the sphere.
//!
//! A point of a face is `(s, t)` in -1..1. Each coordinate is warped by `w / sqrt(1 + c² (1 - w²))` with c = 0.87,
//! which evens out the cells (greatest to least area 1.268, against 5.196 without), then the cube point is
//! normalised. The mapping and its inverse use only square roots and divisions, which IEEE 754 rounds correctly: the
//! same bits on every machine. Lengths are summed in the order x, y, z on every face, so that two faces agree on
//! their common edge to the bit.

use glam::DVec3;

pub(crate) const C_SQUARED: f64 = 0.87 * 0.87;

/// One of the six faces: the axis that points out of it, positive or negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
#[repr(u8)]
pub enum Face {
    PosX,
    NegX,
    PosY,
    NegY,
    PosZ,
    NegZ,
}

impl Face {
    /// All six, in the order of their number.
    pub const ALL: [Face; 6] = [Face::PosX, Face::NegX, Face::PosY, Face::NegY, Face::PosZ, Face::NegZ];

    /// Its name in the names of files.
    #[cfg(feature = "bake")]
    pub(crate) fn name(self) -> &'static str {
        ["pos_x", "neg_x", "pos_y", "neg_y", "pos_z", "neg_z"][self as usize]
    }

    /// The axis (0 = x, 1 = y, 2 = z) and sign of the outward normal.
    pub fn axis(self) -> (usize, i64) {
        let number = self as usize;
        (number / 2, if number.is_multiple_of(2) { 1 } else { -1 })
    }

    /// The face whose outward normal is `sign` times `axis`.
    pub fn from_axis(axis: usize, positive: bool) -> Face {
        Self::ALL[axis * 2 + usize::from(!positive)]
    }

    /// The axes along which `s` and `t` grow, chosen so that (s, t, outward) is right-handed: seen from outside, `t` is
    /// a quarter turn anticlockwise from `s`. The sign applies to `s`.
    pub fn tangent_axes(self) -> ((usize, i64), usize) {
        let (axis, sign) = self.axis();
        (((axis + 1) % 3, sign), (axis + 2) % 3)
    }

    /// The face that a direction goes through; on an edge or corner, the first axis wins.
    pub fn of_direction(dir: DVec3) -> Face {
        let a = dir.abs();
        let axis = if a.x >= a.y && a.x >= a.z {
            0
        } else if a.y >= a.z {
            1
        } else {
            2
        };
        Face::from_axis(axis, dir[axis] >= 0.0)
    }
}

/// Warps one face coordinate, -1..1 to -1..1; odd, and exact at -1, 0 and 1.
#[inline]
fn bend(w: f64) -> f64 {
    w / (1.0 + C_SQUARED * (1.0 - w * w)).sqrt()
}

/// The inverse of [`bend`].
#[inline]
pub(crate) fn unbend(v: f64) -> f64 {
    v * ((1.0 + C_SQUARED) / (1.0 + C_SQUARED * (v * v))).sqrt()
}

/// Unit vector through the point `(s, t)` of a face, both -1..1.
#[inline]
pub fn direction(face: Face, s: f64, t: f64) -> DVec3 {
    let (axis, sign) = face.axis();
    let ((s_axis, s_sign), t_axis) = face.tangent_axes();
    let mut p = [0.0; 3];
    p[axis] = sign as f64;
    p[s_axis] = bend(s) * s_sign as f64;
    p[t_axis] = bend(t);
    // Written out, so that the order of the sum is the same on every face.
    let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
    DVec3::new(p[0] / length, p[1] / length, p[2] / length)
}

/// The face and the point `(s, t)` on it that a direction (of any length but zero) goes through.
pub fn face_point(dir: DVec3) -> (Face, f64, f64) {
    let face = Face::of_direction(dir);
    let (axis, _) = face.axis();
    let ((s_axis, s_sign), t_axis) = face.tangent_axes();
    let depth = dir[axis].abs();
    (face, unbend(dir[s_axis] / depth * s_sign as f64), unbend(dir[t_axis] / depth))
}

/// Tangent of the angle of a cone whose sine is `share`; of nearly a right angle or more, infinite.
pub(crate) fn tangent_of(share: f64) -> f64 {
    if share < 0.9 { share / (1.0 - share * share).sqrt() } else { f64::INFINITY }
}

/// The part of a face, `s` and `t` from and to, that a cone around a direction covers. `wide`: see
/// [`tangent_of`].
pub(crate) fn part_under(face: Face, dir: DVec3, wide: f64) -> Option<[[f64; 2]; 2]> {
    let (axis, sign) = face.axis();
    let ((s_axis, s_sign), t_axis) = face.tangent_axes();
    let depth = dir[axis] * sign as f64;
    if wide > 0.2 {
        return Some([[-1.0, 1.0]; 2]);
    }
    // A face ends 55 degrees from its middle; the cone is at most 12 wide.
    if depth <= 0.3 * dir.length() {
        return None;
    }
    let at = [dir[s_axis] * s_sign as f64 / depth, dir[t_axis] / depth];
    let out = (at[0] * at[0] + at[1] * at[1]).sqrt();
    // On the plane of the face an angle is stretched by at most the square of the secant at its far end.
    let far = (out + wide) / (1.0 - out * wide);
    let reach = wide * (1.0 + far * far) + 1e-12;
    let part = |v: f64| {
        (v - reach <= 1.0 && v + reach >= -1.0).then(|| [v - reach, v + reach].map(|v| unbend(v.clamp(-1.0, 1.0))))
    };
    Some([part(at[0])?, part(at[1])?])
}

#[cfg(any(feature = "bake", feature = "render"))]
/// The direction at `x`, `y` of a face of a cube texture with `side` texels along each face, as WebGPU orders and turns
/// its faces; the middles of texels are at halves. Faces are flat here, unlike those of the planet's squares.
pub(crate) fn texture_direction(face: usize, side: usize, x: f64, y: f64) -> DVec3 {
    let (u, v) = (2.0 * x / side as f64 - 1.0, 2.0 * y / side as f64 - 1.0);
    let dir = match face {
        0 => DVec3::new(1.0, -v, -u),
        1 => DVec3::new(-1.0, -v, u),
        2 => DVec3::new(u, 1.0, v),
        3 => DVec3::new(u, -1.0, -v),
        4 => DVec3::new(u, -v, 1.0),
        _ => DVec3::new(-u, -v, -1.0),
    };
    dir.normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corner_grid(face: Face, n: i32) -> impl Iterator<Item = (f64, f64, DVec3)> {
        let at = move |i: i32| -1.0 + 2.0 * f64::from(i) / f64::from(n);
        (0..=n).flat_map(move |j| (0..=n).map(move |i| (at(i), at(j), direction(face, at(i), at(j)))))
    }

    #[test]
    fn faces_agree_on_their_edges_to_the_bit() {
        // Every boundary point of every face must be produced, bit for bit, by exactly one other face (two at
        // corners).
        let boundary: Vec<(Face, [u64; 3], bool)> = Face::ALL
            .iter()
            .flat_map(|&face| {
                corner_grid(face, 64).filter_map(move |(s, t, d)| {
                    let (on_s, on_t) = (s.abs() == 1.0, t.abs() == 1.0);
                    (on_s || on_t).then(|| (face, d.to_array().map(|x| (x + 0.0).to_bits()), on_s && on_t))
                })
            })
            .collect();
        for (face, bits, corner) in &boundary {
            let twins = boundary.iter().filter(|(f, b, _)| f != face && b == bits).count();
            assert_eq!(twins, if *corner { 2 } else { 1 }, "{face:?} {bits:?}");
        }
    }

    #[test]
    fn squares_are_seen_from_outside() {
        for face in Face::ALL {
            let (a, b, c) = (direction(face, 0.0, 0.0), direction(face, 0.1, 0.0), direction(face, 0.0, 0.1));
            assert!((b - a).cross(c - a).dot(a) > 0.0, "{face:?}");
        }
    }

    #[test]
    fn area_distortion_is_what_the_mapping_promises() {
        let n = 64;
        let at = |i: i32| -1.0 + 2.0 * f64::from(i) / f64::from(n);
        let cell = |i, j| {
            let d = |i, j| direction(Face::PosX, at(i), at(j));
            (d(i + 1, j) - d(i, j)).cross(d(i, j + 1) - d(i, j)).length()
        };
        let areas: Vec<f64> = (0..n).flat_map(|j| (0..n).map(move |i| cell(i, j))).collect();
        let (min, max) = areas.iter().fold((f64::MAX, 0.0_f64), |(lo, hi), &a| (lo.min(a), hi.max(a)));
        assert!(max / min < 1.29, "{}", max / min);
    }

    proptest! {
        #[test]
        fn the_inverse_is_exact_to_rounding(face in 0_usize..6, s in -1.0..=1.0_f64, t in -1.0..=1.0_f64) {
            let dir = direction(Face::ALL[face], s, t);
            let (face, s, t) = face_point(dir);
            prop_assert!((direction(face, s, t) - dir).length() < 1e-15);
        }
    }

    #[cfg(feature = "render")]
    #[test]
    fn texels_of_a_cube_texture_look_where_webgpu_looks() {
        // The middle of each face, and a texel beside it to the right and below.
        let middles = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        let rights = [-DVec3::Z, DVec3::Z, DVec3::X, DVec3::X, DVec3::X, -DVec3::X];
        let downs = [-DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z, -DVec3::Y, -DVec3::Y];
        for (face, ((middle, right), down)) in middles.into_iter().zip(rights).zip(downs).enumerate() {
            let at = |x, y| texture_direction(face, 5, f64::from(x) + 0.5, f64::from(y) + 0.5);
            assert!(at(2, 2).distance(middle) < 1e-12, "{face}");
            assert!(at(3, 2).dot(right) > 0.3 && at(2, 3).dot(down) > 0.3, "{face}");
        }
    }
}
