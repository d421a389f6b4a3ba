//! What a world map declares, and the planet as it reads it.

use super::bytes::{Reader, Writer};
use super::cells::Cells;
use super::{DrawnCourse, Sculpted, World};
use crate::planet::{Key, Plates, Rivers, Weather};
use std::sync::Arc;

/// Asked again and again while a map is solved; no means that nobody wants the answer any more.
pub(crate) type KeepGoing<'a> = dyn Fn() -> bool + Sync + 'a;

/// What of a planet the world maps depend on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Inputs {
    /// Key of the heights that [`Ground::heights_m`] gives, the structure apart.
    pub(crate) heights: Key,
    /// Key of the heights that [`Ground::under_m`] gives, if there is a layer under the structure.
    pub(crate) under: Option<Key>,
    /// Height of the sea's surface in metres, if there is a sea.
    pub(crate) sea_level_m: Option<f64>,
    /// Whether something reads the distance to the coast.
    pub(crate) reads_coast: bool,
    /// The structure, if the planet has one.
    pub(crate) structure: Option<Arc<StructureInputs>>,
    /// Key of what ground edits change of the structure: [`Ground::sculpted`] and [`Ground::courses`].
    pub(crate) sculpted: Option<Key>,
    /// Number of grids of its rivers.
    pub(crate) grids: usize,
}

/// What of a planet its structure depends on, layers and sea apart.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StructureInputs {
    pub(crate) plates: Plates,
    pub(crate) weather: Weather,
    pub(crate) rivers: Rivers,
    /// Seed of the planet.
    pub(crate) seed: u32,
    pub(crate) radius_km: f64,
    /// Temperatures at sea level, and how much colder it gets with height.
    pub(crate) equator_c: f64,
    pub(crate) pole_c: f64,
    pub(crate) lapse_c_per_km: f64,
}

/// The planet as world maps read it.
pub(crate) trait Ground: Sync {
    /// What the maps depend on.
    fn inputs(&self) -> &Inputs;

    /// Heights of the ground at the centres of cells, in metres, without detail that is finer than the cells and
    /// without biome relief. None if `keep_going` said no.
    fn heights_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>>;

    /// The same of the layers that lie under the structure; zeros if there are none.
    fn under_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>>;

    /// Paint of the structure at the centres of cells, if there is some.
    fn sculpted(&self, _cells: &Cells) -> Option<Sculpted> {
        None
    }

    /// Rivers whose courses are drawn by hand.
    fn courses(&self) -> &[DrawnCourse] {
        &[]
    }
}

/// What a map is solved from.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) ground: &'a dyn Ground,
    /// The maps before this one in the list are final.
    pub(crate) world: &'a World,
    pub(crate) keep_going: &'a KeepGoing<'a>,
}

impl Job<'_> {
    pub(crate) fn inputs(&self) -> &Inputs {
        self.ground.inputs()
    }
}

/// A world map.
pub(crate) trait WorldMap: Sized + Send + Sync {
    /// For reports.
    const NAME: &'static str;

    /// Cells along the side of a cube face, coarse to fine. The last level that [`WorldMap::levels`] counts is the
    /// answer.
    const SIDES: &'static [usize];

    /// Whether the coarse levels of a map serve even while a map of an earlier revision could: when a coarse answer at
    /// once is worth more than an old one.
    const COARSE_FIRST: bool = false;

    /// How many of the levels are solved.
    fn levels(_inputs: &Inputs) -> usize {
        Self::SIDES.len()
    }

    /// Key of everything that the map reads; None if nothing reads the map. This is the only place where the
    /// dependencies of a map are declared.
    fn key(inputs: &Inputs) -> Option<Key>;

    /// Solves the map with cubes of `side` cells. `coarser`: the level before, if it was solved. None if nobody wants
    /// the answer any more.
    fn solve(job: &Job<'_>, side: usize, coarser: Option<&Self>) -> Option<Self>;

    /// Whether the next level can be solved from this one. A map that was read from disk may lack what that needs.
    fn can_be_refined(&self) -> bool {
        true
    }

    /// Whether the finest level is kept on disk: worth it where reading takes less time than solving.
    const STORED: bool = false;

    /// Writes what [`WorldMap::read`] needs.
    fn write(&self, _to: &mut Writer) {}

    /// A map that was written. None if the bytes are not those of a map of this side: they are checked, not trusted.
    fn read(_inputs: &Inputs, _side: usize, _from: &mut Reader<'_>) -> Option<Self> {
        None
    }
}
