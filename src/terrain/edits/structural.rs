//! Edits that change what a structure is solved from: paint of uplift, of rock and of rain, and courses of rivers.

use super::Edits;
use super::compiled::CompiledEdit;
use super::near::{Hit, Near, Touch};
use super::roster::Roster;
use crate::planet::edits::{EditPoint, RiverCourse};
use crate::planet::{Key, Tool};
use crate::world::{DrawnCourse, Sculpted};
use glam::DVec3;
use rayon::prelude::*;

/// Farthest that a river strays.
const MOST_WANDER_RAD: f64 = 0.5;
/// Points painted at a time.
const CHUNK: usize = 4096;

/// Paint of the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StructurePaint {
    Uplift { uplift_m: f64 },
    Rock { hardness: f64 },
    Rain { rain_mm: f64 },
}

impl Edits {
    /// The key of all edits of the structure. None if there is none.
    pub(crate) fn structure_key(&self) -> Option<Key> {
        let is_none = self.structural.is_empty() && self.courses.is_empty();
        let key = || Key::of(&(self.structural.key_of_all(), &self.courses));
        (!is_none).then(|| Self::with_masks(key(), self.masked.structure, || self.mask_key()))
    }

    /// Rivers whose courses are drawn by hand, in the order of the edits.
    pub(crate) fn courses(&self) -> &[DrawnCourse] {
        &self.courses
    }

    /// Paint of the structure at points. None if there is none anywhere.
    pub(crate) fn sculpted(&self, dirs: &[DVec3]) -> Option<Sculpted> {
        if self.structural.is_empty() {
            return None;
        }
        let mut sculpted = Sculpted::none(dirs.len());
        let Sculpted { uplift_m, hardness, rain_mm } = &mut sculpted;
        let chunks = uplift_m.par_chunks_mut(CHUNK).zip(hardness.par_chunks_mut(CHUNK));
        let chunks = chunks.zip(rain_mm.par_chunks_mut(CHUNK)).zip(dirs.par_chunks(CHUNK));
        chunks.for_each(|(((uplift_m, hardness), rain_mm), dirs)| {
            let all = |_: u32, _: &CompiledEdit| true;
            Near::default().each_touch(&self.structural, &self.roster, dirs, all, |Touch { edit, hits, .. }| {
                let Some(paint) = edit.structure_paint() else { return };
                let shares = self.shares(edit, hits.iter().map(|hit| dirs[hit.point]), &[]);
                for (own, Hit { point: i, nearest }) in hits.iter().enumerate() {
                    let (i, weight) = (*i, edit.weight(dirs[*i], nearest) * shares.of(own));
                    match paint {
                        StructurePaint::Uplift { uplift_m: by_m } => uplift_m[i] += by_m * weight,
                        StructurePaint::Rock { hardness: by } => hardness[i] += by * weight,
                        StructurePaint::Rain { rain_mm: by_mm } => rain_mm[i] += by_mm * weight,
                    }
                }
            });
        });
        Some(sculpted)
    }
}

/// The rivers of a roster whose courses are drawn by hand.
pub(super) fn courses_of(roster: &Roster, radius_m: f64) -> Vec<DrawnCourse> {
    let mut courses = Vec::new();
    for edit in roster.shared().map(|shared| &shared.edit) {
        let Tool::River(RiverCourse { spring_m3_s, cut }) = edit.tool else { continue };
        let points: Vec<DVec3> = edit.points.0.iter().map(EditPoint::direction).collect();
        let wander_rad = (edit.raggedness * edit.radius_km * 1000.0 / radius_m).min(MOST_WANDER_RAD);
        let course = DrawnCourse { points, wander_rad, seed: edit.seed, spring_m3_s, cut };
        let images = edit.images().map(|image| {
            let points = course.points.iter().map(|dir| image.of(*dir)).collect();
            DrawnCourse { points, ..course.clone() }
        });
        let images: Vec<DrawnCourse> = images.collect();
        courses.push(course);
        courses.extend(images);
    }
    courses
}
