//! What changed between two planets, and which stages of a rebuild that makes stale.

use super::biome::Reliefs;
use super::param::{ParamPath, Params, Segment, Stage, Stages, Value};
use super::{Planet, TableRows};
use std::collections::HashMap;

/// One parameter that two planets differ in. Of a whole part or list element that only one of them has,
/// each parameter is a change.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Where the parameter stands.
    pub path: ParamPath,
    /// The stages that the change makes stale by itself.
    pub stages: Stages,
}

/// Every difference, in the order of the file.
pub fn diff(before: &Planet, after: &Planet) -> Vec<Change> {
    let (old, new) = (snapshot(before), snapshot(after));
    let change = |(path, stages, _): &Entry| Change { path: path.clone(), stages: *stages };
    let same_places = old.len() == new.len() && old.iter().zip(&new).all(|(old, new)| old.0 == new.0);
    let mut changes: Vec<Change> = if same_places {
        old.iter().zip(&new).filter(|(old, new)| old.2 != new.2).map(|(_, new)| change(new)).collect()
    } else {
        let index = |values: &'_ [Entry]| -> HashMap<ParamPath, usize> {
            values.iter().enumerate().map(|(i, (path, _, _))| (path.clone(), i)).collect()
        };
        let (in_old, in_new) = (index(&old), index(&new));
        new.iter()
            .filter(|(path, _, value)| in_old.get(path).is_none_or(|&i| old[i].2 != *value))
            .chain(old.iter().filter(|(path, _, _)| !in_new.contains_key(path)))
            .map(change)
            .collect()
    };
    if before.biomes.table != after.biomes.table {
        let path = ParamPath::from(vec![Segment::Field("biomes"), Segment::Field("table")]);
        changes.push(Change { path, stages: Stages::of(&[Stage::Material]) });
    }
    follow_relief(before, after, &mut changes);
    changes
}

/// Biomes with a relief make heights follow the table, the palette and the climate. Without one in the table, its parameters touch
/// nothing.
fn follow_relief(before: &Planet, after: &Planet, changes: &mut [Change]) {
    let (old, new) = (before.biomes.reliefs(), after.biomes.reliefs());
    let relief = Stages::of(&[Stage::Field, Stage::Height]);
    let sizes = |reliefs: Option<&Reliefs>| reliefs.into_iter().flat_map(Reliefs::sizes_m).collect::<Vec<f64>>();
    let known = sizes(old.as_ref());
    let needs_noise = sizes(new.as_ref()).iter().any(|size_m| !known.contains(size_m));
    let by_temperature = [before, after].iter().all(|planet| planet.biomes.rows == TableRows::Temperature);
    for change in changes {
        let is_of = |part| change.path.segments().get(1) == Some(&Segment::Field(part));
        let in_biomes = change.path.segments().first() == Some(&Segment::Field("biomes"));
        if in_biomes && (is_of("palette") || is_of("table")) {
            let more = if old == new {
                Stages::NONE
            } else if needs_noise {
                relief
            } else {
                Stages::of(&[Stage::Height])
            };
            change.stages = change.stages.without(relief).and(more);
        } else if by_temperature && in_biomes && (is_of("lowest_m") || is_of("highest_m")) {
            // The table does not look at heights.
        } else if new.is_some() && change.stages.with_consequences().contains(Stage::Climate) {
            change.stages = change.stages.and(Stages::of(&[Stage::Height]));
        }
    }
}

/// The stages that the differences touch; what takes their results follows ([`Stages::with_consequences`]).
pub fn touched_stages(before: &Planet, after: &Planet) -> Stages {
    diff(before, after).into_iter().fold(Stages::NONE, |all, change| all.and(change.stages))
}

type Entry = (ParamPath, Stages, Value);

fn snapshot(planet: &Planet) -> Vec<Entry> {
    let mut values = Vec::new();
    planet.clone().each_param(&mut ParamPath::default(), &mut |path, param, value| {
        values.push((path.clone(), param.stages, value.get()));
    });
    values
}
