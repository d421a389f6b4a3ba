//! The differences between two planets, as lines of text.

use crate::editor::state::describe::locked;
use crate::editor::widgets::number::{format_number, suffix};
use crate::editor::widgets::value_text::value_text;
use crate::planet::param::{ParamPath, Segment, Value};
use crate::planet::{Planet, diff};
use std::collections::HashMap;

/// Longest text of the values before and after a change, in characters.
const MOST_OF_VALUES: usize = 32;

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

/// The value before and after a change of one parameter: "800 m to 900 m".
pub(super) fn values(before: &Planet, after: &Planet) -> Option<String> {
    let changes = diff::diff(before, after);
    let [only] = changes.as_slice() else { return None };
    let values = format!("{} to {}", short_text(before, only)?, short_text(after, only)?);
    (values.chars().count() <= MOST_OF_VALUES).then_some(values)
}

/// The value at a path, rounded as in its field.
fn short_text(planet: &Planet, wanted: &ParamPath) -> Option<String> {
    let mut found = None;
    planet.each_value(&mut |path, param, value| {
        if path == wanted && found.is_none() {
            found = match value.get() {
                Value::Number(number) => Some(format!("{}{}", format_number(number), suffix(param.unit))),
                Value::Curve(_) | Value::Triple(_) => None,
                other => Some(value_text(param, &other, value.labels())),
            };
        }
    });
    found
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

    #[test]
    fn a_change_of_one_parameter_shows_its_values() {
        let layer = |amplitude_m, bias| Planet {
            layers: vec![Layer { amplitude_m, bias, ..Layer::default() }],
            ..Planet::default()
        };
        assert_eq!(values(&layer(800.0, 0.5), &layer(912.35, 0.5)).as_deref(), Some("800 m to 912.35 m"));
        assert_eq!(values(&layer(800.0, 0.5), &layer(900.0, 0.6)), None, "two parameters");
        assert_eq!(values(&layer(800.0, 0.5), &layer(800.0, 0.5)), None);
    }
}
