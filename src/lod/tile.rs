//! A tile: the mesh data of one node, for any renderer.

use crate::sphere::{Face, NodeId};
use glam::{DVec3, Vec3};

/// Quads along a tile's side.
pub const TILE_QUADS: usize = 32;
/// Vertices along a tile's side.
pub const TILE_SIDE: usize = TILE_QUADS + 1;
/// Vertices of a tile.
pub const TILE_VERTICES: usize = TILE_SIDE * TILE_SIDE;

/// Texels along the side of a detail texture: one on each vertex and three between. Neighbours share their borders.
pub const DETAIL_SIDE: usize = 4 * TILE_QUADS + 1;
/// Apron: texels beyond the node on each side, so that averages around a point are equal from both sides of a border.
pub const DETAIL_APRON: usize = 2;
/// Texels along the side of the images of a detail texture.
pub const DETAIL_IMAGE: usize = DETAIL_SIDE + 2 * DETAIL_APRON;

/// Resident size of a detail texture with rivers and lakes.
pub(crate) const DETAIL_BYTES: usize = 3 * DETAIL_IMAGE * DETAIL_IMAGE * size_of::<[half::f16; 4]>();

/// The detail texture of a node: the ground at four times the density of its mesh, for shading.
///
/// [`DETAIL_IMAGE`] rows of [`DETAIL_IMAGE`] texels, to be interpolated linearly. Inside the apron of [`DETAIL_APRON`]
/// texels, the first and the last lie on the edges of the node. Heights are those of the evaluator, so that climate,
/// coasts and biomes cover the same share of the ground at every level. Slopes omit detail finer than twice the texel
/// spacing.
#[derive(Debug)]
pub struct DetailTile {
    /// The node.
    pub id: NodeId,
    /// Unique serial number.
    pub serial: u64,
    /// [`Tile::heights_serial`] of the tile that it was made for.
    pub heights_serial: u64,
    /// Rise over run along the two tangents of [`slope_basis`] (the normal is along `up - x * east - y * north`), and
    /// the same as the detail texture of the parent shows it.
    pub slopes: Vec<[half::f16; 4]>,
    /// The height in metres to which [`DetailTile::heights`] are relative.
    pub base_m: f32,
    /// Height in metres as the sum of the first two. The other two are the slope (rise over run) at the point as
    /// [`DetailTile::slopes`] show it, and with every octave.
    pub heights: Vec<[half::f16; 4]>,
    /// Rivers and lakes: share of the ground around the point that is under water (0 to 1), depth of the water in
    /// metres, the share as the detail texture of the parent shows it, and 1 where the water has a shore (0 where it
    /// is narrower than texels). Empty without a structure. Heights and slopes are those of the water's surface.
    pub water: Vec<[half::f16; 4]>,
}

impl DetailTile {
    /// Resident size.
    pub fn bytes(&self) -> usize {
        (self.slopes.len() + self.heights.len() + self.water.len()) * size_of::<[half::f16; 4]>()
    }
}

/// Two perpendicular tangents of the sphere at a direction on a face: one as nearly along the first axis of the face as
/// possible, and the one to its left, seen from outside.
pub fn slope_basis(face: Face, dir_planet: DVec3) -> [DVec3; 2] {
    let along = slope_axis(face);
    let east = (along - dir_planet * dir_planet.dot(along)).normalize_or_zero();
    [east, dir_planet.cross(east)]
}

/// The axis that a face's first tangent follows.
pub fn slope_axis(face: Face) -> DVec3 {
    let ((axis, sign), _) = face.tangent_axes();
    let mut along = DVec3::ZERO;
    along[axis] = sign as f64;
    along
}

