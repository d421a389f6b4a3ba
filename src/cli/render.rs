//! `tellus render`: a picture of a planet, without a window.

use super::{Failure, args, headless, load, maps};
use crate::lod::{Camera, Quality, View, opening};
use crate::planet::file::write_atomically;
use crate::render::{DebugView, Metering, Renderer, Scene, Tone};
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use crate::tiles::{add_detail, build_over};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::path::PathBuf;
use std::sync::Arc;

/// Draw a planet into a PNG file
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The picture to write
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = args::size)]
    size: [u32; 2],
    #[arg(
        long,
        help = format!("Latitude of the camera in degrees, north positive [default: {}]", opening::OPENING_LAT_DEG),
        value_name = "DEG",
        allow_hyphen_values = true,
        value_parser = args::latitude
    )]
    lat: Option<f64>,
    #[arg(
        long,
        help = format!(
            "Longitude of the camera in degrees, east positive [default: {} east of the star]",
            opening::OPENING_LON_FROM_STAR_DEG
        ),
        value_name = "DEG",
        allow_hyphen_values = true,
        value_parser = args::longitude
    )]
    lon: Option<f64>,
    /// Altitude of the camera above the ground or the water on it, whichever is higher; negative: depth under water
    /// [default: far enough to see the whole planet]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = args::altitude)]
    altitude: Option<f64>,
    /// Heading of the camera in degrees: 0 north, 90 east
    #[arg(long, value_name = "DEG", default_value = "0", allow_hyphen_values = true, value_parser = args::heading)]
    heading: f64,
    #[arg(
        long,
        help = format!(
            "Pitch in degrees: 0 at the horizon, -90 straight down [default: {} from above {} planet radii, {} below]",
            opening::FAR_PITCH_DEG,
            opening::LOOK_DOWN_RADII,
            opening::NEAR_PITCH_DEG
        ),
        value_name = "DEG",
        allow_hyphen_values = true,
        value_parser = args::pitch
    )]
    pitch: Option<f64>,
    /// Vertical field of view in degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = Camera::DEFAULT_FOV_Y_RAD.to_degrees(),
        allow_hyphen_values = true,
        value_parser = args::field_of_view
    )]
    fov: f64,
    /// Location with the star overhead [default: from the preset, at --time]
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true, value_parser = args::location)]
    sun: Option<(f64, f64)>,
    /// Time in seconds; it moves the star, the clouds and the waves
    #[arg(long, value_name = "SECONDS", default_value = "0", allow_hyphen_values = true, value_parser = args::seconds)]
    time: f64,
    /// Exposure in stops, 0 for a sunlit planet [default: metered from the picture]
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = args::exposure)]
    exposure: Option<f64>,
    /// Tone curve from radiance to the picture
    #[arg(long, value_enum, default_value_t = Tone::default())]
    tone: Tone,
    /// Quality of the picture
    #[arg(long, value_enum, default_value_t = Quality::High)]
    quality: Quality,
    /// The shaded planet, or a debug view
    #[arg(long, value_enum, default_value_t = DebugView::default())]
    view: DebugView,
}

impl ValueEnum for Quality {
    fn value_variants<'a>() -> &'a [Self] {
        &Quality::ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Quality::Low => "low",
            Quality::Medium => "medium",
            Quality::High => "high",
        }))
    }
}

impl ValueEnum for Tone {
    fn value_variants<'a>() -> &'a [Self] {
        &Tone::ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Tone::AgX => "agx",
            Tone::Neutral => "neutral",
            Tone::Plain => "plain",
        }))
    }
}

