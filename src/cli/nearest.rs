//! `tellus nearest`: the nearest place with a property, and the nearest object.

use super::{Failure, args, instances, load, maps, print, sample};
use crate::life::{Instance, NearestObject};
use crate::planet::Planet;
use crate::sphere::LatLon;
use crate::terrain::{Sample, Search, Terrain, Wanted};
use glam::DVec3;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// Points along the way to the farthest place, unless a spacing is given.
const DEFAULT_STEPS: f64 = 500.0;

/// Find the nearest place with a property, such as land, a river, a biome, level ground or a tree
#[derive(clap::Args)]
#[command(
    after_help = "Points are looked at on circles around the start, --spacing apart; what is narrower may be overlooked. \
    All properties that are named must hold. Objects are all looked at, the nearest first, whatever the spacing. Without \
    such a place the status is 1."
)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    #[arg(
        long,
        help = "Latitude of the start in degrees, north positive",
        value_name = "DEG",
        value_parser = args::latitude
    )]
    lat: f64,
    #[arg(
        long,
        help = "Longitude of the start in degrees, east positive",
        value_name = "DEG",
        value_parser = args::longitude
    )]
    lon: f64,
    /// Greatest distance from the start
    #[arg(long, value_name = "KILOMETRES", default_value = "1000", value_parser = args::region)]
    within: f64,
    /// Distance between the points that are looked at [default: 1/500 of --within]
    #[arg(long, value_name = "METRES", value_parser = args::length)]
    spacing: Option<f64>,
    #[command(flatten)]
    property: Property,
    /// Print a JSON object: lat, lon, distance_m, object if one was asked for, and what `tellus sample` tells
    #[arg(long)]
    json: bool,
}

/// What must hold.
#[derive(clap::Args)]
#[group(required = true, multiple = true)]
struct Property {
    /// land: no water over the ground. sea, lake, river: their water. object: a plant, a stone or another object
    #[arg(long, value_name = "WHAT", value_parser = ["land", "sea", "lake", "river", "object"])]
    what: Option<String>,
    /// An object of these populations, by their names
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    kind: Vec<String>,
    /// A biome of the palette, by its name
    #[arg(long, value_name = "BIOME")]
    biome: Option<String>,
    /// Ground no steeper than this
    #[arg(long, value_name = "DEGREES", value_parser = args::zenith)]
    slope: Option<f64>,
    /// Ground no lower than this over the reference sphere
    #[arg(long, value_name = "METRES", value_parser = args::level)]
    above: Option<f64>,
    /// Ground no higher than this over the reference sphere
    #[arg(long, value_name = "METRES", value_parser = args::level)]
    below: Option<f64>,
}

impl Property {
    /// The water that is wanted, or that there is none.
    fn water(&self) -> Option<&str> {
        self.what.as_deref().filter(|what| *what != "object")
    }

    /// Whether an object is wanted.
    fn is_object(&self) -> bool {
        !self.kind.is_empty() || self.what.as_deref() == Some("object")
    }

    /// Whether more than an object is wanted.
    fn is_of_ground(&self) -> bool {
        let bounds = [self.slope, self.above, self.below];
        self.water().is_some() || self.biome.is_some() || bounds.iter().any(Option::is_some)
    }

    /// What decides about the property.
    fn wanted(&self) -> Wanted {
        let normal = if self.slope.is_some() { Wanted::HEIGHT.and_normal() } else { Wanted::HEIGHT };
        let biome = if self.biome.is_some() { normal.and_biome() } else { normal };
        if self.water().is_some() { biome.and_water() } else { biome }
    }
}

