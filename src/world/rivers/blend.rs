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

use super::reach::Line;
use glam::DVec3;
use std::ops::Range;

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

/// A point against the channel of one piece.
pub(super) struct Foot {
    pub(super) share: f64,
    /// Gradient of the share.
    pub(super) share_gradient: DVec3,
    pub(super) offset: DVec3,
    pub(super) distance2: f64,
}

impl Foot {
    #[inline(always)]
    pub(super) fn new(line: &Line, dir: DVec3) -> Self {
        let v = dir - line.start;
        let along = v.dot(line.along) * line.per_length2;
        let share = along.clamp(0.0, 1.0);
        let straight = v - line.along * share;
        // The part along the ground alone: the piece lies a little below it.
        let offset = straight - dir * straight.dot(dir);
        let share_gradient = if share == along { line.along * line.per_length2 } else { DVec3::ZERO };
        Self { share, share_gradient, offset, distance2: offset.dot(offset) }
    }
}

/// Points whose sums are found at a time.
pub(super) const PACKET: usize = 32;

/// One number for each point of a packet.
pub(super) type Lane = [f64; PACKET];

/// Sums over the pieces of one level around each point of a packet.
#[derive(Debug, Default)]
pub(super) struct Sums {
    /// Heights are summed from this one, so that no digits are lost.
    reference_m: Lane,
    weights: Lane,
    weights_gradient: [Lane; 3],
    banks: Lane,
    banks_gradient: [Lane; 3],
    least_q: Lane,
    least_gradient: [Lane; 3],
    /// The nearest piece: its number, the share of it before the foot, and the square of the distance.
    piece: Lane,
    share: Lane,
    nearest2: Lane,
    /// Square of the distance from the newest piece; infinite beyond its influence.
    pub(super) newest2: Lane,
}

impl Sums {
    /// Forgets the sums of some points. `reference_m`: height of the banks of a piece.
    pub(super) fn restart(&mut self, points: Range<usize>, reference_m: f64) {
        self.reference_m[points.clone()].fill(reference_m);
        let gradients = [&mut self.weights_gradient, &mut self.banks_gradient, &mut self.least_gradient];
        let zero = [&mut self.weights, &mut self.banks, &mut self.piece, &mut self.share];
        for lane in gradients.into_iter().flatten().chain(zero) {
            lane[points.clone()].fill(0.0);
        }
        self.least_q[points.clone()].fill(1.0);
        self.nearest2[points].fill(f64::MAX);
    }

    /// Takes in a piece, by its number, at some points. `SLOPES`: with gradients.
    // One loop over a dozen lanes.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    pub(super) fn take_in<const SLOPES: bool>(
        &mut self,
        points: Range<usize>,
        dirs: &[Lane; 3],
        line: &Line,
        number: u16,
    ) {
        let ([start_x, start_y, start_z], [along_x, along_y, along_z]) = (line.start.to_array(), line.along.to_array());
        let number = f64::from(number);
        for i in points.start..points.end.min(PACKET) {
            let (x, y, z) = (dirs[0][i], dirs[1][i], dirs[2][i]);
            let (vx, vy, vz) = (x - start_x, y - start_y, z - start_z);
            let along = (vx * along_x + vy * along_y + vz * along_z) * line.per_length2;
            let share = along.clamp(0.0, 1.0);
            let (sx, sy, sz) = (vx - along_x * share, vy - along_y * share, vz - along_z * share);
            let down = sx * x + sy * y + sz * z;
            let offset = [sx - x * down, sy - y * down, sz - z * down];
            let distance2 = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
            let d2 = distance2 * line.per_influence2;
            let is_near = d2 < 1.0;
            self.newest2[i] = if is_near { distance2 } else { f64::INFINITY };
            // The plain distance decides which is nearest.
            let is_nearest = is_near && distance2 < self.nearest2[i];
            self.piece[i] = if is_nearest { number } else { self.piece[i] };
            self.share[i] = if is_nearest { share } else { self.share[i] };
            self.nearest2[i] = if is_nearest { distance2 } else { self.nearest2[i] };
            // Uphill of the start the line of the banks bends, so that it stays below its greatest rise.
            let line_m = line.bank_change_m * along.min(line.last_share);
            let bent = if line_m > 0.0 { line.rise_m / (line.rise_m + line_m) } else { 1.0 };
            let bank_m = line.bank_m - self.reference_m[i] + line_m * bent;
            let spread = 1.0 / (d2 + line.flat2 + 1e-30);
            let q = d2 * d2 * (1.0 + line.flat2) * spread;
            let is_least = is_near && q < self.least_q[i];
            self.least_q[i] = if is_least { q } else { self.least_q[i] };
            let (within, per_q2) = (1.0 - d2, 1.0 / (q * q + TINY));
            let weight = within * within * per_q2;
            self.weights[i] = if is_near { self.weights[i] + weight } else { self.weights[i] };
            self.banks[i] = if is_near { self.banks[i] + weight * bank_m } else { self.banks[i] };
            if SLOPES {
                let q_slope = d2 * (d2 + 2.0 * line.flat2) * (1.0 + line.flat2) * spread * spread;
                let bank_slope_m = if along <= line.last_share { line.bank_change_m * bent * bent } else { 0.0 };
                let weight_slope = -2.0 * per_q2 * (within + weight * q * q_slope);
                let climb = weight * bank_slope_m * line.per_length2;
                for (axis, along) in [along_x, along_y, along_z].into_iter().enumerate() {
                    let by_direction = offset[axis] * (2.0 * line.per_influence2);
                    let least = &mut self.least_gradient[axis][i];
                    *least = if is_least { by_direction * q_slope } else { *least };
                    let slope = by_direction * weight_slope;
                    let (weights, banks) = (&mut self.weights_gradient[axis][i], &mut self.banks_gradient[axis][i]);
                    *weights = if is_near { *weights + slope } else { *weights };
                    *banks = if is_near { *banks + (slope * bank_m + along * climb) } else { *banks };
                }
            }
        }
    }

    /// The level at a point.
    #[inline(always)]
    pub(super) fn level(&self, i: usize) -> Level {
        let at = |lanes: &[Lane; 3]| DVec3::from_array(lanes.each_ref().map(|lane| lane[i]));
        let banks = if self.weights[i] > 0.0 {
            let per = 1.0 / self.weights[i];
            let mean = self.banks[i] * per;
            let gradient = (at(&self.banks_gradient) - at(&self.weights_gradient) * mean) * per;
            Jet { value: self.reference_m[i] + mean, gradient }
        } else {
            Jet::default()
        };
        let x = self.least_q[i].sqrt();
        let gradient = if x > 1e-12 { at(&self.least_gradient) * (0.5 / x) } else { DVec3::ZERO };
        let nearest = Nearest { piece: self.piece[i] as u16, share: self.share[i], distance2: self.nearest2[i] };
        let nearest = Some(nearest).filter(|nearest| nearest.distance2 < f64::MAX);
        Level { banks, x: Jet { value: x, gradient }, nearest }
    }
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
