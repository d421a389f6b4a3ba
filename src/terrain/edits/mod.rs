//! Ground edits, compiled: strokes, stamps and splines that change the height of the joined layers.
//!
//! - `path`: the line through the points of an edit, and the nearest place of it
//! - `tool`: what each tool does to a height, with derivatives and bounds
//! - `widening`: what edits do to the bounds of heights
//! - `reading`: edits that read the ground around a point
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
use reading::{ReadBy, Reader};
use roster::{Roster, slot_of};
use std::fmt;
use std::sync::Arc;
use widening::Widening;

/// Edits around a place that read the ground, beyond which its bounds are those of the planet.
const MOST_READING: usize = 16;

/// The edits of a planet that are on, compiled.
#[derive(Clone)]
pub(crate) struct Edits {
    /// What they were compiled from.
    world: World,
    list: GroundEdits,
    roster: Roster,
    /// Those that change the ground.
    ground: Index,
    /// Those that paint the climate, and the climates of the biomes that they paint.
    climate: Index,
    places: Places,
    /// Those that paint clouds.
    clouds: Index,
    /// Those that paint masks of layers.
    masks: Index,
    /// Those that change what stands on the ground.
    life: Index,
    /// Those that paint the structure, and rivers whose courses are drawn.
    structural: Index,
    courses: Vec<DrawnCourse>,
    key: Key,
    /// Whether an edit reads the ground around a point.
    reads: bool,
    masked: Masked,
}

/// Which edits painted masks limit: whether one of the ground, of the climate, of clouds, of the structure, of life.
#[derive(Clone, Copy, Debug, Default)]
struct Masked {
    ground: bool,
    climate: bool,
    clouds: bool,
    structure: bool,
    life: bool,
}

impl Masked {
    fn of(roster: &Roster) -> Self {
        let mut masked = Self::default();
        for edit in roster.edits().filter(|edit| edit.mask.is_some()) {
            match edit.paint() {
                None => masked.ground = true,
                Some(Paint::Clouds { .. }) => masked.clouds = true,
                Some(Paint::Structure(_)) => masked.structure = true,
                Some(Paint::Life { .. } | Paint::Object { .. }) => {}
                Some(_) => masked.climate = true,
            }
            masked.life |= edit.is_life();
        }
        masked
    }
}

/// Heights at directions as the edits before the one in a slot left them. They may begin where an earlier edit began.
type Before<'a> = dyn Fn(u32, &[DVec3], Option<&Begun>) -> Vec<f64> + 'a;

/// The ground before an edit, for those that read it around a point.
pub(crate) struct Ground<'a> {
    pub(crate) before: &'a Before<'a>,
    pub(crate) memory: &'a Memory,
}

/// The ground before an earlier edit, from which that before a later one is evaluated.
pub(crate) struct Begun {
    /// The slot of the earlier edit.
    pub(crate) slot: u32,
    /// Heights at the same points.
    pub(crate) heights_m: Vec<f64>,
}

/// The edits that act: from the one in a slot on, and before the one in another.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Span {
    pub(crate) from: Option<u32>,
    pub(crate) before: Option<u32>,
}

