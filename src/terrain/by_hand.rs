//! Plates under directions, as the editor changes them by hand.

use super::Terrain;
use super::points::unit;
use crate::planet::PlateByHand;
use glam::DVec3;

impl Terrain {
    /// The plate at a direction, as an entry that leaves it as it was laid out. None without a structure.
    pub fn plate_entry(&self, dir_planet: DVec3) -> Option<PlateByHand> {
        let layout = &self.world().plates.map()?.layout;
        layout.entry(layout.plate_under(unit(dir_planet)))
    }

    /// The entry of a plate after it was dragged: the ground at `from_planet` goes to `to_planet`.
    pub fn dragged_plate(&self, entry: &PlateByHand, from_planet: DVec3, to_planet: DVec3) -> Option<PlateByHand> {
        self.world().plates.map()?.layout.dragged(entry, unit(from_planet), unit(to_planet))
    }
}
