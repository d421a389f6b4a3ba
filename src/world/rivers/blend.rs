//! The ground of one level of reaches at a point, laid over the ground of the level before.
//!
//! Let each piece within its influence `R` lie at distance `d` from the point, and let `q = d⁴ (1 + F) / (d² + F)` in
//! units of `R`, with `F` the square of half the floodplain's width. So `q` is d² beyond a floodplain and much less on
//! it. Heights of the banks at the feet are interpolated with weights `(1 - d²)² / q²` (Shepard 1968), which is exact
//! on every reach, whatever flows beside it. With `x² = min q`, the ground is
//!
//! `ground of the level before · f(x) + banks · (1 - f(x)) + amplitude · rise(x)`
//!
//! with f smooth from 0 to 1, and rise from 0 on the reach to 1 at the end of its influence. Ridges form where two
//! reaches are equally far. Nothing has a border: cells, blocks and faces do not show. Sums run in the order of the
//! pieces, which does not depend on who asks.

use super::block::Block;
use super::channel::Cut;
use super::reach::Line;
use glam::DVec3;

/// Keeps weights finite on a reach.
const TINY: f64 = 1e-24;

/// A number and its tangential gradient by the direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Jet {
    pub(crate) value: f64,
    pub(crate) gradient: DVec3,
}

impl Jet {
    pub(super) fn times(self, other: Jet) -> Jet {
        Jet { value: self.value * other.value, gradient: self.gradient * other.value + other.gradient * self.value }
    }

    pub(super) fn plus(self, other: Jet) -> Jet {
        Jet { value: self.value + other.value, gradient: self.gradient + other.gradient }
    }

    pub(super) fn plus_number(self, number: f64) -> Jet {
        Jet { value: self.value + number, gradient: self.gradient }
    }

    pub(super) fn scaled(self, by: f64) -> Jet {
        Jet { value: self.value * by, gradient: self.gradient * by }
    }

    /// A function of the number: its value, and its derivative.
    pub(super) fn mapped(self, value: f64, slope: f64) -> Jet {
        Jet { value, gradient: self.gradient * slope }
    }
}

/// The piece nearest to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Its number in its block.
    pub(super) piece: u16,
    /// Share of the piece before the foot.
    pub(super) share: f64,
    /// Square of the straight distance, radians.
    pub(super) distance2: f64,
}

/// The reaches of one level at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    /// Height of the banks, where any reach is near.
    pub(super) banks: Jet,
    /// 0 on a reach, 1 far from all.
    pub(super) x: Jet,
    pub(super) nearest: Option<Nearest>,
}

/// A point against one piece.
pub(super) struct Foot {
    pub(super) share: f64,
    /// Gradient of the share.
    pub(super) share_gradient: DVec3,
    /// Height of the banks above the start of the piece, their line drawn out beyond its ends, and how that varies with
    /// the share.
    bank_m: f64,
    bank_slope_m: f64,
    pub(super) offset: DVec3,
    pub(super) distance2: f64,
}

/// None beyond the influence of the piece.
#[inline(always)]
fn foot(line: &Line, dir: DVec3) -> Option<Foot> {
    let v = dir - line.start;
    let along = v.dot(line.along) * line.per_length2;
    let share = along.clamp(0.0, 1.0);
    let straight = v - line.along * share;
    // The part along the ground alone: the piece lies a little below it.
    let offset = straight - dir * straight.dot(dir);
    let distance2 = offset.dot(offset);
    if distance2 * line.per_influence2 >= 1.0 {
        return None;
    }
    let share_gradient = if share == along { line.along * line.per_length2 } else { DVec3::ZERO };
    // Uphill of the start the line of the banks bends, so that it stays below its greatest rise.
    let line_m = line.bank_change_m * along.min(line.last_share);
    let bent = if line_m > 0.0 { line.rise_m / (line.rise_m + line_m) } else { 1.0 };
    let bank_slope_m = if along <= line.last_share { line.bank_change_m * bent * bent } else { 0.0 };
    Some(Foot { share, share_gradient, bank_m: line_m * bent, bank_slope_m, offset, distance2 })
}

