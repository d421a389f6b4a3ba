//! Tests of the patch against brute force: every part of every object.

use super::block::Solid;
use super::forms::{self, SolidForm};
use super::patch::ObjectPatch;
use super::shape::Near;
use crate::planet::life::READY_POPULATIONS;
use crate::planet::{Layer, Planet, Population};
use crate::sphere::{LatLon, Tangent};
use crate::terrain::ground::convex::Axis;
use crate::terrain::{Capsule, RayLimits, Terrain};
use glam::DVec3;
use proptest::prelude::*;
use std::sync::{Arc, LazyLock, Mutex};

const RADIUS_M: f64 = 600_000.0;
/// Objects so far around are all there are.
const AROUND_M: f64 = 110.0;

struct Site {
    solids: Vec<(u16, Solid)>,
    forms: Vec<SolidForm>,
    patch: Mutex<ObjectPatch>,
    middle_m: DVec3,
}

/// A site with trunks, cacti, crystals and boulders.
fn site() -> &'static Site {
    static SITE: LazyLock<Site> = LazyLock::new(|| {
        let ready = ["Broadleaf tree", "Palm", "Column cactus", "Boulder", "Crystals"];
        let life = READY_POPULATIONS.iter().filter(|one| ready.contains(&one.name)).enumerate();
        let life = life.map(|(seed, one)| Population {
            form: one.population().form,
            height_m: one.population().height_m,
            per_hectare: 120.0,
            slope_to_deg: 90.0,
            lean_deg: 10.0,
            seed: seed as u32,
            ..Population::default()
        });
        let layers = vec![Layer { amplitude_m: 100.0, ..Layer::default() }];
        let planet =
            Planet { radius_km: RADIUS_M / 1000.0, life: life.collect(), water: None, layers, ..Planet::default() };
        let terrain = Arc::new(Terrain::try_new(Arc::new(planet)).unwrap());
        let forms = forms::of_terrain(&terrain);
        let middle = LatLon::from_degrees(20.0, 30.0).direction();
        let solid = |instance: crate::life::Instance| {
            let form = forms.iter().find(|form| form.placement.index == instance.population).unwrap();
            let shape = &form.shapes[usize::from(instance.variant)];
            (instance.population, Solid::new(&instance, shape, RADIUS_M))
        };
        let solids = terrain.instances(middle, AROUND_M).unwrap().into_iter().map(solid).collect();
        let middle_m = middle * (RADIUS_M + terrain.height_m(middle));
        Site { solids, forms, patch: Mutex::new(ObjectPatch::new(terrain)), middle_m }
    });
    &SITE
}

impl Site {
    /// Calls for each part with its object.
    fn each(&self, mut call: impl FnMut(u16, &Solid, &super::shape::Part)) {
        for (population, solid) in &self.solids {
            let form = self.forms.iter().find(|form| form.placement.index == *population).unwrap();
            solid.shape(form).parts.iter().for_each(|part| call(*population, solid, part));
        }
    }
}

fn local(solid: &Solid, axis: &Axis) -> Axis {
    Axis { from_m: solid.local_m(axis.from_m), to_m: solid.local_m(axis.to_m) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn answers_are_those_of_brute_force(
        place in [-40.0..40.0_f64, -40.0..40.0_f64, 0.2..8.0_f64], long in [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64],
        is_ball in any::<bool>(), radius_m in 0.05..1.0_f64, way in [-1.0..1.0_f64, -1.0..1.0_f64, -0.4..0.3_f64],
        far_m in 0.5..45.0_f64,
    ) {
        let site = site();
        let mut patch = site.patch.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let tangent = Tangent::new(site.middle_m.normalize());
        let from_m = site.middle_m + tangent.planet(DVec3::from(place));
        let to_m = if is_ball { from_m } else { from_m + DVec3::from(long) };
        let (axis, dir) = (Axis { from_m, to_m }, tangent.planet(DVec3::from(way)).normalize_or(tangent.up_planet));
        let capsule = Capsule { ends_planet_m: [from_m, to_m], radius_m };

        let mut nearest: Option<(u64, Near)> = None;
        let mut hit: Option<(u64, f64)> = None;
        let mut stop: Option<(u64, f64)> = None;
        site.each(|_, solid, part| {
            let (axis, dir) = (local(solid, &axis), solid.local(dir));
            let near = part.nearest(solid.size_m, &axis);
            if nearest.is_none_or(|(_, best)| near.away_m < best.away_m) {
                nearest = Some((solid.id, near));
            }
            if let Some((away_m, _)) = part.ray(solid.size_m, axis.from_m, dir, [0.0, far_m])
                && hit.is_none_or(|(_, best_m)| away_m < best_m)
            {
                hit = Some((solid.id, away_m));
            }
            if let Some((gone_m, _)) = part.impact(solid.size_m, &axis, dir, far_m, radius_m)
                && stop.is_none_or(|(_, best_m)| gone_m < best_m)
            {
                stop = Some((solid.id, gone_m));
            }
        });
        let (id, near) = nearest.unwrap();
        let contact = patch.contact(&capsule, 60.0).unwrap();
        prop_assert!((contact.hit.gap_m - near.away_m + radius_m).abs() < 1e-9 && contact.object.id == id);
        let met = patch.raycast(from_m, dir, &RayLimits::default().to_m(far_m));
        prop_assert_eq!(met.map(|met| met.object.id), hit.map(|(id, _)| id));
        prop_assert!(met.is_none_or(|met| (met.hit.away_m - hit.unwrap().1).abs() < 1e-7));
        let sweep = patch.sweep(&capsule, dir * far_m, 0.0);
        prop_assert_eq!(sweep.is_some(), stop.is_some());
        if let (Some(sweep), Some((_, gone_m))) = (sweep, stop) {
            prop_assert!((sweep.hit.share * far_m - gone_m).abs() < 1e-5, "{} {gone_m}", sweep.hit.share * far_m);
        }
    }
}
