//! `tellus bench`: the figures that the design sets a bar for, measured on this machine in one run.
//!
//! - [`noise`]: million points a second, against fastnoise-lite
//! - [`edits`]: time from an edit to the finished tiles
//! - [`queries`]: time of heights, samples, rays, contacts and sweeps
//! - [`collision`]: time of contacts, sweeps and walkers on a patch of ground
//! - [`bake`]: million pixels a second of a height map
//! - [`sculpt`]: time and memory of thousands of ground edits
//! - [`structure`]: time to solve plates, weather and rivers, and points a second with rivers
//! - [`clouds`]: time of cloud maps and queries
//! - [`frames`]: time of a frame and of its clouds, sea and air
//! - [`life`]: time of objects on the ground: their meshes, their places, frames with them
//! - [`thumbnails`]: time of nine small pictures
//! - [`air`]: time that new LUTs of the air take on the GPU

mod air;
mod bake;
mod clouds;
mod collision;
mod edits;
mod frames;
mod life;
mod noise;
mod queries;
mod sculpt;
mod structure;
mod thumbnails;

use super::{Failure, headless, print};
use crate::lod::{Quality, View, opening};
use crate::planet::{Planet, shipped};
use crate::simd::Simd;
use crate::tiles::build_now;
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Measure how fast this machine is
#[derive(clap::Args)]
pub(super) struct Args {
    /// Answer as a JSON object
    #[arg(long)]
    json: bool,
    /// Measure one part alone
    #[arg(long, value_name = "PART")]
    only: Option<Part>,
}

/// A part of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Part {
    /// Million points of noise a second
    Noise,
    /// The whole opening view of each shipped planet without a structure
    Rebuild,
    /// Heights, samples, rays, contacts and sweeps
    Queries,
    /// Contacts, sweeps and walkers on a patch of ground
    Collision,
    /// Height maps of the globe, in files
    Bake,
    /// A height map of 16k x 8k pixels, once: a minute or more, and 256 MB of disk. Not among all parts
    LargeBake,
    /// Edits of two planets without a structure: the first, and the one whose tiles take longest
    Edits,
    /// Ten thousand ground edits
    Sculpt,
    /// Plates, weather and rivers
    Structure,
    /// Cloud maps and queries of clouds
    Clouds,
    /// Frames on the GPU, and what their parts take
    Frames,
    /// Plants and stones: their meshes, their places, and frames with and without them
    Life,
    /// Objects that one core places in a second: of the part life, what needs no GPU. Not among all parts
    Placing,
    /// Nine variations as small pictures
    Thumbnails,
    /// LUTs of the air, on the GPU
    Air,
}

/// Size of the opening view that rebuilds are measured in.
const SIZE_PX: [u32; 2] = [1280, 720];
/// Runs of which the median is taken, unless they take too long.
const RUNS: usize = 15;
/// Least number of runs, however long they take.
const FEWEST_RUNS: usize = 3;
/// No further run begins after this time.
const LONG: Duration = Duration::from_secs(3);

