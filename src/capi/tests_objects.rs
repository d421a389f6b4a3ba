//! The functions of objects, called as C calls them.

use super::moving::TellusContact;
use super::objects::*;
use super::tests::{Held, error, load};
use crate::life::ObjectPatch;
use crate::planet::Planet;
use crate::sphere::LatLon;
use crate::terrain::{Capsule, RayLimits, Terrain};
use glam::DVec3;
use std::ffi::CStr;
use std::ptr::{null, null_mut};
use std::sync::Arc;

/// A small world of boulders.
const STONY: &str = r#"(
    version: 3,
    name: "Stony",
    radius_km: 400.0,
    layers: [(name: "Hills", amplitude_m: 20.0, shape: Fbm(wavelength_km: 2.0, octaves: 6))],
    life: [
        (name: "Pebbles", seed: 4, per_hectare: 900.0, height_m: 0.1, slope_to_deg: 90.0, form: Stone()),
        (name: "Boulders", seed: 5, per_hectare: 120.0, height_m: 2.0, slope_to_deg: 90.0, form: Stone()),
    ],
)"#;

fn stony() -> (Held, Arc<Terrain>) {
    let planet = Planet::from_text("stony.ron", STONY).unwrap();
    (Held(load(STONY)), Arc::new(Terrain::try_new(planet.into()).unwrap()))
}

fn middle() -> DVec3 {
    LatLon::from_degrees(12.0, 34.0).direction()
}

const NONE: TellusInstance = TellusInstance {
    id: 0,
    seed: 0,
    population: 0,
    direction: [0.0; 3],
    ground_m: 0.0,
    base_m: 0.0,
    axis: [0.0; 3],
    turn_rad: 0.0,
    size_m: 0.0,
    brightness: 0.0,
    variant: 0,
    reserved: 0,
};

#[test]
fn instances_are_those_of_the_library_as_many_as_there_is_room_for() {
    let (planet, terrain) = stony();
    let wanted = terrain.instances(middle(), 60.0).unwrap();
    assert!(wanted.len() > 200, "{}", wanted.len());
    let at = middle().to_array();
    for room in [0, 7, wanted.len() + 3] {
        let mut found = vec![NONE; room];
        // SAFETY: the buffer holds `room`.
        let count = unsafe { tellus_instances(planet.0, at.as_ptr(), 60.0, found.as_mut_ptr(), room) };
        assert_eq!(count, wanted.len() as i64);
        for (found, wanted) in found.iter().zip(&wanted) {
            assert_eq!((found.id, found.seed, found.population), (wanted.id, wanted.seed, wanted.population.into()));
            assert_eq!((found.direction, found.axis), (wanted.dir_planet.to_array(), wanted.axis_planet.to_array()));
            assert_eq!([found.base_m, found.size_m, found.turn_rad], [wanted.base_m, wanted.size_m, wanted.turn_rad]);
        }
        assert!(found.iter().skip(wanted.len()).all(|rest| *rest == NONE));
    }
    // SAFETY: names are texts of the planet, and functions refuse before they write.
    unsafe {
        assert_eq!(tellus_population_count(planet.0), 2);
        assert_eq!(CStr::from_ptr(tellus_population_name(planet.0, 1)).to_str(), Ok("Boulders"));
        assert!(tellus_population_name(planet.0, 2).is_null());
        assert_eq!(tellus_instances(planet.0, at.as_ptr(), f64::NAN, null_mut(), 0), -1);
        assert!(error().contains("radius_m"));
        assert_eq!(tellus_instances(planet.0, at.as_ptr(), 60.0, null_mut(), 1), -1);
        assert!(error().contains("instances is NULL"));
        assert_eq!(tellus_instances(planet.0, at.as_ptr(), 300_000.0, null_mut(), 0), -1);
        assert!(error().contains("ask for a smaller part"));
    }
}

#[test]
fn the_nearest_object_is_that_of_the_library() {
    let (planet, terrain) = stony();
    let (at, mut found) = (middle().to_array(), NONE);
    for (population, only) in [(-1, &[][..]), (1, &[1][..])] {
        let wanted = terrain.nearest_object(middle(), 500.0, only, &|_| true).unwrap().unwrap();
        // SAFETY: the buffers hold 3 numbers and one instance.
        let there = unsafe { tellus_nearest_object(planet.0, at.as_ptr(), 500.0, population, &raw mut found) };
        assert_eq!((there, found.id), (1, wanted.instance.id));
    }
    // SAFETY: as before.
    unsafe {
        assert_eq!(tellus_nearest_object(planet.0, at.as_ptr(), 0.0, 1, &raw mut found), 0);
        assert_eq!(tellus_nearest_object(planet.0, at.as_ptr(), 5.0, 2, &raw mut found), -1);
        assert!(error().contains("no population 2"));
    }
}

