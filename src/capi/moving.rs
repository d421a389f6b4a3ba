//! What a game asks at each moment: clouds and waves at a time, chunks of ground for physics, balls and capsules
//! against the ground.

use super::answers::{answer, at_least_zero, input, optional_output, output};
use super::{SCRATCH, TellusPlanet, directions_of, valid};
use crate::clouds::CloudField;
use crate::sea::{Column, Waves};
use crate::terrain::{Capsule, ChunkGrid, Contact, Wanted};
use glam::DVec3;

/// Most cells along a side of a chunk.
pub const TELLUS_MAX_CHUNK_CELLS: u32 = 1024;

/// How much of the sky clouds cover, each 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TellusClouds {
    /// Low clouds.
    pub low: f64,
    /// Middle clouds.
    pub middle: f64,
    /// The veil of high clouds.
    pub veil: f64,
    /// Fog: a share of the ground.
    pub fog: f64,
}

/// Where a capsule that moves touches the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TellusContact {
    /// Share of the motion until it touches, 0 to 1.
    pub share: f64,
    /// Distance between the surfaces there; negative: how far the capsule must move along the normal to be free.
    pub gap_m: f64,
    /// The point of the ground in the planet frame, metres from the centre.
    pub point_m: [f64; 3],
    /// Unit vector from the ground to the capsule.
    pub normal: [f64; 3],
}

/// Clouds over `count` directions of 3 numbers each at a time in seconds; 0 on a planet without clouds. False, and
/// nothing written, if that failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `clouds` is NULL
/// or holds `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_clouds(
    planet: *const TellusPlanet,
    directions: *const f64,
    count: usize,
    time_s: f64,
    clouds: *mut TellusClouds,
) -> bool {
    answer(false, || {
        // SAFETY: the caller's promise.
        let planet = unsafe { valid(planet) }?;
        // SAFETY: the caller's promise.
        let (dirs, clouds) =
            unsafe { (directions_of(directions, count, "directions")?, output(clouds, count, "clouds")?) };
        let time_s = finite(time_s)?;
        clouds.fill(TellusClouds { low: 0.0, middle: 0.0, veil: 0.0, fog: 0.0 });
        if planet.terrain.planet().clouds.is_some() {
            let field = planet.clouds.get_or_init(|| CloudField::new(&planet.terrain));
            for (clouds, found) in clouds.iter_mut().zip(field.covers(dirs, time_s)) {
                *clouds = TellusClouds { low: found.low, middle: found.middle, veil: found.veil, fog: found.fog };
            }
        }
        Ok(true)
    })
}

/// Heights of the water's surface over the reference sphere in metres under `count` directions of 3 numbers each at a
/// time in seconds: of the sea with its waves, of lakes and rivers their level; NaN on land. Directions should lie
/// within some kilometres of each other: all have the waves around the first. False, and nothing written, if that
/// failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `heights_m` is
/// NULL or holds `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_water(
    planet: *const TellusPlanet,
    directions: *const f64,
    count: usize,
    time_s: f64,
    heights_m: *mut f64,
) -> bool {
    answer(false, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let (dirs, heights_m) =
            unsafe { (directions_of(directions, count, "directions")?, output(heights_m, count, "heights_m")?) };
        let time_s = finite(time_s)?;
        let Some(first) = dirs.first() else { return Ok(true) };
        let waves = Waves::near(terrain, first.normalize());
        let sea_m = terrain.planet().sea_level_m();
        let samples = terrain.samples(dirs, Wanted::HEIGHT.and_water());
        for ((dir, sample), height_m) in dirs.iter().zip(samples).zip(heights_m) {
            let dir = dir.normalize();
            *height_m = match sample.water_level_m.filter(|level_m| *level_m > sample.height_m) {
                level_m if level_m.is_some() && level_m == sea_m => {
                    waves.surface(dir, time_s, &Column::at(terrain, dir)).height_m
                }
                level_m => level_m.unwrap_or(f64::NAN),
            };
        }
        Ok(true)
    })
}

