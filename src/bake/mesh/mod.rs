//! Meshes of a planet or a region in files: glTF 2.0 (GLB) or Wavefront OBJ, with textures, levels of detail, skirts.
//!
//! Positions of vertices are the evaluator's: the height of a vertex is what [`Terrain::sample`] answers there, to the
//! precision of 32-bit floats. A globe is six squares, the quadtree's whole faces; neighbours share the vertices of
//! their border to the bit. A region is one square, the same as that of a map of the region. Textures cover squares.
//!
//! Frames, in metres times the scale, y up, as glTF has it:
//! - globe: the origin is the planet's centre, +Y points to the north pole, +X to latitude 0, longitude 0, -Z to
//!   longitude 90°;
//! - region: the origin is the region's centre on the reference sphere, +X points east, +Y up, -Z north.
//!
//! - `square`: a square of the sphere, and the frame; `surface`: ground and water at points; `patch`: the vertices of a
//!   square; `geometry`: triangles of a level of detail; `textures`; `quantize`: vertices as whole numbers; `chunks`,
//!   `glb`, `obj`: encoders; `objects`: plants and stones as instances; `tileset`: 3D Tiles; `measures`: what a tile
//!   tells of itself; `implicit`: subtree files

mod chunks;
mod geometry;
mod glb;
mod implicit;
mod measures;
mod obj;
mod objects;
mod patch;
mod quantize;
mod square;
mod surface;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_tiles;
mod textures;
mod tileset;

use super::progress::Progress;
use super::sidecar::of_planet;
use super::{BakeError, Detail, Outcome, Region};
use crate::life::Canopies;
use crate::planet::Planet;
use crate::planet::file::Target;
use crate::terrain::Terrain;
use geometry::Geometry;
use glam::DVec3;
use patch::Patch;
use quantize::Lattice;
use serde_json::{Value, json};
use square::Square;
use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};
use surface::Surface;
use textures::Textures;

pub use objects::ObjectBake;
pub use tileset::Tileset;

/// Most vertices of a mesh, all squares together; they take some 100 bytes each.
const MAX_VERTICES: u64 = 1 << 23;
/// Most texels of the textures of one kind, all squares together.
const MAX_TEXELS: u64 = 1 << 27;
/// Samples of a texel.
const SAMPLES: u64 = (textures::FINER * textures::FINER) as u64;
/// Most levels of detail.
const MAX_LEVELS: u32 = 8;

/// A mesh that is to be written to a file. Begin with [`MeshBake::new`]: there may be more fields.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshBake {
    /// The part of the planet.
    pub area: Area,
    /// Cells along each side of a square of the finest level.
    pub cells: u32,
    /// The kind of file.
    pub format: MeshFormat,
    /// Width of the textures of a square in pixels; None for colours at the vertices.
    pub texture_px: Option<u32>,
    /// What becomes of seas, lakes and rivers.
    pub water: MeshWater,
    /// Levels of detail; each has half the cells of the one before along each side.
    pub levels: u32,
    /// Depth of the skirts around squares in metres, which hide gaps between levels of detail; 0 for none.
    pub skirt_m: f64,
    /// Units of the file in a metre.
    pub scale: f64,
    /// How much of a structure is in the mesh.
    pub detail: Detail,
    /// Whether vertices are whole numbers of 16 and 8 bits (KHR_mesh_quantization), of [`MeshFormat::Glb`] alone.
    pub is_quantized: bool,
}

/// The part of the planet that a mesh shows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Area {
    /// All of it, as six squares.
    Globe,
    /// A square region.
    Region(Region),
}

/// The kinds of file for meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Binary glTF 2.0: one file.
    Glb,
    /// Wavefront OBJ, with a material file and textures beside it.
    Obj,
}

/// What becomes of the water of a planet in a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshWater {
    /// The mesh runs on the surface of the water, which is opaque.
    #[default]
    Surface,
    /// The mesh runs on the ground; a transparent mesh of the water lies over it.
    Apart,
    /// The mesh runs on the ground, and there is no water.
    None,
}

impl MeshFormat {
    /// Both.
    pub const ALL: [MeshFormat; 2] = [MeshFormat::Glb, MeshFormat::Obj];

    /// The ending of its files' names.
    pub fn extension(self) -> &'static str {
        match self {
            MeshFormat::Glb => "glb",
            MeshFormat::Obj => "obj",
        }
    }

    /// The format that the ending of a path names.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.extension() == ending)
    }
}

impl MeshWater {
    /// All of them.
    pub const ALL: [MeshWater; 3] = [MeshWater::Surface, MeshWater::Apart, MeshWater::None];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            MeshWater::Surface => "surface",
            MeshWater::Apart => "apart",
            MeshWater::None => "none",
        }
    }

    /// The choice of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|water| water.name() == name)
    }
}

/// A square with all that a file says of it.
struct Piece {
    name: &'static str,
    /// From the finest to the coarsest.
    levels: Vec<Geometry>,
    /// The water over it, level by level, where that is a mesh of its own.
    water: Vec<Geometry>,
    textures: Option<Textures>,
    /// How its positions count, if they are whole numbers.
    steps: Option<Steps>,
}

