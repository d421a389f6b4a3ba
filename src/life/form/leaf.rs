//! Leaves: single triangles, bent pairs, twigs, stars and blades, drawn from both sides.

use super::build::{Look, Mesh};
use super::math::{TURN, cos, sin};
use super::random::Random;
use glam::Vec3;

/// Leaf or cluster of leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    /// Foot of the leaf.
    pub at: Vec3,
    /// Unit direction from the foot to the tip.
    pub along: Vec3,
    /// Unit direction across.
    pub across: Vec3,
    /// Length from foot to tip.
    pub length: f32,
    /// Width across.
    pub width: f32,
    /// Normal for lighting.
    pub normal: Vec3,
    /// Look at the foot.
    pub look: Look,
    /// Look at the tip.
    pub tip: Look,
}

/// Triangle whose broad side lies at a share `belly` of the length: two shoulders and a tip.
pub(super) fn triangle(mesh: &mut Mesh, leaf: &Leaf, skew: f32) {
    let Leaf { at, along, across, length, width, normal, look, tip } = *leaf;
    let half = across * (width * 0.5);
    let lift = along * (skew * length * 0.4);
    let a = mesh.vertex(at - half - lift, normal - across * 0.2 - along * 0.15, look);
    let b = mesh.vertex(at + half + lift, normal + across * 0.2 - along * 0.15, look);
    let c = mesh.vertex(at + along * length, normal + along * 0.2, tip);
    mesh.triangle(a, b, c);
}

/// Pair of triangles folded along the line from foot to tip, by `bend` of the width.
pub(super) fn pair(mesh: &mut Mesh, leaf: &Leaf, bend: f32) {
    let Leaf { at, along, across, length, width, normal, look, tip } = *leaf;
    let belly = at + along * (length * 0.42) - across.cross(along) * (bend * width);
    let half = across * (width * 0.5);
    let foot = mesh.vertex(at, normal - along * 0.2, look);
    let a = mesh.vertex(belly - half, normal - across * 0.35, tip);
    let b = mesh.vertex(belly + half, normal + across * 0.35, tip);
    let end = mesh.vertex(at + along * length, normal + along * 0.2, tip);
    mesh.triangle(foot, end, a);
    mesh.triangle(foot, b, end);
}

/// Twig: leaves to both sides of a line and one at its end, two triangles each.
///
/// `leaf` is the leaf at the end; the twig reaches back from its foot. `fan` is the angle between leaves and twig.
pub(super) fn twig(mesh: &mut Mesh, leaf: &Leaf, blades: usize, fan: f32, random: &mut Random) {
    let Leaf { at, along, across, length, width, normal, look, tip } = *leaf;
    let up = across.cross(along);
    let up = if up.dot(normal) < 0.0 { -up } else { up };
    for k in 0..blades {
        let hand = if k == 0 { 0.0 } else { 1.0 - 2.0 * (k % 2) as f32 };
        let angle = hand * fan * random.range(0.75, 1.3) + random.signed() * 0.15;
        let (s, c) = (sin(angle), cos(angle));
        let roll = random.signed() * 0.6;
        let way = along * c + across * s;
        let side = ((across * c - along * s) + up * roll).normalize_or(across);
        let long = length * random.range(0.75, 1.15);
        let foot = at - along * (0.36 * length * k.div_ceil(2) as f32);
        let half = side * (width * 0.5 * random.range(0.85, 1.15));
        let skew = way * (long * random.range(-0.16, 0.16));
        let belly = foot + way * (long * random.range(0.34, 0.46));
        let end = foot + way * long - up * (long * random.range(0.1, 0.4));
        let normal = normal - side * (0.3 * roll);
        let glow = random.range(0.88, 1.12);
        let [look, tip] = [look, tip].map(|l| Look { light: l.light * glow, ..l });
        let a = mesh.vertex(belly - half - skew, normal - side * 0.3, look);
        let b = mesh.vertex(belly + half + skew, normal + side * 0.3, look);
        let end = mesh.vertex(end, normal + way * 0.3, tip);
        mesh.triangle(a, b, end);
        let foot = mesh.vertex(foot - up * (0.1 * long), normal - way * 0.2, look);
        mesh.triangle(a, foot, b);
    }
}

/// Star: triangles around one centre, turned against one another, whose corners are the tips of leaves.
pub(super) fn star(mesh: &mut Mesh, leaf: &Leaf, triangles: usize, random: &mut Random) {
    let Leaf { at, along, across, length, width, normal, look, tip } = *leaf;
    let up = across.cross(along).normalize_or(normal);
    let up = if up.dot(normal) < 0.0 { -up } else { up };
    for t in 0..triangles {
        let spin = TURN / 3.0 * t as f32 / triangles as f32;
        let corner = [0.0, 1.0, 2.0].map(|k: f32| {
            let angle = spin + k * TURN / 3.0 + random.signed() * 0.5;
            let far = random.range(0.62, 1.2);
            let out = along * (cos(angle) * length * far) + across * (sin(angle) * width * far);
            // Tips bend down, so that the star is a small dome.
            let place = at + out + up * (length * random.range(-0.45, 0.05));
            let glow = 0.5 + 0.5 * cos(angle);
            let mixed = Look { light: look.light + (tip.light - look.light) * glow, ..tip };
            mesh.vertex(place, normal + out.normalize_or_zero() * 0.45, mixed)
        });
        mesh.triangle(corner[0], corner[1], corner[2]);
    }
}

/// Point of a blade's path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rib {
    /// Middle of the blade.
    pub at: Vec3,
    /// Half of the width, as a vector across.
    pub half: Vec3,
    /// Normal for lighting.
    pub normal: Vec3,
    /// Look.
    pub look: Look,
}

/// Flat strip through `ribs` that ends in a point; it takes 2 x ribs - 3 triangles.
pub(super) fn blade(mesh: &mut Mesh, ribs: &[Rib]) {
    let Some((end, body)) = ribs.split_last() else { return };
    let mut previous: Option<[u16; 2]> = None;
    for rib in body {
        let left = mesh.vertex(rib.at - rib.half, rib.normal - rib.half.normalize_or_zero() * 0.2, rib.look);
        let right = mesh.vertex(rib.at + rib.half, rib.normal + rib.half.normalize_or_zero() * 0.2, rib.look);
        if let Some([a, b]) = previous {
            mesh.triangle(a, b, right);
            mesh.triangle(a, right, left);
        }
        previous = Some([left, right]);
    }
    if let Some([a, b]) = previous {
        let tip = mesh.vertex(end.at, end.normal, end.look);
        mesh.triangle(a, b, tip);
    }
}
