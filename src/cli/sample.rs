//! `tellus sample`: height, normal, climate and biome at a location, from the evaluator that the editor and games use.

use super::{Failure, args, load, print};
use crate::sphere::LatLon;
use crate::terrain::{Sample, Terrain};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// Print height, slope, climate and biome at a location
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// Latitude in degrees, north positive
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = args::latitude)]
    lat: f64,
    /// Longitude in degrees, east positive
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = args::longitude)]
    lon: f64,
    /// Print a JSON object: height_m, slope_deg, normal, temperature_c, precipitation_mm (a year), temperature and
    /// moisture (0 to 1, the axes of the biome table), biome, layers
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let terrain = Terrain::try_new(Arc::new(load(&args.file)?)).map_err(|error| error.to_string())?;
    let dir = LatLon::from_degrees(args.lat, args.lon).direction();
    let (sample, layers_m) = (terrain.sample(dir), terrain.layers_m(dir));
    let answer = if args.json {
        format!("{:#}", as_json(&terrain, &sample, &layers_m))
    } else {
        as_text(&terrain, &sample, &layers_m)
    };
    print(&answer)
}

fn biome_name<'a>(terrain: &'a Terrain, sample: &Sample) -> &'a str {
    terrain.planet().biomes.palette.get(sample.biome).map_or("", |biome| biome.name.as_str())
}

fn as_json(terrain: &Terrain, sample: &Sample, layers_m: &[f64]) -> Value {
    let layers = terrain.planet().layers.iter().zip(layers_m);
    json!({
        "height_m": sample.height_m,
        "slope_deg": sample.slope_rad.to_degrees(),
        "normal": sample.normal_planet.to_array(),
        "temperature_c": sample.temperature_c,
        "temperature": sample.temperature,
        "precipitation_mm": sample.precipitation_mm,
        "moisture": sample.moisture,
        "biome": biome_name(terrain, sample),
        "layers": layers.map(|(layer, m)| json!({ "name": layer.name, "height_m": m })).collect::<Vec<_>>(),
    })
}

fn as_text(terrain: &Terrain, sample: &Sample, layers_m: &[f64]) -> String {
    let [x, y, z] = sample.normal_planet.to_array();
    let mut lines = vec![
        format!("height       {:.3} m", sample.height_m),
        format!("slope        {:.2}°", sample.slope_rad.to_degrees()),
        format!("normal       {x:.6} {y:.6} {z:.6}"),
        format!("temperature  {:.1} °C ({:.3})", sample.temperature_c, sample.temperature),
        format!("moisture     {:.3} ({:.0} mm a year)", sample.moisture, sample.precipitation_mm),
        format!("biome        {}", biome_name(terrain, sample)),
    ];
    let layers = terrain.planet().layers.iter().zip(layers_m);
    lines.extend(layers.map(|(layer, m)| format!("layer        {:.3} m  {}", m, layer.name)));
    lines.join("\n")
}
