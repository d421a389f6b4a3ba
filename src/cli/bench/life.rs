//! The cost of life on the ground: meshes, places, what a view keeps, and frames with and without it.

use super::super::headless::Gpu;
use super::super::{maps, tell};
use super::frames::{QUALITIES, SIZE_PX};
use super::{median, repeat};
use crate::life::{Canopies, Model, Scenery};
use crate::lod::{Camera, Quality, View};
use crate::planet::Planet;
use crate::render::{FrameStats, Renderer, Scene};
use crate::sphere::{LatLon, spread};
use crate::terrain::Terrain;
use crate::tiles::{Surface, add_detail, build_over};
use glam::DVec3;
use serde_json::{Value, json};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// Directions of which the one with the most cover is measured.
const PLACES: usize = 4000;
/// Radius of the region whose objects are placed.
const REGION_M: f64 = 250.0;
/// Heights of the eye above the ground, and its pitch.
const EYES: [(f64, f64); 2] = [(2.0, 0.0), (300.0, -0.25)];

/// `models_ms`: all meshes of the planet, on all cores; `covers_ms`: what their canopies need. `frames`: a list as of
/// the part frames. The rest is as in [`placing`].
pub(super) fn measure(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = terrain(planet)?;
    let models_ms = median(&repeat(|| {
        for population in planet.life.iter().filter(|population| population.enabled) {
            black_box(Model::new(population));
        }
    }));
    let mut canopies = Canopies::new(&terrain);
    let covers_ms = median(&repeat(|| canopies = Canopies::new(&terrain)));
    let dir = most_covered(&terrain, &canopies);
    let mut report = placing_at(&terrain, dir)?;
    report["models_ms"] = json!(models_ms);
    report["covers_ms"] = json!(covers_ms);
    report["frames"] = json!(frames(&terrain, dir));
    Ok(report)
}

/// `placed_per_s_core`: objects that one core places in a second, on ground that is not known; `again_per_s_core`: the
/// same when its rivers are.
pub(super) fn placing(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = terrain(planet)?;
    placing_at(&terrain, most_covered(&terrain, &Canopies::new(&terrain)))
}

fn terrain(planet: &Arc<Planet>) -> Result<Arc<Terrain>, String> {
    let terrain = Terrain::load(planet.clone(), maps::kept(), &|_| true).map_err(|error| error.to_string())?;
    terrain.map(Arc::new).ok_or_else(|| "world maps are not solved".to_owned())
}

fn placing_at(terrain: &Terrain, dir: DVec3) -> Result<Value, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|error| error.to_string())?;
    let place = || pool.install(|| terrain.instances(dir, REGION_M)).map(|found| found.len());
    let begun = Instant::now();
    let objects = place().map_err(|error| error.to_string())?;
    let placed_s = begun.elapsed().as_secs_f64();
    let again_ms = median(&repeat(|| {
        let _ = black_box(place());
    }));
    let (latitude_deg, longitude_deg) = LatLon::from_direction(dir).to_degrees();
    Ok(json!({
        "planet": terrain.planet().name,
        "latitude_deg": latitude_deg,
        "longitude_deg": longitude_deg,
        "objects": objects,
        "placed_per_s_core": objects as f64 / placed_s,
        "again_per_s_core": again_ms.map(|again_ms| objects as f64 / again_ms * 1000.0),
    }))
}

/// The direction, of many, where objects cover most of the ground.
fn most_covered(terrain: &Terrain, canopies: &Canopies) -> DVec3 {
    let covers = spread(PLACES).map(|dir| (canopies.at(dir, &terrain.sample(dir)).cover, dir));
    covers.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(DVec3::Z, |(_, dir)| dir)
}

/// Frames over a place at each quality and from each height. `None` without a GPU.
fn frames(terrain: &Arc<Terrain>, dir: DVec3) -> Option<Value> {
    let gpu = Gpu::open(SIZE_PX).ok()?;
    let eyes = QUALITIES.iter().flat_map(|quality| EYES.map(|eye| (quality, eye)));
    let measured: Option<Vec<Value>> =
        eyes.map(|((name, quality), eye)| frame(&gpu, terrain, dir, (name, *quality), eye)).collect();
    Some(json!(measured?))
}

fn frame(
    gpu: &Gpu,
    terrain: &Arc<Terrain>,
    dir: DVec3,
    (name, quality): (&str, Quality),
    (height_m, pitch_rad): (f64, f64),
) -> Option<Value> {
    let planet = terrain.planet();
    let eye_m = planet.radius_m() + terrain.height_m(dir) + height_m;
    let camera = Camera::over(LatLon::from_direction(dir), eye_m, 0.0, pitch_rad, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: SIZE_PX, quality };
    let mut surface = build_over(terrain, &view);
    let begun = Instant::now();
    add_detail(&mut surface, &view);
    let detail_ms = begun.elapsed().as_secs_f64() * 1000.0;
    let (frame_ms, stats) = frame_of(gpu, &surface, view)?;
    let (objects, cells) = (surface.scenery.object_count(), surface.scenery.cells.len());
    surface.scenery = Scenery::default();
    let (bare_ms, bare) = frame_of(gpu, &surface, view)?;
    let times_bare = frame_ms / bare_ms;
    // All views together take minutes on a software driver.
    tell(&format!("life: {name}, {height_m} m: {frame_ms:.0} ms, {times_bare:.2} times a bare ground"));
    Some(json!({
        "quality": name,
        "height_m": height_m,
        "detail_ms": detail_ms,
        "frame_ms": frame_ms,
        "objects_ms": frame_ms - bare_ms,
        "times_bare": times_bare,
        "kept": objects,
        "cells": cells,
        "drawn": stats.objects_drawn,
        "triangles": stats.triangles - bare.triangles,
    }))
}

/// Milliseconds of a frame, with drawing waited for and the picture read back; what it drew.
fn frame_of(gpu: &Gpu, surface: &Surface, view: View) -> Option<(f64, FrameStats)> {
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).ok()?;
    let eye = view.camera.position_planet_m;
    let up = eye.normalize();
    let sun = (up + up.any_orthonormal_vector()).normalize();
    let mut stats = FrameStats::default();
    let mut draw = || {
        let scene = Scene::of_planet(surface, view, sun);
        // An error here shows in every figure of the GPU.
        let _ = gpu.picture(SIZE_PX, |target| {
            renderer.render(target, &scene).map(|drawn| stats = drawn).map_err(|error| error.to_string())
        });
    };
    // The first frame uploads and builds everything.
    draw();
    let frame_ms = median(&repeat(draw))?;
    Some((frame_ms, stats))
}
