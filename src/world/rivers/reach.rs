//! A reach: the curve from one node to the next, its bed and its channel, cut into straight pieces.

use super::grid::RATIO;
use glam::DVec3;

/// Discharge from which a reach carries a river that is drawn, in cubic metres a second. Weaker ones are valleys.
pub(super) const LEAST_RIVER_M3_S: f64 = 1.0;
/// The channel reaches from bank to bank this much wider than the water.
const BANK: f64 = 1.25;
/// Share of the depth by which the water stands below the banks: the depth of the channel where the water ends.
pub(super) const FREEBOARD: f64 = (1.0 - 1.0 / (BANK * BANK)) * (1.0 - 1.0 / (BANK * BANK));

/// Distance within which the ground depends on a reach, by the width of a cell. Together with the jitter of nodes it
/// keeps the reaches that matter to a cell within two rings of cells.
pub(super) const INFLUENCE: f64 = 0.45;
/// Half the width of a channel is at most this share of the influence of its reach.
const WIDEST: f64 = 0.8;
/// Square of half a channel's width, by that of the influence, from which the next level is too fine for it.
const OUTGROWN: f64 = 0.8 / (RATIO * RATIO) as f64;
/// How far from the banks of a river of 100 m³/s the layers over the structure are whole, metres.
const RIVERSIDE_M: f64 = 2500.0;
/// Discharges up to which a brook rides on the layers over the structure, and from which they leave a river its bed, on
/// a planet of the Earth's size.
const BROOK_TO_RIVER_M3_S: [f64; 2] = [1.5, 10.0];
const EARTH_M: f64 = 6.371e6;
/// Length of the end tangents of a reach, by its chord: the less, the nearer the curve stays to the chord.
const STRETCH: f64 = 0.8;
/// A share beyond every influence.
const FAR: f64 = 100.0;

/// A reach before it is cut.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    pub(super) river: u64,
    pub(super) from: DVec3,
    pub(super) to: DVec3,
    /// Directions of flow at both ends, of any length; none where nothing flows on, or nothing flows in.
    pub(super) tangents: [Option<DVec3>; 2],
    /// Whether it goes on as the river below it, or joins that.
    pub(super) is_main: bool,
    /// Heights of the banks at both ends, metres. The second is not above the first.
    pub(super) bank_m: [f64; 2],
    /// Height that the line of the banks reaches at most above its spring, where it is drawn out uphill, metres.
    pub(super) rise_m: f64,
    /// The lake into which or out of which it flows, counted from 1.
    pub(super) lake: u32,
    pub(super) discharge_m3_s: [f64; 2],
    /// Half the width of the floodplain at both ends, radians.
    pub(super) flat_rad: [f64; 2],
    /// Distance within which the ground depends on it, radians.
    pub(super) influence_rad: f64,
}

/// A straight piece of a reach. Heights and channel vary linearly along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) line: Line,
    pub(super) stream: Stream,
}

/// What flows along a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stream {
    /// The lake into which or out of which it flows, counted from 1.
    pub(super) lake: u32,
    pub(super) channel: Channel,
    pub(super) river: u64,
    /// Derivatives of the curve at both ends, by the share of the piece.
    pub(super) tangents: [DVec3; 2],
}

/// What of a piece shapes the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) start: DVec3,
    pub(super) along: DVec3,
    pub(super) per_length2: f64,
    /// Height of the banks at the start, and the change to the end: never above 0.
    pub(super) bank_m: f64,
    pub(super) bank_change_m: f64,
    /// Where the line of the banks is drawn out uphill, it stays below this height above the start.
    pub(super) rise_m: f64,
    /// The share up to which it is drawn out downhill: into the next piece of the same reach.
    pub(super) last_share: f64,
    /// The square of the influence, inverted.
    pub(super) per_influence2: f64,
    /// The square of half the floodplain's width, by that of the influence.
    pub(super) flat2: f64,
    /// Square of the distance from which there is no channel; 0 where there is no river, or where a coarser level cuts
    /// its channel.
    pub(super) channel2: f64,
}

/// The channel of a piece. Widths are angles. All are 0 where there is no river.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Channel {
    /// Half the width from bank to bank.
    pub(super) bank_rad: f64,
    pub(super) bank_change_rad: f64,
    pub(super) depth_m: f64,
    pub(super) depth_change_m: f64,
    pub(super) discharge_m3_s: f64,
    pub(super) discharge_change_m3_s: f64,
    /// Distance from the bank to where layers over the structure are whole.
    pub(super) riverside_rad: f64,
    pub(super) riverside_change_rad: f64,
    /// How far layers over the structure give way to it: from 0 for a brook to 1.
    pub(super) hold: f64,
    pub(super) hold_change: f64,
}

/// Width of a river at its discharge, in metres (exponent: Pelletier 2021; factor: Andreadis et al. 2013).
pub(super) fn width_m(discharge_m3_s: f64) -> f64 {
    7.2 * discharge_m3_s.max(0.0).sqrt()
}

