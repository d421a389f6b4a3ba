//! `tellus instances`: the plants, stones and other objects of a region, one by one.

use super::geojson::{self, feature, rounded};
use super::{Failure, args, load_as_source, maps, outputs};
use crate::life::Instance;
use crate::planet::Planet;
use crate::planet::file::write_atomically;
use crate::sphere::{LatLon, Tangent};
use crate::terrain::Terrain;
use glam::DVec3;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Write the plants, stones and other objects of a region, one by one
#[derive(clap::Args)]
#[command(
    after_help = "Objects are those that pictures show and that the library answers. Columns of a CSV: id, kind (the \
    population), latitude_deg, longitude_deg, height_m (of the foot), turn_deg (about the object's axis, against the \
    clock from the east as seen from above), scale (1 is the height of the population)."
)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    #[arg(
        long,
        help = "Latitude of the middle in degrees, north positive",
        value_name = "DEG",
        value_parser = args::latitude
    )]
    lat: f64,
    #[arg(
        long,
        help = "Longitude of the middle in degrees, east positive",
        value_name = "DEG",
        value_parser = args::longitude
    )]
    lon: f64,
    /// Length of a side of the region: a square about the middle, azimuthal equidistant
    #[arg(long, value_name = "KILOMETRES", default_value = "1", value_parser = args::region)]
    km: f64,
    /// Populations by their names [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    kind: Vec<String>,
    /// The file to write, in ascending order of ids: a table, or points
    #[arg(short, long, value_name = "OUT.csv|.geojson")]
    output: PathBuf,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let endings: Vec<&str> = ["csv"].into_iter().chain(geojson::ENDINGS.iter().copied()).collect();
    outputs::check_ending(&args.output, &endings)?;
    let (planet, sources) = load_as_source(&args.file)?;
    outputs::check_files(&sources, &[&args.output])?;
    planet.check_ground()?;
    let only = chosen(&planet, &args.kind)?;
    let terrain = maps::terrain(planet)?;
    let found = region(&terrain, LatLon::from_degrees(args.lat, args.lon).direction(), args.km * 1000.0)
        .map_err(|error| format!("--km: {error}"))?;
    let kept: Vec<&Instance> = found.iter().filter(|instance| only[usize::from(instance.population)]).collect();
    let failed = |error: String| format!("{}: {error}", args.output.display());
    let is_table = args.output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let text =
        if is_table { table(terrain.planet(), &kept).map_err(failed)? } else { points(terrain.planet(), &kept)? };
    write_atomically(&args.output, text.as_bytes()).map_err(failed)?;
    Ok(())
}

/// For each population, whether it is written.
fn chosen(planet: &Planet, names: &[String]) -> Result<Vec<bool>, Failure> {
    let known: Vec<&str> = planet.life.iter().map(|population| population.name.as_str()).collect();
    if let Some(stranger) = names.iter().find(|name| !known.contains(&name.as_str())) {
        let right = match known.as_slice() {
            [] => format!("{} has no populations", planet.name),
            known => format!("use {}", known.join(", ")),
        };
        return Err(format!("--kind: there is no population {stranger:?}; {right}").into());
    }
    Ok(known.iter().map(|name| names.is_empty() || names.iter().any(|wanted| wanted == name)).collect())
}

/// The objects of a square about a direction.
fn region(terrain: &Terrain, middle: DVec3, side_m: f64) -> Result<Vec<Instance>, crate::life::TooMany> {
    let (frame, planet_m) = (Tangent::new(middle), terrain.planet().radius_m());
    let half_rad = 0.5 * side_m / planet_m;
    let is_within = |dir: DVec3| {
        let local = frame.local(dir);
        let aside = libm::hypot(local.x, local.y);
        let stretch = if aside > 0.0 { libm::atan2(aside, local.z) / aside } else { 1.0 };
        local.x.abs() * stretch <= half_rad && local.y.abs() * stretch <= half_rad
    };
    terrain.instances_where(middle, 0.5 * side_m * std::f64::consts::SQRT_2, &[], &is_within)
}

/// Name of the population, and height as a share of the population's.
fn kind_and_scale<'a>(planet: &'a Planet, instance: &Instance) -> (&'a str, f64) {
    let population = &planet.life[usize::from(instance.population)];
    (&population.name, instance.size_m / population.height_m)
}

fn table(planet: &Planet, instances: &[&Instance]) -> Result<String, String> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let header = ["id", "kind", "latitude_deg", "longitude_deg", "height_m", "turn_deg", "scale"];
    table.write_record(header).map_err(|error| error.to_string())?;
    for instance in instances {
        let (lat_deg, lon_deg) = LatLon::from_direction(instance.dir_planet).to_degrees();
        let (kind, scale) = kind_and_scale(planet, instance);
        let row = [
            instance.id.to_string(),
            kind.to_owned(),
            format!("{lat_deg:.9}"),
            format!("{lon_deg:.9}"),
            format!("{:.3}", instance.base_m),
            format!("{:.2}", instance.turn_rad.to_degrees()),
            format!("{scale:.4}"),
        ];
        table.write_record(row).map_err(|error| error.to_string())?;
    }
    let bytes = table.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

fn points(planet: &Planet, instances: &[&Instance]) -> Result<String, String> {
    geojson::collection(instances.iter().map(|instance| {
        let (lat_deg, lon_deg) = LatLon::from_direction(instance.dir_planet).to_degrees();
        let (kind, scale) = kind_and_scale(planet, instance);
        let height_m = rounded(instance.base_m, 1e3);
        let geometry: Value =
            json!({ "type": "Point", "coordinates": [rounded(lon_deg, 1e9), rounded(lat_deg, 1e9), height_m] });
        // A number of JSON does not hold all bits of an id.
        let properties = json!({
            "id": instance.id.to_string(),
            "kind": kind,
            "turn_deg": rounded(instance.turn_rad.to_degrees(), 1e2),
            "scale": rounded(scale, 1e4),
        });
        feature(&geometry, &properties)
    }))
}
