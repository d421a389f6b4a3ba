//! The functions, called as C calls them.

use super::*;
use crate::planet::shipped;
use std::ffi::CStr;

pub(super) struct Held(pub(super) *mut TellusPlanet);

impl Drop for Held {
    fn drop(&mut self) {
        // SAFETY: it came from the library, and this is its end.
        unsafe { tellus_planet_free(self.0) };
    }
}

pub(super) fn error() -> String {
    // SAFETY: the text is valid until the next failure on this thread.
    unsafe { CStr::from_ptr(tellus_last_error()) }.to_str().unwrap().to_owned()
}

pub(super) fn load(text: &str) -> *mut TellusPlanet {
    let text = CString::new(text).unwrap();
    // SAFETY: both texts end with a zero byte.
    unsafe { tellus_planet_from_text(c"test.ron".as_ptr(), text.as_ptr(), std::ptr::null()) }
}

fn preset() -> &'static shipped::Shipped {
    shipped::ALL.iter().find(|preset| preset.file == "pallor.ron").unwrap()
}

fn pallor() -> Held {
    Held(load(preset().text))
}

#[test]
fn answers_are_those_of_the_evaluator() {
    let planet = pallor();
    let terrain = Terrain::try_new(preset().load().unwrap().into()).unwrap();
    let dirs: Vec<DVec3> = crate::sphere::spread(700).collect();
    let numbers: Vec<f64> = dirs.iter().flat_map(DVec3::to_array).collect();
    let mut heights_m = vec![0.0; dirs.len()];
    let mut samples = vec![TellusSample::of(&crate::terrain::Sample::default()); dirs.len()];
    // SAFETY: the buffers are as long as they are said to be.
    unsafe {
        assert!(tellus_heights(planet.0, numbers.as_ptr(), dirs.len(), heights_m.as_mut_ptr()));
        assert!(tellus_samples(planet.0, numbers.as_ptr(), dirs.len(), samples.as_mut_ptr()));
        assert_eq!(tellus_radius_m(planet.0), terrain.planet().radius_m());
        assert_eq!(CStr::from_ptr(tellus_name(planet.0)).to_str().unwrap(), terrain.planet().name);
        assert_eq!(CStr::from_ptr(tellus_hash(planet.0)).to_bytes().len(), 32);
        assert_eq!(tellus_biome_count(planet.0) as usize, terrain.planet().biomes.palette.len());
    }
    assert_eq!(heights_m, terrain.heights_m(&dirs));
    for (sample, found) in samples.iter().zip(terrain.samples(&dirs, Wanted::ALL)) {
        assert_eq!((sample.height_m, sample.biome as usize), (found.height_m, found.biome));
        assert_eq!((sample.normal, sample.temperature_c), (found.normal_planet.to_array(), found.temperature_c));
        assert_eq!(sample.water_level_m.is_nan(), found.water_level_m.is_none());
    }
    let above = dirs[3] * (terrain.planet().radius_m() + heights_m[3] + 1000.0);
    // SAFETY: both hold 3 numbers.
    let distance_m = unsafe { tellus_raycast(planet.0, above.to_array().as_ptr(), (-dirs[3]).to_array().as_ptr()) };
    assert!((distance_m - 1000.0).abs() < 1e-3, "{distance_m}");
}