/// Positions as whole numbers, in units of the file.
struct Steps {
    /// Length of one.
    step: f64,
    /// Where they count from.
    corner: DVec3,
}

/// The name of a level of detail: that of the piece if it has one level alone.
fn level_name(name: &str, level: usize, levels: usize) -> String {
    if levels > 1 { format!("{name}_LOD{level}") } else { name.to_owned() }
}

impl MeshBake {
    /// Most levels of detail.
    pub const MOST_LEVELS: u32 = MAX_LEVELS;
    /// Cells along each side of a square, unless a spacing is wanted.
    pub const CELLS: u32 = 256;

    /// A mesh with colours at its vertices.
    pub fn new(area: Area, cells: u32, format: MeshFormat) -> Self {
        Self {
            area,
            cells,
            format,
            texture_px: None,
            water: MeshWater::Surface,
            levels: 1,
            skirt_m: 0.0,
            scale: 1.0,
            detail: Detail::All,
            is_quantized: false,
        }
    }

    /// The least number of cells along a side for a distance between vertices of at most `spacing_m` on the reference
    /// sphere, that can be halved for each level of detail but the first. Without a distance, [`Self::CELLS`].
    pub fn cells_for(area: &Area, radius_m: f64, spacing_m: Option<f64>, levels: u32) -> u32 {
        let multiple = 1_u32 << levels.clamp(1, MAX_LEVELS).saturating_sub(1);
        let Some(spacing_m) = spacing_m else { return Self::CELLS.next_multiple_of(multiple) };
        let cells = (side_m(area, radius_m) / spacing_m).ceil().clamp(1.0, f64::from(u32::MAX / 2)) as u32;
        cells.div_ceil(multiple) * multiple
    }

    /// Mean distance between neighbouring vertices of the finest level along the middle of a square, on the reference
    /// sphere.
    pub fn spacing_m(&self, radius_m: f64) -> f64 {
        side_m(&self.area, radius_m) / f64::from(self.cells)
    }

    /// Vertices of the finest level, all squares together.
    pub fn vertices(&self) -> u64 {
        self.squares() * (u64::from(self.cells) + 1).pow(2)
    }

    pub(super) fn squares(&self) -> u64 {
        if self.area == Area::Globe { 6 } else { 1 }
    }

    /// Whether it takes milliseconds a vertex; see [`Detail`].
    pub fn is_slow(&self, planet: &Planet) -> bool {
        planet.structure.is_some() && self.detail == Detail::All && self.spacing_m(planet.radius_m()) > super::SLOW_M
    }

