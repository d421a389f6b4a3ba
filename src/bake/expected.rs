//! What a bake is expected to take, found by asking some of its points.

use super::{Bake, Detail};
use crate::terrain::Scratch;
use std::time::Instant;

/// Squares of pixels that are asked, and their side.
const SQUARES: u64 = 12;
const SIDE: u32 = 4;

/// What a bake takes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Expected {
    /// Pixels that are not there yet.
    pub pixels: u64,
    /// Seconds for them on this machine, about, with all threads.
    pub secs: f64,
    /// Bytes of all strips on the disk.
    pub strip_bytes: u64,
}

impl Bake {
    /// What a bake with all detail of a structure takes; None for others, which take microseconds a pixel. `folder`:
    /// of the maps, where strips may be already. The terrain has its final maps, and the bake can be made.
    pub fn expected(&self, folder: &std::path::Path) -> Option<Expected> {
        let has_structure = self.terrain.planet().structure.is_some();
        if !has_structure || self.detail != Detail::All || self.check().is_err() {
            return None;
        }
        let strips = self.strips(folder);
        if self.is_finished(folder, &strips) {
            return None;
        }
        let grid = &strips.grid;
        let (width, height) = (u64::from(grid.width), u64::from(grid.height));
        let mine = (0..strips.count()).filter(|number| self.shard.is_none_or(|shard| shard.has(*number)));
        let missing = mine.map(|number| strips.strip(number)).filter(|strip| !strips.seems_there(strip));
        let pixels = missing.map(|strip| width * strip.rows.len() as u64).sum();
        let of_all = width * height * grid.pictures() as u64;
        let channels: u64 = self.maps.iter().map(|map| map.channels() as u64).sum();

        let mut scratch = Scratch::default();
        let mut heights_m = [0.0; (SIDE * SIDE) as usize];
        let begun = Instant::now();
        for square in 0..SQUARES {
            // Spread evenly: an odd number of steps leads through all columns.
            let first = (2 * square + 1) * of_all / (2 * SQUARES);
            let (picture, y) = ((first / (width * height)) as usize, (first / width % height) as u32);
            let x = (square * width * 5 / SQUARES % width) as u32;
            let pixel = |i: u32| ((x + i % SIDE).min(grid.width - 1), (y + i / SIDE).min(grid.height - 1));
            let dirs: Vec<_> = (0..SIDE * SIDE).map(pixel).map(|(x, y)| grid.direction(picture, x, y)).collect();
            self.terrain.heights_spaced_into(&dirs, 0.0, &mut heights_m, &mut scratch);
        }
        let each_secs = begun.elapsed().as_secs_f64() / (SQUARES * u64::from(SIDE * SIDE)) as f64;
        let secs = each_secs * pixels as f64 / rayon::current_num_threads() as f64;
        Some(Expected { pixels, secs, strip_bytes: of_all * channels * size_of::<f32>() as u64 })
    }
}
