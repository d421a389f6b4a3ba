//! Share of the sky that each corner of a mesh sees past the rest of it.

use super::artist::Fine;
use super::math::{GOLDEN, around, mix};
use super::sight::each_pixel;
use glam::{Vec2, Vec3};

/// Directions of the sky.
const WAYS: u32 = 24;
/// Pixels along a side of a picture of the mesh.
const SIDE: usize = 96;
/// Distance from a surface at which it does not hide itself, in heights.
const BIAS: f32 = 0.03;
/// Light of what sees nothing of the sky: others throw light there.
const LEAST: f32 = 0.3;

/// Writes the light of all corners.
pub(super) fn sky(fine: &mut Fine) {
    let middle = Vec3::new(0.0, 0.0, 0.5);
    let reach = fine.vertices.iter().fold(0.1_f32, |reach, v| reach.max((v.position - middle).length()));
    let scale = SIDE as f32 / (2.0 * reach);
    // Seen share and whole, for both sides of a surface: leaves have two.
    let mut seen = vec![(0.0_f32, 0.0_f32); fine.vertices.len()];
    for i in 0..WAYS {
        // As many for each part of the sky's light on level ground.
        let high = ((i as f32 + 0.5) / WAYS as f32).sqrt();
        let way = around(i as f32 * GOLDEN) * (1.0 - high * high).sqrt() + Vec3::Z * high;
        let right = way.any_orthonormal_vector();
        let up = way.cross(right);
        let place = |p: Vec3| {
            let rel = p - middle;
            (Vec2::new(rel.dot(right), rel.dot(up)) * scale + 0.5 * SIDE as f32).extend(-rel.dot(way))
        };
        let mut depths = vec![f32::MAX; SIDE * SIDE];
        for triangle in &fine.triangles {
            let corners = triangle.map(|at| place(fine.vertices[at as usize].position));
            each_pixel(corners, [SIDE; 2], |at, depth, _| depths[at] = depths[at].min(depth));
        }
        for (v, (share, whole)) in fine.vertices.iter().zip(&mut seen) {
            let facing = v.normal.dot(way);
            let weight = if v.part > 0.5 { facing.abs().max(0.2) } else { facing.max(0.0) };
            if weight <= 0.0 {
                continue;
            }
            let at = place(v.position + (way + v.normal * facing.signum()) * (0.5 * BIAS));
            let column = (at.x.max(0.0) as usize).min(SIDE - 1);
            let row = (at.y.max(0.0) as usize).min(SIDE - 1);
            *whole += weight;
            if depths[row * SIDE + column] >= at.z - BIAS {
                *share += weight;
            }
        }
    }
    for (v, (share, whole)) in fine.vertices.iter_mut().zip(seen) {
        // What faces the ground alone sees none of these ways.
        v.light = if whole > 0.0 { mix(LEAST, 1.0, share / whole) } else { mix(LEAST, 1.0, 0.25) };
    }
}
