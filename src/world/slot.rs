//! One world map that serves, the key of what it was solved from, and its next level.

use super::map::{Inputs, Job, WorldMap};
use super::store::MapStore;
use crate::planet::Key;
use std::sync::Arc;
use std::time::Instant;

/// What solving world maps took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapWork {
    /// Levels of maps that were solved.
    pub runs: usize,
    /// Maps that were read from disk.
    pub reads: usize,
    /// Drafts of the structure.
    pub drafts: usize,
    /// Seconds it took.
    pub busy_secs: f64,
    /// The level that was solved last.
    pub last: Option<MapLevel>,
}

/// One level of a world map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapLevel {
    /// Name of the map.
    pub map: &'static str,
    /// Cells along the side of a cube face.
    pub side: usize,
    /// Seconds it took.
    pub secs: f64,
}

/// A map, if there is one.
pub(crate) struct Slot<M>(Option<Served<M>>);

/// Levels from here on are drafts, from which nothing is refined.
const DRAFTS: usize = usize::MAX / 2;

struct Served<M> {
    key: Key,
    /// Index of its side in the sides of the map, or [`DRAFTS`] and the side of the crust that a draft was made from.
    level: usize,
    map: Arc<M>,
}

impl<M> Clone for Slot<M> {
    fn clone(&self) -> Self {
        Self(self.0.as_ref().map(|Served { key, level, map }| Served { key: *key, level: *level, map: map.clone() }))
    }
}

impl<M> Default for Slot<M> {
    fn default() -> Self {
        Self(None)
    }
}

impl<M: WorldMap> Slot<M> {
    /// A draft of a planet's own map, made from the crust on a grid of `side`. None if nothing reads the map.
    pub(super) fn draft(inputs: &Inputs, side: usize, map: M) -> Option<Self> {
        Some(Self(Some(Served { key: M::key(inputs)?, level: DRAFTS + side, map: Arc::new(map) })))
    }

    /// Whether the map that serves is the planet's own, at any level.
    pub(super) fn is_of(&self, inputs: &Inputs) -> bool {
        self.0.as_ref().is_some_and(|served| M::key(inputs) == Some(served.key))
    }

    /// Whether a store has the planet's own finest map.
    pub(super) fn is_stored(&self, store: Option<&MapStore>, inputs: &Inputs) -> bool {
        store.zip(M::key(inputs)).is_some_and(|(store, key)| store.has::<M>(M::SIDES[Self::finest(inputs)], key))
    }

    fn finest(inputs: &Inputs) -> usize {
        M::levels(inputs).clamp(1, M::SIDES.len()) - 1
    }

    /// The map that serves.
    pub(crate) fn map(&self) -> Option<&Arc<M>> {
        self.0.as_ref().map(|served| &served.map)
    }

    /// Key of the map that serves: of what it was solved from, and of its level.
    pub(crate) fn key(&self) -> Option<Key> {
        self.0.as_ref().map(|served| key_at(served.key, served.level))
    }

    /// The [`Slot::key`] of a planet's own finest map.
    pub(crate) fn final_key(inputs: &Inputs) -> Option<Key> {
        M::key(inputs).map(|key| key_at(key, Self::finest(inputs)))
    }

    pub(super) fn serving(&self, inputs: &Inputs) -> Self {
        if M::key(inputs).is_some() { self.clone() } else { Self::default() }
    }

    pub(super) fn is_final(&self, inputs: &Inputs) -> bool {
        self.key() == Self::final_key(inputs)
    }

    /// Cells of the levels that are solved, and of all levels.
    pub(super) fn cells(&self, inputs: &Inputs) -> [usize; 2] {
        let Some(key) = M::key(inputs) else { return [0, 0] };
        let up_to = |levels: usize| M::SIDES[..levels].iter().map(|side| 6 * side * side).sum();
        let own = self.0.as_ref().filter(|served| served.key == key && served.level < DRAFTS);
        let solved = own.map_or(0, |served| served.level + 1);
        let all = Self::finest(inputs) + 1;
        [up_to(solved.min(all)), up_to(all)]
    }

