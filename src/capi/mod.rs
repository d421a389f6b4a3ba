//! The C interface: a planet for engines that do not speak Rust (Unity, Unreal, Godot, Python).
//!
//! - this file, `moving` and `objects`: the functions, of which `include/tellus.h` is made
//! - `answers`: errors and the caller's buffers
//!
//! A shared library is built with `cargo rustc --lib --no-default-features --features capi --crate-type cdylib`.
//! `docs/embedding.md` shows its use.

mod answers;
pub mod moving;
pub mod objects;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_objects;

use crate::clouds::CloudField;
use crate::planet::param::ParamPath;
use crate::planet::{Key, Planet};
use crate::sphere::{Face, LatLon, NodeId};
use crate::terrain::{Detail, MapStore, Scratch, Terrain, Wanted};
use answers::{answer, input, last_error, optional_text, output, text};
use glam::DVec3;
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::sync::{Arc, OnceLock};

/// A planet, ready for queries. Any number of threads may ask at once.
pub struct TellusPlanet {
    terrain: Arc<Terrain>,
    /// Made when clouds are asked for.
    clouds: OnceLock<CloudField>,
    name: CString,
    hash: CString,
    biomes: Vec<CString>,
    populations: Vec<CString>,
}

/// The surface under one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TellusSample {
    /// Height of the ground above the reference sphere, below the sea too.
    pub height_m: f64,
    /// Surface of the sea, lake or river over the ground; NaN where there is none.
    pub water_level_m: f64,
    /// Unit normal of the ground in the planet frame.
    pub normal: [f64; 3],
    /// Angle between the ground and the horizontal.
    pub slope_rad: f64,
    /// Temperature at the surface.
    pub temperature_c: f64,
    /// Rain and snow in a year.
    pub rain_mm: f64,
    /// Index of the biome; see `tellus_biome_name`.
    pub biome: u32,
}

/// Most vertices along the side of a tile.
pub const TELLUS_MAX_TILE_SIDE: u32 = 4097;

/// Most bytes in a folder of kept maps.
const CACHE_BYTES: u64 = 1 << 30;

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// The version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn tellus_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// What went wrong in the last call that failed on this thread; empty if none did. Valid until the next call that fails
/// on this thread.
#[unsafe(no_mangle)]
pub extern "C" fn tellus_last_error() -> *const c_char {
    last_error()
}

/// Loads a preset from a file, with its height maps. NULL if that failed.
///
/// A planet with a structure solves its maps first, which takes a second or more. They are kept in `cache_folder` for
/// the next time, at most 1 GiB of them; NULL keeps none.
///
/// # Safety
/// `path` and `cache_folder` are NULL or end with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_planet_from_file(
    path: *const c_char,
    cache_folder: *const c_char,
) -> *mut TellusPlanet {
    answer(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let (path, folder) = unsafe { (text(path, "path")?, optional_text(cache_folder, "cache_folder")?) };
        let planet = Planet::load(path).map_err(|error| error.to_string())?;
        ready(planet, folder)
    })
}

/// Loads a preset from text. Height maps must have absolute paths. `name` stands for the file in messages. NULL if that
/// failed. See `tellus_planet_from_file` for `cache_folder`.
///
/// # Safety
/// `name`, `preset` and `cache_folder` are NULL or end with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_planet_from_text(
    name: *const c_char,
    preset: *const c_char,
    cache_folder: *const c_char,
) -> *mut TellusPlanet {
    answer(std::ptr::null_mut(), || {
        // SAFETY: the caller's promise.
        let (name, preset) = unsafe { (text(name, "name")?, text(preset, "preset")?) };
        // SAFETY: the caller's promise.
        let folder = unsafe { optional_text(cache_folder, "cache_folder") }?;
        let mut planet = Planet::from_text(name, preset).map_err(|error| error.to_string())?;
        let problems = planet.load_pictures();
        let [textures, others] = planet.harmless_problems(problems);
        let said = |(path, why): (ParamPath, String)| format!("{name}: {path}: {why}");
        textures.into_iter().for_each(|problem| log::warn!("{}", said(problem)));
        others.into_iter().next().map_or_else(|| ready(planet, folder), |problem| Err(said(problem)))
    })
}

/// Frees a planet. NULL is ignored.
///
/// # Safety
/// `planet` is NULL or came from this library, is not freed twice, and no thread uses it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_planet_free(planet: *mut TellusPlanet) {
    if !planet.is_null() {
        // SAFETY: the caller's promise.
        let planet = unsafe { Box::from_raw(planet) };
        answer((), || {
            drop(planet);
            Ok(())
        });
    }
}

