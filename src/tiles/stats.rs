//! Statistics of a build: runs and times of each stage, and memory use.

use super::horizon::HorizonWork;
use crate::planet::param::{Stage, Stages};
use crate::world::MapWork;
use std::time::Instant;

/// What building a surface took, over all slices of its request.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BuildStats {
    /// Tiles in the surface.
    pub tiles: usize,
    /// Vertices in the surface.
    pub vertices: usize,
    /// Tiles built or given a new climate: those of the surface and their ancestors.
    pub tiles_built: usize,
    /// Octaves of noise times points that were evaluated, for tiles and world maps.
    pub octave_samples: usize,
    /// Seconds from the request to the finished surface.
    pub duration_secs: f64,
    /// Seconds it took to compile the planet.
    pub compile_secs: f64,
    /// Seconds it took to choose the LOD cut.
    pub select_secs: f64,
    /// Slices that the work took. Each ended with a complete surface.
    pub slices: usize,
    /// What solving its world maps took.
    pub maps: MapWork,
    /// What its horizon angles took, after its tiles.
    pub horizons: HorizonWork,
    stages: PerStage,
}

/// One entry for each stage of [`Stage::ALL`]; only those of [`Stages::OF_TILES`] run here.
type PerStage = [StageWork; Stage::ALL.len()];

/// What one stage took, on all threads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StageWork {
    /// Number of runs: one for each tile, and for [`Stage::Field`] one for each layer of each tile.
    pub runs: usize,
    /// Seconds it ran, summed over all threads.
    pub busy_secs: f64,
    /// Start of the first run, in seconds from the request.
    pub begin_secs: f64,
    /// End of the last run, in seconds from the request.
    pub end_secs: f64,
}

impl BuildStats {
    /// What one stage took.
    pub fn stage(&self, stage: Stage) -> StageWork {
        self.stages[stage as usize]
    }

    /// The stages that ran.
    pub fn ran(&self) -> Stages {
        Stage::ALL.into_iter().filter(|stage| self.stage(*stage).runs > 0).collect()
    }

    /// Adds the work of a thread.
    pub(crate) fn add(&mut self, work: &Work) {
        self.tiles_built += work.tiles;
        self.octave_samples += work.octave_samples;
        for (sum, stage) in self.stages.iter_mut().zip(work.stages) {
            sum.add(stage);
        }
    }
}

impl StageWork {
    fn add(&mut self, other: StageWork) {
        if other.runs == 0 {
            return;
        }
        let first = self.runs == 0;
        self.runs += other.runs;
        self.busy_secs += other.busy_secs;
        self.begin_secs = if first { other.begin_secs } else { self.begin_secs.min(other.begin_secs) };
        self.end_secs = self.end_secs.max(other.end_secs);
    }
}

/// The work of one thread.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    origin: Instant,
    /// Tiles finished.
    pub(crate) tiles: usize,
    /// Octaves times points that were evaluated.
    pub(crate) octave_samples: usize,
    stages: PerStage,
}

impl Work {
    /// No work; times count from `origin`.
    pub(crate) fn since(origin: Instant) -> Self {
        Self { origin, tiles: 0, octave_samples: 0, stages: Default::default() }
    }

    /// Runs a stage of a tile and records it.
    pub(crate) fn run<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let result = work();
        let secs = |at: Instant| at.duration_since(self.origin).as_secs_f64();
        let (begin_secs, end_secs) = (secs(begun), secs(Instant::now()));
        self.stages[stage as usize].add(StageWork { runs: 1, busy_secs: end_secs - begin_secs, begin_secs, end_secs });
        result
    }
}

/// Memory use of the builder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Memory {
    /// Bytes in tiles, their inputs, and the layer fields behind world maps.
    pub used_bytes: usize,
    /// Greatest number of bytes, unless the tiles on screen need more.
    pub budget_bytes: usize,
    /// Number of tiles.
    pub tiles: usize,
    /// Number of horizon tiles.
    pub horizons: usize,
    /// Number of layer fields, of this revision and of earlier ones.
    pub fields: usize,
}
