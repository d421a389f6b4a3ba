//! What the user wants to bake: maps, a mesh or 3D tiles.

use crate::bake::mesh::{Area, MeshBake, MeshFormat, MeshWater, Tileset};
use crate::bake::room::{bytes_in, check_room};
use crate::bake::{Bake, Detail, Format, Landscape, Map, MapPlan, Projection, Quadtree, Region};
use crate::planet::Planet;
use crate::terrain::Terrain;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Product {
    /// Pictures into a folder.
    #[default]
    Maps,
    /// A mesh into a file.
    Mesh,
    /// A tree of meshes into a folder.
    Tiles,
}

impl Product {
    /// All of them, with the name that a person reads and what it is for.
    pub const ALL: [(Product, &'static str, &'static str); 3] = [
        (Product::Maps, "Maps", "Pictures for terrain engines, materials and GIS programs"),
        (Product::Mesh, "Mesh", "The globe or a region as one glTF or OBJ file"),
        (Product::Tiles, "3D tiles", "The globe as a tree of meshes that a viewer streams: 3D Tiles 1.1"),
    ];
}

/// How pixels lie on the globe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The globe in one picture.
    Globe,
    /// Six faces of a cube.
    Cube,
    /// A square about a place.
    Region,
    /// The same square in tiles that share their borders.
    Landscape,
    /// The tiles of a quadtree of the globe.
    Quadtree,
}

impl Form {
    /// All of them, with the name that a person reads and what it is for.
    pub const ALL: [(Form, &'static str, &'static str); 5] = [
        (Form::Globe, "Globe", "Equirectangular: the whole globe in one picture, twice as wide as high"),
        (Form::Cube, "Cube", "Six faces of a cube texture"),
        (Form::Region, "Region", "A square about a place, as terrain engines take it"),
        (
            Form::Landscape,
            "Landscape",
            "The square in tiles that share the vertices of their borders, as Unreal imports them",
        ),
        (
            Form::Quadtree,
            "Quadtree",
            "Tiles of the globe on all levels up to the finest, with pixels of their neighbours",
        ),
    ];
}

/// What is to be baked.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeSettings {
    /// What is written.
    pub product: Product,
    /// The maps, in the order of [`Map::ALL`].
    pub maps: Vec<Map>,
    /// The map in the small picture.
    pub previewed: Map,
    /// How pixels of maps lie on the globe.
    pub form: Form,
    /// Tiles along each side with [`Form::Landscape`].
    pub landscape_tiles: u32,
    /// The tiles with [`Form::Quadtree`].
    pub quadtree: Quadtree,
    /// The square of maps with [`Form::Region`] and [`Form::Landscape`], of a mesh and of the finest tiles.
    pub region: Region,
    /// Width of a picture in pixels.
    pub size: u32,
    /// The kind of file of maps.
    pub format: Format,
    /// How much of a structure is in what is written.
    pub detail: Detail,
    /// The mesh.
    pub mesh: MeshChoice,
    /// The tiles.
    pub tiles: TilesChoice,
}

/// What a mesh is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshChoice {
    /// Whether it shows the region alone.
    pub of_region: bool,
    /// Greatest distance between vertices; None for [`MeshBake::CELLS`] on a side.
    pub spacing_m: Option<f64>,
    /// The kind of file.
    pub format: MeshFormat,
    /// Width of textures in pixels; None for colours at the vertices.
    pub texture_px: Option<u32>,
    /// What becomes of seas, lakes and rivers.
    pub water: MeshWater,
    /// Levels of detail.
    pub levels: u32,
    /// Depth of the skirts in metres.
    pub skirt_m: f64,
    /// Units of the file in a metre.
    pub scale: f64,
    /// Whether vertices are whole numbers, of glTF alone.
    pub is_quantized: bool,
}

/// What tiles are like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TilesChoice {
    /// The finest level.
    pub levels: u8,
    /// Whether levels beyond [`Tileset::WHOLE`] are in the region alone.
    pub in_region: bool,
    /// Cells along a side of a tile.
    pub cells: u32,
    /// Width of the textures of a tile in pixels; None for colours at the vertices.
    pub texture_px: Option<u32>,
    /// Whether tiles run on the water, or on the ground beneath.
    pub has_water: bool,
    /// Whether vertices are whole numbers.
    pub is_quantized: bool,
    /// Whether subtree files tell of the tiles, instead of a list.
    pub is_implicit: bool,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            product: Product::Maps,
            maps: vec![Map::Height, Map::Normal, Map::Albedo],
            previewed: Map::Height,
            form: Form::Globe,
            landscape_tiles: 2,
            quadtree: Quadtree { levels: 3, apron: 1 },
            region: Region { lat_deg: 0.0, lon_deg: 0.0, side_km: 100.0 },
            size: 4096,
            format: Format::Png16,
            detail: Detail::Pixel,
            mesh: MeshChoice {
                of_region: false,
                spacing_m: None,
                format: MeshFormat::Glb,
                texture_px: Some(1024),
                water: MeshWater::Surface,
                levels: 1,
                skirt_m: 0.0,
                scale: 1.0,
                is_quantized: false,
            },
            tiles: TilesChoice {
                levels: 4,
                in_region: false,
                cells: 64,
                texture_px: Some(128),
                has_water: true,
                is_quantized: false,
                is_implicit: false,
            },
        }
    }
}

