//! The channels of rivers at a point: their bed, the water in it, and how far layers over the structure may stand.
//!
//! Each channel is cut by one level of reaches: the last one that is asked for, or an earlier one where the next is too
//! fine for a channel so wide. In the water the ground is the bed alone, whatever the levels around it say: the line of
//! the banks less `depth (1 - u)²`, with u the square of the distance by half the channel's width. Between the water
//! and the top of the bank it goes over into the ground around. Where channels meet, each counts by its depth.

use super::blend::{Foot, Jet, Nearest};
use super::reach::{Channel, FREEBOARD, Line};
use glam::DVec3;

/// Share of the influence of a reach within which layers over the structure give way to its river.
const WITHIN: f64 = 0.95;

/// The channels at a point. The jets are sums over channels until [`Cut::bed`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The deepest one: its depth here, its level of reaches and its piece.
    depth: Jet,
    pub(super) river: Option<(usize, Nearest)>,
    /// Depth of that river in the middle.
    full_m: f64,
    /// The greatest depth here by the depth in the middle.
    shape: Jet,
    /// Weights of the channels, and the sum of their banks.
    weights: Jet,
    banks: Jet,
    /// From 0 in a channel to 1 where layers over the structure are whole.
    pub(super) beside: Jet,
}

impl Default for Cut {
    fn default() -> Self {
        Self {
            depth: Jet::default(),
            river: None,
            full_m: 0.0,
            shape: Jet::default(),
            weights: Jet::default(),
            banks: Jet::default(),
            beside: Jet { value: 1.0, gradient: DVec3::ZERO },
        }
    }
}

impl Cut {
    /// Takes in a piece with a river, which this level of reaches cuts or leaves to a finer one.
    #[inline(never)]
    pub(super) fn join(&mut self, level: usize, is_cut: bool, piece: (u16, &Line, &Channel), foot: &Foot) {
        let (number, line, channel) = piece;
        let bank_rad = channel.bank_rad + channel.bank_change_rad * foot.share;
        self.stand_aside(line, channel, foot, bank_rad);
        let u = foot.distance2 / (bank_rad * bank_rad);
        if !is_cut || u >= 1.0 {
            return;
        }
        let full_m = channel.depth_m + channel.depth_change_m * foot.share;
        let u_gradient = foot.offset * (2.0 / (bank_rad * bank_rad))
            - foot.share_gradient * (2.0 * u / bank_rad * channel.bank_change_rad);
        let shape = Jet { value: (1.0 - u) * (1.0 - u), gradient: u_gradient * (-2.0 * (1.0 - u)) };
        let full = Jet { value: full_m, gradient: foot.share_gradient * channel.depth_change_m };
        let depth = full.times(shape);
        let bank = Jet {
            value: line.bank_m + line.bank_change_m * foot.share,
            gradient: foot.share_gradient * line.bank_change_m,
        };
        let square = depth.times(depth);
        let weight = square.times(square);
        self.weights = self.weights.plus(weight);
        self.banks = self.banks.plus(weight.times(bank));
        if shape.value > self.shape.value {
            self.shape = shape;
        }
        if depth.value > self.depth.value {
            (self.depth, self.full_m) = (depth, full_m);
            self.river = Some((level, Nearest { piece: number, share: foot.share, distance2: foot.distance2 }));
        }
    }

    /// Layers stand from the banks of the river on, and are whole at the end of its riverside. Brooks ride on them.
    fn stand_aside(&mut self, line: &Line, channel: &Channel, foot: &Foot, bank_rad: f64) {
        let hold = channel.hold + channel.hold_change * foot.share;
        if hold <= 0.0 {
            return;
        }
        let distance = foot.distance2.sqrt();
        let beyond = distance - bank_rad;
        let riverside_rad = channel.riverside_rad + channel.riverside_change_rad * foot.share;
        let most_rad = WITHIN / line.per_influence2.sqrt() - bank_rad;
        let (reach, reach_gradient) = if riverside_rad < most_rad {
            (riverside_rad, foot.share_gradient * channel.riverside_change_rad)
        } else {
            (most_rad, foot.share_gradient * -channel.bank_change_rad)
        };
        if beyond >= reach {
            return;
        }
        let away = if beyond > 0.0 {
            let t = beyond / reach;
            let outwards = foot.offset * (1.0 / distance) - foot.share_gradient * channel.bank_change_rad;
            Jet { value: t, gradient: (outwards - reach_gradient * t) * (1.0 / reach) }
        } else {
            Jet::default()
        };
        if 1.0 - hold * (1.0 - away.value) >= self.beside.value {
            return;
        }
        let hold = Jet { value: hold, gradient: foot.share_gradient * channel.hold_change };
        self.beside = hold.times(away.plus_number(-1.0)).plus_number(1.0);
    }

    /// The ground with the channels cut into it.
    #[inline(always)]
    pub(super) fn bed(&self, ground: Jet) -> Jet {
        if self.weights.value <= 0.0 {
            return ground;
        }
        let per = 1.0 / self.weights.value;
        let bank = self.banks.value * per;
        let bank = Jet { value: bank, gradient: (self.banks.gradient - self.weights.gradient * bank) * per };
        let t = (self.shape.value * (1.0 / FREEBOARD)).min(1.0);
        let slope = if t < 1.0 { 6.0 * t * (1.0 - t) * (1.0 / FREEBOARD) } else { 0.0 };
        let within = self.shape.mapped(t * t * (3.0 - 2.0 * t), slope);
        ground.plus(bank.plus(ground.scaled(-1.0)).times(within)).plus(self.depth.scaled(-1.0))
    }

    /// Height of the water's surface above the bed; 0 beside the water.
    pub(super) fn rise_m(&self) -> f64 {
        (self.depth.value - FREEBOARD * self.full_m).max(0.0)
    }
}
