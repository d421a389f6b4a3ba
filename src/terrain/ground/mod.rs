//! Ground near some place, kept for the many questions that moving things ask of it.
//!
//! - [`GroundPatch`]: contacts and sweeps of capsules against triangles whose vertices are the evaluator's heights
//! - `lattice`: where vertices lie; `block`: 16 by 16 cells of it, evaluated when a shape first comes near
//! - `convex`: pieces that a capsule meets. What stands on the ground is more pieces for [`GroundPatch::visit`]
//! - `walker`: a character that walks on it
//!
//! Answers do not depend on what was asked before: blocks that are dropped and made again are the same to the bit.

mod block;
pub(crate) mod convex;
mod lattice;
mod walker;

use super::Terrain;
use super::contact::{Capsule, Contact, Sweep};
use super::query::Scratch;
use block::Block;
use convex::{Axis, Convex, Nearest, Triangle};
use glam::DVec3;
use lattice::{BlockId, Span};
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;
pub use walker::{Walkable, Walker, WalkerBody};

/// A sweep stops this far from what it would meet.
pub(crate) const TOUCH_M: f64 = 1e-4;
/// Width of the cells of a new patch.
const FINEST_M: f64 = 0.25;
/// Cells are no wider than the radius of a shape over this, or than the patch's finest.
const CELLS: f64 = 4.0;
/// There are not many more than this to either side of a shape.
const MOST_CELLS: f64 = 32.0;
/// Memory of the blocks that are kept at first: some 5,000 of them.
const KEPT_BYTES: usize = 64 << 20;
/// Points of an axis in the ground whose depth is looked up.
const DEPTHS: usize = 9;
/// Pieces of a motion from which on the bounds of the ground are asked for a shorter way.
const FAR_PIECES: f64 = 64.0;

/// Ground near some place, kept in memory: contacts and sweeps of any shapes there take microseconds.
///
/// It is a lattice of triangles, fixed to the planet, whose vertices have [`Terrain::height_m`] to the bit. Blocks of
/// it are evaluated when a shape first comes near, and those not used for longest are dropped: so it follows those who
/// move. Large shapes meet wider cells: at most a quarter of the radius, or the patch's own width. Between vertices the
/// ground deviates from the evaluator's by no more than [`Contact::deviation_m`], which is measured; what is narrower
/// than a cell may be missed.
///
/// A patch belongs to one thread. Two patches of one planet and width give equal answers, whatever they were asked
/// before. After a change of the planet make a new one.
pub struct GroundPatch {
    terrain: Arc<Terrain>,
    finest_m: f64,
    most_blocks: usize,
    blocks: Vec<Block>,
    /// Where a block is kept.
    slots: HashMap<BlockId, usize>,
    /// The cells of the question at hand, each with the place of its block.
    near: Vec<(usize, Span)>,
    spans: Vec<Span>,
    asked: u64,
    scratch: Scratch,
}

impl fmt::Debug for GroundPatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GroundPatch").field("finest_m", &self.finest_m).field("blocks", &self.blocks.len()).finish()
    }
}

impl GroundPatch {
    /// A patch with cells of 0.25 m and 64 MiB of blocks, evaluated when they are needed.
    pub fn new(terrain: Arc<Terrain>) -> Self {
        Self {
            terrain,
            finest_m: FINEST_M,
            most_blocks: KEPT_BYTES / Block::BYTES,
            blocks: Vec::new(),
            slots: HashMap::new(),
            near: Vec::new(),
            spans: Vec::new(),
            asked: 0,
            scratch: Scratch::default(),
        }
    }

    /// The same with finest cells of at most this width on average, and more than half of it: the lattice has levels.
    /// What is no number above 0 means the finest there are, 0.15 m on a planet of the Earth's size.
    #[must_use]
    pub fn cell_m(mut self, width_m: f64) -> Self {
        self.finest_m = width_m;
        self.blocks.clear();
        self.slots.clear();
        self
    }

    /// The same with another limit of its memory. A question that needs more of it gets more.
    #[must_use]
    pub fn budget_bytes(mut self, bytes: usize) -> Self {
        self.most_blocks = bytes / Block::BYTES;
        self
    }

