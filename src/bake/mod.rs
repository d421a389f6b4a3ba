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
//! - `strips`: computes and keeps strips; `rows`: reads a map from them
//! - `png`, `openexr`, `geotiff`, `ktx2`, `raw`: encoders; `sidecar`: the JSON beside a map
//! - `mesh`: meshes with textures
//! - `edits`: ground edits as a height picture
//! - `preview`: a small picture of a map; `progress`, `error`

mod edits;
mod error;
mod format;
mod geotiff;
mod ktx2;
mod lights;
mod maps;
pub mod mesh;
mod occlusion;
mod openexr;
mod pieces;
mod png;
mod preview;
mod progress;
mod projection;
mod raw;
mod rows;
mod sidecar;
mod strips;
#[cfg(test)]
mod tests;

pub use edits::{BakedEdits, Deviation, EditBake};
pub use error::BakeError;
pub use format::Format;
#[cfg(feature = "editor")]
pub(crate) use format::srgb_byte;
pub use maps::Map;
pub use pieces::{Landscape, Quadtree};
pub use preview::Preview;
pub use projection::{Projection, Region};

use crate::planet::file::{Target, write_atomically_with};
use crate::planet::{Key, VERSION};
use crate::terrain::Terrain;
use format::{Shape, Steps};
use geotiff::{Ground, Place};
use progress::Progress;
use projection::{Grid, longest_side_km};
use rayon::prelude::*;
use rows::Rows;
use std::fs::{self, File};
use std::io::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use strips::{Evaluator, Strips};

/// Largest width of a picture, in pixels.
pub const MAX_SIZE: u32 = 65_536;
/// Distance between pixels from which few of them share a river block.
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
/// of them share a valley, and all detail takes milliseconds a pixel: hours for a map of the globe.
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
    /// The strips of a shard are done. How many strips of the other shards are not there yet.
    Shard {
        /// Strips that are missing.
        missing: u32,
    },
    /// Somebody said no. The same bake goes on from here.
    Stopped,
}

impl Bake {
    /// A bake of maps at time zero.
    pub fn new(terrain: Arc<Terrain>, maps: Vec<Map>, projection: Projection, size: u32, format: Format) -> Self {
        Self {
            terrain,
            maps,
            projection,
            size,
            format,
            detail: Detail::All,
            time_secs: 0.0,
            heights_m: None,
            shard: None,
        }
    }

    /// Writes the maps to a folder, which is made if there is none. Strips that an earlier run left there are used.
    ///
    /// `go_on` is asked again and again, from several threads, with the share of the work that is done (0 to 1). If it
    /// answers no, the bake stops; the same bake goes on from there.
    ///
    /// # Errors
    /// What is wrong with what was asked for, before anything is written; or with a file. No file is left half-written.
    pub fn run(&self, folder: &Path, go_on: &(dyn Fn(f64) -> bool + Sync)) -> Result<Outcome, BakeError> {
        profiling::scope!("bake");
        self.check().map_err(BakeError::Asked)?;
        make_folder(folder)?;
        let planet = self.terrain.planet();
        let key = self.key();
        let grid = Grid::new(&self.projection, self.size, planet.radius_km);
        let strip_folder = folder.join(format!("bake-{:016x}.strips", key.bits() >> 64));
        let strips = Strips::new(grid, self.maps.clone(), key, strip_folder);
        let files = self.files(&strips.grid, folder);
        for BakedFile { path, about, .. } in &files {
            if let (Projection::Quadtree(_), Some(folder)) = (&self.projection, path.parent()) {
                make_folder(folder)?;
            }
            for path in [Some(path), about.as_ref()].into_iter().flatten() {
                Target::checked(path).map_err(|error| BakeError::file(path, error))?;
            }
        }
        make_folder(&strips.folder)?;
        let missing: Vec<_> =
            (0..strips.count()).map(|number| strips.strip(number)).filter(|strip| !strips.has(strip)).collect();
        let (mine, others): (Vec<_>, Vec<_>) =
            missing.into_iter().partition(|strip| self.shard.is_none_or(|shard| shard.has(strip.number)));
        log::info!(
            "{}: {} of {} strips of {} are to be computed",
            folder.display(),
            mine.len(),
            strips.count(),
            planet.name
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
            return Ok(Outcome::Shard { missing: others.len() as u32 });
        }
        let ranges = self.ranges(&strips)?;
        let written = files.par_iter().try_for_each(|file| self.encode(&strips, file, ranges[file.map], &progress));
        if progress.is_stopped() {
            return Ok(Outcome::Stopped);
        }
        written?;
        strips::remove(&strips.folder)?;
        Ok(Outcome::Done(files.into_iter().map(|file| file.path).collect()))
    }

    /// The longest side of a region of a planet, km: its corners are still nearer than the far side.
    pub fn longest_side_km(radius_km: f64) -> f64 {
        longest_side_km(radius_km)
    }

