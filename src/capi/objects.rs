//! Objects on the ground: lists of them, and what bodies hit of them.

use super::answers::{answer, at_least_zero, input, optional_output, output};
use super::moving::{TellusContact, capsule_of, motion_of};
use super::{TellusPlanet, directions_of, valid};
use crate::life::{Instance, ObjectId, ObjectPatch};
use crate::terrain::RayLimits;
use glam::DVec3;
use std::ffi::c_char;

/// An object that stands on the ground: a plant, a stone, the same wherever and whenever it is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TellusInstance {
    /// Its id in the population.
    pub id: u64,
    /// Seed of its population. With the id it names the object, whatever becomes of other populations.
    pub seed: u32,
    /// Index of its population; see `tellus_population_name`.
    pub population: u32,
    /// Unit direction of its place in the planet frame.
    pub direction: [f64; 3],
    /// Height of the ground there above the reference sphere.
    pub ground_m: f64,
    /// Height of its foot above the reference sphere: it may be sunk into the ground.
    pub base_m: f64,
    /// Unit vector from its foot to its top in the planet frame.
    pub axis: [f64; 3],
    /// Turn about the axis, against the clock as seen from the top.
    pub turn_rad: f64,
    /// Height along its axis.
    pub size_m: f64,
    /// Factor on the colours of its population.
    pub brightness: f64,
    /// Variant of the form, 0 to 3.
    pub variant: u32,
    /// Always 0.
    pub reserved: u32,
}

/// The name of an object among all of a planet. A save may hold its bytes: they are the same on every machine of one
/// byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct TellusObject {
    /// Its id in the population.
    pub id: u64,
    /// Seed of its population.
    pub seed: u32,
    /// Write 0.
    pub reserved: u32,
}

/// Solid objects near those who move: trunks, stones and others of populations that are solid. It keeps what was asked
/// for, so one thread uses it at a time. It may outlive its planet.
pub struct TellusObjects(ObjectPatch);

/// Number of populations.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_population_count(planet: *const TellusPlanet) -> u32 {
    // SAFETY: the caller's promise.
    answer(0, || Ok(unsafe { valid(planet) }?.populations.len() as u32))
}

/// The name of a population. Valid as long as the planet; NULL if there is no such population.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_population_name(planet: *const TellusPlanet, population: u32) -> *const c_char {
    answer(std::ptr::null(), || {
        // SAFETY: the caller's promise.
        let all = &unsafe { valid(planet) }?.populations;
        let found = all.get(population as usize).map(|name| name.as_ptr());
        found.ok_or_else(|| format!("there is no population {population}; there are {}", all.len()))
    })
}

/// The objects within `radius_m` of a direction of 3 numbers, along the reference sphere, on all cores. The answer is
/// their number, -1 if that failed. The first `capacity` of them are written, in ascending order of their ids: if there
/// are more, ask with a larger buffer. `instances` may be NULL where `capacity` is 0.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `direction` is NULL or holds 3 numbers, and `instances` is NULL or
/// holds `capacity`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_instances(
    planet: *const TellusPlanet,
    direction: *const f64,
    radius_m: f64,
    instances: *mut TellusInstance,
    capacity: usize,
) -> i64 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let (dirs, instances) =
            unsafe { (directions_of(direction, 1, "direction")?, output(instances, capacity, "instances")?) };
        let radius_m = at_least_zero(radius_m, "radius_m")?;
        let found = terrain.instances(dirs[0], radius_m).map_err(|error| error.to_string())?;
        for (instance, found) in instances.iter_mut().zip(&found) {
            *instance = TellusInstance::of(found);
        }
        Ok(found.len() as i64)
    })
}

/// The nearest object to a direction of 3 numbers within a distance along the reference sphere, of one population or,
/// where `population` is negative, of any. 1 and `instance` written, 0 if there is none, -1 if that failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `direction` is NULL or holds 3 numbers, and `instance` is NULL or
/// holds one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_nearest_object(
    planet: *const TellusPlanet,
    direction: *const f64,
    within_m: f64,
    population: i32,
    instance: *mut TellusInstance,
) -> i32 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let TellusPlanet { terrain, populations, .. } = unsafe { valid(planet) }?;
        // SAFETY: the caller's promise.
        let (dirs, instance) = unsafe { (directions_of(direction, 1, "direction")?, output(instance, 1, "instance")?) };
        let within_m = at_least_zero(within_m, "within_m")?;
        let only: Vec<u16> = u16::try_from(population).into_iter().collect();
        if population >= 0 && population as usize >= populations.len() {
            return Err(format!("there is no population {population}; there are {}", populations.len()));
        }
        let found = terrain.nearest_object(dirs[0], within_m, &only, &|_| true).map_err(|error| error.to_string())?;
        let Some(found) = found else { return Ok(0) };
        instance[0] = TellusInstance::of(&found.instance);
        Ok(1)
    })
}

