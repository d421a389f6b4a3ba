//! One edit, compiled: its tool, its line, and the pieces of that line.

use super::Subject;
use super::context::Context;
use super::index::{Hash, Piece, chord_of};
use super::limits::Limits;
use super::mask::{EditMask, ShareAt};
use super::nearest::Nearest;
use super::outline::{self, Noise, Sampled};
use super::paint::Paint;
use super::path::{self, Arc, Taper, angle_of, away};
use super::reading::{Reader, Reads, Sample, Slope, Surroundings};
use super::tool::{At, BY_GROUND, BY_READ, BY_STRENGTH, BY_T, Dual, EditTool, Site, Task, falloff};
use super::widening::Widening;
use crate::planet::GroundEdit;
use crate::planet::edits::EditBlend;
use crate::terrain::jet::Jet;
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
    task: Task,
    /// Quantity that the tool reads besides the ground under a point.
    reads: Reads,
    arcs: Vec<Arc>,
    pub(super) pieces: Vec<Piece>,
    is_stamp: bool,
    radius_rad: f64,
    /// Radii to which it reaches.
    reach: f64,
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

/// A point by the line of an edit.
struct Place {
    taper: Taper,
    radius_rad: f64,
    /// Distance in radii, before the outline is ragged.
    plain: f64,
    /// Factor on the distance by a ragged outline, and its derivative by the noise.
    stretch: (f64, f64),
    ragged: Option<Sampled>,
    /// 1 on the left side of a line with two sides, -1 on its right, 1 elsewhere.
    side: f64,
}

impl Place {
    /// Distance in radii.
    #[inline(always)]
    fn t(&self) -> f64 {
        self.plain * self.stretch.0
    }
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
    /// Derivative by the noise of the outline.
    outline: Option<(f64, Sampled)>,
    /// Derivative by what the tool reads, which changes within the reach of the edit, and its gradient.
    read: (f64, Slope<'a>),
}

impl Effect<'_> {
    /// The gradient by the direction that points so far apart can show.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        let outline = self.outline.as_ref();
        let outline = outline.map_or(DVec3::ZERO, |(by_noise, noise)| noise.gradient(spacing_rad) * *by_noise);
        let seen = outline::seen(self.feature_rad, spacing_rad, LEAST_POINTS);
        let (by_read, slope) = &self.read;
        self.smooth * seen + outline * seen + slope.gradient(spacing_rad) * *by_read
    }
}

impl CompiledEdit {
    /// `scatter`: the mask that decides where copies lie, see [`path::places`].
    pub(super) fn new(edit: &GroundEdit, radius_m: f64, sea_m: Option<f64>, scatter: Option<ShareAt<'_>>) -> Self {
        let site = Site { edit, radius_m, sea_m: sea_m.unwrap_or(0.0) };
        let radius_rad = site.radius_rad();
        let task = Task::new(&site);
        let points = &edit.points.0;
        let mut arcs =
            if edit.tool.is_stamp() { path::places(edit, radius_m, scatter) } else { path::arcs(points, radius_rad) };
        let value_of_sides = task.tool().and_then(EditTool::value_of_sides);
        if let Some(value) = value_of_sides {
            path::set_values(&mut arcs, |from, to| value([from, to], radius_rad));
        }
        path::add_images(&mut arcs, edit, value_of_sides.is_some());
        let reads = match task.tool() {
            Some(_) if value_of_sides.is_some() => Reads::Sides,
            Some(tool) => tool.reads(&site, &arcs),
            None => Reads::Nothing,
        };
        let heights = arcs.iter().flat_map(|arc| arc.values);
        let heights_m = heights.fold((f64::MAX, f64::MIN), |(lo, hi), h| (lo.min(h), hi.max(h)));
        let widest = arcs.iter().flat_map(|arc| arc.widths).fold(0.0, f64::max);
        let reach = task.reach();
        let range = task.tool().map_or_else(Widening::default, |tool| tool.range(heights_m));
        let mut compiled = Self {
            tapers: arcs.iter().flat_map(|arc| arc.widths).any(|width| width != 1.0),
            pieces: Vec::new(),
            is_stamp: edit.tool.is_stamp(),
            images: edit.image_count(),
            radius_rad,
            reach,
            reach_chord: chord_of(radius_rad * reach * widest),
            core: (1.0 - edit.softness).min(0.99),
            raggedness: edit.raggedness,
            outline: (edit.raggedness > 0.0).then(|| Noise::new(edit.seed, radius_rad)),
            blend: edit.blend,
            limits: Limits::new(edit, sea_m),
            mask: edit.limiting_mask().filter(|_| !edit.is_scattered()).map(|name| EditMask::new(name, edit)),
            range: range.then(Widening::by(ROUNDING_M, ROUNDING_M)),
            context: Context::default(),
            own: 0,
            task,
            reads,
            arcs,
        };
        (compiled.own, compiled.pieces) = compiled.cut(edit);
        compiled
    }

