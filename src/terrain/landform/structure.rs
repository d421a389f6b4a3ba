//! The ground that rivers carve (see [`crate::world::carved`]), as a field.
//!
//! Coarse tiles show fewer levels of rivers than fine ones: a valley narrower than the distance between two points
//! cannot be seen, and finding it would take as long as all others together.

use super::{Chunk, Evaluate, MAX_BANDS, Scratch};
use crate::planet::Key;
use crate::terrain::wet::Water;
use crate::world::carved::Carved;
use crate::world::rivers::{Cache, Flow, Jet, LEVELS, RiverPoint, Rivers};
use glam::DVec3;
use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::{Arc, Weak};

/// Cells of the finest level of rivers in a value are at least as wide as this many points.
const VALUE_POINTS: f64 = 2.0;
/// The same for gradients: slopes of narrower valleys would look like noise.
const GRADIENT_POINTS: f64 = 3.0;

/// The solved rivers of a planet, with their key; none until they are solved. Fields of earlier revisions must not keep
/// the maps alive, so this refers to them weakly.
#[derive(Clone)]
pub(super) struct Solved {
    key: Option<Key>,
    rivers: Weak<Rivers>,
}

impl Solved {
    pub(super) fn new(carved: Option<(Key, &Carved)>) -> Self {
        let rivers = carved.map_or_else(Weak::new, |(_, carved)| Arc::downgrade(&carved.rivers));
        Self { key: carved.map(|(key, _)| key), rivers }
    }

    /// The rivers, if they are solved and the planet still has them.
    pub(super) fn rivers(&self) -> Option<Arc<Rivers>> {
        self.rivers.upgrade()
    }
}

impl PartialEq for Solved {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl std::fmt::Debug for Solved {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Solved").field(&self.key).finish()
    }
}

/// The carved ground.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Structure {
    solved: Solved,
    bounds: (f64, f64),
}

impl Structure {
    pub(super) fn new(carved: Option<(Key, &Carved)>) -> Self {
        let bounds = carved.map_or((0.0, 0.0), |(_, carved)| carved.rivers.bounds_near(DVec3::Z, PI));
        Self { solved: Solved::new(carved), bounds }
    }
}

thread_local! {
    /// The blocks of rivers that the thread uses, and its last answers.
    static MEMORY: RefCell<Memory> = RefCell::default();
}

#[derive(Default)]
struct Memory {
    cache: Cache,
    /// The answers at the points of the newest chunk.
    points: Vec<RiverPoint>,
    flows: Vec<Flow>,
    banks: Vec<f64>,
    chunks: [LayerShares; CHUNKS],
    newest: usize,
}

/// Chunks whose shares of layers are kept: the layers of a tile are evaluated one after the other.
const CHUNKS: usize = 8;

/// The shares of layers at the points of a chunk, and what they follow from.
#[derive(Default)]
struct LayerShares {
    rivers: u64,
    levels: usize,
    /// Whether they have gradients.
    slopes: bool,
    dirs: Vec<DVec3>,
    shares: Vec<[Jet; LEVELS + 1]>,
}

impl LayerShares {
    fn belongs_to(&self, rivers: &Rivers, dirs: &[DVec3], slopes: bool, levels: usize) -> bool {
        let is_enough = self.slopes || !slopes;
        self.rivers == rivers.number() && self.levels == levels && is_enough && self.dirs == dirs
    }
}

impl Memory {
    /// Evaluates rivers at the points of a chunk, which becomes the newest.
    fn evaluate(&mut self, rivers: &Rivers, dirs: &[DVec3], slopes: bool, spacing_rad: f64, levels: usize) {
        rivers.evaluate(dirs, slopes, levels, &mut self.cache, &mut self.points);
        // Queries ask for one chunk at a time.
        self.newest = if spacing_rad > 0.0 { (self.newest + 1) % CHUNKS } else { 0 };
        let kept = &mut self.chunks[self.newest];
        (kept.rivers, kept.levels, kept.slopes) = (rivers.number(), levels, slopes);
        kept.dirs.clear();
        kept.dirs.extend_from_slice(dirs);
        kept.shares.clear();
        kept.shares.extend(self.points.iter().map(|point| point.layers));
    }
}

