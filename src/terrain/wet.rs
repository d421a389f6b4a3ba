//! Rivers and lakes as tiles draw them: the surface of the water where it stands above the ground, and its share of
//! the ground around each point.
//!
//! Layers over the structure end at the banks of its rivers, so that a river keeps the bed and the level of the
//! structure. Ground edits do not: there a river keeps its depth and follows the ground. A lake keeps its level and
//! shows where the ground is below it. The sea is none of this; it is drawn apart.

use crate::world::rivers::{Flow, RiverPoint};

/// Widths of a river, in spacings, from which a grid begins to show its banks, and from which it shows them fully.
const WIDE: [f64; 2] = [1.5, 3.0];
/// Mean depth of a river by the depth in its middle.
const MEAN_DEPTH: f64 = 0.6;
/// Least change of the ground from one point to the next that counts at a shore, metres.
const LEAST_SPREAD_M: f64 = 0.02;

/// Points beside a lake that know of its shore.
const SHORE: f64 = 2.0;

/// Water near a point of a grid, as the structure of a planet knows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Water {
    /// Height of the surface of the lake near the point, metres; minus infinity without one.
    lake_m: f32,
    /// Share of the point's footprint in a river.
    river: f32,
    /// Depth of that river, metres: its mean where it is narrow, else the depth at the point.
    river_depth_m: f32,
    /// Height of its surface above the carved ground if the point is in it, metres; else 0.
    river_rise_m: f32,
    /// 0 for a river as wide as the points are apart, 1 for a wide one.
    river_wide: f32,
}

/// Water at a point whose ground is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Wet {
    /// Height of the drawn surface above the ground, metres; never below 0.
    pub(crate) rise_m: f64,
    /// Share of the ground around the point that is under water, 0 to 1.
    pub(crate) share: f64,
    /// Depth of the water, metres; negative on the dry ground beside a lake, so that it is 0 at the shore.
    pub(crate) depth_m: f64,
    /// 0 where the water is narrower than the points are apart, 1 where it has a shore.
    pub(crate) wide: f64,
    /// The part of the ground's slope that the surface shows: 0 on water.
    pub(crate) slope: f64,
}

impl Water {
    /// The water of a point and of its footprint.
    pub(crate) fn new(point: &RiverPoint, flow: &Flow) -> Self {
        let rise_m = point.rise_m;
        let wide = ((flow.width - WIDE[0]) / (WIDE[1] - WIDE[0])).clamp(0.0, 1.0);
        let mean_m = MEAN_DEPTH * flow.depth_m;
        Self {
            lake_m: point.lake_level_m.map_or(f32::NEG_INFINITY, |level_m| level_m as f32),
            river: flow.share as f32,
            river_depth_m: (mean_m + (rise_m - mean_m) * wide) as f32,
            river_rise_m: rise_m as f32,
            river_wide: wide as f32,
        }
    }

    /// The water where a curve bends all heights. `height_m`: the ground of the structure.
    pub(crate) fn bent(&self, height_m: f64, curve: impl Fn(f64) -> f64) -> Self {
        let rise_m = f64::from(self.river_rise_m);
        Self {
            lake_m: if self.lake_m.is_finite() { curve(f64::from(self.lake_m)) as f32 } else { self.lake_m },
            river_rise_m: if rise_m > 0.0 { (curve(height_m + rise_m) - curve(height_m)) as f32 } else { 0.0 },
            ..*self
        }
    }

    /// The water over the ground as all layers leave it. `spread_m`: how far the slope takes the ground from one point
    /// to the next. Where its surface would lie under the sea there is none.
    pub(crate) fn over(&self, ground_m: f64, spread_m: f64, sea_m: Option<f64>) -> Wet {
        let over_m = f64::from(self.lake_m) - ground_m;
        let lake = (0.5 + over_m / spread_m.max(LEAST_SPREAD_M)).clamp(0.0, 1.0);
        let river_rise_m = f64::from(self.river_rise_m);
        // The bed of a great river may lie below the sea. Where its surface does, the water is the sea's.
        let is_inland = sea_m.is_none_or(|sea_m| ground_m + river_rise_m > sea_m);
        let river = if is_inland { f64::from(self.river) } else { 0.0 };
        if lake >= river {
            // Beyond a shore the next points know of it, too.
            let is_near = over_m > -SHORE * spread_m.max(LEAST_SPREAD_M);
            return Wet {
                rise_m: over_m.max(0.0).max(if is_inland { river_rise_m } else { 0.0 }),
                share: lake,
                depth_m: if is_near { over_m } else { 0.0 },
                wide: if is_near { 1.0 } else { f64::from(self.river_wide) },
                slope: 1.0 - lake,
            };
        }
        Wet {
            rise_m: over_m.max(river_rise_m).max(0.0),
            share: river,
            depth_m: f64::from(self.river_depth_m),
            wide: f64::from(self.river_wide),
            slope: if river_rise_m > 0.0 { 0.0 } else { 1.0 - river },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: Water =
        Water { lake_m: f32::NEG_INFINITY, river: 0.0, river_depth_m: 0.0, river_rise_m: 0.0, river_wide: 0.0 };

    #[test]
    fn the_surface_never_lies_below_the_ground() {
        assert_eq!(DRY.over(-30.0, 1.0, None), Wet { slope: 1.0, ..Wet::default() });
        let lake = Water { lake_m: 100.0, ..DRY };
        let river = Water { river: 0.4, river_depth_m: 5.0, river_rise_m: 3.0, ..lake };
        for ground_m in [-20.0, 0.0, 99.0, 99.9, 100.0, 100.1, 300.0] {
            for water in [lake, river] {
                let wet = water.over(ground_m, 2.0, Some(0.0));
                assert!(wet.rise_m >= 0.0 && (wet.depth_m >= 0.0 || wet.share < 0.5), "{wet:?}");
                assert!((0.0..=1.0).contains(&wet.share) && (0.0..=1.0).contains(&wet.slope), "{wet:?}");
            }
        }
        // A lake is level; a river follows the ground, but not into the sea.
        assert_eq!(lake.over(40.0, 2.0, None).rise_m, 60.0);
        assert_eq!(lake.over(100.0, 2.0, None).share, 0.5);
        assert_eq!(river.over(300.0, 2.0, Some(0.0)).share, f64::from(0.4_f32));
        let river = Water { lake_m: f32::NEG_INFINITY, ..river };
        assert_eq!(river.over(-20.0, 2.0, Some(0.0)).share, 0.0);
        assert_eq!(river.over(-2.0, 2.0, Some(0.0)).share, f64::from(0.4_f32), "its surface is a metre over the sea");
    }
}
