//! From an edit to the finished tiles, for one parameter of every kind, through the builder that the editor uses.

use super::{median, opening_view, p95};
use crate::build::{Builder, Surface};
use crate::lod::View;
use crate::lod::tile::TILE_VERTICES;
use crate::planet::param::{Domain, Param, ParamPath, Stage, Value, ValueMut};
use crate::planet::{Planet, diff, validate};
use serde_json::json;
use std::collections::BTreeSet;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Edits of one parameter, each from a different value.
const RUNS: usize = 7;
/// After this an edit is given up.
const PATIENCE: Duration = Duration::from_secs(30);

/// The `edits` list of the report.
pub(super) fn measure(planet: &Arc<Planet>) -> Vec<serde_json::Value> {
    let view = opening_view(planet);
    let bench = Bench::new();
    if bench.settle(planet, &view).is_none() {
        return Vec::new();
    }
    let edits = one_of_every_kind(planet);
    edits.iter().map(|(path, stage)| measure_one(&bench, planet, &view, path, *stage)).collect()
}

fn measure_one(bench: &Bench, planet: &Arc<Planet>, view: &View, path: &ParamPath, stage: Stage) -> serde_json::Value {
    let (mut times, mut tiles) = (Vec::new(), 0);
    for run in 1..=RUNS {
        let Some(edited) = edited(planet, path, run) else { continue };
        bench.settle(planet, view);
        if let Some((secs, built)) = bench.settle(&Arc::new(edited), view) {
            times.push(secs * 1000.0);
            tiles = built;
        }
    }
    times.sort_by(f64::total_cmp);
    json!({
        "parameter": path.to_string(),
        "stages": stages(stage),
        "tiles": tiles,
        "vertices": tiles * TILE_VERTICES,
        "ms": median(&times),
        "ms_p95": p95(&times),
    })
}

/// The builder, and a bell that it rings.
struct Bench {
    builder: Builder,
    bell: Arc<(Mutex<()>, Condvar)>,
}

impl Bench {
    fn new() -> Self {
        let bell = Arc::new((Mutex::new(()), Condvar::new()));
        let ring = Arc::clone(&bell);
        let builder = Builder::new(move || ring.1.notify_all());
        Self { builder, bell }
    }

    /// Asks for a planet and waits for its complete surface: seconds, and tiles built on the way.
    fn settle(&self, planet: &Arc<Planet>, view: &View) -> Option<(f64, usize)> {
        let start = Instant::now();
        let mut last = self.builder.surface();
        let mut tiles = 0;
        self.builder.request(planet, view);
        while start.elapsed() < PATIENCE {
            let busy = self.builder.is_busy();
            let surface = self.builder.surface();
            if let Some(surface) = &surface
                && !last.as_ref().is_some_and(|last| Arc::ptr_eq(last, surface))
            {
                tiles += surface.stats.tiles_built;
                last = Some(Arc::clone(surface));
            }
            if !busy {
                let complete = |surface: &Arc<Surface>| surface.complete;
                return last
                    .as_ref()
                    .filter(|surface| complete(surface))
                    .map(|_| (start.elapsed().as_secs_f64(), tiles));
            }
            // The bell may ring between the question and the wait, hence the short limit.
            let guard = self.bell.0.lock().unwrap_or_else(PoisonError::into_inner);
            drop(self.bell.1.wait_timeout(guard, Duration::from_micros(200)));
        }
        None
    }
}

/// The stages that a change at `first` makes run.
fn stages(first: Stage) -> Vec<String> {
    let tiles = [Stage::Field, Stage::Height, Stage::Climate];
    if first.touches_tiles() {
        tiles.into_iter().filter(|stage| *stage >= first).map(|stage| format!("{stage:?}")).collect()
    } else {
        vec![format!("{first:?}")]
    }
}

/// The first parameter of every combination of part, stage and type of value.
fn one_of_every_kind(planet: &Planet) -> Vec<(ParamPath, Stage)> {
    let mut kinds = BTreeSet::new();
    let mut found = Vec::new();
    planet.clone().each(&mut |path, param, value| {
        let part = path.segments().first().cloned();
        let kind = (part, path.segments().len(), param.stage, kind(&value));
        if nudged(param, &value, 1).is_some() && kinds.insert(kind) {
            found.push(path.clone());
        }
    });
    found
        .into_iter()
        .filter_map(|path| {
            let after = edited(planet, &path, 1)?;
            let stage = diff::first_stale_stage(planet, &after)?;
            Some((path, stage))
        })
        .collect()
}

fn kind(value: &ValueMut<'_>) -> u8 {
    match value {
        ValueMut::Number(_) => 0,
        ValueMut::Count(_) => 1,
        ValueMut::Flag(_) => 2,
        ValueMut::Triple(_) => 3,
        ValueMut::Text(_) => 4,
        ValueMut::Letter(_) => 5,
        ValueMut::Choice(_) => 6,
        ValueMut::Curve(_) => 7,
    }
}

/// The planet with one parameter moved a little, further with each `step`; `None` where that would not be valid.
fn edited(planet: &Planet, path: &ParamPath, step: usize) -> Option<Planet> {
    let mut edited = planet.clone();
    edited.each(&mut |at, param, mut value| {
        if at == path
            && let Some(new) = nudged(param, &value, step)
        {
            value.set(&new);
        }
    });
    (edited != *planet && validate::problems(&edited).is_empty()).then_some(edited)
}

fn nudged(param: &Param, value: &ValueMut<'_>, step: usize) -> Option<Value> {
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
            ValueMut::Choice(choice) => Value::Choice((index + 1) % choice.names().len().max(1)),
            _ => return None,
        },
        (Value::Curve(points), _) if points.is_empty() => {
            Value::Curve(vec![[-1.0, -1.0 - share], [0.0, share], [1.0, 1.0 + share]])
        }
        // Other names and letters would leave masks and tables behind.
        (Value::Text(v), _) => Value::Text(format!("{v} {step}")),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::shipped;

    #[test]
    fn every_stage_is_measured_with_valid_edits() {
        let planet = shipped::default_planet();
        let edits = one_of_every_kind(&planet);
        let stages: BTreeSet<Stage> = edits.iter().map(|(_, stage)| *stage).collect();
        let all = [
            Stage::Field,
            Stage::Height,
            Stage::Climate,
            Stage::Material,
            Stage::CloudMap,
            Stage::AirTables,
            Stage::Uniform,
            Stage::Label,
        ];
        assert_eq!(stages, BTreeSet::from(all));
        assert!(edits.iter().all(|(path, _)| !path.segments().is_empty()), "{edits:?}");
    }
}
