//! One edit, compiled: its tool, its line, and the pieces of that line.

use super::index::{Hash, Piece, chord_of};
use super::outline::{self, Noise, Sampled};
use super::path::{self, Arc, angle_of};
use super::tool::{At, Change, CompiledTool, falloff, rise};
use crate::planet::{GroundEdit, Limit, Tool};
use glam::DVec3;

/// Arcs of a piece.
const PIECE: usize = 8;
/// Discs wider than this count as the whole sphere.
const WIDEST_RAD: f64 = 1.2;
/// Points from the middle of a fade to its end from which a gradient shows the fade.
const LEAST_POINTS: f64 = 2.0;
/// Least height over which an edit of land or sea floor alone begins at the sea level.
const LEAST_RAMP_M: f64 = 1.0;

/// An edit, compiled.
#[derive(Debug)]
pub(super) struct CompiledEdit {
    tool: CompiledTool,
    arcs: Vec<Arc>,
    pub(super) pieces: Vec<Piece>,
    radius_rad: f64,
    /// Share of the radius without fade.
    core: f64,
    raggedness: f64,
    /// Noise of a ragged outline.
    outline: Option<Noise>,
    /// Noise of rough ground.
    rough: Option<Noise>,
    /// The sea level, if the edit ends there, and whether it acts above it.
    limit: Option<(f64, bool)>,
    heights_m: (f64, f64),
}

/// What is near a point of the line of an edit.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    nearest: Option<Nearest>,
    /// Of a road: sums over near arcs of weight and of weight times height, each with its gradient.
    weight: (f64, DVec3),
    weighted_m: (f64, DVec3),
}

#[derive(Clone, Copy, Debug)]
struct Nearest {
    chord2: f64,
    /// Its arc among those of the edit.
    arc: u32,
}

/// What an edit does at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effect {
    pub(super) change_m: f64,
    /// Derivative of the new height by the old one.
    pub(super) by_ground: f64,
    /// Gradient by the distance from the line, without noise; the size of what makes it.
    smooth: DVec3,
    feature_rad: f64,
    /// Derivatives by the two noises.
    outline: Option<(f64, Sampled)>,
    rough: Option<(f64, Sampled)>,
}

impl Effect {
    /// The gradient by the direction that points so far apart can show.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        let noisy = |part: &Option<(f64, Sampled)>| {
            part.as_ref().map_or(DVec3::ZERO, |(by_noise, noise)| noise.gradient(spacing_rad) * *by_noise)
        };
        let seen = outline::seen(self.feature_rad, spacing_rad, LEAST_POINTS);
        self.smooth * seen + noisy(&self.outline) * seen + noisy(&self.rough)
    }
}

impl CompiledEdit {
    pub(super) fn new(edit: &GroundEdit, radius_m: f64, sea_m: Option<f64>) -> Self {
        let radius_rad = edit.radius_km * 1000.0 / radius_m;
        let tool = CompiledTool::new(edit, sea_m.unwrap_or(0.0));
        let points = &edit.points.0;
        let arcs = if edit.tool.is_stamp() { path::places(points) } else { path::arcs(points, radius_rad) };
        let limit = match edit.limit {
            Limit::Everywhere => None,
            Limit::AboveSea => Some((sea_m.unwrap_or(0.0), true)),
            Limit::BelowSea => Some((sea_m.unwrap_or(0.0), false)),
        };
        let rough = match &edit.tool {
            Tool::Roughen(rough) => Some(Noise::new(edit.seed ^ 0x5C07, rough.wavelength_km * 1000.0 / radius_m)),
            _ => None,
        };
        let heights = arcs.iter().flat_map(|arc| arc.heights_m);
        let heights_m = heights.fold((f64::MAX, f64::MIN), |(lo, hi), h| (lo.min(h), hi.max(h)));
        let mut compiled = Self {
            pieces: Vec::new(),
            radius_rad,
            core: (1.0 - edit.softness).min(0.99),
            raggedness: edit.raggedness,
            outline: (edit.raggedness > 0.0).then(|| Noise::new(edit.seed, radius_rad)),
            rough,
            limit,
            heights_m,
            tool,
            arcs,
        };
        compiled.pieces = compiled.cut(edit);
        compiled
    }

