//! Strips: rows of all maps of a bake, computed at once and kept in one file each until all are there.
//!
//! Strips are what a bake resumes from and what its shards write. Their size depends on the size of the picture alone,
//! and their values on nothing but the planet, so that whoever computes a strip writes the same bytes. Memory is at
//! most that of one strip on each core, [`STRIP_PIXELS`] x 4 bytes for each channel of each map.
//!
//! Format, little-endian: `MAGIC`, the key of the bake (16 bytes), the number of the strip (4 bytes); for each map its
//! least and greatest value; for each map its values row by row, channels together. All values are floats of 32 bits.

use super::error::BakeError;
use super::lights::Lights;
use super::maps::{MOST_CHANNELS, Map, Site};
use super::occlusion::open_shares;
use super::projection::Grid;
use super::{Bake, Detail};
use crate::clouds::{CloudCover, CloudField};
use crate::planet::Key;
use crate::planet::file::write_atomically_with;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use std::fs::File;
use std::io::{self, BufWriter, Read as _, Write as _};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Most pixels of a strip, unless a single row has more.
const STRIP_PIXELS: u32 = 1 << 17;
/// Least number of strips of a bake, if it has as many rows: small bakes use all cores, too.
const LEAST_STRIPS: u32 = 32;
/// Pixels of one query. They form a block rather than a row: a thread then builds the river blocks around them once.
const TASK: usize = 1024;
const MAGIC: [u8; 8] = *b"TELLUSB1";
const HEAD: usize = MAGIC.len() + 16 + 4;
const FLOAT: usize = size_of::<f32>();

/// The strips of a bake.
pub(super) struct Strips {
    pub(super) grid: Grid,
    pub(super) maps: Vec<Map>,
    pub(super) key: Key,
    pub(super) folder: PathBuf,
    /// Rows of every strip but the last of a picture.
    rows: u32,
    of_picture: u32,
}

/// The rows of a strip.
pub(super) struct Strip {
    pub(super) number: u32,
    pub(super) picture: usize,
    pub(super) rows: Range<u32>,
}

/// What strips are computed from.
pub(super) struct Evaluator<'a> {
    terrain: &'a Terrain,
    clouds: Option<CloudField>,
    time_secs: f64,
    detail: Detail,
    lights: Option<Lights>,
}

/// What maps show besides the ground, for each point; empty if none of them does.
#[derive(Default)]
struct Extras {
    clouds: Vec<CloudCover>,
    open: Vec<f64>,
    lights: Vec<[f64; 3]>,
}

impl Strips {
    pub(super) fn new(grid: Grid, maps: Vec<Map>, key: Key, folder: PathBuf) -> Self {
        let least = LEAST_STRIPS.div_ceil(grid.pictures() as u32);
        let rows = (STRIP_PIXELS / grid.width).min(grid.height.div_ceil(least)).max(1);
        let of_picture = grid.height.div_ceil(rows);
        Self { grid, maps, key, folder, rows, of_picture }
    }

    /// How many there are.
    pub(super) fn count(&self) -> u32 {
        self.of_picture * self.grid.pictures() as u32
    }

    pub(super) fn strip(&self, number: u32) -> Strip {
        let first = number % self.of_picture * self.rows;
        let rows = first..(first + self.rows).min(self.grid.height);
        Strip { number, picture: (number / self.of_picture) as usize, rows }
    }

    /// The strip with a row of a picture.
    pub(super) fn with_row(&self, picture: usize, row: u32) -> Strip {
        self.strip(picture as u32 * self.of_picture + row / self.rows)
    }

    pub(super) fn path(&self, number: u32) -> PathBuf {
        self.folder.join(format!("{number:05}.strip"))
    }

    /// Whether a strip is there. Strips are written whole or not at all.
    pub(super) fn has(&self, strip: &Strip) -> bool {
        let length = self.plane(strip, self.maps.len()).start;
        let Ok(mut file) = File::open(self.path(strip.number)) else { return false };
        let mut head = [0; HEAD];
        file.metadata().is_ok_and(|about| about.len() == length)
            && file.read_exact(&mut head).is_ok()
            && head == self.head(strip.number)
    }

