//! A draft of the structure: its maps on coarse grids, solved at once, so that a slider that is dragged shows what it
//! does. The maps proper follow, from the beginning; no map is refined from a draft.
//!
//! A draft has the plates of the final answer. Its winds blow over ground that no river has carved.

use super::World;
use super::carved::{Carved, drainage_of, weather_over};
use super::grid::children;
use super::map::{Ground, Inputs, Job};
use super::plates::Plates;
use super::sculpted::rock_of;
use super::slot::{MapWork, Slot};
use std::sync::Arc;
use std::time::Instant;

/// Cells along the side of a cube face of a draft. Rivers have as many as the plates, which may be final.
pub(super) const SIDE: usize = 32;

impl World {
    /// Whether the rivers that serve are those of another planet, and its own must be solved.
    pub(crate) fn wants_draft(&self, inputs: &Inputs) -> bool {
        inputs.structure.is_some()
            && !self.carved.is_of(inputs)
            && !self.carved.is_stored(self.store.as_deref(), inputs)
    }

    /// Drafts of the maps of the structure, and the other maps as they are. Plates that are final stay.
    pub(crate) fn draft(&self, ground: &dyn Ground, work: &mut MapWork) -> Option<Self> {
        profiling::scope!("draft of the structure");
        let begun = Instant::now();
        let inputs = ground.inputs();
        let structure = inputs.structure.as_ref()?;
        let mut world = self.clone();
        if !world.plates.is_of(inputs) {
            let plates = Plates::solve(&structure.plates, structure.seed, SIDE, &|| true)?;
            world.plates = Slot::draft(inputs, SIDE, plates)?;
        }
        let rock = world.plates.map()?.rock.clone();
        let job = Job { ground, world: &world, keep_going: &|| true };
        let mut risen_m = rock_of(&job, &rock).risen_m();
        let mut side = rock.side;
        while side > SIDE {
            side /= 2;
            risen_m = (0..6 * side * side)
                .map(|cell| children(side, cell).map(|i| risen_m[i]).iter().sum::<f64>() * 0.25)
                .collect();
        }
        let weather = weather_over(&job, side, &risen_m)?;
        let drainage = Arc::new(drainage_of(&job, &rock, &weather, None)?);
        let carved = Carved::new(drainage, inputs.sea_level_m, structure.radius_km, None);
        world.weather = Slot::draft(inputs, rock.side, weather)?;
        world.carved = Slot::draft(inputs, rock.side, carved)?;
        work.drafts += 1;
        work.busy_secs += begun.elapsed().as_secs_f64();
        Some(world)
    }
}
