//! The terrain layers of a preset: what stands in the ordered list, not how it is evaluated (see `terrain`).

use super::param::{
    Choice, Domain, Param, ParamPath, Params, Segment, Stage, Unit, Visit, choice, count, linear, log, params,
};
use serde::{Deserialize, Serialize};

params! {
    /// One layer of terrain. Its noise `v` is about -1 to 1; its output is `y = (v + bias) * amplitude_m`, which `blend`
    /// joins to the height made by the layers above it in the list, as far as the masks let it.
    pub struct Layer {
        /// What the layer is called; masks refer to it by this name, so it must be unique.
        name: String = "Layer".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 48 }, Stage::Label;
        /// Whether the layer takes part. A layer that is off can still serve as a mask.
        enabled: bool = true, "Enabled", Unit::None, Domain::Flag, Stage::Height;
        /// Start of this layer's pseudo-random sequence; another number is another landscape of the same kind.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field;
        /// Height of a full swing of the noise.
        amplitude_m: f64 = 1000.0, "Amplitude", Unit::Metres, log(0.0, 100_000.0), Stage::Height;
        /// Added to the noise before the amplitude: positive raises the whole layer, negative sinks it.
        bias: f64 = 0.0, "Bias", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// How the layer joins the height below it.
        blend: Blend = Blend::Add, "Blend", Unit::None, Domain::Choice, Stage::Height;
    } with {
        /// The kind of noise and its parameters.
        shape: Shape = Shape::default();
        /// Where the layer acts; several masks multiply.
        masks: Vec<Mask> = Vec::new();
    }
}

choice! {
    /// How a layer's output `y` joins the height `h` of the layers before it.
    pub enum Blend {
        /// `h + y`
        Add = "Add",
        /// `h - y`
        Subtract = "Subtract",
        /// `h * (v + bias)`: the layer scales what is there; its amplitude plays no part.
        Multiply = "Multiply",
        /// The greater of `h` and `y`.
        Max = "Max",
        /// The lesser of `h` and `y`.
        Min = "Min",
        /// `y` alone.
        Replace = "Replace",
    }
}

/// The kind of noise of a layer, with the parameters of that kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// Rolling ground: octaves of gradient noise summed.
    Fbm(Fbm),
    /// Mountain chains: octaves of noise folded into crests.
    Ridged(Ridged),
    /// Impact craters of many sizes.
    Craters(Craters),
}

impl Default for Shape {
    fn default() -> Self {
        Shape::Fbm(Fbm::default())
    }
}

impl Shape {
    /// The names of the kinds, in the order of [`Choice::index`].
    pub const NAMES: &'static [&'static str] = &["Fbm", "Ridged", "Craters"];
    const KIND: Param = Param {
        name: "shape",
        label: "Kind",
        doc: "The kind of noise this layer is made of.",
        unit: Unit::None,
        domain: Domain::Choice,
        stage: Stage::Field,
    };
}

impl Choice for Shape {
    fn names(&self) -> &'static [&'static str] {
        Self::NAMES
    }
    fn index(&self) -> usize {
        match self {
            Shape::Fbm(_) => 0,
            Shape::Ridged(_) => 1,
            Shape::Craters(_) => 2,
        }
    }
    /// Changes the kind and keeps what both kinds have.
    fn set_index(&mut self, index: usize) {
        let (wavelength_km, octaves, gain, lacunarity) = match self {
            Shape::Fbm(s) => (s.wavelength_km, s.octaves, s.gain, s.lacunarity),
            Shape::Ridged(s) => (s.wavelength_km, s.octaves, s.gain, s.lacunarity),
            Shape::Craters(s) => (s.diameter_km, s.octaves, s.gain, s.lacunarity),
        };
        match index {
            0 => *self = Shape::Fbm(Fbm { wavelength_km, octaves, gain, lacunarity }),
            1 => *self = Shape::Ridged(Ridged { wavelength_km, octaves, gain, lacunarity, ..Ridged::default() }),
            2 => {
                let craters = Craters { diameter_km: wavelength_km, octaves, gain, lacunarity, ..Craters::default() };
                *self = Shape::Craters(craters);
            }
            _ => {}
        }
    }
}

impl Params for Shape {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        let before = self.index();
        visit(path, &Self::KIND, super::param::ValueMut::Choice(self));
        debug_assert!(before < Self::NAMES.len());
        match self {
            Shape::Fbm(shape) => shape.each_param(path, visit),
            Shape::Ridged(shape) => shape.each_param(path, visit),
            Shape::Craters(shape) => shape.each_param(path, visit),
        }
    }
}

params! {
    /// Fractal Brownian motion: octaves of gradient noise, each finer and weaker than the one before, summed and divided
    /// by the sum of their strengths.
    pub struct Fbm {
        /// Distance from crest to crest of the coarsest octave.
        wavelength_km: f64 = 2000.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

params! {
    /// Ridged multifractal (Musgrave): noise folded at zero into crests; each octave is strong where the one before was,
    /// so that valleys stay smooth and crests grow sharp. Shifted to about -1 (valley) to 1 (crest).
    pub struct Ridged {
        /// Distance between neighbouring ranges of the coarsest octave.
        wavelength_km: f64 = 800.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// How much a crest of one octave strengthens the next: 0 is rough everywhere, 2 keeps valleys smooth.
        feedback: f64 = 2.0, "Feedback", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Impact craters: bowls with a raised rim, from -1 (floor) to about 0.3 (rim); each octave is a smaller size.
    pub struct Craters {
        /// Diameter of the widest craters.
        diameter_km: f64 = 200.0, "Diameter", Unit::Kilometres, log(0.001, 50_000.0), Stage::Field;
        /// How many sizes there are; each one more halves the smallest crater (at lacunarity 2).
        octaves: u32 = 7, "Octaves", Unit::None, count(1, 20), Stage::Field;
        /// Depth of each size against the one before.
        gain: f64 = 0.55, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Smallness of each size against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Share of the ground that has been hit, for each size.
        density: f64 = 0.7, "Density", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// Lets a layer act only where another layer's noise is in a range.
    pub struct Mask {
        /// Name of the layer whose noise decides.
        layer: String = String::new(), "Layer", Unit::None, Domain::Text { max_chars: 48 }, Stage::Height;
        /// Noise value at which the layer is fully off.
        from: f64 = -0.1, "From", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// Noise value at which the layer is fully on; between the two it fades smoothly.
        to: f64 = 0.1, "To", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// Off where it would be on, and the reverse.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

/// Gives each list element its place in a path, for panels that work on one element at a time.
pub fn layer_path(index: usize) -> ParamPath {
    ParamPath::from(vec![Segment::Field("layers"), Segment::Index(index)])
}
