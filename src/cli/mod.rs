//! The command line: one file for each subcommand.
//!
//! - `args`: parsers of sizes, angles and locations; `area`: arguments that bakes share
//! - `render`, `film`, `check`, `sample`, `nearest`, `bake`, `mesh`, `tiles`, `rivers`, `coasts`, `instances`, `maps`,
//!   `sky`, `system`, `new`, `bench`: the subcommands
//! - `geojson`: features and lines for `rivers`, `coasts` and `instances`; `polygons`: land and water from coasts
//! - `points`: many points for `sample`
//! - `work`: threads, and progress of long work
//! - `headless`: a GPU without a window
//! - `outputs`: what every command checks before it writes files
//! - `logging`: what is logged, and the log file of the editor
//! - `camera`: what a photographer sets, for `render` and `film`
//!
//! Exit status 0 = done, 1 = the input is wrong (said on standard error), 2 = usage.

mod area;
mod args;
mod bake;
mod bench;
mod camera;
mod check;
mod coasts;
mod film;
mod geojson;
mod headless;
mod instances;
mod logging;
mod maps;
mod mesh;
mod nearest;
mod new;
mod outputs;
mod points;
mod polygons;
mod render;
mod rivers;
mod sample;
mod sky;
mod system;
mod tiles;
mod work;

use crate::planet::picture::is_contained;
use crate::planet::printable::printable;
use crate::planet::sources::Sources;
use crate::planet::{LoadError, Planet, ground_note};
use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use logging::Logging;
use std::any::TypeId;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

/// Shape a whole planet with live sliders, save it as one RON preset, draw and query it from scripts.
#[derive(Parser)]
#[command(name = "tellus", version, args_conflicts_with_subcommands = true)]
#[command(after_help = "Without a subcommand the editor opens, with FILE if one is given.\n\n\
    World maps of structures are kept in the user's cache folder, at most 512 MiB of them. TELLUS_MAPS names another \
    folder; empty for none.")]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// The preset to open in the editor; if there is no such file, saving makes it
    #[arg(value_name = "FILE.ron")]
    file: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Command {
    Render(Box<render::Args>),
    Film(Box<film::Args>),
    Check(check::Args),
    Sample(sample::Args),
    Nearest(Box<nearest::Args>),
    Bake(Box<bake::Args>),
    Mesh(Box<mesh::Args>),
    Tiles(tiles::Args),
    Rivers(rivers::Args),
    Coasts(coasts::Args),
    Instances(instances::Args),
    Maps(maps::Args),
    Sky(sky::Args),
    System(system::Args),
    New(new::Args),
    Bench(bench::Args),
}

/// Why a subcommand failed.
enum Failure {
    /// Printed as `error: ...`.
    Message(String),
    /// Everything has been printed already.
    Told,
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Failure::Message(message)
    }
}

/// Runs the program with the arguments of this process.
pub fn run() -> ExitCode {
    ignore_limit_signal();
    let logging = Logging::start();
    // A panic of a picture decoder is reported as a problem of the preset, with its line: the panic is not printed.
    let print_panic = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !is_contained() {
            print_panic(panic);
        }
    }));
    let cli = match command().try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => {
            // Help goes to standard output. Errors repeat what was typed.
            if !error.use_stderr() {
                return ended(written(error.print().and_then(|()| io::stdout().flush())).map(drop));
            }
            let _ = write!(io::stderr(), "{}", printable(&error.render().to_string()));
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let result = match cli.command {
        None => edit(cli.file, &logging),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Film(args)) => film::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Sample(args)) => sample::run(&args),
        Some(Command::Nearest(args)) => nearest::run(&args),
        Some(Command::Bake(args)) => bake::run(&args),
        Some(Command::Mesh(args)) => mesh::run(&args),
        Some(Command::Tiles(args)) => tiles::run(&args),
        Some(Command::Rivers(args)) => rivers::run(&args),
        Some(Command::Coasts(args)) => coasts::run(&args),
        Some(Command::Instances(args)) => instances::run(&args),
        Some(Command::Maps(args)) => maps::run(&args),
        Some(Command::Sky(args)) => sky::run(&args),
        Some(Command::System(args)) => system::run(&args),
        Some(Command::New(args)) => new::run(&args),
        Some(Command::Bench(args)) => bench::run(&args),
    };
    ended(result)
}

