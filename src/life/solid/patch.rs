//! Solid objects near those who move: contacts, sweeps and rays against trunks, stones and other objects that are hit.

use super::block::{Block, BlockScratch, Solid};
use super::forms::{self, SolidForm};
use super::hidden::{HiddenObjects, ObjectId};
use super::shape::Near;
use crate::sphere::NodeId;
use crate::terrain::ground::TOUCH_M;
use crate::terrain::ground::convex::Axis;
use crate::terrain::{Capsule, Contact, RayLimits, Sweep, Terrain};
use glam::DVec3;
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// Memory of the objects that are kept at first: some 100,000 of them.
const KEPT_BYTES: usize = 16 << 20;
/// Motions and rays are looked at in pieces of this length.
const PIECE_M: f64 = 16.0;
/// Questions that reach farther than this from their middle meet no object.
const LARGEST_M: f64 = 500.0;
/// Length of the pieces that a motion or a ray looks at, in all.
const LOOKED_M: f64 = 10_000.0;
/// From this length on the bounds of the ground are asked for a shorter way.
const FAR_M: f64 = 4.0 * PIECE_M;

/// What a question met, and of what.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Met<T, O = ObjectId> {
    /// The contact, the sweep or the hit.
    pub hit: T,
    /// The object; None is the ground, where that may be met.
    pub object: O,
}

/// Where a ray meets something.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayHit {
    /// Distance from the ray's origin.
    pub away_m: f64,
    /// The place.
    pub point_planet_m: DVec3,
    /// Unit vector out of what is met; against the ray where it begins inside.
    pub normal_planet: DVec3,
}

/// Solid objects near some place, kept in memory: contacts, sweeps and rays there take microseconds.
///
/// They are the objects that [`Terrain::instances`] answers and that are drawn, of populations that are
/// [`solid`](crate::planet::Population::solid). Trunks, stalks and tendrils are hit as capsules, section by section;
/// stones, crystals, cacti, mushrooms and cushions as convex hulls of the connected parts of their mesh. The
/// [`Contact::deviation_m`] of a contact says how far the corners of the mesh lie from the shape, at most; it is
/// measured. Boughs, leaves, needles, fronds and blades of grass are passed through, and nothing is hit of a tuft.
///
/// Cells of a population are placed when a shape first comes near, and those not used for longest are dropped. A patch
/// belongs to one thread. Answers do not depend on what was asked before. After a change of the planet make a new one.
pub struct ObjectPatch {
    terrain: Arc<Terrain>,
    forms: Arc<[SolidForm]>,
    hidden: HiddenObjects,
    most_bytes: usize,
    blocks: Vec<Block>,
    /// Where a block is kept.
    slots: HashMap<(usize, NodeId), usize>,
    bytes: usize,
    /// The blocks of the question at hand.
    near: Vec<usize>,
    cells: Vec<NodeId>,
    asked: u64,
    memory: BlockScratch,
    /// The greatest [`SolidForm::reach_m`].
    tallest_m: f64,
}

impl fmt::Debug for ObjectPatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ObjectPatch").field("forms", &self.forms.len()).field("blocks", &self.blocks.len()).finish()
    }
}

impl ObjectPatch {
    /// A patch that keeps 16 MiB of objects. It measures the forms of all solid populations first, which takes some
    /// milliseconds for each.
    pub fn new(terrain: Arc<Terrain>) -> Self {
        let forms = forms::of_terrain(&terrain).into();
        Self::with_forms(terrain, forms)
    }

    fn with_forms(terrain: Arc<Terrain>, forms: Arc<[SolidForm]>) -> Self {
        let tallest_m = forms.iter().map(|form| form.reach_m).fold(0.0, f64::max);
        Self {
            terrain,
            forms,
            hidden: HiddenObjects::default(),
            most_bytes: KEPT_BYTES,
            blocks: Vec::new(),
            slots: HashMap::new(),
            bytes: 0,
            near: Vec::new(),
            cells: Vec::new(),
            asked: 0,
            memory: BlockScratch::default(),
            tallest_m,
        }
    }

    /// An empty patch of the same planet for another thread, with the same hidden objects: it measures no form again.
    #[must_use]
    pub fn another(&self) -> Self {
        let other = Self::with_forms(Arc::clone(&self.terrain), Arc::clone(&self.forms));
        Self { hidden: self.hidden.clone(), most_bytes: self.most_bytes, ..other }
    }

    /// The same with another limit of its memory. A question that needs more of it gets more.
    #[must_use]
    pub fn budget_bytes(mut self, bytes: usize) -> Self {
        self.most_bytes = bytes;
        self
    }

    /// The terrain on which the objects stand.
    pub fn terrain(&self) -> &Arc<Terrain> {
        &self.terrain
    }

