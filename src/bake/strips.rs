//! Strips: rows of all maps of a bake, computed at once and kept in one file each until all are there.
//!
//! Strips are what a bake resumes from and what its shards write. Their size depends on the size of the picture alone,
//! and their values on nothing but the planet, so that whoever computes a strip writes the same bytes. Memory is at
//! most that of one strip on each core, [`STRIP_PIXELS`] x 4 bytes for each channel of each map, or with all detail of
//! a structure [`DETAILED_BYTES`].
//!
//! Within a strip, points of a planet with a structure are asked along a curve that keeps neighbours together, whatever
//! the projection.
//!
//! Format, little-endian: `MAGIC`, the key of the bake (16 bytes), the number of the strip (4 bytes); for each map its
//! least and greatest value and the CRC-32 of its values; the CRC-32 of all that; for each map its values row by row,
//! channels together. All values are floats of 32 bits. A strip that is damaged counts as missing.

use super::error::BakeError;
use super::lights::Lights;
use super::maps::{MOST_CHANNELS, Map, Site};
use super::occlusion::open_shares;
use super::projection::Grid;
use super::{Bake, Detail};
use crate::clouds::{CloudCover, CloudField};
use crate::life::Canopies;
use crate::planet::Key;
use crate::planet::file::write_atomically_with;
use crate::planet::open::open_file;
use crate::planet::output::is_unfinished;
use crate::sphere::curve;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use std::fs::File;
use std::io::{self, BufWriter, Read as _, Seek as _, SeekFrom, Write as _};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Most pixels of a strip, unless a single row has more.
pub(super) const STRIP_PIXELS: u32 = 1 << 17;
/// The same with all detail of a structure, where a strip should be higher than the squares for which rivers are made:
/// most pixels, and most bytes.
pub(super) const DETAILED_PIXELS: u32 = 1 << 21;
pub(super) const DETAILED_BYTES: u32 = 1 << 26;
/// Least number of strips of a bake, if it has as many rows: small bakes use all cores, too.
const LEAST_STRIPS: u32 = 32;
/// Pixels of one query.
const TASK: usize = 1024;
const MAGIC: [u8; 8] = *b"TELLUSB2";
const HEAD: usize = MAGIC.len() + 16 + 4;
/// Length of what the head says of a map, and of a checksum.
const PLANE: usize = 12;
const SUM: usize = 4;
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

/// What the head of a strip says of the values of a map.
#[derive(Clone, Copy)]
struct Plane {
    least: f32,
    greatest: f32,
    crc32: u32,
}

/// What strips are computed from.
pub(super) struct Evaluator<'a> {
    terrain: &'a Terrain,
    clouds: Option<CloudField>,
    time_secs: f64,
    detail: Detail,
    lights: Option<Lights>,
    canopies: Canopies,
}

/// What maps show besides the ground, for each point; empty if none of them does.
#[derive(Default)]
struct Extras {
    clouds: Vec<CloudCover>,
    open: Vec<f64>,
    lights: Vec<[f64; 3]>,
}

impl Strips {
    /// `most_pixels`: of a strip, unless a single row has more.
    pub(super) fn new(grid: Grid, maps: Vec<Map>, key: Key, folder: PathBuf, most_pixels: u32) -> Self {
        let least = LEAST_STRIPS.div_ceil(grid.pictures() as u32);
        let rows = (most_pixels / grid.width).min(grid.height.div_ceil(least)).max(1);
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
        self.folder.join(format!("{number:05}{ENDING}"))
    }

    /// Whether a strip is there whole.
    pub(super) fn has(&self, strip: &Strip) -> bool {
        (0..self.maps.len()).all(|map| self.read(strip, map).is_ok())
    }

    /// Whether a strip is there: its values are not read.
    pub(super) fn seems_there(&self, strip: &Strip) -> bool {
        self.open(strip).is_ok()
    }

    fn head(&self, number: u32, planes: &[Plane]) -> Vec<u8> {
        let mut head = [&MAGIC[..], &self.key.bits().to_le_bytes(), &number.to_le_bytes()].concat();
        for Plane { least, greatest, crc32 } in planes {
            head.extend([least.to_le_bytes(), greatest.to_le_bytes(), crc32.to_le_bytes()].concat());
        }
        let sum = crc32fast::hash(&head);
        head.extend(sum.to_le_bytes());
        head
    }