    /// The terrain whose ground it is.
    pub fn terrain(&self) -> &Arc<Terrain> {
        &self.terrain
    }

    /// Memory of the blocks that are kept.
    pub fn resident_bytes(&self) -> usize {
        self.blocks.len() * Block::BYTES
    }

    /// Height of the patch's ground above the reference sphere under a position, with the finest cells. A position
    /// that is zero or not finite counts as one over the north pole.
    pub fn height_m(&mut self, position_planet_m: DVec3) -> f64 {
        self.asked += 1;
        let dir = super::points::unit(position_planet_m);
        self.ground_m(lattice::level_of(self.finest_m, self.radius_m()), dir) - self.radius_m()
    }

    /// As [`Terrain::contact`], against the ground of the patch: with its [`Contact::deviation_m`], and with the
    /// narrowest ridges that its cells can hold.
    pub fn contact(&mut self, capsule: &Capsule, within_m: f64) -> Option<Contact> {
        if !capsule.is_valid() || within_m.is_nan() {
            return None;
        }
        self.asked += 1;
        let (axis, within_m) = (Axis::of(capsule), within_m.max(0.0));
        let wide_m = capsule.radius_m + within_m;
        let level = self.level_for(capsule.radius_m, 0.5 * axis.length_m() + wide_m);
        // Asked first: what lies in the planet's middle is near all of its ground.
        let found = if self.is_in_ground(level, &axis) { None } else { Some(self.nearest(level, &axis, wide_m)) };
        let Some(found) = found.filter(|found| found.is_none_or(|(near, _)| near.away_m > 0.0)) else {
            return Some(self.way_out(level, &axis, capsule.radius_m));
        };
        found.map(|found| contact_of(found, capsule.radius_m))
    }

    /// How far a capsule moves along a motion until it is a skin's width from the ground of the patch. None if nothing
    /// stops it, and for a capsule or a motion that is not finite. What touches may leave or slide along; a capsule
    /// whose axis is in the ground is stopped at 0, wherever it goes: its contact says the way out.
    ///
    /// It stops up to a tenth of a millimetre before the skin's width. The way is looked at in pieces as long as the
    /// capsule is wide, so that a motion of kilometres close to the ground takes long.
    pub fn sweep(&mut self, capsule: &Capsule, motion_planet_m: DVec3, skin_m: f64) -> Option<Sweep> {
        if !capsule.is_valid() || !motion_planet_m.is_finite() {
            return None;
        }
        self.asked += 1;
        let skin_m = if skin_m.is_finite() { skin_m.max(0.0) } else { 0.0 };
        let (axis, wide_m) = (Axis::of(capsule), capsule.radius_m + skin_m);
        let (length_m, half_m) = (motion_planet_m.length(), 0.5 * axis.length_m());
        let piece_m = half_m + 2.0 * wide_m;
        let level = self.level_for(capsule.radius_m, half_m + piece_m);
        if self.is_in_ground(level, &axis) {
            return Some(Sweep { share: 0.0, contact: self.way_out(level, &axis, capsule.radius_m) });
        }
        let dir = if length_m > 0.0 { motion_planet_m / length_m } else { DVec3::ZERO };
        let mut gone_m = 0.0;
        while gone_m < length_m {
            let left_m = length_m - gone_m;
            let here = axis.moved(dir * gone_m);
            if left_m > FAR_PIECES * piece_m
                && let Some(free_m) = self.terrain.free_m(&capsule.moved(dir * gone_m), left_m)
            {
                gone_m += free_m;
                continue;
            }
            if let Some((more_m, found)) = self.impact(level, &here, dir, piece_m.min(left_m), wide_m) {
                gone_m += more_m;
                let contact = match found.0.away_m > 0.0 {
                    true => contact_of(found, capsule.radius_m),
                    false => self.way_out(level, &axis.moved(dir * gone_m), capsule.radius_m),
                };
                return Some(Sweep { share: gone_m / length_m, contact });
            }
            gone_m += piece_m;
        }
        None
    }