/// Depth of a river at its discharge, in metres (Pelletier 2021).
pub(super) fn depth_m(discharge_m3_s: f64) -> f64 {
    0.27 * libm::pow(discharge_m3_s.max(0.0), 0.4)
}

/// Distance from the bank of a river to where layers over the structure are whole, in metres. It grows with the
/// discharge a little less than the floors of valleys do.
fn riverside_m(discharge_m3_s: f64) -> f64 {
    RIVERSIDE_M * libm::pow(discharge_m3_s.max(0.0) * 0.01, 0.3)
}

/// How far layers over the structure give way to a river: from 0 for a brook to 1. Small planets have small rivers.
fn hold(discharge_m3_s: f64, radius_m: f64) -> f64 {
    let size = (radius_m * (1.0 / EARTH_M)).min(1.0);
    let [brook, river] = BROOK_TO_RIVER_M3_S.map(|discharge| discharge * size * size);
    let t = ((discharge_m3_s - brook) / (river - brook)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Line {
    /// Whether this level cuts the channel of the piece: the last one that is asked for does, and one whose next level
    /// would be too fine for a channel so wide.
    #[inline(always)]
    pub(super) fn is_cut(&self, is_last: bool) -> bool {
        self.channel2 > 0.0 && (is_last || self.is_outgrown())
    }

    fn is_outgrown(&self) -> bool {
        self.channel2 * self.per_influence2 > OUTGROWN
    }
}

impl Channel {
    /// Square of the distance from which there is no channel.
    fn reach2(&self) -> f64 {
        let widest = self.bank_rad.max(self.bank_rad + self.bank_change_rad);
        widest * widest
    }

    /// Square of the distance from which layers over the structure are whole.
    pub(super) fn farthest2(&self) -> f64 {
        if self.hold.max(self.hold + self.hold_change) <= 0.0 {
            return 0.0;
        }
        let [start, end] = [0.0, 1.0].map(|share| {
            self.bank_rad + self.bank_change_rad * share + self.riverside_rad + self.riverside_change_rad * share
        });
        start.max(end) * start.max(end)
    }

    /// Half the width of the water, radians.
    pub(super) fn half_width_rad(&self, share: f64) -> f64 {
        (self.bank_rad + self.bank_change_rad * share) * (1.0 / BANK)
    }
}

impl Reach {
    /// Cuts the reach into `count` straight pieces.
    pub(super) fn cut(&self, count: usize, radius_m: f64, pieces: &mut Vec<Piece>) {
        let has_river = self.discharge_m3_s[0] >= LEAST_RIVER_M3_S;
        let ends = |k: usize, [a, b]: [f64; 2]| a + (b - a) * (k as f64 / count as f64);
        let channel = |k: usize| {
            let discharge = ends(k, self.discharge_m3_s);
            let bank_rad = (0.5 * BANK * width_m(discharge) / radius_m).min(WIDEST * self.influence_rad);
            [bank_rad, depth_m(discharge), discharge, riverside_m(discharge) / radius_m, hold(discharge, radius_m)]
        };
        let curve = Curve { ends: [self.from, self.to], tangents: self.end_tangents() };
        let (mut end, mut channel_end) = (curve.at(0, count), has_river.then(|| channel(0)));
        for k in 0..count {
            let (start, channel_start) = (end, channel_end);
            (end, channel_end) = (curve.at(k + 1, count), has_river.then(|| channel(k + 1)));
            let flat_rad = 0.5 * (ends(k, self.flat_rad) + ends(k + 1, self.flat_rad)) / self.influence_rad;
            let (bank_m, next_m) = (ends(k, self.bank_m), ends(k + 1, self.bank_m));
            let channel = channel_start.zip(channel_end).map(|(start, end)| {
                let [bank_rad, depth_m, discharge, riverside_rad, hold] = start;
                let [next_rad, next_depth_m, next, next_riverside_rad, next_hold] = end;
                Channel {
                    bank_rad,
                    bank_change_rad: next_rad - bank_rad,
                    depth_m,
                    depth_change_m: next_depth_m - depth_m,
                    discharge_m3_s: discharge,
                    discharge_change_m3_s: next - discharge,
                    riverside_rad,
                    riverside_change_rad: next_riverside_rad - riverside_rad,
                    hold,
                    hold_change: next_hold - hold,
                }
            });
            let along = end.0 - start.0;
            let channel = channel.unwrap_or_default();
            let line = Line {
                start: start.0,
                along,
                per_length2: 1.0 / along.dot(along).max(1e-30),
                bank_m,
                bank_change_m: next_m - bank_m,
                rise_m: self.bank_m[0] - bank_m + self.rise_m + 1e-3,
                last_share: if k + 1 == count { 1.0 } else { FAR },
                per_influence2: 1.0 / (self.influence_rad * self.influence_rad),
                flat2: flat_rad * flat_rad,
                channel2: channel.reach2(),
            };
            let stream = Stream { lake: self.lake, channel, river: self.river, tangents: [start.1, end.1] };
            pieces.push(Piece { line, stream });
        }
    }

    /// Derivatives of the curve at both ends: a river goes on smoothly, a tributary bends into the flow it joins.
    fn end_tangents(&self) -> [DVec3; 2] {
        let chord = self.to - self.from;
        let length = chord.dot(chord).sqrt();
        let straight = chord / length.max(1e-30);
        let [first, last] = self.tangents;
        let first = first.map_or(straight, unit);
        let last = match last.map(unit) {
            Some(last) if self.is_main => last,
            Some(last) => unit(straight + last * 0.7),
            None => straight,
        };
        [first * (length * STRETCH), last * (length * STRETCH)]
    }
}

impl Piece {
    /// Cuts the piece into `count` pieces of a curve through its ends, bent to one side by `bend` of its length, and in
    /// the middle wider by `swell` of its width. Their influence is `finer` times less.
    pub(super) fn refined(&self, count: usize, finer: f64, [bend, swell]: [f64; 2], each: &mut impl FnMut(Piece)) {
        let Piece { line: whole, stream } = self;
        let end = whole.start + whole.along;
        let curve = Curve { ends: [whole.start, end], tangents: stream.tangents };
        let aside = whole.start.cross(whole.along) * (16.0 * bend);
        let step = 1.0 / count as f64;
        let point = |k: usize| {
            let (p, tangent) = curve.at(k, count);
            let t = k as f64 * step;
            let u = 1.0 - t;
            // Ends stay where they are to the bit.
            let p = if k == 0 || k == count { p } else { unit(p + aside * (t * t * u * u)) };
            (p, (tangent * count as f64 + aside * (2.0 * t * u * (u - t))) * step)
        };
        let bank_rad = |t: f64| {
            let Channel { bank_rad, bank_change_rad, .. } = stream.channel;
            (bank_rad + bank_change_rad * t) * (1.0 + swell * (4.0 * t * (1.0 - t)))
        };
        for k in 0..count {
            let ((a, first), (b, last)) = (point(k), point(k + 1));
            let (share, along) = (k as f64 * step, b - a);
            let Channel { depth_change_m, discharge_change_m3_s, riverside_change_rad, hold_change, .. } =
                stream.channel;
            let (bank_rad, next_rad) = (bank_rad(share), bank_rad(share + step));
            let channel = Channel {
                bank_rad,
                bank_change_rad: next_rad - bank_rad,
                depth_m: stream.channel.depth_m + depth_change_m * share,
                depth_change_m: depth_change_m * step,
                discharge_m3_s: stream.channel.discharge_m3_s + discharge_change_m3_s * share,
                discharge_change_m3_s: discharge_change_m3_s * step,
                riverside_rad: stream.channel.riverside_rad + riverside_change_rad * share,
                riverside_change_rad: riverside_change_rad * step,
                hold: stream.channel.hold + hold_change * share,
                hold_change: hold_change * step,
            };
            let line = Line {
                start: a,
                along,
                per_length2: 1.0 / along.dot(along).max(1e-30),
                bank_m: whole.bank_m + whole.bank_change_m * share,
                bank_change_m: whole.bank_change_m * step,
                rise_m: whole.rise_m - whole.bank_change_m * share,
                last_share: (whole.last_share - share) * count as f64,
                per_influence2: whole.per_influence2 * (finer * finer),
                flat2: whole.flat2 * (finer * finer),
                channel2: if whole.channel2 > 0.0 && !whole.is_outgrown() { channel.reach2() } else { 0.0 },
            };
            each(Piece { line, stream: Stream { channel, tangents: [first, last], ..*stream } });
        }
    }
}

/// A cubic curve between two unit directions (Hermite form).
struct Curve {
    ends: [DVec3; 2],
    tangents: [DVec3; 2],
}

impl Curve {
    /// The direction at share `k / count`, and the derivative there by one piece. The ends are given back to the bit,
    /// so that reaches meet.
    fn at(&self, k: usize, count: usize) -> (DVec3, DVec3) {
        let (t, [a, b], [first, last]) = (k as f64 / count as f64, self.ends, self.tangents);
        let u = 1.0 - t;
        let slope = (b - a) * (6.0 * t * u) + first * (u * (1.0 - 3.0 * t)) + last * (t * (3.0 * t - 2.0));
        let slope = slope / count as f64;
        if k == 0 {
            return (a, slope);
        }
        if k == count {
            return (b, slope);
        }
        let p =
            a * (u * u * (1.0 + 2.0 * t)) + b * (t * t * (3.0 - 2.0 * t)) + first * (t * u * u) - last * (t * t * u);
        (unit(p), slope)
    }
}

fn unit(v: DVec3) -> DVec3 {
    v / v.dot(v).sqrt().max(1e-30)
}
