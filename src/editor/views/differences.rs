//! The differences between two planets, as lines of text.

use crate::editor::state::describe::locked;
use crate::editor::widgets::value_text::value_text;
use crate::planet::param::{ParamPath, Segment};
use crate::planet::{Planet, diff};
use std::collections::HashMap;

/// A line for each parameter that differs: "amplitude of Hills: 800 m, in the file 900 m".
pub(super) fn lines(mine: &Planet, theirs: &Planet) -> Vec<String> {
    let (ours, others) = (texts(mine), texts(theirs));
    let mut lines = Vec::new();
    for path in diff::diff(mine, theirs) {
        if path.segments() == [Segment::Field("biomes"), Segment::Field("table")] {
            lines.push("biome table".to_owned());
            continue;
        }
        // A part that only one of the planets has is one line.
        match (ours.get(&path), others.get(&path)) {
            (Some(mine_is), Some(theirs_is)) => {
                lines.push(format!("{}: {mine_is}, in the file {theirs_is}", locked(theirs, &path)));
            }
            (Some(_), None) => lines.push(format!("{}: only here", whole(mine, &path))),
            (None, _) => lines.push(format!("{}: only in the file", whole(theirs, &path))),
        }
    }
    lines.dedup();
    lines
}

/// The layer, biome or part that holds a parameter.
fn whole(planet: &Planet, path: &ParamPath) -> String {
    crate::editor::state::describe::owner(planet, path).unwrap_or_else(|| path.to_string())
}

fn texts(planet: &Planet) -> HashMap<ParamPath, String> {
    let mut texts = HashMap::new();
    planet.each_value(&mut |path, param, value| {
        texts.entry(path.clone()).or_insert_with(|| value_text(param, &value.get(), value.labels()));
    });
    texts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Clouds, Layer};

    #[test]
    fn each_difference_is_a_line() {
        let layer = |amplitude_m| Layer { name: "Hills".to_owned(), amplitude_m, ..Layer::default() };
        let mine = Planet { layers: vec![layer(800.0)], clouds: Some(Clouds::default()), ..Planet::default() };
        let theirs = Planet { layers: vec![layer(900.0)], radius_km: 5000.0, ..Planet::default() };
        let lines = lines(&mine, &theirs);
        assert_eq!(
            lines,
            [
                "radius: 6371 km, in the file 5000 km",
                "amplitude of Hills: 800 m, in the file 900 m",
                "clouds: only here"
            ]
        );
        assert!(super::lines(&mine, &mine).is_empty());
    }
}