/// One vertex, 52 bytes.
///
/// The position in the planet frame is `high + low`: each component is an f64 split into two f32. A shader that
/// computes `(high - eye_high) + (low - eye_low)` gets the position relative to the eye without loss, and the same bits
/// for the same point in every tile, so that neighbouring tiles meet without a pinhole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "render", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Vertex {
    /// Greater part of the position, metres.
    pub position_high_m: [f32; 3],
    /// Height above the reference sphere, metres.
    pub height_m: f32,
    /// Rest of the position, metres.
    pub position_low_m: [f32; 3],
    /// Temperature in °C at sea level, or at the reference sphere without a sea. Shaders subtract the lapse with
    /// height.
    pub temperature_c: f32,
    /// Moisture at the same level, before it is clamped to 0 (dry) to 1 (wet).
    pub moisture: f32,
    /// Unit normal in the planet frame, octahedral, snorm: [`normal_of_oct`] reads it. Terrain finer than twice the
    /// vertex spacing is faded out.
    pub normal_oct: [i16; 2],
    /// The normal of the parent tile at this point: blend to it with distance, so that no level change shows.
    pub parent_normal_oct: [i16; 2],
    /// Deviation: height above the chord that the vertex replaces ([`crate::lod::chords`]), along its vertical; 0 at
    /// level 0.
    pub deviation_m: f32,
    /// The deviation expected from the coarser level: see [`crate::lod::select`].
    pub foreseen_m: f32,
}

impl Vertex {
    /// The position in the planet frame.
    pub fn position_planet_m(&self) -> DVec3 {
        DVec3::from_array(self.position_high_m.map(f64::from)) + DVec3::from_array(self.position_low_m.map(f64::from))
    }
}

/// The unit normal that two snorm numbers stand for, as in [`Vertex::normal_oct`]: the octahedron |x| + |y| + |z| = 1,
/// seen along z, its lower half folded over the edges of the upper one (Cigolle et al. 2014, "A survey of efficient
/// representations for independent unit vectors"). Any two numbers have one.
pub fn normal_of_oct(oct: [i16; 2]) -> Vec3 {
    // The least number stands for -1, too.
    let [x, y] = oct.map(|w| (f32::from(w) / 32767.0).max(-1.0));
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize()
}

/// Quads along the side of a block.
pub const BLOCK_QUADS: usize = 8;
/// Blocks along a tile's side.
pub const BLOCKS_SIDE: usize = TILE_QUADS / BLOCK_QUADS;

/// A square part of a tile, with its own bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// Distance from its middle vertex to its farthest vertex.
    pub radius_m: f32,
    /// The greatest [`Vertex::foreseen_m`] of a vertex that a child would have in it.
    pub foreseen_m: f32,
}

/// The mesh of a node.
#[derive(Clone, Debug)]
pub struct Tile {
    /// The node.
    pub id: NodeId,
    /// Unique: the key under which a renderer keeps its copy.
    pub serial: u64,
    /// Unique for each set of heights: a tile with only a new climate keeps it.
    pub heights_serial: u64,
    /// [`TILE_SIDE`] rows of [`TILE_SIDE`] vertices: `u` (east on the face) runs fastest.
    pub vertices: Vec<Vertex>,
    /// Lowest height of a vertex.
    pub min_height_m: f64,
    /// Greatest height of a vertex.
    pub max_height_m: f64,
    /// Centre of the bounding sphere in the planet frame.
    pub center_planet_m: DVec3,
    /// Radius of the bounding sphere around all vertices, in every state of their morph.
    pub bounding_radius_m: f64,
    /// [`BLOCKS_SIDE`] rows of [`BLOCKS_SIDE`] blocks.
    pub blocks: [Block; BLOCKS_SIDE * BLOCKS_SIDE],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::spread;

    #[test]
    fn any_two_numbers_are_a_unit_normal_and_the_corners_are_the_axes() {
        for dir in spread(500) {
            let oct = [dir.x, dir.y].map(|w| (w * 40_000.0) as i16);
            assert!((normal_of_oct(oct).length() - 1.0).abs() < 1e-6);
        }
        const ONE: i16 = 32767;
        let corners = [([0, 0], Vec3::Z), ([ONE, 0], Vec3::X), ([0, -ONE], -Vec3::Y), ([ONE, ONE], -Vec3::Z)];
        for (oct, normal) in corners.into_iter().chain([([i16::MIN, 0], -Vec3::X)]) {
            assert!(normal_of_oct(oct).distance(normal) < 1e-6, "{oct:?}");
        }
    }
}