/// The exit status of a result, after its message.
fn ended(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Failure::Message(message) = failure {
                tell(&format!("error: {message}"));
            }
            ExitCode::FAILURE
        }
    }
}

/// The command line with all subcommands. An option that takes a number also takes a negative one, and answers with
/// its range; without this, `-1` would be taken for an option.
fn command() -> clap::Command {
    let numbers = [
        TypeId::of::<f64>(),
        TypeId::of::<[f64; 2]>(),
        TypeId::of::<(f64, f64)>(),
        TypeId::of::<u8>(),
        TypeId::of::<u16>(),
        TypeId::of::<u32>(),
        TypeId::of::<u64>(),
        TypeId::of::<[u32; 2]>(),
        TypeId::of::<(u32, u32)>(),
    ];
    let of_number = |arg: clap::Arg| {
        let is_number = numbers.iter().any(|number| arg.get_value_parser().type_id() == *number);
        if is_number { arg.allow_hyphen_values(true) } else { arg }
    };
    Cli::command().mut_subcommands(|command| command.mut_args(of_number))
}

/// Makes a file that grows beyond the user's limit (`ulimit -f`) an error of the write, as a full disk is. Unless it is
/// ignored, a signal ends the program without a word.
fn ignore_limit_signal() {
    #[cfg(unix)]
    // SAFETY: no other thread runs yet, and nothing else handles this signal.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

#[cfg(feature = "editor")]
fn edit(file: Option<PathBuf>, logging: &Logging) -> Result<(), Failure> {
    if let Some(file) = &file {
        // Reported here rather than in a window: who typed a name on the command line reads the answer there. The
        // editor itself reports a missing picture. A name without a file is that of a new planet.
        crate::editor::check_first(file)?;
    }
    if let Some(folder) = crate::editor::folder() {
        logging.keep_in(&folder);
    }
    Ok(crate::editor::run(file, maps::kept())?)
}

#[cfg(not(feature = "editor"))]
fn edit(_: Option<PathBuf>, _: &Logging) -> Result<(), Failure> {
    Err("this program was built without the editor; build it with the feature `editor`".to_owned().into())
}

fn load(path: &Path) -> Result<Planet, Failure> {
    load_noted(path).map_err(|error| Failure::Message(error.to_string()))
}

/// Loads a preset. Notes say so if its ground is other here than where it was saved, and what is doubtful in it.
fn load_noted(path: &Path) -> Result<Planet, LoadError> {
    let (planet, text) = Planet::load_with_text(path)?;
    if let Some(note) = ground_note(&text) {
        tell(&format!("note: {}: {note}", path.display()));
    }
    for (at, doubt) in planet.life_doubts() {
        tell(&format!("note: {}: {at}: {doubt}", path.display()));
    }
    Ok(planet)
}

/// A planet, and the files that no output may replace.
fn load_as_source(path: &Path) -> Result<(Arc<Planet>, Sources), Failure> {
    let planet = load(path)?;
    let sources = Sources::of_preset(path, &planet);
    Ok((Arc::new(planet), sources))
}

/// Prints a line on standard error.
fn tell(line: &str) {
    let _ = writeln!(io::stderr(), "{}", printable(line));
}

/// Prints a line on standard output. It is no failure if the reader has stopped reading (`tellus ... | head -1`).
fn print(text: &str) -> Result<(), Failure> {
    print_on(text).map(|_| ())
}

/// As [`print`]. Whether the reader is still there.
fn print_on(text: &str) -> Result<bool, Failure> {
    let mut out = io::stdout().lock();
    written(writeln!(out, "{}", printable(text)).and_then(|()| out.flush()))
}

/// Whether the reader of standard output is still there, after something was written to it.
fn written(result: io::Result<()>) -> Result<bool, Failure> {
    match result {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {error}").into())
        }
        result => Ok(result.is_ok()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_declared_without_contradiction() {
        command().debug_assert();
    }
}
