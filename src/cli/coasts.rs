//! `tellus coasts`: coasts, or lines of another height, as GeoJSON.

use super::geojson::{self, feature, rounded};
use super::{Failure, args, load, maps};
use crate::planet::file::{Target, write_atomically};
use crate::terrain::Contour;
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;
use std::sync::Arc;

/// Cells along a side of a face, unless a spacing is given.
const DEFAULT_CELLS: u32 = 1024;
/// Most cells along a side of a face.
const MOST_CELLS: u32 = 16_384;

/// Write coasts, or lines of another height, as GeoJSON
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The file to write: closed LineStrings with the land to the left, the longest first; one that crosses the
    /// antimeridian is a MultiLineString
    #[arg(short, long, value_name = "OUT.geojson")]
    output: PathBuf,
    /// Height of the lines over the reference sphere [default: the sea level]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = args::level)]
    height: Option<f64>,
    /// Greatest distance between points: islands and bays that are smaller are left out [default: 1/1024 of a quarter
    /// of the equator]
    #[arg(long, value_name = "METRES", value_parser = args::length)]
    spacing: Option<f64>,
    /// Least length of a line
    #[arg(long, value_name = "KILOMETRES", default_value = "0", value_parser = args::depth)]
    min_length: f64,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let planet = Arc::new(load(&args.file)?);
    planet.check_ground()?;
    let Some(height_m) = args.height.or(planet.sea_level_m()) else {
        let file = args.file.display();
        return Err(format!("{file}: {} has no sea; name the --height of the lines", planet.name).into());
    };
    let cells = match args.spacing {
        // Too many cells stay too many as a whole number.
        Some(spacing_m) => (FRAC_PI_2 * planet.radius_m() / spacing_m).ceil() as u32,
        None => DEFAULT_CELLS,
    };
    if cells > MOST_CELLS {
        let least_m = FRAC_PI_2 * planet.radius_m() / f64::from(MOST_CELLS);
        return Err(format!("--spacing: too small for the whole globe; use {least_m:.3} m or more").into());
    }
    let failed = |error: String| format!("{}: {error}", args.output.display());
    Target::checked(&args.output).map_err(failed)?;
    let lines = maps::terrain(planet)?.contours(height_m, cells);
    let kept = lines.iter().filter(|line| line.length_km >= args.min_length);
    let text = geojson::collection(kept.map(|line| contour(line, height_m)))?;
    write_atomically(&args.output, text.as_bytes()).map_err(failed)?;
    Ok(())
}

fn contour(line: &Contour, height_m: f64) -> Value {
    let properties = json!({ "kind": "contour", "height_m": height_m, "length_km": rounded(line.length_km, 1e3) });
    feature(&geojson::line(&geojson::parts(&line.points)), &properties)
}