    fn radius_m(&self) -> f64 {
        self.terrain.planet().radius_m()
    }

    /// The level of the lattice for a shape of a radius, in a ball of another.
    fn level_for(&self, radius_m: f64, reach_m: f64) -> u8 {
        // The finest width may be NaN: then the others count.
        lattice::level_of((radius_m / CELLS).max(reach_m / MOST_CELLS).max(self.finest_m), self.radius_m())
    }

    /// The nearest piece within a distance of an axis, and how far the ground may deviate there.
    fn nearest(&mut self, level: u8, axis: &Axis, within_m: f64) -> Option<(Nearest, f64)> {
        self.gather(level, axis, DVec3::ZERO, within_m);
        let mut best: Option<(Nearest, f64)> = None;
        self.visit(axis, within_m, |piece, deviation_m| {
            let near = piece.nearest(axis);
            let nearest_m = best.map_or(within_m, |(best, _)| best.away_m);
            if near.away_m <= nearest_m {
                best = Some((near, deviation_m));
            }
            near.away_m.min(nearest_m)
        });
        best
    }

    /// How far an axis moves until it is so near to a piece, and where.
    fn impact(
        &mut self,
        level: u8,
        axis: &Axis,
        dir: DVec3,
        length_m: f64,
        radius_m: f64,
    ) -> Option<(f64, (Nearest, f64))> {
        let (half_m, touch_m) = (dir * (0.5 * length_m), radius_m + TOUCH_M);
        let (middle, within_m) = (axis.moved(half_m), 0.5 * length_m + touch_m);
        self.gather(level, &middle, half_m, touch_m);
        let mut first: Option<(f64, (Nearest, f64))> = None;
        self.visit(&middle, within_m, |piece, deviation_m| {
            let most_m = first.map_or(length_m, |(gone_m, _)| gone_m);
            if let Some((gone_m, near)) = convex::impact(piece, axis, dir, most_m, radius_m) {
                first = Some((gone_m, (near, deviation_m)));
            }
            within_m
        });
        first
    }

    /// Whether an end of an axis is in the ground.
    fn is_in_ground(&mut self, level: u8, axis: &Axis) -> bool {
        self.clearance_m(level, axis.from_m) < 0.0 || (!axis.is_point() && self.clearance_m(level, axis.to_m) < 0.0)
    }

    /// The contact of a capsule whose axis is in the ground: from its deepest point to the nearest ground, or straight
    /// up from deeper than its radius.
    fn way_out(&mut self, level: u8, axis: &Axis, radius_m: f64) -> Contact {
        let (mut depth_m, mut deepest_m) = (f64::NEG_INFINITY, axis.from_m);
        for i in 0..DEPTHS {
            let at_m = axis.from_m.lerp(axis.to_m, i as f64 / (DEPTHS - 1) as f64);
            let under_m = -self.clearance_m(level, at_m);
            if under_m > depth_m {
                (depth_m, deepest_m) = (under_m, at_m);
            }
        }
        let up = super::points::unit(deepest_m);
        let above_m = up * self.ground_m(level, up);
        let deepest = Axis { from_m: deepest_m, to_m: deepest_m };
        let near = if depth_m <= radius_m { self.nearest(level, &deepest, depth_m.max(0.0)) } else { None };
        let (point_planet_m, deviation_m) = match near {
            Some((near, deviation_m)) => (near.on_piece_m, deviation_m),
            None => (above_m, self.deviation_m(level, up)),
        };
        let out_m = point_planet_m - deepest_m;
        let normal_planet = out_m.try_normalize().filter(|_| depth_m > TOUCH_M).unwrap_or(up);
        Contact { gap_m: -out_m.length() - radius_m, point_planet_m, normal_planet, deviation_m }
    }

    fn clearance_m(&mut self, level: u8, position_m: DVec3) -> f64 {
        position_m.length() - self.ground_m(level, super::points::unit(position_m))
    }

