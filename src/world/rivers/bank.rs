//! Distances from the banks of rivers.
//!
//! A river counts on the level that cuts its channel, as for `flow`: there its distance is that of the water itself.
//! That level knows of it as far as its influence reaches. Farther away the reaches of coarser levels tell of it, whose
//! courses are straighter: they count as no nearer than what the finer level would know.

use super::Rivers;
use super::cache::Cache;
use super::grid::FacePlace;
use super::reach::{Channel, INFLUENCE, Line};
use glam::DVec3;

impl Rivers {
    /// Finds the distance of each direction from the nearest bank, as an angle: 0 in the water of a river, infinity
    /// where no river is known.
    pub(crate) fn banks(&self, dirs: &[DVec3], levels: usize, cache: &mut Cache, out: &mut Vec<f64>) {
        cache.belongs_to(self.number);
        cache.is_spread = self.is_spread(dirs, levels);
        out.clear();
        out.extend(dirs.iter().map(|&dir| self.bank(dir, levels, cache)));
    }

    fn bank(&self, dir: DVec3, levels: usize, cache: &mut Cache) -> f64 {
        let place = FacePlace::new(dir);
        self.find_blocks(&place, levels, true, cache);
        let nearest_on = |level: usize, counts: &dyn Fn(&Line) -> bool| {
            let Some((_, block)) = &cache.current[level] else { return f64::INFINITY };
            let wet = block.near(&place).iter().filter_map(|&number| {
                let (line, channel) = (&block.lines[usize::from(number)], &block.stream(number).channel);
                if counts(line) { from_bank(dir, line, channel) } else { None }
            });
            wet.fold(f64::INFINITY, f64::min)
        };
        let mut bank_rad = f64::INFINITY;
        for level in 0..levels {
            bank_rad = bank_rad.min(nearest_on(level, &|line| line.is_cut(level + 1 == levels)));
        }
        for level in 1..levels {
            let unknown_rad = INFLUENCE * self.grids[level].width_rad(dir);
            bank_rad = bank_rad.min(nearest_on(level - 1, &|_| true).max(unknown_rad));
        }
        bank_rad
    }
}

/// Distance of a direction from the bank of a piece, if it carries water and the direction is within its influence.
#[inline(always)]
fn from_bank(dir: DVec3, line: &Line, channel: &Channel) -> Option<f64> {
    let v = dir - line.start;
    let share = (v.dot(line.along) * line.per_length2).clamp(0.0, 1.0);
    let straight = v - line.along * share;
    // The part along the ground alone: the piece lies a little below it.
    let offset = straight - dir * straight.dot(dir);
    let distance2 = offset.dot(offset);
    let discharge_m3_s = channel.discharge_m3_s + channel.discharge_change_m3_s * share;
    let is_near = distance2 * line.per_influence2 < 1.0 && discharge_m3_s > 0.0;
    is_near.then(|| (distance2.sqrt() - channel.half_width_rad(share)).max(0.0))
}
