//! `tellus instances`: the plants, stones and other objects of a region, one by one.
//!
//! - `rows`: a table, and points; `columns`: the table by columns

mod columns;
mod rows;

use super::{Failure, args, geojson, load_as_source, maps, outputs};
use crate::bake::Region;
use crate::bake::mesh::ObjectBake;
use crate::life::{Instance, TooMany};
use crate::planet::Planet;
use crate::planet::file::write_atomically_with;
use crate::sphere::{LatLon, Tangent};
use crate::terrain::Terrain;
use glam::DVec3;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// Write the plants, stones and other objects of a region, one by one
#[derive(clap::Args)]
#[command(
    after_help = "Objects are those that pictures show and that the library answers. Columns of a .csv or .parquet: id, kind (the \
    population), latitude_deg, longitude_deg, height_m (of the foot), turn_deg (about the object's axis, against the \
    clock from the east as seen from above), scale (1 is the height of the population), qx, qy, qz, qw (the whole turn \
    with the lean: a quaternion from the form, z up, to east, north and up at the place). A .glb has a mesh for each \
    population and variant with its instances (EXT_mesh_gpu_instancing), in the frame of `tellus mesh` for the same \
    region; its sides are at most 20 km."
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
    /// The file to write, in ascending order of ids: a table, points, or meshes with instances
    #[arg(short, long, value_name = "OUT.csv|.parquet|.geojson|.glb")]
    output: PathBuf,
}

/// A kind of file.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Table,
    Columns,
    Points,
    Meshes,
}

impl Format {
    /// The endings of its files' names.
    fn endings(self) -> &'static [&'static str] {
        match self {
            Format::Table => &["csv"],
            Format::Columns => &["parquet"],
            Format::Points => geojson::ENDINGS,
            Format::Meshes => &["glb"],
        }
    }

    /// The format that the ending of a path names.
    fn of(path: &Path) -> Result<Self, Failure> {
        let all = [Format::Table, Format::Columns, Format::Points, Format::Meshes];
        let endings: Vec<&str> = all.iter().flat_map(|format| format.endings()).copied().collect();
        outputs::check_ending(path, &endings)?;
        let ending = path.extension().unwrap_or_default();
        let is_of = |format: &Format| format.endings().iter().any(|one| ending.eq_ignore_ascii_case(one));
        Ok(all.into_iter().find(is_of).unwrap_or(Format::Table))
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let format = Format::of(&args.output)?;
    let (planet, sources) = load_as_source(&args.file)?;
    outputs::check_files(&sources, &[&args.output])?;
    planet.check_ground()?;
    let bake = ObjectBake::new(Region { lat_deg: args.lat, lon_deg: args.lon, side_km: args.km });
    if format == Format::Meshes {
        bake.check(&planet).map_err(|error| format!("--km: {error}"))?;
    }
    let only = chosen(&planet, &args.kind)?;
    let terrain = maps::terrain(planet)?;
    let middle = LatLon::from_degrees(args.lat, args.lon).direction();
    let found = region(&terrain, middle, args.km * 1000.0, &only).map_err(|error| format!("--km: {error}"))?;
    let (planet, path) = (terrain.planet(), &args.output);
    let write = |write: &mut dyn FnMut(&mut File) -> io::Result<()>| {
        write_atomically_with(path, None, write).map_err(|error| format!("{}: {error}", path.display()))
    };
    match format {
        Format::Table => write(&mut |file| rows::write_table(file, planet, &found))?,
        Format::Columns => write(&mut |file| columns::write(file, planet, &found))?,
        Format::Points => write(&mut |file| rows::write_points(file, planet, &found))?,
        Format::Meshes => bake.write(planet, &found, path).map_err(|error| error.to_string())?,
    }
    Ok(())
}

/// Indices of populations that are named; empty, which stands for all, without a name.
pub(super) fn chosen(planet: &Planet, names: &[String]) -> Result<Vec<u16>, Failure> {
    let known: Vec<&str> = planet.life.iter().map(|population| population.name.as_str()).collect();
    if let Some(stranger) = names.iter().find(|name| !known.contains(&name.as_str())) {
        let right = match known.as_slice() {
            [] => format!("{} has no populations", planet.name),
            known => format!("use {}", known.join(", ")),
        };
        return Err(format!("--kind: there is no population {stranger:?}; {right}").into());
    }
    Ok((0..).zip(known).filter(|(_, name)| names.iter().any(|wanted| wanted == name)).map(|(index, _)| index).collect())
}

/// The objects of some populations, or of all if none is named, in a square about a direction.
fn region(terrain: &Terrain, middle: DVec3, side_m: f64, populations: &[u16]) -> Result<Vec<Instance>, TooMany> {
    let (frame, planet_m) = (Tangent::new(middle), terrain.planet().radius_m());
    let half_rad = 0.5 * side_m / planet_m;
    let is_within = |dir: DVec3| {
        let local = frame.local(dir);
        let aside = libm::hypot(local.x, local.y);
        let stretch = if aside > 0.0 { libm::atan2(aside, local.z) / aside } else { 1.0 };
        local.x.abs() * stretch <= half_rad && local.y.abs() * stretch <= half_rad
    };
    terrain.instances_where(middle, 0.5 * side_m * std::f64::consts::SQRT_2, populations, &is_within)
}

/// Name of the population, and height as a share of the population's.
pub(super) fn kind_and_scale<'a>(planet: &'a Planet, instance: &Instance) -> (&'a str, f64) {
    let population = &planet.life[usize::from(instance.population)];
    (&population.name, instance.size_m / population.height_m)
}
