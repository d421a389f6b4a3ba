//! What bakes will write: the names of their files, and the room that these take at least. Both are known before
//! anything is computed, so that a bake that would replace what it reads, or fill the disk, is refused at once.

use super::format::Format;
use super::maps::Map;
use super::mesh::{MeshBake, Tileset};
use super::projection::{Grid, Projection};
use crate::planet::Planet;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes of a value in a strip; a map is not counted, as some are packed very well.
const STRIP_VALUE: u64 = 4;

/// Maps of a planet that is not solved yet.
#[derive(Clone, Debug)]
pub struct MapPlan<'a> {
    /// As in [`super::Bake`].
    pub maps: &'a [Map],
    /// How pixels lie on the globe.
    pub projection: Projection,
    /// Width of a picture in pixels.
    pub size: u32,
    /// The kind of file.
    pub format: Format,
}

/// A file that is to be written.
pub(super) struct BakedFile {
    pub(super) path: PathBuf,
    /// The JSON that describes it. All tiles of a quadtree have one.
    pub(super) about: PathBuf,
    /// Its pictures: one, or the six faces of a cube.
    pub(super) pictures: Range<usize>,
    /// Index of the map.
    pub(super) map: usize,
}

impl MapPlan<'_> {
    /// All files in a folder.
    ///
    /// # Errors
    /// What is wrong with the projection or the size, and what would be right.
    pub fn files(&self, planet: &Planet, folder: &Path) -> Result<Vec<PathBuf>, String> {
        let files = self.baked(&self.grid(planet)?, folder);
        let mut paths: Vec<PathBuf> = files.into_iter().flat_map(|file| [file.path, file.about]).collect();
        paths.sort();
        paths.dedup();
        Ok(paths)
    }

    /// The room that the strips take at least.
    ///
    /// # Errors
    /// As [`Self::files`].
    pub fn least_bytes(&self, planet: &Planet) -> Result<u64, String> {
        let grid = self.grid(planet)?;
        let channels: usize = self.maps.iter().map(|map| map.channels()).sum();
        let pixels = grid.pictures() as u64 * u64::from(grid.width) * u64::from(grid.height);
        Ok(pixels.saturating_mul(channels as u64 * STRIP_VALUE))
    }

    fn grid(&self, planet: &Planet) -> Result<Grid, String> {
        self.projection.check(planet, self.size)?;
        Ok(Grid::new(&self.projection, self.size, planet.radius_km))
    }

    /// The files of all maps.
    pub(super) fn baked(&self, grid: &Grid, folder: &Path) -> Vec<BakedFile> {
        let pictures = grid.pictures();
        let mut files = Vec::new();
        for (index, map) in self.maps.iter().enumerate() {
            let (name, ending) = (map.name(), self.format.extension());
            let mut push = |pictures: Range<usize>, piece: &str| {
                let path = folder.join(format!("{name}{piece}.{ending}"));
                let about = match self.projection {
                    Projection::Quadtree(_) => folder.join(format!("{name}.json")),
                    _ => path.with_extension("json"),
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
}

/// Bytes of a vertex and its two triangles in a GLB, in one with whole numbers, and in an OBJ, at least.
const GLB_VERTEX: u64 = 48;
const QUANTIZED_VERTEX: u64 = 36;
const OBJ_VERTEX: u64 = 100;

/// Least bytes of a mesh in a file. `texels`: pixels of all its textures.
fn mesh_bytes(vertices: u64, is_quantized: bool, is_obj: bool, texels: u64) -> u64 {
    let vertex = match (is_obj, is_quantized) {
        (true, _) => OBJ_VERTEX,
        (false, true) => QUANTIZED_VERTEX,
        (false, false) => GLB_VERTEX,
    };
    // Textures are packed, a smooth one very well.
    vertices.saturating_mul(vertex).saturating_add(texels / 2)
}

fn texels(texture_px: Option<u32>) -> u64 {
    texture_px.map_or(0, |px| u64::from(px) * u64::from(px))
}

impl MeshBake {
    /// The room that its files take at least.
    pub fn least_bytes(&self) -> u64 {
        let is_obj = self.format == super::mesh::MeshFormat::Obj;
        mesh_bytes(self.vertices(), self.is_quantized, is_obj, self.squares() * texels(self.texture_px))
    }
}

impl Tileset {
    /// All files in a folder.
    pub fn files(&self, planet: &Planet, folder: &Path) -> Vec<PathBuf> {
        self.names(planet).into_iter().map(|name| folder.join(name)).collect()
    }

    /// The room that its tiles take at least.
    pub fn least_bytes(&self, planet: &Planet) -> u64 {
        let vertices = (u64::from(self.cells) + 1).pow(2);
        let tile = mesh_bytes(vertices, self.is_quantized, false, texels(self.texture_px));
        (self.tiles(planet).unwrap_or_default() as u64).saturating_mul(tile)
    }
}
