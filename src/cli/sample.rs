//! `tellus sample`: height, normal, climate, biome and water at a location, from the evaluator that the editor and
//! games use.

use super::points::Points;
use super::work::WorkArgs;
use super::{Failure, args, load, maps, print};
use crate::clouds::{CloudCover, CloudField};
use crate::life::{Canopies, Canopy};
use crate::sea::{Column, WaterSurface, Waves};
use crate::sphere::LatLon;
use crate::sphere::geo::east_north;
use crate::terrain::{GroundMaterial, GroundMaterials, River, Sample, Terrain};
use glam::DVec3;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// Print height, slope, climate, biome and water at a location, or at many
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    #[arg(
        long,
        help = "Latitude in degrees, north positive",
        value_name = "DEG",
        value_parser = args::latitude,
        required_unless_present = "points"
    )]
    lat: Option<f64>,
    #[arg(
        long,
        help = "Longitude in degrees, east positive",
        value_name = "DEG",
        value_parser = args::longitude,
        required_unless_present = "points"
    )]
    lon: Option<f64>,
    /// Many locations, LAT,LON on each line, from a file or from standard input (-). Empty lines and lines that begin
    /// with # are skipped. The answer is a JSON object on a line for each, in order, as --json prints it, with lat and
    /// lon
    #[arg(long, value_name = "FILE", conflicts_with_all = ["lat", "lon"])]
    points: Option<PathBuf>,
    /// Heights alone, in metres, for the points of --points: one number on a line for each point, as height_m of --json
    #[arg(long, requires = "points", conflicts_with_all = ["json", "lat", "lon", "time"])]
    heights: bool,
    /// Time in seconds, for clouds and waves
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = args::seconds)]
    time: f64,
    /// Print a JSON object: height_m, slope_deg, curvature (-1 to 1, below 0 in hollows), normal, temperature_c,
    /// precipitation_mm (a year), temperature and moisture (0 to 1, the axes of the biome table), biome, material
    /// (the pattern of the ground, whether of a patch or of the rock of steep ground), canopy_cover (0 to 1),
    /// canopy_height_m, populations (objects per_hectare), layers, water_level_m, water_surface_m (of the sea, with
    /// its waves), wave_height_m (significant), river, lake, bank_m (distance from water), basin, wind_m_s (to the
    /// east and to the north), rain_mm (a year), plate, cloud_cover, middle_cover, veil_cover and fog_cover (0 to 1)
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    work: WorkArgs,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    args.work.begin()?;
    let planet = Arc::new(load(&args.file)?);
    if args.heights {
        planet.check_ground()?;
    }
    let terrain = || maps::terrain(planet);
    if let Some(points) = &args.points {
        // A file that is not there is told before anything is solved.
        let points = Points::open(points)?;
        let terrain = terrain()?;
        if args.heights {
            return points.answer_heights(&terrain);
        }
        return points.answer(&terrain, &Moment::new(&terrain, args.time));
    }
    let terrain = terrain()?;
    let dir = LatLon::from_degrees(args.lat.unwrap_or_default(), args.lon.unwrap_or_default()).direction();
    let (sample, layers_m) = (terrain.sample(dir), terrain.layers_m(dir));
    let moment = Moment::new(&terrain, args.time);
    let answer = if args.json {
        format!("{:#}", as_json(&terrain, dir, &sample, &layers_m, &moment))
    } else {
        as_text(&terrain, dir, &sample, &layers_m, &moment)
    };
    print(&answer)
}

/// What is over the ground: clouds and waves at a time, and objects.
pub(super) struct Moment {
    time_secs: f64,
    canopies: Canopies,
    materials: GroundMaterials,
    clouds: Option<CloudField>,
}

impl Moment {
    fn new(terrain: &Terrain, time_secs: f64) -> Self {
        let canopies = Canopies::new(terrain);
        let clouds = terrain.planet().clouds.as_ref().map(|_| CloudField::new(terrain));
        Self { time_secs, canopies, materials: GroundMaterials::new(terrain), clouds }
    }

    fn cover(&self, dir: DVec3) -> Option<CloudCover> {
        self.clouds.as_ref().map(|field| field.cover(dir, self.time_secs))
    }