#[test]
fn objects_are_hit_as_in_the_library_until_they_are_hidden() {
    let (planet, terrain) = stony();
    let mut patch = ObjectPatch::new(terrain.clone());
    // SAFETY: the planet is one of this library.
    let objects = unsafe { tellus_objects(planet.0) };
    // The objects outlive their planet.
    drop(planet);
    let boulder = terrain.nearest_object(middle(), 500.0, &[1], &|_| true).unwrap().unwrap().instance;
    let above_m = boulder.foot_planet_m(400_000.0) + boulder.dir_planet * 10.0;
    let (down, motion_m) = ((-boulder.dir_planet).to_array(), (boulder.dir_planet * -20.0).to_array());
    let ends_m = [above_m.to_array(), above_m.to_array()];
    let ball = Capsule::sphere(above_m, 0.5);
    let mut contact = TellusContact { share: -1.0, gap_m: 0.0, point_m: [0.0; 3], normal: [0.0; 3] };
    let mut object = TellusObject { id: 0, seed: 0, reserved: 1 };
    let mut normal = [0.0; 3];
    // SAFETY: all buffers hold what the functions say.
    unsafe {
        let (ends_m, above) = (ends_m.as_ptr().cast(), above_m.to_array());
        let swept = patch.sweep(&ball, boulder.dir_planet * -20.0, 0.01).unwrap();
        let (met, named) = (&raw mut contact, &raw mut object);
        assert_eq!(tellus_objects_sweep(objects, ends_m, 0.5, motion_m.as_ptr(), 0.01, met, named), 1);
        assert_eq!((contact.share, contact.point_m), (swept.hit.share, swept.hit.contact.point_planet_m.to_array()));
        assert_eq!((object.seed, object.id, object.reserved), (swept.object.seed, swept.object.id, 0));
        let near = patch.contact(&ball, 20.0).unwrap();
        assert_eq!(tellus_objects_contact(objects, ends_m, 0.5, 20.0, met, null_mut()), 1);
        assert_eq!((contact.gap_m, contact.share), (near.hit.gap_m, 0.0));
        let ray = patch.raycast(above_m, -boulder.dir_planet, &RayLimits::default().to_m(20.0)).unwrap();
        let away_m = tellus_objects_raycast(objects, above.as_ptr(), down.as_ptr(), 20.0, normal.as_mut_ptr(), named);
        assert_eq!((away_m, normal), (ray.hit.away_m, ray.hit.normal_planet.to_array()));
        assert_eq!(object.id, ray.object.id);

        assert_eq!(tellus_objects_hide(objects, named, 1), 1);
        assert_eq!(tellus_objects_hide(objects, named, 1), 0);
        let more_m = tellus_objects_raycast(objects, above.as_ptr(), down.as_ptr(), 20.0, null_mut(), null_mut());
        assert!(more_m > away_m, "{more_m}");
        // The planet does not have the population of this one.
        let stranger = TellusObject { id: 3, seed: 77, reserved: 0 };
        assert_eq!(tellus_objects_hide(objects, &raw const stranger, 1), 1);
        let mut hidden = [TellusObject { id: 0, seed: 0, reserved: 0 }; 3];
        assert_eq!(tellus_objects_hidden(objects, hidden.as_mut_ptr(), 3), 2);
        assert_eq!(hidden[..2], [object, stranger]);
        assert_eq!(tellus_objects_show(objects, hidden.as_ptr(), 2), 2);
        assert_eq!(tellus_objects_hidden(objects, null_mut(), 0), 0);
        let again_m = tellus_objects_raycast(objects, above.as_ptr(), down.as_ptr(), 20.0, null_mut(), null_mut());
        assert_eq!(again_m, away_m);

        assert_eq!(tellus_objects_contact(objects, ends_m, -1.0, 20.0, met, named), -1);
        assert!(error().contains("radius_m"));
        assert!(tellus_objects_raycast(objects, above.as_ptr(), down.as_ptr(), f64::NAN, null_mut(), named).is_nan());
        assert!(error().contains("to_m"));
        tellus_objects_free(objects);
    }
}

#[test]
fn null_is_refused_or_ignored() {
    // SAFETY: the functions refuse NULL before they read.
    unsafe {
        assert!(tellus_objects(null()).is_null());
        assert_eq!(tellus_population_count(null()), 0);
        assert_eq!(tellus_objects_hide(null_mut(), null(), 0), -1);
        assert!(error().contains("objects is NULL"));
        assert_eq!(tellus_objects_hidden(null(), null_mut(), 0), -1);
        tellus_objects_free(null_mut());
    }
}