    /// Memory of the objects that are kept.
    pub fn resident_bytes(&self) -> usize {
        self.bytes
    }

    /// The objects that it leaves out.
    pub fn hidden(&self) -> &HiddenObjects {
        &self.hidden
    }

    /// The same, to hide and show objects.
    pub fn hidden_mut(&mut self) -> &mut HiddenObjects {
        &mut self.hidden
    }

    /// Where a capsule is nearest to an object; None if all are farther than `within_m`, and for a capsule that is not
    /// finite or has no radius. A capsule in an object has the way out: of a trunk the least, of a stone the least
    /// along the normal of a face of its hull.
    ///
    /// A capsule that reaches farther than 500 m with `within_m` meets no object.
    pub fn contact(&mut self, capsule: &Capsule, within_m: f64) -> Option<Met<Contact>> {
        if !capsule.is_valid() || within_m.is_nan() {
            return None;
        }
        let (axis, radius_m) = (Axis::of(capsule), capsule.radius_m);
        let mut most_m = radius_m + within_m.max(0.0);
        self.gather(axis.middle_m(), 0.5 * axis.length_m() + most_m);
        let mut best: Option<(&Solid, &SolidForm, Near)> = None;
        self.visit(&axis, most_m, |solid, form| {
            let local = axis_in(solid, &axis);
            for part in solid.shape(form).near_parts(solid.size_m, &local, most_m) {
                let near = part.nearest(solid.size_m, &local);
                if near.away_m <= most_m && best.is_none_or(|(.., best)| near.away_m < best.away_m) {
                    (best, most_m) = (Some((solid, form, near)), near.away_m.max(0.0));
                }
            }
            most_m
        });
        best.map(|(solid, form, near)| met(solid, form, contact_of(solid, form, &near, radius_m)))
    }

    /// How far a capsule moves along a motion until it is a skin's width from an object. None if nothing stops it, and
    /// for a capsule or a motion that is not finite. What touches may leave or slide along; a capsule whose axis is in
    /// a stone is stopped at 0, wherever it goes, and one whose axis is in a trunk may leave.
    ///
    /// It stops up to a tenth of a millimetre before the skin's width. Capsules that reach farther than 500 m meet no
    /// object. It looks no farther than 10 km along its way among objects.
    pub fn sweep(&mut self, capsule: &Capsule, motion_planet_m: DVec3, skin_m: f64) -> Option<Met<Sweep>> {
        self.sweep_up_to(capsule, motion_planet_m, skin_m, 1.0)
    }

    /// As [`ObjectPatch::sweep`], of a motion that ends after a share of it.
    pub(super) fn sweep_up_to(
        &mut self,
        capsule: &Capsule,
        motion_planet_m: DVec3,
        skin_m: f64,
        share: f64,
    ) -> Option<Met<Sweep>> {
        if !capsule.is_valid() || !motion_planet_m.is_finite() || self.forms.is_empty() {
            return None;
        }
        let skin_m = if skin_m.is_finite() { skin_m.max(0.0) } else { 0.0 };
        let (axis, wide_m) = (Axis::of(capsule), capsule.radius_m + skin_m);
        let (length_m, half_m) = (motion_planet_m.length(), 0.5 * axis.length_m());
        let dir = if length_m > 0.0 { motion_planet_m / length_m } else { return None };
        let (piece_m, end_m) = (PIECE_M.max(half_m + 2.0 * wide_m), length_m * share);
        let (mut gone_m, mut looked_m) = (0.0, 0.0);
        while gone_m < end_m && looked_m < LOOKED_M {
            let (left_m, here) = (end_m - gone_m, capsule.moved(dir * gone_m));
            if let Some(free_m) = self.free_m(&here, left_m) {
                gone_m += free_m;
                continue;
            }
            let most_m = piece_m.min(left_m);
            if let Some((more_m, (solid, form, near))) = self.impact(&here, dir, most_m, skin_m) {
                let contact = contact_of(solid, form, &near, capsule.radius_m);
                return Some(met(solid, form, Sweep { share: (gone_m + more_m) / length_m, contact }));
            }
            (gone_m, looked_m) = (gone_m + piece_m, looked_m + piece_m);
        }
        None
    }

