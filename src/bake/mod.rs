//! Maps of a planet in files: heights, normals, climate, biomes, water, clouds. Meshes are in [`mesh`].
//!
//! Baked values are the evaluator's: the value of a pixel is what [`Terrain::sample`] answers at the pixel's centre, to
//! half a step of the file's numbers. With [`Detail::Pixel`] it is what the evaluator answers for points as far apart
//! as pixels.
//!
//! A bake computes *strips*, some rows of all its maps, on all cores, and keeps each in a file of its own in a folder
//! beside the maps. When all are there, it encodes the maps from them and removes them. So a bake that was interrupted
//! goes on where it stopped, several machines can share one ([`Shard`]), memory does not grow with the size, and the
//! range of 16 bits is known before the first pixel is written. Every way gives the same bytes.
//!
//! - `maps`: what can be baked; `projection`: where pixels lie; `pieces`: landscapes and quadtrees; `format`: kinds of
//!   file, and steps of their numbers
//! - `occlusion`: ambient occlusion; `lights`: lights of settlements
//! - `strips`: computes and keeps strips; `rows`: reads a map from them; `expected`: what computing them takes
//! - `output`: the files of the maps, written together, and whether they are there
//! - `png`, `openexr`, `geotiff`, `ktx2`, `raw`: encoders; `sidecar`: the JSON beside a map
//! - `mesh`: meshes with textures
//! - `edits`: ground edits as a height picture
//! - `outputs`: what bakes will write, known before; `room`: whether the disk takes it
//! - `preview`: a small picture of a map; `progress`, `error`

mod edits;
mod error;
mod expected;
mod format;
mod geotiff;
mod ktx2;
mod lights;
mod maps;
pub mod mesh;
mod occlusion;
mod openexr;
mod output;
mod pieces;
mod plan;
mod png;
mod preview;
mod progress;
mod projection;
mod raw;
#[cfg(feature = "cli")]
pub(crate) mod room;
mod rows;
mod sidecar;
mod strips;
#[cfg(test)]
mod tests;

pub use edits::{BakedEdits, Deviation, EditBake};
pub use error::BakeError;
pub use expected::Expected;
pub use format::Format;
#[cfg(feature = "editor")]
pub(crate) use format::srgb_byte;
pub use maps::Map;
pub use pieces::{Landscape, Quadtree};
pub use plan::MapPlan;
pub use preview::Preview;
pub use projection::{Projection, Region};

use crate::made::identity;
use crate::planet::Key;
use crate::planet::file::Target;
use crate::terrain::Terrain;
use plan::BakedFile;
use progress::Progress;
use projection::{Grid, longest_side_km};
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use strips::{DETAILED_BYTES, DETAILED_PIXELS, Evaluator, STRIP_PIXELS, Strip, Strips};

/// Largest width of a picture, in pixels.
pub const MAX_SIZE: u32 = 65_536;
/// Distance between vertices from which few of them share a river block.
const SLOW_M: f64 = 1000.0;
/// Work of computing a strip, in that of encoding it for one map.
const STRIP_WORK: u64 = 8;

/// Maps of a planet that are to be written to files.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Bake {
    /// The planet, with its final world maps.
    pub terrain: Arc<Terrain>,
    /// What to bake: each map once.
    pub maps: Vec<Map>,
    /// How pixels lie on the globe.
    pub projection: Projection,
    /// Width of a picture in pixels.
    pub size: u32,
    /// The kind of file.
    pub format: Format,
    /// How much of a structure is in the map.
    pub detail: Detail,
    /// Seconds after time zero, for clouds.
    pub time_secs: f64,
    /// The heights that whole numbers run between; None for the lowest and highest of the map.
    pub heights_m: Option<[f64; 2]>,
    /// The part of the work to do; None for all that is left, and then for the files.
    pub shard: Option<Shard>,
}

/// How much of a structure is in a map. It makes no difference to a planet without one.
///
/// Each river of a structure is made when a point near it asks. Where pixels are farther apart than valleys, hardly two
/// of them share a valley, and all detail takes far longer: see [`Bake::expected`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Detail {
    /// All: what [`Terrain::sample`] answers.
    #[default]
    All,
    /// Without valleys and rivers too narrow for the map's pixels, as the planet is drawn from afar. The rivers of the
    /// solved drainage are there however wide a pixel is.
    Pixel,
}