    /// Opens a strip whose head and length are right.
    fn open(&self, strip: &Strip) -> io::Result<(File, Vec<Plane>)> {
        let mut file = open_file(&self.path(strip.number))?;
        let mut head = vec![0; HEAD + self.maps.len() * PLANE + SUM];
        file.read_exact(&mut head)?;
        let plane = |[least, greatest, crc32]: &[[u8; FLOAT]; 3]| Plane {
            least: f32::from_le_bytes(*least),
            greatest: f32::from_le_bytes(*greatest),
            crc32: u32::from_le_bytes(*crc32),
        };
        let planes: Vec<_> = head[HEAD..].as_chunks().0.as_chunks().0.iter().map(plane).collect();
        let length = self.place(strip, self.maps.len()).start;
        if head != self.head(strip.number, &planes) || file.metadata()?.len() != length {
            return Err(damaged());
        }
        Ok((file, planes))
    }

    /// The values of a map in a strip, as bytes.
    pub(super) fn read(&self, strip: &Strip, map: usize) -> io::Result<Vec<u8>> {
        let (mut file, planes) = self.open(strip)?;
        let place = self.place(strip, map);
        let mut bytes = vec![0; (place.end - place.start) as usize];
        file.seek(SeekFrom::Start(place.start))?;
        file.read_exact(&mut bytes)?;
        if planes.get(map).is_none_or(|plane| crc32fast::hash(&bytes) != plane.crc32) {
            return Err(damaged());
        }
        Ok(bytes)
    }

    /// Where the values of a map are in the file of a strip, in bytes.
    fn place(&self, strip: &Strip, map: usize) -> Range<u64> {
        let pixels = u64::from(self.grid.width) * u64::from(strip.rows.end - strip.rows.start);
        let bytes = |map: &Map| pixels * (map.channels() * FLOAT) as u64;
        let start = (HEAD + self.maps.len() * PLANE + SUM) as u64 + self.maps.iter().take(map).map(bytes).sum::<u64>();
        start..start + self.maps.get(map).map_or(0, bytes)
    }

    /// Least and greatest value of each map in a strip that is there.
    pub(super) fn ranges(&self, strip: &Strip) -> Result<Vec<(f32, f32)>, BakeError> {
        let (_, planes) = self.open(strip).map_err(|error| BakeError::file(&self.path(strip.number), error))?;
        Ok(planes.iter().map(|plane| (plane.least, plane.greatest)).collect())
    }

    /// Computes a strip and writes its file.
    pub(super) fn compute(
        &self,
        strip: &Strip,
        evaluator: &Evaluator<'_>,
        scratch: &mut Scratch,
    ) -> Result<(), BakeError> {
        profiling::scope!("bake a strip");
        let values = self.values(strip, evaluator, scratch);
        let bytes: Vec<Vec<u8>> =
            values.iter().map(|values| values.iter().flat_map(|v| v.to_le_bytes()).collect()).collect();
        let plane = |(values, bytes): (&Vec<f32>, &Vec<u8>)| Plane {
            least: values.iter().copied().fold(f32::INFINITY, f32::min),
            greatest: values.iter().copied().fold(f32::NEG_INFINITY, f32::max),
            crc32: crc32fast::hash(bytes),
        };
        let planes: Vec<_> = values.iter().zip(&bytes).map(plane).collect();
        drop(values);
        let path = self.path(strip.number);
        let write = &mut |file: &mut File| {
            let mut out = BufWriter::new(file);
            out.write_all(&self.head(strip.number, &planes))?;
            bytes.iter().try_for_each(|bytes| out.write_all(bytes))?;
            out.flush()
        };
        write_atomically_with(&path, None, write).map_err(|error| BakeError::file(&path, error))
    }

