//! Meshes of artists as forms: height 1, the share of the sky at each corner, and levels of detail.

use super::build::{Detail, Mesh, Vertex};
use super::math::pow;
use super::thin::{self, Thinned};
use super::{LEVELS, shade};
use crate::planet::Form;
use crate::planet::life::FileMesh;
use crate::planet::mesh::{MeshData, MeshNode};
use glam::{Vec2, Vec3};
use std::cell::OnceCell;

/// Most triangles of each level of detail.
pub(super) const MOST: [usize; LEVELS] = [20_000, 1400, 280, 56];
/// Greatest factor of a corner's colour on the mean colour.
const MOST_TINT: f32 = 3.9;

/// Triangles with indices of 32 bits.
#[derive(Clone, Debug, Default)]
pub(super) struct Fine {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<[u32; 3]>,
}

/// Mesh of a file before its levels of detail, which are made when they are asked for.
pub(super) struct Plan {
    fine: Fine,
    levels: [OnceCell<Thinned>; LEVELS],
}

/// Plan of a variant; None if there is no mesh, or nothing of it is above the ground.
pub(super) fn plan(form: &FileMesh, seed: u32) -> Option<Plan> {
    let mesh = form.file.mesh()?;
    let nodes = variant(mesh, form.variants, seed);
    let foot = |node: &MeshNode| if form.variants { node.foot } else { Vec2::ZERO };
    let top = nodes.iter().map(|node| top(node)).fold(0.0, f32::max);
    if top < 1e-6 {
        return None;
    }
    let mut fine = Fine::default();
    for node in nodes {
        let (first, foot) = (fine.vertices.len() as u32, foot(node).extend(0.0));
        fine.vertices.extend(node.corners.iter().map(|corner| {
            let mean = Vec3::from_array(mesh.colors[usize::from(corner.is_leaf)].map(|part| part as f32));
            let tint = (corner.color / mean.max(Vec3::splat(1e-3))).clamp(Vec3::ZERO, Vec3::splat(MOST_TINT));
            Vertex {
                position: (corner.position - foot) / top,
                normal: corner.normal.normalize_or(Vec3::Z),
                part: f32::from(u8::from(corner.is_leaf)),
                light: 1.0,
                sway: 0.0,
                tint: if form.own_colors { tint } else { Vec3::ONE },
            }
        }));
        fine.triangles.extend(node.triangles.iter().map(|triangle| triangle.map(|at| first + at)));
    }
    let reach = fine.vertices.iter().fold(0.05_f32, |reach, v| reach.max(v.position.truncate().length()));
    for v in &mut fine.vertices {
        // Trunks bend less than what is far out.
        let out = v.position.truncate().length() / reach;
        v.sway = (pow(v.position.z.clamp(0.0, 1.0), 1.5) * (0.3 + 0.7 * out)).min(1.0);
    }
    shade::sky(&mut fine);
    Some(Plan { fine, levels: Default::default() })
}

/// Mesh at a level of detail.
pub(super) fn build(plan: &Plan, detail: &Detail) -> Mesh {
    let level = detail.level.min(LEVELS - 1);
    plan.levels[level].get_or_init(|| thin::thinned(&plan.fine, MOST[level])).mesh(detail)
}

/// The nodes that are the variant of a seed.
fn variant(mesh: &MeshData, are_variants: bool, seed: u32) -> Vec<&MeshNode> {
    if !are_variants {
        return mesh.nodes.iter().collect();
    }
    let standing = mesh.nodes.iter().filter(|node| top(node) > 1e-6).take(Form::VARIANTS as usize);
    let standing: Vec<&MeshNode> = standing.collect();
    // The lowest two bits of a seed differ from variant to variant of a population (`crate::life::model`).
    let pick = (seed % Form::VARIANTS) as usize % standing.len().max(1);
    standing.get(pick).copied().into_iter().collect()
}

/// Greatest height of a node over the ground.
fn top(node: &MeshNode) -> f32 {
    node.corners.iter().fold(0.0, |top, corner| top.max(corner.position.z))
}
