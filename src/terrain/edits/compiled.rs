//! One edit, compiled: its tool, its line, and the pieces of that line.

use super::context::Context;
use super::gullies::{Carved, Gullies};
use super::index::{Hash, Piece, chord_of};
use super::limits::Limits;
use super::mask::{EditMask, ShareAt};
use super::nearest::Nearest;
use super::outline::{self, Noise, Sampled};
use super::paint::Paint;
use super::path::{self, Arc, Taper, angle_of, away};
use super::reading::{Read, Reader};
use super::smooth::Lattice;
use super::stamp::{Stamp, Stamped};
use super::structural::StructurePaint;
use super::tool::{At, CompiledTool, falloff, rise};
use super::widening::Widening;
use crate::planet::edits::EditBlend;
use crate::planet::{GroundEdit, Tool};
use glam::DVec3;

/// Arcs of a piece.
const PIECE: usize = 4;
/// Discs wider than this count as the whole sphere.
const WIDEST_RAD: f64 = 1.2;
/// Points from the middle of a fade to its end from which a gradient shows the fade.
const LEAST_POINTS: f64 = 2.0;
/// Bounds are wider than the formulas say, for rounding.
const ROUNDING_M: f64 = 1e-4;

/// An edit, compiled.
#[derive(Clone, Debug)]
pub(super) struct CompiledEdit {
    tool: CompiledTool,
    arcs: Vec<Arc>,
    pub(super) pieces: Vec<Piece>,
    is_stamp: bool,
    radius_rad: f64,
    /// How many images it has, itself among them: each has as many arcs.
    images: usize,
    /// Chord of the distance to which it reaches.
    reach_chord: f64,
    /// Whether the edit is wider at some of its points than at others.
    pub(super) tapers: bool,
    /// Share of the radius without fade.
    core: f64,
    raggedness: f64,
    /// Noise of a ragged outline.
    outline: Option<Noise>,
    /// Noise of rough ground.
    rough: Option<Noise>,
    /// The picture of a stamp.
    stamp: Option<Stamp>,
    /// How the edit reads the ground around a point.
    pub(super) reader: Option<Reader>,
    blend: EditBlend,
    limits: Limits,
    /// The painted mask that limits it.
    pub(super) mask: Option<EditMask>,
    /// What it does to the bounds of heights. Conservative.
    pub(super) range: Widening,
    /// What it depends on besides its own numbers.
    pub(super) context: Context,
    /// Hash of its numbers without its line.
    pub(super) own: u128,
}

/// Of a road at a point: sums over near arcs of weight and of weight times height, each with its gradient.
#[derive(Clone, Copy, Debug, Default)]
struct Average {
    weight: (f64, DVec3),
    weighted_m: (f64, DVec3),
}

/// How paint fades at a point.
struct Fade {
    weight: f64,
    /// Derivative of the weight by the distance in radii, before the outline is ragged.
    by_plain: f64,
    /// The distance in radii.
    plain: f64,
    taper: Taper,
    /// Derivative by the noise of a ragged outline.
    outline: Option<(f64, Sampled)>,
}

/// What an edit does at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effect<'a> {
    pub(super) change_m: f64,
    /// Derivative of the new height by the old one.
    pub(super) by_ground: f64,
    /// Derivative of the change by the share that a mask leaves of it.
    pub(super) by_share: f64,
    /// Gradient by the distance from the line, without noise; the size of what makes it.
    smooth: DVec3,
    feature_rad: f64,
    /// Gradient of ground that takes the place of the old one: it has the slopes of far larger features.
    ground: DVec3,
    /// Derivatives by the two noises.
    outline: Option<(f64, Sampled)>,
    rough: Option<(f64, Sampled)>,
    /// Derivative by the value of a picture, or by the height of gullies.
    detail: Option<(f64, Detail<'a>)>,
}

/// What changes within the reach of an edit, and is shaded as finely as points can show.
#[derive(Clone, Copy, Debug)]
enum Detail<'a> {
    Picture(Stamped<'a>),
    Gullies(Carved),
}

impl Detail<'_> {
    fn gradient(&self, spacing_rad: f64) -> DVec3 {
        match self {
            Detail::Picture(stamped) => stamped.gradient(spacing_rad),
            Detail::Gullies(carved) => carved.gradient(spacing_rad),
        }
    }
}

