//! The files of the maps of a bake: their names, their contents, and whether they are there already.
//!
//! All of them are completed in the strip folder before the first takes its place. Descriptions come last. Each has the
//! CRC-32 of its pictures, the identity of what made them and a checksum of itself. A power cut may leave files of two
//! bakes side by side: their checksums do not fit, and the bake is not taken for finished.

use super::format::{Format, Shape, Steps};
use super::geotiff::{self, Ground, Place};
use super::maps::Map;
use super::plan::{BakedFile, MapPlan};
use super::progress::Progress;
use super::projection::{Grid, Projection, Region};
use super::rows::Rows;
use super::strips::Strips;
use super::{Bake, BakeError, ktx2, openexr, png, raw, sidecar};
use crate::made::crc32_of;
use crate::planet::Key;
use crate::planet::file::{Staged, read, stage};
use crc32fast::Hasher;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

/// Longest description that is read.
const MOST_BYTES: u64 = 1 << 24;

impl Bake {
    /// The files of all maps; those that one description describes follow each other.
    pub(super) fn files(&self, folder: &Path) -> Vec<BakedFile> {
        let Self { maps, projection, size, format, .. } = self;
        let grid = Grid::new(projection, *size, self.terrain.planet().radius_km);
        MapPlan { maps, projection: *projection, size: *size, format: *format }.baked(&grid, folder)
    }

    /// What made the files: the strips, and how they were encoded.
    fn identity(&self, strips: &Strips) -> String {
        format!("{:032x}", Key::of(&(strips.key, self.format.name(), self.heights_m)).bits())
    }

    /// Whether the same bake has made all files, and they are whole. To a shard it does not matter how its strips were
    /// encoded.
    pub(super) fn is_finished(&self, folder: &Path, strips: &Strips) -> bool {
        let about = |path: &Path| sidecar::unsealed(&String::from_utf8(read(path, MOST_BYTES).ok()?).ok()?);
        // The names of descriptions tell nothing of the format, but the faces of a cube have one or six.
        let formats: &[Format] = if self.shard.is_some() { &Format::ALL } else { &[self.format] };
        let encoded = formats.iter().map(|format| Self { format: *format, ..self.clone() });
        encoded.into_iter().any(|bake| {
            let (files, is_shard) = (bake.files(folder), self.shard.is_some());
            let is_ours = |about: &Value| {
                let is_same = about["identity"] == bake.identity(strips).as_str();
                is_same || is_shard && about["strips"] == strips_name(strips) && about["format"] == bake.format.name()
            };
            files.chunk_by(|a, b| a.about == b.about).all(|group| {
                let Some(about) = about(&group[0].about).filter(is_ours) else { return false };
                let sums = group.par_iter().map(|file| crc32_of(&file.path).ok());
                let sums: Option<Vec<Hasher>> = sums.collect();
                sums.is_some_and(|sums| about["crc32"] == joined(&sums).as_str())
            })
        })
    }

    /// Writes all files. Whether nobody has stopped it.
    pub(super) fn write(
        &self,
        strips: &Strips,
        files: &[BakedFile],
        ranges: &[(f64, f64)],
        progress: &Progress<'_>,
    ) -> Result<bool, BakeError> {
        let encoded: Result<Vec<_>, _> =
            files.par_iter().map(|file| self.encode(strips, file, ranges[file.map], progress)).collect();
        if progress.is_stopped() {
            return Ok(false);
        }
        let mut encoded = encoded?.into_iter();
        let (mut pictures, mut abouts) = (Vec::new(), Vec::new());
        for group in files.chunk_by(|a, b| a.about == b.about) {
            let BakedFile { path, about: beside, pictures: of_first, map } = &group[0];
            let mut sums = Vec::with_capacity(group.len());
            // In this order: the other would take one more than the group has.
            for (file, (staged, sum)) in group.iter().zip(encoded.by_ref()) {
                pictures.push((staged, &file.path));
                sums.push(sum);
            }
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let faces: Vec<_> = of_first.clone().filter_map(|picture| strips.grid.face(picture)).collect();
            let shape = self.shape(strips, *map, ranges[*map]);
            let mut about = sidecar::about(self, self.maps[*map], &name, (&faces, of_first.start), &shape);
            about["crc32"] = json!(joined(&sums));
            about["identity"] = json!(self.identity(strips));
            about["strips"] = json!(strips_name(strips));
            let text = sidecar::sealed(about);
            let staged = stage(beside, Some(&strips.folder), &mut |file| file.write_all(text.as_bytes()));
            abouts.push((staged.map_err(|error| BakeError::file(beside, error))?, beside));
        }
        for (staged, path) in pictures.into_iter().chain(abouts) {
            staged.commit().map_err(|error| BakeError::file(path, error))?;
        }
        Ok(true)
    }

    fn shape(&self, strips: &Strips, map: usize, found: (f64, f64)) -> Shape {
        let map = self.maps[map];
        let asked = self.heights_m.filter(|_| map == Map::Height);
        let steps = Steps::new(self.format, map, found, asked);
        let (width, height) = (strips.grid.width, strips.grid.height);
        Shape { width, height, channels: map.channels(), format: self.format, steps }
    }

    /// Encodes a file, without putting it into its place.
    fn encode(
        &self,
        strips: &Strips,
        file: &BakedFile,
        found: (f64, f64),
        progress: &Progress<'_>,
    ) -> Result<(Staged, Hasher), BakeError> {
        profiling::scope!("encode a map");
        let BakedFile { path, pictures, map: index, .. } = file;
        let (map, shape) = (self.maps[*index], self.shape(strips, *index, found));
        let place = Place { ground: self.ground(pictures.start), radius_m: self.terrain.planet().radius_m() };
        let mut rows: Vec<_> = pictures.clone().map(|picture| Rows::new(strips, picture, *index, progress)).collect();
        let write = &mut |out: &mut File| match (self.format, &mut rows[..]) {
            (Format::Ktx2, faces) => ktx2::write(out, map, &shape, faces),
            (Format::Png8 | Format::Png16, [rows]) => png::write(out, &shape, rows),
            (Format::Exr | Format::Exr16, [rows]) => openexr::write(out, &shape, rows),
            (Format::Tiff | Format::Tiff16, [rows]) => geotiff::write(out, &shape, &place, rows),
            (_, rows) => rows.iter_mut().try_for_each(|rows| raw::write(&mut *out, &shape, rows)),
        };
        let staged = stage(path, Some(&strips.folder), write).map_err(|error| BakeError::file(path, error))?;
        let sum = crc32_of(staged.unfinished()).map_err(|error| BakeError::file(path, error))?;
        Ok((staged, sum))
    }

    /// How a picture lies on the sphere.
    pub(super) fn ground(&self, picture: usize) -> Ground {
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
}

/// The key of the strips.
fn strips_name(strips: &Strips) -> String {
    format!("{:032x}", strips.key.bits())
}

/// The CRC-32 of files one after another.
fn joined(sums: &[Hasher]) -> String {
    let mut all = Hasher::new();
    sums.iter().for_each(|sum| all.combine(sum));
    format!("{:08x}", all.finalize())
}
