//! `tellus system`: where the bodies of a system are, and whether it lasts; and the camera of `render` in a system.

use super::{Failure, args, maps, print};
use crate::film::InSystem;
use crate::lod::Camera;
use crate::planet::Planet;
use crate::planet::file::read_text;
use crate::render::Worlds;
use crate::sphere::LatLon;
use crate::system::limits::{distance_text, hill_radii_m, warnings};
use crate::system::nbody::{Scheme, Trial, fitting_step_secs, try_out};
use crate::system::{Pose, System, YEAR_SECS};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// List the bodies of a system at a time, and say whether it lasts
#[derive(clap::Args)]
pub(super) struct Args {
    /// The system file
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// Time in seconds
    #[arg(long, value_name = "SECONDS", default_value = "0", allow_hyphen_values = true, value_parser = args::seconds)]
    time: f64,
    /// Run the system for this long under the attraction of all its bodies, and say what happens
    #[arg(long, value_name = "YEARS", value_parser = args::years)]
    trial: Option<f64>,
    /// Step of the trial [default: a two-hundredth of the shortest period]
    #[arg(long, value_name = "HOURS", requires = "trial", value_parser = args::length)]
    step: Option<f64>,
    /// Scheme of the trial
    #[arg(long, value_enum, requires = "trial", default_value_t = Scheme::default())]
    scheme: Scheme,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let worlds = load(&args.file)?;
    let (system, radii_m) = (worlds.system(), worlds.radii_m());
    print(&format!("{}: {} bodies at {} s", system.name, system.bodies.len(), args.time))?;
    let poses = worlds.ephemeris().at(args.time);
    let hill_m = hill_radii_m(system);
    for number in 0..system.bodies.len() {
        print(&line(&worlds, &poses, &hill_m, number))?;
    }
    for warning in warnings(system, &radii_m) {
        print(&format!("warning: {}", warning.message))?;
    }
    if let Some(years) = args.trial {
        let step_secs = args.step.map_or_else(|| fitting_step_secs(system), |hours| hours * 3600.0);
        let trial = try_out(system, &radii_m, args.scheme, (years * YEAR_SECS, step_secs), &mut |_, _| true);
        for text in told(system, &trial, step_secs) {
            print(&text)?;
        }
    }
    Ok(())
}

/// A body: its orbit, its Hill sphere, and where the star and the parent stand over it.
fn line(worlds: &Worlds, poses: &[Pose], hill_m: &[f64], number: usize) -> String {
    let system = worlds.system();
    let body = &system.bodies[number];
    let mut text = format!("  {}", body.name);
    let parent = system.parents()[number];
    let over = |other: usize| {
        let towards = poses[other].position_m - poses[number].position_m;
        let (lat, lon) = LatLon::from_direction(poses[number].system_from_body.inverse() * towards).to_degrees();
        let side =
            |degrees: f64, sides: [&str; 2]| format!("{:.1}° {}", degrees.abs(), sides[usize::from(degrees < 0.0)]);
        format!("{} {}", side(lat, ["N", "S"]), side(lon, ["E", "W"]))
    };
    if let (Some(parent), Some(orbit)) = (parent, worlds.ephemeris().orbit(number)) {
        let days = orbit.period_secs() / 86_400.0;
        let apart_m = (poses[number].position_m - poses[parent].position_m).length();
        text += &format!(": {} from {}, period {days:.3} days", distance_text(apart_m), system.bodies[parent].name);
        if hill_m[number].is_finite() {
            text += &format!(", Hill sphere {}", distance_text(hill_m[number]));
        }
    }
    if worlds.planet(number).is_some() {
        let star = system.bodies.iter().position(|body| body.light.is_some());
        if let Some(star) = star {
            text += &format!("; {} over {}", system.bodies[star].name, over(star));
        }
        if let Some(parent) = parent.filter(|parent| Some(*parent) != star && !system.bodies[*parent].is_point()) {
            text += &format!("; {} over {}", system.bodies[parent].name, over(parent));
        }
    }
    text
}

fn told(system: &System, trial: &Trial, step_secs: f64) -> Vec<String> {
    let years = trial.secs / YEAR_SECS;
    let mut lines = vec![format!(
        "trial of {years:.3} years, step {:.3} hours: energy error at most {:.1e}",
        step_secs / 3600.0,
        trial.energy_error
    )];
    lines.extend(trial.events.iter().map(|event| event.told(system)));
    if trial.events.is_empty() {
        lines.push("no encounter, no escape, no collision".to_owned());
    }
    lines
}

/// A system file and the presets that it names.
fn load(file: &Path) -> Result<Worlds, Failure> {
    let text = read_text(file).map_err(|error| error.to_string())?;
    if !System::is_system(&text) && Planet::from_text("", &text).is_ok() {
        return Err(format!("{}: this is a preset of one planet, not a system file", file.display()).into());
    }
    let system = System::from_text(&file.display().to_string(), &text).map_err(|error| error.to_string())?;
    let planets = system.load_planets(file).map_err(|error| error.to_string())?;
    Ok(Worlds::new(system, planets))
}

/// The body of a system by its name.
pub(super) fn place(file: &Path, body: &str) -> Result<InSystem, Failure> {
    let worlds = load(file)?;
    let number = find(&worlds, "--body", body)?;
    if worlds.planet(number).is_none() {
        return Err(format!("--body: {body} has no surface; name a planet or a moon").into());
    }
    Ok(InSystem::new(Arc::new(worlds), number, maps::kept()))
}

fn find(worlds: &Worlds, argument: &str, name: &str) -> Result<usize, Failure> {
    let names = || worlds.system().bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>().join(", ");
    let found = worlds.system().find(name);
    found.ok_or_else(|| format!("{argument}: there is no body {name:?}; there is: {}", names()).into())
}

/// The planet of a body in the light of its system.
pub(super) fn lit_planet(system: &InSystem, time_secs: f64) -> Result<Planet, Failure> {
    system.planet(time_secs).ok_or_else(|| "the system has no star to light the body".to_owned().into())
}

/// A camera turned towards another body, its top away from the ground.
pub(super) fn towards(system: &InSystem, camera: Camera, name: &str, time_secs: f64) -> Result<Camera, Failure> {
    let number = find(system.worlds(), "--towards", name)?;
    if number == system.body() {
        return Err(format!("--towards: the camera is near {name} itself; leave it out, or use --pitch").into());
    }
    let around = system.worlds().around(system.body(), camera.position_planet_m, time_secs);
    let ahead = around.place(number).0.normalize();
    Ok(Camera::looking(camera.position_planet_m, ahead, camera.position_planet_m.normalize(), camera.fov_y_rad))
}

impl ValueEnum for Scheme {
    fn value_variants<'a>() -> &'a [Self] {
        &[Scheme::Verlet, Scheme::Yoshida6]
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Scheme::Verlet => "verlet",
            Scheme::Yoshida6 => "yoshida6",
        }))
    }
}
