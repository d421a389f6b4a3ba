//! 3D Tiles 1.1 (OGC 22-025r4): the globe as a tree of GLB files, one for each square of the quadtree, and the tileset
//! that lists them. Four squares replace the one that they divide. Neighbours of one level share their borders to the
//! bit; skirts hide the gaps between levels. The geometric error of a tile is measured: how far the vertices of the
//! tiles that replace it lie from it.
//!
//! Each file is written as a whole, so that an interrupted bake goes on with the files that are missing.

use super::geometry::Geometry;
use super::patch::Patch;
use super::square::Square;
use super::surface::Surface;
use super::textures::Textures;
use super::{MeshWater, Piece, SAMPLES, glb, has_final_maps};
use crate::bake::progress::Progress;
use crate::bake::sidecar::of_planet;
use crate::bake::{BakeError, Detail, Outcome, Region, make_folder};
use crate::planet::file::write_atomically;
use crate::planet::{Key, Planet, VERSION};
use crate::sphere::{LatLon, NodeId, Tangent};
use crate::terrain::Terrain;
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// Finest level.
const MAX_LEVEL: u8 = 16;
/// Most tiles.
const MAX_TILES: usize = 200_000;
/// Most texels along a side of a tile.
const MAX_TEXTURE: u32 = 1024;
/// Most cells along a side of a tile.
const MAX_CELLS: u32 = 256;
/// What boxes are enlarged by for numbers that were rounded.
const ROUNDING_M: f64 = 1.0;
/// Points along a side of a tile from which its box is found, and what the box is enlarged by for the border between.
const BORDER: u32 = 16;
const BETWEEN: f64 = 1.002;
/// Depth of skirts in distances between vertices.
const SKIRT: f64 = 1.0;

/// A tileset that is to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct Tileset {
    /// The finest level; level 0 is a face of the cube sphere.
    pub levels: u8,
    /// Where levels beyond [`Tileset::WHOLE`] are; None for everywhere.
    pub region: Option<Region>,
    /// Cells along a side of a tile.
    pub cells: u32,
    /// Width of the textures of a tile in pixels; None for colours at the vertices.
    pub texture_px: Option<u32>,
    /// Whether the mesh runs on seas, lakes and rivers, or on the ground beneath.
    pub water: MeshWater,
    /// How much of a structure is in the tiles.
    pub detail: Detail,
}

impl Tileset {
    /// The finest level that a tileset with a region has outside of it.
    pub const WHOLE: u8 = 2;

    /// A tileset of the whole globe with colours at its vertices.
    pub fn new(levels: u8) -> Self {
        Self { levels, region: None, cells: 64, texture_px: None, water: MeshWater::Surface, detail: Detail::All }
    }

