//! What is kept of a mesh: triangles in the frame of forms, and colours.

use crate::planet::linked::{Linked, LinkedFile};
use glam::{Vec2, Vec3};
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// Most triangles of the mesh of one file.
pub const MAX_TRIANGLES: usize = 200_000;

/// A reference to a mesh.
pub type MeshFile = LinkedFile<MeshData>;

/// Corner of a mesh's triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshCorner {
    /// Place in the units of the file; z is up and the ground is at 0.
    pub position: Vec3,
    /// Unit vector.
    pub normal: Vec3,
    /// Albedo, linear sRGB, 0 .. 1.
    pub color: Vec3,
    /// Whether it belongs to leaves: parts that light passes and bodies do not hit.
    pub is_leaf: bool,
}

/// Node at the top of a scene, with all below it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshNode {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// Place of the node over the ground, in the units of the file.
    pub foot: Vec2,
    /// Corners.
    pub corners: Vec<MeshCorner>,
    /// Triples of corners, with the front counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
}

/// The mesh of a file.
pub struct MeshData {
    /// The nodes at the top of the scene that have triangles.
    pub nodes: Vec<MeshNode>,
    /// Mean colours of all but leaves, and of leaves (albedo, linear sRGB). Equal if the file has only one of them.
    pub colors: [[f64; 3]; 2],
    /// Whether any of the triangles are leaves.
    pub has_leaves: bool,
    /// The files that belong to it, beside the one that the preset names.
    pub(super) others: Vec<PathBuf>,
    /// Hash of all files.
    pub(super) hash: u64,
}

impl MeshData {
    pub(super) fn new(nodes: Vec<MeshNode>, others: Vec<PathBuf>, hash: u64) -> Self {
        let (colors, has_leaves) = means(&nodes);
        Self { nodes, colors, has_leaves, others, hash }
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.nodes.iter().map(|node| node.triangles.len()).sum()
    }

    /// Hash of the content.
    pub(in crate::planet) fn hash(&self) -> u64 {
        self.hash
    }

    /// The files that belong to it, beside the one that the preset names.
    pub(in crate::planet) fn others(&self) -> &[PathBuf] {
        &self.others
    }
}

/// Content keys are made of this.
impl fmt::Debug for MeshData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MeshData({:016x})", self.hash)
    }
}

impl PartialEq for MeshData {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash
    }
}

impl Linked for MeshData {
    type Key = PathBuf;
}

impl LinkedFile<MeshData> {
    /// The mesh, if it is loaded.
    pub fn mesh(&self) -> Option<&Arc<MeshData>> {
        self.current().map(|(_, mesh)| mesh)
    }
}

#[cfg(test)]
impl LinkedFile<MeshData> {
    /// A reference to a mesh that is in no file.
    pub(crate) fn holding(nodes: Vec<MeshNode>) -> Self {
        let mut file = Self::from("mesh.glb".to_owned());
        file.set_folder("".as_ref());
        file.give(&PathBuf::from("mesh.glb"), &Arc::new(MeshData::new(nodes, Vec::new(), 0)));
        file
    }
}

/// Mean colours by area, of all but leaves and of leaves, and whether there are leaves.
fn means(nodes: &[MeshNode]) -> ([[f64; 3]; 2], bool) {
    let mut sums = [(Vec3::ZERO, 0.0_f32); 2];
    for node in nodes {
        for triangle in &node.triangles {
            let [a, b, c] = triangle.map(|at| &node.corners[at as usize]);
            let area = (b.position - a.position).cross(c.position - a.position).length();
            let (sum, whole) = &mut sums[usize::from(a.is_leaf)];
            *sum += (a.color + b.color + c.color) * (area / 3.0);
            *whole += area;
        }
    }
    let has = sums.map(|(_, whole)| whole > 0.0);
    let [wood, leaf] = sums.map(|(sum, whole)| (sum / whole.max(f32::MIN_POSITIVE)).as_dvec3().to_array());
    ([if has[0] { wood } else { leaf }, if has[1] { leaf } else { wood }], has[1])
}
