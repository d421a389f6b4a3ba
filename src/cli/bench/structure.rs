//! The cost of a structure: its solvers level by level, the tiles of the opening view, and points among its rivers.

use super::{edits, median, opening_view, repeat};
use crate::planet::{Planet, Structure};
use crate::sphere::spread;
use crate::terrain::coarse::CellFields;
use crate::terrain::{Detail, Scratch, Terrain};
use crate::tiles::{MapWork, build_over};
use crate::world::drainage;
use glam::DVec3;
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Instant;

/// Points along the side of a patch, and the distance between them: near enough for every level of rivers.
const PATCH_SIDE: usize = 128;
const PATCH_STEP_M: f64 = 15.0;
/// Patches on land, far from each other.
const PATCHES: usize = 24;

/// The `structure` object of the report: a planet with a structure, median run.
///
/// - `draft_ms`, `draft_rivers_ms`: time until a draft serves after an edit of the plates, and of the rivers alone
/// - `first_ms`, `finest_ms`: time until the coarsest and the finest rivers serve
/// - `levels`: each solver's share, with nanoseconds for each land cell and pass of the river solver
/// - `view_first_ms`, `view_ms`: the whole opening view with maps at hand, the first time and again
/// - `cold_mps`, `warm_mps`: million heights a second on one core with all levels of rivers, where no river has been
///   asked for, and again
/// - `agents_first_us`: microseconds of one core for the height under each of ten thousand people spread over the
///   planet, the first time; `agents_ms`: milliseconds for all of them again, on all cores, after a step;
///   `agents_spaced_ms`: those with the detail of points 500 m apart; `agents_kept_mb`: what is kept for them
/// - `edits`: edits of the layers over the structure
pub(super) fn measure(planet: &Planet) -> Result<Value, String> {
    let planet = Arc::new(planet.clone());
    let draft = Terrain::builder(planet.clone()).draft().map_err(|error| error.to_string())?;
    let mut runs = Vec::new();
    repeat(|| runs.push(solve(&draft)));
    runs.sort_by(|a, b| a.finest_ms.total_cmp(&b.finest_ms));
    let Run { terrain, first_ms, finest_ms, levels } = runs.swap_remove(runs.len() / 2);

    let terrain = Arc::new(terrain);
    let view = opening_view(&planet);
    let timed = || {
        let begun = Instant::now();
        drop(build_over(&terrain, &view));
        begun.elapsed().as_secs_f64() * 1000.0
    };
    let view_first_ms = timed();
    let view_ms = median(&repeat(|| {
        timed();
    }));
    let [cold_mps, warm_mps] = patches_mps(&terrain);
    let [agents_first_us, agents_ms, agents_spaced_ms] = agents(&terrain);
    Ok(json!({
        "draft_ms": draft_ms(&draft, &planet, |_| ())?,
        "draft_rivers_ms": draft_ms(&terrain, &planet, |structure| structure.rivers.erodibility *= 1.1)?,
        "first_ms": first_ms,
        "finest_ms": finest_ms,
        "levels": levels,
        "view_first_ms": view_first_ms,
        "view_ms": view_ms,
        "cold_mps": cold_mps,
        "warm_mps": warm_mps,
        "agents_first_us": agents_first_us,
        "agents_ms": agents_ms,
        "agents_spaced_ms": agents_spaced_ms,
        "agents_kept_mb": terrain.kept_rivers_bytes() as f64 * 1e-6,
        "edits": edits::measure(&planet, Some("layers")),
    }))
}

/// Time of a draft after an edit, with the maps of a terrain at hand.
fn draft_ms(before: &Terrain, planet: &Planet, edit: impl Fn(&mut Structure)) -> Result<Option<f64>, String> {
    let mut edited = planet.clone();
    edited.structure.iter_mut().for_each(edit);
    let draft = Terrain::builder(Arc::new(edited)).reuse(before).draft().map_err(|error| error.to_string())?;
    let fields = CellFields::default();
    Ok(median(&repeat(|| drop(draft.with_draft_maps(&fields, &mut MapWork::default())))))
}

struct Run {
    terrain: Terrain,
    first_ms: f64,
    finest_ms: f64,
    levels: Vec<Value>,
}