impl Detail {
    /// Both.
    pub const ALL: [Detail; 2] = [Detail::All, Detail::Pixel];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Detail::All => "all",
            Detail::Pixel => "pixel",
        }
    }

    /// The detail of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|detail| detail.name() == name)
    }

    /// Valleys that points so far apart would not show are left out, for pixels of a size. Those of the solved drainage
    /// always show.
    fn spacing_rad(self, terrain: &Terrain, pixel_rad: f64) -> f64 {
        match (self, terrain.river_spacing_rad()) {
            (Detail::Pixel, Some(coarsest_rad)) => pixel_rad.min(coarsest_rad),
            _ => 0.0,
        }
    }
}

/// One of several equal parts of a bake, each for another process or machine. Its strips go to the strip folder; a bake
/// without a shard joins them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1.
    pub number: u32,
    /// How many there are.
    pub count: u32,
}

/// How a bake ended.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The maps are written: these files, and a `.json` beside each.
    Done(Vec<PathBuf>),
    /// Nothing was to be done: the same had made these files already, and they are whole.
    Kept(Vec<PathBuf>),
    /// The strips of a shard are done. How many strips of the other shards are not there yet.
    Shard {
        /// Strips that are missing.
        missing: u32,
    },
    /// Somebody said no. The same bake goes on from here.
    Stopped,
}

impl Bake {
    /// A bake of maps at time zero, with the detail of their pixels.
    pub fn new(terrain: Arc<Terrain>, maps: Vec<Map>, projection: Projection, size: u32, format: Format) -> Self {
        Self {
            terrain,
            maps,
            projection,
            size,
            format,
            detail: Detail::Pixel,
            time_secs: 0.0,
            heights_m: None,
            shard: None,
        }
    }

    /// Writes the maps to a folder, which is made if there is none. Strips that an earlier run left there are used if
    /// they are whole. All maps take their places together, once all are complete. If the same bake has made them
    /// already, nothing is done, by a shard neither.
    ///
    /// `go_on` is asked again and again, from several threads, with the share of the work that is done (0 to 1). If it
    /// answers no, the bake stops; the same bake goes on from there.
    ///
    /// # Errors
    /// What is wrong with what was asked for, before anything is written; or with a file. No file is left half-written.
    pub fn run(&self, folder: &Path, go_on: &(dyn Fn(f64) -> bool + Sync)) -> Result<Outcome, BakeError> {
        profiling::scope!("bake");
        self.check().map_err(BakeError::Asked)?;
        let (strips, files) = (self.strips(folder), self.files(folder));
        let paths = || files.iter().map(|file| file.path.clone()).collect();
        if self.is_finished(folder, &strips) {
            return Ok(Outcome::Kept(paths()));
        }
        match self.make(folder, &strips, &files, go_on) {
            // Another process was faster, and has removed the strips.
            Err(_) if self.is_finished(folder, &strips) => Ok(Outcome::Kept(paths())),
            made => made,
        }
    }

