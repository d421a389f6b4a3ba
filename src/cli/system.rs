//! `tellus system`: where the bodies of a system are, and whether it lasts; and the camera of `render` in a system.

use super::work::told as told_of;
use super::{Failure, args, load_as_source, maps, print, tell};
use crate::film::InSystem;
use crate::lod::Camera;
use crate::planet::Planet;
use crate::planet::sources::Sources;
use crate::render::Worlds;
use crate::sphere::LatLon;
use crate::system::limits::{distance_text, hill_radii_m, warnings};
use crate::system::nbody::Scheme;
use crate::system::trial::{Ending, EventKind, Plan, Trial};
use crate::system::{Pose, System, YEAR_SECS};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use glam::DVec3;
use serde_json::{Value, json};
use signal_hook::consts::SIGINT;
use signal_hook::flag;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// List the bodies of a system at a time, and say whether it lasts
#[derive(clap::Args)]
pub(super) struct Args {
    /// The system file
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// Time in seconds
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = args::seconds)]
    time: f64,
    /// Run the system for this long under the attraction of all its bodies, and say what happens. Ctrl+C ends the run
    /// and shows what it came to. Exit status 1 if the result is not to be trusted
    #[arg(long, value_name = "YEARS", value_parser = args::years)]
    trial: Option<f64>,
    /// Step of the trial, or the longest step of radau15 [default: one that suits the shortest orbit]. One that is too
    /// long for an orbit is refused
    #[arg(long, value_name = "HOURS", requires = "trial", value_parser = args::length)]
    step: Option<f64>,
    /// Scheme of the trial. radau15 has steps that follow the motion, the others have even steps
    #[arg(long, value_enum, requires = "trial", default_value_t = Scheme::default())]
    scheme: Scheme,
    /// Print a JSON object: bodies, each with name, parent (null at the root), position_m and velocity_m_s, about the
    /// body at the root; with --trial also trial: years, steps, energy_error, trusted, doubts, ending, events, and
    /// bodies at its end, about the common centre of mass. Warnings go to standard error
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (worlds, _) = load(&args.file)?;
    let (system, radii_m) = (worlds.system(), worlds.radii_m());
    // A trial that is refused prints nothing else.
    let plan = args.trial.map(|years| {
        let step_secs = args.step.map(|hours| hours * 3600.0);
        let plan = Plan::new(system, &radii_m, args.scheme, years * YEAR_SECS, step_secs);
        plan.map_err(|error| format!("{}: --trial: {error}", args.file.display()))
    });
    let plan = plan.transpose()?;
    let poses = worlds.ephemeris().at(args.time);
    let warnings = warnings(system, &radii_m);
    if args.json {
        warnings.iter().for_each(|warning| tell(&format!("warning: {}", warning.message)));
    } else {
        print(&format!("{}: {} bodies at {} s", system.name, system.bodies.len(), args.time))?;
        let hill_m = hill_radii_m(system);
        for number in 0..system.bodies.len() {
            print(&line(&worlds, &poses, &hill_m, number))?;
        }
        for warning in warnings {
            print(&format!("warning: {}", warning.message))?;
        }
    }
    let trial = plan.map(|plan| tried(&plan)).transpose()?;
    if args.json {
        let mut answer = json!({ "bodies": bodies(system, poses.iter().map(|pose| (pose.position_m, pose.velocity))) });
        if let Some(trial) = &trial {
            answer["trial"] = as_json(system, trial);
        }
        print(&format!("{answer:#}"))?;
    } else if let Some(trial) = &trial {
        for text in told(system, trial) {
            print(&text)?;
        }
    }
    let doubts = trial.map_or_else(Vec::new, |trial| trial.doubts(system));
    for doubt in &doubts {
        tell(&format!("error: the trial is not to be trusted: {doubt}"));
    }
    if doubts.is_empty() { Ok(()) } else { Err(Failure::Told) }
}

/// Runs a trial, tells how far it is, and ends it when the user asks for it (Ctrl+C); a second time ends the program.
fn tried(plan: &Plan<'_>) -> Result<Trial, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let hooked = flag::register_conditional_shutdown(SIGINT, 130, stop.clone())
        .and_then(|_| flag::register(SIGINT, stop.clone()))
        .map_err(|error| format!("Ctrl+C cannot be watched: {error}"))?;
    let told = told_of("trial");
    let trial = plan.run(&mut |done, _| told(done) && !stop.load(Ordering::Relaxed));
    told(1.0);
    signal_hook::low_level::unregister(hooked);
    Ok(trial)
}

