//! A tile: the finished mesh of one node, ready for any renderer.

use crate::sphere::{Face, NodeId};
use glam::DVec3;

/// Quads along a tile's side.
pub const TILE_QUADS: usize = 32;
/// Vertices along a tile's side.
pub const TILE_SIDE: usize = TILE_QUADS + 1;
/// Vertices of a tile.
pub const TILE_VERTICES: usize = TILE_SIDE * TILE_SIDE;

/// Texels along a detail tile's side, one on each vertex and three between: borders are shared with the neighbours.
pub const DETAIL_SIDE: usize = 4 * TILE_QUADS + 1;
/// Texels beyond the node on each side: what is averaged over texels around a point is the same from either side of a border.
pub const DETAIL_APRON: usize = 2;
/// Texels along the side of a detail tile's images.
pub const DETAIL_IMAGE: usize = DETAIL_SIDE + 2 * DETAIL_APRON;

/// The ground of a node four times as fine as its mesh: the relief that a tile's vertices are too coarse to show, for shading.
///
/// Values lie on [`DETAIL_IMAGE`] rows of [`DETAIL_IMAGE`] texels, with linear interpolation between; but for [`DETAIL_APRON`] around,
/// the first and the last lie on the node's edges. Heights are the evaluator's, as on vertices: what is made of them (climate, shores, biomes) covers the same
/// share of the ground at every level. From slopes, what is finer than twice the texel spacing is faded out.
#[derive(Debug)]
pub struct DetailTile {
    /// The node.
    pub id: NodeId,
    /// Different for any two ever built.
    pub serial: u64,
    /// [`Tile::heights_serial`] of the tile whose ground it shows.
    pub heights_serial: u64,
    /// Rise over run along two tangents of the sphere, as [`slope_basis`] has them at each point (the normal is along
    /// `up - x * east - y * north`); and the same as the parent's detail shows it.
    pub slopes: Vec<[half::f16; 4]>,
    /// The height that [`DetailTile::heights`] count from, metres.
    pub base_m: f32,
    /// Height in metres as the sum of the first two. The others are how steep (rise over run) the ground is at that very point as
    /// far as [`DetailTile::slopes`] show it, and with what is faded out of them.
    pub heights: Vec<[half::f16; 4]>,
}

impl DetailTile {
    /// Resident size.
    pub fn bytes(&self) -> usize {
        self.slopes.len() * size_of::<[half::f16; 4]>() + self.heights.len() * size_of::<[half::f16; 4]>()
    }
}

/// Two tangents of the sphere at a direction on a face, perpendicular to each other: one as nearly along the face's
/// first axis as it can be, and the one to its left, seen from outside.
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
    /// Temperature in °C at the level that climate counts from: the sea's, or the reference sphere's. What height adds is
    /// for whoever knows the height of a place between vertices.
    pub temperature_c: f32,
    /// Moisture at the same level, before it is cut to 0 (dry) to 1 (wet).
    pub moisture: f32,
    /// Unit normal in the planet frame, octahedral, snorm; relief finer than twice the vertex
    /// spacing is faded out of it.
    pub normal_oct: [i16; 2],
    /// The same as the parent tile would have it here: blend to it with distance, so that no level change shows.
    pub parent_normal_oct: [i16; 2],
    /// How far it stands above the chord that is drawn in its place before it appears ([`crate::lod::chords`]), along its
    /// vertical; 0 for a vertex of level 0.
    pub deviation_m: f32,
    /// How large that was to be expected from the level before: see [`crate::lod::select`].
    pub foreseen_m: f32,
}

impl Vertex {
    /// The position in the planet frame.
    pub fn position_planet_m(&self) -> DVec3 {
        DVec3::from_array(self.position_high_m.map(f64::from)) + DVec3::from_array(self.position_low_m.map(f64::from))
    }
}

/// Quads along a side of one of the blocks that a tile's bounds are known for.
pub const BLOCK_QUADS: usize = 8;
/// Blocks along a tile's side.
pub const BLOCKS_SIDE: usize = TILE_QUADS / BLOCK_QUADS;

/// A square part of a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// Distance of the farthest vertex from the one in the middle.
    pub radius_m: f32,
    /// The greatest [`Vertex::foreseen_m`] that a child's vertex in it would have.
    pub foreseen_m: f32,
}

/// The finished mesh of a node.
#[derive(Clone, Debug)]
pub struct Tile {
    /// The node.
    pub id: NodeId,
    /// Different for any two tiles ever built: the key under which a renderer keeps its copy.
    pub serial: u64,
    /// Different for any two sets of heights: a tile rebuilt for another climate keeps it.
    pub heights_serial: u64,
    /// [`TILE_SIDE`] rows of [`TILE_SIDE`] vertices: `u` (east on the face) runs fastest.
    pub vertices: Vec<Vertex>,
    /// Lowest height of a vertex.
    pub min_height_m: f64,
    /// Greatest height of a vertex.
    pub max_height_m: f64,
    /// Centre of the bounding sphere in the planet frame.
    pub center_planet_m: DVec3,
    /// Radius of the bounding sphere, around all vertices whether they have come out or not.
    pub bounding_radius_m: f64,
    /// [`BLOCKS_SIDE`] rows of as many.
    pub blocks: [Block; BLOCKS_SIDE * BLOCKS_SIDE],
}
