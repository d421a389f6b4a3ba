//! Ground edits, compiled: strokes, stamps and splines that change the height of the joined layers.
//!
//! - `path`: the line through the points of an edit, and the nearest place of it
//! - `tool`: the tools, one file each: what each does to a height, with derivatives and bounds
//! - `widening`: what edits do to the bounds of heights
//! - `reading`: what edits read besides: the ground around a point, as the edits before left it
//! - `smooth`: ground without fine detail, around a point
//! - `gullies`: gullies down the slopes of that ground
//! - `memory`: what those have found out, node by node
//! - `stamp`: height pictures as stamps
//! - `paint`: painted climate and clouds
//! - `mask`: painted masks of layers and of other edits
//! - `life`: painted life, and what roads and walls clear
//! - `scatter`: copies of stamps whose places follow a mask
//! - `limits`: heights to which an edit is limited
//! - `structural`: paint of a structure, and rivers whose courses are drawn
//! - `outline`: noise for ragged outlines and rough ground
//! - `compiled`: one edit: its tool, its line, the pieces of that line
//! - `roster`: the edits that are on, in order, from one revision to the next
//! - `index`: which pieces are near a point, a tile or a disc
//! - `leaves`: points by the leaves of the index that hold them
//! - `context`: what edits that read the ground depend on
//! - `near`: the parts of them that may act on a run of points
//! - `nearest`: the nearest arc of an edit
//!
//! Edits act in order at each point. One loop over points in f64 serves queries and tiles alike, with basic operations
//! and `libm` alone, so heights are the same bits on every machine and instruction set. A point looks only at the
//! pieces in its leaf of the index: thousands of edits cost what the few near the point cost.

mod compiled;
mod context;
mod gullies;
mod index;
mod leaves;
mod life;
mod limits;
mod mask;
mod memory;
mod near;
mod nearest;
mod outline;
mod paint;
mod path;
mod reading;
mod roster;
mod scatter;
mod smooth;
mod stamp;
mod structural;
mod tool;
mod widening;

use super::field::Components;
use super::height::Heights;
use crate::planet::edits::Shared;
use crate::planet::{GroundEdits, Key, Planet, Tool};
use crate::sphere::NodeId;
use crate::world::DrawnCourse;
use compiled::CompiledEdit;
use glam::DVec3;
pub(crate) use index::chord_of;
use index::{Index, Piece};
pub(crate) use life::{Placed, Planting, PopulationId};
pub(crate) use mask::MaskId;
pub(crate) use memory::Memory;
pub(crate) use near::Near;
use near::{Hit, Touch};
pub(crate) use paint::Painted;
use paint::{Paint, Places};
use reading::Reader;
pub(crate) use reading::Surrounded;
use roster::{Changes, Roster, slot_of};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use widening::Widening;

/// Edits around a place that read the ground, beyond which its bounds are those of the planet.
const MOST_READING: usize = 16;

/// Subject that edits change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Subject {
    Ground,
    /// Climate, and the climates of the biomes that are painted.
    Climate,
    Clouds,
    /// Painted masks of layers and of other edits.
    Masks,
    /// What stands on the ground.
    Life,
    /// Structure, and rivers whose courses are drawn.
    Structure,
}

impl Subject {
    /// All subjects, in the order of their indices.
    const ALL: [Self; 6] = [Self::Ground, Self::Climate, Self::Clouds, Self::Masks, Self::Life, Self::Structure];
}

/// The edits of a planet that are on, compiled.
#[derive(Clone)]
pub(crate) struct Edits {
    /// What they were compiled from.
    world: World,
    list: GroundEdits,
    roster: Roster,
    /// Pieces of the edits of each subject.
    indices: [Index; Subject::ALL.len()],
    /// Whether a painted mask limits one of them, for each subject.
    masked: [bool; Subject::ALL.len()],
    places: Places,
    courses: Vec<DrawnCourse>,
    /// Pieces of the edits that read the ground around a point.
    reading: Index,
}

/// The edits that act: from the one in a slot on, and before the one in another.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Span {
    pub(crate) from: Option<u32>,
    pub(crate) before: Option<u32>,
}

impl fmt::Debug for Edits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut tuple = f.debug_tuple("Edits");
        tuple.field(&self.index(Subject::Ground).key_of_all());
        let others = [Subject::Climate, Subject::Clouds, Subject::Structure, Subject::Masks, Subject::Life];
        for subject in others {
            tuple.field(&self.key(subject));
        }
        tuple.finish()
    }
}

/// What compiled edits depend on besides the edits.
#[derive(Clone, Copy, Debug, PartialEq)]
struct World {
    radius_m: f64,
    sea_m: Option<f64>,
}

