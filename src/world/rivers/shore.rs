//! The surface of lakes as tiles draw it.
//!
//! The solver knows the lake of each cell. Shores follow the ground, which says nothing where it lies below the lake
//! though no cell of the lake is near, and nothing of the border between two lakes. There the drawn surface is smooth:
//! it sinks away from the cells of its lake until it meets the ground, and it slopes from one lake to the next.

use super::Rivers;
use glam::DVec3;

/// Distance within which a cell counts, in cells: within the ring around the cell of the point.
const REACH: f64 = 1.45;
/// Share of lake cells around a point below which the surface sinks, and how far it sinks until there are none.
const FRINGE: f64 = 0.3;
const SINKS_M: f64 = 80.0;
/// A reach this far below a lake lies beyond its sill.
const BEYOND_M: f64 = 40.0;

impl Rivers {
    /// Height of the surface of the lake near a direction, if it is higher than the sea: on dry ground, too. `cell`:
    /// the cell of the direction. `bank_m`: height of the banks of the nearest reach, if that has nothing to do with a
    /// lake.
    pub(super) fn shore_m(&self, dir: DVec3, cell: usize, bank_m: Option<f64>) -> Option<f64> {
        let trunks = &self.trunks;
        if trunks.lake_near(cell) == 0 {
            return None;
        }
        let reach_rad = REACH * trunks.grid.width_rad(dir);
        let (mut weights, mut wet, mut sum_m) = (0.0, 0.0, 0.0);
        for (near, middle) in trunks.ring(cell) {
            let weight = (1.0 - middle.distance_squared(dir) / (reach_rad * reach_rad)).max(0.0);
            let weight = weight * weight;
            weights += weight;
            if let Some(level_m) = trunks.level_of(trunks.drainage.lake[near]) {
                wet += weight;
                sum_m += weight * level_m;
            }
        }
        if wet <= 0.0 {
            return None;
        }
        let level_m = sum_m / wet;
        if bank_m.is_some_and(|bank_m| bank_m < level_m - BEYOND_M) {
            return None;
        }
        let lack = (1.0 - wet / weights * (1.0 / FRINGE)).max(0.0);
        Some(level_m - SINKS_M * lack * lack).filter(|level_m| trunks.sea_level_m.is_none_or(|sea_m| *level_m > sea_m))
    }
}