    /// The pieces of the line.
    fn cut(&self, edit: &GroundEdit) -> Vec<Piece> {
        let reach_rad = self.radius_rad * self.tool.reach();
        let mut common = Hash::default();
        self.tool.hash(&mut common);
        common.add_f64(self.radius_rad);
        common.add_f64(self.core);
        common.add_f64(self.raggedness);
        common.add(u64::from(edit.seed));
        let (sea_m, above) = self.limit.unwrap_or((f64::MAX, true));
        common.add_f64(sea_m);
        common.add(u64::from(above));
        if let Tool::Roughen(rough) = &edit.tool {
            common.add_f64(rough.wavelength_km);
        }
        let piece = |(number, arcs): (usize, &[Arc])| {
            let middle = arcs.iter().map(|arc| arc.a + arc.b).sum::<DVec3>().normalize_or(arcs[0].a);
            let ends = arcs.iter().flat_map(|arc| [arc.a, arc.b]);
            let angle_rad = ends.map(|end| angle_of(end.distance_squared(middle))).fold(0.0, f64::max) + reach_rad;
            let angle_rad = if angle_rad > WIDEST_RAD { std::f64::consts::PI } else { angle_rad };
            let mut hash = common;
            for number in arcs.iter().flat_map(|arc| [arc.a, arc.b]).flat_map(|end| end.to_array()) {
                hash.add_f64(number);
            }
            arcs.iter().flat_map(|arc| arc.heights_m).for_each(|height_m| hash.add_f64(height_m));
            let (first, count) = ((number * PIECE) as u32, arcs.len() as u32);
            Piece { edit: 0, first, count, middle, chord: chord_of(angle_rad), hash: hash.0 }
        };
        self.arcs.chunks(PIECE).enumerate().map(piece).collect()
    }

    /// Adds the arcs of a piece to what is known of a place.
    pub(super) fn look(&self, dir: DVec3, piece: &Piece, place: &mut Place) {
        let is_road = matches!(self.tool, CompiledTool::Road { .. });
        let arcs = &self.arcs[piece.first as usize..(piece.first + piece.count) as usize];
        for (number, arc) in (piece.first..).zip(arcs) {
            let (chord2, _) = arc.chord2(dir);
            if place.nearest.is_none_or(|nearest| chord2 < nearest.chord2) {
                place.nearest = Some(Nearest { chord2, arc: number });
            }
            let t = if is_road { angle_of(chord2) / self.radius_rad } else { 1.0 };
            if t >= 1.0 {
                continue;
            }
            let foot = arc.foot(dir);
            let (weight, by_t) = falloff(t, self.core);
            let weight_by_dir = away(dir, foot.dir) * (by_t / self.radius_rad);
            let [from_m, to_m] = arc.heights_m;
            let height_m = from_m + (to_m - from_m) * foot.along;
            let slope = if foot.inside { (to_m - from_m) / arc.length_rad().max(1e-15) } else { 0.0 };
            let height_by_dir = arc.tangent(foot.dir) * slope;
            place.weight.0 += weight;
            place.weight.1 += weight_by_dir;
            place.weighted_m.0 += weight * height_m;
            place.weighted_m.1 += weight_by_dir * height_m + height_by_dir * weight;
        }
    }