/// The solid objects of a planet. The forms of its populations are measured first, which takes some milliseconds for
/// each. NULL if that failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects(planet: *const TellusPlanet) -> *mut TellusObjects {
    answer(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let patch = ObjectPatch::new(unsafe { valid(planet) }?.terrain.clone());
        Ok(Box::into_raw(Box::new(TellusObjects(patch))))
    })
}

/// Frees solid objects. NULL is ignored.
///
/// # Safety
/// `objects` is NULL or came from this library, is not freed twice, and no thread uses it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_free(objects: *mut TellusObjects) {
    if !objects.is_null() {
        // SAFETY: the caller's promise.
        let objects = unsafe { Box::from_raw(objects) };
        answer((), || {
            drop(objects);
            Ok(())
        });
    }
}

/// Where a capsule (as that of `tellus_sweep`) is nearest to an object. 1 and `contact` written, with a share of 0, if
/// one is within `within_m`, 0 if none is, -1 if that failed. `object` may be NULL.
///
/// # Safety
/// `objects` is NULL or came from `tellus_objects`, and no other thread uses it; `ends_m` is NULL or holds 6 numbers,
/// `contact` and `object` are NULL or hold one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_contact(
    objects: *mut TellusObjects,
    ends_m: *const f64,
    radius_m: f64,
    within_m: f64,
    contact: *mut TellusContact,
    object: *mut TellusObject,
) -> i32 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let patch = unsafe { valid_objects(objects) }?;
        // SAFETY: the caller's promise.
        let (capsule, contact, object) = unsafe {
            (capsule_of(ends_m, radius_m)?, output(contact, 1, "contact")?, optional_output(object, 1, "object")?)
        };
        let within_m = at_least_zero(within_m, "within_m")?;
        let Some(met) = patch.contact(&capsule, within_m) else { return Ok(0) };
        contact[0] = TellusContact::of(0.0, &met.hit);
        object.fill(TellusObject::of(met.object));
        Ok(1)
    })
}

/// As `tellus_sweep`, among objects alone: the ground does not stop the motion. `object` may be NULL.
///
/// # Safety
/// As for `tellus_objects_contact`; `motion_m` is NULL or holds 3 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_sweep(
    objects: *mut TellusObjects,
    ends_m: *const f64,
    radius_m: f64,
    motion_m: *const f64,
    skin_m: f64,
    contact: *mut TellusContact,
    object: *mut TellusObject,
) -> i32 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let patch = unsafe { valid_objects(objects) }?;
        // SAFETY: the caller's promise.
        let (capsule, motion_m) = unsafe { (capsule_of(ends_m, radius_m)?, motion_of(motion_m)?) };
        // SAFETY: the caller's promise.
        let (contact, object) = unsafe { (output(contact, 1, "contact")?, optional_output(object, 1, "object")?) };
        let skin_m = at_least_zero(skin_m, "skin_m")?;
        let Some(met) = patch.sweep(&capsule, motion_m, skin_m) else { return Ok(0) };
        contact[0] = TellusContact::of(met.hit.share, &met.hit.contact);
        object.fill(TellusObject::of(met.object));
        Ok(1)
    })
}

/// Distance in metres along a ray (planet frame, metres from the centre) to the first object, up to `to_m`: infinite if
/// it meets none, NaN if that failed. Neither the ground nor the sea stops it; see `tellus_raycast`. `normal` has 3
/// numbers; it and `object` may be NULL, and are written where an object is met.
///
/// # Safety
/// `objects` is NULL or came from `tellus_objects`, and no other thread uses it; `origin_m`, `direction` and `normal`
/// are NULL or hold 3 numbers, `object` is NULL or holds one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_raycast(
    objects: *mut TellusObjects,
    origin_m: *const f64,
    direction: *const f64,
    to_m: f64,
    normal: *mut f64,
    object: *mut TellusObject,
) -> f64 {
    answer(f64::NAN, || {
        // SAFETY: the caller's promise.
        let patch = unsafe { valid_objects(objects) }?;
        // SAFETY: the caller's promise.
        let (origin_m, dirs) = unsafe { (input(origin_m, 3, "origin_m")?, directions_of(direction, 1, "direction")?) };
        // SAFETY: the caller's promise.
        let (normal, object) =
            unsafe { (optional_output(normal, 3, "normal")?, optional_output(object, 1, "object")?) };
        let origin_m = DVec3::from_slice(origin_m);
        if !origin_m.is_finite() {
            return Err("origin_m is not finite".to_owned());
        }
        if to_m.is_nan() || to_m < 0.0 {
            return Err(format!("to_m is {to_m}; use 0 or more"));
        }
        let Some(met) = patch.raycast(origin_m, dirs[0], &RayLimits::default().to_m(to_m)) else {
            return Ok(f64::INFINITY);
        };
        normal.iter_mut().zip(met.hit.normal_planet.to_array()).for_each(|(normal, found)| *normal = found);
        object.fill(TellusObject::of(met.object));
        Ok(met.hit.away_m)
    })
}