/// The name of the planet. Valid as long as the planet; NULL if `planet` is NULL.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_name(planet: *const TellusPlanet) -> *const c_char {
    // SAFETY: the caller's promise.
    answer(std::ptr::null(), || Ok(unsafe { valid(planet) }?.name.as_ptr()))
}

/// A hash of all that the planet is, as 32 hexadecimal digits; the same on every machine. Valid as long as the planet.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_hash(planet: *const TellusPlanet) -> *const c_char {
    // SAFETY: the caller's promise.
    answer(std::ptr::null(), || Ok(unsafe { valid(planet) }?.hash.as_ptr()))
}

/// Radius of the reference sphere in metres; NaN if `planet` is NULL.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_radius_m(planet: *const TellusPlanet) -> f64 {
    // SAFETY: the caller's promise.
    answer(f64::NAN, || Ok(unsafe { valid(planet) }?.terrain.planet().radius_m()))
}

/// Number of biomes.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_biome_count(planet: *const TellusPlanet) -> u32 {
    // SAFETY: the caller's promise.
    answer(0, || Ok(unsafe { valid(planet) }?.biomes.len() as u32))
}

/// The name of a biome. Valid as long as the planet; NULL if there is no such biome.
///
/// # Safety
/// `planet` is NULL or a planet of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_biome_name(planet: *const TellusPlanet, biome: u32) -> *const c_char {
    answer(std::ptr::null(), || {
        // SAFETY: the caller's promise.
        let biomes = &unsafe { valid(planet) }?.biomes;
        let found = biomes.get(biome as usize);
        found.map(|name| name.as_ptr()).ok_or_else(|| format!("there is no biome {biome}; there are {}", biomes.len()))
    })
}

/// The unit direction of a place in the planet frame: Z points to the north pole, X to latitude 0 and longitude 0.
/// `lat_deg` is -90 to 90. False, and nothing written, if that failed.
///
/// # Safety
/// `direction` is NULL or holds 3 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_direction(lat_deg: f64, lon_deg: f64, direction: *mut f64) -> bool {
    answer(false, || {
        if !((-90.0..=90.0).contains(&lat_deg) && lon_deg.is_finite()) {
            return Err(format!("{lat_deg},{lon_deg} is no location; use -90 to 90 and a finite number of degrees"));
        }
        // SAFETY: the caller's promise.
        let direction = unsafe { output(direction, 3, "direction") }?;
        direction.copy_from_slice(&LatLon::from_degrees(lat_deg, lon_deg).direction().to_array());
        Ok(true)
    })
}

/// Heights of the ground in metres under `count` directions of 3 numbers each, on the calling thread. False, and
/// nothing written, if that failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `heights_m` is
/// NULL or holds `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_heights(
    planet: *const TellusPlanet,
    directions: *const f64,
    count: usize,
    heights_m: *mut f64,
) -> bool {
    // SAFETY: the caller's promise.
    unsafe { tellus_heights_spaced(planet, directions, count, 0.0, heights_m) }
}

/// As `tellus_heights`, without rivers and valleys of a structure that points `spacing_m` metres apart would not show:
/// far cheaper where points are spread over the planet. 0 is all of them.
///
/// # Safety
/// As for `tellus_heights`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_heights_spaced(
    planet: *const TellusPlanet,
    directions: *const f64,
    count: usize,
    spacing_m: f64,
    heights_m: *mut f64,
) -> bool {
    answer(false, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let (dirs, heights_m) =
            unsafe { (directions_of(directions, count, "directions")?, output(heights_m, count, "heights_m")?) };
        let spacing_rad = spacing_rad(terrain, spacing_m)?;
        SCRATCH.with_borrow_mut(|scratch| terrain.heights_spaced_into(dirs, spacing_rad, heights_m, scratch));
        Ok(true)
    })
}

/// A distance between points as an angle.
fn spacing_rad(terrain: &Terrain, spacing_m: f64) -> Result<f64, String> {
    if spacing_m.is_nan() || spacing_m < 0.0 {
        return Err(format!("spacing_m is {spacing_m}; use a distance in metres, or 0 for all detail"));
    }
    Ok(Detail::SpacingM(spacing_m).spacing_rad(terrain.planet().radius_m()))
}