fn bodies(system: &System, states: impl Iterator<Item = (DVec3, DVec3)>) -> Value {
    let body = |(member, (position_m, velocity)): (&crate::system::Member, (DVec3, DVec3))| {
        json!({
            "name": member.name,
            "parent": (!member.parent.is_empty()).then_some(&member.parent),
            "position_m": position_m.to_array(),
            "velocity_m_s": velocity.to_array(),
        })
    };
    system.bodies.iter().zip(states).map(body).collect()
}

fn as_json(system: &System, trial: &Trial) -> Value {
    let doubts = trial.doubts(system);
    let event = |event: &crate::system::trial::Event| {
        json!({
            "kind": match event.kind {
                EventKind::Encounter => "encounter",
                EventKind::Escape => "escape",
                EventKind::Collision => "collision",
            },
            "years": event.time_secs / YEAR_SECS,
            "bodies": event.bodies.map(|body| &system.bodies[body].name),
        })
    };
    json!({
        "years": trial.secs / YEAR_SECS,
        "steps": trial.steps,
        "energy_error": trial.energy_error,
        "trusted": doubts.is_empty(),
        "doubts": doubts,
        "ending": match trial.ending {
            Ending::Whole => "whole",
            Ending::Stopped => "stopped",
            Ending::Collision => "collision",
            Ending::Lost => "lost",
            Ending::TooManySteps(_) => "too many steps",
        },
        "events": trial.events.iter().map(event).collect::<Vec<_>>(),
        "bodies": bodies(system, trial.masses.iter().map(|mass| (mass.position_m, mass.velocity))),
    })
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

fn told(system: &System, trial: &Trial) -> Vec<String> {
    let years = trial.secs / YEAR_SECS;
    let mut lines = vec![format!(
        "trial of {years:.3} years{}, {} steps: energy error at most {:.1e}",
        if trial.ending == Ending::Stopped { ", which was stopped" } else { "" },
        trial.steps,
        trial.energy_error
    )];
    lines.extend(trial.events.iter().map(|event| event.told(system)));
    if trial.events.is_empty() && trial.doubts(system).is_empty() {
        lines.push("no encounter, no escape, no collision".to_owned());
    }
    lines
}

/// A system file and the presets that it names; and these files.
fn load(file: &Path) -> Result<(Worlds, Sources), Failure> {
    let system = System::load(file).map_err(|error| error.to_string())?;
    let planets = system.load_planets(file).map_err(|error| error.to_string())?;
    let sources = system.sources(file, &planets);
    Ok((Worlds::new(system, planets), sources))
}

/// What a picture shows.
pub(super) struct Subject {
    /// The planet under the camera.
    pub(super) planet: Arc<Planet>,
    /// The system that it is a body of.
    pub(super) system: Option<InSystem>,
    /// The files that no picture may replace.
    pub(super) sources: Sources,
}

/// The planet of a preset, or a body of a system at a time.
pub(super) fn subject(file: &Path, body: Option<&str>, time_secs: f64) -> Result<Subject, Failure> {
    let Some(body) = body else {
        let (planet, sources) = load_as_source(file)?;
        return Ok(Subject { planet, system: None, sources });
    };
    let (worlds, sources) = load(file)?;
    let number = find(&worlds, "--body", body)?;
    if worlds.planet(number).is_none() {
        return Err(format!("--body: {body} has no surface; name a planet or a moon").into());
    }
    let system = InSystem::new(Arc::new(worlds), number, maps::kept());
    let planet = system.planet(time_secs).ok_or_else(|| "the system has no star to light the body".to_owned())?;
    Ok(Subject { planet: Arc::new(planet), system: Some(system), sources })
}

fn find(worlds: &Worlds, argument: &str, name: &str) -> Result<usize, Failure> {
    let names = || worlds.system().bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>().join(", ");
    let found = worlds.system().find(name);
    found.ok_or_else(|| format!("{argument}: there is no body {name:?}; there is: {}", names()).into())
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
        &[Scheme::Radau15, Scheme::Verlet, Scheme::Yoshida6]
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Scheme::Radau15 => "radau15",
            Scheme::Verlet => "verlet",
            Scheme::Yoshida6 => "yoshida6",
        }))
    }
}