    /// Distance of the ground from the centre, under a unit direction.
    fn ground_m(&mut self, level: u8, dir: DVec3) -> f64 {
        let (id, cell) = lattice::cell_under(level, dir);
        let slot = self.slot(id);
        self.blocks[slot].ground_m(cell, dir)
    }

    fn deviation_m(&mut self, level: u8, dir: DVec3) -> f64 {
        let slot = self.slot(lattice::cell_under(level, dir).0);
        self.blocks[slot].deviation_m
    }

    /// Finds the cells that may be within a distance of an axis that moves by so much to and fro, and evaluates those
    /// that are not known.
    fn gather(&mut self, level: u8, axis: &Axis, half_m: DVec3, within_m: f64) {
        let (middle_m, up) = (axis.middle_m(), super::points::unit(axis.middle_m()));
        // What is high takes no more ground than what is low: only how far it reaches aside counts.
        let ends_m = [axis.from_m, axis.to_m].into_iter().flat_map(|end_m| [end_m - half_m, end_m + half_m]);
        let (aside_m, lowest_m) = ends_m.fold((0.0_f64, f64::INFINITY), |(aside_m, lowest_m), end_m| {
            let along_m = end_m.dot(up);
            (aside_m.max((end_m - up * along_m).length()), lowest_m.min(along_m))
        });
        let share = if lowest_m > within_m { (aside_m + within_m) / lowest_m } else { 1.0 };
        let mut spans = std::mem::take(&mut self.spans);
        lattice::spans_under(level, middle_m, share, &mut spans);
        self.near.clear();
        for span in &spans {
            let slot = self.slot(span.id);
            self.near.push((slot, *span));
        }
        self.spans = spans;
    }

    /// Calls for each piece that may be within a distance of an axis, with the deviation of the ground there. The
    /// answer is the distance that counts from then on.
    fn visit(&self, axis: &Axis, mut within_m: f64, mut meet: impl FnMut(&Triangle, f64) -> f64) {
        let lowest_m = axis.nearest_to(DVec3::ZERO).length();
        for (slot, span) in &self.near {
            let block = &self.blocks[*slot];
            if lowest_m - within_m > block.top_m {
                continue;
            }
            for row in span.rows[0]..span.rows[1] {
                for column in span.columns[0]..span.columns[1] {
                    let (middle_m, ball_m) = block.ball_m(column, row);
                    if axis.nearest_to(middle_m).distance(middle_m) > within_m + ball_m {
                        continue;
                    }
                    for triangle in &block.triangles(column, row) {
                        within_m = meet(triangle, block.deviation_m);
                    }
                }
            }
        }
    }

    /// The place of a block, which is made if it is not there: instead of the one not asked for longest, if the budget
    /// is spent. One of the question at hand stays.
    fn slot(&mut self, id: BlockId) -> usize {
        let slot = match self.slots.get(&id) {
            Some(slot) => *slot,
            None => {
                let block = Block::new(id, &self.terrain, &mut self.scratch);
                let oldest = if self.blocks.len() < self.most_blocks {
                    None
                } else {
                    (0..self.blocks.len()).min_by_key(|slot| self.blocks[*slot].asked)
                };
                let slot = match oldest.filter(|slot| self.blocks[*slot].asked < self.asked) {
                    Some(slot) => {
                        let old = std::mem::replace(&mut self.blocks[slot], block);
                        self.slots.remove(&old.id);
                        slot
                    }
                    None => {
                        self.blocks.push(block);
                        self.blocks.len() - 1
                    }
                };
                self.slots.insert(id, slot);
                slot
            }
        };
        self.blocks[slot].asked = self.asked;
        slot
    }
}

impl Axis {
    pub(crate) fn of(capsule: &Capsule) -> Self {
        let [from_m, to_m] = capsule.ends_planet_m;
        Self { from_m, to_m }
    }
}

fn contact_of((near, deviation_m): (Nearest, f64), radius_m: f64) -> Contact {
    Contact {
        gap_m: near.away_m - radius_m,
        point_planet_m: near.on_piece_m,
        normal_planet: (near.on_axis_m - near.on_piece_m) / near.away_m,
        deviation_m,
    }
}
