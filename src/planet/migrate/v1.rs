//! Presets of version 1: layers of three kinds, six blends, masks by the noise of another layer. Frozen: never edit it.

use super::frozen::{Migrate, frozen, frozen_choice};
use super::v2;
use crate::planet::Version;

/// The whole file. Types that are missing here were the same in version 2.
#[derive(serde::Deserialize)]
#[serde(rename = "Planet", default, deny_unknown_fields)]
pub(super) struct File {
    version: Version,
    name: String,
    seed: u32,
    radius_km: f64,
    star: v2::Star,
    layers: Vec<Layer>,
    climate: v2::Climate,
    biomes: v2::Biomes,
    water: Option<v2::Water>,
    atmosphere: Option<v2::Atmosphere>,
    clouds: Option<v2::Clouds>,
}

impl Default for File {
    fn default() -> Self {
        Self {
            version: Version(1),
            name: "Unnamed".to_owned(),
            seed: 1,
            radius_km: 6371.0,
            star: v2::Star::default(),
            layers: Vec::new(),
            climate: v2::Climate::default(),
            biomes: v2::Biomes::default(),
            water: None,
            atmosphere: None,
            clouds: None,
        }
    }
}

impl Migrate<v2::File> for File {
    fn migrate(self) -> v2::File {
        v2::File {
            version: self.version.migrate(),
            name: self.name,
            seed: self.seed,
            radius_km: self.radius_km,
            star: self.star,
            layers: self.layers.migrate(),
            climate: self.climate,
            biomes: self.biomes,
            water: self.water,
            atmosphere: self.atmosphere,
            clouds: self.clouds,
            ..v2::File::default()
        }
    }
}

frozen! {
    "Layer" Layer => v2::Layer {
        name: String = "Layer".to_owned(),
        enabled: bool = true,
        seed: u32 = 1,
        amplitude_m: f64 = 1000.0,
        bias: f64 = 0.0,
        blend: Blend = Blend::Add,
        shape: Shape = Shape::Fbm(v2::Fbm::default()),
        masks: Vec<Mask> = Vec::new(),
    } adding { softness_m: 100.0, curve: Vec::new() }
}

frozen_choice! { Blend => v2::Blend { Add, Subtract, Multiply, Max, Min, Replace } }

#[derive(serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Mask {
    layer: String,
    from: f64,
    to: f64,
    invert: bool,
}

impl Default for Mask {
    fn default() -> Self {
        Self { layer: String::new(), from: -0.1, to: 0.1, invert: false }
    }
}

impl Migrate<v2::Mask> for Mask {
    fn migrate(self) -> v2::Mask {
        let Mask { layer, from, to, invert } = self;
        v2::Mask::Layer(v2::LayerMask { layer, from, to, invert })
    }
}

#[derive(serde::Deserialize)]
pub(super) enum Shape {
    Fbm(v2::Fbm),
    Ridged(v2::Ridged),
    Craters(Craters),
}

impl Migrate<v2::Shape> for Shape {
    fn migrate(self) -> v2::Shape {
        match self {
            Shape::Fbm(fbm) => v2::Shape::Fbm(fbm),
            Shape::Ridged(ridged) => v2::Shape::Ridged(ridged),
            Shape::Craters(craters) => v2::Shape::Craters(craters.migrate()),
        }
    }
}

frozen! {
    /// Craters of one shape: bowls.
    "Craters" Craters => v2::Craters {
        diameter_km: f64 = 200.0,
        octaves: u32 = 7,
        gain: f64 = 0.55,
        lacunarity: f64 = 2.0,
        density: f64 = 0.7,
    } adding { power: 0.0, rim: 0.28, ejecta: 1.6, floor: 0.0, peak: 0.0, age: 0.0, fresh: 0.0 }
}
