//! Edits that change what a structure is solved from: paint of uplift, of rock and of rain, and courses of rivers.

use super::near::Near;
use super::paint::Paint;
use super::roster::Roster;
use super::{Edits, Subject};
use crate::planet::Tool;
use crate::planet::edits::{EditPoint, RiverCourse};
use crate::world::{DrawnCourse, Sculpted};
use glam::DVec3;
use rayon::prelude::*;

/// Farthest that a river strays.
const MOST_WANDER_RAD: f64 = 0.5;
/// Points painted at a time.
const CHUNK: usize = 4096;

/// Paint of the structure, in the order of its keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StructurePaint {
    Uplift,
    Rock,
    Rain,
}

impl Edits {
    /// Rivers whose courses are drawn by hand, in the order of the edits.
    pub(crate) fn courses(&self) -> &[DrawnCourse] {
        &self.courses
    }

    /// Paint of the structure at points. None if there is none anywhere.
    pub(crate) fn sculpted(&self, dirs: &[DVec3]) -> Option<Sculpted> {
        if self.index(Subject::Structure).is_empty() {
            return None;
        }
        let mut sculpted = Sculpted::none(dirs.len());
        let Sculpted { uplift_m, hardness, rain_mm } = &mut sculpted;
        let chunks = uplift_m.par_chunks_mut(CHUNK).zip(hardness.par_chunks_mut(CHUNK));
        let chunks = chunks.zip(rain_mm.par_chunks_mut(CHUNK)).zip(dirs.par_chunks(CHUNK));
        chunks.for_each(|(((uplift_m, hardness), rain_mm), dirs)| {
            self.each_weight(
                Subject::Structure,
                dirs,
                &mut Near::default(),
                |_| true,
                |i, edit, weight, share| {
                    let Some(Paint::Structure(kind, amount)) = edit.paint() else { return };
                    let quantity = match kind {
                        StructurePaint::Uplift => &mut uplift_m[i],
                        StructurePaint::Rock => &mut hardness[i],
                        StructurePaint::Rain => &mut rain_mm[i],
                    };
                    *quantity += amount * (weight * share);
                },
            );
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
