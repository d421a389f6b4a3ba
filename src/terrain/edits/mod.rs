//! Ground edits, compiled: strokes, stamps and splines that change the height of the joined layers.
//!
//! - `path`: the line through the points of an edit, and the nearest place of it
//! - `tool`: what each tool does to a height, with derivatives and bounds
//! - `outline`: noise for ragged outlines and rough ground
//! - `compiled`: one edit: its tool, its line, the pieces of that line
//! - `index`: which pieces are near a point, a tile or a disc
//!
//! Edits act in order at each point. One loop over points in f64 serves queries and tiles alike, with basic operations
//! and `libm` alone, so heights are the same bits on every machine and instruction set. A point looks only at the
//! pieces in its leaf of the index: thousands of edits cost what the few near the point cost.

mod compiled;
mod index;
mod outline;
mod path;
mod tool;

use super::field::Components;
use super::height::Heights;
use crate::planet::edits::Shared;
use crate::planet::{GroundEdits, Key, Planet};
use crate::sphere::NodeId;
use compiled::{CompiledEdit, Place};
use glam::DVec3;
use index::{Index, Piece};
use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// The edits of a planet that are on, compiled.
pub(crate) struct Edits {
    edits: Vec<Arc<CompiledEdit>>,
    index: Index,
    key: Key,
    /// Those of the planet with their compiled forms, by address, for the next revision.
    known: HashMap<usize, (Arc<Shared>, Arc<CompiledEdit>)>,
}

impl fmt::Debug for Edits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Edits").field(&self.key).finish()
    }
}

/// What compiled edits depend on besides the edits.
#[derive(Clone, Copy, Debug, PartialEq)]
struct World {
    radius_m: f64,
    sea_m: Option<f64>,
}

/// The edits that were compiled last, for the next revision: most of its edits are the same.
struct Last {
    world: World,
    list: GroundEdits,
    edits: Option<Arc<Edits>>,
}

impl Edits {
    /// The edits of a planet. None if none is on.
    pub(crate) fn new(planet: &Planet) -> Option<Arc<Self>> {
        static LAST: Mutex<Option<Last>> = Mutex::new(None);
        if planet.edits.is_empty() {
            return None;
        }
        let world = World { radius_m: planet.radius_m(), sea_m: planet.sea_level_m() };
        let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
        let before = last.as_ref().filter(|last| last.world == world);
        if let Some(same) = before.filter(|last| last.list.is_same(&planet.edits)) {
            return same.edits.clone();
        }
        let known = before.and_then(|last| last.edits.clone());
        let edits = Self::compiled(&planet.edits, world, known.as_deref()).map(Arc::new);
        *last = Some(Last { world, list: planet.edits.clone(), edits: edits.clone() });
        edits
    }

    fn compiled(list: &GroundEdits, world: World, before: Option<&Self>) -> Option<Self> {
        profiling::scope!("compile edits");
        let mut known = HashMap::with_capacity(list.len());
        let mut edits = Vec::with_capacity(list.len());
        let acts = |shared: &&Arc<Shared>| shared.edit.enabled && !shared.edit.points.0.is_empty();
        for shared in list.shared().iter().filter(acts) {
            let same = before.and_then(|before| before.known.get(&address(shared)));
            let compiled = match same {
                Some((_, compiled)) => compiled.clone(),
                None => Arc::new(CompiledEdit::new(&shared.edit, world.radius_m, world.sea_m)),
            };
            // The edit itself is kept, too, so that no other one can take its address.
            known.insert(address(shared), (shared.clone(), compiled.clone()));
            edits.push(compiled);
        }
        if edits.is_empty() {
            return None;
        }
        let mut pieces = Vec::new();
        for (number, edit) in edits.iter().enumerate() {
            pieces.extend(edit.pieces.iter().map(|piece| Piece { edit: number as u32, ..*piece }));
        }
        let index = Index::new(pieces);
        let key = index.key_of_all();
        Some(Self { edits, index, key, known })
    }

    /// The key of all edits.
    pub(crate) fn key(&self) -> Key {
        self.key
    }

    /// The key of the edits that touch a node and the ground close around it. None if none does.
    pub(crate) fn key_near(&self, id: NodeId) -> Option<Key> {
        self.index.key_near(id)
    }

    /// Changes the heights of points, and their gradients for each of the spacings.
    pub(crate) fn apply(&self, dirs: &[DVec3], spacings_rad: &[f64], heights: &mut Heights, limits_m: (f64, f64)) {
        let mut walk = self.index.walk();
        for (i, &dir) in dirs.iter().enumerate() {
            let pieces = walk.leaf(dir);
            if !pieces.is_empty() {
                self.apply_at(dir, pieces, spacings_rad, heights, i, limits_m);
            }
        }
    }

    fn apply_at(
        &self,
        dir: DVec3,
        pieces: &[u32],
        spacings_rad: &[f64],
        heights: &mut Heights,
        i: usize,
        limits_m: (f64, f64),
    ) {
        let mut rest = pieces;
        while let Some(&first) = rest.first() {
            let number = self.index.piece(first).edit;
            let same = rest.iter().take_while(|piece| self.index.piece(**piece).edit == number).count();
            let (own, others) = rest.split_at(same);
            rest = others;
            let Some(edit) = self.edits.get(number as usize) else { continue };
            let mut place = Place::default();
            for piece in own.iter().map(|piece| self.index.piece(*piece)).filter(|piece| piece.holds(dir)) {
                edit.look(dir, piece, &mut place);
            }
            let Some(effect) = edit.effect(dir, &place, heights.height_m[i]) else { continue };
            heights.height_m[i] = (heights.height_m[i] + effect.change_m).clamp(limits_m.0, limits_m.1);
            for (gradient, &spacing_rad) in heights.gradients.iter_mut().zip(spacings_rad) {
                let before = components(gradient, i);
                set_components(gradient, i, before * effect.by_ground + effect.gradient(spacing_rad));
            }
        }
    }

    /// Widens the lowest and greatest height of the layers by what the edits do within an angle of a direction (None:
    /// anywhere). Conservative.
    pub(crate) fn bounds_m(&self, (lo, hi): (f64, f64), near: Option<(DVec3, f64)>) -> (f64, f64) {
        let near = near.map(|(dir, angle_rad)| (dir, index::chord_of(angle_rad)));
        let mut all = (lo, hi);
        self.index.each_leaf(near, &mut |pieces| {
            let (mut range, mut last) = ((lo, hi), None);
            for piece in pieces.iter().map(|piece| self.index.piece(*piece)) {
                let touches = near.is_none_or(|(dir, chord)| piece.touches(dir, chord));
                // The pieces of one edit act once.
                if !touches || last == Some(piece.edit) {
                    continue;
                }
                last = Some(piece.edit);
                if let Some(edit) = self.edits.get(piece.edit as usize) {
                    range = edit.range_m(range);
                }
            }
            all = (all.0.min(range.0), all.1.max(range.1));
        });
        all
    }
}

fn components(gradient: &Components, i: usize) -> DVec3 {
    DVec3::from_array(gradient.each_ref().map(|component| f64::from(component[i])))
}

fn set_components(gradient: &mut Components, i: usize, value: DVec3) {
    for (component, value) in gradient.iter_mut().zip(value.to_array()) {
        component[i] = value as f32;
    }
}

fn address(shared: &Arc<Shared>) -> usize {
    Arc::as_ptr(shared) as usize
}
