//! What changed between two planets, and which stages of a rebuild that makes stale.

use super::Planet;
use super::param::{ParamPath, Params, Segment, Stage, Value};
use std::collections::HashMap;

/// One parameter that two planets differ in. A whole part or list element that only one of them has stands as one change
/// under the path of its list or part.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Where the parameter stands.
    pub path: ParamPath,
    /// The first stage that the change makes stale.
    pub stage: Stage,
}

/// Every difference, in the order of the file.
pub fn diff(before: &Planet, after: &Planet) -> Vec<Change> {
    let (old, new) = (snapshot(before), snapshot(after));
    let index = |values: &'_ [Entry]| -> HashMap<ParamPath, usize> {
        values.iter().enumerate().map(|(i, (path, _, _))| (path.clone(), i)).collect()
    };
    let (in_old, in_new) = (index(&old), index(&new));
    let mut changes: Vec<Change> = new
        .iter()
        .filter(|(path, _, value)| in_old.get(path).is_none_or(|&i| old[i].2 != *value))
        .chain(old.iter().filter(|(path, _, _)| !in_new.contains_key(path)))
        .map(|(path, stage, _)| Change { path: path.clone(), stage: *stage })
        .collect();
    if before.biomes.table != after.biomes.table {
        let path = ParamPath::from(vec![Segment::Field("biomes"), Segment::Field("table")]);
        changes.push(Change { path, stage: Stage::Material });
    }
    changes
}

/// The earliest stale stage, or `None` when the planets are equal.
pub fn first_stale_stage(before: &Planet, after: &Planet) -> Option<Stage> {
    diff(before, after).into_iter().map(|change| change.stage).min()
}

type Entry = (ParamPath, Stage, Value);

fn snapshot(planet: &Planet) -> Vec<Entry> {
    let mut values = Vec::new();
    planet.clone().each_param(&mut ParamPath::default(), &mut |path, param, value| {
        values.push((path.clone(), param.stage, value.get()));
    });
    values
}
