//! Parts of a preset as text, to copy them from planet to planet: a preset that holds nothing but them.

use super::explain::options;
use super::{Layer, Planet, VERSION, file, locate};
use ron::ser::PrettyConfig;
use serde::Serialize;

/// The text of a part of a planet, such as `clouds`; None if the planet does not have it. Empty: the whole planet.
pub fn of_part(planet: &Planet, part: &str) -> Option<String> {
    match part {
        "" => Some(planet.to_text()),
        "star" => Some(text(part, &planet.star)),
        "layers" => Some(of_layers(&planet.layers)),
        "edits" => Some(text(part, &planet.edits)),
        "life" => Some(text(part, &planet.life)),
        "climate" => Some(text(part, &planet.climate)),
        "biomes" => Some(text(part, &planet.biomes)),
        "structure" => planet.structure.as_ref().map(|value| text(part, value)),
        "water" => planet.water.as_ref().map(|value| text(part, value)),
        "atmosphere" => planet.atmosphere.as_ref().map(|value| text(part, value)),
        "clouds" => planet.clouds.as_ref().map(|value| text(part, value)),
        "giant" => planet.giant.as_ref().map(|value| text(part, value)),
        "rings" => planet.rings.as_ref().map(|value| text(part, value)),
        _ => None,
    }
}

/// The text of layers.
pub fn of_layers(layers: &[Layer]) -> String {
    text("layers", layers)
}

fn text(part: &str, value: &(impl Serialize + ?Sized)) -> String {
    let config = PrettyConfig::new().new_line("\n").escape_strings(false);
    let mut bare = String::new();
    // Writing plain data into a string cannot fail. If it did, the text would be refused when it is read.
    let _ = options().to_writer_pretty(&mut bare, value, config);
    format!("(\n    version: {VERSION},\n    {part}: {},\n)\n", bare.replace('\n', "\n    "))
}

/// A text that was read.
pub struct Snippet {
    planet: Planet,
    fields: Vec<String>,
}

/// Reads a snippet, or a whole preset. `source` names the text in messages.
///
/// # Errors
/// What is wrong with the text.
pub fn read(source: &str, text: &str) -> Result<Snippet, String> {
    let told = |error: super::LoadError| error.to_string().lines().next().unwrap_or_default().to_owned();
    let planet = file::parsed(source, text).map_err(told)?;
    // Masks may be on layers that were not copied.
    let mut alone = planet.clone();
    let names: Vec<&str> = planet.layers.iter().map(|layer| layer.name.as_str()).collect();
    for layer in &mut alone.layers {
        layer.masks.retain(|mask| mask.layer().is_none_or(|name| names.contains(&name)));
    }
    // Strokes of the life tool may be of populations that were not copied.
    alone.edits.drop_strangers(&planet.life);
    file::checked(source, text, &alone).map_err(told)?;
    let mut fields = Vec::new();
    locate::walk(text, |steps, _| {
        if let [locate::Step::Field(name)] = steps {
            fields.push((*name).to_owned());
        }
        true
    });
    Ok(Snippet { planet, fields })
}

impl Snippet {
    /// Whether the text says something of a part. Empty: of the planet itself.
    pub fn has(&self, part: &str) -> bool {
        let name = if part.is_empty() { "radius_km" } else { part };
        self.fields.iter().any(|field| field == name)
    }

    /// The planet of the text; what the text does not mention has its defaults.
    pub fn planet(&self) -> &Planet {
        &self.planet
    }
}

impl Planet {
    /// Takes a part over from another planet; empty: everything but the editor's own section.
    pub fn take_part(&mut self, from: &Planet, part: &str) {
        match part {
            "" => *self = Planet { editor: self.editor.take(), ..from.clone() },
            "star" => self.star.clone_from(&from.star),
            "layers" => self.layers.clone_from(&from.layers),
            "edits" => self.edits.clone_from(&from.edits),
            "life" => self.life.clone_from(&from.life),
            "climate" => self.climate.clone_from(&from.climate),
            "biomes" => self.biomes.clone_from(&from.biomes),
            "structure" => self.structure.clone_from(&from.structure),
            "water" => self.water.clone_from(&from.water),
            "atmosphere" => self.atmosphere.clone_from(&from.atmosphere),
            "clouds" => self.clouds.clone_from(&from.clouds),
            "giant" => self.giant.clone_from(&from.giant),
            "rings" => self.rings.clone_from(&from.rings),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{EditPoint, EditPoints, Giant, GroundEdit, LayerMask, Mask, Rings, shipped};

    #[test]
    fn every_part_goes_through_text() {
        let mut from = shipped::default_planet();
        (from.rings, from.giant) = (Some(Rings::default()), Some(Giant { bands: 5, ..Giant::default() }));
        from.edits.push(GroundEdit { points: EditPoints(vec![EditPoint::default()]), ..GroundEdit::default() });
        for part in Planet::PARTS.iter().map(|part| part.name).filter(|name| *name != "editor") {
            let text = of_part(&from, part).unwrap();
            let read = read("clipboard", &text).unwrap_or_else(|error| panic!("{part}: {error}\n{text}"));
            let others = Planet::PARTS.iter().filter(|other| other.name != part);
            assert!(read.has(part) && !read.has(""), "{part}");
            others.for_each(|other| assert!(!read.has(other.name), "{part} {}", other.name));
            let (mut to, mut wanted) = (Planet::default(), Planet::default());
            to.take_part(read.planet(), part);
            wanted.take_part(&from, part);
            assert_ne!(wanted, Planet::default(), "{part} has something to copy");
            assert_eq!(to, wanted, "{part}");
        }
        from.giant = None;
        let whole = read("clipboard", &of_part(&from, "").unwrap()).unwrap();
        assert!(whole.has("") && whole.has("clouds"));
        assert_eq!(*whole.planet(), from);
    }

    #[test]
    fn what_is_no_preset_is_told() {
        assert_eq!(of_part(&Planet::default(), "clouds"), None);
        let error = read("clipboard", "hello").err().unwrap();
        assert!(error.starts_with("clipboard:1:1"), "{error}");
        let layers = [Layer { name: "Hills".to_owned(), ..Layer::default() }];
        assert_eq!(read("clipboard", &of_layers(&layers)).unwrap().planet().layers, layers);
        let masked = Layer {
            masks: vec![Mask::Layer(LayerMask { layer: "Gone".to_owned(), ..LayerMask::default() })],
            ..layers[0].clone()
        };
        assert_eq!(read("clipboard", &of_layers(std::slice::from_ref(&masked))).unwrap().planet().layers, [masked]);
        let flawed = [Layer { amplitude_m: 1e9, ..Layer::default() }];
        assert!(read("clipboard", &of_layers(&flawed)).err().unwrap().contains("amplitude_m"));
    }
}