impl Edits {
    /// The edits of a planet, after those of an earlier revision: most of them are the same. None if none is on.
    pub(crate) fn new(planet: &Planet, before: Option<&Arc<Self>>) -> Option<Arc<Self>> {
        if planet.edits.is_empty() {
            return None;
        }
        let world = World { radius_m: planet.radius_m(), sea_m: planet.sea_level_m() };
        let edits = match before.filter(|before| before.world == world) {
            Some(same) if same.list.is_same(&planet.edits) => same.over(planet),
            Some(before) => Arc::new(before.next(planet)),
            None => Arc::new(Self::none(world).next(planet)),
        };
        (edits.roster.len() > 0).then_some(edits)
    }

    fn none(world: World) -> Self {
        Self {
            world,
            list: GroundEdits::default(),
            roster: Roster::default(),
            indices: Default::default(),
            masked: Default::default(),
            places: Places::default(),
            courses: Vec::new(),
            reading: Index::default(),
        }
    }

    /// The edits of the next revision.
    fn next(&self, planet: &Planet) -> Self {
        profiling::scope!("compile edits");
        let (world, list) = (self.world, planet.edits.clone());
        let compile =
            |shared: &Arc<Shared>| Arc::new(CompiledEdit::new(&shared.edit, world.radius_m, world.sea_m, None));
        let (mut roster, mut changes) = self.roster.next(&planet.edits, compile);
        let next = |subject: Subject, roster: &Roster, changes: &Changes| {
            self.index(subject).next(roster, changes, |edit| edit.changes(subject))
        };
        let masks = next(Subject::Masks, &roster, &changes);
        scatter::refresh(&mut roster, &mut changes, &masks, world);
        let mut indices = Subject::ALL.map(|subject| next(subject, &roster, &changes));
        let courses =
            if changes.is_empty() { self.courses.clone() } else { structural::courses_of(&roster, world.radius_m) };
        // What reads the ground depends on the edits before it.
        let later = context::refresh(&mut roster, [&indices[Subject::Ground as usize], &masks], &changes);
        if !later.is_empty() {
            let ground = &mut indices[Subject::Ground as usize];
            *ground = ground.next(&roster, &later, |edit| edit.changes(Subject::Ground));
        }
        let places = self.places.next(planet, painted_biomes(planet, &indices[Subject::Climate as usize]));
        let reading = self.reading.next(&roster, &changes, |edit| edit.reader().is_some());
        let masked =
            Subject::ALL.map(|subject| roster.edits().any(|edit| edit.mask.is_some() && edit.changes(subject)));
        Self { world, list, roster, indices, masked, places, courses, reading }
    }

    /// The pieces of the edits of a subject.
    fn index(&self, subject: Subject) -> &Index {
        &self.indices[subject as usize]
    }

    /// Edits for a planet that differs in its biome table at most.
    fn over(self: &Arc<Self>, planet: &Planet) -> Arc<Self> {
        let places = self.places.next(planet, painted_biomes(planet, self.index(Subject::Climate)));
        if places == self.places {
            return self.clone();
        }
        Arc::new(Self { places, ..self.as_ref().clone() })
    }

    /// The memory of edits that read ground which has this key before all edits, after that of an earlier terrain.
    pub(crate) fn memory(&self, ground: Key, before: &Arc<Memory>) -> Arc<Memory> {
        if self.reading.is_empty() {
            return Arc::default();
        }
        let lattices = self.roster.reading().flat_map(|(_, edit)| {
            let key = edit.lattice_key();
            std::iter::once(key).chain((0..gullies::MOST_OCTAVES).map(move |k| gullies::lattice_of(key, k)))
        });
        Memory::after(before, ground, &lattices.collect())
    }

    /// The key of all edits of a subject. None if there is none. Files of world maps hold that of the structure.
    pub(crate) fn key(&self, subject: Subject) -> Option<Key> {
        let index = self.index(subject);
        let (key, is_none) = match subject {
            Subject::Climate => (Key::of(&(index.key_of_all(), &self.places.places)), index.is_empty()),
            Subject::Structure => {
                (Key::of(&(index.key_of_all(), &self.courses)), index.is_empty() && self.courses.is_empty())
            }
            _ => (index.key_of_all(), index.is_empty()),
        };
        (!is_none).then(|| self.with_masks(key, subject, || self.key(Subject::Masks)))
    }

    /// The key of the edits of a subject that touch a node and the ground close around it. None if none does.
    pub(crate) fn key_near(&self, subject: Subject, id: NodeId) -> Option<Key> {
        let key = self.index(subject).key_near(id, &self.roster)?;
        let key = if subject == Subject::Climate { Key::of(&(key, &self.places.places)) } else { key };
        Some(self.with_masks(key, subject, || self.key_near(Subject::Masks, id)))
    }