/// Hides `count` objects, those that a game has felled or taken: nothing hits them. The answer is how many were there
/// before, -1 if that failed. Objects of populations that the planet does not have may be among them.
///
/// # Safety
/// `objects` is NULL or came from `tellus_objects`, and no other thread uses it; `hidden` is NULL or holds `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_hide(
    objects: *mut TellusObjects,
    hidden: *const TellusObject,
    count: usize,
) -> i64 {
    // SAFETY: the caller's promise.
    unsafe { change(objects, hidden, count, |patch, object| patch.hidden_mut().hide(object)) }
}

/// Shows `count` objects again. The answer is how many were hidden, -1 if that failed.
///
/// # Safety
/// As for `tellus_objects_hide`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_show(
    objects: *mut TellusObjects,
    shown: *const TellusObject,
    count: usize,
) -> i64 {
    // SAFETY: the caller's promise.
    unsafe { change(objects, shown, count, |patch, object| patch.hidden_mut().show(object)) }
}

/// The hidden objects, for a save. The answer is their number, -1 if that failed. The first `capacity` of them are
/// written, in ascending order of seeds and ids. `hidden` may be NULL where `capacity` is 0.
///
/// # Safety
/// As for `tellus_objects_hide`; `hidden` is NULL or holds `capacity`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_objects_hidden(
    objects: *const TellusObjects,
    hidden: *mut TellusObject,
    capacity: usize,
) -> i64 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let patch = &unsafe { objects.as_ref() }.ok_or("objects is NULL")?.0;
        // SAFETY: the caller's promise.
        let hidden = unsafe { output(hidden, capacity, "hidden") }?;
        for (hidden, found) in hidden.iter_mut().zip(patch.hidden().iter()) {
            *hidden = TellusObject::of(found);
        }
        Ok(patch.hidden().len() as i64)
    })
}

/// Changes the hidden objects one by one; how many changed.
///
/// # Safety
/// As for [`tellus_objects_hide`].
unsafe fn change(
    objects: *mut TellusObjects,
    named: *const TellusObject,
    count: usize,
    each: impl Fn(&mut ObjectPatch, ObjectId) -> bool,
) -> i64 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let patch = unsafe { valid_objects(objects) }?;
        // SAFETY: the caller's promise.
        let named = unsafe { input(named, count, "objects to hide or show") }?;
        let changed = named.iter().filter(|one| each(patch, ObjectId { seed: one.seed, id: one.id }));
        Ok(changed.count() as i64)
    })
}

impl TellusInstance {
    fn of(found: &Instance) -> Self {
        Self {
            id: found.id,
            seed: found.seed,
            population: found.population.into(),
            direction: found.dir_planet.to_array(),
            ground_m: found.ground_m,
            base_m: found.base_m,
            axis: found.axis_planet.to_array(),
            turn_rad: found.turn_rad,
            size_m: found.size_m,
            brightness: found.brightness,
            variant: found.variant.into(),
            reserved: 0,
        }
    }
}

impl TellusObject {
    fn of(found: ObjectId) -> Self {
        Self { id: found.id, seed: found.seed, reserved: 0 }
    }
}

/// # Safety
/// `objects` is NULL or came from this library, outlives the answer, and nothing else uses it meanwhile.
unsafe fn valid_objects<'a>(objects: *mut TellusObjects) -> Result<&'a mut ObjectPatch, String> {
    // SAFETY: the caller's promise.
    let objects = unsafe { objects.as_mut() }.ok_or_else(|| "objects is NULL".to_owned())?;
    Ok(&mut objects.0)
}
