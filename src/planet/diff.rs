//! Which parameters two planets differ in, by path: for the names of undo steps. Which stages must run again is told by
//! [`crate::terrain::Revision::changes_since`].

use super::Planet;
use super::param::{ParamPath, Segment, Value};
use std::collections::HashMap;

/// The paths of all parameters that differ, in the order of the file. Of a part or list element that only one planet
/// has, every parameter differs.
pub fn diff(before: &Planet, after: &Planet) -> Vec<ParamPath> {
    let (old, new) = (snapshot(before), snapshot(after));
    let same_paths = old.len() == new.len() && old.iter().zip(&new).all(|(old, new)| old.0 == new.0);
    let mut paths: Vec<ParamPath> = if same_paths {
        old.iter().zip(&new).filter(|(old, new)| old.1 != new.1).map(|(_, (path, _))| path.clone()).collect()
    } else {
        let index = |values: &'_ [(ParamPath, Value)]| -> HashMap<ParamPath, usize> {
            values.iter().enumerate().map(|(i, (path, _))| (path.clone(), i)).collect()
        };
        let (in_old, in_new) = (index(&old), index(&new));
        new.iter()
            .filter(|(path, value)| in_old.get(path).is_none_or(|&i| old[i].1 != *value))
            .chain(old.iter().filter(|(path, _)| !in_new.contains_key(path)))
            .map(|(path, _)| path.clone())
            .collect()
    };
    if before.biomes.table != after.biomes.table {
        paths.push(ParamPath::from(vec![Segment::Field("biomes"), Segment::Field("table")]));
    }
    paths
}

fn snapshot(planet: &Planet) -> Vec<(ParamPath, Value)> {
    let mut values = Vec::new();
    planet.each_value(&mut |path, _, value| values.push((path.clone(), value.get())));
    values
}