    /// A key of edits of a subject with that of the masks, if masks limit some of them.
    fn with_masks(&self, key: Key, subject: Subject, masks: impl FnOnce() -> Option<Key>) -> Key {
        if !self.masked[subject as usize] {
            return key;
        }
        masks().map_or(key, |masks| Key::of(&(key, masks)))
    }

    /// The ranks of the edits of a span.
    fn ranks(&self, span: Span) -> Range<u32> {
        let rank_of = |slot: u32| self.roster.rank_of(slot);
        span.from.map_or(0, rank_of)..span.before.map_or(u32::MAX, rank_of)
    }

    /// Changes the heights of points, and their gradients for each of the spacings, by a span of edits.
    /// `surrounded`: what these edits need around the points, see [`Edits::surroundings`].
    pub(crate) fn apply(
        &self,
        dirs: &[DVec3],
        spacings_rad: &[f64],
        heights: &mut Heights,
        limits_m: (f64, f64),
        near: &mut Near,
        (surrounded, span): (&Surrounded, Span),
    ) {
        let ranks = self.ranks(span);
        let acts = |slot: u32, _: &CompiledEdit| ranks.contains(&self.roster.rank_of(slot));
        near.each_touch(self.index(Subject::Ground), &self.roster, dirs, acts, |Touch { slot, edit, arcs, hits }| {
            let around = surrounded.of(slot);
            let shares = self.shares(edit, hits.iter().map(|hit| dirs[hit.point]), spacings_rad);
            for (own, Hit { point: i, nearest }) in hits.iter().enumerate() {
                let (i, dir, share) = (*i, dirs[*i], shares.of(own));
                if share <= 0.0 {
                    continue;
                }
                let Some(effect) = edit.effect(dir, (nearest, arcs), heights.height_m[i], around, share) else {
                    continue;
                };
                let changed_m = heights.height_m[i] + effect.change_m;
                heights.height_m[i] = changed_m.clamp(limits_m.0, limits_m.1);
                let is_limit = heights.height_m[i] != changed_m;
                let masks = shares.gradients(own).iter().copied().chain(std::iter::repeat(DVec3::ZERO));
                for ((gradient, &spacing_rad), mask) in heights.gradients.iter_mut().zip(spacings_rad).zip(masks) {
                    let before = components(gradient, i) * effect.by_ground;
                    let after = before + effect.gradient(spacing_rad) + mask * effect.by_share;
                    set_components(gradient, i, if is_limit { DVec3::ZERO } else { after });
                }
            }
        });
    }

    /// Calls `each` with the points within reach of edits of a subject: the number of a point, the edit, the weight of
    /// its paint there, and the share that a mask leaves of it. `wanted`: which edits count.
    fn each_weight(
        &self,
        subject: Subject,
        dirs: &[DVec3],
        near: &mut Near,
        wanted: impl Fn(&CompiledEdit) -> bool,
        mut each: impl FnMut(usize, &CompiledEdit, f64, f64),
    ) {
        let counts = |_: u32, edit: &CompiledEdit| wanted(edit);
        near.each_touch(self.index(subject), &self.roster, dirs, counts, |Touch { edit, hits, .. }| {
            let shares = self.shares(edit, hits.iter().map(|hit| dirs[hit.point]), &[]);
            for (own, Hit { point: i, nearest }) in hits.iter().enumerate() {
                each(*i, edit, edit.weight(dirs[*i], nearest), shares.of(own));
            }
        });
    }

    /// The paint of the climate at points; nothing if there is none at any.
    pub(crate) fn painted(&self, dirs: &[DVec3], near: &mut Near, painted: &mut Vec<Painted>) {
        painted.clear();
        if self.index(Subject::Climate).is_empty() {
            return;
        }
        self.each_weight(
            Subject::Climate,
            dirs,
            near,
            |_| true,
            |i, edit, weight, share| {
                if let Some(paint) = edit.paint().filter(|_| weight * share > 0.0) {
                    painted.resize(dirs.len(), Painted::NONE);
                    paint.apply(&mut painted[i], weight * share, |key| self.places.of(key));
                }
            },
        );
    }

    /// By how much paint changes the log-odds of the cover of clouds at points: calls `each` with the number of a point
    /// and the change.
    pub(crate) fn clouded(&self, dirs: &[DVec3], near: &mut Near, mut each: impl FnMut(usize, f64)) {
        self.each_weight(
            Subject::Clouds,
            dirs,
            near,
            |_| true,
            |i, edit, weight, share| {
                if let Some(Paint::Clouds { odds }) = edit.paint() {
                    each(i, odds * weight * share);
                }
            },
        );
    }

    /// Whether paint of the climate may be at one of these points.
    pub(crate) fn may_paint(&self, dirs: &[DVec3], near: &mut Near) -> bool {
        !self.index(Subject::Climate).is_empty() && near.holds_any(self.index(Subject::Climate), dirs)
    }

