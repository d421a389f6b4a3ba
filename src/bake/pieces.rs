//! Projections in many pictures: the tiles of a landscape, and those of a quadtree.

use super::projection::Region;
use super::{MAX_SIZE, Projection};
use crate::planet::Planet;
use crate::sphere::{Face, NodeId, Tangent};
use glam::DVec3;

/// Most tiles of a quadtree or a landscape.
const MAX_TILES: u64 = 1 << 18;

/// A square region in tiles for a terrain engine, as Unreal imports tiled landscapes. Pixels are vertices: neighbours
/// share those of their border, and the outermost lie on the border of the region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landscape {
    /// The region, from its first vertex to its last.
    pub region: Region,
    /// Tiles along each side.
    pub tiles: u32,
}

/// The whole globe as the tiles of a quadtree on each face of the cube sphere, from one tile a face to the finest
/// level: those of [`NodeId`]. A picture has the pixels of its tile and an apron of more around it, so that a filter
/// gives the same result on both sides of a border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quadtree {
    /// The finest level: its tiles are 2^`levels` along a side of a face.
    pub levels: u8,
    /// Pixels around a tile on each side.
    pub apron: u32,
}

impl Landscape {
    /// Tile width in pixels that Unreal recommends, unless another one is asked for; 2017 is the next.
    pub const SIZE: u32 = 1009;

    /// Cells along a side of the whole landscape, for tiles of `size` vertices.
    fn cells(self, size: u32) -> u64 {
        u64::from(self.tiles) * u64::from(size.saturating_sub(1)).max(1)
    }

    /// Distance between vertices.
    pub(super) fn pixel_m(self, size: u32) -> f64 {
        self.region.side_km * 1000.0 / self.cells(size) as f64
    }

    /// Column and row of a picture, from the upper left.
    pub(super) fn place(self, picture: usize) -> [u32; 2] {
        let picture = picture as u32;
        [picture % self.tiles.max(1), picture / self.tiles.max(1)]
    }

    pub(super) fn pictures(self) -> usize {
        self.tiles as usize * self.tiles as usize
    }

    /// The left and the upper edge of the first pixel of a picture, metres along east and north of the centre: half a
    /// pixel beside the vertex.
    pub(super) fn corner_m(self, picture: usize, size: u32) -> [f64; 2] {
        let (half, pixel_m) = (self.cells(size) as f64 / 2.0, self.pixel_m(size));
        let [column, row] = self.place(picture).map(|tile| f64::from(tile) * f64::from(size - 1));
        [(column - half - 0.5) * pixel_m, (half - row + 0.5) * pixel_m]
    }

    pub(super) fn direction(
        self,
        tangent: &Tangent,
        pixel_rad: f64,
        size: u32,
        picture: usize,
        x: u32,
        y: u32,
    ) -> DVec3 {
        let half = self.cells(size) as f64 / 2.0;
        // Whole numbers, so that the shared vertices of neighbours are the same to the bit.
        let [column, row] = self.place(picture).map(|tile| u64::from(tile) * u64::from(size - 1));
        let (right, down) = ((column + u64::from(x)) as f64 - half, (row + u64::from(y)) as f64 - half);
        tangent.direction(right * pixel_rad, -down * pixel_rad)
    }

    /// What is wrong with it.
    pub(super) fn check(self, planet: &Planet, size: u32) -> Result<(), String> {
        self.region.check(planet)?;
        let most = u64::from(MAX_SIZE) / u64::from(size.saturating_sub(1)).max(1);
        if u64::from(self.tiles) > most || self.tiles == 0 {
            return Err(format!(
                "{} tiles of {size} pixels along a side are out of range; use 1 to {most}, which is {MAX_SIZE} pixels",
                self.tiles
            ));
        }
        Ok(())
    }
}

impl Quadtree {
    /// Tile width in pixels, unless another one is asked for.
    pub const SIZE: u32 = 256;
    /// The finest level that there can be, where the number of tiles allows it.
    pub const MOST_LEVELS: u8 = 20;

    /// Width of a picture for tiles of `size` pixels.
    pub(super) fn picture(self, size: u32) -> u32 {
        size.saturating_add(2 * self.apron)
    }

    /// Tiles of all levels.
    pub fn tiles(self) -> u64 {
        6 * ((1 << (2 * (u32::from(self.levels.min(20)) + 1))) - 1) / 3
    }