/// The reaches of a block near a direction. `cut` takes in their channels: with it, the number of the level, and
/// whether that is the last one.
#[inline(always)]
pub(super) fn level(dir: DVec3, block: &Block, list: &[u16], mut cut: Option<(&mut Cut, usize, bool)>) -> Level {
    let (mut weights, mut sum) = (Jet::default(), Jet::default());
    let (mut least_q, mut least_slope) = (1.0, DVec3::ZERO);
    let mut nearest = Nearest { piece: 0, share: 0.0, distance2: f64::MAX };
    // Heights are summed from one of them, so that no digits are lost.
    let reference = list.first().map_or(0.0, |&first| block.lines[usize::from(first)].bank_m);
    for &number in list {
        let line = &block.lines[usize::from(number)];
        let Some(foot) = foot(line, dir) else { continue };
        let d2 = foot.distance2 * line.per_influence2;
        // The plain distance decides which is nearest.
        if foot.distance2 < nearest.distance2 {
            nearest = Nearest { piece: number, share: foot.share, distance2: foot.distance2 };
        }
        let by_direction = foot.offset * (2.0 * line.per_influence2);
        let spread = 1.0 / (d2 + line.flat2 + 1e-30);
        let q = d2 * d2 * (1.0 + line.flat2) * spread;
        let q_slope = d2 * (d2 + 2.0 * line.flat2) * (1.0 + line.flat2) * spread * spread;
        if q < least_q {
            (least_q, least_slope) = (q, by_direction * q_slope);
        }
        let (within, per_q2) = (1.0 - d2, 1.0 / (q * q + TINY));
        let weight = within * within * per_q2;
        let weight_slope = -2.0 * per_q2 * (within + weight * q * q_slope);
        let weight_gradient = by_direction * weight_slope;
        let bank_m = line.bank_m - reference + foot.bank_m;
        let climb = weight * foot.bank_slope_m * line.per_length2;
        weights.value += weight;
        weights.gradient += weight_gradient;
        sum.value += weight * bank_m;
        sum.gradient += weight_gradient * bank_m + line.along * climb;
        if let Some((cut, level, is_last)) = &mut cut
            && line.channel2 > 0.0
        {
            let is_cut = line.is_cut(*is_last);
            cut.join(*level, is_cut, (number, line, &block.stream(number).channel), &foot);
        }
    }
    let banks = if weights.value > 0.0 {
        let per = 1.0 / weights.value;
        let mean = sum.value * per;
        Jet { value: reference + mean, gradient: (sum.gradient - weights.gradient * mean) * per }
    } else {
        Jet::default()
    };
    let x = least_q.sqrt();
    let x = Jet { value: x, gradient: if x > 1e-12 { least_slope * (0.5 / x) } else { DVec3::ZERO } };
    Level { banks, x, nearest: Some(nearest).filter(|nearest| nearest.distance2 < f64::MAX) }
}

/// How valley sides rise with the distance from their reach: a V that steepens, then rounds off into the ridge.
fn rise(x: Jet) -> Jet {
    let t = x.value;
    x.mapped(0.5 * t * t * (3.0 - 2.0 * t) + 0.5 * t * (2.0 - t), 3.0 * t * (1.0 - t) + (1.0 - t))
}

/// Lays a level over the ground of the level before.
#[inline(always)]
pub(super) fn laid_over(before: Jet, amplitude: Jet, level: &Level) -> Jet {
    let t = level.x.value;
    let far = level.x.mapped(t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t));
    let near = Jet { value: 1.0 - far.value, gradient: -far.gradient };
    before.times(far).plus(level.banks.times(near)).plus(amplitude.times(rise(level.x)))
}