    /// What a ray meets first; None if that is no object, if the origin is infinite or NaN, or if the direction is
    /// zero, infinite or NaN. A ray that begins in an object meets it there. Neither the ground nor the sea stops it.
    ///
    /// It looks no farther than 10 km along its way among objects: give it an end.
    pub fn raycast(&mut self, origin_planet_m: DVec3, dir_planet: DVec3, limits: &RayLimits) -> Option<Met<RayHit>> {
        if !origin_planet_m.is_finite() || !dir_planet.is_finite() || self.forms.is_empty() {
            return None;
        }
        let dir = dir_planet.try_normalize()?;
        let [mut at_m, end_m] = self.ray_limits(origin_planet_m, dir, limits)?;
        let mut looked_m = 0.0;
        while at_m <= end_m && looked_m < LOOKED_M {
            let point_m = origin_planet_m + dir * at_m;
            if let Some(free_m) = self.free_m(&Capsule::sphere(point_m, TOUCH_M), end_m - at_m) {
                at_m += free_m;
                continue;
            }
            let piece_m = PIECE_M.min(end_m - at_m);
            if let Some(met) = self.ray_piece(origin_planet_m, dir, [at_m, at_m + piece_m]) {
                return Some(met);
            }
            (at_m, looked_m) = (at_m + PIECE_M, looked_m + PIECE_M);
        }
        None
    }

    /// The part of a ray on which objects may stand: from over the highest of them to under the lowest.
    fn ray_limits(&self, origin_m: DVec3, dir: DVec3, limits: &RayLimits) -> Option<[f64; 2]> {
        let (low_m, high_m) = self.terrain.height_bounds_m();
        let radius_m = self.terrain.planet().radius_m();
        let (top_m, bottom_m) = (radius_m + high_m + self.tallest_m, radius_m + low_m - self.tallest_m);
        let (along_m, apart2) = (-origin_m.dot(dir), origin_m.length_squared());
        let half = |radius_m: f64| {
            let half2 = along_m * along_m - (apart2 - radius_m * radius_m);
            (radius_m > 0.0 && half2 >= 0.0).then(|| half2.sqrt())
        };
        let over_m = half(top_m)?;
        let from_m = limits.from_m.max(0.0).max(along_m - over_m);
        let under_m = half(bottom_m).map(|half_m| along_m - half_m).filter(|at_m| *at_m > from_m);
        let to_m = limits.to_m.min(along_m + over_m).min(under_m.unwrap_or(f64::INFINITY));
        (limits.from_m <= limits.to_m && from_m <= to_m).then_some([from_m, to_m])
    }

    /// What a ray meets between two distances.
    fn ray_piece(&mut self, origin_m: DVec3, dir: DVec3, [from_m, to_m]: [f64; 2]) -> Option<Met<RayHit>> {
        let [start_m, end_m] = [from_m, to_m].map(|at_m| origin_m + dir * at_m);
        let piece = Axis { from_m: start_m, to_m: end_m };
        self.gather(piece.middle_m(), 0.5 * (to_m - from_m) + TOUCH_M);
        let mut best: Option<(&Solid, &SolidForm, f64, DVec3)> = None;
        self.visit(&piece, TOUCH_M, |solid, form| {
            let (local, local_dir) = (axis_in(solid, &piece), solid.local(dir));
            for part in solid.shape(form).near_parts(solid.size_m, &local, TOUCH_M) {
                let most_m = best.map_or(to_m, |(.., away_m, _)| away_m) - from_m;
                if let Some((more_m, normal)) = part.ray(solid.size_m, local.from_m, local_dir, [0.0, most_m])
                    && best.is_none_or(|(.., away_m, _)| from_m + more_m < away_m)
                {
                    best = Some((solid, form, from_m + more_m, normal));
                }
            }
            TOUCH_M
        });
        best.map(|(solid, form, away_m, normal)| {
            let (point_planet_m, normal_planet) = (origin_m + dir * away_m, solid.planet(normal));
            met(solid, form, RayHit { away_m, point_planet_m, normal_planet })
        })
    }

    /// How far a capsule moves in a direction until it touches an object.
    fn impact(
        &mut self,
        capsule: &Capsule,
        dir: DVec3,
        length_m: f64,
        skin_m: f64,
    ) -> Option<(f64, (&Solid, &SolidForm, Near))> {
        let (axis, wide_m) = (Axis::of(capsule), capsule.radius_m + skin_m);
        let (middle_m, aside_m) = (axis.middle_m(), 0.5 * axis.length_m() + wide_m + TOUCH_M);
        let way = Axis { from_m: middle_m, to_m: middle_m + dir * length_m };
        self.gather(way.middle_m(), 0.5 * length_m + aside_m);
        let mut first: Option<(f64, (&Solid, &SolidForm, Near))> = None;
        self.visit(&way, aside_m, |solid, form| {
            let (local, local_dir) = (axis_in(solid, &axis), solid.local(dir));
            for part in solid.shape(form).near_parts(solid.size_m, &axis_in(solid, &way), aside_m) {
                let most_m = first.map_or(length_m, |(gone_m, _)| gone_m);
                if let Some((gone_m, near)) = part.impact(solid.size_m, &local, local_dir, most_m, wide_m)
                    && first.is_none_or(|(first_m, _)| gone_m < first_m)
                {
                    first = Some((gone_m, (solid, form, near)));
                }
            }
            aside_m
        });
        first
    }