/// The view that the design's bar is set for.
fn opening_view(planet: &Planet) -> View {
    opening::opening_view(planet, SIZE_PX, Quality::Medium)
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut planets: Vec<(&str, Arc<Planet>)> = Vec::new();
    for shipped in shipped::ALL {
        let planet = shipped.load().map_err(|error| Failure::Message(error.to_string()))?;
        // What a structure takes is measured apart.
        if planet.structure.is_none() {
            planets.push((shipped.file, Arc::new(planet)));
        }
    }
    let Some((first_file, first)) = planets.first() else {
        return Err("no preset without a structure is shipped".to_owned().into());
    };
    let wants = |part: Part| args.only.is_none_or(|only| only == part);
    let mut report = json!({ "simd": Simd::detect().name(), "threads": rayon::current_num_threads() });
    if wants(Part::Noise) {
        report["noise"] = noise::measure();
    }
    // Edits need them too: to find the planet whose tiles take longest.
    if wants(Part::Rebuild) || wants(Part::Edits) {
        let rebuilds: Result<Vec<Value>, _> = planets.iter().map(|(file, planet)| rebuild(file, planet)).collect();
        report["rebuild"] = json!(rebuilds?);
    }
    if wants(Part::Queries) {
        report["queries"] = json!([queries::measure(first)?, queries::measure(&Arc::new(shipped::default_planet()))?]);
    }
    if wants(Part::Collision) {
        let default = Arc::new(shipped::default_planet());
        report["collision"] = json!([collision::measure(first)?, collision::measure(&default)?]);
    }
    if wants(Part::Bake) {
        report["bake"] = bake::measure(first)?;
    }
    if args.only == Some(Part::LargeBake) {
        report["large_bake"] = bake::measure_large()?;
    }
    if wants(Part::Edits) {
        report["edits"] = json!(edits::measure(first, None));
        let full_ms = |i: &usize| report["rebuild"][*i]["full_ms"].as_f64().unwrap_or(0.0);
        let heaviest = (0..planets.len()).max_by(|a, b| full_ms(a).total_cmp(&full_ms(b))).unwrap_or(0);
        report["heaviest"] = json!(planets[heaviest].0);
        report["heaviest_edits"] = json!(edits::measure(&planets[heaviest].1, None));
    }
    if wants(Part::Sculpt) {
        report["sculpt"] = sculpt::measure((first_file, first))?;
    }
    if wants(Part::Structure) {
        report["structure"] = structure::measure(&shipped::default_planet())?;
    }
    if wants(Part::Clouds) {
        report["clouds"] = clouds::measure(first)?;
    }
    if wants(Part::Frames) {
        report["frames"] = json!(frames::measure(first));
    }
    if wants(Part::Life) {
        report["life"] = life::measure(&Arc::new(shipped::default_planet()))?;
    }
    if args.only == Some(Part::Placing) {
        report["placing"] = life::placing(&Arc::new(shipped::default_planet()))?;
    }
    if wants(Part::Thumbnails) {
        report["thumbnails"] = json!([thumbnails::measure(first), thumbnails::measure(&shipped::default_planet())]);
    }
    if wants(Part::Air) {
        report["adapter"] = json!(headless::Gpu::open(SIZE_PX).ok().map(|gpu| gpu.name));
        report["air"] = json!(air::measure(first));
    }
    report["memory_mb"] = json!(peak_memory_mb());
    print(&if args.json { format!("{report:#}") } else { as_text(&report) })
}

/// The whole surface of the opening view, from nothing.
fn rebuild(file: &str, planet: &Arc<Planet>) -> Result<Value, String> {
    let view = opening_view(planet);
    let build = || build_now(planet, &view).map(|surface| surface.stats).map_err(|error| error.to_string());
    let mut stats = build();
    let times = repeat(|| stats = build());
    let stats = stats?;
    Ok(json!({
        "preset": file,
        "nodes": stats.tiles,
        "vertices": stats.vertices,
        "octave_samples": stats.octave_samples,
        "full_ms": median(&times),
        "full_ms_p95": p95(&times),
    }))
}

/// Milliseconds of several runs, sorted.
fn repeat(mut run: impl FnMut()) -> Vec<f64> {
    let begun = Instant::now();
    let mut times = Vec::new();
    while times.len() < FEWEST_RUNS || (times.len() < RUNS && begun.elapsed() < LONG) {
        let start = Instant::now();
        run();
        times.push(start.elapsed().as_secs_f64() * 1000.0);
    }
    times.sort_by(f64::total_cmp);
    times
}

/// The middle of sorted times.
fn median(sorted: &[f64]) -> Option<f64> {
    sorted.get(sorted.len() / 2).copied()
}

/// The 95th percentile of sorted times.
fn p95(sorted: &[f64]) -> Option<f64> {
    let rank = (sorted.len() * 95).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied()
}

/// Peak resident size of this process, where the system tells.
fn peak_memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

fn as_text(report: &Value) -> String {
    let plain = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.as_f64().map_or(number.to_string(), |n| format!("{n:.2}")),
        Value::Null => "-".to_owned(),
        other => other.to_string(),
    };
    let row = |item: &Value| {
        let fields = item.as_object().into_iter().flatten().map(|(k, v)| format!("{k} {}", plain(v)));
        fields.collect::<Vec<_>>().join(", ")
    };
    let mut lines = Vec::new();
    for (key, value) in report.as_object().into_iter().flatten() {
        match value {
            Value::Object(fields) => {
                for (name, value) in fields {
                    match value {
                        Value::Array(items) => {
                            lines.extend(items.iter().map(|item| format!("{key}.{name}: {}", row(item))));
                        }
                        other => lines.push(format!("{key}.{name}: {}", plain(other))),
                    }
                }
            }
            Value::Array(items) => {
                lines.extend(items.iter().map(|item| format!("{key}: {}", row(item))));
            }
            other => lines.push(format!("{key}: {}", plain(other))),
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_percentiles() {
        let times: Vec<f64> = (1..=20).map(f64::from).collect();
        assert_eq!((median(&times), p95(&times)), (Some(11.0), Some(19.0)));
        assert_eq!((median(&[]), p95(&[])), (None, None));
        assert_eq!((median(&[3.0]), p95(&[3.0])), (Some(3.0), Some(3.0)));
    }
}
