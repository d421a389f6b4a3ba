//! Symmetry of an edit: its images around the axis of the planet and across the equator.

use super::{GroundEdit, MAX_EDIT_POINTS};
use glam::DVec3;

/// Most images around the axis.
pub const MAX_TURNS: u32 = 12;

/// How an image of an edit lies to the edit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Image {
    cos: f64,
    sin: f64,
    /// Whether it is a mirror image.
    pub(crate) mirrored: bool,
}

impl Image {
    /// The image of a direction.
    pub(crate) fn of(&self, dir: DVec3) -> DVec3 {
        let z = if self.mirrored { -dir.z } else { dir.z };
        DVec3::new(dir.x * self.cos - dir.y * self.sin, dir.x * self.sin + dir.y * self.cos, z)
    }
}

impl GroundEdit {
    /// How many times the edit is there: once without symmetry.
    pub fn image_count(&self) -> usize {
        self.turns.clamp(1, MAX_TURNS) as usize * if self.mirrored { 2 } else { 1 }
    }

    /// The images besides the edit itself.
    pub(crate) fn images(&self) -> impl Iterator<Item = Image> {
        let turns = self.turns.clamp(1, MAX_TURNS);
        let turned = move |mirrored: bool, turn: u32| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(turn) / f64::from(turns));
            Image { cos, sin, mirrored }
        };
        let mirrored = if self.mirrored { 0..turns } else { 0..0 };
        (1..turns).map(move |turn| turned(false, turn)).chain(mirrored.map(move |turn| turned(true, turn)))
    }

    /// How many points a line may have, so that all of its images have no more than an edit may.
    pub fn most_points(&self) -> usize {
        MAX_EDIT_POINTS / self.image_count()
    }
}