    /// The values of each map in a strip.
    #[inline(never)] // The frames of the evaluator are large.
    pub(super) fn values(&self, strip: &Strip, evaluator: &Evaluator<'_>, scratch: &mut Scratch) -> Vec<Vec<f32>> {
        let (width, high) = (self.grid.width as usize, strip.rows.len());
        let mut planes: Vec<Vec<f32>> = self.maps.iter().map(|map| vec![0.0; width * high * map.channels()]).collect();
        let direction = |pixel: usize| {
            self.grid.direction(strip.picture, (pixel % width) as u32, strip.rows.start + (pixel / width) as u32)
        };
        let mut order: Vec<usize> = (0..width * high).collect();
        if evaluator.terrain.river_spacing_rad().is_some() {
            order.sort_by_cached_key(|pixel| curve::place(direction(*pixel)));
        }
        let mut dirs = Vec::with_capacity(TASK);
        let mut samples = Vec::new();
        for pixels in order.chunks(TASK) {
            dirs.clear();
            dirs.extend(pixels.iter().map(|pixel| direction(*pixel)));
            let pixel_rad = self.grid.spacing_rad(strip.picture);
            let extras = evaluator.find(&self.maps, &dirs, pixel_rad, &mut samples, scratch);
            let planet = evaluator.terrain.planet();
            for (i, ((&dir, sample), pixel)) in dirs.iter().zip(&samples).zip(pixels).enumerate() {
                let clouds = extras.clouds.get(i).copied().unwrap_or_default();
                let (open, lights) = (extras.open.get(i).copied(), extras.lights.get(i).copied());
                let (open, lights) = (open.unwrap_or(1.0), lights.unwrap_or_default());
                let canopies = &evaluator.canopies;
                let site = Site { planet, dir, sample, clouds, open, lights, canopies };
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
        let shows_life = bake.maps.iter().any(|map| map.shows_life());
        Self {
            terrain: &bake.terrain,
            clouds: planet.clouds.as_ref().filter(|_| shows_clouds).map(|_| CloudField::new(&bake.terrain)),
            time_secs: bake.time_secs,
            detail: bake.detail,
            lights: bake.maps.contains(&Map::NightLights).then(|| Lights::new(planet)).flatten(),
            canopies: if shows_life { Canopies::new(&bake.terrain) } else { Canopies::default() },
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
            bank: a.bank || b.bank,
            curvature: a.curvature || b.curvature,
        };
        let planet = self.terrain.planet();
        let of_map =
            |map: &Map| map.wanted().map(|wanted| if map.shows_life() { wanted.and_for_life(planet) } else { wanted });
        if let Some(wanted) = maps.iter().filter_map(of_map).reduce(both) {
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

fn damaged() -> io::Error {
    io::Error::other("is damaged; the same command makes it anew")
}

/// Ending of the file of a strip.
const ENDING: &str = ".strip";

/// Removes the strips of a bake that is done, and their folder if nothing else is in it.
pub(super) fn remove(folder: &Path) -> Result<(), BakeError> {
    let is_own = |path: &Path| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let stem = name.strip_suffix(ENDING).unwrap_or_default();
        is_unfinished(name) || (!stem.is_empty() && stem.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let removed = std::fs::read_dir(folder).and_then(|entries| {
        for path in entries.map(|entry| entry.map(|entry| entry.path())) {
            let path = path?;
            if !is_own(&path) {
                continue;
            }
            match std::fs::remove_file(path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        std::fs::remove_dir(folder)
    });
    match removed {
        Err(error) if !matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::DirectoryNotEmpty) => {
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
        let grid = Grid::new(&projection, size, 1000.0);
        Strips::new(grid, maps, Key::of(&size), PathBuf::from("strips"), STRIP_PIXELS)
    }

    #[test]
    fn only_strips_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let strips = folder.path().join("strips");
        std::fs::create_dir(&strips).unwrap();
        for name in ["00000.strip", "12345.strip", "mine.strip", "notes.txt"] {
            std::fs::write(strips.join(name), name).unwrap();
        }
        remove(&strips).unwrap();
        let left = |name: &str| strips.join(name).exists();
        assert!(!left("00000.strip") && !left("12345.strip") && left("mine.strip") && left("notes.txt"));
        for name in ["mine.strip", "notes.txt"] {
            std::fs::remove_file(strips.join(name)).unwrap();
        }
        remove(&strips).unwrap();
        assert!(!strips.exists());
        remove(&strips).unwrap();
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