    /// Whether the bake takes milliseconds a pixel; see [`Detail`].
    pub fn is_slow(&self) -> bool {
        let planet = self.terrain.planet();
        let pixel_rad = match self.projection {
            // The coarsest level is as wide as the planet.
            Projection::Quadtree(_) => Quadtree::pixel_rad(0, self.size),
            projection => projection.spacing_rad(self.size, planet.radius_km),
        };
        planet.structure.is_some() && self.detail == Detail::All && pixel_rad * planet.radius_m() > SLOW_M
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
        let size = self.size;
        if !(2..=MAX_SIZE).contains(&size) {
            return Err(format!("a size of {size} is out of range; use 2 to {MAX_SIZE}"));
        }
        if self.projection == Projection::Equirect && !size.is_multiple_of(2) {
            return Err(format!("{size} is odd, and the map is half as high as wide; use {}", size + 1));
        }
        match &self.projection {
            Projection::Region(region) => region.check(planet)?,
            Projection::Landscape(landscape) => landscape.check(planet, size)?,
            Projection::Quadtree(tree) => tree.check(size)?,
            Projection::Equirect | Projection::Cube => {}
        }
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
        let program = (env!("CARGO_PKG_VERSION"), VERSION);
        let planet = Key::of_planet(self.terrain.planet());
        Key::of(&(program, planet, self.projection, self.size, self.detail, &self.maps, time_secs))
    }

    /// The files of all maps.
    fn files(&self, grid: &Grid, folder: &Path) -> Vec<BakedFile> {
        let pictures = grid.pictures();
        let mut files = Vec::new();
        for (index, map) in self.maps.iter().enumerate() {
            let (name, ending) = (map.name(), self.format.extension());
            let mut push = |pictures: Range<usize>, piece: &str| {
                let path = folder.join(format!("{name}{piece}.{ending}"));
                // All tiles of a quadtree have one description.
                let about = match self.projection {
                    Projection::Quadtree(_) => (pictures.start == 0).then(|| folder.join(format!("{name}.json"))),
                    _ => Some(path.with_extension("json")),
                };
                files.push(BakedFile { path, about, pictures, map: index });
            };
            if self.format == Format::Ktx2 && self.projection == Projection::Cube {
                push(0..pictures, "");
                continue;
            }
            for picture in 0..pictures {
                let piece = match &self.projection {
                    Projection::Landscape(landscape) => {
                        let [column, row] = landscape.place(picture);
                        format!("_x{column}_y{row}")
                    }
                    Projection::Quadtree(tree) => format!("/{}", tree.name(picture)),
                    _ => grid.face(picture).map_or(String::new(), |face| format!("_{face}")),
                };
                push(picture..picture + 1, &piece);
            }
        }
        files
    }

    /// How a picture lies on the sphere.
    fn ground(&self, picture: usize) -> Ground {
        let plane = |region: &Region, corner_m, pixel_m| Ground::Plane {
            lat_deg: region.lat_deg,
            lon_deg: region.lon_deg,
            corner_m,
            pixel_m,
        };
        match &self.projection {
            Projection::Equirect => Ground::Globe,
            Projection::Cube | Projection::Quadtree(_) => Ground::Elsewhere,
            Projection::Region(region) => {
                let side_m = region.side_km * 1000.0;
                plane(region, [-side_m / 2.0, side_m / 2.0], side_m / f64::from(self.size))
            }
            Projection::Landscape(landscape) => {
                plane(&landscape.region, landscape.corner_m(picture, self.size), landscape.pixel_m(self.size))
            }
        }
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

    /// Writes a map and the JSON beside it.
    fn encode(
        &self,
        strips: &Strips,
        file: &BakedFile,
        found: (f64, f64),
        progress: &Progress<'_>,
    ) -> Result<(), BakeError> {
        profiling::scope!("encode a map");
        let BakedFile { path, about, pictures, map: index } = file;
        let map = self.maps[*index];
        let asked = self.heights_m.filter(|_| map == Map::Height);
        let steps = Steps::new(self.format, map, found, asked);
        let (width, height) = (strips.grid.width, strips.grid.height);
        let shape = Shape { width, height, channels: map.channels(), format: self.format, steps };
        let place = Place { ground: self.ground(pictures.start), radius_m: self.terrain.planet().radius_m() };
        let mut rows: Vec<_> = pictures.clone().map(|picture| Rows::new(strips, picture, *index, progress)).collect();
        let write = &mut |out: &mut File| match (self.format, &mut rows[..]) {
            (Format::Ktx2, faces) => ktx2::write(out, map, &shape, faces),
            (Format::Png8 | Format::Png16, [rows]) => png::write(out, &shape, rows),
            (Format::Exr | Format::Exr16, [rows]) => openexr::write(out, &shape, rows),
            (Format::Tiff | Format::Tiff16, [rows]) => geotiff::write(out, &shape, &place, rows),
            (_, rows) => rows.iter_mut().try_for_each(|rows| raw::write(&mut *out, &shape, rows)),
        };
        write_atomically_with(path, Some(&strips.folder), write).map_err(|error| BakeError::file(path, error))?;
        let Some(beside) = about else { return Ok(()) };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let faces: Vec<_> = pictures.clone().filter_map(|picture| strips.grid.face(picture)).collect();
        let about = sidecar::about(self, map, &name, (&faces, pictures.start), &shape);
        let write = &mut |file: &mut File| writeln!(file, "{about:#}");
        write_atomically_with(beside, Some(&strips.folder), write).map_err(|error| BakeError::file(beside, error))
    }
}

/// A file that is to be written.
struct BakedFile {
    path: PathBuf,
    /// The JSON that describes it, if it is not another file's.
    about: Option<PathBuf>,
    /// Its pictures: one, or the six faces of a cube.
    pictures: Range<usize>,
    /// Index of the map.
    map: usize,
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
