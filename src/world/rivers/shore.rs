//! The surface of lakes as tiles draw it.
//!
//! The solver knows the lake of each cell. Shores follow the ground, which says nothing where it lies below the lake
//! though no cell of the lake is near, and nothing of the border between two lakes. There the drawn surface is smooth:
//! it sinks away from the cells of its lake until it meets the ground, and it slopes from one lake to the next.

use super::Rivers;
use super::blend::Jet;
use glam::DVec3;

/// Distance within which a cell counts, in cells: within the ring around the cell of the point.
const REACH: f64 = 1.45;
/// Share of lake cells around a point below which the surface sinks, and how far it sinks until there are none.
const FRINGE: f64 = 0.3;
const SINKS_M: f64 = 80.0;
/// A reach this far below a lake lies beyond its sill.
const BEYOND_M: f64 = 40.0;
/// Shares of lake cells around a point between which the solved bed takes over from the banks of reaches.
pub(super) const OFF_SHORE: [f64; 2] = [0.25, 0.6];
/// Share of lake cells around a point from which layers over the structure are lowest, and how far they stand then: in
/// shallow water they still make islands and bays.
const OFF_LAYERS: f64 = 0.5;
const ISLANDS: f64 = 0.4;
/// Depth of the solved bed from which rivers and the relief between them add nothing, metres.
pub(super) const SHALLOWS_M: f64 = 30.0;

/// The lakes around a point. Each cell of the ring counts by its distance, so that nothing jumps between cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lakeside {
    /// Share of the weights that lies in lakes, above 0 and at most 1.
    pub(super) share: Jet,
    /// Mean height of their surfaces.
    level_m: Jet,
}

impl Rivers {
    /// The lakes around a direction, in the ring of its cell.
    pub(super) fn lakeside(&self, dir: DVec3, cell: usize) -> Option<Lakeside> {
        let trunks = &self.trunks;
        if trunks.lake_near(cell) == 0 {
            return None;
        }
        let width_rad = trunks.grid.width_rad(dir);
        let per_reach2 = 1.0 / (REACH * REACH * width_rad * width_rad);
        // The width of a cell goes with the square of the greatest component of the direction.
        let greatest = dir.abs().max_element();
        let axis = DVec3::select(dir.abs().cmpeq(DVec3::splat(greatest)), dir.signum(), DVec3::ZERO);
        let shrinking = axis * (-4.0 / greatest);
        let (mut weights, mut wet, mut sum_m) = (Jet::default(), Jet::default(), Jet::default());
        for (near, middle) in trunks.ring(cell) {
            let away = dir - middle;
            let distance2 = away.dot(away) * per_reach2;
            if distance2 >= 1.0 {
                continue;
            }
            let within = 1.0 - distance2;
            let gradient = (away * (2.0 * per_reach2) + shrinking * distance2) * (-2.0 * within);
            let weight = Jet { value: within * within, gradient };
            weights = weights.plus(weight);
            if let Some(level_m) = trunks.level_of(trunks.drainage.lake[near]) {
                wet = wet.plus(weight);
                sum_m = sum_m.plus(weight.scaled(level_m));
            }
        }
        if wet.value <= 0.0 {
            return None;
        }
        let share = quotient(wet, weights);
        Some(Lakeside { share, level_m: quotient(sum_m, wet) })
    }

    /// Height of the surface of the lake near a point, if it is higher than the sea: on dry ground, too. `bank_m`:
    /// height of the banks of the nearest reach, if that has nothing to do with a lake.
    pub(super) fn shore_m(&self, lakeside: &Lakeside, bank_m: Option<f64>) -> Option<f64> {
        let level_m = lakeside.level_m.value;
        if bank_m.is_some_and(|bank_m| bank_m < level_m - BEYOND_M) {
            return None;
        }
        let lack = (1.0 - lakeside.share.value * (1.0 / FRINGE)).max(0.0);
        let surface_m = level_m - SINKS_M * lack * lack;
        Some(surface_m).filter(|surface_m| self.trunks.sea_level_m.is_none_or(|sea_m| *surface_m > sea_m))
    }
}

impl Lakeside {
    /// How far layers over the structure stand from the lakes: 1 where none is near, [`ISLANDS`] off their shores.
    #[inline(always)]
    pub(super) fn beside(&self) -> Jet {
        let share = self.share.scaled((ISLANDS - 1.0) / OFF_LAYERS).plus_number(1.0);
        if share.value > ISLANDS { share } else { Jet { value: ISLANDS, gradient: DVec3::ZERO } }
    }

    /// Off the shore the solved bed holds: no spit of land follows the last reach of each river.
    #[inline(always)]
    pub(super) fn drowned(&self, ground: Jet, solved: Jet) -> Jet {
        let [from, to] = OFF_SHORE;
        let t = ((self.share.value - from) * (1.0 / (to - from))).clamp(0.0, 1.0);
        let off = self.share.mapped(t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) * (1.0 / (to - from)));
        sunk(ground, solved, self.level_m.plus(solved.scaled(-1.0)).times(off))
    }
}

/// Ground that sinks to the solved ground where that lies below water.
#[inline(always)]
pub(super) fn sunk(ground: Jet, solved: Jet, depth_m: Jet) -> Jet {
    if depth_m.value <= 0.0 || ground.value <= solved.value {
        return ground;
    }
    let t = (depth_m.value * (1.0 / SHALLOWS_M)).min(1.0);
    let share = depth_m.mapped(1.0 - t * t * (3.0 - 2.0 * t), -6.0 * t * (1.0 - t) * (1.0 / SHALLOWS_M));
    solved.plus(ground.plus(solved.scaled(-1.0)).times(share))
}

fn quotient(a: Jet, b: Jet) -> Jet {
    let value = a.value / b.value;
    Jet { value, gradient: (a.gradient - b.gradient * value) * (1.0 / b.value) }
}
