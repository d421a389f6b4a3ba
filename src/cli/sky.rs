//! `tellus sky`: transmittance and radiance of the air, from the 64-bit reference or from the shaders.

use super::{Failure, args, headless, load, print};
use crate::atmosphere::{Air, SkyRay, reference};
use crate::lod::Quality;
use crate::planet::Planet;
use crate::render::{Renderer, SkyAnswer};
use serde_json::json;
use std::path::PathBuf;

/// Paths that `--reference` traces: they leave about one percent of noise.
const PATHS: u32 = 200_000;

/// Print how much light the air lets through and scatters
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// Angle from the zenith to the star, in degrees
    #[arg(long, value_name = "DEG", value_parser = args::zenith)]
    sun_zenith: f64,
    /// Angle from the zenith to the view ray, in degrees
    #[arg(long, value_name = "DEG", value_parser = args::zenith)]
    view_zenith: f64,
    /// Angle about the zenith from the star to the view ray, in degrees
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = args::heading)]
    azimuth: f64,
    /// Height of the eye above the reference sphere, which counts as the ground
    #[arg(long, value_name = "METRES", default_value = "2", value_parser = args::height)]
    altitude: f64,
    /// Ask the shaders instead of the 64-bit reference
    #[arg(long, conflicts_with = "reference")]
    gpu: bool,
    /// Trace paths through all orders of scattering; slow
    #[arg(long)]
    reference: bool,
    /// Print a JSON object: transmittance to the star, and radiance of the air under unit irradiance
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let planet = load(&args.file)?;
    let ray = SkyRay {
        altitude_m: args.altitude,
        view_zenith_rad: args.view_zenith.to_radians(),
        sun_zenith_rad: args.sun_zenith.to_radians(),
        azimuth_rad: args.azimuth.to_radians(),
    };
    let SkyAnswer { transmittance, radiance } =
        if args.gpu { shaders(&planet, ray)? } else { physics(&planet, ray, args.reference)? };
    let line = |rgb: [f64; 3]| rgb.map(|x| format!("{x:.6}")).join(" ");
    print(&if args.json {
        format!("{:#}", json!({ "transmittance": transmittance, "radiance": radiance }))
    } else {
        format!("transmittance  {}\nradiance       {}", line(transmittance), line(radiance))
    })
}

fn physics(planet: &Planet, ray: SkyRay, traced: bool) -> Result<SkyAnswer, Failure> {
    let air = Air::try_new(planet).map_err(|error| error.to_string())?;
    Ok(SkyAnswer {
        transmittance: air.sun_transmittance(ray.altitude_m, ray.sun_zenith_rad),
        radiance: if traced { reference::radiance(&air, &ray, PATHS) } else { air.radiance(&ray) },
    })
}

fn shaders(planet: &Planet, ray: SkyRay) -> Result<SkyAnswer, Failure> {
    let gpu = headless::Gpu::open([1, 1])?;
    let failed = |error: &dyn std::fmt::Display| format!("the GPU ({}): {error}", gpu.name);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).map_err(|error| format!("the renderer: {error}"))?;
    let answers = renderer.sky(planet, Quality::High, &[ray]).map_err(|error| failed(&error))?;
    Ok(answers.first().copied().ok_or_else(|| failed(&"no answer"))?)
}