/// A square of ground for a physics engine, in a local frame: metres along east, north and up of a place, from the
/// ground there. `column` counts to the east, `row` to the north; the place is the south west corner of 0, 0.
/// Neighbours share the vertices of their border to the bit.
///
/// `positions_m` and `normals` have 3 (`cells` + 1)^2 numbers, row by row from the south west; `normals` may be NULL.
/// The triangles are those of `tellus_tile_indices` with a side of `cells` + 1. False, and nothing written, if that
/// failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `direction` is NULL or holds 3 numbers, and `positions_m` and
/// `normals` are NULL or hold 3 (`cells` + 1)^2.
#[allow(clippy::too_many_arguments)] // C has no tuples.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_chunk(
    planet: *const TellusPlanet,
    direction: *const f64,
    side_m: f64,
    cells: u32,
    column: i32,
    row: i32,
    positions_m: *mut f32,
    normals: *mut f32,
) -> bool {
    answer(false, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let dir = unsafe { directions_of(direction, 1, "direction") }?[0];
        if !(1..=TELLUS_MAX_CHUNK_CELLS).contains(&cells) {
            return Err(format!("cells is {cells}; use 1 to {TELLUS_MAX_CHUNK_CELLS}"));
        }
        if !(side_m > 0.0 && side_m <= terrain.planet().radius_m()) {
            return Err(format!("side_m is {side_m}; use more than 0 and at most the radius"));
        }
        let count = (cells as usize + 1).pow(2);
        // SAFETY: the caller's promise.
        let positions_m = unsafe { output(positions_m, 3 * count, "positions_m") }?;
        // SAFETY: the caller's promise.
        let normals = unsafe { optional_output(normals, 3 * count, "normals") }?;
        let grid = ChunkGrid::on_ground(terrain, dir, side_m, cells);
        let chunk = SCRATCH.with_borrow_mut(|scratch| grid.chunk(terrain, [column, row], scratch));
        for (position, found) in positions_m.as_chunks_mut().0.iter_mut().zip(&chunk.positions_m) {
            *position = found.to_array();
        }
        for (normal, found) in normals.as_chunks_mut().0.iter_mut().zip(&chunk.normals) {
            *normal = found.to_array();
        }
        Ok(true)
    })
}

/// How far a capsule moves until it is `skin_m` from the ground: all points within `radius_m` of the line between two
/// ends (3 numbers each, planet frame, metres from the centre; a ball has both in one place). `motion_m` has 3 numbers.
/// What touches may leave. 1 and `contact` written if it is stopped, 0 if it is not, -1 if that failed. The sea does
/// not count.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `ends_m` is NULL or holds 6 numbers, `motion_m` is NULL or holds 3,
/// and `contact` is NULL or holds one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_sweep(
    planet: *const TellusPlanet,
    ends_m: *const f64,
    radius_m: f64,
    motion_m: *const f64,
    skin_m: f64,
    contact: *mut TellusContact,
) -> i32 {
    answer(-1, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let (capsule, motion_m, contact) =
            unsafe { (capsule_of(ends_m, radius_m)?, motion_of(motion_m)?, output(contact, 1, "contact")?) };
        let skin_m = at_least_zero(skin_m, "skin_m")?;
        let sweep = SCRATCH.with_borrow_mut(|scratch| terrain.sweep_with(&capsule, motion_m, skin_m, scratch));
        let Some(sweep) = sweep else { return Ok(0) };
        contact[0] = TellusContact::of(sweep.share, &sweep.contact);
        Ok(1)
    })
}

impl TellusContact {
    pub(super) fn of(share: f64, found: &Contact) -> Self {
        Self {
            share,
            gap_m: found.gap_m,
            point_m: found.point_planet_m.to_array(),
            normal: found.normal_planet.to_array(),
        }
    }
}

/// The motion of a capsule.
///
/// # Safety
/// `motion_m` is NULL or holds 3 numbers.
pub(super) unsafe fn motion_of(motion_m: *const f64) -> Result<DVec3, String> {
    // SAFETY: the caller's promise.
    let motion_m = DVec3::from_slice(unsafe { input(motion_m, 3, "motion_m") }?);
    if motion_m.is_finite() { Ok(motion_m) } else { Err("motion_m is not finite".to_owned()) }
}

/// A capsule between two ends.
///
/// # Safety
/// `ends_m` is NULL or holds 6 numbers.
pub(super) unsafe fn capsule_of(ends_m: *const f64, radius_m: f64) -> Result<Capsule, String> {
    // SAFETY: the caller's promise.
    let ends_m = unsafe { input(ends_m, 6, "ends_m") }?;
    let ends_planet_m = [DVec3::from_slice(ends_m), DVec3::from_slice(&ends_m[3..])];
    if !ends_planet_m.iter().all(|end_m| end_m.is_finite()) {
        return Err("ends_m is not finite".to_owned());
    }
    if !(radius_m > 0.0 && radius_m.is_finite()) {
        return Err(format!("radius_m is {radius_m}; use more than 0"));
    }
    Ok(Capsule { ends_planet_m, radius_m })
}

fn finite(time_s: f64) -> Result<f64, String> {
    if time_s.is_finite() { Ok(time_s) } else { Err(format!("time_s is {time_s}; use a finite number")) }
}
