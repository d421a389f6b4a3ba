//! Painted life: strokes that clear the ground or plant it, roads and walls, on which nothing stands, and objects that
//! are placed one by one.

use super::compiled::CompiledEdit;
use super::near::Near;
use super::paint::Paint;
use super::path::Arc;
use super::roster::slot_of;
use super::{Edits, Subject};
use crate::planet::Key;
use crate::sphere::NodeId;
use glam::DVec3;
use std::cell::RefCell;

/// A population, by a hash of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PopulationId(pub(super) Key);

impl PopulationId {
    pub(crate) fn of(name: &str) -> Self {
        Self(Key::of(name))
    }

    /// Population of this name; None if the name is empty.
    pub(super) fn named(name: &str) -> Option<Self> {
        (!name.is_empty()).then(|| Self::of(name))
    }
}

/// What edits make of the share of its greatest density that a population has by rule: `keep * share + add`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Planting {
    pub(crate) keep: f64,
    pub(crate) add: f64,
}

impl Planting {
    /// No edit.
    pub(crate) const NONE: Self = Self { keep: 1.0, add: 0.0 };

    /// A part of the way to a share.
    fn lead(&mut self, to: f64, weight: f64) {
        let left = 1.0 - weight;
        *self = Self { keep: self.keep * left, add: self.add * left + to * weight };
    }

    /// The share after the edits.
    pub(crate) fn of(&self, share: f64) -> f64 {
        self.keep * share + self.add
    }
}

/// An object that is placed by hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) dir: DVec3,
    /// Factor on the height of its population.
    pub(crate) size: f64,
    /// Turn against the clock, seen from above.
    pub(crate) turn_rad: f64,
}

impl Placed {
    /// The object at an arc of an edit.
    fn new(arc: &Arc, size: f64, [turn_rad, random_rad]: [f64; 2]) -> Self {
        let turn_rad = turn_rad + random_rad * arc.turned;
        let turn_rad = if arc.flipped { turn_rad } else { -turn_rad };
        Self { dir: arc.a, size: size * arc.scale * arc.widths[0], turn_rad }
    }
}

impl CompiledEdit {
    /// Whether it places objects of a population, or of the first one.
    fn places(&self, population: PopulationId) -> bool {
        matches!(self.paint(), Some(Paint::Object { population: of, .. }) if of.is_none_or(|of| of == population))
    }

    /// Whether it changes where a population stands.
    fn moves(&self, population: PopulationId) -> bool {
        self.plants(Some(population)) || self.places(population)
    }

    /// Whether it changes the share of a population; without one, whether it changes that of all of them.
    fn plants(&self, population: Option<PopulationId>) -> bool {
        match self.paint() {
            Some(Paint::Life { population: Some(painted), .. }) => population == Some(*painted),
            Some(Paint::Object { .. }) => false,
            _ => self.changes(Subject::Life),
        }
    }
}

impl Edits {
    /// Whether an edit changes what stands on the ground.
    pub(crate) fn plants(&self) -> bool {
        !self.index(Subject::Life).is_empty()
    }

    /// Whether edits that touch a node change where a population stands.
    pub(crate) fn touches_life(&self, id: NodeId, population: PopulationId) -> bool {
        self.index(Subject::Life).pieces_of_some(id, &self.roster, |edit| edit.moves(population)).next().is_some()
    }

    /// The key of the edits that touch a node and change where a population stands. None if none does.
    pub(crate) fn life_key_near(&self, id: NodeId, population: PopulationId) -> Option<Key> {
        let key = self.index(Subject::Life).key_of_some(id, &self.roster, |edit| edit.moves(population))?;
        Some(self.with_masks(key, Subject::Life, || self.key_near(Subject::Masks, id)))
    }

    /// The key of the edits that touch a disc, given by its middle and chord, and change the share of a population;
    /// without a population, of those that change all. None if none does.
    #[cfg(feature = "render")]
    pub(crate) fn life_key_in(&self, disc: (DVec3, f64), population: Option<PopulationId>) -> Option<Key> {
        let key = self.index(Subject::Life).key_in(disc, &self.roster, |edit| edit.plants(population))?;
        Some(self.with_masks(key, Subject::Life, || self.key(Subject::Masks)))
    }

