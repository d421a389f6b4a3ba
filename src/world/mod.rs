//! World maps: values for the whole globe, each solved from the whole planet.
//!
//! A world map is a raster over the sphere. Its value at one point may depend on the planet everywhere, so no query can
//! evaluate it on the spot: it is solved once for each revision that changes what it reads, in the background, and then
//! sampled. Queries use the maps of the previous revision until the new ones are complete.
//!
//! - `map`: [`map::WorldMap`], inputs and solver of a map; [`Ground`], the heights and layers that solvers read,
//!   which the terrain implements
//! - [`World`]: the maps that serve. A new map is one file and one line of `world_maps!` below
//! - `cells`: the grid on which maps are solved; `slot`: one map, and its key
//! - `plates`, `weather`, `carved`: the structure of a planet: its crust, its winds and rain, and the ground that
//!   rivers carve (`drainage` solves rivers; `rivers` evaluates them at a point; `grid`, `noise` serve all)
//! - `sculpted`: what ground edits change of a structure
//! - `draft`: quick answers on coarse grids while a slider is dragged
//! - `floodplain`: land that rivers and lakes keep wet
//! - `coast`: signed distance to the coast; `picture`: maps as debug views show them
//! - `store`: map files; `bytes`: their binary encoding; `once`: values made when they are first asked for
//!
//! The module knows nothing of layers or noise: data goes from the terrain's heights into a map, and from the map into
//! the terrain's climate. The finest maps depend on the preset alone, never on drafts or earlier maps.

mod bytes;
pub(crate) mod carved;
pub(crate) mod cells;
pub(crate) mod coast;
mod draft;
pub(crate) mod drainage;
mod floodplain;
pub(crate) mod grid;
mod map;
pub(crate) mod noise;
mod once;
#[cfg(feature = "render")]
mod picture;
pub(crate) mod plates;
pub(crate) mod rivers;
mod sculpted;
mod slot;
mod store;
pub(crate) mod weather;

use carved::Carved;
use coast::Coast;
use map::Job;
pub(crate) use map::{Ground, Inputs, KeepGoing, StructureInputs};
#[cfg(feature = "render")]
pub(crate) use picture::{MapPicture, MapView, RAIN_COLORS};
use plates::Plates;
pub(crate) use sculpted::{DrawnCourse, Sculpted};
pub(crate) use slot::Slot;
pub use slot::{MapLevel, MapWork};
use std::fmt;
use std::sync::Arc;
pub use store::MapStore;
use weather::Weather;

/// The Earth's radius in km. Widths and speeds of the structure are those of a planet of this size.
pub(crate) const EARTH_KM: f64 = 6371.0;

/// Lists the maps, each after those that it reads.
macro_rules! world_maps {
    ($( $(#[doc = $doc:literal])+ $name:ident: $map:ty; )+) => {
        /// The world maps that serve a planet: those of its own, or of an earlier revision until its own are whole.
        #[derive(Clone, Default)]
        pub(crate) struct World {
            /// Where the finest maps are kept from one process to the next.
            pub(crate) store: Option<Arc<MapStore>>,
            $( $(#[doc = $doc])+ pub(crate) $name: Slot<$map>, )+
        }

        impl World {
            /// The maps that may serve a planet at once: all but those that nothing reads any more.
            pub(crate) fn serving(&self, inputs: &Inputs) -> Self {
                Self { store: self.store.clone(), $( $name: self.$name.serving(inputs), )+ }
            }

            /// Share of the cells of all levels of all maps that are solved, 0 to 1: about the share of the work.
            pub(crate) fn progress(&self, inputs: &Inputs) -> f64 {
                let [done, all] = [$( self.$name.cells(inputs) ),+]
                    .into_iter()
                    .fold([0, 0], |[done, all], [more, of]| [done + more, all + of]);
                if all == 0 { 1.0 } else { done as f64 / all as f64 }
            }

            /// Whether every map is the finest one of this planet.
            pub(crate) fn is_final(&self, inputs: &Inputs) -> bool {
                $( self.$name.is_final(inputs) )&&+
            }

            /// Solves the next level of the first map that is not final. None if `keep_going` said no.
            pub(crate) fn step(
                &self,
                ground: &dyn Ground,
                keep_going: &KeepGoing<'_>,
                work: &mut MapWork,
            ) -> Option<Self> {
                $( if !self.$name.is_final(ground.inputs()) {
                    let mut world = self.clone();
                    world.$name = self.$name.step(&Job { ground, world: self, keep_going }, work)?;
                    return Some(world);
                } )+
                Some(self.clone())
            }
        }
    };
}

world_maps! {
    /// Plates of the crust.
    plates: Plates;
    /// Weather of a mean year.
    weather: Weather;
    /// The ground that rivers carve.
    carved: Carved;
    /// Signed distance to the coast.
    coast: Coast;
}

/// The maps are rasters: only which ones serve is printed.
impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("carved", &self.carved.key())
            .field("coast", &self.coast.key())
            .finish_non_exhaustive()
    }
}
