//! Time and memory of ten thousand strokes all over a planet: full rebuilds of views near and far, with the strokes and
//! without, and the time from one stroke more to its tiles and to its picture. Once on a planet of one layer, which is
//! the worst case, and once on a shipped planet.

use super::super::headless::Gpu;
use super::edits::Bench;
use super::{median, p95, repeat};
use crate::lod::{Camera, Quality, View};
use crate::planet::edits::{EditPoint, GroundEdit, Raise, Tool};
use crate::planet::{Fbm, Layer, Planet, Shape};
use crate::render::{Renderer, Reuse, Scene};
use crate::sphere::geo::{self, east_north};
use crate::sphere::{LatLon, NodeId};
use crate::terrain::Terrain;
use crate::tiles::{DEFAULT_BUDGET_BYTES, Surface, build_now};
use glam::DVec3;
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Instant;

/// Strokes on the planet.
const STROKES: usize = 10_000;
/// Points of each stroke, and the distance between them in radii of the planet.
const POINTS: usize = 10;
const STEP_RAD: f64 = 0.004;
/// Radius of a stroke, in radii of the planet: strokes cover six tenths of it.
const RADIUS_RAD: f64 = 0.008;
/// Height of the eye over the ground in each view, in radii of the planet.
/// The third sees about a hundred strokes.
const ALTITUDES: [f64; 4] = [0.035, 0.15, 0.235, 0.4];
/// Sizes of the pictures that strokes are drawn in. The pixels of the small one take a software driver little time: it
/// shows what a stroke takes beside them.
const PICTURE_PX: [u32; 2] = [640, 360];
const SMALL_PX: [u32; 2] = [64, 36];
/// Strokes that are added one after the other, and how often the planet is saved.
const RUNS: usize = 30;
const SAVES: usize = 5;

/// The `sculpt` list of the report. `shipped`: a shipped planet, and the name of its preset.
pub(super) fn measure((file, shipped): (&str, &Arc<Planet>)) -> Result<Value, String> {
    Ok(json!([measure_on("one layer", &one_layer())?, measure_on(file, shipped)?]))
}

fn measure_on(name: &str, bare: &Planet) -> Result<Value, String> {
    let invalid = |error: crate::planet::InvalidPlanet| error.to_string();
    let bare = Arc::new(Planet { edits: Default::default(), ..bare.clone() });
    let before_mb = resident_mb();
    let many = Arc::new(Planet { edits: strokes(bare.radius_km).into_iter().collect(), ..Planet::clone(&bare) });
    let terrain = Terrain::try_new(many.clone()).map_err(invalid)?;
    let after_mb = resident_mb();
    drop(terrain);

    let mut views = Vec::new();
    for altitude in ALTITUDES {
        let view = view(&bare, altitude);
        let surface = build_now(&many, &view).map_err(invalid)?;
        let bare_surface = build_now(&bare, &view).map_err(invalid)?;
        let full = |planet: &Arc<Planet>| repeat(|| drop(build_now(planet, &view)));
        let (with, without) = (median(&full(&many)), median(&full(&bare)));
        views.push(json!({
            "altitude_m": altitude * bare.radius_m(),
            "strokes_in_view": in_view(&many, &surface),
            "tiles": surface.stats.tiles,
            "tiles_without": bare_surface.stats.tiles,
            "full_ms": with,
            "full_ms_without": without,
            "ratio": with.zip(without).map(|(with, without)| with / without),
        }));
    }

    let (bench, view) = (Bench::new(DEFAULT_BUDGET_BYTES), view(&bare, ALTITUDES[1]));
    bench.settle(&many, &view);
    let (mut times, mut compile_ms) = (Vec::new(), Vec::new());
    for edited in one_more(&many) {
        let Some(([_, secs], stats)) = bench.settle(&edited, &view) else { continue };
        times.push(secs * 1000.0);
        compile_ms.push(stats.compile_secs * 1000.0);
    }
    times.sort_by(f64::total_cmp);
    compile_ms.sort_by(f64::total_cmp);
    let picture_ms = to_picture_ms(&many, view, PICTURE_PX);
    let small_ms = to_picture_ms(&many, view, SMALL_PX);
    let (save_ms, load_ms) = save_and_load_ms(&many)?;
    Ok(json!({
        "planet": name,
        "strokes": STROKES,
        "views": views,
        "stroke_ms": median(&times),
        "stroke_ms_p95": p95(&times),
        "stroke_compile_ms": median(&compile_ms),
        "stroke_picture_ms": picture_ms.map(|[stroke, _]| stroke),
        "still_picture_ms": picture_ms.map(|[_, still]| still),
        "stroke_small_picture_ms": small_ms.map(|[stroke, _]| stroke),
        "still_small_picture_ms": small_ms.map(|[_, still]| still),
        "file_mb": many.to_text().len() as f64 / 1e6,
        "save_ms": save_ms,
        "load_ms": load_ms,
        "memory_mb": after_mb.zip(before_mb).map(|(after, before)| after - before),
    }))
}

