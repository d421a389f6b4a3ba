//! Stand-in: a capsule for what a game draws, and for a mesh that is not there.

use super::build::{Detail, Look, Mesh};
use super::math::mix;
use super::sphere;
use glam::Vec3;

/// Width of a stand-in for a mesh that is not there, as a share of the height.
pub(super) const WIDTH: f32 = 0.3;

/// Mesh of an upright capsule that stands on the ground. `width`: share of the height.
pub(super) fn build(width: f32, detail: &Detail) -> Mesh {
    let ball = sphere::sphere(detail.pick([5, 2, 1, 1]));
    let cap = (0.5 * width).min(0.5);
    let sides = 0.5 * width * detail.swell();
    let mut mesh = Mesh::default();
    for way in &ball.corners {
        let middle = if way.z > 1e-3 { 1.0 - cap } else { cap };
        let at = Vec3::new(way.x * sides * detail.flat, way.y * sides * detail.flat, middle + way.z * cap);
        // An ellipsoid's normals are those of the sphere over its axes.
        let normal = Vec3::new(way.x / sides.max(1e-3), way.y / sides.max(1e-3), way.z / cap.max(1e-3));
        mesh.vertex(at, normal, Look { part: 0.0, light: mix(0.55, 1.0, at.z), sway: 0.3 * at.z * at.z });
    }
    ball.triangles.iter().for_each(|&[a, b, c]| mesh.triangle(a, b, c));
    mesh
}
