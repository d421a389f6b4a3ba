//! A plate of the structure that is dragged: what lay under the pointer stays under it.

use super::camera::orbit::sphere_point;
use crate::lod::Camera;
use crate::planet::{Planet, PlateByHand};
use crate::terrain::Terrain;
use glam::DVec3;

/// Name of the undo step of such a drag.
pub(super) const PLATE_STEP: &str = "Move plate";

/// The plate that is held.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateDrag {
    /// Its entry when the drag began.
    entry: PlateByHand,
    /// Where it was taken hold of: a unit direction.
    from: DVec3,
}

impl PlateDrag {
    /// Takes hold of the plate at a point of the picture (-1 to 1, right and up).
    pub(super) fn start(
        terrain: &Terrain,
        planet: &Planet,
        camera: &Camera,
        point: (f64, f64),
        aspect: f64,
    ) -> Option<Self> {
        let ray = camera.ray_dir_planet(point.0, point.1, aspect);
        // Not beside the globe.
        terrain.raycast(camera.position_planet_m, ray)?;
        let from = under(terrain, camera, point, aspect);
        let laid_out = terrain.plate_entry(from)?;
        let by_hand = &planet.structure.as_ref()?.plates.by_hand;
        let entry = by_hand.iter().find(|entry| entry.plate == laid_out.plate).cloned().unwrap_or(laid_out);
        Some(Self { entry, from })
    }

    /// Brings what was held under a point of the picture. Returns whether the planet was changed.
    pub(super) fn drag(
        &self,
        terrain: &Terrain,
        planet: &mut Planet,
        camera: &Camera,
        point: (f64, f64),
        aspect: f64,
    ) -> bool {
        let to = under(terrain, camera, point, aspect);
        let Some(structure) = &mut planet.structure else { return false };
        let Some(dragged) = terrain.dragged_plate(&self.entry, self.from, to) else { return false };
        structure.plates.set_by_hand(dragged);
        true
    }
}

/// The direction of the reference sphere under a point of the picture.
fn under(terrain: &Terrain, camera: &Camera, (x, y): (f64, f64), aspect: f64) -> DVec3 {
    let ray = camera.ray_dir_planet(x, y, aspect);
    let radius_m = terrain.planet().radius_m().min(camera.position_planet_m.length());
    sphere_point(camera.position_planet_m, ray, radius_m)
}