/// Milliseconds of saving the planet with one stroke more, and of loading it: medians.
fn save_and_load_ms(many: &Planet) -> Result<(Option<f64>, Option<f64>), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let path = folder.path().join("many.ron");
    let (mut saves, mut loads) = (Vec::new(), Vec::new());
    for edited in one_more(many).take(SAVES) {
        let start = Instant::now();
        edited.save(&path).map_err(|error| error.to_string())?;
        saves.push(start.elapsed().as_secs_f64() * 1000.0);
        let start = Instant::now();
        Planet::load(&path).map_err(|error| error.to_string())?;
        loads.push(start.elapsed().as_secs_f64() * 1000.0);
    }
    saves.sort_by(f64::total_cmp);
    loads.sort_by(f64::total_cmp);
    Ok((median(&saves), median(&loads)))
}

/// The planet with one stroke more, which grows as one does under the hand.
fn one_more(planet: &Planet) -> impl Iterator<Item = Arc<Planet>> {
    let strokes = (0..RUNS).map(|run| stroke(planet.radius_km, middle().direction(), 0.02 * run as f64, 2));
    strokes.map(|stroke| {
        let mut edited = planet.clone();
        edited.edits.push(stroke);
        Arc::new(edited)
    })
}

/// Milliseconds from one stroke more to its picture, and those of a picture in which nothing changed: medians. `None`
/// without a GPU.
fn to_picture_ms(many: &Arc<Planet>, view: View, size_px: [u32; 2]) -> Option<[f64; 2]> {
    let gpu = Gpu::open(size_px).ok()?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).ok()?;
    let view = View { size_px, quality: Quality::Low, ..view };
    let bench = Bench::new(DEFAULT_BUDGET_BYTES);
    let mut picture_secs = |planet: &Arc<Planet>| {
        let start = Instant::now();
        let (_, surface) = bench.settle(planet, &view).and_then(|(secs, _)| Some((secs, bench.surface()?)))?;
        let scene =
            Scene { reuse: Reuse::None, ..Scene::of_planet(&surface, view, planet.star.place(0.0).direction()) };
        let drawn =
            gpu.picture(size_px, |target| renderer.render(target, &scene).map(drop).map_err(|error| error.to_string()));
        drawn.ok().map(|_| start.elapsed().as_secs_f64())
    };
    // The first picture uploads and builds everything.
    picture_secs(many)?;
    let (mut strokes, mut still) = (Vec::new(), Vec::new());
    for edited in one_more(many) {
        strokes.push(picture_secs(&edited)? * 1000.0);
        still.push(picture_secs(&edited)? * 1000.0);
    }
    [&mut strokes, &mut still].into_iter().for_each(|times| times.sort_by(f64::total_cmp));
    Some([median(&strokes)?, median(&still)?])
}

fn one_layer() -> Planet {
    let layer = Layer {
        amplitude_m: 400.0,
        shape: Shape::Fbm(Fbm { wavelength_km: 300.0, octaves: 12, ..Fbm::default() }),
        ..Layer::default()
    };
    Planet { radius_km: 1000.0, layers: vec![layer], ..Planet::default() }
}

fn middle() -> LatLon {
    LatLon::from_degrees(12.0, -70.0)
}

fn view(planet: &Planet, altitude: f64) -> View {
    let camera = Camera::over(middle(), planet.radius_m() * (1.0 + altitude), 0.3, -1.4, Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px: [1280, 800], quality: Quality::Medium }
}

fn strokes(planet_km: f64) -> Vec<GroundEdit> {
    let spread = geo::spread(STROKES).enumerate();
    // Headings by the golden angle: no two neighbours run alike.
    spread.map(|(number, dir)| stroke(planet_km, dir, 2.399_963 * number as f64, POINTS)).collect()
}

/// A stroke that bends a little.
fn stroke(planet_km: f64, from: DVec3, heading_rad: f64, points: usize) -> GroundEdit {
    let (east, north) = east_north(from);
    let point = |step: usize| {
        let (heading_rad, away_rad) = (heading_rad + 0.05 * step as f64, step as f64 * STEP_RAD);
        let along = east * libm::sin(heading_rad) + north * libm::cos(heading_rad);
        EditPoint::under((from * libm::cos(away_rad) + along * libm::sin(away_rad)).normalize())
    };
    let tool = Tool::Raise(Raise { amount_m: 100.0 });
    GroundEdit {
        tool,
        radius_km: RADIUS_RAD * planet_km,
        points: (0..points).map(point).collect(),
        ..GroundEdit::default()
    }
}

/// Strokes with a point on a tile of the surface that the camera sees.
fn in_view(planet: &Planet, surface: &Surface) -> usize {
    let leaves: std::collections::HashSet<NodeId> = surface.leaves.iter().map(|leaf| leaf.tile.id).collect();
    let levels: std::collections::BTreeSet<u8> = leaves.iter().map(|id| id.level).collect();
    let camera = &surface.view.camera;
    let aspect = f64::from(surface.view.size_px[0]) / f64::from(surface.view.size_px[1]);
    let is_seen = |point: &EditPoint| {
        let dir = point.direction();
        let is_drawn = levels.iter().any(|level| leaves.contains(&NodeId::containing(dir, *level)));
        let place_m = dir * planet.radius_m();
        let is_drawn = is_drawn && place_m.dot(camera.position_planet_m - place_m) > 0.0;
        let at = camera.planet_from_view.inverse() * (place_m - camera.position_planet_m);
        let half = -at.z * (0.5 * camera.fov_y_rad).tan();
        is_drawn && at.z < 0.0 && at.y.abs() <= half && at.x.abs() <= half * aspect
    };
    planet.edits.iter().filter(|edit| edit.points.0.iter().any(is_seen)).count()
}

/// Resident size of this process now, where the system tells.
fn resident_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}
