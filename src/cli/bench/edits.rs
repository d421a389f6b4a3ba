//! Time from an edit to its first tiles and to its final ones, for one parameter of every kind, through the builder
//! that the editor uses. They differ where an edit moves the coast: the first tiles have the coast of the revision
//! before.

use super::{median, opening_view, p95};
use crate::lod::View;
use crate::lod::tile::TILE_VERTICES;
use crate::planet::param::{Domain, Param, ParamPath, Segment, Stages, Value, ValueRef};
use crate::planet::{Planet, validate};
use crate::tiles::{BuildStats, Builder, BuilderOptions, DEFAULT_BUDGET_BYTES, Surface};
use serde_json::json;
use std::collections::HashSet;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Edits of each parameter, each from a different value.
const RUNS: usize = 7;
/// The same without a cache, where each takes as long as a rebuild.
const UNCACHED_RUNS: usize = 3;
/// An edit that takes longer is given up.
const PATIENCE: Duration = Duration::from_secs(30);

/// The `edits` list of the report: with the cache that the editor has, and without any. `part`: the only part whose
/// parameters are edited.
pub(super) fn measure(planet: &Arc<Planet>, part: Option<&'static str>) -> Vec<serde_json::Value> {
    let view = opening_view(planet);
    let mut edits = one_of_every_kind(planet);
    let is_wanted = |path: &ParamPath| part.is_none_or(|part| path.segments().first() == Some(&Segment::Field(part)));
    edits.retain(|(path, _)| is_wanted(path));
    // One builder after the other, because the background work of one would take time from the other.
    let all = |budget_bytes: usize, runs: usize| -> Vec<_> {
        let bench = Bench::new(budget_bytes);
        edits.iter().map(|(path, _)| bench.measure(planet, &view, path, runs)).collect()
    };
    let (cached, uncached) = (all(DEFAULT_BUDGET_BYTES, RUNS), all(0, UNCACHED_RUNS));
    let measured = edits.iter().zip(cached).zip(uncached);
    measured
        .filter_map(|(((path, stages), cached), uncached)| {
            let ((stats, [first, times]), (_, [_, without])) = (cached?, uncached?);
            let ran = stats.ran().and(stages.without(Stages::OF_TILES));
            Some(json!({
                "parameter": path.to_string(),
                "stages": ran.iter().map(|stage| format!("{stage:?}")).collect::<Vec<_>>(),
                "tiles": stats.tiles_built,
                "vertices": stats.tiles_built * TILE_VERTICES,
                "octave_samples": stats.octave_samples,
                "ms_first": median(&first),
                "ms": median(&times),
                "ms_p95": p95(&times),
                "ms_uncached": median(&without),
            }))
        })
        .collect()
}

/// The builder, and a bell that it rings when a surface changes.
pub(super) struct Bench {
    builder: Builder,
    bell: Arc<(Mutex<()>, Condvar)>,
}

impl Bench {
    pub(super) fn new(budget_bytes: usize) -> Self {
        let bell = Arc::new((Mutex::new(()), Condvar::new()));
        let ring = Arc::clone(&bell);
        let builder =
            Builder::with_options(BuilderOptions::default().budget_bytes(budget_bytes), move || ring.1.notify_all());
        Self { builder, bell }
    }

    /// The statistics of the last of several edits of one parameter, and the sorted milliseconds of all: to the first
    /// tiles, and to the final ones.
    fn measure(
        &self,
        planet: &Arc<Planet>,
        view: &View,
        path: &ParamPath,
        runs: usize,
    ) -> Option<(BuildStats, [Vec<f64>; 2])> {
        let (mut times, mut last) = ([Vec::new(), Vec::new()], None);
        for run in 1..=runs {
            let Some(edited) = edited(planet, path, run) else { continue };
            self.settle(planet, view)?;
            let (secs, stats) = self.settle(&Arc::new(edited), view)?;
            times.iter_mut().zip(secs).for_each(|(times, secs)| times.push(secs * 1000.0));
            last = Some(stats);
        }
        times.iter_mut().for_each(|times| times.sort_by(f64::total_cmp));
        Some((last?, times))
    }

    /// The surface that was finished last.
    pub(super) fn surface(&self) -> Option<Arc<Surface>> {
        self.builder.surface()
    }