impl BakeSettings {
    /// The projection of maps.
    pub fn projection(&self) -> Projection {
        match self.form {
            Form::Globe => Projection::Equirect,
            Form::Cube => Projection::Cube,
            Form::Region => Projection::Region(self.region),
            Form::Landscape => Projection::Landscape(Landscape { region: self.region, tiles: self.landscape_tiles }),
            Form::Quadtree => Projection::Quadtree(self.quadtree),
        }
    }

    /// Width and height of all pictures of one map, and how many there are.
    pub fn pictures(&self) -> ([u32; 2], u64) {
        match self.form {
            Form::Globe => ([self.size, self.size / 2], 1),
            Form::Cube => ([self.size; 2], 6),
            Form::Region => ([self.size; 2], 1),
            Form::Landscape => ([self.size; 2], u64::from(self.landscape_tiles) * u64::from(self.landscape_tiles)),
            Form::Quadtree => ([self.size + 2 * self.quadtree.apron; 2], self.quadtree.tiles()),
        }
    }

    /// The maps that a planet has.
    pub fn maps_of(&self, planet: &Planet) -> Vec<Map> {
        self.maps.iter().copied().filter(|map| map.missing(planet).is_none()).collect()
    }

    /// The bake of the maps that a planet has.
    pub fn bake(&self, terrain: Arc<Terrain>, time_secs: f64) -> Bake {
        let maps = self.maps_of(terrain.planet());
        let mut bake = Bake::new(terrain, maps, self.projection(), self.size, self.format);
        (bake.detail, bake.time_secs) = (self.detail, time_secs);
        bake
    }

    /// The mesh. Without water on the planet there is none to put apart.
    pub fn mesh(&self, planet: &Planet) -> MeshBake {
        let MeshChoice { of_region, spacing_m, format, texture_px, water, levels, skirt_m, scale, is_quantized } =
            self.mesh;
        let area = if of_region { Area::Region(self.region) } else { Area::Globe };
        let cells = MeshBake::cells_for(&area, planet.radius_m(), spacing_m, levels);
        let has_water = planet.water.is_some() || planet.structure.is_some();
        let water = if water == MeshWater::Apart && !has_water { MeshWater::Surface } else { water };
        MeshBake {
            texture_px,
            water,
            levels,
            skirt_m,
            scale,
            detail: self.detail,
            is_quantized: is_quantized && format == MeshFormat::Glb,
            ..MeshBake::new(area, cells, format)
        }
    }

    /// The tiles.
    pub fn tileset(&self) -> Tileset {
        let TilesChoice { levels, in_region, cells, texture_px, has_water, is_quantized, is_implicit } = self.tiles;
        let water = if has_water { MeshWater::Surface } else { MeshWater::None };
        let region = in_region.then_some(self.region);
        let detail = self.detail;
        Tileset { region, cells, texture_px, water, detail, is_quantized, is_implicit, ..Tileset::new(levels) }
    }

    fn plan<'a>(&self, maps: &'a [Map]) -> MapPlan<'a> {
        MapPlan { maps, projection: self.projection(), size: self.size, format: self.format }
    }

    /// The files to write: in a folder, or a mesh and what is beside it.
    ///
    /// # Errors
    /// What is wrong with the settings.
    pub fn outputs(&self, planet: &Planet, to: &Path) -> Result<Vec<PathBuf>, String> {
        match self.product {
            Product::Maps => self.plan(&self.maps_of(planet)).files(planet, to),
            Product::Mesh => Ok(self.mesh(planet).files(planet.radius_m(), to)),
            Product::Tiles => Ok(self.tileset().files(planet, to)),
        }
    }

    /// Checks that the disk has room for them.
    ///
    /// # Errors
    /// How much is missing.
    pub fn check_room(&self, planet: &Planet, to: &Path) -> Result<(), String> {
        let (least_bytes, parts) = match self.product {
            Product::Maps => (self.plan(&self.maps_of(planet)).least_bytes(planet)?, "strip"),
            Product::Mesh => (self.mesh(planet).least_bytes(), ""),
            Product::Tiles => (self.tileset().least_bytes(planet), "glb"),
        };
        let is_part = |path: &Path| path.extension().is_some_and(|ending| ending == parts);
        check_room(to, least_bytes, bytes_in(to, &is_part, 1))
    }

    /// Whether the region matters.
    pub fn uses_region(&self) -> bool {
        match self.product {
            Product::Maps => matches!(self.form, Form::Region | Form::Landscape),
            Product::Mesh => self.mesh.of_region,
            Product::Tiles => self.tiles.in_region,
        }
    }

    /// These settings as the small picture shows them: a mesh and tiles by the colours of their ground.
    pub fn as_shown(&self) -> Self {
        let form = if self.uses_region() { Form::Region } else { Form::Globe };
        match self.product {
            Product::Maps => self.clone(),
            Product::Mesh | Product::Tiles => Self { previewed: Map::Albedo, form, ..self.clone() },
        }
    }
}
