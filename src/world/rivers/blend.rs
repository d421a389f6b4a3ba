//! The ground of one level of reaches at a point, laid over the ground of the level before.
//!
//! Let each piece within its influence `R` lie at distance `d` from the point, and let `q = d⁴ (1 + F) / (d² + F)` in
//! units of `R`, with `F` the square of half the floodplain's width. So `q` is d² beyond a floodplain and much less on
//! it. Heights of the banks at the feet are interpolated with weights `(1 - d²)² / q²` (Shepard 1968), which is exact on
//! every reach, whatever flows beside it. With `x² = min q`, the ground is
//!
//! `ground of the level before · f(x) + banks · (1 - f(x)) + amplitude · rise(x)`
//!
//! with f smooth from 0 to 1, and rise from 0 on the reach to 1 at the end of its influence. Ridges form where two
//! reaches are equally far. Nothing has a border: cells, blocks and faces do not show. Sums run in the order of the
//! pieces, which does not depend on who asks.

use super::reach::Piece;
use glam::DVec3;

/// Keeps weights finite on a reach.
const TINY: f64 = 1e-24;

/// A number and its tangential gradient by the direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) gradient: DVec3,
}

impl Jet {
    pub(super) fn times(self, other: Jet) -> Jet {
        Jet { value: self.value * other.value, gradient: self.gradient * other.value + other.gradient * self.value }
    }

    pub(super) fn plus(self, other: Jet) -> Jet {
        Jet { value: self.value + other.value, gradient: self.gradient + other.gradient }
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
    pub(super) piece: Piece,
    /// Share of the piece before the foot.
    pub(super) share: f64,
    /// Straight distance, radians.
    pub(super) distance_rad: f64,
}

/// The reaches of one level at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    /// Height of the banks, where any reach is near.
    pub(super) banks: Jet,
    /// 0 on a reach, 1 far from all.
    pub(super) x: Jet,
    /// Depth of the channel below the banks, and the height of the water.
    pub(super) carved: Jet,
    pub(super) nearest: Option<Nearest>,
    /// The river whose channel the point is in.
    pub(super) river: Option<Nearest>,
}

/// A point against one piece.
struct Foot {
    share: f64,
    /// Gradient of the share.
    share_gradient: DVec3,
    /// The share up to which the line of the banks is drawn out, and whether it varies here.
    drawn_out: f64,
    is_drawn_out: bool,
    offset: DVec3,
    distance2: f64,
}

#[inline(always)]
fn foot(piece: &Piece, dir: DVec3) -> Foot {
    let v = dir - piece.start;
    let along = v.dot(piece.along) * piece.per_length2;
    let share = along.clamp(0.0, 1.0);
    let straight = v - piece.along * share;
    // The part along the ground alone: the piece lies a little below it.
    let offset = straight - dir * straight.dot(dir);
    let share_gradient = if share == along { piece.along * piece.per_length2 } else { DVec3::ZERO };
    let drawn_out = along.clamp(piece.shares[0], piece.shares[1]);
    Foot { share, share_gradient, drawn_out, is_drawn_out: drawn_out == along, offset, distance2: offset.dot(offset) }
}

/// The reaches near a direction. `is_last` asks for channels too.
#[inline(always)]
pub(super) fn level<'a>(dir: DVec3, pieces: impl Iterator<Item = &'a Piece>, is_last: bool) -> Level {
    let (mut weights, mut sum) = (Jet::default(), Jet::default());
    let (mut least_q, mut least_2) = ((1.0, DVec3::ZERO), f64::MAX);
    let mut nearest: Option<(&Piece, f64)> = None;
    let mut carved = Jet::default();
    let mut river = None;
    let mut reference = None;
    for piece in pieces {
        let foot = foot(piece, dir);
        let d2 = foot.distance2 * piece.per_influence2;
        if d2 >= 1.0 {
            continue;
        }
        // The plain distance decides which is nearest.
        if foot.distance2 < least_2 {
            least_2 = foot.distance2;
            nearest = Some((piece, foot.share));
        }
        let by_direction = foot.offset * (2.0 * piece.per_influence2);
        let spread = 1.0 / (d2 + piece.flat2 + 1e-30);
        let q = d2 * d2 * (1.0 + piece.flat2) * spread;
        let q_slope = d2 * (d2 + 2.0 * piece.flat2) * (1.0 + piece.flat2) * spread * spread;
        if q < least_q.0 {
            least_q = (q, by_direction * q_slope);
        }
        let (within, per_q2) = (1.0 - d2, 1.0 / (q * q + TINY));
        let weight = within * within * per_q2;
        let weight_slope = -2.0 * per_q2 * (within + weight * q * q_slope);
        let weight_gradient = by_direction * weight_slope;
        // Heights are summed from the first one, so that no digits are lost.
        let reference = *reference.get_or_insert(piece.bank_m);
        let bank_m = piece.bank_m - reference + piece.bank_change_m * foot.drawn_out;
        let climb = if foot.is_drawn_out { weight * piece.bank_change_m * piece.per_length2 } else { 0.0 };
        weights.value += weight;
        weights.gradient += weight_gradient;
        sum.value += weight * bank_m;
        sum.gradient += weight_gradient * bank_m + piece.along * climb;
        if is_last && piece.channel.bank_rad > 0.0 {
            let (depth, is_inside) = channel(piece, &foot);
            if is_inside && depth.value > carved.value {
                carved = depth;
                river = Some((piece, foot.share, foot.distance2));
            }
        }
    }
    let banks = match (reference, weights.value > 0.0) {
        (Some(reference), true) => {
            let mean = sum.value / weights.value;
            Jet { value: reference + mean, gradient: (sum.gradient - weights.gradient * mean) / weights.value }
        }
        _ => Jet::default(),
    };
    let x = least_q.0.sqrt();
    let x = Jet { value: x, gradient: if x > 1e-12 { least_q.1 * (0.5 / x) } else { DVec3::ZERO } };
    let of = |piece: &Piece, share, distance2: f64| Nearest { piece: *piece, share, distance_rad: distance2.sqrt() };
    Level {
        banks,
        x,
        carved,
        nearest: nearest.map(|(piece, share)| of(piece, share, least_2)),
        river: river.map(|(piece, share, distance2)| of(piece, share, distance2)),
    }
}

/// How deep a channel is cut below its banks: `depth (1 - u)²`, with u the square of the distance by half its width.
#[inline(never)]
fn channel(piece: &Piece, foot: &Foot) -> (Jet, bool) {
    let channel = &piece.channel;
    let bank_rad = channel.bank_rad + channel.bank_change_rad * foot.share;
    let u = foot.distance2 / (bank_rad * bank_rad);
    if u >= 1.0 {
        return (Jet::default(), false);
    }
    let depth_m = channel.depth_m + channel.depth_change_m * foot.share;
    let u_gradient = foot.offset * (2.0 / (bank_rad * bank_rad))
        - foot.share_gradient * (2.0 * u / bank_rad * channel.bank_change_rad);
    let shape = (1.0 - u) * (1.0 - u);
    let gradient =
        u_gradient * (-2.0 * (1.0 - u) * depth_m) + foot.share_gradient * (channel.depth_change_m * shape);
    (Jet { value: depth_m * shape, gradient }, true)
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
