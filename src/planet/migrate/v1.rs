//! Presets of version 1: layers of three kinds, six blends, masks by the noise of another layer. Frozen: never edit it.

use super::v2;
use crate::planet::{self, Atmosphere, Biomes, Climate, Clouds, LayerMask, Star, Version, Water};
use serde::Deserialize;

/// The whole file.
#[derive(Deserialize)]
#[serde(rename = "Planet", default, deny_unknown_fields)]
pub(super) struct File {
    version: Version,
    name: String,
    seed: u32,
    radius_km: f64,
    star: Star,
    layers: Vec<Layer>,
    climate: Climate,
    biomes: Biomes,
    water: Option<Water>,
    atmosphere: Option<Atmosphere>,
    clouds: Option<Clouds>,
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Layer {
    name: String,
    enabled: bool,
    seed: u32,
    amplitude_m: f64,
    bias: f64,
    blend: Blend,
    shape: Shape,
    masks: Vec<Mask>,
}

#[derive(Deserialize)]
enum Blend {
    Add,
    Subtract,
    Multiply,
    Max,
    Min,
    Replace,
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Mask {
    layer: String,
    from: f64,
    to: f64,
    invert: bool,
}

#[derive(Deserialize)]
enum Shape {
    Fbm(Fbm),
    Ridged(Ridged),
    Craters(Craters),
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Fbm {
    wavelength_km: f64,
    octaves: u32,
    gain: f64,
    lacunarity: f64,
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Ridged {
    wavelength_km: f64,
    octaves: u32,
    gain: f64,
    lacunarity: f64,
    feedback: f64,
}

#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Craters {
    diameter_km: f64,
    octaves: u32,
    gain: f64,
    lacunarity: f64,
    density: f64,
}

impl Default for File {
    fn default() -> Self {
        Self {
            version: Version(1),
            name: "Unnamed".to_owned(),
            seed: 1,
            radius_km: 6371.0,
            star: Star::default(),
            layers: Vec::new(),
            climate: Climate::default(),
            biomes: Biomes::default(),
            water: None,
            atmosphere: None,
            clouds: None,
        }
    }
}

impl Default for Layer {
    fn default() -> Self {
        Self {
            name: "Layer".to_owned(),
            enabled: true,
            seed: 1,
            amplitude_m: 1000.0,
            bias: 0.0,
            blend: Blend::Add,
            shape: Shape::Fbm(Fbm::default()),
            masks: Vec::new(),
        }
    }
}

impl Default for Mask {
    fn default() -> Self {
        Self { layer: String::new(), from: -0.1, to: 0.1, invert: false }
    }
}

impl Default for Fbm {
    fn default() -> Self {
        Self { wavelength_km: 2000.0, octaves: 12, gain: 0.5, lacunarity: 2.0 }
    }
}

impl Default for Ridged {
    fn default() -> Self {
        Self { wavelength_km: 800.0, octaves: 12, gain: 0.5, lacunarity: 2.0, feedback: 2.0 }
    }
}

impl Default for Craters {
    fn default() -> Self {
        Self { diameter_km: 200.0, octaves: 7, gain: 0.55, lacunarity: 2.0, density: 0.7 }
    }
}

impl From<File> for v2::File {
    fn from(file: File) -> Self {
        let File { version: _, name, seed, radius_km, star, layers, climate, biomes, water, atmosphere, clouds } = file;
        let layers = layers.into_iter().map(planet::Layer::from).collect();
        let height_curve = Vec::new();
        let editor = None;
        let version = Version(2);
        Self {
            version,
            name,
            seed,
            radius_km,
            height_curve,
            star,
            layers,
            climate,
            biomes,
            water,
            atmosphere,
            clouds,
            editor,
        }
    }
}

impl From<Layer> for planet::Layer {
    fn from(layer: Layer) -> Self {
        let Layer { name, enabled, seed, amplitude_m, bias, blend, shape, masks } = layer;
        let masks = masks.into_iter().map(planet::Mask::from).collect();
        let (blend, shape) = (blend.into(), shape.into());
        Self { name, enabled, seed, amplitude_m, bias, blend, shape, masks, curve: Vec::new(), ..Self::default() }
    }
}

impl From<Blend> for planet::Blend {
    fn from(blend: Blend) -> Self {
        match blend {
            Blend::Add => Self::Add,
            Blend::Subtract => Self::Subtract,
            Blend::Multiply => Self::Multiply,
            Blend::Max => Self::Max,
            Blend::Min => Self::Min,
            Blend::Replace => Self::Replace,
        }
    }
}

impl From<Mask> for planet::Mask {
    fn from(mask: Mask) -> Self {
        let Mask { layer, from, to, invert } = mask;
        Self::Layer(LayerMask { layer, from, to, invert })
    }
}

impl From<Shape> for planet::Shape {
    fn from(shape: Shape) -> Self {
        match shape {
            Shape::Fbm(Fbm { wavelength_km, octaves, gain, lacunarity }) => {
                Self::Fbm(planet::Fbm { wavelength_km, octaves, gain, lacunarity })
            }
            Shape::Ridged(Ridged { wavelength_km, octaves, gain, lacunarity, feedback }) => {
                Self::Ridged(planet::Ridged { wavelength_km, octaves, gain, lacunarity, feedback })
            }
            Shape::Craters(Craters { diameter_km, octaves, gain, lacunarity, density }) => {
                // Version 1 knew bowls of one shape.
                let (power, rim, ejecta, floor, peak, age, fresh) = (0.0, 0.28, 1.6, 0.0, 0.0, 0.0, 0.0);
                Self::Craters(planet::Craters {
                    diameter_km,
                    octaves,
                    gain,
                    lacunarity,
                    density,
                    power,
                    rim,
                    ejecta,
                    floor,
                    peak,
                    age,
                    fresh,
                })
            }
        }
    }
}
