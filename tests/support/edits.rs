//! A planet that uses every parameter, and an edit of each.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use std::sync::Arc;
use tellus::planet::param::{Domain, Param, ParamPath, Stages, Value, ValueMut};
use tellus::planet::{
    Atmosphere, Biome, Blend, Clouds, Layer, Mask, Planet, Population, Shape, Steep, Table, TableRows, Water,
    param::Choice as _,
};
use tellus::terrain::Revision;

/// A planet on which every parameter has an effect: all landforms, masks, all biomes in the biome table.
pub fn full_planet() -> Planet {
    let mut planet = Planet {
        radius_km: 1500.0,
        // A young sea, whose waves grow with the fetch, and that glows.
        water: Some(Water { fetch_km: 8.0, glow: 0.1, ..Water::default() }),
        atmosphere: Some(Atmosphere::default()),
        clouds: Some(Clouds { middle: 0.2, ..Clouds::default() }),
        ..Planet::default()
    };
    // A height map without its picture has no effect.
    let kinds = Shape::all().into_iter().filter(|shape| !matches!(shape, Shape::HeightMap(_)));
    for (i, mut shape) in kinds.enumerate() {
        shrink(&mut shape);
        let name = shape.names()[shape.index()].to_owned();
        let blend = if i == 0 { Blend::Add } else { Blend::ALL[i % Blend::ALL.len()] };
        planet.layers.push(Layer {
            name,
            shape,
            seed: i as u32,
            amplitude_m: 900.0,
            bias: 0.1,
            blend,
            ..Layer::default()
        });
    }
    for (i, mut mask) in Mask::all().into_iter().enumerate() {
        if let Mask::Layer(mask) = &mut mask {
            mask.layer = planet.layers[0].name.clone();
        }
        planet.layers[1 + i].masks.push(mask);
    }
    let biome = |key, color, steep| Biome { key, color, steep, ..Biome::default() };
    planet.biomes.palette = vec![biome('a', [0.1, 0.3, 0.1], Steep::Rock), biome('b', [0.4, 0.4, 0.2], Steep::Biome)];
    planet.biomes.table = Table::uniform('a', 4, 3);
    planet.biomes.table.set_key(1, 1, 'b');
    planet.biomes.rows = TableRows::Temperature;
    planet.biomes.beach_m = 50.0;
    planet.biomes.snow = true;
    planet.climate.sea_moisture = 0.3;
    planet.life = vec![Population { clumping: 0.4, ..Population::default() }];
    planet
}

/// Fewer octaves: tests build many tiles.
fn shrink(shape: &mut Shape) {
    use tellus::planet::param::Params as _;
    shape.each_param(&mut ParamPath::default(), &mut |_, param, mut value| {
        if param.name == "octaves" {
            value.set(&Value::Count(3));
        }
    });
}

/// An edit of one parameter.
pub struct Edit {
    pub path: String,
    /// The stages that its description declares stale.
    pub declared: Stages,
    pub planet: Planet,
}

/// Parameters that the full planet does not read: its first biome shows the shared rock where it is steep, and the rows
/// of its table go by temperature.
pub fn is_idle(path: &str) -> bool {
    path.starts_with("biomes.palette[0].steep_")
        || [".under", ".folding"].iter().any(|end| path.ends_with(end))
        || ["biomes.lowest_m", "biomes.highest_m"].contains(&path)
}

/// One edit of each parameter that can take another value, and one of the biome table.
pub fn every_edit(planet: &Planet) -> Vec<Edit> {
    let mut places: Vec<(ParamPath, Stages)> = Vec::new();
    planet.each_value(&mut |path, param, _| places.push((path.clone(), param.stages)));
    let mut edits: Vec<Edit> = places
        .into_iter()
        .filter_map(|(path, stages)| {
            let mut edited = planet.clone();
            let mut renamed = None;
            edited.each(&mut |at, param, mut value| {
                if *at == path {
                    let new = other(planet, param, &value);
                    renamed = Some((param.name, value.get(), new.clone()));
                    value.set(&new);
                }
            });
            if let Some((name, old, new)) = renamed {
                follow(&mut edited, name, &old, &new);
            }
            for mask in edited.layers.iter_mut().flat_map(|layer| &mut layer.masks) {
                // A mask of another kind.
                if mask.layer() == Some("") {
                    mask.set_layer(&planet.layers[0].name);
                }
            }
            // With a biome relief, heights follow climate and biomes, and only the content keys tell how far.
            let reliefs = planet.biomes.palette.iter().any(|biome| biome.relief_m > 0.0);
            let by_keys = reliefs || path.to_string().contains("relief");
            let declared = stages.with_consequences();
            let declared = if by_keys {
                declared.without(Stages::OF_TILES).and(changes(planet, &edited).within(Stages::OF_TILES))
            } else {
                declared
            };
            let path = path.to_string();
            (edited != *planet && !is_idle(&path)).then_some(Edit { path, declared, planet: edited })
        })
        .collect();
    let mut painted = planet.clone();
    painted.biomes.table.set_key(0, 0, planet.biomes.palette[1].key);
    let declared = changes(planet, &painted);
    edits.push(Edit { path: "biomes.table".to_owned(), declared, planet: painted });
    edits
}