#[test]
fn tiles_share_edges_and_their_triangles_face_outwards() {
    const SIDE: usize = 9;
    let planet = pallor();
    let tile = |face, x| {
        let (mut positions_m, mut normals) = ([[0.0; 3]; SIDE * SIDE], [[0.0; 3]; SIDE * SIDE]);
        let (to, normals_to) = (positions_m.as_mut_ptr().cast(), normals.as_mut_ptr().cast());
        // SAFETY: the buffers hold the vertices of a tile.
        assert!(unsafe { tellus_tile(planet.0, face, 3, x, 2, SIDE as u32, to, normals_to) });
        (positions_m.map(DVec3::from_array), normals.map(glam::Vec3::from_array))
    };
    let mut indices = [0_u32; 6 * (SIDE - 1) * (SIDE - 1)];
    // SAFETY: the buffer holds the indices of a tile.
    assert!(unsafe { tellus_tile_indices(SIDE as u32, indices.as_mut_ptr()) });
    for face in 0..6 {
        let ((left, normals), (right, _)) = (tile(face, 4), tile(face, 5));
        for row in 0..SIDE {
            assert_eq!(left[row * SIDE + SIDE - 1], right[row * SIDE]);
        }
        for triangle in indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|index| left[index as usize]);
            assert!((b - a).cross(c - a).dot(a) > 0.0, "face {face}");
        }
        assert!(left.iter().zip(&normals).all(|(at, normal)| at.as_vec3().dot(*normal) > 0.0));
    }
}

#[test]
fn what_cannot_be_done_is_told_and_leaves_the_buffers_alone() {
    assert!(load("(version: 1, name: \"X\", radius_km: -3.0)").is_null());
    assert!(error().starts_with("test.ron:1:") && error().contains("radius_km"), "{}", error());
    let planet = pallor();
    let mut heights_m = [7.0; 2];
    let mut ask = |planet: *const TellusPlanet, dirs: *const f64, count: usize, to_nowhere: bool| {
        let to = if to_nowhere { std::ptr::null_mut() } else { heights_m.as_mut_ptr() };
        // SAFETY: what is not NULL is as long as it is said to be, or said to be impossibly long.
        let is_done = unsafe { tellus_heights(planet, dirs, count, to) };
        assert!(!is_done && heights_m == [7.0; 2]);
        error()
    };
    let (up, bad) = ([0.0, 0.0, 1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, f64::NAN, 0.0, 0.0]);
    assert_eq!(ask(std::ptr::null(), up.as_ptr(), 2, false), "planet is NULL");
    assert_eq!(ask(planet.0, std::ptr::null(), 2, false), "directions is NULL");
    assert_eq!(ask(planet.0, up.as_ptr(), 2, true), "heights_m is NULL");
    assert_eq!(
        ask(planet.0, bad.as_ptr(), 2, false),
        "directions: vector 1 is zero or not finite; use a direction of any length"
    );
    assert!(ask(planet.0, up.as_ptr(), usize::MAX / 2, false).contains("cannot hold"));
    // SAFETY: NULL is refused, and a direction that is refused is not read.
    let is_nan = |from: *const f64| unsafe { tellus_raycast(planet.0, from, std::ptr::null()) }.is_nan();
    assert!(is_nan(std::ptr::null()) && error() == "origin_m is NULL", "{}", error());
    assert!(is_nan(up.as_ptr()) && error() == "direction is NULL", "{}", error());
    for (lat_deg, lon_deg) in [(f64::NAN, 0.0), (91.0, 0.0), (0.0, f64::INFINITY)] {
        let mut direction = [7.0; 3];
        // SAFETY: the buffer holds 3 numbers.
        assert!(!unsafe { tellus_direction(lat_deg, lon_deg, direction.as_mut_ptr()) } && direction == [7.0; 3]);
        assert!(error().contains("is no location; use -90 to 90"), "{}", error());
    }
    let mut room = [0.0; 12];
    // SAFETY: the buffer is large enough for a side of 2; other sides are refused.
    let mut tile = |face, level, x, side| unsafe {
        assert!(!tellus_tile(planet.0, face, level, x, 0, side, room.as_mut_ptr(), std::ptr::null_mut()));
        error()
    };
    assert_eq!(tile(6, 0, 0, 2), "face is 6; use 0 to 5");
    assert_eq!(tile(0, 23, 0, 2), "level is 23; use 0 to 22");
    assert_eq!(tile(0, 1, 2, 2), "x and y are 2 and 0; at level 1 they go from 0 to 1");
    assert_eq!(tile(0, 1, 1, 1), "side is 1; use 2 to 4097");
    // SAFETY: a planet of the library.
    assert!(unsafe { tellus_biome_name(planet.0, 10_000) }.is_null() && error().contains("no biome 10000"));
    let failed = answer(3, || -> Result<i32, String> { panic!("as asked") });
    assert!(failed == 3 && error().contains("please report"));
}

