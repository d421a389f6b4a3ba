//! The kinds of terrain layer and the parameters of each. How a kind is evaluated stands in the file of the same name in
//! `terrain/landform`.
//!
//! A new kind: its parameters here, one line in the list of kinds, one file in `terrain/landform`. The list of names,
//! the panels, the file and the messages follow from these.

use super::kinds::kinds;
use super::param::{Stage, Unit, count, linear, log, params};

/// Writes the enum from the list of kinds, each of which is also the name of its parameters.
macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $kind:ident, )+) => {
        kinds! {
            /// The kind of terrain that this layer is made of.
            pub enum Shape: "shape", "Kind", Stage::Field;
            $( $(#[doc = $doc])+ $kind($kind), )+
        }
    };
}

shapes! {
    /// Rolling ground: octaves of gradient noise summed.
    Fbm,
    /// Mountain chains: octaves of noise folded into crests.
    Ridged,
    /// Impact craters of many sizes.
    Craters,
    /// Steps cut into the ground that the layers before have made.
    Terraces,
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
    /// Terraces: the height made by the layers before is cut into flat treads with steep risers between them, one step for each
    /// `amplitude_m`. The layer's noise is the way from that height to its step, -0.5 to 0.5, so that it belongs with the blend
    /// Add. Masks on it look at the noise of its waviness.
    pub struct Terraces {
        /// How flat the treads are and how steep the risers: 0 leaves the ground as it is, 1 makes stairs.
        sharpness: f64 = 0.8, "Sharpness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// How far noise raises and lowers the steps, as a share of a step.
        waviness: f64 = 0.5, "Waviness", Unit::None, linear(0.0, 4.0), Stage::Height;
        /// Distance from crest to crest of that noise's coarsest octave.
        wavelength_km: f64 = 30.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves that noise has; each one more halves the smallest feature.
        octaves: u32 = 4, "Octaves", Unit::None, count(1, 24), Stage::Field;
    }
}
