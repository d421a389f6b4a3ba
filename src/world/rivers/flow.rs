//! Rivers as a grid of points draws them: the share of water in the footprint of each point.
//!
//! A footprint is a tent, from full weight at the point to none one spacing away. So the footprints of a grid overlap:
//! a river narrower than the spacing is a continuous line, and its shares sum to its width.

use super::Rivers;
use super::cache::Cache;
use super::grid::FacePlace;
use super::reach::{Channel, FREEBOARD, Line};
use glam::DVec3;

/// How far beyond its banks the width of a river is known, in spacings.
const BESIDE: f64 = 2.5;

/// The river in the footprint of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// Share of the footprint that is water, 0 to 1.
    pub(crate) share: f64,
    /// Depth of the water in the middle of the river.
    pub(crate) depth_m: f64,
    /// Width of the water, in spacings: known on the dry points next to the footprint, too.
    pub(crate) width: f64,
}

impl Rivers {
    /// Finds the rivers in the footprints of points `spacing_rad` apart (above 0), near each other and in order: one
    /// answer for each direction. Of several rivers the one with the greatest share counts.
    pub(crate) fn flows(
        &self,
        dirs: &[DVec3],
        levels: usize,
        spacing_rad: f64,
        cache: &mut Cache,
        out: &mut Vec<Flow>,
    ) {
        cache.belongs_to(self.number);
        cache.is_spread = self.is_spread(dirs, levels);
        out.clear();
        out.extend(dirs.iter().map(|&dir| self.flow(dir, levels, spacing_rad, cache)));
    }

    fn flow(&self, dir: DVec3, levels: usize, spacing_rad: f64, cache: &mut Cache) -> Flow {
        let place = FacePlace::new(dir);
        self.find_blocks(&place, levels, true, cache);
        let mut flow = Flow::default();
        for (level, block) in cache.current[..levels].iter().enumerate() {
            let Some((_, block)) = block else { continue };
            let is_last = level + 1 == levels;
            for &number in block.near(&place) {
                let line = &block.lines[usize::from(number)];
                if !line.is_cut(is_last) {
                    continue;
                }
                flow.join(dir, line, &block.stream(number).channel, spacing_rad);
            }
        }
        flow
    }
}

impl Flow {
    /// Takes in the river of a piece.
    #[inline(always)]
    fn join(&mut self, dir: DVec3, line: &Line, channel: &Channel, spacing_rad: f64) {
        let v = dir - line.start;
        let share = (v.dot(line.along) * line.per_length2).clamp(0.0, 1.0);
        let straight = v - line.along * share;
        // The part along the ground alone: the piece lies a little below it.
        let offset = straight - dir * straight.dot(dir);
        let distance2 = offset.dot(offset);
        // Beyond half the width and the points next to the footprint: (a + b)² is at most 2 (a² + b²).
        let far_rad = BESIDE * spacing_rad;
        if distance2 >= 2.0 * (line.channel2 + far_rad * far_rad) {
            return;
        }
        let (distance_rad, half_rad) = (distance2.sqrt(), channel.half_width_rad(share));
        let found = share_of(distance_rad / spacing_rad, half_rad / spacing_rad);
        let width = 2.0 * half_rad / spacing_rad;
        let depth_m = channel.depth_m + channel.depth_change_m * share;
        if found > self.share {
            (self.share, self.width, self.depth_m) = (found, width, depth_m * (1.0 - FREEBOARD));
        } else if self.share == 0.0 && distance_rad < half_rad + far_rad {
            self.width = self.width.max(width);
        }
    }
}

/// Share of a footprint that is water, from the distance to the centre line and half the width, both in spacings.
fn share_of(distance: f64, half_width: f64) -> f64 {
    tent_below(half_width - distance) - tent_below(-half_width - distance)
}

/// Integral of a tent of width 2 and area 1 around 0, from far below up to `x`.
fn tent_below(x: f64) -> f64 {
    let near = 1.0 - x.abs().min(1.0);
    let beyond = 0.5 * near * near;
    if x < 0.0 { beyond } else { 1.0 - beyond }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_across_a_river_sum_to_its_width() {
        for half_width in [0.01, 0.2, 0.5, 1.3, 4.0] {
            for shift in [0.0, 0.17, 0.5, 0.83] {
                let shares = (-8..=8).map(|k| share_of((f64::from(k) + shift).abs(), half_width));
                let sum: f64 = shares.inspect(|share| assert!((0.0..=1.0).contains(share), "{share}")).sum();
                assert!((sum - 2.0 * half_width).abs() < 1e-9, "{sum} {half_width} {shift}");
            }
        }
        assert!(share_of(0.0, 2.0) == 1.0 && share_of(4.0, 2.0) == 0.0);
        // A narrow river is a line without gaps: wherever it runs between two points, one of them has half of it.
        assert!(share_of(0.5, 0.01) > 0.009);
    }
}