    /// Requests a planet and waits for its complete surface: seconds to the first and to the final tiles, and
    /// statistics.
    pub(super) fn settle(&self, planet: &Arc<Planet>, view: &View) -> Option<([f64; 2], BuildStats)> {
        let (start, mut first_secs) = (Instant::now(), None);
        self.builder.request(planet, view).ok()?;
        while !self.builder.has_all_tiles() {
            let is_there = |surface: Arc<Surface>| Arc::ptr_eq(surface.terrain.planet(), planet);
            if first_secs.is_none() && self.builder.surface().is_some_and(is_there) {
                first_secs = Some(start.elapsed().as_secs_f64());
            }
            if start.elapsed() > PATIENCE {
                return None;
            }
            // The bell may ring between the check and the wait, hence the short limit.
            let guard = self.bell.0.lock().unwrap_or_else(PoisonError::into_inner);
            drop(self.bell.1.wait_timeout(guard, Duration::from_micros(200)));
        }
        let surface = self.builder.surface().filter(|surface| surface.complete)?;
        let secs = start.elapsed().as_secs_f64();
        Some(([first_secs.unwrap_or(secs), secs], surface.stats))
    }
}

/// The first parameter of every combination of part, stage and type of value.
fn one_of_every_kind(planet: &Planet) -> Vec<(ParamPath, Stages)> {
    let mut kinds = HashSet::new();
    let mut found = Vec::new();
    planet.each_value(&mut |path, param, value| {
        let part = path.segments().first().cloned();
        let kind = (part, path.segments().len(), param.stages, kind(value));
        if nudged(param, value, 1).is_some() && kinds.insert(kind) {
            found.push((path.clone(), param.stages.with_consequences()));
        }
    });
    found.retain(|(path, _)| edited(planet, path, 1).is_some());
    found
}

fn kind(value: ValueRef<'_>) -> u8 {
    match value {
        ValueRef::Number(_) => 0,
        ValueRef::Count(_) => 1,
        ValueRef::Flag(_) => 2,
        ValueRef::Triple(_) => 3,
        ValueRef::Text(_) => 4,
        ValueRef::Letter(_) => 5,
        ValueRef::Choice(_) => 6,
        ValueRef::Curve(_) => 7,
    }
}

/// The planet with one parameter moved a little, further with each `step`; `None` where the result would not be
/// valid.
fn edited(planet: &Planet, path: &ParamPath, step: usize) -> Option<Planet> {
    let mut edited = planet.clone();
    edited.each(&mut |at, param, mut value| {
        if at == path
            && let Some(new) = nudged(param, value.as_ref(), step)
        {
            value.set(&new);
        }
    });
    (edited != *planet && validate::problems(&edited).is_empty()).then_some(edited)
}

fn nudged(param: &Param, value: ValueRef<'_>, step: usize) -> Option<Value> {
    let share = 0.01 * step as f64;
    Some(match (value.get(), param.domain) {
        (Value::Number(v), Domain::Number { min, max, .. }) => {
            let by = if v == 0.0 { (max - min) * 0.01 * share } else { v.abs() * share };
            Value::Number(if v + by <= max { v + by } else { v - by })
        }
        (Value::Count(v), Domain::Count { min, .. }) => Value::Count(if v > min { v - 1 } else { v + 1 }),
        (Value::Count(v), _) => Value::Count(v.wrapping_add(step as u32)),
        (Value::Flag(v), _) => Value::Flag(!v),
        (Value::Triple(v), _) => Value::Triple(v.map(|c| c * (1.0 - share))),
        (Value::Choice(index), _) => match value {
            ValueRef::Choice(choice) => Value::Choice((index + 1) % choice.names().len().max(1)),
            _ => return None,
        },
        (Value::Curve(points), _) if points.is_empty() => {
            Value::Curve(vec![[-1.0, -1.0 - share], [0.0, share], [1.0, 1.0 + share]])
        }
        // Other names and letters would break the masks and tables that refer to them.
        (Value::Text(v), _) => Value::Text(format!("{v} {step}")),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::param::Stage;
    use crate::planet::shipped;

    #[test]
    fn every_stage_is_measured_with_valid_edits() {
        let planet = shipped::default_planet();
        let edits = one_of_every_kind(&planet);
        let stages = edits.iter().fold(Stages::NONE, |all, (_, stages)| all.and(*stages));
        assert_eq!(stages, Stages::of(&Stage::ALL));
        assert!(edits.iter().all(|(path, _)| !path.segments().is_empty()), "{edits:?}");
    }
}