    /// What the edit does to ground of a height. None if nothing.
    pub(super) fn effect(&self, dir: DVec3, place: &Place, ground_m: f64) -> Option<Effect> {
        let nearest = place.nearest?;
        let plain = angle_of(nearest.chord2) / self.radius_rad;
        if plain >= self.tool.reach() {
            return None;
        }
        // A ragged outline is nearer than the radius, never farther.
        let ragged = self.outline.as_ref().map(|noise| noise.at(dir));
        let (stretch, by_noise) = ragged.map_or((1.0, 0.0), |noise| self.stretch(noise.value));
        let t = plain * stretch;
        if t >= self.tool.reach() {
            return None;
        }
        let rough = self.rough.as_ref().map(|noise| noise.at(dir));
        let line = (place.weight.0 > 0.0).then(|| {
            let height_m = place.weighted_m.0 / place.weight.0;
            (height_m, (place.weighted_m.1 - place.weight.1 * height_m) / place.weight.0)
        });
        let at = At {
            ground_m,
            t,
            core: self.core,
            noise: rough.map_or(0.0, |rough| rough.value),
            line_m: line.map_or(ground_m, |line| line.0),
        };
        let mut change = self.tool.change(&at);
        if let Some((sea_m, above)) = self.limit {
            change = limited(change, ground_m, sea_m, above);
        }
        if change.change_m == 0.0 && change.by_t == 0.0 {
            return None;
        }
        let foot = self.arcs[nearest.arc as usize].foot(dir).dir;
        let line_by_dir = line.map_or(DVec3::ZERO, |line| line.1) * change.by_line;
        Some(Effect {
            change_m: change.change_m,
            by_ground: 1.0 + change.by_ground,
            smooth: away(dir, foot) * (change.by_t * stretch / self.radius_rad) + line_by_dir,
            feature_rad: self.radius_rad * (1.0 - self.core).max(0.1),
            outline: ragged.map(|noise| (change.by_t * plain * by_noise, noise)),
            rough: rough.map(|rough| (change.by_noise, rough)),
        })
    }

    /// By how much a ragged outline brings the radius nearer, 1 to 1 + 4 times the raggedness; its derivative by the
    /// noise. The cube makes few deep bays of many shallow ones.
    fn stretch(&self, noise: f64) -> (f64, f64) {
        let share = 0.5 + 0.5 * noise / outline::MOST;
        let (cube, by_noise) = (share * share * share, 1.5 * share * share / outline::MOST);
        (1.0 + 4.0 * self.raggedness * cube, 4.0 * self.raggedness * by_noise)
    }

    /// Lowest and greatest height that ground between these may get. Conservative.
    pub(super) fn range_m(&self, range_m: (f64, f64)) -> (f64, f64) {
        let (lo, hi) = self.tool.range_m(range_m, self.heights_m);
        let rounding_m = 1e-9 * lo.abs().max(hi.abs()) + 1e-9;
        (lo.min(range_m.0) - rounding_m, hi.max(range_m.1) + rounding_m)
    }
}

/// The unit tangent at a direction that points away from another one; zero where they are the same.
fn away(dir: DVec3, from: DVec3) -> DVec3 {
    let apart = dir - from;
    (apart - dir * dir.dot(apart)).normalize_or_zero()
}

/// A change of land or of sea floor alone. It begins at the sea level, over as much height as it changes, so that no
/// coast becomes a cliff.
fn limited(change: Change, ground_m: f64, sea_m: f64, above: bool) -> Change {
    let over_m = if above { ground_m - sea_m } else { sea_m - ground_m };
    if over_m <= 0.0 {
        return Change::default();
    }
    let size_m = change.change_m.abs();
    let ramp_m = size_m.max(LEAST_RAMP_M);
    let (share, by_share) = rise(over_m / ramp_m);
    let sign = if above { 1.0 } else { -1.0 };
    // The ramp grows with the change.
    let grows = if size_m > LEAST_RAMP_M { change.change_m.signum() } else { 0.0 };
    let by_ramp = -change.change_m * by_share * over_m / (ramp_m * ramp_m) * grows;
    let by_change = share + by_ramp;
    Change {
        change_m: change.change_m * share,
        by_ground: change.by_ground * by_change + change.change_m * by_share * sign / ramp_m,
        by_t: change.by_t * by_change,
        by_noise: change.by_noise * by_change,
        by_line: change.by_line * by_change,
    }
}
