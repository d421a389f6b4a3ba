//! What a world map declares, and the planet as it reads it.

use super::cells::Cells;
use crate::planet::Key;

/// Asked again and again while a map is solved; no means that nobody wants the answer any more.
pub(crate) type KeepGoing<'a> = dyn Fn() -> bool + Sync + 'a;

/// What of a planet the world maps depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inputs {
    /// Key of the heights that [`Ground::heights_m`] gives.
    pub(crate) heights: Key,
    /// Height of the sea's surface in metres, if there is a sea.
    pub(crate) sea_level_m: Option<f64>,
    /// Whether something reads the distance to the coast.
    pub(crate) reads_coast: bool,
}

/// The planet as world maps read it.
pub(crate) trait Ground: Sync {
    /// What the maps depend on.
    fn inputs(&self) -> &Inputs;

    /// Heights of the layers at the centres of cells, in metres, without detail that is finer than the cells. None if
    /// `keep_going` said no.
    fn heights_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>>;
}

/// A world map.
pub(crate) trait WorldMap: Sized + Send + Sync {
    /// Cells along the side of a cube face, coarse to fine. The last level is the answer; those before it serve only
    /// while no map of an earlier revision does.
    const SIDES: &'static [usize];

    /// Key of everything that the map reads; None if nothing reads the map. This is the only place where the
    /// dependencies of a map are declared.
    fn key(inputs: &Inputs) -> Option<Key>;

    /// Solves the map with cubes of `side` cells. None if `keep_going` said no.
    fn solve(ground: &dyn Ground, side: usize, keep_going: &KeepGoing<'_>) -> Option<Self>;
}