/// The surface under `count` directions of 3 numbers each, on the calling thread. False, and nothing written, if that
/// failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `directions` is NULL or holds 3 `count` numbers, and `samples` is NULL
/// or holds `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_samples(
    planet: *const TellusPlanet,
    directions: *const f64,
    count: usize,
    samples: *mut TellusSample,
) -> bool {
    // SAFETY: the caller's promise.
    unsafe { tellus_samples_spaced(planet, directions, count, 0.0, samples) }
}

/// As `tellus_samples`, without rivers and valleys of a structure that points `spacing_m` metres apart would not show.
/// 0 is all of them.
///
/// # Safety
/// As for `tellus_samples`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_samples_spaced(
    planet: *const TellusPlanet,
    directions: *const f64,
    count: usize,
    spacing_m: f64,
    samples: *mut TellusSample,
) -> bool {
    answer(false, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let (dirs, samples) =
            unsafe { (directions_of(directions, count, "directions")?, output(samples, count, "samples")?) };
        let spacing_rad = spacing_rad(terrain, spacing_m)?;
        SCRATCH.with_borrow_mut(|scratch| {
            const BATCH: usize = 256;
            let mut found = [crate::terrain::Sample::default(); BATCH];
            for (dirs, samples) in dirs.chunks(BATCH).zip(samples.chunks_mut(BATCH)) {
                // A `TellusSample` has neither a bank nor a curvature.
                let wanted = Wanted::HEIGHT.and_normal().and_biome().and_water();
                terrain.samples_spaced_into(dirs, spacing_rad, wanted, &mut found, scratch);
                for (sample, found) in samples.iter_mut().zip(&found) {
                    *sample = TellusSample::of(found);
                }
            }
        });
        Ok(true)
    })
}

/// Distance in metres along a ray (planet frame, metres from the centre) to the ground or the sea, whichever is nearer:
/// infinite if it meets neither, NaN if that failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `origin_m` and `direction` are NULL or hold 3 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_raycast(
    planet: *const TellusPlanet,
    origin_m: *const f64,
    direction: *const f64,
) -> f64 {
    answer(f64::NAN, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        // SAFETY: the caller's promise.
        let origin_m = DVec3::from_slice(unsafe { input(origin_m, 3, "origin_m") }?);
        // SAFETY: the caller's promise.
        let dir = unsafe { directions_of(direction, 1, "direction") }?[0];
        if !origin_m.is_finite() {
            return Err("origin_m is not finite".to_owned());
        }
        Ok(terrain.raycast(origin_m, dir).unwrap_or(f64::INFINITY))
    })
}

/// The vertices of a square of the globe, `side` by `side`: positions in the planet frame (metres from the centre) and
/// unit normals, 3 numbers each, column by column within rows. Neighbours of one level share their edges to the bit.
///
/// `face` is 0 to 5: +X, -X, +Y, -Y, +Z, -Z. A face has `2^level` by `2^level` squares, `level` 0 to 22. `normals` may
/// be NULL. False, and nothing written, if that failed.
///
/// # Safety
/// `planet` is NULL or a planet of this library; `positions_m` and `normals` are NULL or hold 3 `side` `side` numbers.
#[allow(clippy::too_many_arguments)] // C has no tuples.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_tile(
    planet: *const TellusPlanet,
    face: u32,
    level: u32,
    x: u32,
    y: u32,
    side: u32,
    positions_m: *mut f64,
    normals: *mut f32,
) -> bool {
    answer(false, || {
        // SAFETY: the caller's promise.
        let terrain = &unsafe { valid(planet) }?.terrain;
        let node = node(face, level, x, y)?;
        let side = checked_side(side)?;
        // SAFETY: the caller's promise.
        let positions_m = unsafe { output(positions_m, 3 * side * side, "positions_m") }?;
        let normals = if normals.is_null() {
            None
        } else {
            // SAFETY: the caller's promise.
            Some(unsafe { output(normals, 3 * side * side, "normals") }?)
        };
        let at = |k: usize| k as f64 / (side - 1) as f64;
        let dirs: Vec<DVec3> = (0..side * side).map(|i| node.direction(at(i % side), at(i / side))).collect();
        let wanted = if normals.is_some() { Wanted::HEIGHT.and_normal() } else { Wanted::HEIGHT };
        let samples = terrain.samples(&dirs, wanted);
        let radius_m = terrain.planet().radius_m();
        for ((dir, sample), position) in dirs.iter().zip(&samples).zip(positions_m.as_chunks_mut().0) {
            *position = (*dir * (radius_m + sample.height_m)).to_array();
        }
        if let Some(normals) = normals {
            for (sample, normal) in samples.iter().zip(normals.as_chunks_mut().0) {
                *normal = sample.normal_planet.as_vec3().to_array();
            }
        }
        Ok(true)
    })
}

