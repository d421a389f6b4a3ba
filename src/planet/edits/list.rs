//! The list of ground edits of a planet. Copies share their edits until one of them is changed, so that a planet with
//! thousands of edits is copied, compared and kept in undo steps at almost no cost.

use super::{GroundEdit, MAX_ALL_COPIES, MAX_ALL_PLACES, MAX_ALL_POINTS, MAX_EDIT_POINTS, MAX_EDITS, Tool};
use crate::planet::Biome;
use crate::planet::param::{Form, Look, ParamPath, Params, Part, PartType, Segment, Visit};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::{Arc, OnceLock};

/// Ground edits in the order in which they act.
#[derive(Clone, Debug, Default)]
pub struct GroundEdits(Arc<Vec<Arc<Shared>>>);

/// An edit that several lists may share.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    pub(crate) edit: GroundEdit,
    /// Whether it was found to be valid; forgotten when it is changed.
    valid: OnceLock<()>,
}

impl Clone for Shared {
    fn clone(&self) -> Self {
        self.edit.clone().into()
    }
}

impl From<GroundEdit> for Shared {
    fn from(edit: GroundEdit) -> Self {
        Self { edit, valid: OnceLock::new() }
    }
}

impl Shared {
    /// Whether the edit is known to be valid.
    pub(crate) fn is_valid(&self) -> bool {
        self.valid.get().is_some()
    }

    /// Notes that it is.
    pub(crate) fn note_valid(&self) {
        let _ = self.valid.set(());
    }

    fn changing(&mut self) -> &mut GroundEdit {
        self.valid = OnceLock::new();
        &mut self.edit
    }
}

impl GroundEdits {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the planet may not have another edit with as many points as an edit may have.
    pub fn is_full(&self) -> bool {
        let points: usize = self.iter().map(|edit| edit.points.0.len()).sum();
        self.len() >= MAX_EDITS
            || points + MAX_EDIT_POINTS > MAX_ALL_POINTS
            || self.place_count() + MAX_ALL_COPIES > MAX_ALL_PLACES
    }

    /// How many points there are with the copies of stamps and the images by symmetry.
    pub fn place_count(&self) -> usize {
        let places = |edit: &GroundEdit| {
            let copies = if edit.tool.is_stamp() { edit.copies.max(1) as usize } else { 1 };
            edit.points.0.len() * copies * edit.image_count()
        };
        self.iter().map(places).fold(0, usize::saturating_add)
    }

    /// The edits in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &GroundEdit> {
        self.0.iter().map(|shared| &shared.edit)
    }

    /// The edits in order, as they are shared.
    pub(crate) fn shared(&self) -> &[Arc<Shared>] {
        &self.0
    }

    /// Whether both are one list in memory. Equal lists may be two.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// The edit of an index.
    pub fn get(&self, index: usize) -> Option<&GroundEdit> {
        self.0.get(index).map(|shared| &shared.edit)
    }

    /// The edit of an index, to be changed.
    pub fn get_mut(&mut self, index: usize) -> Option<&mut GroundEdit> {
        // Looked up first: an index out of range copies nothing.
        self.0.get(index)?;
        Arc::make_mut(&mut self.0).get_mut(index).map(|shared| Arc::make_mut(shared).changing())
    }

    /// Adds an edit behind the last.
    pub fn push(&mut self, edit: GroundEdit) {
        Arc::make_mut(&mut self.0).push(Arc::new(edit.into()));
    }

    /// Adds an edit before an index, or behind the last.
    pub fn insert(&mut self, index: usize, edit: GroundEdit) {
        let index = index.min(self.len());
        Arc::make_mut(&mut self.0).insert(index, Arc::new(edit.into()));
    }

    /// Takes an edit out.
    pub fn remove(&mut self, index: usize) -> Option<GroundEdit> {
        self.0.get(index)?;
        Some(Arc::unwrap_or_clone(Arc::make_mut(&mut self.0).remove(index)).edit)
    }

    /// Paint of biomes follows a palette that was changed: a biome that got another key keeps its paint, that of a
    /// biome that is gone becomes the first.
    pub fn follow_palette(&mut self, before: &[Biome], after: &[Biome]) {
        let Some(first) = after.first() else { return };
        let has = |palette: &[Biome], key: char| palette.iter().any(|biome| biome.key == key);
        for index in 0..self.len() {
            let Some(Tool::Biome(paint)) = self.get(index).map(|edit| &edit.tool) else { continue };
            if has(after, paint.biome) {
                continue;
            }
            let at = before.iter().position(|biome| biome.key == paint.biome).filter(|_| before.len() == after.len());
            let renamed = at.and_then(|at| after.get(at)).filter(|biome| !has(before, biome.key));
            let new = renamed.unwrap_or(first).key;
            if let Some(Tool::Biome(paint)) = self.get_mut(index).map(|edit| &mut edit.tool) {
                paint.biome = new;
            }
        }
    }

    /// Moves an edit to another index. An index out of range changes nothing.
    pub fn shift(&mut self, from: usize, to: usize) {
        if from < self.len() && to < self.len() && from != to {
            let edits = Arc::make_mut(&mut self.0);
            let edit = edits.remove(from);
            edits.insert(to, edit);
        }
    }
}

