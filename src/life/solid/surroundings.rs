//! Surroundings: the ground and the objects on it as one.

use super::hidden::ObjectId;
use super::patch::{Met, ObjectPatch, RayHit};
use crate::terrain::{Capsule, Contact, GroundPatch, RayLimits, Scratch, Sweep, Terrain, Walkable, Wanted};
use glam::DVec3;
use std::sync::Arc;

/// The ground near some place with the objects on it: what a body meets. A [`Walker`](crate::terrain::Walker) walks
/// among them.
///
/// Answers name the object that is met, or None for the ground.
#[derive(Debug)]
pub struct Surroundings {
    /// The ground.
    pub ground: GroundPatch,
    /// The objects.
    pub objects: ObjectPatch,
    scratch: Scratch,
}

impl Surroundings {
    /// Surroundings with new patches of a terrain.
    pub fn new(terrain: Arc<Terrain>) -> Self {
        Self::of(GroundPatch::new(Arc::clone(&terrain)), ObjectPatch::new(terrain))
    }

    /// Surroundings of two patches, which should be those of one terrain.
    pub fn of(ground: GroundPatch, objects: ObjectPatch) -> Self {
        Self { ground, objects, scratch: Scratch::default() }
    }

    /// Memory of both patches.
    pub fn resident_bytes(&self) -> usize {
        self.ground.resident_bytes() + self.objects.resident_bytes()
    }

    /// The nearer of [`GroundPatch::contact`] and [`ObjectPatch::contact`].
    pub fn contact(&mut self, capsule: &Capsule, within_m: f64) -> Option<Met<Contact, Option<ObjectId>>> {
        let ground = self.ground.contact(capsule, within_m);
        let object = self.objects.contact(capsule, within_m);
        match (ground, object) {
            (Some(ground), Some(object)) if object.hit.gap_m < ground.gap_m => Some(object.named()),
            (Some(hit), _) => Some(Met { hit, object: None }),
            (None, object) => object.map(Met::named),
        }
    }

    /// The first of [`GroundPatch::sweep`] and [`ObjectPatch::sweep`].
    pub fn sweep(
        &mut self,
        capsule: &Capsule,
        motion_planet_m: DVec3,
        skin_m: f64,
    ) -> Option<Met<Sweep, Option<ObjectId>>> {
        let ground = self.ground.sweep(capsule, motion_planet_m, skin_m);
        let share = ground.map_or(1.0, |ground| ground.share);
        let object = self.objects.sweep_up_to(capsule, motion_planet_m, skin_m, share);
        object.map(Met::named).or(ground.map(|hit| Met { hit, object: None }))
    }

    /// The first of [`Terrain::raycast_within`] and [`ObjectPatch::raycast`]: the evaluator's ground, the sea if it
    /// stops the ray, or an object.
    pub fn raycast(
        &mut self,
        origin_planet_m: DVec3,
        dir_planet: DVec3,
        limits: &RayLimits,
    ) -> Option<Met<RayHit, Option<ObjectId>>> {
        let terrain = Arc::clone(self.ground.terrain());
        let ground_m = terrain.raycast_within(origin_planet_m, dir_planet, limits, &mut self.scratch);
        let limits = limits.to_m(ground_m.unwrap_or(limits.to_m));
        if let Some(object) = self.objects.raycast(origin_planet_m, dir_planet, &limits) {
            return Some(object.named());
        }
        let away_m = ground_m?;
        let point_planet_m = origin_planet_m + dir_planet.normalize_or_zero() * away_m;
        let sample = self.sample(point_planet_m);
        let over_m = point_planet_m.length() - terrain.planet().radius_m() - sample.height_m;
        // What is over the ground is the sea.
        let is_ground = over_m < 1e-3;
        let normal_planet = if is_ground { sample.normal_planet } else { point_planet_m.normalize_or(DVec3::Z) };
        Some(Met { hit: RayHit { away_m, point_planet_m, normal_planet }, object: None })
    }

    fn sample(&mut self, point_m: DVec3) -> crate::terrain::Sample {
        let mut samples = [crate::terrain::Sample::default()];
        let wanted = Wanted::HEIGHT.and_normal();
        let dirs = [point_m.normalize_or(DVec3::Z)];
        self.ground.terrain().samples_spaced_into(&dirs, 0.0, wanted, &mut samples, &mut self.scratch);
        samples[0]
    }
}

impl<T> Met<T> {
    /// The same among answers that may be of the ground.
    fn named(self) -> Met<T, Option<ObjectId>> {
        Met { hit: self.hit, object: Some(self.object) }
    }
}

impl Walkable for Surroundings {
    fn ground(&mut self) -> &mut GroundPatch {
        &mut self.ground
    }

    fn contact(&mut self, capsule: &Capsule, within_m: f64) -> Option<Contact> {
        Surroundings::contact(self, capsule, within_m).map(|met| met.hit)
    }

    fn way_aside(&mut self, capsule: &Capsule, skin_m: f64) -> DVec3 {
        let Some(met) = self.objects.contact(capsule, skin_m).filter(|met| met.hit.gap_m < skin_m) else {
            return DVec3::ZERO;
        };
        let (up, normal) = (capsule.ends_planet_m[0].normalize_or(DVec3::Z), met.hit.normal_planet);
        let level = normal - up * normal.dot(up);
        // What is in a boulder from below gets out to a side, too.
        let side = level.try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
        side * ((2.0 * skin_m - met.hit.gap_m) / level.length().max(0.3))
    }

    fn sweep(&mut self, capsule: &Capsule, motion_planet_m: DVec3, skin_m: f64) -> Option<Sweep> {
        Surroundings::sweep(self, capsule, motion_planet_m, skin_m).map(|met| met.hit)
    }
}