    /// The tile of a picture: level by level, face by face, row by row.
    pub(super) fn node(self, picture: usize) -> NodeId {
        let (mut level, mut left) = (0_u8, picture as u64);
        while left >= 6 << (2 * u32::from(level)) {
            left -= 6 << (2 * u32::from(level));
            level += 1;
        }
        let side = 1_u64 << level;
        let face = Face::ALL[(left / (side * side)) as usize % Face::ALL.len()];
        NodeId { level, face, x: (left % side) as u32, y: (left / side % side) as u32 }
    }

    /// The angle between pixels of a level, where they are farthest apart.
    pub(super) fn pixel_rad(level: u8, size: u32) -> f64 {
        2.0 / f64::from(size) / (f64::from(level)).exp2()
    }

    pub(super) fn direction(self, size: u32, picture: usize, x: u32, y: u32) -> DVec3 {
        let share = |pixel: u32| (f64::from(pixel) + 0.5 - f64::from(self.apron)) / f64::from(size);
        self.node(picture).direction(share(x), 1.0 - share(y))
    }

    /// The file of a picture under the folder of its map, without an ending: `LEVEL/FACE_X_Y`, `y` upwards.
    pub(super) fn name(self, picture: usize) -> String {
        let NodeId { level, face, x, y } = self.node(picture);
        format!("{level}/{}_{x}_{y}", face.name())
    }

    /// What is wrong with it.
    pub(super) fn check(self, size: u32) -> Result<(), String> {
        if self.tiles() > MAX_TILES {
            let most = (0..Self::MOST_LEVELS)
                .take_while(|levels| Self { levels: *levels, ..self }.tiles() <= MAX_TILES)
                .count()
                - 1;
            return Err(format!("{} levels are out of range; use 0 to {most}", self.levels));
        }
        if self.apron > size / 8 {
            return Err(format!("an apron of {} pixels is out of range; use 0 to {}", self.apron, size / 8));
        }
        Ok(())
    }
}

impl Projection {
    /// The same part of the globe in few pictures, for a person to look at.
    pub(super) fn whole(&self) -> Projection {
        match self {
            Projection::Landscape(landscape) => Projection::Region(landscape.region),
            Projection::Quadtree(_) => Projection::Cube,
            other => *other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::LatLon;
    use std::collections::HashSet;

    #[test]
    fn tiles_of_a_landscape_share_their_border_vertices() {
        let region = Region { lat_deg: 12.0, lon_deg: 34.0, side_km: 48.0 };
        let landscape = Landscape { region, tiles: 3 };
        let size = 17;
        let tangent = Tangent::at(LatLon::from_degrees(12.0, 34.0));
        let pixel_rad = landscape.pixel_m(size) / 1e6;
        let at = |picture, x, y| landscape.direction(&tangent, pixel_rad, size, picture, x, y);
        for i in 0..size {
            assert_eq!(at(0, 16, i), at(1, 0, i));
            assert_eq!(at(1, i, 16), at(4, i, 0));
        }
        assert_eq!(at(4, 8, 8), tangent.direction(0.0, 0.0));
        // A side from the first vertex to the last.
        assert_eq!(landscape.pixel_m(size), 1000.0);
        assert_eq!(landscape.corner_m(0, size), [-24_500.0, 24_500.0]);
        assert_eq!(landscape.corner_m(5, size), [7_500.0, 8_500.0]);
        assert_eq!(at(0, 0, 0), tangent.direction(-0.024, 0.024));
    }

    #[test]
    fn pictures_of_a_quadtree_are_its_tiles_and_aprons_lie_in_their_neighbours() {
        let tree = Quadtree { levels: 3, apron: 2 };
        assert_eq!((tree.tiles(), tree.picture(16)), (510, 20));
        let nodes: HashSet<NodeId> = (0..510).map(|picture| tree.node(picture)).collect();
        assert_eq!(nodes.len(), 510);
        assert!(nodes.iter().all(|node| node.level <= 3 && node.x < 1 << node.level && node.y < 1 << node.level));
        // The first pixel of a tile is in it, that to its left is in the neighbour and the same as there.
        let picture = (0..510).find(|picture| tree.name(*picture) == "3/pos_x_3_4").unwrap();
        let left = (0..510).find(|picture| tree.name(*picture) == "3/pos_x_2_4").unwrap();
        let (own, apron) = (tree.direction(16, picture, 2, 9), tree.direction(16, picture, 1, 9));
        assert_eq!(NodeId::containing(own, 3), tree.node(picture));
        assert_eq!(NodeId::containing(apron, 3), tree.node(left));
        assert!((apron - tree.direction(16, left, 17, 9)).length() < 1e-12);
        // The upper rows are those where y grows.
        assert!(NodeId::containing(tree.direction(16, picture, 9, 1), 3).y == 5);
    }
}