    fn make(
        &self,
        folder: &Path,
        strips: &Strips,
        files: &[BakedFile],
        go_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Outcome, BakeError> {
        make_folder(folder)?;
        for BakedFile { path, about, .. } in files {
            if let (Projection::Quadtree(_), Some(folder)) = (&self.projection, path.parent()) {
                make_folder(folder)?;
            }
            for path in [path, about] {
                Target::checked(path).map_err(|error| BakeError::file(path, error))?;
            }
        }
        make_folder(&strips.folder)?;
        let is_mine = |number: &u32| self.shard.is_none_or(|shard| shard.has(*number));
        let (mine, others): (Vec<u32>, Vec<u32>) = (0..strips.count()).partition(is_mine);
        let missing = |strip: Strip| Some(strip).filter(|strip| !strips.has(strip));
        let mine: Vec<_> = mine.into_par_iter().filter_map(|number| missing(strips.strip(number))).collect();
        log::info!(
            "{}: {} of {} strips of {} are to be computed",
            folder.display(),
            mine.len(),
            strips.count(),
            self.terrain.planet().name
        );
        let encoding = if self.shard.is_some() { 0 } else { u64::from(strips.count()) * self.maps.len() as u64 };
        let progress = Progress::new(mine.len() as u64 * STRIP_WORK + encoding, go_on);
        let evaluator = Evaluator::new(self);
        progress.each(&mine, |strip, scratch| {
            strips.compute(strip, &evaluator, scratch)?;
            progress.add(STRIP_WORK);
            Ok(())
        })?;
        if progress.is_stopped() {
            return Ok(Outcome::Stopped);
        }
        if self.shard.is_some() {
            let missing = others.into_iter().filter(|number| !strips.seems_there(&strips.strip(*number)));
            return Ok(Outcome::Shard { missing: missing.count() as u32 });
        }
        if !self.write(strips, files, &self.ranges(strips)?, &progress)? {
            return Ok(Outcome::Stopped);
        }
        strips::remove(&strips.folder)?;
        Ok(Outcome::Done(files.iter().map(|file| file.path.clone()).collect()))
    }

    /// What it is made from, in a folder beside the maps.
    fn strips(&self, folder: &Path) -> Strips {
        let planet = self.terrain.planet();
        let grid = Grid::new(&self.projection, self.size, planet.radius_km);
        let key = self.key();
        let folder = folder.join(format!("bake-{:016x}.strips", key.bits() >> 64));
        let channels: usize = self.maps.iter().map(|map| map.channels()).sum();
        let pixels = match self.detail {
            Detail::All if planet.structure.is_some() => {
                let most = DETAILED_BYTES / (size_of::<f32>() * channels.max(1)) as u32;
                most.clamp(STRIP_PIXELS, DETAILED_PIXELS)
            }
            _ => STRIP_PIXELS,
        };
        Strips::new(grid, self.maps.clone(), key, folder, pixels)
    }

    /// The longest side of a region of a planet, km: its corners are still nearer than the far side.
    pub fn longest_side_km(radius_km: f64) -> f64 {
        longest_side_km(radius_km)
    }

    /// What is wrong with what is asked for.
    fn check(&self) -> Result<(), String> {
        let planet = self.terrain.planet();
        if !self.terrain.has_final_maps() {
            return Err("the world maps of the terrain are not final; load it with Terrain::load".to_owned());
        }
        if self.maps.is_empty() {
            return Err("there is no map to bake; name at least one, such as height".to_owned());
        }
        for (i, map) in self.maps.iter().enumerate() {
            let name = map.name();
            if self.maps[..i].contains(map) {
                return Err(format!("{name} is named twice"));
            }
            if let Some(lack) = map.missing(planet) {
                return Err(format!("{name}: {} has {lack}; leave it out", planet.name));
            }
            if self.format == Format::R16 && map.channels() > 1 {
                return Err(format!("{name} has {} channels, r16 holds one; use png16, tiff16 or exr", map.channels()));
            }
        }
        self.projection.check(planet, self.size)?;
        if !self.time_secs.is_finite() {
            return Err(format!("a time of {} s is out of range; use a finite number", self.time_secs));
        }
        if self.heights_m.is_some_and(|[min, max]| !(min < max && (max - min).is_finite())) {
            return Err("the range of heights must run from a lower to a higher one".to_owned());
        }
        match self.shard {
            Some(shard) if !(1..=shard.count).contains(&shard.number) => {
                Err(format!("there is no shard {} of {}", shard.number, shard.count))
            }
            _ => Ok(()),
        }
    }

    /// Key of the strips: of everything that they depend on.
    fn key(&self) -> Key {
        let time_secs = Some(self.time_secs).filter(|_| self.maps.iter().any(|map| map.is_of_clouds()));
        let planet = Key::of_planet(self.terrain.planet());
        identity(planet, &(self.projection, self.size, self.detail, &self.maps, time_secs))
    }

    /// Least and greatest value of each map.
    fn ranges(&self, strips: &Strips) -> Result<Vec<(f64, f64)>, BakeError> {
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); self.maps.len()];
        for number in 0..strips.count() {
            for ((min, max), (lo, hi)) in ranges.iter_mut().zip(strips.ranges(&strips.strip(number))?) {
                (*min, *max) = (min.min(lo.into()), max.max(hi.into()));
            }
        }
        for (map, (min, max)) in self.maps.iter().zip(&ranges) {
            let too_narrow = self.heights_m.filter(|[lo, hi]| *map == Map::Height && (min < lo || max > hi));
            if let Some([lo, hi]) = too_narrow.filter(|_| self.format.top(*map).is_some()) {
                return Err(BakeError::Asked(format!(
                    "the heights run from {min:.3} to {max:.3} m, which is beyond the range of {lo} to {hi} m that was \
                     asked for; with a wider range the same bake goes on from here"
                )));
            }
        }
        Ok(ranges)
    }
}

impl Shard {
    fn has(self, strip: u32) -> bool {
        strip % self.count == self.number - 1
    }
}

/// Makes a folder if there is none.
fn make_folder(folder: &Path) -> Result<(), BakeError> {
    if folder.exists() && !folder.is_dir() {
        return Err(BakeError::file(folder, "is a file; name a folder"));
    }
    fs::create_dir_all(folder).map_err(|error| BakeError::file(folder, format!("cannot make the folder: {error}")))
}