/// What was found.
struct Found {
    dir_planet: DVec3,
    away_m: f64,
    object: Option<Instance>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let planet = Arc::new(load(&args.file)?);
    planet.check_ground()?;
    let property = &args.property;
    let biome = property.biome.as_deref().map(|name| biome(&planet, name)).transpose()?;
    let kinds = instances::chosen(&planet, &property.kind)?;
    let sea_m = planet.sea_level_m();
    let holds = |sample: &Sample| {
        let is_of = |what: &str| {
            let wet_m = sample.water_level_m.filter(|level_m| *level_m > sample.height_m);
            match what {
                "land" => wet_m.is_none(),
                "sea" => wet_m.is_some() && wet_m == sea_m,
                "lake" => wet_m.is_some() && sample.lake.is_some(),
                _ => wet_m.is_some() && wet_m != sea_m && sample.lake.is_none(),
            }
        };
        property.water().is_none_or(is_of)
            && biome.is_none_or(|biome| sample.biome == biome)
            && property.slope.is_none_or(|slope_deg| sample.slope_rad.to_degrees() <= slope_deg)
            && property.above.is_none_or(|above_m| sample.height_m >= above_m)
            && property.below.is_none_or(|below_m| sample.height_m <= below_m)
    };
    let start = LatLon::from_degrees(args.lat, args.lon).direction();
    let terrain = maps::terrain(planet)?;
    let found = if property.is_object() {
        object(&terrain, args, &kinds, &holds)?
    } else {
        let within_m = args.within * 1000.0;
        let spacing_m = args.spacing.unwrap_or(within_m / DEFAULT_STEPS);
        let search = Search { around_planet: start, within_m, spacing_m, wanted: property.wanted() };
        let place = terrain.nearest(&search, &holds, &|_| true)?;
        place.map(|place| Found { dir_planet: place.dir_planet, away_m: place.away_m, object: None })
    };
    let Some(found) = found else {
        let what = if property.is_object() { "object" } else { "place" };
        return Err(format!("there is no such {what} within {} km of the start", args.within).into());
    };
    tell(&terrain, start, &found, args.json)
}

/// The nearest object of populations on ground with the other properties.
fn object(
    terrain: &Terrain,
    args: &Args,
    populations: &[u16],
    holds: &(dyn Fn(&Sample) -> bool + Sync),
) -> Result<Option<Found>, String> {
    let start = LatLon::from_degrees(args.lat, args.lon).direction();
    let (wanted, is_of_ground) = (args.property.wanted(), args.property.is_of_ground());
    let takes = |instance: &Instance| {
        !is_of_ground || terrain.samples(&[instance.dir_planet], wanted).first().is_some_and(holds)
    };
    let found = terrain.nearest_object(start, args.within * 1000.0, populations, &takes);
    let found = found.map_err(|error| format!("--within: none is near, and {error}"))?;
    Ok(found.map(|NearestObject { instance, away_m, .. }| Found {
        dir_planet: instance.dir_planet,
        away_m,
        object: Some(instance),
    }))
}

/// Prints what was found.
fn tell(terrain: &Terrain, start: DVec3, found: &Found, as_json: bool) -> Result<(), Failure> {
    let Found { dir_planet, away_m, object } = found;
    let (lat_deg, lon_deg) = LatLon::from_direction(*dir_planet).to_degrees();
    if !as_json {
        let heading_deg = sample::heading_deg(start, *dir_planet - start);
        let (away_km, digits) = (away_m / 1000.0, if object.is_some() { 9 } else { 6 });
        let what = match object {
            Some(object) => {
                let (kind, _) = instances::kind_and_scale(terrain.planet(), object);
                format!("{kind} {}, {:.2} m high, foot at {:.1} m", object.id, object.size_m, object.base_m)
            }
            None => format!("height {:.1} m", terrain.height_m(*dir_planet)),
        };
        return print(&format!(
            "{lat_deg:.digits$}, {lon_deg:.digits$}: {away_km:.3} km away, heading {heading_deg:.0}°, {what}"
        ));
    }
    let mut answer = sample::everything(terrain, *dir_planet, 0.0);
    answer["lat"] = json!(lat_deg);
    answer["lon"] = json!(lon_deg);
    answer["distance_m"] = json!(away_m);
    if let Some(object) = object {
        answer["object"] = of_object(terrain.planet(), object);
    }
    print(&format!("{answer:#}"))
}

fn of_object(planet: &Planet, object: &Instance) -> Value {
    let (kind, scale) = instances::kind_and_scale(planet, object);
    json!({
        // JSON numbers do not hold all bits of an id.
        "id": object.id.to_string(),
        "kind": kind,
        "height_m": object.base_m,
        "size_m": object.size_m,
        "turn_deg": object.turn_rad.to_degrees(),
        "quaternion": object.local_from_form().to_array(),
        "scale": scale,
    })
}

/// The index of a biome.
fn biome(planet: &Planet, name: &str) -> Result<usize, String> {
    let palette = &planet.biomes.palette;
    palette.iter().position(|biome| biome.name.eq_ignore_ascii_case(name)).ok_or_else(|| {
        let names: Vec<&str> = palette.iter().map(|biome| biome.name.as_str()).collect();
        format!("{} has no biome {name}; it has {}", planet.name, names.join(", "))
    })
}