    fn head(&self, number: u32) -> [u8; HEAD] {
        let mut head = [0; HEAD];
        let fields = [&MAGIC[..], &self.key.bits().to_le_bytes(), &number.to_le_bytes()].concat();
        head.copy_from_slice(&fields);
        head
    }

    /// Where the values of a map are in the file of a strip, in bytes.
    pub(super) fn plane(&self, strip: &Strip, map: usize) -> Range<u64> {
        let pixels = u64::from(self.grid.width) * u64::from(strip.rows.end - strip.rows.start);
        let bytes = |map: &Map| pixels * (map.channels() * FLOAT) as u64;
        let start = (HEAD + self.maps.len() * 2 * FLOAT) as u64 + self.maps.iter().take(map).map(bytes).sum::<u64>();
        start..start + self.maps.get(map).map_or(0, bytes)
    }

    /// Least and greatest value of each map in a strip that is there.
    pub(super) fn ranges(&self, strip: &Strip) -> Result<Vec<(f32, f32)>, BakeError> {
        let path = self.path(strip.number);
        let mut bytes = vec![0; HEAD + self.maps.len() * 2 * FLOAT];
        File::open(&path).and_then(|mut file| file.read_exact(&mut bytes)).map_err(|e| BakeError::file(&path, e))?;
        let floats: Vec<f32> = floats(&bytes[HEAD..]).collect();
        Ok(floats.as_chunks().0.iter().map(|&[min, max]| (min, max)).collect())
    }

    /// Computes a strip and writes its file.
    pub(super) fn compute(
        &self,
        strip: &Strip,
        evaluator: &Evaluator<'_>,
        scratch: &mut Scratch,
    ) -> Result<(), BakeError> {
        profiling::scope!("bake a strip");
        let planes = self.values(strip, evaluator, scratch);
        let path = self.path(strip.number);
        let write = &mut |file: &mut File| {
            let mut out = BufWriter::new(file);
            out.write_all(&self.head(strip.number))?;
            for plane in &planes {
                let (min, max) =
                    plane.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &v| (lo.min(v), hi.max(v)));
                out.write_all(&min.to_le_bytes())?;
                out.write_all(&max.to_le_bytes())?;
            }
            planes.iter().flatten().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
            out.flush()
        };
        write_atomically_with(&path, None, write).map_err(|error| BakeError::file(&path, error))
    }

    /// The values of each map in a strip.
    #[inline(never)] // The frames of the evaluator are large.
    pub(super) fn values(&self, strip: &Strip, evaluator: &Evaluator<'_>, scratch: &mut Scratch) -> Vec<Vec<f32>> {
        let (width, high) = (self.grid.width as usize, strip.rows.len());
        let mut planes: Vec<Vec<f32>> = self.maps.iter().map(|map| vec![0.0; width * high * map.channels()]).collect();
        let wide = (TASK / high).max(1);
        let mut dirs = Vec::with_capacity(TASK.max(high));
        let mut samples = Vec::new();
        for first in (0..width).step_by(wide) {
            let columns = first..(first + wide).min(width);
            dirs.clear();
            for row in strip.rows.clone() {
                dirs.extend(columns.clone().map(|x| self.grid.direction(strip.picture, x as u32, row)));
            }
            let pixel_rad = self.grid.spacing_rad(strip.picture);
            let extras = evaluator.find(&self.maps, &dirs, pixel_rad, &mut samples, scratch);
            let planet = evaluator.terrain.planet();
            for (i, (&dir, sample)) in dirs.iter().zip(&samples).enumerate() {
                let clouds = extras.clouds.get(i).copied().unwrap_or_default();
                let (open, lights) = (extras.open.get(i).copied(), extras.lights.get(i).copied());
                let (open, lights) = (open.unwrap_or(1.0), lights.unwrap_or_default());
                let site = Site { planet, dir, sample, clouds, open, lights };
                let pixel = i / columns.len() * width + columns.start + i % columns.len();
                for (map, plane) in self.maps.iter().zip(&mut planes) {
                    let (channels, values): (_, [f32; MOST_CHANNELS]) = (map.channels(), map.values(&site));
                    plane[pixel * channels..][..channels].copy_from_slice(&values[..channels]);
                }
            }
        }
        planes
    }
}