    /// Objects on a hectare, for each population that stands there.
    fn populations<'a>(&self, terrain: &'a Terrain, dir: DVec3, sample: &Sample) -> Vec<(&'a str, f64)> {
        let densities = self.canopies.densities_per_hectare(dir, sample);
        let named = terrain.planet().life.iter().map(|population| population.name.as_str()).zip(densities);
        named.filter(|(_, per_hectare)| *per_hectare > 0.0).collect()
    }

    /// The surface of the sea, where the sample is of the sea, and the significant wave height.
    fn sea(&self, terrain: &Terrain, dir: DVec3, sample: &Sample) -> Option<(WaterSurface, f64)> {
        terrain.planet().sea_level_m().filter(|level_m| sample.water_level_m == Some(*level_m))?;
        let waves = Waves::near(terrain, dir);
        let surface = waves.surface(dir, self.time_secs, &Column::at(terrain, dir));
        Some((surface, waves.significant_height_m()))
    }
}

fn material_name(material: &GroundMaterial) -> String {
    let place = if material.is_rock {
        " (rock of steep ground)"
    } else if material.is_patch {
        " (patch)"
    } else {
        ""
    };
    format!("{}{place}", material.textures.unwrap_or(material.detail.name()))
}

fn biome_name<'a>(terrain: &'a Terrain, sample: &Sample) -> &'a str {
    terrain.planet().biomes.palette.get(sample.biome).map_or("", |biome| biome.name.as_str())
}

/// All that is known of a point at a time.
pub(super) fn everything(terrain: &Terrain, dir: DVec3, time_secs: f64) -> Value {
    as_json(terrain, dir, &terrain.sample(dir), &terrain.layers_m(dir), &Moment::new(terrain, time_secs))
}

/// All that is known of a point.
pub(super) fn as_json(terrain: &Terrain, dir: DVec3, sample: &Sample, layers_m: &[f64], moment: &Moment) -> Value {
    let clouds = moment.cover(dir);
    let canopy = moment.canopies.at(dir, sample);
    let material = moment.materials.at(dir, sample);
    let populations = moment.populations(terrain, dir, sample).into_iter();
    let sea = moment.sea(terrain, dir, sample);
    let river = sample.river.map(|river| {
        json!({
            "id": river.id,
            "distance_m": river.distance_m,
            "width_m": river.width_m,
            "depth_m": river.depth_m,
            "discharge_m3_s": river.discharge_m3_s,
            "flow": river.flow_planet.to_array(),
            "flow_heading_deg": heading_deg(dir, river.flow_planet),
        })
    });
    let layers = terrain.planet().layers.iter().zip(layers_m);
    json!({
        "has_ground": terrain.planet().giant.is_none(),
        "height_m": sample.height_m,
        "slope_deg": sample.slope_rad.to_degrees(),
        "curvature": sample.curvature,
        "normal": sample.normal_planet.to_array(),
        "temperature_c": sample.temperature_c,
        "temperature": sample.temperature,
        "precipitation_mm": sample.precipitation_mm,
        "moisture": sample.moisture,
        "biome": biome_name(terrain, sample),
        "material": {
            "detail": material.detail.name(),
            "textures": material.textures,
            "patch": material.is_patch,
            "rock": material.is_rock,
        },
        "canopy_cover": canopy.cover,
        "canopy_height_m": canopy.height_m,
        "populations": populations.map(|(name, n)| json!({ "name": name, "per_hectare": n })).collect::<Vec<_>>(),
        "layers": layers.map(|(layer, m)| json!({ "name": layer.name, "height_m": m })).collect::<Vec<_>>(),
        "water_level_m": sample.water_level_m,
        "water_surface_m": sea.map(|(surface, _)| surface.height_m),
        "wave_height_m": sea.map(|(_, height_m)| height_m),
        "river": river,
        "lake": sample.lake,
        "bank_m": sample.bank_m,
        "basin": sample.basin,
        "wind_m_s": to_east_and_north(dir, sample.wind_planet_m_s),
        "rain_mm": sample.rain_mm,
        "plate": sample.plate,
        "cloud_cover": clouds.map(|cover| cover.low),
        "middle_cover": clouds.map(|cover| cover.middle),
        "veil_cover": clouds.map(|cover| cover.veil),
        "fog_cover": clouds.map(|cover| cover.fog),
    })
}