    /// Whether edits of the ground reach each of some points.
    #[cfg(feature = "bake")]
    pub(crate) fn reached(&self, dirs: &[DVec3]) -> Vec<bool> {
        let mut reached = vec![false; dirs.len()];
        let (ground, all) = (self.index(Subject::Ground), |_: u32, _: &CompiledEdit| true);
        Near::default().each_touch(ground, &self.roster, dirs, all, |Touch { hits, .. }| {
            hits.iter().for_each(|hit| reached[hit.point] = true);
        });
        reached
    }

    /// A disc that holds all ground that edits reach: its middle and its angle. None if there is none.
    #[cfg(feature = "bake")]
    pub(crate) fn disc(&self) -> Option<(DVec3, f64)> {
        let pieces = || self.roster.edits().filter(|edit| edit.changes(Subject::Ground)).flat_map(|edit| &edit.pieces);
        let middle = pieces().map(|piece| piece.middle).sum::<DVec3>().try_normalize()?;
        let reach_rad = |piece: &Piece| middle.angle_between(piece.middle) + path::angle_of(piece.chord * piece.chord);
        Some((middle, pieces().map(reach_rad).fold(0.0, f64::max)))
    }

    /// How far from a place the ground lies, as an angle, that decides about the ground within an angle of it: farther
    /// where edits read the ground.
    pub(crate) fn reach_rad(&self, dir: DVec3, angle_rad: f64) -> f64 {
        let (mut reach_rad, mut counted) = (angle_rad, Vec::new());
        if self.reading.is_empty() {
            return angle_rad;
        }
        loop {
            let before = counted.len();
            let disc = (dir, index::chord_of(reach_rad));
            self.index(Subject::Ground).each_leaf(Some(disc), &mut |pieces| {
                for &number in pieces {
                    let slot = slot_of(number);
                    let reader = self.roster.edit(slot).and_then(|edit| edit.reader());
                    let touches = self.roster.piece(number).is_some_and(|piece| piece.touches(disc.0, disc.1));
                    if let Some(reader) = reader.filter(|_| touches && !counted.contains(&slot)) {
                        counted.push(slot);
                        reach_rad += Reader::reach_rad(reader);
                    }
                }
            });
            if counted.len() > MOST_READING || reach_rad >= std::f64::consts::PI {
                return std::f64::consts::PI;
            }
            if counted.len() == before {
                return reach_rad;
            }
        }
    }

    /// Widens the lowest and greatest height of the layers by what the edits do within an angle of a direction (None:
    /// anywhere). Conservative.
    pub(crate) fn bounds_m(&self, (lo, hi): (f64, f64), near: Option<(DVec3, f64)>) -> (f64, f64) {
        if near.is_none() && self.reading.is_empty() {
            return self.index(Subject::Ground).range().of((lo, hi));
        }
        let near = near.map(|(dir, angle_rad)| (dir, index::chord_of(angle_rad)));
        let is_near = |piece: &Piece| near.is_none_or(|(dir, chord)| piece.touches(dir, chord));
        if !self.reading.is_empty() {
            // Smooth ground is a mean of the ground of several leaves: all edits count as if they were at one place.
            let mut pieces = Vec::new();
            self.index(Subject::Ground).each_leaf(near, &mut |leaf| pieces.extend_from_slice(leaf));
            pieces.sort_unstable_by_key(|number| self.roster.rank(*number));
            pieces.dedup();
            return index::range_of(&pieces, &self.roster, is_near).of((lo, hi));
        }
        let mut range = Widening::default();
        self.index(Subject::Ground)
            .each_leaf(near, &mut |pieces| range = range.or(index::range_of(pieces, &self.roster, is_near)));
        range.of((lo, hi))
    }
}

/// The keys of the biomes that strokes paint, in order.
fn painted_biomes(planet: &Planet, climate: &Index) -> Vec<char> {
    if climate.is_empty() {
        return Vec::new();
    }
    let keys = planet.edits.iter().filter_map(|edit| match &edit.tool {
        Tool::Biome(paint) if edit.enabled => Some(paint.biome),
        _ => None,
    });
    keys.collect::<std::collections::BTreeSet<char>>().into_iter().collect()
}

fn components(gradient: &Components, i: usize) -> DVec3 {
    DVec3::from_array(gradient.each_ref().map(|component| f64::from(component[i])))
}

/// Thousands of edits at a place can multiply a slope beyond all numbers.
const STEEPEST: f64 = 1e30;

fn set_components(gradient: &mut Components, i: usize, value: DVec3) {
    for (component, value) in gradient.iter_mut().zip(value.to_array()) {
        component[i] = value.clamp(-STEEPEST, STEEPEST) as f32;
    }
}
