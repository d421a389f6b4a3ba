//! `tellus new`: a random valid planet, or a variation of one.

use super::{Failure, load, print};
use crate::lod::scout;
use crate::planet::random;
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
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Vary this planet instead of making a new one
    #[arg(long, value_name = "FILE.ron")]
    from: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let seed = args.seed.unwrap_or_else(seed_from_clock);
    let planet = match &args.from {
        Some(from) => random::vary(&load(from)?, seed, VARIATION),
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