    /// The hash of its numbers without its line, and the pieces of the line.
    fn cut(&self, edit: &GroundEdit) -> (u128, Vec<Piece>) {
        let reach_rad = self.radius_rad * self.reach;
        let mut common = Hash::default();
        self.task.hash(&mut common);
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
            if let Reads::Picture(Some(stamp)) = &self.reads {
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

    /// The heights of a line over these of its arcs: their mean by weight. None where they have none.
    fn average(&self, dir: DVec3, arcs: &[u32]) -> Option<(f64, DVec3)> {
        let (mut weights, mut sum_m) = ((0.0, DVec3::ZERO), (0.0, DVec3::ZERO));
        for arc in arcs.iter().map(|number| &self.arcs[*number as usize]) {
            let ((chord2, inside), taper) = (arc.chord2(dir), arc.taper(dir));
            let radius_rad = self.radius_rad * taper.width;
            let t = angle_of(chord2) / radius_rad;
            if t >= 1.0 {
                continue;
            }
            let foot = arc.foot(dir, inside);
            let Jet { v: weight, d: [by_t] } = falloff(Jet::<f64, 1>::variable(t, 0), self.core);
            let weight_by_dir = (away(dir, foot.dir) / radius_rad - taper.width_by * (t / taper.width)) * by_t;
            let (height_m, height_by_dir) = arc.value(&foot);
            weights.0 += weight;
            weights.1 += weight_by_dir;
            sum_m.0 += weight * height_m;
            sum_m.1 += weight_by_dir * height_m + height_by_dir * weight;
        }
        let height_m = sum_m.0 / weights.0;
        (weights.0 > 0.0).then(|| (height_m, (sum_m.1 - weights.1 * height_m) / weights.0))
    }

    /// How the edit reads the ground around a point, if it does.
    pub(super) fn reader(&self) -> Option<&Reader> {
        if let Reads::Around(reader) = &self.reads { Some(reader) } else { None }
    }

    /// What the edit paints.
    pub(super) fn paint(&self) -> Option<&Paint> {
        if let Task::Paint(paint) = &self.task { Some(paint) } else { None }
    }

    /// The place of a direction by the line. None out of reach.
    #[inline(always)]
    fn place(&self, dir: DVec3, nearest: &Nearest) -> Option<Place> {
        let arc = &self.arcs[nearest.arc as usize];
        let taper = arc.taper(dir);
        let radius_rad = self.radius_rad * arc.scale * taper.width;
        let plain = angle_of(nearest.chord2) / radius_rad;
        if plain >= self.reach {
            return None;
        }
        // A ragged outline is nearer than the radius, never farther.
        let ragged = self.outline.as_ref().map(|noise| noise.at(dir));
        let stretch = ragged.map_or((1.0, 0.0), |noise| self.stretch(noise.value));
        let side = if let Reads::Sides = self.reads { self.side(nearest, dir) } else { 1.0 };
        let place = Place { taper, radius_rad, plain, stretch, ragged, side };
        (place.t() < self.reach).then_some(place)
    }

    /// The weight of paint at a direction within reach: 1 in the core, 0 from the radius on. Of a road or a wall: 1
    /// where nothing stands.
    pub(super) fn weight(&self, dir: DVec3, nearest: &Nearest) -> f64 {
        let Some(place) = self.place(dir, nearest) else { return 0.0 };
        match self.bare() {
            Some(bare) => f64::from(u8::from(place.taper.strength > 0.0 && place.t() <= bare)),
            None => falloff(Jet::<f64, 0>::constant(place.t()), self.core).v * place.taper.strength,
        }
    }

    /// Share of the radius on which nothing stands, of a road or a wall.
    fn bare(&self) -> Option<f64> {
        self.task.tool().and_then(|tool| tool.bare(self.core))
    }

    /// Whether nothing stands on it.
    pub(super) fn is_built(&self) -> bool {
        self.bare().is_some()
    }

    /// Whether it changes a subject.
    pub(super) fn changes(&self, subject: Subject) -> bool {
        match (&self.task, subject) {
            (Task::Ground(_), Subject::Ground) => true,
            (Task::Ground(_), Subject::Life) => self.is_built(),
            (Task::Ground(_), _) => false,
            (Task::Paint(paint), _) => paint.subject() == Some(subject),
        }
    }

    /// The weight of paint with its gradient, as the change of an effect. None where it is 0.
    pub(super) fn weighted(&self, dir: DVec3, nearest: &Nearest) -> Option<Effect<'_>> {
        let place = self.place(dir, nearest)?;
        let weight = falloff(Dual::variable(place.t(), BY_T), self.core);
        let weight = weight * Dual::variable(place.taper.strength, BY_STRENGTH);
        (weight.v > 0.0).then(|| self.effect_of((dir, nearest), &place, weight, 1.0, Slope::None))
    }

    /// What the edit does at a point within reach, to ground of a height, by these of its arcs. None if nothing.
    /// `around`: the ground around, if it reads that. `share`: what a mask leaves of the effect.
    #[inline]
    pub(super) fn effect(
        &self,
        dir: DVec3,
        (nearest, arcs): (&Nearest, &[u32]),
        ground_m: f64,
        around: Option<&Surroundings>,
        share: f64,
    ) -> Option<Effect<'_>> {
        let tool = self.task.tool()?;
        let place = self.place(dir, nearest)?;
        let Sample { value, slope } = self.read((dir, nearest), arcs, place.radius_rad, around)?;
        let at = At {
            ground_m: Dual::variable(ground_m, BY_GROUND),
            t: Dual::variable(place.t(), BY_T),
            core: self.core,
            read: Dual::variable(value, BY_READ),
            side: place.side,
            scale: self.arcs[nearest.arc as usize].scale,
        };
        let change_m = tool.change_m(&at) * Dual::variable(place.taper.strength * share, BY_STRENGTH);
        let change_m = self.limits.applied(change_m, at.ground_m);
        let stays = match self.blend {
            EditBlend::Both => change_m == Dual::constant(0.0),
            EditBlend::Raise => change_m.v <= 0.0,
            EditBlend::Lower => change_m.v >= 0.0,
        };
        (!stays).then(|| self.effect_of((dir, nearest), &place, change_m, share, slope))
    }

