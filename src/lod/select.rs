//! Which nodes must be split: those of whose children any vertex would be visible ([`super::range`]).
//!
//! The deviations of the children are estimated from those of the node's own vertices: they halve from level to level
//! on ground of constant slope, and fall to a quarter on smooth ground. A vertex appears at the distance given by this
//! estimate, so a node that is not split lacks no visible vertex, whatever its children are like.

use super::chords::chords;
use super::range::Ranges;
use super::{Culling, View};
use crate::lod::tile::{BLOCK_QUADS, BLOCKS_SIDE, Block, TILE_SIDE, Tile};
use crate::sphere::NodeId;
use glam::DVec3;
use std::collections::HashSet;

/// Factor on the opening of the frustum: nodes a little outside the picture are refined, so that turning the camera
/// shows no coarse ground.
const FRUSTUM_MARGIN: f64 = 1.15;
/// Factor on ranges: nodes a little farther away are refined, because the camera moves while tiles are built.
const DISTANCE_MARGIN: f64 = 1.03;
/// A node that is split stays split until its errors are this many times smaller than those that split it.
const HYSTERESIS: f64 = 1.4;

/// Decides for one view which nodes must be split.
pub struct Selection<'a> {
    culling: Culling,
    eye_planet_m: DVec3,
    ranges: Ranges,
    /// Nodes that are split in the LOD cut on screen.
    shown: Option<&'a HashSet<NodeId>>,
}

impl<'a> Selection<'a> {
    /// `lowest_radius_m`: distance from the centre of the lowest ground or sea. `shown`: the split nodes on screen.
    pub fn new(view: &View, ranges: &Ranges, lowest_radius_m: f64, shown: Option<&'a HashSet<NodeId>>) -> Self {
        let culling = Culling::widened(view, lowest_radius_m, FRUSTUM_MARGIN);
        Self { culling, eye_planet_m: view.camera.position_planet_m, ranges: *ranges, shown }
    }

    /// Whether the tile is too coarse for the view.
    pub fn wants_split(&self, tile: &Tile) -> bool {
        if tile.id.level >= NodeId::MAX_LEVEL {
            return false;
        }
        let factor = if self.shown.is_some_and(|shown| shown.contains(&tile.id)) { HYSTERESIS } else { 1.0 };
        let level = tile.id.level + 1;
        let reach_m = |foreseen_m: f32| self.ranges.begin_m(level, f64::from(foreseen_m) * factor) * DISTANCE_MARGIN;
        self.is_within(tile, &reach_m) && self.culling.sees(tile)
    }

    /// Whether shading needs the tile's own detail texture: that of an ancestor is too coarse.
    ///
    /// Each tile is asked by itself. A texture shows its own level and its parent's, and so reaches to twice the range
    /// of its level: as far as a tile reaches that begins within the range, but not as far as its parent.
    pub fn wants_detail(&self, tile: &Tile) -> bool {
        self.is_within(tile, &|_| self.ranges.shaded_m(tile.id.level))
    }

    /// Whether the picture shows any part of the tile.
    pub fn sees(&self, tile: &Tile) -> bool {
        self.culling.sees(tile)
    }

    /// Whether any vertex of the tile or of its children may be nearer than a distance that depends on the expected
    /// deviation in its block.
    fn is_within(&self, tile: &Tile, reach_m: &dyn Fn(f32) -> f64) -> bool {
        let most_m = tile.blocks.iter().map(|block| block.foreseen_m).fold(0.0, f32::max);
        if self.eye_planet_m.distance(tile.center_planet_m) - tile.bounding_radius_m >= reach_m(most_m) {
            return false;
        }
        let away_m = |i: usize| tile.vertices[i].position_planet_m().distance(self.eye_planet_m);
        let beside_m = 0.7 * self.ranges.spacing_m(tile.id.level);
        tile.blocks.iter().enumerate().any(|(i, block)| {
            let first = i / BLOCKS_SIDE * BLOCK_QUADS * TILE_SIDE + i % BLOCKS_SIDE * BLOCK_QUADS;
            let (reach_m, radius_m) = (reach_m(block.foreseen_m), f64::from(block.radius_m));
            let middle_m = away_m(first + BLOCK_QUADS / 2 * (TILE_SIDE + 1));
            let mut rows = (0..=BLOCK_QUADS).map(|y| first + y * TILE_SIDE);
            middle_m < reach_m
                || (middle_m - radius_m < reach_m
                    && rows.any(|row| (row..=row + BLOCK_QUADS).any(|i| away_m(i) - beside_m < reach_m)))
        })
    }
}

/// Sets the expected deviations of the children of a tile in each block. `level` is the tile's.
pub(crate) fn foresee(level: u8, deviations_m: &[f32], blocks: &mut [Block]) {
    for block in blocks.iter_mut() {
        // The deviations of level 0 are unknown: it has no parent.
        block.foreseen_m = if level == 0 { UNKNOWN_M } else { 0.0 };
    }
    // The deviation halves with each level: the share that a child's vertex has of the two ends of its chord.
    for chord in chords(false).iter().filter(|chord| chord.stride <= 2 && u16::from(level) >= chord.stride) {
        let share = if chord.stride == 1 { 0.5 } else { 0.25 };
        let foreseen_m = deviations_m[usize::from(chord.vertex)].abs() * share;
        let (x, y) = (usize::from(chord.vertex) % TILE_SIDE, usize::from(chord.vertex) / TILE_SIDE);
        // A vertex between blocks belongs to all of them.
        let of = |w: usize| [w.saturating_sub(1) / BLOCK_QUADS, (w / BLOCK_QUADS).min(BLOCKS_SIDE - 1)];
        for (bx, by) in of(y).into_iter().flat_map(|by| of(x).map(|bx| (bx, by))) {
            let block = &mut blocks[by * BLOCKS_SIDE + bx];
            block.foreseen_m = block.foreseen_m.max(foreseen_m);
        }
    }
}

/// An unknown deviation in metres: greater than any planet.
pub(crate) const UNKNOWN_M: f32 = 1e12;
