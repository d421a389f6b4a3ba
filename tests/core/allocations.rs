//! Queries allocate nothing once the scratch of their thread has grown.

use glam::DVec3;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use tellus::planet::shipped;
use tellus::sphere::spread;
use tellus::terrain::{Sample, Scratch, Terrain, Wanted};

/// The system's allocator, which counts for threads that ask for it.
struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

thread_local! {
    /// Allocations of this thread since it began to count, if it does.
    static COUNT: Cell<Option<usize>> = const { Cell::new(None) };
}

fn count() {
    // A thread that is ending counts no more.
    let _ = COUNT.try_with(|count| count.set(count.get().map(|n| n + 1)));
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as the caller promised.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as the caller promised.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as the caller promised.
        unsafe { System.dealloc(block, layout) }
    }
}

/// How often this thread allocates while something runs.
fn allocations<T>(run: impl FnOnce() -> T) -> usize {
    COUNT.set(Some(0));
    let answer = run();
    let count = COUNT.replace(None).unwrap();
    drop(answer);
    count
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| std::hint::black_box(vec![1_u8; 100])), 1);
    assert_eq!(allocations(|| std::hint::black_box(1)), 0);
}

#[test]
fn queries_allocate_nothing_after_the_first() {
    let dirs: Vec<DVec3> = spread(600).collect();
    // Rivers build blocks of cells where nobody has been: see the next test.
    let all = shipped::ALL.iter().map(|shipped| (shipped.file, shipped.load().unwrap()));
    for (file, planet) in all.filter(|(_, planet)| planet.structure.is_none()) {
        let planet = Arc::new(planet);
        let terrain = Terrain::try_new(planet.clone()).unwrap();
        let (mut heights_m, mut samples) = (vec![0.0; dirs.len()], vec![Sample::default(); dirs.len()]);
        let mut scratch = Scratch::default();
        let mut ask = |singles: &[DVec3]| {
            for &dir in singles {
                let eye_m = dir * (planet.radius_m() + terrain.height_m(dir).max(0.0) + 50.0);
                terrain.sample(dir);
                terrain.raycast(eye_m, dir.any_orthonormal_vector() - dir);
                terrain.raycast_with(eye_m, -dir, &mut scratch);
            }
            terrain.heights_into(&dirs, &mut heights_m, &mut scratch).unwrap();
            terrain.samples_into(&dirs, Wanted::ALL, &mut samples, &mut scratch).unwrap();
        };
        // Every layer is met by one of the directions, so that all memory has grown.
        ask(&dirs);
        assert_eq!(allocations(|| ask(&dirs[..100])), 0, "{file}");
    }
}

/// Rivers keep the blocks of cells around the last points. Points in the same blocks need no memory.
#[test]
fn queries_of_rivers_allocate_nothing_where_they_have_been() {
    let terrain = Terrain::try_new(crate::water::planet().into()).unwrap();
    let rivers = terrain.rivers(50.0);
    let middle = rivers.courses[0].points[rivers.courses[0].points.len() / 2].place.direction();
    let dirs: Vec<DVec3> = spread(100).map(|dir| (middle + dir * 1e-3).normalize()).collect();
    let mut samples = vec![Sample::default(); dirs.len()];
    let mut scratch = Scratch::default();
    let mut ask = || {
        terrain.samples_into(&dirs, Wanted::ALL, &mut samples, &mut scratch).unwrap();
        for dir in &dirs[..20] {
            terrain.sample(*dir);
        }
    };
    ask();
    assert_eq!(allocations(&mut ask), 0);
    assert!(samples.iter().any(|sample| sample.river.is_some()));
}
