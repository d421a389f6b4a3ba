//! `tellus tiles`: a planet as 3D Tiles.

use super::area::{DetailArgs, RegionArgs, tell_slow};
use super::work::{WorkArgs, told};
use super::{Failure, args, load_as_source, maps, outputs, tell};
use crate::bake::Outcome;
use crate::bake::mesh::{MeshWater, Tileset};
use std::path::PathBuf;

/// Write a planet as 3D Tiles 1.1: a tree of GLB files that a viewer streams
#[derive(clap::Args)]
#[command(
    after_help = "Tiles are in the planet frame, metres: Z to the north pole, X to 0°N 0°E. Level N has 2^N squares along \
    each side of the six faces. With a region, levels beyond 2 are there alone. The same command goes on where it was \
    interrupted, makes damaged tiles anew, and does nothing once all is done."
)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The folder for tileset.json and the tiles; it is made if there is none
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The finest level
    #[arg(
        long,
        value_name = "N",
        default_value = "4",
        value_parser = |text: &str| args::whole(text, 0, Tileset::MOST_LEVELS)
    )]
    levels: u8,
    /// Cells along a side of a tile
    #[arg(
        long,
        value_name = "N",
        default_value = "64",
        value_parser = |text: &str| args::whole(text, 2, Tileset::MOST_CELLS)
    )]
    cells: u32,
    /// Width of textures of colour, normals and roughness, of each tile; without it vertices have colours
    #[arg(long, value_name = "PIXELS", value_parser = |text: &str| args::whole(text, 2, Tileset::MOST_TEXTURE))]
    texture: Option<u32>,
    /// surface: tiles run on seas, lakes and rivers. none: on the ground, without water
    #[arg(long, value_name = "CHOICE", default_value = "surface", value_parser = ["surface", "none"])]
    water: String,
    /// Vertices as whole numbers of 16 and 8 bits: tiles are about half as large. Viewers must know
    /// KHR_mesh_quantization
    #[arg(long)]
    quantize: bool,
    /// A binary file for each of the six faces tells of the tiles, instead of a list in tileset.json; levels up to 10.
    /// Viewers must read boxes from the metadata of tiles, which not all do (docs/meshes.md)
    #[arg(long)]
    implicit: bool,
    #[command(flatten)]
    region: RegionArgs,
    #[command(flatten)]
    detail: DetailArgs,
    #[command(flatten)]
    work: WorkArgs,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    args.work.begin()?;
    let (planet, sources) = load_as_source(&args.file)?;
    let tileset = Tileset {
        region: args.region.region(),
        cells: args.cells,
        texture_px: args.texture,
        water: MeshWater::named(&args.water).unwrap_or_default(),
        detail: args.detail.detail,
        is_quantized: args.quantize,
        is_implicit: args.implicit,
        ..Tileset::new(args.levels)
    };
    tileset.check(&planet)?;
    outputs::check_files_in(&args.output, &sources, &tileset.files(&planet, &args.output))?;
    outputs::check_disk(&args.output, tileset.least_bytes(&planet), Some("glb"))?;
    if tileset.is_slow(&planet) {
        tell_slow();
    }
    let outcome = tileset.run(&maps::terrain(planet)?, &args.output, &told("baked"));
    if let Outcome::Kept(_) = outcome.map_err(|error| error.to_string())? {
        tell("the tiles are there already, whole, and made by this bake: nothing was done");
    }
    Ok(())
}