fn from_file(file: &str) -> (Held, Terrain) {
    let preset = shipped::ALL.iter().find(|preset| preset.file == file).unwrap();
    (Held(load(preset.text)), Terrain::try_new(preset.load().unwrap().into()).unwrap())
}

#[test]
fn clouds_and_water_at_a_time_are_those_of_the_library() {
    let (planet, terrain) = from_file("maren.ron");
    let dirs: Vec<DVec3> = crate::sphere::spread(40).collect();
    let numbers: Vec<f64> = dirs.iter().flat_map(DVec3::to_array).collect();
    let mut clouds = vec![moving::TellusClouds { low: -1.0, middle: -1.0, veil: -1.0, fog: -1.0 }; dirs.len()];
    // SAFETY: the buffers are as long as they are said to be.
    assert!(unsafe { moving::tellus_clouds(planet.0, numbers.as_ptr(), dirs.len(), 5000.0, clouds.as_mut_ptr()) });
    let field = CloudField::new(&terrain);
    for (dir, clouds) in dirs.iter().zip(&clouds) {
        let found = field.cover(*dir, 5000.0);
        assert_eq!(
            (clouds.low, clouds.middle, clouds.veil, clouds.fog),
            (found.low, found.middle, found.veil, found.fog)
        );
    }
    let sea_m = terrain.planet().sea_level_m().unwrap();
    let (mut at_sea, mut moved) = (0, 0);
    for dir in &dirs {
        let mut heights_m = [[0.0; 2]; 2];
        for (time_s, heights_m) in [100.0, 103.0].into_iter().zip(&mut heights_m) {
            let twice = [dir.to_array(), (*dir * 2.0).to_array()];
            // SAFETY: both buffers hold what two directions take.
            assert!(unsafe {
                moving::tellus_water(planet.0, twice.as_ptr().cast(), 2, time_s, heights_m.as_mut_ptr())
            });
        }
        let [[first_m, same_m], [later_m, _]] = heights_m;
        let is_sea = terrain.height_m(*dir) < sea_m;
        assert_eq!(first_m.is_nan(), !is_sea);
        if is_sea {
            assert!((first_m - same_m).abs() < 1e-6 && (first_m - sea_m).abs() < 60.0, "{first_m}");
            at_sea += 1;
            moved += i32::from(first_m != later_m);
        }
    }
    assert!(at_sea > 10 && moved * 2 > at_sea, "{moved} of {at_sea}");
    // SAFETY: the function refuses before it reads.
    assert!(!unsafe { moving::tellus_water(planet.0, numbers.as_ptr(), 1, f64::NAN, [0.0].as_mut_ptr()) });
    assert!(error().contains("time_s"));
}

#[test]
fn chunks_and_sweeps_are_those_of_the_library() {
    let (planet, terrain) = from_file("pallor.ron");
    let dir = LatLon::from_degrees(12.0, 34.0).direction();
    let mut positions_m = vec![[0.0_f32; 3]; 81];
    // SAFETY: the buffer holds 9 by 9 vertices.
    assert!(unsafe {
        let at = dir.to_array();
        let positions_m = positions_m.as_mut_ptr().cast();
        moving::tellus_chunk(planet.0, at.as_ptr(), 100.0, 8, -2, 3, positions_m, std::ptr::null_mut())
    });
    let grid = crate::terrain::ChunkGrid::on_ground(&terrain, dir, 100.0, 8);
    let chunk = grid.chunk(&terrain, [-2, 3], &mut Scratch::default());
    assert!(chunk.positions_m.iter().zip(&positions_m).all(|(wanted, found)| wanted.to_array() == *found));
    let start_m = dir * (terrain.planet().radius_m() + terrain.height_m(dir) + 500.0);
    let ends_m = [start_m.to_array(), start_m.to_array()];
    let motion_m = (dir * -1000.0).to_array();
    let mut contact = moving::TellusContact { share: -1.0, gap_m: 0.0, point_m: [0.0; 3], normal: [0.0; 3] };
    let mut sweep = |radius_m: f64, motion_m: [f64; 3]| {
        // SAFETY: the buffers hold 6, 3 and one.
        unsafe {
            moving::tellus_sweep(planet.0, ends_m.as_ptr().cast(), radius_m, motion_m.as_ptr(), 0.0, &raw mut contact)
        }
    };
    assert_eq!(sweep(0.0, motion_m), -1);
    assert_eq!(sweep(2.0, motion_m.map(|along| -along)), 0);
    assert_eq!(sweep(2.0, motion_m), 1);
    let wanted = terrain.sweep(&crate::terrain::Capsule::sphere(start_m, 2.0), dir * -1000.0).unwrap();
    assert_eq!((contact.share, contact.point_m), (wanted.share, wanted.contact.point_planet_m.to_array()));
}