    /// The quantity that the tool reads at a point. None where there is none.
    #[inline(always)]
    fn read(
        &self,
        (dir, nearest): (DVec3, &Nearest),
        arcs: &[u32],
        radius_rad: f64,
        around: Option<&Surroundings>,
    ) -> Option<Sample<'_>> {
        let arc = &self.arcs[nearest.arc as usize];
        let line = |(value, gradient)| Sample { value, slope: Slope::Line(gradient) };
        match &self.reads {
            Reads::Nothing => Some(Sample { value: 0.0, slope: Slope::None }),
            Reads::Sides => Some(line(arc.value(&arc.foot(dir, nearest.inside)))),
            Reads::Heights => self.average(dir, arcs).map(line),
            Reads::Noise(noise) => {
                let noise = noise.at(dir);
                Some(Sample { value: noise.value, slope: Slope::Noise(noise) })
            }
            Reads::Picture(stamp) => {
                let stamped = stamp.as_ref()?.at(dir, nearest.arc as usize, arc.a, radius_rad);
                Some(Sample { value: stamped.value, slope: Slope::Picture(stamped) })
            }
            Reads::Around(reader) => around.map(|around| reader.at(dir, around)),
        }
    }

    /// The effect of a change at a place.
    #[inline(always)]
    fn effect_of<'a>(
        &self,
        (dir, nearest): (DVec3, &Nearest),
        place: &Place,
        change: Dual,
        share: f64,
        slope: Slope<'a>,
    ) -> Effect<'a> {
        let (arc, taper, by_t) = (&self.arcs[nearest.arc as usize], &place.taper, change.d[BY_T]);
        // Where the edit is level, no direction leads away from its line.
        let outward = match (by_t == 0.0, &self.reads) {
            (true, _) => DVec3::ZERO,
            // The foot of a point on the line tells no direction.
            (false, Reads::Sides) if nearest.inside => arc.leftward(dir) * place.side,
            _ => away(dir, arc.foot(dir, nearest.inside).dir),
        };
        let (stretch, by_noise) = place.stretch;
        let along = taper.strength_by * (change.d[BY_STRENGTH] * share)
            - taper.width_by * (by_t * stretch * place.plain / taper.width);
        let line = if let Slope::Line(gradient) = slope { gradient * change.d[BY_READ] } else { DVec3::ZERO };
        Effect {
            change_m: change.v,
            by_ground: 1.0 + change.d[BY_GROUND],
            by_share: change.d[BY_STRENGTH] * taper.strength,
            smooth: outward * (by_t * stretch / place.radius_rad) + line + along,
            feature_rad: place.radius_rad * (1.0 - self.core).max(0.1),
            outline: place.ragged.map(|noise| (by_t * place.plain * by_noise, noise)),
            read: (change.d[BY_READ], slope),
        }
    }

    /// By how much a ragged outline brings the radius nearer, 1 to 1 + 4 times the raggedness; its derivative by the
    /// noise. The cube makes few deep bays of many shallow ones.
    #[inline(always)]
    fn stretch(&self, noise: f64) -> (f64, f64) {
        let share = 0.5 + 0.5 * noise / outline::MOST;
        let (cube, by_noise) = (share * share * share, 1.5 * share * share / outline::MOST);
        (1.0 + 4.0 * self.raggedness * cube, 4.0 * self.raggedness * by_noise)
    }
}
