//! The ground that rivers carve (see [`crate::world::carved`]), as a field.
//!
//! Coarse tiles show fewer levels of rivers than fine ones: a valley narrower than the distance between two points
//! cannot be seen, and finding it would take as long as all others together.

use super::{Chunk, Evaluate, Scratch};
use crate::planet::Key;
use crate::terrain::wet::Water;
use crate::world::carved::Carved;
use crate::world::rivers::{Cache, Flow, RiverPoint, Rivers};
use glam::DVec3;
use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::{Arc, Weak};

/// Cells of the finest level of rivers in a value are at least as wide as this many points.
const VALUE_POINTS: f64 = 2.0;
/// The same for gradients: slopes of narrower valleys would look like noise.
const GRADIENT_POINTS: f64 = 3.0;

/// The carved ground. Fields of earlier revisions must not keep its maps alive, so it refers to them weakly.
#[derive(Clone)]
pub(crate) struct Structure {
    key: Option<Key>,
    rivers: Weak<Rivers>,
    bounds: (f64, f64),
}

impl Structure {
    pub(super) fn new(carved: Option<(Key, &Carved)>) -> Self {
        match carved {
            Some((key, carved)) => Self {
                key: Some(key),
                rivers: Arc::downgrade(&carved.rivers),
                bounds: carved.rivers.bounds_near(DVec3::Z, PI),
            },
            None => Self { key: None, rivers: Weak::new(), bounds: (0.0, 0.0) },
        }
    }
}

thread_local! {
    /// The blocks of rivers that the thread uses, and its last answers.
    static MEMORY: RefCell<Memory> = RefCell::default();
}

#[derive(Default)]
struct Memory {
    cache: Cache,
    points: Vec<RiverPoint>,
    flows: Vec<Flow>,
}

/// The greatest distance between points, as an angle, at which values have the coarsest level of rivers. `side`: cells
/// along the side of a face of the solved drainage.
pub(crate) fn coarsest_spacing_rad(side: usize) -> f64 {
    (2.0 / (side as f64 * VALUE_POINTS)).next_down()
}

/// Evaluates rivers at unit directions, on the levels that points `spacing_rad` apart show (0: on all). Allocates
/// nothing once the blocks around have been built.
pub(crate) fn river_points(rivers: &Rivers, dirs: &[DVec3], spacing_rad: f64, answer: impl FnOnce(&[RiverPoint])) {
    MEMORY.with_borrow_mut(|Memory { cache, points, .. }| {
        rivers.evaluate(dirs, rivers.levels_for(spacing_rad, VALUE_POINTS), cache, points);
        answer(points);
    });
}

impl PartialEq for Structure {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl std::fmt::Debug for Structure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Structure").field(&self.key).finish()
    }
}

impl Evaluate for Structure {
    fn octave_count(&self) -> usize {
        0
    }

    fn bounds(&self) -> (f64, f64) {
        self.bounds
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        self.rivers.upgrade().map_or(self.bounds, |rivers| rivers.bounds_near(dir_planet, angle_rad))
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Some(rivers) = self.rivers.upgrade() else { return };
        MEMORY.with_borrow_mut(|Memory { cache, points, flows }| {
            let levels = rivers.levels_for(chunk.point_spacing_rad, VALUE_POINTS);
            rivers.evaluate(chunk.dirs, levels, cache, points);
            for (value, point) in scratch.sums.value.iter_mut().zip(&*points) {
                *value += point.height_m;
            }
            for (gradient, &spacing_rad) in scratch.sums.gradients_mut().iter_mut().zip(chunk.spacings_rad) {
                let seen = rivers.levels_for(spacing_rad, GRADIENT_POINTS).min(levels);
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