    /// Writes `tileset.json` and the tiles `LEVEL/FACE_X_Y.glb` to a folder, which is made if there is none. Tiles that
    /// an earlier run of the same bake left there are kept. The tileset comes last.
    ///
    /// `go_on` is asked again and again, from several threads, with the share of the work that is done (0 to 1). If it
    /// answers no, the bake stops; the same bake goes on from there.
    ///
    /// # Errors
    /// What is wrong with what was asked for, before anything is written; or with a file. No file is left half-written.
    pub fn run(
        &self,
        terrain: &Terrain,
        folder: &Path,
        go_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Outcome, BakeError> {
        profiling::scope!("bake a tileset");
        let planet = terrain.planet();
        has_final_maps(terrain).and_then(|()| self.check(planet)).map_err(BakeError::Asked)?;
        let nodes = self.nodes(planet);
        make_folder(folder)?;
        self.claim(planet, folder)?;
        let is_there = |node: &NodeId| Measures::read(&folder.join(uri(*node))).is_some();
        let missing: Vec<NodeId> = nodes.par_iter().copied().filter(|node| !is_there(node)).collect();
        for level in 0..=self.levels {
            make_folder(&folder.join(level.to_string()))?;
        }
        let texels = self.texture_px.map_or(0, |px| u64::from(px) * u64::from(px) * SAMPLES);
        let side = u64::from(self.cells) + 1;
        let progress = Progress::new(missing.len() as u64 * (side * side + texels), go_on);
        missing.par_iter().with_max_len(1).try_for_each(|node| {
            if progress.is_stopped() { Ok(()) } else { self.write(terrain, *node, &folder.join(uri(*node)), &progress) }
        })?;
        if progress.is_stopped() {
            return Ok(Outcome::Stopped);
        }
        let path = folder.join("tileset.json");
        let measured = nodes.par_iter().map(|node| {
            let path = folder.join(uri(*node));
            let measures = Measures::read(&path);
            measures.map(|measures| (*node, measures)).ok_or_else(|| BakeError::file(&path, "is no tile any more"))
        });
        let measures: HashMap<NodeId, Measures> = measured.collect::<Result<_, _>>()?;
        let text = format!("{:#}\n", self.tileset(planet, &measures));
        write_atomically(&path, text.as_bytes()).map_err(|error| BakeError::file(&path, error))?;
        let tiles = nodes.into_iter().map(|node| folder.join(uri(node)));
        Ok(Outcome::Done([path].into_iter().chain(tiles).collect()))
    }

    /// Whether such a tileset of a planet can be written.
    ///
    /// # Errors
    /// What is wrong with what is asked for, and what would be right.
    pub fn check(&self, planet: &Planet) -> Result<(), String> {
        planet.check_ground()?;
        if self.levels > MAX_LEVEL {
            return Err(format!("level {} is out of range; use 0 to {MAX_LEVEL}", self.levels));
        }
        if !(2..=MAX_CELLS).contains(&self.cells) || !self.cells.is_multiple_of(2) {
            return Err(format!("{} cells are out of range; use even numbers from 2 to {MAX_CELLS}", self.cells));
        }
        match self.texture_px {
            Some(px) if !(2..=MAX_TEXTURE).contains(&px) => {
                return Err(format!("textures of {px} pixels are out of range; use 2 to {MAX_TEXTURE}"));
            }
            _ => {}
        }
        if self.water == MeshWater::Apart {
            return Err("tiles have no mesh of the water; use surface or none".to_owned());
        }
        self.region.as_ref().map_or(Ok(()), |region| region.check(planet))?;
        match self.tiles(planet) {
            None => Err(format!("these are more than {MAX_TILES} tiles; use fewer levels, or a region")),
            Some(_) => Ok(()),
        }
    }

    /// How many tiles there are; None if that is more than can be written.
    pub fn tiles(&self, planet: &Planet) -> Option<usize> {
        let of_level = |level: u8| NodeId::roots().len() << (2 * u32::from(level));
        let count = match self.region {
            None => (0..=self.levels.min(MAX_LEVEL)).map(of_level).sum(),
            Some(_) => self.nodes(planet).len(),
        };
        Some(count).filter(|count| *count <= MAX_TILES)
    }

    /// Mean distance between neighbouring vertices of the finest level, on the reference sphere.
    pub fn finest_m(&self, planet: &Planet) -> f64 {
        self.spacing_m(planet, self.levels)
    }

    /// Whether it takes milliseconds a vertex; see [`Detail`].
    pub fn is_slow(&self, planet: &Planet) -> bool {
        // The coarse levels of every tileset are.
        planet.structure.is_some() && self.detail == Detail::All
    }

    /// Notes which bake the folder belongs to.
    fn claim(&self, planet: &Planet, folder: &Path) -> Result<(), BakeError> {
        let program = (env!("CARGO_PKG_VERSION"), VERSION);
        let planet = Key::of_planet(planet);
        let water = self.water.name();
        let key = Key::of(&(program, planet, self.cells, self.texture_px, water, self.detail));
        let (path, wanted) = (folder.join("tiles.key"), format!("{:032x}\n", key.bits()));
        match std::fs::read_to_string(&path) {
            Ok(found) if found == wanted => Ok(()),
            Ok(_) => {
                let message = "holds tiles of another bake; name another folder, or remove that one";
                Err(BakeError::file(folder, message))
            }
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(BakeError::file(&path, error)),
            Err(_) => write_atomically(&path, wanted.as_bytes()).map_err(|error| BakeError::file(&path, error)),
        }
    }

    /// All nodes, the coarsest first.
    pub(super) fn nodes(&self, planet: &Planet) -> Vec<NodeId> {
        let (mut nodes, mut level) = (Vec::new(), NodeId::roots().to_vec());
        while !level.is_empty() && nodes.len() <= MAX_TILES {
            let next =
                level.iter().filter(|node| self.is_divided(planet, **node)).flat_map(|node| node.children()).collect();
            nodes.append(&mut level);
            level = next;
        }
        nodes
    }

    fn is_divided(&self, planet: &Planet, node: NodeId) -> bool {
        if node.level >= self.levels {
            return false;
        }
        let Some(region) = self.region.filter(|_| node.level >= Self::WHOLE) else { return true };
        let center = LatLon::from_degrees(region.lat_deg, region.lon_deg).direction();
        let half_diagonal_rad = region.side_km / planet.radius_km / std::f64::consts::SQRT_2;
        center.angle_between(node.direction(0.5, 0.5)) < half_diagonal_rad + radius_rad(node)
    }

    fn spacing_m(&self, planet: &Planet, level: u8) -> f64 {
        std::f64::consts::FRAC_PI_2 * planet.radius_m() / f64::from(self.cells) / f64::from(1_u32 << level)
    }

    fn write(&self, terrain: &Terrain, node: NodeId, path: &Path, progress: &Progress<'_>) -> Result<(), BakeError> {
        let planet = terrain.planet();
        let (radius_m, spacing_m) = (planet.radius_m(), self.spacing_m(planet, node.level));
        let origin_planet_m = node.direction(0.5, 0.5) * radius_m;
        let square = Square::of_node(node, radius_m, origin_planet_m);
        let surface = Surface { terrain, water: self.water, detail: self.detail };
        let patch = Patch::new(&square, self.cells, &surface, progress);
        if progress.is_stopped() {
            return Ok(());
        }
        let textures = self.texture_px.map(|px| Textures::new(&square, px, &patch, &surface, progress));
        let textures = textures.transpose().map_err(|error| BakeError::file(path, error))?;
        if progress.is_stopped() {
            return Ok(());
        }
        let levels = vec![Geometry::new(&patch, 1, spacing_m * SKIRT, 1.0, textures.is_some())];
        let piece = Piece { name: square.name(), levels, water: Vec::new(), textures };
        let mut about = json!({ "spacing_m": spacing_m });
        about["measures"] = json!(Measures::of(&patch, radius_m));
        glb::write(planet, &about, path, &[piece], square.turned(origin_planet_m))
    }

    /// The list of tiles.
    fn tileset(&self, planet: &Planet, measures: &HashMap<NodeId, Measures>) -> Value {
        let mut about = of_planet(planet);
        about["water"] = json!(self.water.name());
        about["detail"] = json!(self.detail.name());
        let roots = NodeId::roots().map(|root| self.tile(planet, root, measures));
        let top_m = planet.radius_m() + roots.iter().map(|(_, whole)| whole.highest_m).fold(0.0, f64::max);
        let children: Vec<Value> = roots.into_iter().map(|(tile, _)| tile).collect();
        json!({
            "asset": {
                "version": "1.1",
                "extras": about,
            },
            "geometricError": planet.radius_m(),
            "root": {
                "boundingVolume": {
                    "box": [0.0, 0.0, 0.0, top_m, 0.0, 0.0, 0.0, top_m, 0.0, 0.0, 0.0, top_m],
                },
                "geometricError": planet.radius_m(),
                "refine": "REPLACE",
                "children": children,
            },
        })
    }

    /// A tile with those that it is divided into, and what holds for all of them: the extremes, and the error of the
    /// tile.
    fn tile(&self, planet: &Planet, node: NodeId, measures: &HashMap<NodeId, Measures>) -> (Value, Measures) {
        let mut whole = Measures { coarser_m: 0.0, ..measures.get(&node).copied().unwrap_or_default() };
        let mut tile = json!({ "content": { "uri": uri(node) } });
        if self.is_divided(planet, node) {
            let children = node.children().map(|child| {
                let (tile, part) = self.tile(planet, child, measures);
                // The tile is the mesh of every second vertex of its children.
                let coarser_m = measures.get(&child).map_or(0.0, |measures| measures.coarser_m);
                whole = Measures {
                    lowest_m: whole.lowest_m.min(part.lowest_m),
                    highest_m: whole.highest_m.max(part.highest_m),
                    coarser_m: whole.coarser_m.max(coarser_m + part.coarser_m),
                };
                tile
            });
            tile["children"] = json!(children);
        }
        tile["geometricError"] = json!(whole.coarser_m);
        tile["boundingVolume"] = json!({ "box": self.bounding_box(planet, node, &whole) });
        (tile, whole)
    }

    /// A box around a tile with its skirt and all that it is divided into, in the planet frame, metres: its centre, and
    /// half of each side as a vector.
    fn bounding_box(&self, planet: &Planet, node: NodeId, whole: &Measures) -> [f64; 12] {
        let around = Tangent::new(node.direction(0.5, 0.5));
        // Numbers of tiles are floats of 32 bits.
        let low_m = planet.radius_m() + whole.lowest_m - self.spacing_m(planet, node.level) * SKIRT - ROUNDING_M;
        let high_m = planet.radius_m() + whole.highest_m + ROUNDING_M;
        // The extremes lie on the border, and the top in the middle.
        let mut least = DVec3::new(0.0, 0.0, high_m);
        let mut most = least;
        let border = (0..=BORDER).flat_map(|i| {
            let share = f64::from(i) / f64::from(BORDER);
            [(share, 0.0), (share, 1.0), (0.0, share), (1.0, share)]
        });
        for (u, v) in border {
            let dir = around.local(node.direction(u, v));
            for radius_m in [low_m, high_m] {
                (least, most) = (least.min(dir * radius_m), most.max(dir * radius_m));
            }
        }
        let center = around.planet(0.5 * (least + most));
        let half = 0.5 * (most - least) * BETWEEN;
        let axes = [around.east_planet * half.x, around.north_planet * half.y, around.up_planet * half.z];
        let mut numbers = [0.0; 12];
        for (numbers, vector) in numbers.chunks_mut(3).zip([center].into_iter().chain(axes)) {
            numbers.copy_from_slice(&vector.to_array());
        }
        numbers
    }
}

/// What a tile tells of itself, in the file: a bake that goes on needs it of tiles that are there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Measures {
    /// Extremes of its vertices over the reference sphere, lakes and seas included.
    lowest_m: f64,
    highest_m: f64,
    /// Greatest distance of a vertex from the mesh of every second one.
    coarser_m: f64,
}