    /// Writes the mesh of a planet whose world maps are final. A file that is there is replaced when the new one is
    /// complete.
    ///
    /// `go_on` is asked again and again, from several threads, with the share of the work that is done (0 to 1). If it
    /// answers no, the bake stops, and nothing is written.
    ///
    /// # Errors
    /// What is wrong with what was asked for; or with a file. No file is left half-written.
    pub fn run(
        &self,
        terrain: &Terrain,
        path: &Path,
        go_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Outcome, BakeError> {
        profiling::scope!("bake a mesh");
        let planet = terrain.planet();
        has_final_maps(terrain).and_then(|()| self.check(planet)).map_err(BakeError::Asked)?;
        for path in self.files(planet.radius_m(), path) {
            Target::checked(&path).map_err(|error| BakeError::file(&path, error))?;
        }
        let squares = Square::all(&self.area, planet.radius_m());
        let side = u64::from(self.cells) + 1;
        let texels = self.texture_px.map_or(0, |px| u64::from(px) * u64::from(px) * SAMPLES);
        let progress = Progress::new(squares.len() as u64 * (side * side + texels), go_on);
        let canopies = Canopies::new(terrain);
        let surface = Surface { terrain, water: self.water, detail: self.detail, canopies: &canopies };
        let mut pieces = Vec::with_capacity(squares.len());
        for square in &squares {
            let mut patch = Patch::new(square, self.cells, &surface, &progress);
            if progress.is_stopped() {
                return Ok(Outcome::Stopped);
            }
            let center_m = patch.center_m;
            let lattice = self.is_quantized.then(|| {
                let step_m = Lattice::step_m(side_m(&self.area, planet.radius_m()), self.skirt_m);
                let lattice = Lattice::around(&patch, self.skirt_m, step_m);
                lattice.snap(&mut patch);
                lattice
            });
            let textures = self.texture_px.map(|px| Textures::new(square, px, &patch, &surface, &progress));
            let textures = textures.transpose().map_err(|error| BakeError::file(path, error))?;
            if progress.is_stopped() {
                return Ok(Outcome::Stopped);
            }
            let scale = lattice.as_ref().map_or(self.scale, |lattice| lattice.step_m.recip());
            let strides = (0..self.levels).map(|level| 1_usize << level);
            let water = strides.clone().filter_map(|stride| Geometry::water(&patch, stride, scale)).collect();
            let levels =
                strides.map(|stride| Geometry::new(&patch, stride, self.skirt_m, scale, textures.is_some())).collect();
            let steps = lattice.map(|lattice| Steps {
                step: lattice.step_m * self.scale,
                corner: (center_m + lattice.corner_m()) * self.scale,
            });
            pieces.push(Piece { name: square.name(), levels, water, textures, steps });
        }
        match self.format {
            MeshFormat::Glb => {
                glb::write(planet, &self.about(planet), path, &pieces, DVec3::ZERO)?;
                Ok(Outcome::Done(vec![path.to_owned()]))
            }
            MeshFormat::Obj => obj::write(self, planet, path, &pieces).map(Outcome::Done),
        }
    }

    /// The file that is named, and all that are written beside it.
    pub fn files(&self, radius_m: f64, path: &Path) -> Vec<PathBuf> {
        let mut files = vec![path.to_owned()];
        if self.format == MeshFormat::Obj {
            files.push(beside(path, ".mtl"));
            let squares = Square::all(&self.area, radius_m);
            let named = squares.iter().filter(|_| self.texture_px.is_some());
            files.extend(
                named.flat_map(|square| obj::TEXTURES.map(|kind| obj::texture_path(path, square.name(), kind))),
            );
        }
        files
    }

    /// Whether such a mesh of a planet can be written.
    ///
    /// # Errors
    /// What is wrong with what is asked for, and what would be right.
    pub fn check(&self, planet: &Planet) -> Result<(), String> {
        planet.check_ground()?;
        if let Area::Region(region) = &self.area {
            region.check(planet)?;
        }
        if !(1..=MAX_LEVELS).contains(&self.levels) {
            return Err(format!("{} levels of detail are out of range; use 1 to {MAX_LEVELS}", self.levels));
        }
        let multiple = 1 << (self.levels - 1);
        if self.cells == 0 || !self.cells.is_multiple_of(multiple) {
            return Err(format!(
                "{} cells cannot be halved for {} levels of detail; use a multiple of {multiple}",
                self.cells, self.levels
            ));
        }
        let squares = self.squares();
        let most = ((MAX_VERTICES / squares) as f64).sqrt() as u32 - 1;
        if self.cells > most {
            let least_m = side_m(&self.area, planet.radius_m()) / f64::from(most);
            return Err(format!(
                "a spacing of {:.3} m makes more than {} million vertices; use {least_m:.3} m or more, or a smaller region",
                self.spacing_m(planet.radius_m()),
                MAX_VERTICES >> 20
            ));
        }
        let most = ((MAX_TEXELS / squares) as f64).sqrt() as u32;
        match self.texture_px {
            Some(px) if !(2..=most).contains(&px) => {
                return Err(format!("textures of {px} pixels are out of range; use 2 to {most}"));
            }
            _ => {}
        }
        if self.water == MeshWater::Apart && planet.water.is_none() && planet.structure.is_none() {
            return Err(format!("{} has neither a sea nor a structure, so it has no water to put apart", planet.name));
        }
        if self.is_quantized && self.format != MeshFormat::Glb {
            return Err("an OBJ holds no whole numbers of 16 bits; use .glb".to_owned());
        }
        // Deeper ones would meet in the planet's centre; whole numbers would lose their digits to them.
        let half_m = 0.5 * planet.radius_m();
        let (most_m, what) = match self.is_quantized {
            true => (half_m.min(side_m(&self.area, planet.radius_m())), "the side of a quantized square"),
            false => (half_m, "half the planet's radius"),
        };
        if !(0.0..=most_m).contains(&self.skirt_m) {
            return Err(format!("a skirt of {} m is out of range; use 0 to {most_m}, {what} at most", self.skirt_m));
        }
        if !(self.scale.is_finite() && self.scale > 0.0) {
            return Err(format!("a scale of {} is out of range; use more than 0", self.scale));
        }
        Ok(())
    }

    /// What a program may want to know of the mesh.
    fn about(&self, planet: &Planet) -> Value {
        let mut about = of_planet(planet);
        about["units_per_m"] = json!(self.scale);
        about["spacing_m"] = json!(self.spacing_m(planet.radius_m()));
        about["water"] = json!(self.water.name());
        about["detail"] = json!(self.detail.name());
        if let Area::Region(region) = self.area {
            about["lat_deg"] = json!(region.lat_deg);
            about["lon_deg"] = json!(region.lon_deg);
            about["side_km"] = json!(region.side_km);
        }
        about
    }
}

/// Draft maps would be baked without a sign of it.
fn has_final_maps(terrain: &Terrain) -> Result<(), String> {
    if terrain.has_final_maps() {
        return Ok(());
    }
    Err("the world maps of the terrain are not final; load it with Terrain::load".to_owned())
}

/// Length of a side of a square through its middle, on the reference sphere.
fn side_m(area: &Area, radius_m: f64) -> f64 {
    match area {
        Area::Globe => FRAC_PI_2 * radius_m,
        Area::Region(region) => region.side_km * 1000.0,
    }
}

/// A file beside another, with another ending of its name.
fn beside(path: &Path, ending: &str) -> PathBuf {
    // Many readers of OBJ end a name at a space.
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace(char::is_whitespace, "_");
    path.with_file_name(format!("{stem}{ending}"))
}
