//! `tellus new`: a random valid planet, or a variation of one.

use super::{Failure, args, load_as_source, outputs, print};
use crate::lod::scout;
use crate::planet::random;
use crate::planet::sources::Sources;
use std::path::PathBuf;

/// Change of the numbers by `--from`, as a share of their size.
const VARIATION: f64 = 0.25;

/// Write a random valid planet
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset to write
    #[arg(short, long, value_name = "FILE.ron")]
    output: PathBuf,
    /// Seed: equal seeds give equal planets [default: from the clock]
    #[arg(long, value_name = "N", value_parser = |text: &str| args::whole(text, 0, u64::MAX))]
    seed: Option<u64>,
    /// Vary this planet instead of making a new one
    #[arg(long, value_name = "FILE.ron")]
    from: Option<PathBuf>,
    /// Replace the preset that is there already
    #[arg(long)]
    force: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let seed = args.seed.unwrap_or_else(seed_from_clock);
    outputs::check_ending(&args.output, &["ron"])?;
    let from = args.from.as_deref().map(load_as_source).transpose()?;
    let sources = from.as_ref().map_or_else(Sources::default, |(_, sources)| sources.clone());
    outputs::check_files(&sources, &[&args.output])?;
    // Also a link that leads nowhere.
    if args.output.symlink_metadata().is_ok() && !args.force {
        let why = "there is such a file already; name another one, or replace it with --force";
        return Err(format!("{}: {why}", args.output.display()).into());
    }
    let planet = match &from {
        Some((from, _)) => random::vary(from, seed, VARIATION),
        None => scout::random_planet(None, seed),
    };
    planet.save(&args.output).map_err(|error| error.to_string())?;
    print(&format!("{}: {}, seed {seed}", args.output.display(), planet.name))
}

fn seed_from_clock() -> u64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    // At most six digits: short enough to type again.
    (now.as_nanos() / 1000 % 1_000_000) as u64
}