/// The stages that the content keys of two valid planets differ in.
fn changes(before: &Planet, after: &Planet) -> Stages {
    let revision = |planet: &Planet| Revision::try_new(Arc::new(planet.clone()));
    match (revision(before), revision(after)) {
        (Ok(before), Ok(after)) => after.changes_since(&before),
        _ => Stages::NONE,
    }
}

/// Renames references to a biome key or a layer name along with it; otherwise the planet would not be valid.
fn follow(planet: &mut Planet, name: &str, old: &Value, new: &Value) {
    match (name, old, new) {
        ("key", Value::Letter(old), Value::Letter(new)) => {
            let biomes = &mut planet.biomes;
            for row in 0..biomes.table.rows().len() {
                for column in 0..biomes.table.columns() {
                    if biomes.table.key(column, row) == Some(*old) {
                        biomes.table.set_key(column, row, *new);
                    }
                }
            }
            let steep = biomes.palette.iter_mut().map(|biome| &mut biome.steep_key);
            for key in steep.chain([&mut biomes.beach_key, &mut biomes.snow_key]) {
                *key = if *key == *old { *new } else { *key };
            }
        }
        ("name", Value::Text(old), Value::Text(new)) => {
            for mask in planet.layers.iter_mut().flat_map(|layer| &mut layer.masks) {
                if mask.layer() == Some(old) {
                    mask.set_layer(new);
                }
            }
        }
        _ => {}
    }
}

/// Another valid value.
pub fn other(planet: &Planet, param: &Param, value: &ValueMut<'_>) -> Value {
    match (value.get(), param.domain) {
        (Value::Number(v), Domain::Number { min, max, .. }) => {
            let by = (v.abs() * 0.05).max((max - min) * 1e-4);
            Value::Number(if v + by <= max { v + by } else { v - by })
        }
        (Value::Count(v), Domain::Count { max, .. }) => Value::Count(if v < max { v + 1 } else { v - 1 }),
        (Value::Count(v), _) => Value::Count(v + 1),
        (Value::Flag(v), _) => Value::Flag(!v),
        (Value::Triple(v), _) => Value::Triple(v.map(|c| if c > 0.5 { c * 0.8 } else { c + 0.1 })),
        (Value::Choice(index), _) => match value {
            ValueMut::Choice(choice) => Value::Choice((index + 1) % choice.names().len()),
            _ => unreachable!(),
        },
        (Value::Curve(_), Domain::Curve { most, .. }) => {
            Value::Curve(vec![[-0.25 * most, -0.2 * most], [0.25 * most, 0.3 * most]])
        }
        (Value::Letter(key), _) if param.name == "key" => {
            let is_free = |key: &char| planet.biomes.palette.iter().all(|biome| biome.key != *key);
            Value::Letter(('a'..='z').rev().find(is_free).unwrap_or(key))
        }
        // A reference to a biome: another one of the palette.
        (Value::Letter(key), _) => {
            let others = planet.biomes.palette.iter().map(|biome| biome.key);
            Value::Letter(others.rev().find(|other| *other != key).unwrap_or(key))
        }
        // A mask's layer: another one. A layer that masks refer to keeps its name.
        (Value::Text(_), _) if param.name == "layer" => Value::Text(planet.layers[2].name.clone()),
        (Value::Text(_), _) if param.name == "population" => {
            Value::Text(planet.life.last().map(|population| population.name.clone()).unwrap_or_default())
        }
        (Value::Text(text), _) => Value::Text(format!("{text}!")),
        (value, _) => value,
    }
}
