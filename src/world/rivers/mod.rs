//! Rivers at a point: a solved drainage map of the globe, refined to any scale.
//!
//! - `trunk`: the solved drainage, prepared: one reach for each land cell, from its node to the receiver's node
//! - `grid`: cells of a level of refinement, their neighbours and nodes; each level is four times as fine
//! - `net`: nodes of finer levels and where they drain; `coarser`: the reaches around that they must not cross;
//!   `window`: the cells around a block
//! - `tributaries`: the reaches between them, which drain into those before
//! - `reach`: the curve, bed and channel of a reach, cut into straight pieces; `winding`: their bends on finer levels
//! - `block`: pieces near a square of cells, listed by bucket; `cache`: blocks that were built, and the
//!   spots of points that stand alone
//! - `blend`: the ground of one level at points, laid over the level before
//! - `packet`: points that are worked on together
//! - `channel`: the beds of rivers at a point, and how far layers over the structure stand from them
//! - `courses`: rivers from source to mouth
//! - `evaluate`: ground, water and river at points; `bounds`: bounds of the ground near a direction
//! - `bank`: distances from the banks of rivers
//! - `flow`: shares of rivers in the footprints of points, to be drawn; `shore`: the drawn surface of lakes
//!
//! The solved ground is a smooth raster. Each level of reaches is laid over it: on a reach the ground is the reach's
//! bed, which never rises downstream; away from reaches it returns to the level before, raised by the relief between
//! reaches. So the solver's heights hold at large scale, rivers are exact at every scale, and a coarse river stays
//! where it is when finer levels join. Channels are cut last, from discharge.
//!
//! Answers are pure functions of the drainage, the direction and the number of levels: f64 with correctly rounded
//! operations and `libm`, sums in the order of levels, cells and pieces.

mod bank;
mod blend;
mod block;
mod bounds;
mod cache;
mod channel;
mod coarser;
mod courses;
mod evaluate;
mod flow;
mod grid;
mod net;
mod packet;
mod reach;
mod shore;
#[cfg(test)]
mod tests;
mod tributaries;
mod trunk;
mod winding;
mod window;

use super::drainage::Drainage;
use crate::sphere::raster::Raster;
pub(crate) use blend::Jet;
use bounds::Bounds;
use cache::Blocks;
pub(crate) use cache::{Cache, LEVELS, keep_bytes};
pub(crate) use courses::CourseEnd;
pub(crate) use flow::Flow;
use glam::DVec3;
use grid::Grid;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use trunk::Trunks;

/// The rivers of a planet.
pub(crate) struct Rivers {
    trunks: Trunks,
    /// Ground and relief of the cells.
    rasters: [Raster<f32>; 2],
    grids: [Grid; LEVELS],
    /// The greatest relief of each level.
    steepest_m: [f64; LEVELS],
    bounds: Bounds,
    blocks: Blocks,
    number: u64,
}

/// The answer at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RiverPoint {
    /// Height of the ground, the beds of rivers, lakes and the sea included.
    pub(crate) height_m: f64,
    /// Tangential gradients of the height by the direction: of the ground of no level, of the first level, of the first
    /// two, and so on. The one of all levels that were asked for has channels in it; later ones are 0.
    pub(crate) gradients: [DVec3; LEVELS + 1],
    /// Height of the surface of the river above the ground if the point is in its water; else 0.
    pub(crate) rise_m: f64,
    /// The lake near the point, counted from 1; 0 for none.
    pub(crate) lake: u32,
    /// Height of its surface, if that is higher than the sea: on dry ground, too.
    pub(crate) lake_level_m: Option<f64>,
    /// The part of layers over the structure that stands here: 0 in the water of rivers, little in lakes, 1 far from
    /// all. Beside the rivers of no level, of the first, of the first two, and so on; levels that were not asked for
    /// have none. Gradients are tangential.
    pub(crate) layers: [Jet; LEVELS + 1],
    /// From -1 in valleys to 1 on ridges.
    pub(crate) ridge: f64,
    /// The nearest reach, if one is near.
    pub(crate) river: Option<River>,
}

/// A river or a dry valley near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct River {
    /// The same from spring to mouth for a river of the solved drainage, and for each reach of a tributary.
    pub(crate) id: u64,
    /// Distance to the centre line.
    pub(crate) distance_m: f64,
    /// Width of the water; 0 in a dry valley, as are depth and discharge.
    pub(crate) width_m: f64,
    /// Depth of the water in the middle.
    pub(crate) depth_m: f64,
    pub(crate) discharge_m3_s: f64,
    /// Direction of flow, a unit tangent.
    pub(crate) flow: DVec3,
}

impl Rivers {
    /// Prepares a solved drainage. Reaches of finer levels are made where points ask for them.
    pub(crate) fn new(drainage: Arc<Drainage>, sea_level_m: Option<f64>, radius_km: f64) -> Self {
        static NUMBER: AtomicU64 = AtomicU64::new(1);
        let grids = std::array::from_fn(|level| Grid::new(drainage.side, level, drainage.seed));
        let trunks = Trunks::new(drainage, sea_level_m, radius_km);
        let ground_m = trunks.ground_m();
        let bounds = Bounds::new(&trunks, &ground_m);
        Self {
            rasters: trunks.rasters(ground_m),
            steepest_m: grids.map(|grid| evaluate::steepest_m(&grid, trunks.radius_m)),
            grids,
            bounds,
            blocks: Blocks::default(),
            trunks,
            number: NUMBER.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// Tells these rivers from all others of the process.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Bytes of the blocks and spots that are kept.
    pub(crate) fn kept_bytes(&self) -> usize {
        self.blocks.bytes()
    }

    /// How many blocks are kept.
    #[cfg(all(test, feature = "editor"))]
    pub(crate) fn blocks(&self) -> usize {
        self.blocks.count()
    }

    /// Lowest and greatest height of the ground within an angle of a unit direction. Conservative, at every level.
    pub(crate) fn bounds_near(&self, dir: DVec3, angle_rad: f64) -> (f64, f64) {
        self.bounds.near(dir, angle_rad)
    }
}