    pub(super) fn step(&self, job: &Job<'_>, work: &mut MapWork) -> Option<Self> {
        let Some(key) = M::key(job.inputs()) else { return Some(Self::default()) };
        let finest = Self::finest(job.inputs());
        let coarser =
            self.0.as_ref().filter(|served| served.key == key && served.level < finest && served.map.can_be_refined());
        let store = job.world.store.as_deref().filter(|_| M::STORED);
        let begun = Instant::now();
        if coarser.is_none()
            && let Some(map) = store.and_then(|store| store.read::<M>(job.inputs(), M::SIDES[finest], key))
        {
            work.reads += 1;
            work.busy_secs += begun.elapsed().as_secs_f64();
            return Some(Self(Some(Served { key, level: finest, map: Arc::new(map) })));
        }
        let level = match (coarser, &self.0) {
            (Some(coarser), _) => coarser.level + 1,
            // A whole map of an earlier revision shows more than a coarse one of this planet would.
            (None, Some(_)) if !M::COARSE_FIRST => finest,
            _ => 0,
        };
        profiling::scope!("world map");
        let map = M::solve(job, M::SIDES[level], coarser.map(|coarser| &*coarser.map));
        let secs = begun.elapsed().as_secs_f64();
        work.busy_secs += secs;
        let map = Arc::new(map?);
        if let Some(store) = store.filter(|_| level == finest) {
            store.write(&*map, M::SIDES[level], key);
        }
        work.runs += 1;
        work.last = Some(MapLevel { map: M::NAME, side: M::SIDES[level], secs });
        Some(Self(Some(Served { key, level, map })))
    }
}

fn key_at(key: Key, level: usize) -> Key {
    Key::of(&(key, level))
}

#[cfg(test)]
mod tests {
    use super::super::World;
    use super::super::cells::Cells;
    use super::super::map::{Ground, KeepGoing};
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// A planet of which a map reads one number.
    struct Number(Inputs);

    impl Number {
        fn new(number: Option<f64>) -> Self {
            let heights = Key::default();
            Self(Inputs {
                heights,
                under: None,
                sea_level_m: number,
                reads_coast: true,
                structure: None,
                sculpted: None,
                grids: 0,
            })
        }
    }

    impl Ground for Number {
        fn inputs(&self) -> &Inputs {
            &self.0
        }
        fn heights_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
            keep_going().then(|| vec![self.0.sea_level_m.unwrap_or(0.0); cells.dirs.len()])
        }
        fn under_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
            self.heights_m(cells, keep_going)
        }
    }

    /// The number and the level.
    struct Echo(f64, usize);

    impl WorldMap for Echo {
        const NAME: &'static str = "echo";
        const SIDES: &'static [usize] = &[4, 8, 16];
        fn key(inputs: &Inputs) -> Option<Key> {
            inputs.sea_level_m.map(|number| Key::of(&number))
        }
        fn solve(job: &Job<'_>, side: usize, coarser: Option<&Self>) -> Option<Self> {
            assert!(coarser.is_none_or(|coarser| coarser.1 * 2 == side));
            Some(Self(*job.ground.heights_m(&Cells::of(side), job.keep_going)?.first()?, side))
        }
    }

    fn served(slot: &Slot<Echo>) -> Option<(f64, usize)> {
        slot.map().map(|echo| (echo.0, echo.1))
    }

    #[test]
    fn a_first_map_comes_coarse_to_fine_and_an_old_one_serves_until_the_new_one_is_whole() {
        let (one, two, none) = (Number::new(Some(1.0)), Number::new(Some(2.0)), Number::new(None));
        let mut work = MapWork::default();
        let step = |slot: &Slot<Echo>, ground: &Number, work: &mut MapWork| {
            let job = Job { ground, world: &World::default(), keep_going: &|| true };
            slot.step(&job, work).unwrap()
        };
        let mut slot = Slot::<Echo>::default().serving(&one.0);
        for side in [4, 8, 16] {
            assert!(!slot.is_final(&one.0));
            slot = step(&slot, &one, &mut work);
            assert_eq!(served(&slot), Some((1.0, side)));
        }
        assert!(slot.is_final(&one.0) && !slot.is_final(&two.0));
        assert_eq!(served(&slot.serving(&two.0)), Some((1.0, 16)), "the old map serves");
        let new = step(&slot.serving(&two.0), &two, &mut work);
        assert_eq!((served(&new), new.is_final(&two.0), work.runs), (Some((2.0, 16)), true, 4));
        assert_eq!(served(&new.serving(&none.0)), None, "a map that nothing reads is dropped");
        assert!(new.serving(&none.0).is_final(&none.0));
    }

    #[test]
    fn a_map_that_is_not_wanted_any_more_is_given_up() {
        let asked = AtomicUsize::new(0);
        let mut work = MapWork::default();
        let keep_going = || asked.fetch_add(1, Ordering::Relaxed) > 0;
        let (slot, ground) = (Slot::<Echo>::default(), Number::new(Some(1.0)));
        let job = Job { ground: &ground, world: &World::default(), keep_going: &keep_going };
        assert!(slot.step(&job, &mut work).is_none());
        assert_eq!((work.runs, asked.into_inner()), (0, 1));
    }
}
