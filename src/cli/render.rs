//! `tellus render`: a picture of a planet, without a window.

use super::picture_file::Kind;
use super::{Failure, args, headless, load, maps};
use crate::lod::{Camera, Quality, View, opening};
use crate::planet::file::write_atomically;
use crate::render::{DebugView, Lens, Metering, Photo, Post, Renderer, Scene, Tone};
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use crate::tiles::{add_detail, build_over};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::io::IsTerminal as _;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Draw a planet into a PNG or OpenEXR file
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The picture to write: .png, or .exr for linear radiance without stars
    #[arg(short, long, value_name = "OUT.png|OUT.exr")]
    output: PathBuf,
    /// Width and height in pixels. Large pictures are drawn in tiles
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
    /// Focal length in mm in front of a sensor 24 mm high, in place of --fov
    #[arg(long, value_name = "MM", conflicts_with = "fov", value_parser = args::focal_length)]
    focal: Option<f64>,
    /// Diameter of the lens: what is not in focus is blurred. 0.01 is a camera's; 1000 makes a model of a continent.
    /// Needs --focus, and --samples of 4 or more
    #[arg(long, value_name = "METRES", requires = "focus", value_parser = args::length)]
    aperture: Option<f64>,
    /// Distance along the view axis that is in focus
    #[arg(long, value_name = "METRES", requires = "aperture", value_parser = args::length)]
    focus: Option<f64>,
    /// Samples along each side of a pixel, 1 to 16
    #[arg(long, value_name = "N", default_value = "1", value_parser = args::samples)]
    samples: u32,
    /// Bits of each colour of a .png: 8 or 16
    #[arg(long, value_name = "BITS", value_parser = ["8", "16"])]
    bits: Option<String>,
    /// Location with the star overhead [default: from the preset, at --time]
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true, value_parser = args::location)]
    sun: Option<(f64, f64)>,
    /// Time in seconds; it moves the star, the clouds and the waves
    #[arg(long, value_name = "SECONDS", default_value = "0", allow_hyphen_values = true, value_parser = args::seconds)]
    time: f64,
    /// Exposure in stops, 0 for a sunlit planet [default: metered from the picture]
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = args::exposure)]
    exposure: Option<f64>,
    /// Colour temperature in kelvins that is shown white: lower makes the picture bluer
    #[arg(long, value_name = "K", default_value_t = Post::DAYLIGHT_K, value_parser = args::white)]
    white: f64,
    /// How much darker the corners are, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = args::share)]
    vignette: f64,
    /// Share of the light that the lens scatters, 0 to 1: the glow of the sun and of highlights
    #[arg(long, value_name = "SHARE", default_value_t = Post::CLEAN_LENS, value_parser = args::share)]
    bloom: f64,
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
    let kind = Kind::of(&args.output, args.bits.as_deref().and_then(|bits| bits.parse().ok()))?;
    let gpu = headless::Gpu::open(args.size.map(|side| side.min(Photo::MOST_TILE_PX)))?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).map_err(|error| format!("the renderer: {error}"))?;
    let terrain = Arc::new(maps::terrain(planet.clone())?);
    let view = view(args, &terrain)?;
    // The ground of a large picture is as fine as that of a smaller one: its tiles fit into memory.
    let ground_view = View { size_px: fitted(view.size_px), ..view };
    let mut surface = build_over(&terrain, &ground_view);
    add_detail(&mut surface, &ground_view);
    let sun = args.sun.map_or(planet.star.place(args.time), |(lat, lon)| LatLon::from_degrees(lat, lon));
    let mut scene = Scene::of_planet(&surface, view, sun.direction());
    for body in &mut scene.bodies {
        body.frozen = (ground_view.size_px != view.size_px).then_some(ground_view);
    }
    scene.time_secs = args.time;
    scene.debug_view = args.view;
    scene.post.metering = if args.exposure.is_some() { Metering::Manual } else { Metering::Instant };
    scene.post.exposure_ev = args.exposure.unwrap_or(0.0);
    scene.post.tone = args.tone;
    (scene.post.white_k, scene.post.vignette, scene.post.bloom) = (args.white, args.vignette, args.bloom);
    let mut photo = Photo::default();
    (photo.samples, photo.develop) = (args.samples, kind.develop());
    photo.lens = args.aperture.zip(args.focus).map(|(diameter_m, focus_m)| Lens { diameter_m, focus_m });
    let pixels = gpu.checked(|| photo.take(&mut renderer, &scene, &mut told()).map_err(|error| error.to_string()))?;
    let bytes = kind.encode(&pixels.unwrap_or_default(), args.size)?;
    write_atomically(&args.output, &bytes).map_err(|error| format!("{}: {error}", args.output.display()))?;
    Ok(())
}

/// Longest side in pixels of the picture whose ground is drawn.
const GROUND_PX: u32 = 3840;

/// A size that is not larger than [`GROUND_PX`], of the same shape.
fn fitted(size_px: [u32; 2]) -> [u32; 2] {
    let longer = size_px[0].max(size_px[1]);
    if longer <= GROUND_PX {
        return size_px;
    }
    size_px.map(|side| (u64::from(side) * u64::from(GROUND_PX) / u64::from(longer)).max(1) as u32)
}

/// Tells a person at a terminal how much of a picture is drawn, if it takes long.
fn told() -> impl FnMut(f64) -> bool {
    let (start, mut last) = (Instant::now(), None);
    move |done| {
        let percent = (done * 100.0) as u32;
        if start.elapsed() > PATIENCE && last != Some(percent) && std::io::stderr().is_terminal() {
            eprint!("\rdrawn: {percent}%{}", if done < 1.0 { "" } else { "\n" });
            last = Some(percent);
        }
        true
    }
}

/// Time after which progress is told.
const PATIENCE: Duration = Duration::from_secs(2);

/// Height of the sensor that focal lengths refer to: that of 35 mm film.
const SENSOR_MM: f64 = 24.0;

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
    let fov_rad = args.focal.map_or(args.fov.to_radians(), |focal_mm| 2.0 * (0.5 * SENSOR_MM / focal_mm).atan());
    let camera = Camera::over(place, radius_m, heading, pitch, fov_rad);
    Ok(View { camera, size_px: args.size, quality: args.quality })
}
