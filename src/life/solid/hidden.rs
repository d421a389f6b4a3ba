//! Objects that a game hides: those it has felled, taken or replaced by its own.

use crate::life::Instance;
use crate::planet::Planet;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::{BTreeMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

/// An object of a planet: the same wherever and whenever it is asked for; see [`Instance::id`].
///
/// It names its population by the seed, which stays when populations are renamed, put into another order, added and
/// removed. A population with another seed has other objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ObjectId {
    /// Seed of its population.
    pub seed: u32,
    /// Its id in the population.
    pub id: u64,
}

impl ObjectId {
    /// Index of its population in [`Planet::life`]; None if the planet has none with this seed. The first, if several
    /// have it: give each a seed of its own.
    pub fn population(self, planet: &Planet) -> Option<usize> {
        planet.life.iter().position(|population| population.seed == self.seed)
    }
}

/// Objects that are neither hit nor drawn: an [`ObjectPatch`](super::ObjectPatch) leaves them out, and so does a
/// picture whose body has them.
///
/// It is saved as the list of its objects in ascending order. Objects stay in it when their population is taken from
/// the planet, and are hidden again when it comes back; see [`HiddenObjects::strangers`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HiddenObjects {
    /// For each seed of a population, ids: at least one.
    by_seed: BTreeMap<u32, Ids>,
}

/// Ids of objects, which are hashes already.
type Ids = HashSet<u64, BuildHasherDefault<IdHasher>>;

/// Hash of an id: the id itself.
#[derive(Clone, Copy, Default)]
struct IdHasher(u64);

impl Hasher for IdHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.0 = self.0.rotate_left(8) ^ u64::from(*byte));
    }

    fn write_u64(&mut self, id: u64) {
        self.0 = id;
    }
}

/// The hidden objects of one population.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HiddenOf<'a>(Option<&'a Ids>);

impl HiddenOf<'_> {
    pub(crate) fn holds(&self, id: u64) -> bool {
        self.0.is_some_and(|ids| ids.contains(&id))
    }
}

impl HiddenObjects {
    /// Hides an object. Whether it was there before.
    pub fn hide(&mut self, object: ObjectId) -> bool {
        self.by_seed.entry(object.seed).or_default().insert(object.id)
    }

    /// Shows an object again. Whether it was hidden.
    pub fn show(&mut self, object: ObjectId) -> bool {
        let Some(ids) = self.by_seed.get_mut(&object.seed) else { return false };
        let was_hidden = ids.remove(&object.id);
        if ids.is_empty() {
            self.by_seed.remove(&object.seed);
        }
        was_hidden
    }

    /// Whether an object is hidden.
    pub fn holds(&self, object: ObjectId) -> bool {
        self.of_seed(object.seed).holds(object.id)
    }

    /// Hidden objects of the population with a seed.
    pub(crate) fn of_seed(&self, seed: u32) -> HiddenOf<'_> {
        HiddenOf(self.by_seed.get(&seed))
    }

    /// All hidden objects, in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = ObjectId> {
        self.by_seed.iter().flat_map(|(seed, ids)| {
            let mut ids: Vec<u64> = ids.iter().copied().collect();
            ids.sort_unstable();
            ids.into_iter().map(|id| ObjectId { seed: *seed, id })
        })
    }

    /// Hidden objects whose population a planet does not have, in ascending order: a save may be older than the preset.
    /// They hide nothing there.
    pub fn strangers(&self, planet: &Planet) -> impl Iterator<Item = ObjectId> {
        self.iter().filter(|object| object.population(planet).is_none())
    }

    /// Number of hidden objects.
    pub fn len(&self) -> usize {
        self.by_seed.values().map(HashSet::len).sum()
    }

    /// Whether none is hidden.
    pub fn is_empty(&self) -> bool {
        self.by_seed.is_empty()
    }

    /// Takes hidden objects from a list, such as that of [`Terrain::instances`](crate::terrain::Terrain::instances).
    pub fn retain_shown(&self, instances: &mut Vec<Instance>) {
        instances.retain(|instance| !self.holds(instance.object()));
    }
}

impl Extend<ObjectId> for HiddenObjects {
    fn extend<T: IntoIterator<Item = ObjectId>>(&mut self, objects: T) {
        objects.into_iter().for_each(|object| {
            self.hide(object);
        });
    }
}

impl FromIterator<ObjectId> for HiddenObjects {
    fn from_iter<T: IntoIterator<Item = ObjectId>>(objects: T) -> Self {
        let mut hidden = Self::default();
        hidden.extend(objects);
        hidden
    }
}

impl Serialize for HiddenObjects {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for HiddenObjects {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Vec::<ObjectId>::deserialize(deserializer)?.into_iter().collect())
    }
}
