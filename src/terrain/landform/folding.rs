//! A landform steered by belts of folded rock.
//!
//! The landform is evaluated at points that the folds displace away from the centre of the planet, by a distance that
//! grows across a belt and not along it ([`crate::world::plates::Crust::across_rad`]). So the sphere on which solid
//! noise is cut becomes a slope there, and the cut shows features narrower across the belt than along it. The
//! displacement is always at right angles to the ground, hence narrower in every place and direction.

use super::chunk::Chunk;
use super::scratch::{Folded, Jacobian64, Scratch};
use super::varying::Around;
use super::{Evaluate, Landform};
use crate::planet::Key;
use crate::world::plates::{Across, Plates};
use glam::DVec3;
use std::sync::{Arc, Weak};

/// A landform, how strongly folds steer it, and the map of them.
#[derive(Clone)]
pub(crate) struct Folding {
    landform: Landform,
    strength: f64,
    key: Option<Key>,
    /// Weak, because fields of earlier revisions must not keep their maps alive.
    across: Weak<Across>,
}

impl Folding {
    /// Not steered until the plates are known.
    pub(super) fn new(landform: Landform, strength: f64) -> Self {
        Self { landform, strength, key: None, across: Weak::new() }
    }

    /// The same landform over these plates.
    pub(super) fn over(&self, plates: Option<(Key, &Plates)>) -> Self {
        let (key, across) =
            plates.map_or((None, Weak::new()), |(key, plates)| (Some(key), Arc::downgrade(plates.across())));
        Self { landform: self.landform.clone(), strength: self.strength, key, across }
    }

    /// How much narrower features become, at most.
    fn squeeze(&self) -> f64 {
        libm::hypot(1.0, self.strength)
    }
}

impl PartialEq for Folding {
    fn eq(&self, other: &Self) -> bool {
        (self.key, self.strength, &self.landform) == (other.key, other.strength, &other.landform)
    }
}

impl std::fmt::Debug for Folding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Folding").field(&self.landform).field(&self.strength).field(&self.key).finish()
    }
}

impl Evaluate for Folding {
    fn octave_count(&self) -> usize {
        self.landform.octave_count()
    }

    fn bounds(&self) -> (f64, f64) {
        self.landform.bounds()
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let Some(across) = self.across.upgrade() else { return self.landform.bounds_near(dir_planet, angle_rad) };
        let rise = self.strength * across.steepest * angle_rad;
        let from_centre = 1.0 + self.strength * across.raster.value(&across.raster.place(dir_planet), 0);
        let angle_rad = angle_rad * (from_centre + rise);
        self.landform.evaluate().bounds_around(Around { dir_planet, angle_rad, from_centre, rise })
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let landform = self.landform.evaluate();
        let Some(across) = self.across.upgrade() else { return landform.add_to(chunk, scratch) };
        let mut folded = scratch.folded.take().unwrap_or_default();
        folded.find(&across, self.strength, chunk);
        let chunk = Chunk { squeeze: self.squeeze(), ..*chunk };
        landform.add_folded(&chunk, &folded, scratch);
        scratch.folded = Some(folded);
    }
}

impl Folded {
    /// Displaces the points of a chunk. A point `p` goes to `p s`, with `s` from 1 on; the derivative of that by `p` is
    /// `s` on the diagonal, and `p` times the gradient of `s`.
    fn find(&mut self, across: &Across, strength: f64, chunk: &Chunk<'_>) {
        let Self { displaced, jacobian: Jacobian64(jacobian) } = self;
        let bands = chunk.spacings_rad.len().max(1);
        displaced.restart(chunk.len(), bands, true);
        for (i, dir) in chunk.dirs.iter().enumerate() {
            let (distance, gradient) = across.raster.sample(&across.raster.place(*dir), 0);
            let (scale, slope) = (1.0 + strength * distance, (gradient - *dir * gradient.dot(*dir)) * strength);
            for (lane, skewed) in displaced.skewed.iter_mut().zip(chunk.skewed) {
                lane[i] = skewed[i] * scale;
            }
            for (row, p) in jacobian.iter_mut().zip(dir.to_array()) {
                for (lane, slope) in row.iter_mut().zip(slope.to_array()) {
                    lane[i] = p * slope;
                }
            }
            for (axis, row) in jacobian.iter_mut().enumerate() {
                row[axis][i] += scale;
            }
        }
        for bands in &mut displaced.jacobians[..bands] {
            for (lane, exact) in bands.iter_mut().flatten().zip(jacobian.iter().flatten()) {
                lane.iter_mut().zip(exact).take(chunk.len()).for_each(|(lane, exact)| *lane = *exact as f32);
            }
        }
    }
}
