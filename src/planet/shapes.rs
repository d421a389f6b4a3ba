//! The kinds of terrain layer and the parameters of each. How a kind is evaluated stands in the file of the same name in
//! `terrain/landform`.
//!
//! A new kind: its parameters here, one line in the list of [`Shape`], one file in `terrain/landform`. The list of names,
//! the panels, the file and the messages follow from these.

use super::param::{
    Choice, Domain, Param, ParamPath, Params, Stage, Stages, Unit, ValueMut, Visit, count, linear, log, params,
};
use serde::{Deserialize, Serialize};

/// Writes the enum of all kinds from their list.
macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $kind:ident, )+) => {
        /// The kind of noise of a layer, with the parameters of that kind.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Shape { $( $(#[doc = $doc])+ $kind($kind), )+ }

        impl Shape {
            /// The names of the kinds, in the order of [`Choice::index`].
            pub const NAMES: &'static [&'static str] = &[$( stringify!($kind), )+];

            /// What each kind is, in the same order.
            pub const DOCS: &'static [&'static str] = &[$( concat!($($doc),+).trim_ascii_start(), )+];

            /// One of each kind, with its default parameters.
            pub fn all() -> Vec<Shape> {
                vec![$( Shape::$kind($kind::default()), )+]
            }

            fn params(&mut self) -> &mut dyn Params {
                match self { $( Shape::$kind(shape) => shape, )+ }
            }
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
}

impl Default for Shape {
    fn default() -> Self {
        Shape::Fbm(Fbm::default())
    }
}

impl Shape {
    const KIND: Param = Param {
        name: "shape",
        label: "Kind",
        doc: "The kind of noise this layer is made of.",
        unit: Unit::None,
        domain: Domain::Choice,
        stages: Stages::of(&[Stage::Field]),
    };

    /// Takes over what both kinds have: parameters of the same name, and the size of the largest feature, which is the
    /// first parameter in kilometres of either.
    fn take_from(&mut self, before: &mut Shape) {
        let mut old = Vec::new();
        before.params().each_param(&mut ParamPath::default(), &mut |_, param, value| {
            old.push((param.name, param.unit, value.get()));
        });
        let old_size = old.iter().find(|(_, unit, _)| *unit == Unit::Kilometres).map(|(_, _, value)| value.clone());
        let mut size_seen = false;
        self.params().each_param(&mut ParamPath::default(), &mut |_, param, mut value| {
            let is_size =
                param.unit == Unit::Kilometres && !std::mem::replace(&mut size_seen, param.unit == Unit::Kilometres);
            let same = old.iter().find(|(name, unit, _)| *name == param.name && *unit == param.unit);
            let new = if is_size { old_size.as_ref() } else { same.map(|(_, _, value)| value) };
            if let Some(new) = new.filter(|new| new.problem(param).is_none()) {
                value.set(new);
            }
        });
    }
}

impl Choice for Shape {
    fn names(&self) -> &'static [&'static str] {
        Self::NAMES
    }
    fn index(&self) -> usize {
        Self::all().iter().position(|kind| std::mem::discriminant(kind) == std::mem::discriminant(self)).unwrap_or(0)
    }
    /// Changes the kind and keeps what both kinds have.
    fn set_index(&mut self, index: usize) {
        if let Some(mut kind) = Self::all().into_iter().nth(index).filter(|_| index != self.index()) {
            kind.take_from(self);
            *self = kind;
        }
    }
}

impl Params for Shape {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        visit(path, &Self::KIND, ValueMut::Choice(self));
        self.params().each_param(path, visit);
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
