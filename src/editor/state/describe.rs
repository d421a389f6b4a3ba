//! Changes in words: "Change amplitude of Continents", for the undo menu.

use crate::planet::param::{Param, ParamPath, Segment, Value};
use crate::planet::{Planet, diff};

/// Names the difference between two planets.
pub fn change(before: &Planet, after: &Planet) -> String {
    if before.layers.len() != after.layers.len() {
        return "Change layers".to_owned();
    }
    let changes = diff::diff(before, after);
    match changes.as_slice() {
        [only] => match param_at(after, only) {
            // The step must not contain the name itself, which changes with each letter: each would be a step.
            Some((param, _)) if param.name == "name" && only.segments().len() > 1 => {
                let biome = only.segments().first() == Some(&Segment::Field("biomes"));
                format!("Rename {}", if biome { "biome" } else { "layer" })
            }
            Some((param, _)) => {
                let label = lower_first(param.label);
                match owner(after, only) {
                    Some(owner) => format!("Change {label} of {owner}"),
                    None => format!("Change {label}"),
                }
            }
            None => "Change planet".to_owned(),
        },
        [first, rest @ ..] => {
            let part = owner(after, first);
            match part {
                Some(part) if rest.iter().all(|path| owner(after, path).as_deref() == Some(part.as_str())) => {
                    format!("Change {part}")
                }
                _ => "Change planet".to_owned(),
            }
        }
        [] => "Change planet".to_owned(),
    }
}

/// The owner of the parameter at `path`: the name of the layer, of the biome, or of the part.
pub fn owner(planet: &Planet, path: &ParamPath) -> Option<String> {
    match path.segments() {
        [Segment::Field("layers"), Segment::Index(i), ..] => planet.layers.get(*i).map(|layer| layer.name.clone()),
        [Segment::Field("biomes"), Segment::Field("palette"), Segment::Index(i), ..] => {
            planet.biomes.palette.get(*i).map(|biome| biome.name.clone())
        }
        [Segment::Field("edits"), Segment::Index(i), ..] => planet.edits.get(*i).map(|edit| edit.name.clone()),
        [Segment::Field(part), _, ..] => Some((*part).to_owned()),
        _ => None,
    }
}

/// Names a parameter or a part: "amplitude of Hills", "Hills", "clouds".
pub fn locked(planet: &Planet, path: &ParamPath) -> String {
    let param = param_at(planet, path).map(|(param, _)| lower_first(param.label));
    let owner = owner(planet, path).or_else(|| match path.segments() {
        [Segment::Field(part)] if param.is_none() => Some((*part).to_owned()),
        _ => None,
    });
    [param, owner].into_iter().flatten().collect::<Vec<_>>().join(" of ")
}

fn param_at(planet: &Planet, wanted: &ParamPath) -> Option<(&'static Param, Value)> {
    let mut found = None;
    planet.each_value(&mut |path, param, value| {
        if path == wanted {
            found = Some((param, value.get()));
        }
    });
    found
}

/// The text with a small first letter.
pub fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_lowercase().chain(chars).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Layer;

    #[test]
    fn a_change_is_named_after_what_changed() {
        let before =
            Planet { layers: vec![Layer { name: "Continents".to_owned(), ..Layer::default() }], ..Planet::default() };
        let mut after = before.clone();
        after.layers[0].amplitude_m += 1.0;
        assert_eq!(change(&before, &after), "Change amplitude of Continents");
        after.layers[0].bias += 1.0;
        assert_eq!(change(&before, &after), "Change Continents");
        let mut after = before.clone();
        after.biomes.palette[0].name.push('x');
        assert_eq!(change(&before, &after), "Rename biome");
        let mut after = before.clone();
        after.radius_km = 5.0;
        assert_eq!(change(&before, &after), "Change radius");
        let mut after = before.clone();
        after.climate.equator_c = 5.0;
        assert_eq!(change(&before, &after), "Change equator of climate");
    }
}
