//! `tellus nearest`: the nearest place with a property.

use super::{Failure, args, load, maps, print, sample};
use crate::planet::Planet;
use crate::sphere::LatLon;
use crate::terrain::{Sample, Search, Wanted};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

/// Points along the way to the farthest place, unless a spacing is given.
const DEFAULT_STEPS: f64 = 500.0;

/// Find the nearest place with a property, such as land, a river, a biome or level ground
#[derive(clap::Args)]
#[command(
    after_help = "Points are looked at on circles around the start, --spacing apart; what is narrower may be overlooked. \
    All properties that are named must hold. Without such a place the status is 1."
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
    /// Print a JSON object: lat, lon, distance_m, and what `tellus sample` tells
    #[arg(long)]
    json: bool,
}

/// What must hold.
#[derive(clap::Args)]
#[group(required = true, multiple = true)]
struct Property {
    /// land: no water over the ground. sea, lake, river: their water
    #[arg(long = "what", value_name = "WHAT", value_parser = ["land", "sea", "lake", "river"])]
    water: Option<String>,
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

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let planet = Arc::new(load(&args.file)?);
    planet.check_ground()?;
    let property = &args.property;
    let biome = property.biome.as_deref().map(|name| biome(&planet, name)).transpose()?;
    let within_m = args.within * 1000.0;
    let mut wanted = Wanted::HEIGHT;
    if property.slope.is_some() {
        wanted = wanted.and_normal();
    }
    if biome.is_some() {
        wanted = wanted.and_biome();
    }
    if property.water.is_some() {
        wanted = wanted.and_water();
    }
    let start = LatLon::from_degrees(args.lat, args.lon).direction();
    let search =
        Search { around_planet: start, within_m, spacing_m: args.spacing.unwrap_or(within_m / DEFAULT_STEPS), wanted };
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
        property.water.as_deref().is_none_or(is_of)
            && biome.is_none_or(|biome| sample.biome == biome)
            && property.slope.is_none_or(|slope_deg| sample.slope_rad.to_degrees() <= slope_deg)
            && property.above.is_none_or(|above_m| sample.height_m >= above_m)
            && property.below.is_none_or(|below_m| sample.height_m <= below_m)
    };
    let terrain = maps::terrain(planet)?;
    let Some(place) = terrain.nearest(&search, &holds, &|_| true)? else {
        return Err(format!("there is no such place within {} km of the start", args.within).into());
    };
    let (lat_deg, lon_deg) = LatLon::from_direction(place.dir_planet).to_degrees();
    if !args.json {
        let heading_deg = sample::heading_deg(start, place.dir_planet - start);
        let (height_m, away_km) = (place.sample.height_m, place.away_m / 1000.0);
        return print(&format!(
            "{lat_deg:.6}, {lon_deg:.6}: {away_km:.3} km away, heading {heading_deg:.0}°, height {height_m:.1} m"
        ));
    }
    let mut answer = sample::everything(&terrain, place.dir_planet, 0.0);
    answer["lat"] = json!(lat_deg);
    answer["lon"] = json!(lon_deg);
    answer["distance_m"] = json!(place.away_m);
    print(&format!("{answer:#}"))
}

/// The index of a biome.
fn biome(planet: &Planet, name: &str) -> Result<usize, String> {
    let palette = &planet.biomes.palette;
    palette.iter().position(|biome| biome.name.eq_ignore_ascii_case(name)).ok_or_else(|| {
        let names: Vec<&str> = palette.iter().map(|biome| biome.name.as_str()).collect();
        format!("{} has no biome {name}; it has {}", planet.name, names.join(", "))
    })
}
