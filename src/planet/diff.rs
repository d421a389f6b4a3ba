//! What changed between two planets, and which stages of a rebuild that makes stale.

use super::Planet;
use super::param::{ParamPath, Params, Segment, Stage, Value};

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
    let mut changes: Vec<Change> = new
        .iter()
        .filter(|(path, _, value)| old.iter().find(|(p, _, _)| p == path).is_none_or(|(_, _, v)| v != value))
        .chain(old.iter().filter(|(path, _, _)| !new.iter().any(|(p, _, _)| p == path)))
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

fn snapshot(planet: &Planet) -> Vec<(ParamPath, Stage, Value)> {
    let mut values = Vec::new();
    planet.clone().each_param(&mut ParamPath::default(), &mut |path, param, value| {
        values.push((path.clone(), param.stage, value.get()));
    });
    values
}
