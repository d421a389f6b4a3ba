//! 3D Tiles 1.1 (OGC 22-025r4): the globe as a tree of GLB files, one for each square of the quadtree, and the tileset
//! that lists them. Four squares replace the one that they divide. Neighbours of one level share their borders to the
//! bit; skirts hide the gaps between levels. The geometric error of a tile is measured: how far the vertices of the
//! tiles that replace it lie from it. The tileset lists the tiles, or leaves that to a file for each face (`implicit`).
//!
//! Each file is written as a whole and listed in `tiles.key` with its CRC-32, so that an interrupted bake goes on with
//! the files that are missing or damaged. The tileset comes last.

use super::geometry::Geometry;
use super::implicit::{self, Outline, Subtree};
use super::measures::Measures;
use super::patch::Patch;
use super::quantize::Lattice;
use super::square::Square;
use super::surface::Surface;
use super::textures::Textures;
use super::{MeshWater, Piece, SAMPLES, Steps, glb, has_final_maps};
use crate::bake::progress::Progress;
use crate::bake::sidecar::of_planet;
use crate::bake::{BakeError, Detail, Outcome, Region, make_folder};
use crate::life::Canopies;
use crate::made::{Ledger, crc32_of, identity};
use crate::planet::file::{read, write_atomically};
use crate::planet::{Key, Planet};
use crate::sphere::{Face, LatLon, NodeId, Tangent};
use crate::terrain::Terrain;
use glam::DVec3;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The file that says which bake a folder belongs to: 32 digits.
const KEY_FILE: &str = "tiles.key";
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
#[non_exhaustive]
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
    /// Whether vertices are whole numbers of 16 and 8 bits (KHR_mesh_quantization), which a viewer must know.
    pub is_quantized: bool,
    /// Whether a file for each face tells of its tiles, instead of the tileset (implicit tiling), which a viewer must
    /// know. The tiles are the same.
    pub is_implicit: bool,
}

impl Tileset {
    /// The finest level that a tileset with a region has outside of it.
    pub const WHOLE: u8 = 2;

    /// A tileset of the whole globe with colours at its vertices.
    pub fn new(levels: u8) -> Self {
        Self {
            levels,
            region: None,
            cells: 64,
            texture_px: None,
            water: MeshWater::Surface,
            detail: Detail::All,
            is_quantized: false,
            is_implicit: false,
        }
    }

