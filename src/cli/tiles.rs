//! `tellus tiles`: a planet as 3D Tiles.

use super::bake::told;
use super::{Failure, args, load, maps, tell};
use crate::bake::mesh::{MeshWater, Tileset};
use crate::bake::{Detail, Region};
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use std::path::PathBuf;
use std::sync::Arc;

/// Write a planet as 3D Tiles 1.1: a tree of GLB files that a viewer streams
#[derive(clap::Args)]
#[command(
    after_help = "Tiles are in the planet frame, metres: Z to the north pole, X to 0°N 0°E. Level N has 2^N squares along \
    each side of the six faces. The same command goes on where it was interrupted."
)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The folder for tileset.json and the tiles; it is made if there is none
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The finest level
    #[arg(long, value_name = "N", default_value = "4")]
    levels: u8,
    /// Cells along a side of a tile
    #[arg(long, value_name = "N", default_value = "64")]
    cells: u32,
    /// Width of textures of colour, normals and roughness, of each tile; without it vertices have colours
    #[arg(long, value_name = "PIXELS")]
    texture: Option<u32>,
    /// surface: tiles run on seas, lakes and rivers. none: on the ground, without water
    #[arg(long, value_name = "CHOICE", default_value = "surface", value_parser = ["surface", "none"])]
    water: String,
    #[arg(
        long,
        help = "Latitude of the centre of a region in degrees: levels beyond 2 are there alone [default: everywhere]",
        value_name = "DEG",
        allow_hyphen_values = true,
        value_parser = args::latitude,
        requires_all = ["lon", "km"]
    )]
    lat: Option<f64>,
    #[arg(
        long,
        help = "Longitude of the centre of a region in degrees, east positive",
        value_name = "DEG",
        allow_hyphen_values = true,
        value_parser = args::longitude,
        requires_all = ["lat", "km"]
    )]
    lon: Option<f64>,
    /// Length of a side of a region
    #[arg(long, value_name = "KILOMETRES", value_parser = args::region, requires_all = ["lat", "lon"])]
    km: Option<f64>,
    /// all: what `tellus sample` answers. pixel: without valleys and rivers of a structure that are too narrow for the
    /// vertices of a tile; a globe takes seconds instead of hours
    #[arg(
        long,
        value_name = "DETAIL",
        default_value = "all",
        value_parser = PossibleValuesParser::new(Detail::ALL.map(Detail::name)).try_map(|name| Detail::named(&name).ok_or(name))
    )]
    detail: Detail,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let planet = Arc::new(load(&args.file)?);
    let region = match (args.lat, args.lon, args.km) {
        (Some(lat_deg), Some(lon_deg), Some(side_km)) => Some(Region { lat_deg, lon_deg, side_km }),
        _ => None,
    };
    if planet.structure.is_some() && args.detail == Detail::All {
        tell(
            "note: every river under the vertices is made, milliseconds for each where they are far apart; --detail pixel leaves out the narrow ones",
        );
    }
    let tileset = Tileset {
        region,
        cells: args.cells,
        texture_px: args.texture,
        water: MeshWater::named(&args.water).unwrap_or_default(),
        detail: args.detail,
        ..Tileset::new(Arc::new(maps::terrain(planet)?), args.levels)
    };
    tileset.run(&args.output, &told()).map_err(|error| error.to_string())?;
    Ok(())
}