impl Effect<'_> {
    /// The gradient by the direction that points so far apart can show.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        let noisy = |part: &Option<(f64, Sampled)>| {
            part.as_ref().map_or(DVec3::ZERO, |(by_noise, noise)| noise.gradient(spacing_rad) * *by_noise)
        };
        let seen = outline::seen(self.feature_rad, spacing_rad, LEAST_POINTS);
        let detail = self.detail.as_ref();
        let detail = detail.map_or(DVec3::ZERO, |(by_value, detail)| detail.gradient(spacing_rad) * *by_value);
        self.smooth * seen + self.ground + noisy(&self.outline) * seen + noisy(&self.rough) + detail
    }
}

impl CompiledEdit {
    /// `scatter`: the mask that decides where copies lie, see [`path::places`].
    pub(super) fn new(edit: &GroundEdit, radius_m: f64, sea_m: Option<f64>, scatter: Option<ShareAt<'_>>) -> Self {
        let radius_rad = edit.radius_km * 1000.0 / radius_m;
        let reader = match &edit.tool {
            Tool::Smooth(smooth) => Some(Reader::Smooth(Lattice::new(smooth.size * radius_rad))),
            Tool::Thermal(thermal) => Some(Reader::Smooth(Lattice::new(thermal.size * radius_rad))),
            Tool::Hydraulic(gullies) => Some(Reader::Gullies(Gullies::new(gullies, edit.seed, radius_rad, radius_m))),
            _ => None,
        };
        let depth_m = if let Some(Reader::Gullies(gullies)) = &reader { gullies.depth_m() } else { 0.0 };
        let tool = CompiledTool::new(edit, sea_m.unwrap_or(0.0), depth_m);
        let points = &edit.points.0;
        let mut arcs =
            if edit.tool.is_stamp() { path::places(edit, radius_m, scatter) } else { path::arcs(points, radius_rad) };
        match tool {
            // Most in the middle; a closed line slips evenly.
            CompiledTool::Fault { .. } => path::set_values(&mut arcs, |from, to| match from + to {
                length if length == f64::INFINITY => 1.0,
                length => 4.0 * from * to / (length * length).max(1e-30),
            }),
            CompiledTool::Coast { .. } => path::set_values(&mut arcs, |from, to| rise(from.min(to) / radius_rad).0),
            _ => {}
        }
        let has_sides = matches!(tool, CompiledTool::Fault { .. } | CompiledTool::Coast { .. });
        path::add_images(&mut arcs, edit, has_sides);
        let rough = match &edit.tool {
            Tool::Roughen(rough) => Some(Noise::new(edit.seed ^ 0x5C07, rough.wavelength_km * 1000.0 / radius_m)),
            _ => None,
        };
        let stamp = match &edit.tool {
            Tool::Picture(stamp) => Stamp::new(stamp, &arcs),
            _ => None,
        };
        let heights = arcs.iter().flat_map(|arc| arc.values);
        let heights_m = heights.fold((f64::MAX, f64::MIN), |(lo, hi), h| (lo.min(h), hi.max(h)));
        let widest = arcs.iter().flat_map(|arc| arc.widths).fold(0.0, f64::max);
        let mut compiled = Self {
            tapers: arcs.iter().flat_map(|arc| arc.widths).any(|width| width != 1.0),
            pieces: Vec::new(),
            is_stamp: edit.tool.is_stamp(),
            images: edit.image_count(),
            radius_rad,
            reach_chord: chord_of(radius_rad * tool.reach() * widest),
            core: (1.0 - edit.softness).min(0.99),
            raggedness: edit.raggedness,
            outline: (edit.raggedness > 0.0).then(|| Noise::new(edit.seed, radius_rad)),
            rough,
            stamp,
            reader,
            blend: edit.blend,
            limits: Limits::new(edit, sea_m),
            mask: edit.limiting_mask().filter(|_| !edit.is_scattered()).map(|name| EditMask::new(name, edit)),
            range: tool.range(heights_m).then(Widening::by(ROUNDING_M, ROUNDING_M)),
            context: Context::default(),
            own: 0,
            tool,
            arcs,
        };
        (compiled.own, compiled.pieces) = compiled.cut(edit);
        compiled
    }

