//! Vertices as whole numbers of 16 and 8 bits, as KHR_mesh_quantization allows them in glTF 2.0.
//!
//! The positions of all tiles of a level lie on one lattice about the planet's centre. A vertex that two of them share
//! becomes the same point of it in both, so that no gap opens between them.

use super::patch::Patch;
use glam::{DVec3, Vec2, Vec3};

/// Greatest number of a coordinate.
const MOST: f64 = u16::MAX as f64;
/// Points of the lattice at either end that are left free for vertices of skirts, which are rounded twice.
const FREE: f64 = 2.0;
/// Greatest extent of a tile along an axis of the planet frame, in mean sides: 1.29 where three faces of the cube
/// sphere meet. The rest is for relief.
const SIDES: f64 = 1.35;

/// The part of a lattice that a tile lies in.
pub(super) struct Lattice {
    /// Distance between neighbouring points along each axis, metres.
    pub(super) step_m: f64,
    /// The corner that positions are counted from: whole numbers of steps from the planet's centre.
    corner: DVec3,
}

impl Lattice {
    /// Distance between the points for tiles of a level with a mean side and a depth of skirts on the reference sphere,
    /// metres.
    pub(super) fn step_m(side_m: f64, skirt_m: f64) -> f64 {
        (SIDES * side_m + skirt_m) / (MOST - 2.0 * FREE)
    }

    /// The lattice around a patch about the planet's centre, its water and its skirt: that with `step_m`, or each
    /// second, third or further point of it, if the relief is higher than the tile is wide.
    pub(super) fn around(patch: &Patch, skirt_m: f64, step_m: f64) -> Self {
        let water_m = patch.water_m();
        let mut least = DVec3::INFINITY;
        let mut most = DVec3::NEG_INFINITY;
        for vertex in &patch.vertices {
            let position_m = vertex.position_m - patch.center_m;
            let below_m = position_m - position_m.normalize() * skirt_m;
            least = least.min(position_m).min(below_m);
            most = most.max(position_m).max(below_m);
            // Water in a mesh of its own has these levels, and those between.
            for level_m in water_m.into_iter().flatten() {
                let level_m = position_m.normalize() * level_m;
                least = least.min(level_m);
                most = most.max(level_m);
            }
        }
        let steps = (most - least).max_element() / step_m;
        let step_m = step_m * (steps / (MOST - 2.0 * FREE)).ceil().max(1.0);
        Self { step_m, corner: (least / step_m).floor() - (FREE - 1.0) }
    }

    /// The corner from the planet's centre, in the frame of the mesh, metres.
    pub(super) fn corner_m(&self) -> DVec3 {
        self.corner * self.step_m
    }

    /// Moves each vertex to the nearest point of the lattice, at most half a step along each axis, and the origin to
    /// the corner.
    pub(super) fn snap(&self, patch: &mut Patch) {
        for vertex in &mut patch.vertices {
            let steps = (vertex.position_m - patch.center_m) / self.step_m;
            vertex.position_m = (steps.round() - self.corner) * self.step_m;
        }
        patch.center_m = -self.corner_m();
    }
}

/// A position in steps from the corner. The fourth number fills the vertex to a multiple of four bytes.
pub(super) fn position(steps: Vec3) -> [u16; 4] {
    steps.round().extend(0.0).to_array().map(|number| number as u16)
}

/// A vector of unit length or less, 127 for 1: within half of 1/127 along each axis, so that directions are within
/// 0.4 degrees.
pub(super) fn unit(vector: Vec3, fourth: f32) -> [i8; 4] {
    vector.extend(fourth).to_array().map(|value| (value * 127.0).round() as i8)
}

/// Texture coordinates from 0 to 1, 65535 for 1.
pub(super) fn place(uv: Vec2) -> [u16; 2] {
    // An f32 times 65535 is not exact in f32.
    uv.to_array().map(|value| (f64::from(value) * 65_535.0).round() as u16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(range: std::ops::Range<f64>) -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(range).prop_map(DVec3::from_array)
    }

    proptest! {
        #[test]
        fn a_vertex_moves_by_half_a_step_at_most(
            middle in vector(-7e6..7e6),
            offsets in prop::collection::vec(vector(-1e5..1e5), 1..20),
            (step_m, skirt_m, origin_m) in (0.5_f64..20.0, 0.0_f64..1000.0, vector(-1e6..1e6)),
        ) {
            let positions_m: Vec<_> = offsets.iter().map(|offset| middle + *offset).collect();
            // The planet's centre need not be the origin.
            let mut patch = Patch::of(positions_m.iter().map(|position_m| *position_m + origin_m), origin_m);
            let lattice = Lattice::around(&patch, skirt_m, step_m);
            let multiple = lattice.step_m / step_m;
            prop_assert!((multiple - multiple.round()).abs() < 1e-9 && multiple >= 1.0);
            lattice.snap(&mut patch);
            prop_assert!((patch.center_m + lattice.corner_m()).length() < 1e-6);
            for (vertex, position_m) in patch.vertices.iter().zip(&positions_m) {
                let steps = position((vertex.position_m / lattice.step_m).as_vec3());
                let read_m = DVec3::new(steps[0].into(), steps[1].into(), steps[2].into()) * lattice.step_m;
                let away_m = (read_m + lattice.corner_m() - *position_m).abs();
                prop_assert!(away_m.max_element() <= 0.5 * lattice.step_m + 1e-6, "{away_m} of {}", lattice.step_m);
                // So does the skirt, which is rounded twice.
                let below_m = vertex.position_m - (vertex.position_m - patch.center_m).normalize() * skirt_m;
                prop_assert!(below_m.min_element() > 0.0 && below_m.max_element() < MOST * lattice.step_m);
            }
        }

        #[test]
        fn directions_are_within_less_than_half_a_degree(direction in vector(-1.0..1.0)) {
            prop_assume!(direction.length() > 0.01);
            let direction = direction.normalize();
            let [x, y, z, fourth] = unit(direction.as_vec3(), 1.0);
            prop_assert_eq!(fourth, 127);
            let read = DVec3::new(x.into(), y.into(), z.into());
            prop_assert!(read.angle_between(direction).to_degrees() < 0.4);
            // Validators of glTF allow so much.
            prop_assert!((read.length() / 127.0 - 1.0).abs() < 0.00674);
        }

        #[test]
        fn texture_coordinates_are_within_half_a_step(u in 0.0_f32..=1.0, v in 0.0_f32..=1.0) {
            let read = place(Vec2::new(u, v)).map(|number| f64::from(number) / 65_535.0);
            prop_assert!((read[0] - f64::from(u)).abs() <= 0.500_001 / 65_535.0);
            prop_assert!((read[1] - f64::from(v)).abs() <= 0.500_001 / 65_535.0);
        }
    }

    #[test]
    fn ends_are_exact() {
        assert_eq!(unit(Vec3::NEG_X, 0.0), [-127, 0, 0, 0]);
        assert_eq!(place(Vec2::new(0.0, 1.0)), [0, u16::MAX]);
        assert_eq!(position(Vec3::new(0.0, 65_535.0, 0.499)), [0, u16::MAX, 0, 0]);
    }
}
