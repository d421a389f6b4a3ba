//! The kinds of terrain layer and the parameters of each. How a kind is evaluated stands in the file of the same name in
//! `terrain/landform`.
//!
//! A new kind: its parameters here, one line in the list of [`Shape`], one file in `terrain/landform`. The list of names,
//! the panels, the file and the messages follow from these.

use super::param::{
    Choice, Domain, Param, ParamPath, Params, Stage, Unit, ValueMut, Visit, choice, count, linear, log, params,
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
    /// Dunes: crests across the wind, gentle before it and steep behind.
    Dunes,
    /// Eroded mountains: gullies and ridges that run down the slope and branch.
    Gullies,
    /// Cells around scattered centres: plates, cracks or domes.
    Cells,
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
        /// Share of the ground that has been hit, for each size; with a power of counts, by the widest.
        density: f64 = 0.7, "Density", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How much more numerous craters are the smaller they are: the power of their cumulative count, about 2.4 on moons,
        /// until the ground is full of them. At 0 the sizes are mixed evenly.
        power: f64 = 0.0, "Power of counts", Unit::None, linear(0.0, 4.0), Stage::Field;
        /// Height of the rim against the depth of the bowl.
        rim: f64 = 0.28, "Rim", Unit::None, linear(0.0, 0.6), Stage::Field;
        /// How far the ejecta reach, in radii of the crater.
        ejecta: f64 = 1.6, "Ejecta", Unit::None, linear(1.1, 1.6), Stage::Field;
        /// How much of the radius of the widest craters is flat floor; small craters are bowls.
        floor: f64 = 0.0, "Flat floor", Unit::None, linear(0.0, 0.8), Stage::Field;
        /// Height of the peak in the middle of the widest craters against their depth.
        peak: f64 = 0.0, "Central peak", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How worn the oldest craters are: shallow, without a rim. Each crater has its own age up to this.
        age: f64 = 0.0, "Age", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Share of craters that are fresh whatever the age of the rest.
        fresh: f64 = 0.0, "Fresh", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// Dunes: crests that stand across the wind, fork and end as real ones do, from -1 (trough) to 1 (crest).
    pub struct Dunes {
        /// Distance from crest to crest of the largest dunes.
        wavelength_km: f64 = 1.5, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many sizes of dunes ride on one another.
        octaves: u32 = 2, "Octaves", Unit::None, count(1, 8), Stage::Field;
        /// Height of each size against the one before.
        gain: f64 = 0.2, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Smallness of each size against the one before.
        lacunarity: f64 = 4.0, "Lacunarity", Unit::None, linear(1.5, 10.0), Stage::Field;
        /// Heading towards which the wind blows: 0 is north, 90 east.
        wind_deg: f64 = 90.0, "Wind", Unit::Degrees, linear(-180.0, 360.0), Stage::Field;
        /// How much steeper the lee is than the side before the wind: 0 is as steep, 1 breaks off at a sharp crest.
        asymmetry: f64 = 0.8, "Asymmetry", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How far the crests bend to and fro.
        waviness: f64 = 0.5, "Waviness", Unit::None, linear(0.0, 2.0), Stage::Field;
    }
}

params! {
    /// Mountains as running water carves them: smooth relief, and gullies that run down its slopes and branch.
    pub struct Gullies {
        /// Distance from crest to crest of the relief that is carved.
        wavelength_km: f64 = 60.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves the relief has. Those much coarser than the gullies lead them; finer ones roughen the ground.
        octaves: u32 = 2, "Octaves", Unit::None, count(1, 16), Stage::Field;
        /// Strength of each octave, of the relief as of the gullies, against the one before.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave, of the relief as of the gullies, against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Distance between neighbouring gullies of the coarsest kind.
        gully_km: f64 = 8.0, "Gullies", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves of gullies branch off one another.
        gully_octaves: u32 = 5, "Gully octaves", Unit::None, count(1, 16), Stage::Field;
        /// How deep the gullies are against their width: 1 is about as steep as the relief.
        depth: f64 = 1.0, "Depth", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Cells: each point of the ground belongs to the nearest of many scattered centres.
    pub struct Cells {
        /// Distance between neighbouring centres of the coarsest octave, on average.
        cell_km: f64 = 800.0, "Cell size", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// What is made of the cells.
        style: CellStyle = CellStyle::Plates, "Style", Unit::None, Domain::Choice, Stage::Field;
        /// Width of the slopes between plates, or of the cracks, in cells. Domes have none.
        width: f64 = 0.2, "Border width", Unit::None, log(0.005, 1.0), Stage::Field;
        /// How irregular the cells are: at 0 the centres stand in rows.
        jitter: f64 = 1.0, "Jitter", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How many octaves are summed, each of smaller cells.
        octaves: u32 = 1, "Octaves", Unit::None, count(1, 12), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

choice! {
    /// What is made of cells.
    pub enum CellStyle {
        /// Each cell is a plain at a random level, -1 to 1, and slopes join them.
        Plates = "Plates",
        /// The borders are cracks, from 0 (the ground) down to -1.
        Cracks = "Cracks",
        /// Each cell is a dome, from 1 (its top) down to about 0 where it meets the next.
        Bumps = "Bumps",
    }
}
