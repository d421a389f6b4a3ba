//! Parameters that the editor greys have no effect; those beside them have one.

use crate::support::edits::other;
use std::sync::Arc;
use tellus::planet::param::{ParamPath, Stage, Value};
use tellus::planet::{Layer, Mask, Planet, Shape, Water};
use tellus::sphere::LatLon;
use tellus::terrain::{Terrain, Wanted};

/// Planets of one layer of each landform, each with as few octaves and as many zeros as it can have.
fn barren_planets() -> Vec<Planet> {
    let mut planets = Vec::new();
    for mut shape in Shape::all() {
        for style in 0..3 {
            shape.params().each_param(&mut ParamPath::default(), &mut |_, param, mut value| match param.name {
                "octaves" => value.set(&Value::Count(1)),
                "waviness" | "warp_km" | "age" => value.set(&Value::Number(0.0)),
                "style" => value.set(&Value::Choice(style)),
                _ => {}
            });
            let layer = Layer { shape: shape.clone(), amplitude_m: 3000.0, ..Layer::default() };
            let masks = vec![Mask::default()];
            let second = Layer { name: "Second".to_owned(), masks, seed: 9, ..layer.clone() };
            let mut planet = Planet { layers: vec![layer, second], ..Planet::default() };
            if let [Mask::Layer(mask)] = planet.layers[1].masks.as_mut_slice() {
                mask.layer = "Layer".to_owned();
            }
            planet.water = (style == 0).then(Water::default);
            (planet.climate.temperature_variation_c, planet.climate.moisture_variation) = (0.0, 0.0);
            planets.push(planet);
        }
    }
    planets
}

/// Heights and climate at some places.
fn answers(planet: &Planet) -> Vec<String> {
    let dirs: Vec<_> = (0..60)
        .map(|i| LatLon::from_degrees(-80.0 + f64::from(i) * 2.7, f64::from(i) * 67.3 - 180.0).direction())
        .collect();
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let wanted = Wanted::default().and_climate().and_biome();
    terrain.samples(&dirs, wanted).iter().map(|sample| format!("{sample:?}")).collect()
}

#[test]
fn a_greyed_parameter_of_terrain_or_climate_changes_no_answer() {
    let (mut idle_names, mut effective) = (Vec::new(), 0);
    for planet in barren_planets() {
        let before = answers(&planet);
        let mut places = Vec::new();
        planet.each_value(&mut |path, param, _| {
            let of_ground = [Stage::Height, Stage::Field, Stage::Climate, Stage::ClimateNoise];
            if param.stages.iter().any(|stage| of_ground.contains(&stage)) {
                places.push((path.clone(), param.name));
            }
        });
        for (path, name) in places {
            let idle = planet.idle(&path).is_some();
            // One parameter that has an effect for each that has none is enough.
            if !idle && name != "gain" && name != "seed" {
                continue;
            }
            let mut edited = planet.clone();
            edited.each(&mut |at, param, mut value| {
                if *at == path && param.name == name {
                    let new = other(&planet, param, &value);
                    value.set(&new);
                }
            });
            if edited == planet || edited.check().is_err() {
                continue;
            }
            let same = answers(&edited) == before;
            assert!(same || !idle, "{path} is greyed: {:?}", planet.idle(&path));
            effective += usize::from(!same);
            if idle && !idle_names.contains(&name) {
                idle_names.push(name);
            }
        }
    }
    assert!(idle_names.len() >= 16, "{idle_names:?}");
    assert!(effective > 10, "{effective}");
}
