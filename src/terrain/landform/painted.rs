//! A mask of layers that is painted by hand, as a field: 0 where no stroke is, up to 1.

use super::{Chunk, Evaluate, Scratch};
use crate::planet::Key;
use crate::terrain::edits::{Edits, MaskId, Subject, chord_of};
use glam::DVec3;
use std::fmt;
use std::sync::{Arc, Weak};

/// Fields of earlier revisions must not keep their edits alive, so it refers to them weakly.
#[derive(Clone)]
pub(crate) struct Painted {
    mask: MaskId,
    edits: Weak<Edits>,
    /// Of the strokes of all masks. None if there are none.
    key: Option<Key>,
}

impl Painted {
    pub(super) fn new(mask: MaskId, edits: Option<&Arc<Edits>>) -> Self {
        Self {
            mask,
            edits: edits.map(Arc::downgrade).unwrap_or_default(),
            key: edits.and_then(|e| e.key(Subject::Masks)),
        }
    }

    /// The key of the strokes of all masks. None if there are none.
    pub(super) fn key(&self) -> Option<Key> {
        self.key
    }
}

impl PartialEq for Painted {
    fn eq(&self, other: &Self) -> bool {
        (self.mask, self.key) == (other.mask, other.key)
    }
}

/// Without the strokes: a tile depends on those near it alone, and its key holds theirs.
impl fmt::Debug for Painted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Painted").field(&self.mask).finish()
    }
}

impl Evaluate for Painted {
    fn octave_count(&self) -> usize {
        0
    }

    fn bounds(&self) -> (f64, f64) {
        (0.0, if self.key.is_some() { 1.0 } else { 0.0 })
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let may = self.edits.upgrade().is_some_and(|edits| edits.may_mask((dir_planet, chord_of(angle_rad))));
        (0.0, if may { 1.0 } else { 0.0 })
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Some(edits) = self.edits.upgrade() else { return };
        let sums = &mut scratch.sums;
        edits.masked(self.mask, chunk.dirs, chunk.spacings_rad, |i, value, gradients| {
            sums.value[i] += value;
            for (lanes, gradient) in sums.gradients_mut().iter_mut().zip(gradients) {
                for (lane, slope) in lanes.iter_mut().zip(gradient.to_array()) {
                    lane[i] += slope as f32;
                }
            }
        });
    }
}
