//! `tellus maps`: the world maps of presets, solved ahead; and the folder in which this program keeps its own.

use super::work::told as told_of;
use super::{Failure, load, outputs, tell};
use crate::planet::sources::Sources;
use crate::terrain::{MapStore, Terrain};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Names the folder of world maps instead of the user's cache folder; empty for none.
const VARIABLE: &str = "TELLUS_MAPS";

/// World maps that the program keeps: about fifty planets.
const LIMIT_BYTES: u64 = 1 << 29;

/// Solve the world maps of presets and write them to a folder, for a game to ship
#[derive(clap::Args)]
pub(super) struct Args {
    /// The presets. One without a structure has no maps that are worth keeping
    #[arg(value_name = "FILE.ron", required = true)]
    files: Vec<PathBuf>,
    /// The folder; it is made if there is none. Maps that are in it already stay
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    // The names of maps are the store's own.
    outputs::check_files_in(&args.output, &Sources::default(), &[] as &[&Path])?;
    let store = Arc::new(MapStore::new(&args.output, u64::MAX));
    for file in &args.files {
        let planet = load(file)?;
        let has_maps = planet.structure.is_some();
        let told = told_of("world maps solved");
        Terrain::load(Arc::new(planet), Some(store.clone()), &told).map_err(|error| error.to_string())?;
        told(1.0);
        if let Some(problem) = store.take_problem() {
            return Err(problem.into());
        }
        if !has_maps {
            tell(&format!("{}: has no structure, so nothing was written for it", file.display()));
        }
    }
    Ok(())
}

/// The world maps that the program keeps for itself. None if nobody knows where.
pub(super) fn kept() -> Option<Arc<MapStore>> {
    let folder = match std::env::var_os(VARIABLE) {
        Some(folder) if folder.is_empty() => None,
        Some(folder) => Some(PathBuf::from(folder)),
        None => dirs::cache_dir().map(|folder| folder.join("tellus").join("maps")),
    };
    folder.map(|folder| Arc::new(MapStore::new(folder, LIMIT_BYTES)))
}

/// The evaluator of a planet, with the world maps that the program keeps.
pub(super) fn terrain(planet: Arc<crate::planet::Planet>) -> Result<Terrain, Failure> {
    let store = kept();
    let told = told_of("world maps solved");
    let terrain = Terrain::load(planet, store.clone(), &told).map_err(|error| error.to_string())?;
    told(1.0);
    if let Some(problem) = store.and_then(|store| store.take_problem()) {
        tell(&format!("warning: {problem}"));
    }
    // Nobody gives up.
    terrain.ok_or_else(|| "the world maps were not solved".to_owned().into())
}
