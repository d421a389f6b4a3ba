//! The kinds of terrain layer and the parameters of each. How a kind is evaluated stands in the file of the same name in
//! `terrain/landform`.
//!
//! A new kind: its parameters here, one line in the list of [`Shape`], one file in `terrain/landform`. The list of names,
//! the panels, the file and the messages follow from these.

use super::param::{
    Choice, Domain, Param, ParamPath, Params, Stage, Unit, ValueMut, Visit, count, linear, log, params,
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
    /// Rounded hills between creased valleys: octaves of folded noise.
    Billow,
    /// Smooth valleys and rough peaks: octaves that count less where the ground is steep already.
    Damped,
    /// Swirling, folded ground: octaves summed at points displaced by other noise.
    Warped,
    /// Continents and oceans with shelves, slopes and abyssal plains: the base of most planets.
    Continents,
    /// Meandering valleys with flat floors, walls and tributaries.
    Canyons,
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
        stage: Stage::Field,
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

params! {
    /// Billow noise: each octave folded at zero, the other way round than `Ridged`, so that hills are round and the valleys
    /// between them creases. From -1 (valleys) to 1 (tops).
    pub struct Billow {
        /// Distance between neighbouring hills of the coarsest octave.
        wavelength_km: f64 = 100.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 8, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.4, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

params! {
    /// Slope-damped fractal noise (Quilez): an octave counts less where those before it have made the ground steep, as if
    /// rain had worn the slopes down into wide, smooth valleys below rough peaks. About -1 to 1; damping lowers the mean.
    pub struct Damped {
        /// Distance from crest to crest of the coarsest octave.
        wavelength_km: f64 = 400.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// How strongly slope smooths: 0 is plain fractal noise.
        damping: f64 = 0.12, "Damping", Unit::None, log(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Fractal noise at points displaced by another fractal noise, which draws its features out into swirls and folds. About
    /// -1 to 1.
    pub struct Warped {
        /// Distance from crest to crest of the coarsest octave.
        wavelength_km: f64 = 1000.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// How far points are displaced.
        warp_km: f64 = 300.0, "Warp", Unit::Kilometres, log(0.0, 100_000.0), Stage::Field;
        /// Distance over which the displacement changes.
        warp_wavelength_km: f64 = 1000.0, "Warp wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves the displacement has: 1 bends, more curl and fray.
        warp_octaves: u32 = 3, "Warp octaves", Unit::None, count(1, 8), Stage::Field;
    }
}

params! {
    /// Continents and oceans: warped fractal noise, put through a profile with shares of the surface as on the Earth. -1 is the
    /// abyssal plain, 0 the coast; a continental slope leads up to the shelf, a coastal plain to the interior, up to 1.
    pub struct Continents {
        /// Size of the continents.
        wavelength_km: f64 = 5500.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 14, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher frays the coasts and scatters islands.
        gain: f64 = 0.56, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Displacement of the coasts against the wavelength: 0 is blobs, more draws out peninsulas, gulfs and straits.
        warp: f64 = 0.3, "Warp", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Share of the surface that lies above 0.
        land: f64 = 0.32, "Land", Unit::None, linear(0.02, 0.98), Stage::Field;
        /// Share of the sea floor that is shallow shelf.
        shelf: f64 = 0.2, "Shelf", Unit::None, linear(0.01, 0.6), Stage::Field;
    }
}

params! {
    /// Valleys along the zero lines of warped noise: 0 outside them, -1 on the floor of the largest.
    pub struct Canyons {
        /// Distance between the largest valleys.
        wavelength_km: f64 = 200.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many sizes of valley there are: 1 is the largest alone, each one more adds tributaries.
        octaves: u32 = 3, "Octaves", Unit::None, count(1, 12), Stage::Field;
        /// Depth of tributaries against the valleys that they lead to.
        gain: f64 = 0.6, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Smallness of tributaries, in width and distance, against the valleys that they lead to.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Width of the largest valleys from rim to rim.
        width_km: f64 = 8.0, "Width", Unit::Kilometres, log(0.001, 10_000.0), Stage::Field;
        /// Share of the width that is flat floor: 0 is a valley like a V, near 1 a trench between cliffs.
        steepness: f64 = 0.35, "Steepness", Unit::None, linear(0.0, 0.95), Stage::Field;
        /// How far the valleys wind: 0 is nearly straight.
        meander: f64 = 0.5, "Meander", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}