/// A tangent at a direction, along east and north.
fn to_east_and_north(dir: DVec3, tangent: DVec3) -> [f64; 2] {
    let (east, north) = east_north(dir);
    [tangent.dot(east), tangent.dot(north)]
}

/// The heading of a tangent: 0 north, 90 east.
pub(super) fn heading_deg(dir: DVec3, tangent: DVec3) -> f64 {
    let [east, north] = to_east_and_north(dir, tangent);
    east.atan2(north).to_degrees().rem_euclid(360.0)
}

fn as_text(terrain: &Terrain, dir: DVec3, sample: &Sample, layers_m: &[f64], moment: &Moment) -> String {
    if terrain.planet().giant.is_some() {
        return "ground       none: a gas giant; its clouds end at the reference sphere".to_owned();
    }
    let [x, y, z] = sample.normal_planet.to_array();
    let mut lines = vec![
        format!("height       {:.3} m", sample.height_m),
        format!("slope        {:.2}°", sample.slope_rad.to_degrees()),
        format!("normal       {x:.6} {y:.6} {z:.6}"),
        format!("temperature  {:.1} °C ({:.3})", sample.temperature_c, sample.temperature),
        format!("moisture     {:.3} ({:.0} mm a year)", sample.moisture, sample.precipitation_mm),
        format!("biome        {}", biome_name(terrain, sample)),
        format!("material     {}", material_name(&moment.materials.at(dir, sample))),
    ];
    let populations = moment.populations(terrain, dir, sample);
    if !populations.is_empty() {
        let Canopy { cover, height_m, .. } = moment.canopies.at(dir, sample);
        let number = |n: f64| if n < 10.0 { format!("{n:.2}") } else { format!("{n:.0}") };
        let named = populations.iter().map(|(name, per_hectare)| format!("{name} {}", number(*per_hectare)));
        let named = named.collect::<Vec<_>>().join(", ");
        lines.push(format!("canopy       {:.0}% of the ground, {height_m:.1} m high", 100.0 * cover));
        lines.push(format!("per hectare  {named}"));
    }
    lines.extend(sample.water_level_m.map(|level_m| {
        let lake = sample.lake.map_or(String::new(), |lake| format!(", lake {lake}"));
        format!("water        {level_m:.3} m ({:.3} m deep{lake})", level_m - sample.height_m)
    }));
    lines.extend(moment.sea(terrain, dir, sample).map(|(surface, height_m)| {
        format!("waves        {height_m:.2} m high; the surface is at {:.3} m", surface.height_m)
    }));
    lines.extend(sample.river.map(|river| {
        let River { id, distance_m, width_m, depth_m, discharge_m3_s, flow_planet } = river;
        format!(
            "river        {id}: {distance_m:.1} m away, {width_m:.1} m wide, {depth_m:.2} m deep, \
             {discharge_m3_s:.1} m³/s, flows to {:.0}°",
            heading_deg(dir, flow_planet)
        )
    }));
    lines.extend(sample.basin.map(|basin| format!("basin        {basin}")));
    if terrain.planet().structure.is_some() {
        let wind_m_s = sample.wind_planet_m_s;
        lines.push(format!("wind         {:.1} m/s to {:.0}°", wind_m_s.length(), heading_deg(dir, wind_m_s)));
        lines.push(format!("rain         {:.0} mm a year", sample.rain_mm));
    }
    lines.extend(moment.cover(dir).map(|cover| {
        let [low, middle, veil, fog] = [cover.low, cover.middle, cover.veil, cover.fog].map(|cover| cover * 100.0);
        format!("clouds       {low:.0}%, middle {middle:.0}%, veil {veil:.0}%, fog {fog:.0}%")
    }));
    lines.extend(sample.plate.map(|plate| format!("plate        {plate}")));
    let layers = terrain.planet().layers.iter().zip(layers_m);
    lines.extend(layers.map(|(layer, m)| format!("layer        {:.3} m  {}", m, layer.name)));
    lines.join("\n")
}
