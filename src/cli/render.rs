//! `tellus render`: a picture of a planet, without a window.

use super::camera::{CameraArgs, told};
use super::system::{self, Subject};
use super::{Failure, args, headless, maps, outputs};
use crate::film::Sequence;
use crate::lod::{Camera, opening};
use crate::render::{Photo, Renderer};
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use std::path::PathBuf;
use std::sync::Arc;

/// Draw a planet into a PNG or OpenEXR file
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset, or a system file with --body
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The body of a system near which the camera is
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// The body of the system at which the camera looks, in place of --heading and --pitch
    #[arg(long, value_name = "NAME", requires = "body", conflicts_with_all = ["heading", "pitch"])]
    towards: Option<String>,
    /// The picture to write: .png, or .exr for linear radiance without stars
    #[arg(short, long, value_name = "OUT.png|OUT.exr")]
    output: PathBuf,
    #[arg(
        long,
        help = format!("Latitude of the camera in degrees, north positive [default: {}]", opening::OPENING_LAT_DEG),
        value_name = "DEG",
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
        value_parser = args::longitude
    )]
    lon: Option<f64>,
    /// Altitude of the camera above the ground or the water on it, whichever is higher; negative: depth under water,
    /// or below the tops of a giant's clouds
    /// [default: far enough to see the whole planet]
    #[arg(long, value_name = "METRES", value_parser = args::altitude)]
    altitude: Option<f64>,
    /// Heading of the camera in degrees: 0 north, 90 east
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = args::heading)]
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
        value_parser = args::pitch
    )]
    pitch: Option<f64>,
    /// Location with the star overhead [default: from the preset, at --time]
    #[arg(long, value_name = "LAT,LON", conflicts_with = "body", value_parser = args::location)]
    sun: Option<(f64, f64)>,
    /// Time in seconds; it moves the star, the clouds and the waves
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = args::seconds)]
    time: f64,
    #[command(flatten)]
    camera: CameraArgs,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let Subject { planet, system, sources } = system::subject(&args.file, args.body.as_deref(), args.time)?;
    let camera = &args.camera;
    camera.check_view(&planet, &args.file)?;
    let kind = camera.kind(&args.output)?;
    outputs::check_files(&sources, &[&args.output])?;
    let gpu = headless::Gpu::open(camera.size.map(|side| side.min(Photo::MOST_TILE_PX)))?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).map_err(|error| format!("the renderer: {error}"))?;
    let terrain = Arc::new(maps::terrain(planet.clone())?);
    let mut looking = camera_of(args, &terrain)?;
    if let (Some(system), Some(towards)) = (&system, &args.towards) {
        looking = system::towards(system, looking, towards, args.time)?;
    }
    let mut shot = camera.shot(&terrain, looking, args.time);
    shot.system = system;
    shot.sun = args.sun.map(|(lat, lon)| LatLon::from_degrees(lat, lon));
    let sequence = Sequence::picture(shot, args.output.clone(), kind);
    gpu.checked(|| sequence.take(&mut renderer, &mut told()))?;
    Ok(())
}

fn camera_of(args: &Args, terrain: &Terrain) -> Result<Camera, Failure> {
    let planet = terrain.planet();
    let (opening_lat_deg, opening_lon_deg) = opening::opening_place(planet).to_degrees();
    let place = LatLon::from_degrees(args.lat.unwrap_or(opening_lat_deg), args.lon.unwrap_or(opening_lon_deg));
    let (radius_m, altitude_m) = match args.altitude {
        Some(altitude_m) => {
            let below = terrain.sample(place.direction());
            let ground_m = below.height_m;
            let floor_m = below.water_level_m.map_or(ground_m, |water_m| water_m.max(ground_m));
            let depth_m = floor_m - ground_m;
            // Lowest altitude: 0.1 m above the ground or the sea bed. A giant has neither.
            let deepest_m = 0.1 - depth_m;
            if altitude_m < deepest_m && planet.giant.is_none() {
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
            let radius_m = opening::opening_radius_m(planet, terrain.height_bounds_m().1);
            (radius_m, radius_m - planet.radius_m())
        }
    };
    let pitch_deg = args.pitch.unwrap_or_else(|| opening::default_pitch_deg(planet, altitude_m));
    let (heading, pitch) = (args.heading.to_radians(), pitch_deg.to_radians());
    Ok(Camera::over(place, radius_m, heading, pitch, args.camera.fov_y_rad()))
}