/// Solves all maps of a planet.
fn solve(draft: &Terrain) -> Run {
    let fields = CellFields::default();
    let mut run = Run { terrain: draft.clone(), first_ms: 0.0, finest_ms: 0.0, levels: Vec::new() };
    let mut work = MapWork::default();
    while let Some(next) = run.terrain.with_next_map(&fields, &|| true, &mut work) {
        run.terrain = next;
        let Some(level) = work.last else { continue };
        let ms = level.secs * 1000.0;
        run.finest_ms += ms;
        let mut row = json!({ "map": level.map, "side": level.side, "ms": ms, "cells": 6 * level.side * level.side });
        if let Some(carved) = run.terrain.world().carved.map().filter(|carved| carved.drainage.side == level.side) {
            if run.first_ms == 0.0 {
                run.first_ms = run.finest_ms;
            }
            let (land, passes) = (carved.drainage.order.len(), drainage::rounds(level.side));
            row["land"] = json!(land);
            row["passes"] = json!(passes);
            row["ns_per_land_cell_and_pass"] = json!(level.secs * 1e9 / (land * passes).max(1) as f64);
        }
        run.levels.push(row);
    }
    run
}

/// People spread over the planet, how far they go in a step, and the detail of those who need less.
const AGENTS: usize = 10_000;
const AGENT_STEP_M: f64 = 0.1;
const AGENT_SPACING_M: f64 = 500.0;

/// See `agents_first_us`, `agents_ms` and `agents_spaced_ms`.
fn agents(terrain: &Terrain) -> [f64; 3] {
    let mut dirs: Vec<DVec3> = spread(AGENTS).collect();
    let begun = Instant::now();
    terrain.heights_m(&dirs);
    let cores = rayon::current_num_threads() as f64;
    let first_us = begun.elapsed().as_secs_f64() * 1e6 * cores / AGENTS as f64;
    let step_rad = AGENT_STEP_M / terrain.planet().radius_m();
    let mut tick_ms = |detail: Detail| {
        let times = repeat(|| {
            for dir in &mut dirs {
                *dir = (*dir + dir.any_orthonormal_vector() * step_rad).normalize();
            }
            terrain.heights_detailed_m(&dirs, detail);
        });
        median(&times).unwrap_or(f64::NAN)
    };
    [first_us, tick_ms(Detail::All), tick_ms(Detail::SpacingM(AGENT_SPACING_M))]
}

/// Million heights a second of patches that nobody has asked for yet, and of the same again.
fn patches_mps(terrain: &Terrain) -> [Option<f64>; 2] {
    let step_rad = PATCH_STEP_M / terrain.planet().radius_m();
    let sea_m = terrain.planet().sea_level_m().unwrap_or(f64::MIN);
    // By bounds: a height would build the blocks whose absence is measured.
    let is_land = |dir: &DVec3| terrain.height_bounds_near_m(*dir, 1e-4).0 > sea_m;
    let middles = spread(40 * PATCHES).filter(is_land).take(PATCHES);
    let patch = |middle: DVec3| -> Vec<DVec3> {
        let (east, north) = middle.any_orthonormal_pair();
        let away = |k: usize| (k as f64 - 0.5 * PATCH_SIDE as f64) * step_rad;
        let at = |i: usize| (middle + east * away(i % PATCH_SIDE) + north * away(i / PATCH_SIDE)).normalize();
        (0..PATCH_SIDE * PATCH_SIDE).map(at).collect()
    };
    let (mut heights_m, mut scratch) = (vec![0.0; PATCH_SIDE * PATCH_SIDE], Scratch::default());
    let (mut cold, mut warm) = (Vec::new(), Vec::new());
    for dirs in middles.map(patch) {
        for times in [&mut cold, &mut warm] {
            let begun = Instant::now();
            terrain.heights_spaced_into(&dirs, 0.0, &mut heights_m, &mut scratch);
            times.push(dirs.len() as f64 / begun.elapsed().as_secs_f64() * 1e-6);
        }
    }
    [cold, warm].map(|mut rates| {
        rates.sort_by(f64::total_cmp);
        median(&rates)
    })
}