impl ValueEnum for DebugView {
    fn value_variants<'a>() -> &'a [Self] {
        &DebugView::ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            DebugView::Shaded => "shaded",
            DebugView::Height => "height",
            DebugView::Normal => "normal",
            DebugView::Slope => "slope",
            DebugView::Biome => "biome",
            DebugView::Temperature => "temperature",
            DebugView::Moisture => "moisture",
            DebugView::Lod => "lod",
            DebugView::TileBorders => "tiles",
            DebugView::Error => "error",
            DebugView::Wireframe => "wireframe",
            DebugView::Coverage => "coverage",
            DebugView::Albedo => "albedo",
            DebugView::Plates => "plates",
            DebugView::Rain => "rain",
            DebugView::Rivers => "rivers",
        }))
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let planet = Arc::new(load(&args.file)?);
    if args.view.needs_structure() && planet.structure.is_none() {
        let (file, view) = (args.file.display(), args.view.label());
        return Err(format!("{file}: the planet has no structure, so that there is no map of {view} to show").into());
    }
    let gpu = headless::Gpu::open(args.size)?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).map_err(|error| format!("the renderer: {error}"))?;
    let terrain = Arc::new(maps::terrain(planet.clone())?);
    let view = view(args, &terrain)?;
    let mut surface = build_over(&terrain, &view);
    add_detail(&mut surface, &view);
    let sun = args.sun.map_or(planet.star.place(args.time), |(lat, lon)| LatLon::from_degrees(lat, lon));
    let mut scene = Scene::of_planet(&surface, view, sun.direction());
    scene.time_secs = args.time;
    scene.debug_view = args.view;
    scene.post.metering = if args.exposure.is_some() { Metering::Manual } else { Metering::Instant };
    scene.post.exposure_ev = args.exposure.unwrap_or(0.0);
    scene.post.tone = args.tone;
    let pixels =
        gpu.picture(args.size, |target| renderer.render(target, &scene).map(drop).map_err(|error| error.to_string()))?;
    let png = encode(&pixels, args.size).map_err(|error| format!("cannot encode the picture: {error}"))?;
    write_atomically(&args.output, &png).map_err(|error| format!("{}: {error}", args.output.display()))?;
    Ok(())
}

/// A PNG file from rows of RGBA pixels.
fn encode(rgba: &[u8], [width, height]: [u32; 2]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgba)?;
    writer.finish()?;
    Ok(bytes)
}

fn view(args: &Args, terrain: &Terrain) -> Result<View, Failure> {
    let planet = terrain.planet();
    let (opening_lat_deg, opening_lon_deg) = opening::opening_place(planet).to_degrees();
    let place = LatLon::from_degrees(args.lat.unwrap_or(opening_lat_deg), args.lon.unwrap_or(opening_lon_deg));
    let (radius_m, altitude_m) = match args.altitude {
        Some(altitude_m) => {
            let below = terrain.sample(place.direction());
            let ground_m = below.height_m;
            let floor_m = below.water_level_m.map_or(ground_m, |water_m| water_m.max(ground_m));
            let depth_m = floor_m - ground_m;
            // Lowest altitude: 0.1 m above the ground or the sea bed.
            let deepest_m = 0.1 - depth_m;
            if altitude_m < deepest_m {
                // Rounded up, so that the offered altitude is allowed.
                let least_m = (deepest_m * 10.0).ceil() / 10.0;
                let range = match depth_m > 0.2 {
                    true => format!("the water is {depth_m:.1} m deep there; use {least_m:.1} or more"),
                    false => "there is no water there; use 0.1 or more".to_owned(),
                };
                return Err(format!("--altitude: {altitude_m} m is under the ground: {range}").into());
            }
            (planet.radius_m() + floor_m + altitude_m, altitude_m)
        }
        None => {
            let altitude_m = opening::OPENING_ALTITUDE_RADII * planet.radius_m();
            (planet.radius_m() + altitude_m, altitude_m)
        }
    };
    let pitch_deg = args.pitch.unwrap_or_else(|| opening::default_pitch_deg(planet, altitude_m));
    let (heading, pitch) = (args.heading.to_radians(), pitch_deg.to_radians());
    let camera = Camera::over(place, radius_m, heading, pitch, args.fov.to_radians());
    Ok(View { camera, size_px: args.size, quality: args.quality })
}