    /// The hash of its numbers without its line, and the pieces of the line.
    fn cut(&self, edit: &GroundEdit) -> (u128, Vec<Piece>) {
        let reach_rad = self.radius_rad * self.tool.reach();
        let mut common = Hash::default();
        self.tool.hash(&mut common);
        common.add_f64(self.radius_rad);
        common.add_f64(self.core);
        common.add_f64(self.raggedness);
        common.add(u64::from(edit.seed));
        // All arcs are ordered in another way.
        common.add(u64::from(self.tapers));
        common.add(self.blend as u64);
        self.limits.hash(&mut common);
        if let Some(mask) = &self.mask {
            mask.hash(&mut common);
        }
        if let Tool::Roughen(rough) = &edit.tool {
            common.add_f64(rough.wavelength_km);
        }
        match &edit.tool {
            Tool::Smooth(smooth) => common.add_f64(smooth.size),
            Tool::Thermal(thermal) => common.add_f64(thermal.size),
            Tool::Hydraulic(gullies) => {
                common.add(u64::from(gullies.octaves));
                [gullies.spacing, gullies.steepest_deg].into_iter().for_each(|number| common.add_f64(number));
            }
            _ => {}
        }
        self.stamp.iter().flat_map(Stamp::content).for_each(|number| common.add(number));
        // Each place of a stamp acts for itself.
        let size = if self.is_stamp { 1 } else { PIECE };
        let piece = |(first, arcs): (usize, &[Arc])| {
            let middle = arcs.iter().map(|arc| arc.a + arc.b).sum::<DVec3>().normalize_or(arcs[0].a);
            let ends = arcs.iter().flat_map(|arc| [arc.a, arc.b]);
            let size = |arc: &Arc| arc.scale * arc.widths[0].max(arc.widths[1]);
            let largest = arcs.iter().map(size).fold(0.0, f64::max);
            let angle_rad =
                ends.map(|end| angle_of(end.distance_squared(middle))).fold(0.0, f64::max) + reach_rad * largest;
            let angle_rad = if angle_rad > WIDEST_RAD { std::f64::consts::PI } else { angle_rad };
            let mut hash = common;
            for number in arcs.iter().flat_map(|arc| [arc.a, arc.b]).flat_map(|end| end.to_array()) {
                hash.add_f64(number);
            }
            arcs.iter().flat_map(|arc| arc.values).for_each(|value| hash.add_f64(value));
            arcs.iter().for_each(|arc| hash.add_f64(arc.scale));
            arcs.iter().flat_map(|arc| [arc.widths, arc.strengths]).flatten().for_each(|number| hash.add_f64(number));
            if let Some(stamp) = &self.stamp {
                let axes = stamp.axes(first).iter().flat_map(DVec3::to_array);
                axes.for_each(|part| hash.add_f64(part));
            }
            let (first, count) = (first as u32, arcs.len() as u32);
            Piece { first, count, middle, chord: chord_of(angle_rad), hash: hash.0 }
        };
        // Images lie far apart.
        let image = (self.arcs.len() / self.images).max(1);
        let firsts = (0..self.arcs.len()).step_by(image).flat_map(|begin| {
            (begin..begin + image).step_by(size).map(move |first| (first, (first + size).min(begin + image)))
        });
        (common.0, firsts.map(|(first, end)| piece((first, &self.arcs[first..end]))).collect())
    }

    /// Whether the edit acts around each of its places alone.
    pub(super) fn is_stamp(&self) -> bool {
        self.is_stamp
    }

    /// Whether an arc may act on a point within a chord of a direction.
    pub(super) fn may_reach(&self, arc: u32, dir: DVec3, chord: f64) -> bool {
        let most = self.reach_chord + chord;
        self.arcs.get(arc as usize).is_some_and(|arc| arc.chord2(dir).0 <= most * most)
    }

    /// All arcs of the edit.
    pub(super) fn arcs(&self) -> &[Arc] {
        &self.arcs
    }

    /// Squared chord of the distance to which it reaches.
    pub(super) fn reach_chord2(&self) -> f64 {
        self.reach_chord * self.reach_chord
    }

    /// 1 if a direction is on the left side of the line, else -1. At a joint both arcs count: beyond a sharp bend the
    /// plane of either alone cuts through the other side.
    fn side(&self, nearest: &Nearest, dir: DVec3) -> f64 {
        let number = nearest.arc as usize;
        let arc = &self.arcs[number];
        if nearest.inside {
            return arc.side(dir);
        }
        let image = self.arcs.len() / self.images;
        let (first, last) = (number / image * image, number / image * image + image - 1);
        let other = match arc.is_nearer_to_begin(dir) {
            // The line may be closed.
            true if number == first => &self.arcs[last],
            true => &self.arcs[number - 1],
            false if number == last => &self.arcs[first],
            false => &self.arcs[number + 1],
        };
        arc.side_at_joint(other, dir)
    }

