//! Tubes along a path: trunks, branches, stalks and tendrils.

use super::build::{Look, Mesh};
use super::math::{TURN, cos, sin};
use glam::Vec3;

/// Point of a tube's path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    /// Centre.
    pub at: Vec3,
    /// Radius.
    pub radius: f32,
    /// Look of the ring.
    pub look: Look,
}

/// Number of triangles of a tube.
pub(super) fn triangles(knots: usize, sides: usize) -> usize {
    if knots < 2 { 0 } else { (knots - 2) * 2 * sides + sides }
}

/// Path with at most `most` knots (at least 2), which keeps both ends.
pub(super) fn thinned(knots: &[Knot], most: usize) -> Vec<Knot> {
    let most = most.max(2);
    if knots.len() <= most {
        return knots.to_vec();
    }
    (0..most).map(|i| knots[i * (knots.len() - 1) / (most - 1)]).collect()
}

/// Direction of a path at one of its knots.
fn direction(knots: &[Knot], i: usize) -> Vec3 {
    let before = knots[i.saturating_sub(1)].at;
    let after = knots[(i + 1).min(knots.len() - 1)].at;
    (after - before).normalize_or(Vec3::Z)
}

/// Round tube that ends in a point.
pub(super) fn tube(mesh: &mut Mesh, knots: &[Knot], sides: usize) {
    fluted(mesh, knots, sides, |_, _| 1.0);
}

/// Tube that ends in a point; its radius is multiplied by `flute(angle, share of the path)`.
pub(super) fn fluted(mesh: &mut Mesh, knots: &[Knot], sides: usize, flute: impl Fn(f32, f32) -> f32) {
    if knots.len() < 2 || sides < 3 {
        return;
    }
    let last = knots.len() - 1;
    let mut across = direction(knots, 0).any_orthonormal_vector();
    let mut previous: Vec<u16> = Vec::new();
    for (i, knot) in knots[..last].iter().enumerate() {
        let along = direction(knots, i);
        across = (across - along * along.dot(across)).normalize_or(along.any_orthonormal_vector());
        let other = along.cross(across);
        let share = i as f32 / last as f32;
        let slope = (knots[i].radius - knots[i + 1].radius) / (knots[i + 1].at - knots[i].at).length().max(1e-5);
        let ring: Vec<u16> = (0..sides)
            .map(|s| {
                let angle = s as f32 * TURN / sides as f32;
                let out = |a: f32| (across * cos(a) + other * sin(a)) * flute(a, share);
                let tangent = out(angle + 0.05) - out(angle - 0.05);
                let normal = tangent.cross(along).normalize_or(out(angle));
                let at = knot.at + out(angle) * knot.radius;
                mesh.vertex(at, normal + along * slope.clamp(-2.0, 2.0), knot.look)
            })
            .collect();
        for s in 0..previous.len() {
            let n = (s + 1) % sides;
            mesh.triangle(previous[s], previous[n], ring[n]);
            mesh.triangle(previous[s], ring[n], ring[s]);
        }
        previous = ring;
    }
    let tip = mesh.vertex(knots[last].at, direction(knots, last), knots[last].look);
    for s in 0..sides {
        mesh.triangle(previous[s], previous[(s + 1) % sides], tip);
    }
}