impl PartialEq for GroundEdits {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&Arc<Shared>, &Arc<Shared>)| Arc::ptr_eq(a, b) || a.edit == b.edit;
        self.is_same(other) || (self.len() == other.len() && self.0.iter().zip(other.0.iter()).all(same))
    }
}

impl FromIterator<GroundEdit> for GroundEdits {
    fn from_iter<T: IntoIterator<Item = GroundEdit>>(edits: T) -> Self {
        Self(Arc::new(edits.into_iter().map(|edit| Arc::new(edit.into())).collect()))
    }
}

impl Serialize for GroundEdits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for GroundEdits {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::<GroundEdit>::deserialize(deserializer).map(|edits| edits.into_iter().collect())
    }
}

impl Params for GroundEdits {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        if self.is_empty() {
            return;
        }
        for (i, shared) in Arc::make_mut(&mut self.0).iter_mut().enumerate() {
            let edit = Arc::make_mut(shared).changing();
            path.within(Segment::Index(i), |path| edit.each_param(path, visit));
        }
    }

    fn each_value(&self, path: &mut ParamPath, look: &mut Look<'_>) {
        for (i, edit) in self.iter().enumerate() {
            path.within(Segment::Index(i), |path| edit.each_value(path, look));
        }
    }
}

impl PartType for GroundEdits {
    const FORM: Form = Form::List;

    fn each_part(found: &mut dyn FnMut(&'static Part)) {
        GroundEdit::each_part(found);
    }

    fn every_kind() -> Vec<Self> {
        vec![GroundEdit::every_kind().into_iter().collect()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::EditPoint;

    #[test]
    fn a_planet_is_full_where_an_edit_more_could_be_too_much() {
        let long = GroundEdit {
            points: vec![EditPoint::default(); MAX_EDIT_POINTS].into_iter().collect(),
            ..Default::default()
        };
        let mut edits: GroundEdits = vec![long; MAX_ALL_POINTS / MAX_EDIT_POINTS - 1].into_iter().collect();
        assert!(!edits.is_full());
        edits.push(GroundEdit { points: [EditPoint::default()].into_iter().collect(), ..Default::default() });
        assert!(edits.is_full());
        let edits: GroundEdits = vec![GroundEdit::default(); MAX_EDITS].into_iter().collect();
        assert!(edits.is_full());
    }

    #[test]
    fn copies_share_until_one_is_changed() {
        let edits: GroundEdits = (0..3).map(|_| GroundEdit::default()).collect();
        let mut copy = edits.clone();
        assert!(copy.is_same(&edits) && copy.get_mut(7).is_none() && copy.remove(7).is_none());
        copy.shift(1, 9);
        assert!(copy.is_same(&edits), "nothing was copied for nothing");
        if let Some(edit) = copy.get_mut(1) {
            edit.name = "Mine".to_owned();
        }
        assert!(copy != edits && Arc::ptr_eq(&copy.shared()[0], &edits.shared()[0]));
        copy.shift(1, 2);
        assert_eq!(copy.get(2).map(|edit| edit.name.as_str()), Some("Mine"));
        copy.insert(99, GroundEdit::default());
        assert_eq!((copy.len(), edits.len()), (4, 3));
    }
}