    /// The heights of a road over these of its arcs.
    fn average(&self, dir: DVec3, arcs: &[u32]) -> Average {
        let mut sum = Average::default();
        for arc in arcs.iter().map(|number| &self.arcs[*number as usize]) {
            let ((chord2, inside), taper) = (arc.chord2(dir), arc.taper(dir));
            let radius_rad = self.radius_rad * taper.width;
            let t = angle_of(chord2) / radius_rad;
            if t >= 1.0 {
                continue;
            }
            let foot = arc.foot(dir, inside);
            let (weight, by_t) = falloff(t, self.core);
            let weight_by_dir = (away(dir, foot.dir) / radius_rad - taper.width_by * (t / taper.width)) * by_t;
            let (height_m, height_by_dir) = arc.value(&foot);
            sum.weight.0 += weight;
            sum.weight.1 += weight_by_dir;
            sum.weighted_m.0 += weight * height_m;
            sum.weighted_m.1 += weight_by_dir * height_m + height_by_dir * weight;
        }
        sum
    }

    /// What the edit paints.
    pub(super) fn paint(&self) -> Option<&Paint> {
        if let CompiledTool::Paint(paint) = &self.tool { Some(paint) } else { None }
    }

    /// What it paints of the structure, if it does.
    pub(super) fn structure_paint(&self) -> Option<StructurePaint> {
        if let Some(Paint::Structure(paint)) = self.paint() { Some(*paint) } else { None }
    }

    /// How paint fades at a direction within reach.
    fn fade(&self, dir: DVec3, nearest: &Nearest) -> Fade {
        let taper = self.arcs[nearest.arc as usize].taper(dir);
        let plain = angle_of(nearest.chord2) / (self.radius_rad * taper.width);
        let ragged = self.outline.as_ref().map(|noise| noise.at(dir));
        let (stretch, by_noise) = ragged.map_or((1.0, 0.0), |noise| self.stretch(noise.value));
        let (weight, by_t) = falloff(plain * stretch, self.core);
        let by_t = by_t * taper.strength;
        let outline = ragged.map(|noise| (by_t * plain * by_noise, noise));
        Fade { weight, by_plain: by_t * stretch, plain, taper, outline }
    }

    /// The weight of paint at a direction within reach: 1 in the core, 0 from the radius on.
    pub(super) fn weight(&self, dir: DVec3, nearest: &Nearest) -> f64 {
        let fade = self.fade(dir, nearest);
        fade.weight * fade.taper.strength
    }

    /// Whether a direction within reach lies on the bed of a road, up to half-way down its sides, or on the top of a
    /// wall.
    pub(super) fn bears_nothing(&self, dir: DVec3, nearest: &Nearest) -> bool {
        let wide = match self.tool {
            CompiledTool::Road { .. } => 0.5 * (1.0 + self.core),
            CompiledTool::Wall { top, .. } => top,
            _ => return false,
        };
        let taper = self.arcs[nearest.arc as usize].taper(dir);
        let stretch = self.outline.as_ref().map_or(1.0, |noise| self.stretch(noise.at(dir).value).0);
        let away_rad = angle_of(nearest.chord2) * stretch;
        taper.strength > 0.0 && away_rad <= wide * self.radius_rad * taper.width
    }

    /// Whether the edit is the bed of a road, or a wall.
    pub(super) fn is_built(&self) -> bool {
        matches!(self.tool, CompiledTool::Road { .. } | CompiledTool::Wall { .. })
    }