impl Measures {
    fn of(patch: &Patch, radius_m: f64) -> Self {
        let mut measures = Self { lowest_m: f64::INFINITY, highest_m: f64::NEG_INFINITY, coarser_m: 0.0 };
        for (i, vertex) in patch.vertices.iter().enumerate() {
            let height_m = vertex.position_m.distance(patch.center_m) - radius_m;
            measures.lowest_m = measures.lowest_m.min(height_m);
            measures.highest_m = measures.highest_m.max(height_m);
            let (row, column) = (i / patch.side, i % patch.side);
            // The diagonal of a cell runs from its lower left to its upper right corner.
            let (before, after) = match (row % 2, column % 2) {
                (0, 0) => continue,
                (0, _) => ((row, column - 1), (row, column + 1)),
                (_, 0) => ((row - 1, column), (row + 1, column)),
                _ => ((row + 1, column - 1), (row - 1, column + 1)),
            };
            let at = |(row, column): (usize, usize)| patch.at(row, column).position_m;
            let away_m = vertex.position_m.distance(0.5 * (at(before) + at(after)));
            measures.coarser_m = measures.coarser_m.max(away_m);
        }
        measures
    }

    /// The measures in a file; None if it is no tile.
    fn read(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok()?;
        let mut head = [0; 20];
        file.read_exact(&mut head).ok()?;
        let length = head.starts_with(b"glTF").then(|| u32::from_le_bytes([head[12], head[13], head[14], head[15]]))?;
        let mut json = Vec::new();
        file.take(length.into()).read_to_end(&mut json).ok()?;
        let document: Value = serde_json::from_slice(&json).ok()?;
        serde_json::from_value(document.get("nodes")?.get(0)?.get("extras")?.get("measures")?.clone()).ok()
    }
}

/// Angle from the centre of a node to its farthest corner.
fn radius_rad(node: NodeId) -> f64 {
    let center = node.direction(0.5, 0.5);
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    corners.into_iter().map(|(u, v)| center.angle_between(node.direction(u, v))).fold(0.0, f64::max)
}

/// Where the file of a tile is.
pub(super) fn uri(NodeId { level, face, x, y }: NodeId) -> String {
    format!("{level}/{}_{x}_{y}.glb", face.name())
}