/// A planet on the threads of a test: the library promises that any number may ask.
struct Shared(*mut TellusPlanet);

// SAFETY: the planet is not freed before the threads have ended, and its functions may be called from any thread.
unsafe impl Sync for Shared {}

#[test]
fn many_threads_ask_at_once_and_get_the_same_answers() {
    for file in ["maren.ron", "aurel.ron"] {
        stress(file);
    }
}

/// Sixteen threads begin at once, so that they meet in what is made at the first call: clouds, and blocks of rivers.
fn stress(file: &str) {
    let (planet, terrain) = from_file(file);
    let shared = &Shared(planet.0);
    let dirs: Vec<DVec3> = crate::sphere::spread(64).collect();
    let wanted_m = terrain.heights_m(&dirs);
    let field = CloudField::new(&terrain);
    let wanted_cover: Vec<f64> = dirs.iter().map(|dir| field.cover(*dir, 0.0).low).collect();
    let start = std::sync::Barrier::new(16);
    std::thread::scope(|scope| {
        for thread in 0..16_usize {
            let (dirs, wanted_m, wanted_cover, start) = (&dirs, &wanted_m, &wanted_cover, &start);
            let radius_m = terrain.planet().radius_m();
            scope.spawn(move || {
                start.wait();
                for round in 0..8 {
                    let (mut height_m, mut clouds) = ([f64::NAN], [[f64::NAN; 4]]);
                    let i = (thread * 7 + round * 13) % dirs.len();
                    let at = dirs[i].to_array();
                    // SAFETY: the buffers hold what one direction takes.
                    unsafe {
                        assert!(tellus_heights(shared.0, at.as_ptr(), 1, height_m.as_mut_ptr()));
                        assert!(moving::tellus_clouds(shared.0, at.as_ptr(), 1, 0.0, clouds.as_mut_ptr().cast()));
                        let above_m = (dirs[i] * (radius_m + wanted_m[i].max(0.0) + 800.0)).to_array();
                        let down = (-dirs[i]).to_array();
                        let away_m = tellus_raycast(shared.0, above_m.as_ptr(), down.as_ptr());
                        assert!((away_m - 800.0).abs() < 1.0, "{away_m}");
                        let mut vertices_m = [[0.0_f64; 3]; 25];
                        let to = vertices_m.as_mut_ptr().cast();
                        assert!(tellus_tile(shared.0, (i % 6) as u32, 3, 2, 5, 5, to, std::ptr::null_mut()));
                        assert!(vertices_m.iter().all(|at| at.iter().all(|c| c.is_finite())));
                        // Errors belong to the thread that made them.
                        assert!(tellus_biome_name(shared.0, 1000 + thread as u32).is_null());
                    }
                    assert!(error().contains(&format!("no biome {};", 1000 + thread)), "{}", error());
                    assert_eq!(height_m[0], wanted_m[i]);
                    assert_eq!(clouds[0][0], wanted_cover[i]);
                }
            });
        }
    });
}