/// The triangles of a tile of `side` by `side` vertices: 6 (`side` - 1)^2 indices, counter-clockwise from outside.
/// False, and nothing written, if that failed.
///
/// # Safety
/// `indices` is NULL or holds 6 (`side` - 1)^2 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tellus_tile_indices(side: u32, indices: *mut u32) -> bool {
    answer(false, || {
        let cells = checked_side(side)? - 1;
        // SAFETY: the caller's promise.
        let indices = unsafe { output(indices, 6 * cells * cells, "indices") }?;
        for (cell, two) in indices.as_chunks_mut::<6>().0.iter_mut().enumerate() {
            let first = (cell / cells * (cells + 1) + cell % cells) as u32;
            let (right, above) = (first + 1, first + side);
            *two = [first, right, above + 1, first, above + 1, above];
        }
        Ok(true)
    })
}

impl TellusSample {
    fn of(sample: &crate::terrain::Sample) -> Self {
        Self {
            height_m: sample.height_m,
            water_level_m: sample.water_level_m.unwrap_or(f64::NAN),
            normal: sample.normal_planet.to_array(),
            slope_rad: sample.slope_rad,
            temperature_c: sample.temperature_c,
            rain_mm: sample.rain_mm,
            biome: sample.biome as u32,
        }
    }
}

fn ready(planet: Planet, cache_folder: Option<&str>) -> Result<*mut TellusPlanet, String> {
    // A name may hold a zero byte, which ends a text in C.
    let c_text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
    let name = c_text(&planet.name);
    let hash = c_text(&format!("{:032x}", Key::of_planet(&planet).bits()));
    let biomes = planet.biomes.palette.iter().map(|biome| c_text(&biome.name)).collect();
    let populations = planet.life.iter().map(|population| c_text(&population.name)).collect();
    let store = cache_folder.map(|folder| Arc::new(MapStore::new(folder, CACHE_BYTES)));
    let terrain = Terrain::load(planet.into(), store, &|_| true).map_err(|error| error.to_string())?;
    let terrain = Arc::new(terrain.ok_or("loading stopped")?);
    Ok(Box::into_raw(Box::new(TellusPlanet { terrain, clouds: OnceLock::new(), name, hash, biomes, populations })))
}

/// # Safety
/// `planet` is NULL or a planet of this library that outlives the answer.
unsafe fn valid<'a>(planet: *const TellusPlanet) -> Result<&'a TellusPlanet, String> {
    // SAFETY: the caller's promise.
    unsafe { planet.as_ref() }.ok_or_else(|| "planet is NULL".to_owned())
}

/// # Safety
/// `numbers` is NULL or holds 3 `count` numbers that outlive the answer.
unsafe fn directions_of<'a>(numbers: *const f64, count: usize, name: &str) -> Result<&'a [DVec3], String> {
    const { assert!(size_of::<DVec3>() == 24 && align_of::<DVec3>() == align_of::<f64>()) };
    // SAFETY: three numbers lie in memory as a vector does; the caller's promise.
    let dirs: &[DVec3] = unsafe { input(numbers.cast(), count, name) }?;
    match dirs.iter().position(|dir| !dir.is_finite() || *dir == DVec3::ZERO) {
        Some(index) => Err(format!("{name}: vector {index} is zero or not finite; use a direction of any length")),
        None => Ok(dirs),
    }
}

fn node(face: u32, level: u32, x: u32, y: u32) -> Result<NodeId, String> {
    let face = Face::ALL.get(face as usize).ok_or_else(|| format!("face is {face}; use 0 to 5"))?;
    if level > u32::from(NodeId::MAX_LEVEL) {
        return Err(format!("level is {level}; use 0 to {}", NodeId::MAX_LEVEL));
    }
    let most = (1 << level) - 1;
    if x > most || y > most {
        return Err(format!("x and y are {x} and {y}; at level {level} they go from 0 to {most}"));
    }
    Ok(NodeId { level: level as u8, face: *face, x, y })
}

fn checked_side(side: u32) -> Result<usize, String> {
    if (2..=TELLUS_MAX_TILE_SIDE).contains(&side) {
        Ok(side as usize)
    } else {
        Err(format!("side is {side}; use 2 to {TELLUS_MAX_TILE_SIDE}"))
    }
}
