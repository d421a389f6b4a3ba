//! Crystals: clusters of six-sided prisms with pointed ends.

use super::build::{Detail, Look, Mesh};
use super::math::{GOLDEN, TURN, around, cos, mix, pow, sin};
use super::random::Random;
use crate::planet::life::Crystal;
use glam::Vec3;

/// One crystal of a cluster.
struct Prism {
    foot: Vec3,
    axis: Vec3,
    length: f32,
    radius: f32,
    /// Share of the length at which the point begins.
    shoulder: f32,
    /// Offset of the tip, so that the end faces are uneven.
    tip: Vec3,
    spin: f32,
}

/// Crystals from the tallest on.
fn prisms(form: &Crystal, seed: u32) -> Vec<Prism> {
    let mut random = Random::new(seed, 1);
    let spin = random.range(0.0, TURN);
    (0..form.crystals)
        .map(|i| {
            let share = i as f32 / (form.crystals as f32).max(1.0);
            let out = around(spin + i as f32 * GOLDEN + random.signed() * 0.4);
            let away = pow(share, 0.6);
            let angle = form.lean as f32 * (0.12 + 1.15 * away) * random.range(0.7, 1.15);
            let length = if i == 0 { 1.0 } else { mix(0.85, 0.3, share) * random.range(0.75, 1.15) };
            let axis = Vec3::Z * cos(angle) + out * sin(angle);
            let radius = form.width as f32 * 0.5 * mix(1.0, 0.5, share) * random.range(0.75, 1.1);
            let foot = out * (form.spread as f32 * away * random.range(0.7, 1.1)) - axis * 0.08;
            let tip = random.ball() * (radius * 0.5);
            let shoulder = 1.0 - (1.5 * radius / length).clamp(0.12, 0.5) * random.range(0.8, 1.2);
            Prism { foot, axis, length, radius, shoulder, tip, spin: random.range(0.0, TURN) }
        })
        .collect()
}

/// Mesh of a cluster of crystals.
pub(super) fn build(form: &Crystal, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let prisms = prisms(form, detail.seed);
    let spikes = detail.level == 3 && prisms.len() > 3;
    let used = prisms.len().min(detail.pick([24, 24, 11, if spikes { 9 } else { 3 }]));
    // Crystals left out on a far level would leave a gap, so the rest take over from the whole range of sizes.
    let at = |i: usize| if i == 0 { 0 } else { i * prisms.len() / used };
    for i in 0..used {
        let prism = &prisms[at(i)];
        let sides = detail.pick([6, 6, 4, 3]);
        let rings: &[f32] = match detail.level {
            0 => &[0.0, 0.33, 0.66, 1.0],
            _ if spikes => &[0.0],
            _ => &[0.0, 1.0],
        };
        draw(&mut mesh, prism, sides, rings, detail.swell());
    }
    mesh
}

/// Prism with flat faces; `rings` are shares of its body's length.
fn draw(mesh: &mut Mesh, prism: &Prism, sides: usize, rings: &[f32], swell: f32) {
    let across = prism.axis.any_orthonormal_vector();
    let other = prism.axis.cross(across);
    let corner = |s: usize, share: f32| {
        let a = prism.spin + TURN * (s % sides) as f32 / sides as f32;
        // The faces differ in width.
        let a = a + 0.16 * sin(prism.spin * 3.0 + (s % sides) as f32 * 2.2);
        let radius = prism.radius * swell * mix(1.0, 0.86, share);
        let along = prism.length * prism.shoulder * share;
        prism.foot + prism.axis * along + (across * cos(a) + other * sin(a)) * radius
    };
    let tip = prism.foot + prism.axis * prism.length + prism.tip;
    let look = |at: Vec3, share: f32| {
        let light = mix(0.4, 1.0, (at.z * 1.6).clamp(0.0, 1.0)) * mix(0.75, 1.0, share);
        Look { part: pow(share, 1.3) * 0.9, light, sway: 0.0 }
    };
    let face = |mesh: &mut Mesh, points: &[(Vec3, f32)]| {
        let normal = (points[1].0 - points[0].0).cross(points[2].0 - points[0].0);
        let index: Vec<u16> = points.iter().map(|&(p, share)| mesh.vertex(p, normal, look(p, share))).collect();
        (2..index.len()).for_each(|i| mesh.triangle(index[0], index[i - 1], index[i]));
    };
    for s in 0..sides {
        for pair in rings.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let shares = (low * prism.shoulder, high * prism.shoulder);
            let bottom = [(corner(s, low), shares.0), (corner(s + 1, low), shares.0)];
            face(mesh, &[bottom[0], bottom[1], (corner(s + 1, high), shares.1), (corner(s, high), shares.1)]);
        }
        let end = *rings.last().unwrap_or(&0.0);
        let share = end * prism.shoulder;
        face(mesh, &[(corner(s, end), share), (corner(s + 1, end), share), (tip, 1.0)]);
    }
}
