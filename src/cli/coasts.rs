//! `tellus coasts`: coasts, or lines of another height, as GeoJSON: as lines, or as polygons of land and water.

use super::geojson::{self, feature, rounded};
use super::polygons::{Lines, Polygon};
use super::{Failure, args, load_as_source, maps, outputs};
use crate::planet::file::write_atomically;
use crate::terrain::Contour;
use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

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
    /// The file to write. Lines: closed LineStrings with the land to the left, the longest first; one that crosses the
    /// antimeridian is a MultiLineString. Polygons: of the kinds land and water, cut at the antimeridian
    #[arg(short, long, value_name = "OUT.geojson")]
    output: PathBuf,
    /// Height of the lines over the reference sphere [default: the sea level]
    #[arg(long, value_name = "METRES", value_parser = args::level)]
    height: Option<f64>,
    /// Greatest distance between points: islands and bays that are smaller are left out [default: 1/1024 of a quarter
    /// of the equator]
    #[arg(long, value_name = "METRES", value_parser = args::length)]
    spacing: Option<f64>,
    /// What to write
    #[arg(long = "as", value_name = "SHAPE", value_enum, default_value_t = Shape::Lines)]
    shape: Shape,
    /// Least length of a line; of polygons, of the coast around an island or a lake
    #[arg(long, value_name = "KILOMETRES", default_value = "0", value_parser = args::depth)]
    min_length: f64,
}

/// What a coast is written as.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Shape {
    Lines,
    Polygons,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    outputs::check_ending(&args.output, geojson::ENDINGS)?;
    let (planet, sources) = load_as_source(&args.file)?;
    outputs::check_files(&sources, &[&args.output])?;
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
    let terrain = maps::terrain(planet)?;
    let lines = terrain.contours(height_m, cells);
    let kept = lines.iter().filter(|line| line.length_km >= args.min_length);
    let text = match args.shape {
        Shape::Lines => {
            let drawn = kept.map(|line| contour(line, height_m)).filter(|line| !line["geometry"].is_null());
            geojson::collection(drawn)?
        }
        Shape::Polygons => {
            // Where there is no line, one place tells for all.
            let is_land = terrain.height_m(DVec3::X) >= height_m;
            let lines = Lines::new(kept.map(|line| line.points.as_slice()));
            let [land, water] = [true, false].map(|left| lines.polygons(left, left == is_land));
            let side = |polygons: Vec<Polygon>, kind: &'static str| {
                let properties = json!({ "kind": kind, "height_m": height_m });
                polygons.into_iter().map(move |polygon| feature(&polygon.geometry(), &properties))
            };
            geojson::collection(side(land, "land").chain(side(water, "water")))?
        }
    };
    write_atomically(&args.output, text.as_bytes()).map_err(failed)?;
    Ok(())
}

fn contour(line: &Contour, height_m: f64) -> Value {
    let properties = json!({ "kind": "contour", "height_m": height_m, "length_km": rounded(line.length_km, 1e3) });
    feature(&geojson::line(&geojson::parts(&line.points)), &properties)
}