/// The shares of layers at the points of a chunk: for each point that beside the rivers of no level, of the first, and
/// so on. `answer` has them with the number of levels of values and of the gradients of each band.
pub(super) fn layer_shares(
    rivers: &Rivers,
    chunk: &Chunk<'_>,
    answer: impl FnOnce(&[[Jet; LEVELS + 1]], usize, &[usize]),
) {
    let (levels, seen) = levels_of(rivers, chunk);
    let slopes = !chunk.spacings_rad.is_empty();
    MEMORY.with_borrow_mut(|memory| {
        let kept = memory.chunks.iter().position(|kept| kept.belongs_to(rivers, chunk.dirs, slopes, levels));
        let kept = kept.unwrap_or_else(|| {
            memory.evaluate(rivers, chunk.dirs, slopes, chunk.point_spacing_rad, levels);
            memory.newest
        });
        answer(&memory.chunks[kept].shares, levels, &seen[..chunk.spacings_rad.len()]);
    });
}

/// The levels of rivers in values, and in the gradients of each band.
fn levels_of(rivers: &Rivers, chunk: &Chunk<'_>) -> (usize, [usize; MAX_BANDS]) {
    let levels = rivers.levels_for(chunk.point_spacing_rad, VALUE_POINTS);
    let mut seen = [0; MAX_BANDS];
    for (seen, &spacing_rad) in seen.iter_mut().zip(chunk.spacings_rad) {
        *seen = rivers.levels_for(spacing_rad, GRADIENT_POINTS).min(levels);
    }
    (levels, seen)
}

/// The greatest distance between points, as an angle, at which values have the coarsest level of rivers. `side`: cells
/// along the side of a face of the solved drainage.
pub(crate) fn coarsest_spacing_rad(side: usize) -> f64 {
    (2.0 / (side as f64 * VALUE_POINTS)).next_down()
}

/// Rivers at unit directions, on the levels that points `spacing_rad` apart show (0: on all). They are not evaluated
/// again if the thread has just done so for the heights there. Allocates nothing once the blocks around are built.
pub(crate) fn river_points(rivers: &Rivers, dirs: &[DVec3], spacing_rad: f64, answer: impl FnOnce(&[RiverPoint])) {
    let levels = rivers.levels_for(spacing_rad, VALUE_POINTS);
    MEMORY.with_borrow_mut(|memory| {
        if !memory.chunks[memory.newest].belongs_to(rivers, dirs, false, levels) {
            memory.evaluate(rivers, dirs, false, spacing_rad, levels);
        }
        answer(&memory.points);
    });
}

/// Distances of unit directions from the nearest bank, as angles, on the levels of [`river_points`]: 0 in a river,
/// infinity where none is known.
pub(crate) fn river_banks(rivers: &Rivers, dirs: &[DVec3], spacing_rad: f64, answer: impl FnOnce(&[f64])) {
    let levels = rivers.levels_for(spacing_rad, VALUE_POINTS);
    MEMORY.with_borrow_mut(|Memory { cache, banks, .. }| {
        rivers.banks(dirs, levels, cache, banks);
        answer(banks);
    });
}

impl Evaluate for Structure {
    fn octave_count(&self) -> usize {
        0
    }

    fn bounds(&self) -> (f64, f64) {
        self.bounds
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        self.solved.rivers().map_or(self.bounds, |rivers| rivers.bounds_near(dir_planet, angle_rad))
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Some(rivers) = self.solved.rivers() else { return };
        let (levels, seen) = levels_of(&rivers, chunk);
        MEMORY.with_borrow_mut(|memory| {
            let slopes = !chunk.spacings_rad.is_empty();
            memory.evaluate(&rivers, chunk.dirs, slopes, chunk.point_spacing_rad, levels);
            let Memory { cache, points, flows, .. } = memory;
            for (value, point) in scratch.sums.value.iter_mut().zip(&*points) {
                *value += point.height_m;
            }
            for (gradient, &seen) in scratch.sums.gradients_mut().iter_mut().zip(&seen) {
                for (i, point) in points.iter().enumerate() {
                    for (lane, slope) in gradient.iter_mut().zip(point.gradients[seen].to_array()) {
                        lane[i] += slope as f32;
                    }
                }
            }
            if chunk.is_drawn() {
                rivers.flows(chunk.dirs, levels, chunk.point_spacing_rad, cache, flows);
                let water = points.iter().zip(&*flows).map(|(point, flow)| Water::new(point, flow));
                scratch.sums.water.extend(water);
            }
        });
    }
}
