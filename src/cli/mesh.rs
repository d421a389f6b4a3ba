//! `tellus mesh`: a planet or a region as a mesh in a file.

use super::area::{DetailArgs, RegionArgs, tell_slow};
use super::work::{WorkArgs, told};
use super::{Failure, args, load_as_source, maps, outputs};
use crate::bake::MAX_SIZE;
use crate::bake::mesh::{Area, MeshBake, MeshFormat, MeshWater};
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use std::path::{Path, PathBuf};

/// Write a planet or a region as a mesh: glTF 2.0 (GLB) or OBJ
#[derive(clap::Args)]
#[command(
    after_help = "A globe is six meshes about the planet's centre, +Y to the north pole, +X to 0°N 0°E. A region is one \
    mesh about its centre on the reference sphere, +X to the east, +Y up, -Z to the north. Heights of vertices are \
    those of `tellus sample`."
)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The file to write. A .glb holds its textures; an .obj has a .mtl and .png files beside it
    #[arg(short, long, value_name = "OUT.glb|OUT.obj")]
    output: PathBuf,
    /// Greatest distance between vertices along a square's middle [default: 1/256 of a side of the region, or of a side
    /// of one of the six squares of a globe]
    #[arg(long, value_name = "METRES", value_parser = args::length)]
    spacing: Option<f64>,
    #[command(flatten)]
    region: RegionArgs,
    /// Width of textures of colour, normals and roughness, of each square; without it vertices have colours
    #[arg(long, value_name = "PIXELS", value_parser = |text: &str| args::whole(text, 2, MAX_SIZE))]
    texture: Option<u32>,
    /// surface: the mesh runs on seas, lakes and rivers, which are opaque. apart: on the ground, with a transparent
    /// mesh of the water over it. none: on the ground, without water
    #[arg(
        long,
        value_name = "CHOICE",
        default_value = "surface",
        value_parser = PossibleValuesParser::new(MeshWater::ALL.map(MeshWater::name)).try_map(|name| MeshWater::named(&name).ok_or(name))
    )]
    water: MeshWater,
    /// Levels of detail, each with half the vertices of the one before along a side: nodes NAME_LOD0, NAME_LOD1 and so
    /// on, linked by MSFT_lod in a .glb
    #[arg(
        long,
        value_name = "N",
        default_value = "1",
        value_parser = |text: &str| args::whole(text, 1, MeshBake::MOST_LEVELS)
    )]
    lods: u32,
    /// Depth of skirts around the squares, which hide gaps between levels of detail: at most half the planet's radius,
    /// and with --quantize a side of a square
    #[arg(long, value_name = "METRES", default_value = "0", value_parser = args::depth)]
    skirt: f64,
    /// Units of the file in a metre, such as 0.001 for kilometres
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = args::scale)]
    scale: f64,
    /// Vertices as whole numbers of 16 and 8 bits: half as large. Readers must know KHR_mesh_quantization; .glb alone
    #[arg(long)]
    quantize: bool,
    #[command(flatten)]
    detail: DetailArgs,
    #[command(flatten)]
    work: WorkArgs,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    args.work.begin()?;
    let Some(format) = MeshFormat::of(&args.output) else {
        let path = args.output.display();
        return Err(format!("{path}: the ending names no kind of mesh; use .glb or .obj").into());
    };
    let (planet, sources) = load_as_source(&args.file)?;
    let area = args.region.region().map_or(Area::Globe, Area::Region);
    let cells = MeshBake::cells_for(&area, planet.radius_m(), args.spacing, args.lods);
    let mesh = MeshBake {
        texture_px: args.texture,
        water: args.water,
        levels: args.lods,
        skirt_m: args.skirt,
        scale: args.scale,
        detail: args.detail.detail,
        is_quantized: args.quantize,
        ..MeshBake::new(area, cells, format)
    };
    mesh.check(&planet)?;
    outputs::check_files(&sources, &mesh.files(planet.radius_m(), &args.output))?;
    outputs::check_disk(args.output.parent().unwrap_or(Path::new("")), mesh.least_bytes(), None)?;
    if mesh.is_slow(&planet) {
        tell_slow();
    }
    mesh.run(&maps::terrain(planet)?, &args.output, &told("baked")).map_err(|error| error.to_string())?;
    Ok(())
}
