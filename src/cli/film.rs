//! `tellus film`: the frames of a flight over the bookmarks of a planet.

use super::camera::{CameraArgs, told};
use super::system::{self, Subject};
use super::work::WorkArgs;
use super::{Failure, args, headless, maps, outputs, tell};
use crate::film::{CameraPath, Film, Sequence};
use crate::planet::{Bookmark, Planet};
use crate::render::{Photo, Renderer};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Draw a flight over the bookmarks of a planet, or of a body of a system, as numbered frames
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset, or a system file with --body
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The body of a system over whose bookmarks the camera flies
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// The film: way.png gives way-0001.png, way-0002.png, ...; .exr for linear radiance
    #[arg(short, long, value_name = "OUT.png|OUT.exr")]
    output: PathBuf,
    /// Names of bookmarks to fly over, in this order [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    over: Vec<String>,
    /// Length of the film
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = args::length_secs)]
    seconds: f64,
    /// Frames of each second
    #[arg(long, value_name = "N", default_value = "30", value_parser = |text: &str| args::whole(text, 1_u32, 240))]
    fps: u32,
    /// Time in seconds at the first frame; it moves the star, the clouds and the waves
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = args::seconds)]
    time: f64,
    /// Seconds of the planet that pass in each second of the film
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = args::seconds)]
    speed: f64,
    /// Go on where a film was interrupted: keep frames that are whole and that the same film made, which way.frames
    /// lists, and draw all others
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    work: WorkArgs,
}

/// Pixels whose colours are packed into a byte of a file at most: those of a dark sky take little.
const PACKED: u64 = 16;

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    args.work.begin()?;
    let Subject { planet, system, sources } = system::subject(&args.file, args.body.as_deref(), args.time)?;
    let camera = &args.camera;
    camera.check_view(&planet, &args.file)?;
    let kind = camera.kind(&args.output)?;
    let film = Film { secs: args.seconds, fps: args.fps, speed: args.speed };
    outputs::check_files(&sources, &film.files(&args.output))?;
    let pixels = camera.size.map(u64::from).iter().product::<u64>();
    let least_bytes = film.frames() as u64 * (pixels / PACKED);
    outputs::check_disk(args.output.parent().unwrap_or(Path::new("")), least_bytes, args.resume.then_some("png"))?;
    let bookmarks = chosen(&planet, &args.over).map_err(|error| format!("{}: {error}", args.file.display()))?;
    let gpu = headless::Gpu::open(camera.size.map(|side| side.min(Photo::MOST_TILE_PX)))?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).map_err(|error| format!("the renderer: {error}"))?;
    let terrain = Arc::new(maps::terrain(planet.clone())?);
    let Some(path) = CameraPath::over(&terrain, &bookmarks, camera.fov_y_rad()) else {
        return Err(format!("{}: there is no bookmark to fly over", args.file.display()).into());
    };
    let mut first = camera.shot(&terrain, path.camera(&terrain, 0.0), args.time);
    first.system = system;
    let mut sequence = Sequence::film(first, path, film, &args.output, kind);
    sequence.resumes = args.resume;
    let taken = gpu.checked(|| sequence.take(&mut renderer, &mut told()))?;
    if taken.kept == sequence.count() {
        tell("all frames are there already, whole, and of this film: nothing was done");
    }
    Ok(())
}

/// The bookmarks of these names, or all.
fn chosen(planet: &Planet, names: &[String]) -> Result<Vec<Bookmark>, String> {
    let all = planet.editor.as_ref().map_or(&[][..], |notes| &notes.bookmarks);
    if all.is_empty() {
        return Err("the planet has no bookmarks to fly over; add some in the editor (Ctrl+B)".to_owned());
    }
    if names.is_empty() {
        return Ok(all.to_vec());
    }
    let known = || all.iter().map(|bookmark| bookmark.name.as_str()).collect::<Vec<_>>().join(", ");
    let found = |name: &String| {
        let found = all.iter().find(|bookmark| bookmark.name == name.trim());
        found.cloned().ok_or_else(|| format!("--over: there is no bookmark {name:?}; there is: {}", known()))
    };
    names.iter().map(found).collect()
}