impl<'a> Evaluator<'a> {
    /// All that the maps of a bake show.
    pub(super) fn new(bake: &'a Bake) -> Self {
        let planet = bake.terrain.planet();
        let shows_clouds = bake.maps.iter().any(|map| map.is_of_clouds());
        Self {
            terrain: &bake.terrain,
            clouds: planet.clouds.as_ref().filter(|_| shows_clouds).map(|_| CloudField::new(&bake.terrain)),
            time_secs: bake.time_secs,
            detail: bake.detail,
            lights: bake.maps.contains(&Map::NightLights).then(|| Lights::new(planet)).flatten(),
        }
    }

    /// Fills in what maps ask of the terrain, and gives what they ask besides. `pixel_rad`: the angle between pixels.
    fn find(
        &self,
        maps: &[Map],
        dirs: &[DVec3],
        pixel_rad: f64,
        samples: &mut Vec<Sample>,
        scratch: &mut Scratch,
    ) -> Extras {
        let spacing_rad = self.detail.spacing_rad(self.terrain, pixel_rad);
        samples.clear();
        samples.resize(dirs.len(), Sample::default());
        let both = |a: Wanted, b: Wanted| Wanted {
            normal: a.normal || b.normal,
            climate: a.climate || b.climate,
            biome: a.biome || b.biome,
            water: a.water || b.water,
        };
        if let Some(wanted) = maps.iter().filter_map(|map| map.wanted()).reduce(both) {
            self.terrain.samples_spaced_into(dirs, spacing_rad, wanted, samples, scratch);
        }
        let mut extras = Extras::default();
        if let Some(field) = &self.clouds {
            extras.clouds = field.covers(dirs, self.time_secs);
        }
        if maps.contains(&Map::AmbientOcclusion) {
            let heights_m = samples.iter().map(|sample| sample.height_m);
            extras.open = open_shares(self.terrain, (dirs, heights_m), (pixel_rad, spacing_rad), scratch);
        }
        if let Some(lights) = &self.lights {
            // The slope that pixels show, not that of every stone.
            let slopes = self.terrain.slopes_at(dirs, &[spacing_rad, pixel_rad]).slopes;
            let slopes = slopes.last().map_or(&[][..], Vec::as_slice);
            let sites = dirs.iter().zip(&*samples).zip(slopes);
            extras.lights =
                sites.map(|((&dir, sample), slope)| lights.at(dir, sample, slope.length(), pixel_rad)).collect();
        }
        extras
    }
}

/// Floats of bytes, little-endian.
pub(super) fn floats(bytes: &[u8]) -> impl Iterator<Item = f32> {
    bytes.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes))
}

/// Removes the strips of a bake that is done.
pub(super) fn remove(folder: &Path) -> Result<(), BakeError> {
    match std::fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(BakeError::file(folder, format!("the maps are complete, but their strips cannot be removed: {error}")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::projection::Projection;

    fn strips(projection: Projection, size: u32) -> Strips {
        let maps = vec![Map::Height, Map::Normal, Map::Biome];
        Strips::new(Grid::new(&projection, size, 1000.0), maps, Key::of(&size), PathBuf::from("strips"))
    }

    #[test]
    fn strips_cover_every_row_once() {
        for (projection, size) in [(Projection::Equirect, 2), (Projection::Equirect, 130), (Projection::Cube, 67)] {
            let strips = strips(projection, size);
            let (mut picture, mut next) = (0, 0);
            for number in 0..strips.count() {
                let strip = strips.strip(number);
                if strip.picture != picture {
                    assert_eq!((strip.picture, next), (picture + 1, strips.grid.height));
                    (picture, next) = (strip.picture, 0);
                }
                assert!(strip.rows.start == next && !strip.rows.is_empty());
                next = strip.rows.end;
                let found = strips.with_row(strip.picture, strip.rows.end - 1);
                assert_eq!(found.number, number);
            }
            assert_eq!((picture + 1, next), (strips.grid.pictures(), strips.grid.height));
        }
    }

    #[test]
    fn strips_are_small_however_large_the_picture() {
        for size in [64, 1000, 4096, 65_536] {
            let strips = strips(Projection::Equirect, size);
            let strip = strips.strip(0);
            assert!(strip.rows.len() == 1 || strip.rows.len() as u32 * size <= STRIP_PIXELS);
            assert!(strips.count() >= LEAST_STRIPS.min(strips.grid.height), "{size}: {}", strips.count());
        }
    }
}
