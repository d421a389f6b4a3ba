//! Leaves: single triangles, bent pairs and blades, drawn from both sides.

use super::build::{Look, Mesh};
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