    /// The objects of a population that are placed by hand in a node. `is_first`: whether it is the first one.
    pub(crate) fn placed(&self, id: NodeId, (population, is_first): (PopulationId, bool)) -> Vec<Placed> {
        let mut placed = Vec::new();
        for number in self.index(Subject::Life).pieces_of_some(id, &self.roster, |edit| edit.places(population)) {
            let (Some(edit), Some(piece)) = (self.roster.edit(slot_of(number)), self.roster.piece(number)) else {
                continue;
            };
            let Some(Paint::Object { population: of, size, turns_rad }) = edit.paint().copied() else { continue };
            let arcs = edit.arcs().get(piece.first as usize..(piece.first + piece.count) as usize).unwrap_or_default();
            let inside: Vec<&Arc> = arcs.iter().filter(|arc| NodeId::containing(arc.a, id.level) == id).collect();
            let shares = self.shares(edit, inside.iter().map(|arc| arc.a), &[]);
            let stands = |(own, _): &(usize, &&Arc)| (of.is_some() || is_first) && shares.of(*own) >= 0.5;
            placed.extend(inside.iter().enumerate().filter(stands).map(|(_, arc)| Placed::new(arc, size, turns_rad)));
        }
        placed
    }

    /// The greatest factor on the height of a population at which one of its objects is placed by hand; 0 if none is.
    /// `is_first`: whether it is the first population.
    pub(crate) fn largest_placed(&self, population: PopulationId, is_first: bool) -> f64 {
        let sizes = self.roster.edits().map(|edit| match edit.paint() {
            Some(Paint::Object { population: of, size, .. }) if of.map_or(is_first, |of| of == population) => {
                edit.arcs().iter().fold(0.0, |most: f64, arc| most.max(size * arc.scale * arc.widths[0]))
            }
            _ => 0.0,
        });
        sizes.fold(0.0, f64::max)
    }

    /// Whether an edit changes the share of its greatest density that a population has: all but those that place single
    /// objects.
    #[cfg(feature = "render")]
    pub(crate) fn plants_by_share(&self) -> bool {
        self.life_strokes().next().is_some() || self.roster.edits().any(|edit| edit.is_built())
    }

    /// The strokes of life: the population of each, None for all, and the density that it leads to.
    #[cfg(feature = "render")]
    pub(crate) fn life_strokes(&self) -> impl Iterator<Item = (Option<PopulationId>, f64)> {
        self.roster.edits().filter_map(|edit| match edit.paint() {
            Some(Paint::Life { population, density }) => Some((*population, *density)),
            _ => None,
        })
    }

    /// What edits make of the share of a population at points; nothing if none is near any. Without a population, what
    /// those do that change all.
    pub(crate) fn planted(&self, population: Option<PopulationId>, dirs: &[DVec3], planted: &mut Vec<Planting>) {
        thread_local! {
            static NEAR: RefCell<Near> = RefCell::default();
        }
        planted.clear();
        if self.index(Subject::Life).is_empty() {
            return;
        }
        let mut near = NEAR.take();
        let counts = |edit: &CompiledEdit| edit.plants(population);
        self.each_weight(Subject::Life, dirs, &mut near, counts, |i, edit, weight, share| {
            let density = if let Some(Paint::Life { density, .. }) = edit.paint() { *density } else { 0.0 };
            if weight * share > 0.0 {
                planted.resize(dirs.len(), Planting::NONE);
                planted[i].lead(density, weight * share);
            }
        });
        NEAR.set(near);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_in_order_are_one_change_of_the_share() {
        let mut planting = Planting::NONE;
        assert_eq!(planting.of(0.3), 0.3);
        let mut share = 0.3;
        for (density, weight) in [(1.0, 0.5), (0.0, 0.25), (0.6, 1.0 / 3.0)] {
            planting.lead(density, weight);
            share += (density - share) * weight;
            assert!((planting.of(0.3) - share).abs() < 1e-15);
        }
        planting.lead(0.0, 1.0);
        assert_eq!((planting.of(0.0), planting.of(1.0)), (0.0, 0.0));
    }
}
