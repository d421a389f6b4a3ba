//! The value of a parameter as text, for the clipboard and for tooltips, and back.

use super::number::suffix;
use super::typed::Allowed;
use crate::planet::param::{Domain, Param, Unit, Value, ValueRef};

/// The text of a value with its unit. `labels`: the names of the values of a choice.
pub fn value_text(param: &Param, value: &Value, labels: &[&str]) -> String {
    let unit = suffix(param.unit);
    match value {
        Value::Number(v) => format!("{v}{unit}"),
        Value::Count(v) => format!("{v}{unit}"),
        Value::Flag(v) => if *v { "on" } else { "off" }.to_owned(),
        Value::Triple([r, g, b]) => format!("({r}, {g}, {b}){unit}"),
        Value::Text(v) => v.clone(),
        Value::Letter(v) => v.to_string(),
        Value::Curve(points) if points.is_empty() => "no curve".to_owned(),
        Value::Curve(points) => points.iter().map(|[x, y]| format!("({x}, {y})")).collect::<Vec<_>>().join(", "),
        Value::Choice(index) => labels.get(*index).copied().unwrap_or_default().to_owned(),
    }
}

/// Reads a value for a parameter whose value now is `now`. `keys`: the keys of the palette.
///
/// # Errors
/// Why the text is no value of the parameter.
pub fn read_value(param: &Param, now: &ValueRef<'_>, text: &str, keys: &[char]) -> Result<Value, String> {
    let text = text.trim();
    let value = match (now.get(), param.domain) {
        (Value::Number(_), domain) => {
            let Domain::Number { min, max, .. } = domain else { return Err("no number can be pasted here".to_owned()) };
            Value::Number(Allowed::numbers(param.unit, min, max).read(text, None)?)
        }
        (Value::Count(_), Domain::Count { min, max }) => {
            Value::Count(Allowed::whole(min, max).read(text, None)? as u32)
        }
        (Value::Count(_), _) => Value::Count(Allowed::whole(0, u32::MAX).read(text, None)? as u32),
        (Value::Flag(_), _) => match text.to_lowercase().as_str() {
            "on" | "true" | "yes" | "1" => Value::Flag(true),
            "off" | "false" | "no" | "0" => Value::Flag(false),
            _ => return Err(format!("{text:?} is neither on nor off")),
        },
        (Value::Triple(_), _) => match numbers(text, param.unit)?.as_slice() {
            [r, g, b] => Value::Triple([*r, *g, *b]),
            _ => return Err(format!("{text:?} is not three numbers")),
        },
        (Value::Text(_), _) => Value::Text(text.lines().next().unwrap_or_default().to_owned()),
        (Value::Letter(_), domain) => {
            let mut letters = text.chars();
            let (Some(letter), None) = (letters.next(), letters.next()) else {
                return Err(format!("{text:?} is not one letter"));
            };
            if domain == Domain::BiomeKey && !keys.contains(&letter) {
                return Err(format!("no biome has the key {letter:?}"));
            }
            Value::Letter(letter)
        }
        (Value::Curve(_), _) if text == "no curve" => Value::Curve(Vec::new()),
        (Value::Curve(_), _) => {
            let numbers = numbers(text, Unit::None)?;
            let points: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
            if points.len() < 2 || numbers.len() % 2 != 0 {
                return Err(format!("{text:?} is no curve: write (x, y), (x, y)"));
            }
            Value::Curve(points)
        }
        (Value::Choice(_), _) => {
            let is_text = |name: &&str| name.eq_ignore_ascii_case(text);
            let found = now.labels().iter().position(is_text).or(now.names().iter().position(is_text));
            Value::Choice(found.ok_or_else(|| format!("{text:?} is none of {}", now.labels().join(", ")))?)
        }
    };
    value.problem(param).map_or(Ok(value), Err)
}

/// Numbers between commas and parentheses; the unit may follow.
fn numbers(text: &str, unit: Unit) -> Result<Vec<f64>, String> {
    let bare = text.strip_suffix(unit.symbol()).unwrap_or(text);
    let parts = bare.split(['(', ')', ',', '[', ']']).map(str::trim).filter(|part| !part.is_empty());
    parts.map(|part| part.parse().map_err(|_| format!("{part:?} is not a number"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Biome, Layer, Planet, shipped};

    #[test]
    fn every_value_is_read_back_from_its_text() {
        let mut planet = shipped::default_planet();
        planet.layers.push(Layer { curve: vec![[-1.0, 0.5], [1.0, -0.25]], ..Layer::default() });
        let keys: Vec<char> = planet.biomes.palette.iter().map(|biome: &Biome| biome.key).collect();
        let mut count = 0;
        planet.each_value(&mut |path, param, value| {
            let text = value_text(param, &value.get(), value.labels());
            // A rule that is off may name no biome.
            if let Ok(read) = read_value(param, &value, &text, &keys) {
                assert_eq!(read, value.get(), "{path}");
                count += 1;
            } else {
                assert_eq!(param.domain, Domain::BiomeKey, "{path}: {text}");
            }
        });
        assert!(count > 500, "{count}");
    }

    #[test]
    fn what_is_no_value_is_refused() {
        let planet = Planet::default();
        let mut refused = Vec::new();
        planet.each_value(&mut |_, param, value| {
            if ["radius_km", "seed", "color", "precision", "snow", "height_curve", "beach_key"].contains(&param.name) {
                refused.push(read_value(param, &value, "purple", &['a']).unwrap_err());
            }
        });
        assert!(refused.len() >= 7, "{refused:?}");
        planet.each_value(&mut |_, param, value| {
            if param.name == "radius_km" {
                assert!(read_value(param, &value, "1e9 km", &[]).unwrap_err().contains("out of range"));
                assert_eq!(read_value(param, &value, " 2*1500 km ", &[]), Ok(Value::Number(3000.0)));
            }
        });
    }
}