    /// The weight of paint with its gradient, as the change of an effect. None where it is 0.
    pub(super) fn weighted(&self, dir: DVec3, nearest: &Nearest) -> Option<Effect<'_>> {
        let Fade { weight, by_plain, plain, taper, outline } = self.fade(dir, nearest);
        if weight * taper.strength <= 0.0 {
            return None;
        }
        let radius_rad = self.radius_rad * taper.width;
        // In the core no direction leads away from the line.
        let foot = (by_plain != 0.0).then(|| self.arcs[nearest.arc as usize].foot(dir, nearest.inside).dir);
        let outward = foot.map_or(DVec3::ZERO, |foot| away(dir, foot) * (by_plain / radius_rad));
        let along = taper.strength_by * weight - taper.width_by * (by_plain * plain / taper.width);
        Some(Effect {
            change_m: weight * taper.strength,
            by_ground: 0.0,
            by_share: weight * taper.strength,
            smooth: outward + along,
            feature_rad: radius_rad * (1.0 - self.core).max(0.1),
            ground: DVec3::ZERO,
            outline,
            rough: None,
            detail: None,
        })
    }

    /// What the edit does at a point within reach, to ground of a height, by these of its arcs. None if nothing.
    /// `read`: what it has read of the ground around. `share`: what a mask leaves of the effect.
    #[inline]
    pub(super) fn effect(
        &self,
        dir: DVec3,
        (nearest, arcs): (&Nearest, &[u32]),
        ground_m: f64,
        read: Option<Read>,
        share: f64,
    ) -> Option<Effect<'_>> {
        let arc = &self.arcs[nearest.arc as usize];
        let taper = arc.taper(dir);
        let radius_rad = self.radius_rad * arc.scale * taper.width;
        let plain = angle_of(nearest.chord2) / radius_rad;
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
        let copy = nearest.arc as usize;
        let (detail, smooth) = match (&self.stamp, read) {
            (Some(stamp), _) => {
                let stamped = stamp.at(dir, copy, arc.a, radius_rad);
                (Some((stamped.value, Detail::Picture(stamped))), None)
            }
            (None, Some(Read::Carved(carved))) => (Some((carved.height_m, Detail::Gullies(carved))), None),
            (None, Some(Read::Smooth(height_m, gradient))) => (None, Some((height_m, gradient))),
            (None, None) => (None, None),
        };
        let has_sides = matches!(self.tool, CompiledTool::Fault { .. } | CompiledTool::Coast { .. });
        let line = if has_sides {
            Some(arc.value(&arc.foot(dir, nearest.inside)))
        } else if let CompiledTool::Road { .. } = self.tool {
            let Average { weight, weighted_m } = self.average(dir, arcs);
            let height_m = weighted_m.0 / weight.0;
            (weight.0 > 0.0).then(|| (height_m, (weighted_m.1 - weight.1 * height_m) / weight.0))
        } else {
            smooth
        };
        let side = if has_sides { self.side(nearest, dir) } else { 1.0 };
        let at = At {
            ground_m,
            t,
            core: self.core,
            noise: rough.map_or(0.0, |rough| rough.value),
            line: match &detail {
                Some((value, _)) => *value,
                None if matches!(self.tool, CompiledTool::Picture { .. }) => 0.0,
                None => line.map_or(ground_m, |line| line.0),
            },
            side,
            scale: arc.scale,
        };
        let change = self.limits.applied(self.tool.change(&at).times(taper.strength * share), ground_m);
        let stays = match self.blend {
            EditBlend::Both => false,
            EditBlend::Raise => change.change_m <= 0.0,
            EditBlend::Lower => change.change_m >= 0.0,
        };
        if stays {
            return None;
        }
        let derivatives = [change.by_t, change.by_ground, change.by_line, change.by_strength];
        if change.change_m == 0.0 && derivatives == [0.0; 4] {
            return None;
        }
        // Where the edit is level, no direction leads away from its line.
        let outward = match change.by_t == 0.0 {
            true => DVec3::ZERO,
            // The foot of a point on the line tells no direction.
            false if has_sides && nearest.inside => arc.leftward(dir) * side,
            false => away(dir, arc.foot(dir, nearest.inside).dir),
        };
        let along = taper.strength_by * (change.by_strength * share)
            - taper.width_by * (change.by_t * stretch * plain / taper.width);
        let line_by_dir = line.map_or(DVec3::ZERO, |line| line.1) * change.by_line;
        let (line_by_dir, ground) =
            if smooth.is_some() { (DVec3::ZERO, line_by_dir) } else { (line_by_dir, DVec3::ZERO) };
        Some(Effect {
            change_m: change.change_m,
            by_ground: 1.0 + change.by_ground,
            by_share: change.by_strength * taper.strength,
            smooth: outward * (change.by_t * stretch / radius_rad) + line_by_dir + along,
            feature_rad: radius_rad * (1.0 - self.core).max(0.1),
            ground,
            outline: ragged.map(|noise| (change.by_t * plain * by_noise, noise)),
            rough: rough.map(|rough| (change.by_noise, rough)),
            detail: detail.map(|(_, detail)| (change.by_line, detail)),
        })
    }

    /// By how much a ragged outline brings the radius nearer, 1 to 1 + 4 times the raggedness; its derivative by the
    /// noise. The cube makes few deep bays of many shallow ones.
    fn stretch(&self, noise: f64) -> (f64, f64) {
        let share = 0.5 + 0.5 * noise / outline::MOST;
        let (cube, by_noise) = (share * share * share, 1.5 * share * share / outline::MOST);
        (1.0 + 4.0 * self.raggedness * cube, 4.0 * self.raggedness * by_noise)
    }
}
