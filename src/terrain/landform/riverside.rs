//! How far layers over the structure stand from its rivers and lakes, as a field: 0 in the water of rivers, little in
//! lakes, 1 where none is near. It masks every layer over the structure, so that none buries a river. It is no kind of
//! layer.

use super::structure::{Solved, layer_shares};
use super::{Chunk, Evaluate, Scratch};
use crate::planet::Key;
use crate::world::carved::Carved;

/// The riversides of a planet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Riverside(Solved);

impl Riverside {
    pub(super) fn new(carved: Option<(Key, &Carved)>) -> Self {
        Self(Solved::new(carved))
    }
}

impl Evaluate for Riverside {
    fn octave_count(&self) -> usize {
        0
    }

    fn bounds(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Some(rivers) = self.0.rivers() else {
            scratch.sums.value[..chunk.len()].fill(1.0);
            return;
        };
        layer_shares(&rivers, chunk, |shares, levels, seen| {
            for (value, share) in scratch.sums.value.iter_mut().zip(shares) {
                *value += share[levels].value;
            }
            for (gradient, &seen) in scratch.sums.gradients_mut().iter_mut().zip(seen) {
                for (i, share) in shares.iter().enumerate() {
                    for (lane, slope) in gradient.iter_mut().zip(share[seen].gradient.to_array()) {
                        lane[i] += slope as f32;
                    }
                }
            }
        });
    }
}