    /// A distance that a capsule can move whatever the direction, if it is far over the ground and has far to go.
    fn free_m(&self, capsule: &Capsule, wanted_m: f64) -> Option<f64> {
        let middle_m = Axis::of(capsule).middle_m();
        let over_m = || middle_m.length() - self.terrain.planet().radius_m() - self.terrain.height_m(middle_m);
        if wanted_m < FAR_M || over_m() < FAR_M {
            return None;
        }
        let high = Capsule { radius_m: capsule.radius_m + self.tallest_m, ..*capsule };
        self.terrain.free_m(&high, wanted_m)
    }

    /// Finds the cells whose objects may be within a distance of a position, and places those that are not known.
    fn gather(&mut self, middle_m: DVec3, within_m: f64) {
        self.asked += 1;
        self.near.clear();
        let top_m = self.terrain.planet().radius_m() + self.terrain.height_bounds_m().1 + self.tallest_m;
        if within_m > LARGEST_M || middle_m.length() - within_m > top_m {
            return;
        }
        if self.bytes > self.most_bytes {
            self.forget();
        }
        let forms = Arc::clone(&self.forms);
        let mut cells = std::mem::take(&mut self.cells);
        for (number, form) in forms.iter().enumerate() {
            let reach_m = within_m + form.reach_m;
            let share = if middle_m.length() > reach_m { reach_m / middle_m.length() } else { 1.0 };
            cells.clear();
            form.placement.grid.add_cells_under(middle_m, share, &mut cells);
            for cell in &cells {
                let slot = self.slot((number, *cell));
                if !self.blocks[slot].solids.is_empty() {
                    self.near.push(slot);
                }
            }
        }
        self.cells = cells;
    }

    /// Calls for each object that may be within a distance of a segment, but for hidden ones. The answer is the
    /// distance that counts from then on.
    fn visit<'a>(&'a self, segment: &Axis, mut within_m: f64, mut meet: impl FnMut(&'a Solid, &'a SolidForm) -> f64) {
        let is_near =
            |middle_m: DVec3, most_m: f64| segment.nearest_to(middle_m).distance_squared(middle_m) <= most_m * most_m;
        for slot in &self.near {
            let block = &self.blocks[*slot];
            if !is_near(block.ball_m.middle, within_m + block.ball_m.radius) {
                continue;
            }
            let form = &self.forms[block.name.0];
            let hidden = self.hidden.of_seed(form.placement.population().seed);
            for solid in &block.solids {
                if is_near(solid.ball_m.middle, within_m + solid.ball_m.radius) && !hidden.holds(solid.id) {
                    within_m = meet(solid, form);
                }
            }
        }
    }

    /// Drops the blocks that were not asked for longest, until a part of the budget is free.
    fn forget(&mut self) {
        self.blocks.sort_unstable_by_key(|block| std::cmp::Reverse(block.asked));
        let mut bytes = 0;
        self.blocks.retain(|block| {
            bytes += block.bytes();
            bytes <= self.most_bytes / 4 * 3
        });
        self.bytes = self.blocks.iter().map(Block::bytes).sum();
        self.slots = self.blocks.iter().enumerate().map(|(slot, block)| (block.name, slot)).collect();
    }

    /// Where a block is kept, which is made if it is not there.
    fn slot(&mut self, name: (usize, NodeId)) -> usize {
        let slot = match self.slots.get(&name) {
            Some(slot) => *slot,
            None => {
                let block = Block::new(name, &self.forms[name.0], &self.terrain, &mut self.memory);
                self.bytes += block.bytes();
                self.slots.insert(name, self.blocks.len());
                self.blocks.push(block);
                self.blocks.len() - 1
            }
        };
        self.blocks[slot].asked = self.asked;
        slot
    }
}

fn object_of(solid: &Solid, form: &SolidForm) -> ObjectId {
    ObjectId { seed: form.placement.population().seed, id: solid.id }
}

fn met<T>(solid: &Solid, form: &SolidForm, hit: T) -> Met<T> {
    Met { hit, object: object_of(solid, form) }
}

/// An axis in the frame of an object.
fn axis_in(solid: &Solid, axis: &Axis) -> Axis {
    Axis { from_m: solid.local_m(axis.from_m), to_m: solid.local_m(axis.to_m) }
}

fn contact_of(solid: &Solid, form: &SolidForm, near: &Near, radius_m: f64) -> Contact {
    Contact {
        gap_m: near.away_m - radius_m,
        point_planet_m: solid.planet_m(near.on_part_m),
        normal_planet: solid.planet(near.normal),
        deviation_m: solid.shape(form).deviation * solid.size_m,
    }
}