impl fmt::Debug for Edits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Edits")
            .field(&self.key)
            .field(&self.paint_key())
            .field(&self.cloud_key())
            .field(&self.structure_key())
            .field(&self.mask_key())
            .field(&self.life_key())
            .finish()
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
        let ground = Index::default();
        let key = ground.key_of_all();
        Self {
            world,
            list: GroundEdits::default(),
            roster: Roster::default(),
            ground,
            climate: Index::default(),
            clouds: Index::default(),
            masks: Index::default(),
            life: Index::default(),
            structural: Index::default(),
            courses: Vec::new(),
            places: Places::default(),
            key,
            reads: false,
            masked: Masked::default(),
        }
    }

    /// Those of the next revision.
    fn next(&self, planet: &Planet) -> Self {
        profiling::scope!("compile edits");
        let (world, list) = (self.world, planet.edits.clone());
        let compile =
            |shared: &Arc<Shared>| Arc::new(CompiledEdit::new(&shared.edit, world.radius_m, world.sea_m, None));
        let (mut roster, mut changes) = self.roster.next(&planet.edits, compile);
        let masks = self.masks.next(&roster, &changes, |edit| edit.paint().is_some_and(Paint::is_mask));
        scatter::refresh(&mut roster, &mut changes, &masks, world);
        let is_ground = |edit: &CompiledEdit| edit.paint().is_none();
        let mut ground = self.ground.next(&roster, &changes, is_ground);
        let climate = self.climate.next(&roster, &changes, |edit| edit.paint().is_some_and(Paint::is_climate));
        let clouds = self.clouds.next(&roster, &changes, |edit| matches!(edit.paint(), Some(Paint::Clouds { .. })));
        let life = self.life.next(&roster, &changes, CompiledEdit::is_life);
        let structural = self.structural.next(&roster, &changes, |edit| edit.structure_paint().is_some());
        let courses =
            if changes.is_empty() { self.courses.clone() } else { structural::courses_of(&roster, world.radius_m) };
        // What reads the ground depends on the edits before it.
        let later = context::refresh(&mut roster, [&ground, &masks], &changes);
        if !later.is_empty() {
            ground = ground.next(&roster, &later, is_ground);
        }
        let places = self.places.next(planet, painted_biomes(planet, &climate));
        let reads = roster.reading().next().is_some();
        let masked = Masked::of(&roster);
        let key = ground.key_of_all();
        let indices = Self { ground, climate, clouds, masks, life, structural, ..Self::none(world) };
        Self { list, roster, key, places, courses, reads, masked, ..indices }
    }

    /// The same edits on a planet whose biome table may be another.
    fn over(self: &Arc<Self>, planet: &Planet) -> Arc<Self> {
        let places = self.places.next(planet, painted_biomes(planet, &self.climate));
        if places == self.places {
            return self.clone();
        }
        Arc::new(Self { places, ..self.as_ref().clone() })
    }

    /// The memory of edits that read ground which has this key before all edits, after that of an earlier terrain.
    pub(crate) fn memory(&self, ground: Key, before: &Arc<Memory>) -> Arc<Memory> {
        if !self.reads {
            return Arc::default();
        }
        let lattices = self.roster.reading().flat_map(|(_, edit)| {
            let key = edit.lattice_key();
            std::iter::once(key).chain((0..gullies::MOST_OCTAVES).map(move |k| gullies::lattice_of(key, k)))
        });
        Memory::after(before, ground, &lattices.collect())
    }

    /// The key of all edits of the ground. None if there is none.
    pub(crate) fn key(&self) -> Option<Key> {
        (!self.ground.is_empty()).then(|| Self::with_masks(self.key, self.masked.ground, || self.mask_key()))
    }

    /// The key of all paint of clouds. None if there is none.
    pub(crate) fn cloud_key(&self) -> Option<Key> {
        (!self.clouds.is_empty())
            .then(|| Self::with_masks(self.clouds.key_of_all(), self.masked.clouds, || self.mask_key()))
    }

    /// The key of all paint of the climate. None if there is none.
    pub(crate) fn paint_key(&self) -> Option<Key> {
        let key = || Key::of(&(self.climate.key_of_all(), &self.places.places));
        (!self.climate.is_empty()).then(|| Self::with_masks(key(), self.masked.climate, || self.mask_key()))
    }

    /// The key of the edits that touch a node and the ground close around it. None if none does.
    pub(crate) fn key_near(&self, id: NodeId) -> Option<Key> {
        let key = self.ground.key_near(id, &self.roster)?;
        Some(Self::with_masks(key, self.masked.ground, || self.mask_key_near(id)))
    }

    /// The key of paint of the climate that touches a node and the ground close around it. None if none does.
    pub(crate) fn paint_key_near(&self, id: NodeId) -> Option<Key> {
        let key = self.climate.key_near(id, &self.roster)?;
        let key = Key::of(&(key, &self.places.places));
        Some(Self::with_masks(key, self.masked.climate, || self.mask_key_near(id)))
    }

    /// A key of edits with that of the masks, if masks limit some of them.
    fn with_masks(key: Key, is_masked: bool, masks: impl FnOnce() -> Option<Key>) -> Key {
        if is_masked { masks().map_or(key, |masks| Key::of(&(key, masks))) } else { key }
    }

    /// Changes the heights of points, and their gradients for each of the spacings, by a span of edits.
    pub(crate) fn apply(
        &self,
        dirs: &[DVec3],
        spacings_rad: &[f64],
        heights: &mut Heights,
        limits_m: (f64, f64),
        near: &mut Near,
        (ground, span): (&Ground<'_>, Span),
    ) {
        let rank_of = |slot: u32| self.roster.rank_of(slot);
        let ranks = span.from.map_or(0, rank_of)..span.before.map_or(u32::MAX, rank_of);
        let acts = |slot: u32, _: &CompiledEdit| ranks.contains(&rank_of(slot));
        near.each_touch(&self.ground, &self.roster, dirs, acts, |Touch { slot, edit, arcs, hits }| {
            let around = edit.reader.as_ref().map(|reader| {
                let sources = &edit.context.sources;
                let of = ReadBy { slot, lattice: edit.lattice_key(), sources, roster: &self.roster };
                (reader, reader.read(of, hits.iter().map(|hit| dirs[hit.point]), ground))
            });
            let shares = self.shares(edit, hits.iter().map(|hit| dirs[hit.point]), spacings_rad);
            for (own, Hit { point: i, nearest }) in hits.iter().enumerate() {
                let (i, dir, share) = (*i, dirs[*i], shares.of(own));
                if share <= 0.0 {
                    continue;
                }
                let read = around.as_ref().and_then(|(reader, around)| reader.at(dir, around));
                let Some(effect) = edit.effect(dir, (nearest, arcs), heights.height_m[i], read, share) else {
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

    /// The paint of the climate at points; nothing if there is none at any.
    pub(crate) fn painted(&self, dirs: &[DVec3], near: &mut Near, painted: &mut Vec<Painted>) {
        painted.clear();
        if self.climate.is_empty() {
            return;
        }
        near.each_touch(
            &self.climate,
            &self.roster,
            dirs,
            |_, _| true,
            |Touch { edit, hits, .. }| {
                let Some(paint) = edit.paint() else { return };
                let shares = self.shares(edit, hits.iter().map(|hit| dirs[hit.point]), &[]);
                for (own, Hit { point: i, nearest }) in hits.iter().enumerate() {
                    let weight = edit.weight(dirs[*i], nearest) * shares.of(own);
                    if weight > 0.0 {
                        painted.resize(dirs.len(), Painted::NONE);
                        paint.apply(&mut painted[*i], weight, |key| self.places.of(key));
                    }
                }
            },
        );
    }

    /// By how much paint changes the log-odds of the cover of clouds at points: calls `each` with the number of a point
    /// and the change.
    pub(crate) fn clouded(&self, dirs: &[DVec3], near: &mut Near, mut each: impl FnMut(usize, f64)) {
        near.each_touch(
            &self.clouds,
            &self.roster,
            dirs,
            |_, _| true,
            |Touch { edit, hits, .. }| {
                let Some(Paint::Clouds { odds }) = edit.paint() else { return };
                let shares = self.shares(edit, hits.iter().map(|hit| dirs[hit.point]), &[]);
                for (own, Hit { point: i, nearest }) in hits.iter().enumerate() {
                    each(*i, odds * edit.weight(dirs[*i], nearest) * shares.of(own));
                }
            },
        );
    }

    /// Whether paint of the climate may be at one of these points.
    pub(crate) fn may_paint(&self, dirs: &[DVec3], near: &mut Near) -> bool {
        !self.climate.is_empty() && near.holds_any(&self.climate, dirs)
    }

    /// Whether edits of the ground reach each of some points.
    #[cfg(feature = "bake")]
    pub(crate) fn reached(&self, dirs: &[DVec3]) -> Vec<bool> {
        let mut reached = vec![false; dirs.len()];
        Near::default().each_touch(
            &self.ground,
            &self.roster,
            dirs,
            |_, _| true,
            |Touch { hits, .. }| {
                hits.iter().for_each(|hit| reached[hit.point] = true);
            },
        );
        reached
    }

    /// A disc that holds all ground that edits reach: its middle and its angle. None if there is none.
    #[cfg(feature = "bake")]
    pub(crate) fn disc(&self) -> Option<(DVec3, f64)> {
        let pieces = || self.roster.edits().filter(|edit| edit.paint().is_none()).flat_map(|edit| &edit.pieces);
        let middle = pieces().map(|piece| piece.middle).sum::<DVec3>().try_normalize()?;
        let reach_rad = |piece: &Piece| middle.angle_between(piece.middle) + path::angle_of(piece.chord * piece.chord);
        Some((middle, pieces().map(reach_rad).fold(0.0, f64::max)))
    }

    /// How far from a place the ground lies, as an angle, that decides about the ground within an angle of it: farther
    /// where edits read the ground.
    pub(crate) fn reach_rad(&self, dir: DVec3, angle_rad: f64) -> f64 {
        let (mut reach_rad, mut counted) = (angle_rad, Vec::new());
        if !self.reads {
            return angle_rad;
        }
        loop {
            let before = counted.len();
            let disc = (dir, index::chord_of(reach_rad));
            self.ground.each_leaf(Some(disc), &mut |pieces| {
                for &number in pieces {
                    let slot = slot_of(number);
                    let reader = self.roster.edit(slot).and_then(|edit| edit.reader.as_ref());
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
        if near.is_none() && !self.reads {
            return self.ground.range().of((lo, hi));
        }
        let near = near.map(|(dir, angle_rad)| (dir, index::chord_of(angle_rad)));
        let is_near = |piece: &Piece| near.is_none_or(|(dir, chord)| piece.touches(dir, chord));
        if self.reads {
            // Smooth ground is a mean of the ground of several leaves: all edits count as if they were at one place.
            let mut pieces = Vec::new();
            self.ground.each_leaf(near, &mut |leaf| pieces.extend_from_slice(leaf));
            pieces.sort_unstable_by_key(|number| self.roster.rank(*number));
            pieces.dedup();
            return index::range_of(&pieces, &self.roster, is_near).of((lo, hi));
        }
        let mut range = Widening::default();
        self.ground.each_leaf(near, &mut |pieces| range = range.or(index::range_of(pieces, &self.roster, is_near)));
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
