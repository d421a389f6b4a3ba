//! Compiling a planet with what is there already: an earlier terrain, or the world maps of a store.

use super::coarse::CellFields;
use super::edits::Memory;
use super::{Revision, Terrain};
use crate::planet::{InvalidPlanet, Planet};
use crate::world::{MapStore, MapWork, World};
use std::sync::Arc;
use std::time::Instant;

/// A terrain to be: [`Terrain::builder`].
#[derive(Clone, Debug)]
#[must_use]
pub struct TerrainBuilder {
    planet: Arc<Planet>,
    world: World,
    /// The revision and the memory of an earlier terrain.
    before: Option<Revision>,
    memory: Arc<Memory>,
}

impl TerrainBuilder {
    /// Takes the world maps and ground edits of another terrain that this planet has, too, and its store. What changed
    /// decides: a name, a biome or a layer over the structure costs nothing to speak of, a seed all of the structure.
    /// The result is the same as without.
    pub fn reuse(mut self, other: &Terrain) -> Self {
        let store = self.world.store.take();
        self.world = other.world().clone();
        self.world.store = store.or_else(|| self.world.store.take());
        (self.before, self.memory) = (Some(other.revision.clone()), other.memory.clone());
        self
    }

    /// Reads world maps from a store where it has them. Those that it lacks are solved, and written to it.
    pub fn store(mut self, store: Arc<MapStore>) -> Self {
        self.world.store = Some(store);
        self
    }

    /// The terrain.
    ///
    /// # Errors
    /// As [`Terrain::try_new`].
    pub fn build(self) -> Result<Terrain, InvalidPlanet> {
        self.build_with(&CellFields::default(), &mut MapWork::default())
    }

    /// The terrain, if nobody stops it: `go_on` is asked again and again, from several threads, with the share of the
    /// work that is done (0 to 1). If it answers no, the answer is None.
    ///
    /// # Errors
    /// As [`Terrain::try_new`].
    pub fn build_while(self, go_on: &(dyn Fn(f64) -> bool + Sync)) -> Result<Option<Terrain>, InvalidPlanet> {
        let (fields, mut work) = (CellFields::default(), MapWork::default());
        let begun = Instant::now();
        let mut terrain = self.draft()?;
        while !terrain.has_final_maps() {
            let done = terrain.map_progress();
            match terrain.with_next_map(&fields, &|| go_on(done), &mut work) {
                Some(next) => terrain = next,
                None => return Ok(None),
            }
        }
        log::debug!("{}: ready in {:.2} s", terrain.planet().name, begun.elapsed().as_secs_f64());
        Ok(Some(terrain))
    }

    /// As [`TerrainBuilder::build`], with layer fields that are kept for the next time, and a count of the work.
    pub(crate) fn build_with(self, fields: &CellFields, work: &mut MapWork) -> Result<Terrain, InvalidPlanet> {
        let mut terrain = self.draft()?;
        while let Some(next) = terrain.with_next_map(fields, &|| true, work) {
            terrain = next;
        }
        Ok(terrain)
    }

    /// The terrain with the world maps that are there.
    pub(crate) fn draft(self) -> Result<Terrain, InvalidPlanet> {
        let revision = Revision::try_after(self.planet, self.before.as_ref())?;
        Ok(Terrain::draft(&revision, &self.world, self.memory))
    }
}

impl Terrain {
    /// A planet to be compiled with what an earlier terrain or a store has of it already.
    pub fn builder(planet: Arc<Planet>) -> TerrainBuilder {
        TerrainBuilder { planet, world: World::default(), before: None, memory: Arc::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Structure, shipped};
    use crate::sphere::spread;

    #[test]
    fn a_planet_takes_over_the_maps_that_it_shares_with_another_and_no_others() {
        let structure = Some(Structure { grids: 1, ..Structure::default() });
        let planet = Planet { structure, ..shipped::layered() };
        let dirs: Vec<_> = spread(300).collect();
        let build = |builder: TerrainBuilder| {
            let mut work = MapWork::default();
            let terrain = builder.build_with(&CellFields::default(), &mut work).unwrap();
            (terrain, work.runs)
        };
        let (first, runs) = build(Terrain::builder(planet.clone().into()));
        assert!(runs >= 3, "{runs}");
        let mut renamed = planet.clone();
        renamed.name.push('!');
        renamed.biomes.palette[0].name.push('!');
        let (second, runs) = build(Terrain::builder(renamed.clone().into()).reuse(&first));
        assert_eq!((runs, second.planet().name.as_str()), (0, renamed.name.as_str()));
        assert_eq!(second.heights_m(&dirs), first.heights_m(&dirs));
        // Another planet gets maps of its own, whatever it was given.
        let other = Arc::new(Planet { seed: planet.seed + 1, ..planet });
        let (third, runs) = build(Terrain::builder(other.clone()).reuse(&second));
        assert!(runs >= 3 && third.heights_m(&dirs) != first.heights_m(&dirs));
        assert_eq!(third.heights_m(&dirs), Terrain::try_new(other).unwrap().heights_m(&dirs));
    }
}
