//! Objects that a game hides: those it has felled, taken or replaced by its own.

use crate::life::Instance;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// An object of a planet: the same wherever and whenever it is asked for; see [`Instance::id`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ObjectId {
    /// Index of its population in [`Planet::life`](crate::planet::Planet::life).
    pub population: u16,
    /// Its id in the population.
    pub id: u64,
}

/// Objects that queries leave out. They are still drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct HiddenObjects(BTreeSet<ObjectId>);

impl HiddenObjects {
    /// Hides an object. Whether it was there before.
    pub fn hide(&mut self, object: ObjectId) -> bool {
        self.0.insert(object)
    }

    /// Shows an object again. Whether it was hidden.
    pub fn show(&mut self, object: ObjectId) -> bool {
        self.0.remove(&object)
    }

    /// Whether an object is hidden.
    pub fn holds(&self, object: ObjectId) -> bool {
        self.0.contains(&object)
    }

    /// All of them, in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = ObjectId> {
        self.0.iter().copied()
    }

    /// Number of hidden objects.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether none is hidden.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes hidden objects from a list, such as that of [`Terrain::instances`](crate::terrain::Terrain::instances).
    pub fn retain_shown(&self, instances: &mut Vec<Instance>) {
        instances.retain(|instance| !self.holds(instance.object()));
    }
}

impl Extend<ObjectId> for HiddenObjects {
    fn extend<T: IntoIterator<Item = ObjectId>>(&mut self, objects: T) {
        self.0.extend(objects);
    }
}

impl FromIterator<ObjectId> for HiddenObjects {
    fn from_iter<T: IntoIterator<Item = ObjectId>>(objects: T) -> Self {
        Self(objects.into_iter().collect())
    }
}