    /// Writes `tileset.json` and the tiles `LEVEL/FACE_X_Y.glb` to a folder, which is made if there is none. Tiles that
    /// an earlier run of the same bake left there are kept if they are whole. The tileset comes last, after the files
    /// of the faces, `subtrees/FACE_0_0_0.subtree`, if it is implicit.
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
        let key = self.key(planet);
        let ledger = claim(key, folder)?;
        let is_there = |node: &NodeId| ledger.has(&uri(*node), key, &folder.join(uri(*node)));
        let missing: Vec<NodeId> = nodes.par_iter().copied().filter(|node| !is_there(node)).collect();
        for level in 0..=self.levels {
            make_folder(&folder.join(level.to_string()))?;
        }
        let texels = self.texture_px.map_or(0, |px| u64::from(px) * u64::from(px) * SAMPLES);
        let side = u64::from(self.cells) + 1;
        let canopies = Canopies::new(terrain);
        let progress = Progress::new(missing.len() as u64 * (side * side + texels), go_on);
        progress.each(&missing, |node, _| {
            let path = folder.join(uri(*node));
            self.write((terrain, &canopies), *node, &path, &progress)?;
            if progress.is_stopped() {
                return Ok(());
            }
            let listed = crc32_of(&path).and_then(|sum| ledger.add(&uri(*node), key, sum.finalize()));
            listed.map_err(|error| BakeError::file(&path, error))
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
        let outlines = self.outlines(planet, &nodes, &measures);
        let mut files = vec![path.clone()];
        let faces: Vec<Value> = if self.is_implicit {
            let faces = subtrees(&outlines);
            files.extend(write_subtrees(folder, &faces)?);
            faces.iter().map(|(face, subtree)| subtree.root(*face)).collect()
        } else {
            NodeId::roots().map(|root| self.tile(planet, root, &outlines)).into()
        };
        let text = format!("{:#}\n", self.tileset(planet, &measures, &faces));
        let is_new = write_changed(&path, text.as_bytes())?;
        files.extend(nodes.into_iter().map(|node| folder.join(uri(node))));
        Ok(if missing.is_empty() && !is_new { Outcome::Kept(files) } else { Outcome::Done(files) })
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
        if self.is_implicit && self.levels > implicit::MAX_LEVEL {
            let (asked, most) = (self.levels, implicit::MAX_LEVEL);
            return Err(format!(
                "level {asked} is out of range of an implicit tileset; use 0 to {most}, or list the tiles"
            ));
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

    /// The finest level that there can be, where the number of tiles allows it.
    pub const MOST_LEVELS: u8 = MAX_LEVEL;
    /// Most cells along a side of a tile.
    pub const MOST_CELLS: u32 = MAX_CELLS;
    /// Most texels along a side of a tile.
    pub const MOST_TEXTURE: u32 = MAX_TEXTURE;

    /// Names of all files in the folder.
    pub(in crate::bake) fn names(&self, planet: &Planet) -> Vec<String> {
        let faces = Face::ALL.into_iter().filter(|_| self.is_implicit).map(implicit::uri);
        let own = ["tileset.json", KEY_FILE].map(str::to_owned).into_iter();
        own.chain(faces).chain(self.nodes(planet).into_iter().map(uri)).collect()
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

    /// What makes the tiles. Which of them there are, and how they are listed, is another matter.
    fn key(&self, planet: &Planet) -> Key {
        let asked = (self.cells, self.texture_px, self.water.name(), self.detail, self.is_quantized);
        identity(Key::of_planet(planet), &asked)
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

    fn write(
        &self,
        (terrain, canopies): (&Terrain, &Canopies),
        node: NodeId,
        path: &Path,
        progress: &Progress<'_>,
    ) -> Result<(), BakeError> {
        let planet = terrain.planet();
        let (radius_m, spacing_m) = (planet.radius_m(), self.spacing_m(planet, node.level));
        let skirt_m = spacing_m * SKIRT;
        // Floats count from the middle of the tile; whole numbers from a corner that follows from the vertices.
        let middle_planet_m = if self.is_quantized { DVec3::ZERO } else { node.direction(0.5, 0.5) * radius_m };
        let square = Square::of_node(node, radius_m, middle_planet_m);
        let surface = Surface { terrain, water: self.water, detail: self.detail, canopies };
        let mut patch = Patch::new(&square, self.cells, &surface, progress);
        if progress.is_stopped() {
            return Ok(());
        }
        let lattice = self.is_quantized.then(|| {
            let step_m = Lattice::step_m(spacing_m * f64::from(self.cells), skirt_m);
            let lattice = Lattice::around(&patch, skirt_m, step_m);
            lattice.snap(&mut patch);
            lattice
        });
        let textures = self.texture_px.map(|px| Textures::new(&square, px, &patch, &surface, progress));
        let textures = textures.transpose().map_err(|error| BakeError::file(path, error))?;
        if progress.is_stopped() {
            return Ok(());
        }
        let step_m = lattice.as_ref().map(|lattice| lattice.step_m);
        let scale = step_m.map_or(1.0, f64::recip);
        let levels = vec![Geometry::new(&patch, 1, skirt_m, scale, textures.is_some())];
        // The corner is the place of the root.
        let steps = step_m.map(|step| Steps { step, corner: DVec3::ZERO });
        let piece = Piece { name: square.name(), levels, water: Vec::new(), textures, steps };
        let mut about = json!({ "spacing_m": spacing_m });
        about["measures"] = json!(Measures::of(&patch, radius_m));
        let origin_m = lattice.map_or(square.turned(middle_planet_m), |lattice| lattice.corner_m());
        glb::write(planet, &about, path, &[piece], origin_m)
    }

    /// The tileset, with the tiles of the faces.
    fn tileset(&self, planet: &Planet, measures: &HashMap<NodeId, Measures>, faces: &[Value]) -> Value {
        let mut about = of_planet(planet);
        about["water"] = json!(self.water.name());
        about["detail"] = json!(self.detail.name());
        let top_m = planet.radius_m() + measures.values().map(|measures| measures.highest_m).fold(0.0, f64::max);
        let mut tileset = json!({
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
                "children": faces,
            },
        });
        if self.is_implicit {
            tileset["schema"] = implicit::schema();
        }
        tileset
    }

    /// A tile with those that it is divided into.
    fn tile(&self, planet: &Planet, node: NodeId, outlines: &HashMap<NodeId, Outline>) -> Value {
        let mut tile = json!({ "content": { "uri": uri(node) } });
        if let Some(outline) = outlines.get(&node) {
            tile["geometricError"] = json!(outline.error_m);
            tile["boundingVolume"] = json!({ "box": outline.bounds });
        }
        if self.is_divided(planet, node) {
            tile["children"] = json!(node.children().map(|child| self.tile(planet, child, outlines)));
        }
        tile
    }

    /// What holds for each tile and all that it is divided into: the box, and the error of the tile. The nodes come the
    /// coarsest first.
    fn outlines(
        &self,
        planet: &Planet,
        nodes: &[NodeId],
        measures: &HashMap<NodeId, Measures>,
    ) -> HashMap<NodeId, Outline> {
        let mut wholes = HashMap::with_capacity(nodes.len());
        for node in nodes.iter().rev() {
            let own = measures.get(node).copied().unwrap_or_default();
            let mut whole = Measures { coarser_m: 0.0, ..own };
            let parts = node.children().into_iter().filter(|_| self.is_divided(planet, *node));
            for child in parts {
                let part: Measures = wholes.get(&child).copied().unwrap_or_default();
                // The tile is the mesh of every second vertex of its children.
                let coarser_m = measures.get(&child).map_or(0.0, |measures| measures.coarser_m);
                whole = Measures {
                    lowest_m: whole.lowest_m.min(part.lowest_m),
                    highest_m: whole.highest_m.max(part.highest_m),
                    coarser_m: whole.coarser_m.max(coarser_m + part.coarser_m),
                };
            }
            wholes.insert(*node, whole);
        }
        let outline = |(node, whole): (NodeId, Measures)| {
            (node, Outline { bounds: self.bounding_box(planet, node, &whole), error_m: whole.coarser_m })
        };
        wholes.into_iter().map(outline).collect()
    }

    /// A box around a tile with its skirt and all that it is divided into, in the planet frame, metres: its centre, and
    /// half of each side as a vector.
    fn bounding_box(&self, planet: &Planet, node: NodeId, whole: &Measures) -> [f64; 12] {
        let around = frame(node);
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

/// The files of the faces.
fn subtrees(outlines: &HashMap<NodeId, Outline>) -> Vec<(Face, Subtree)> {
    let mut faces: Vec<_> = Face::ALL.into_iter().map(|face| (face, Subtree::default())).collect();
    for (node, outline) in outlines {
        if let Some((_, subtree)) = faces.get_mut(node.face as usize) {
            subtree.add(*node, *outline);
        }
    }
    faces
}

/// Notes which bake a folder belongs to. Gives the list of its tiles.
fn claim(key: Key, folder: &Path) -> Result<Ledger, BakeError> {
    let path = folder.join("tiles.key");
    let failed = |error| BakeError::file(&path, error);
    let (ledger, title) = (Ledger::open(&path).map_err(failed)?, format!("{:032x}", key.bits()));
    match ledger.title() {
        Some(found) if found == title => Ok(ledger),
        Some(_) => {
            let message = "holds tiles of another bake, or of another version; name another folder, or remove that one";
            Err(BakeError::file(folder, message))
        }
        None => ledger.add_line(&title).map(|()| ledger).map_err(failed),
    }
}

/// Writes the files of the faces, except those that are there.
fn write_subtrees(folder: &Path, faces: &[(Face, Subtree)]) -> Result<Vec<PathBuf>, BakeError> {
    make_folder(&folder.join("subtrees"))?;
    let write = |(face, subtree): &(Face, Subtree)| {
        let path = folder.join(implicit::uri(*face));
        write_changed(&path, &subtree.encode()).map(|_| path)
    };
    faces.iter().map(write).collect()
}

/// Writes a file, unless it is there. Whether it was not.
fn write_changed(path: &Path, bytes: &[u8]) -> Result<bool, BakeError> {
    if read(path, bytes.len() as u64).is_ok_and(|found| found == bytes) {
        return Ok(false);
    }
    write_atomically(path, bytes).map(|()| true).map_err(|error| BakeError::file(path, error))
}

/// The axes of the box of a tile. Those of a face are its own, so that columns and rows of its tiles grow along them.
fn frame(node: NodeId) -> Tangent {
    let up_planet = node.direction(0.5, 0.5);
    if node.level > 0 {
        return Tangent::new(up_planet);
    }
    let east_planet = (node.direction(1.0, 0.5) - node.direction(0.0, 0.5)).normalize();
    Tangent { up_planet, east_planet, north_planet: up_planet.cross(east_planet) }
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
