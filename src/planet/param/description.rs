//! What a parameter means: its name, unit and domain.

use super::stage::Stages;
use crate::planet::MAX_BIOMES;

/// The unit a value is written in, in files and on sliders alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Unit {
    None,
    Metres,
    Kilometres,
    Degrees,
    Celsius,
    CelsiusPerKilometre,
    PerKilometre,
    PerMetre,
    MetresPerSecond,
    CubicMetresPerSecond,
    KilometresPerHour,
    KilometresPerSecond,
    Millimetres,
    MillimetresPerYear,
    Hours,
    MillionYears,
    Earths,
    Kelvin,
}

impl Unit {
    /// The symbol after a number, empty for plain numbers.
    pub fn symbol(self) -> &'static str {
        match self {
            Unit::None => "",
            Unit::Metres => "m",
            Unit::Kilometres => "km",
            Unit::Degrees => "°",
            Unit::Celsius => "°C",
            Unit::CelsiusPerKilometre => "°C/km",
            Unit::PerKilometre => "1/km",
            Unit::PerMetre => "1/m",
            Unit::MetresPerSecond => "m/s",
            Unit::CubicMetresPerSecond => "m³/s",
            Unit::KilometresPerHour => "km/h",
            Unit::KilometresPerSecond => "km/s",
            Unit::Millimetres => "mm",
            Unit::MillimetresPerYear => "mm/yr",
            Unit::Hours => "h",
            Unit::MillionYears => "Myr",
            Unit::Earths => "Earths",
            Unit::Kelvin => "K",
        }
    }
}

/// The values a parameter may take, and the scale of its slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// A number from `min` to `max`.
    Number {
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
        /// Whether equal slider steps are equal ratios.
        logarithmic: bool,
    },
    /// Three numbers, one for each of red, green and blue, each from 0 to `max`.
    Triple {
        /// Largest value allowed for each component.
        max: f64,
    },
    /// A whole number from `min` to `max`.
    Count {
        /// Smallest value allowed.
        min: u32,
        /// Largest value allowed.
        max: u32,
    },
    /// Any 32-bit number: the start of a pseudo-random sequence.
    Seed,
    /// On or off.
    Flag,
    /// Linear sRGB, each component from 0 to 1.
    Color,
    /// One of a few named values.
    Choice,
    /// A function through points `[x, y]` in ascending order of x. An empty curve changes nothing.
    Curve {
        /// Largest absolute value of x and of y.
        most: f64,
        /// Smallest distance between neighbouring points along x.
        least_step: f64,
    },
    /// One letter or digit.
    Letter,
    /// The key of a biome of the palette.
    BiomeKey,
    /// Keys of biomes of the palette, as a text; empty for all.
    BiomeKeys,
    /// A line of text of at most this many characters.
    Text {
        /// Most characters allowed.
        max_chars: usize,
    },
    /// The name of a painted mask: at most this many characters.
    MaskName {
        /// Most characters allowed.
        max_chars: usize,
    },
    /// The name of a population: at most this many characters.
    PopulationName {
        /// Most characters allowed.
        max_chars: usize,
        /// What an empty name means.
        none: &'static str,
    },
    /// The path of a file, relative to the preset's folder or absolute; at most this many characters.
    File {
        /// Most characters allowed.
        max_chars: usize,
    },
}

/// A number on a linear slider.
pub const fn linear(min: f64, max: f64) -> Domain {
    Domain::Number { min, max, logarithmic: false }
}

/// A number on a logarithmic slider. `min` may be zero; the slider then starts at a small value.
pub const fn log(min: f64, max: f64) -> Domain {
    Domain::Number { min, max, logarithmic: true }
}

/// A coefficient for each of red, green and blue.
pub const fn triple(max: f64) -> Domain {
    Domain::Triple { max }
}

/// A whole number.
pub const fn count(min: u32, max: u32) -> Domain {
    Domain::Count { min, max }
}

/// The points of a curve; see [`Domain::Curve`].
pub type Curve = Vec<[f64; 2]>;

/// Most points of a curve.
pub const MAX_CURVE_POINTS: usize = 16;

/// The description of a parameter. All descriptions are constants written by the macros of [`super`].
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// The field's name in the file.
    pub name: &'static str,
    /// The name a person reads, in sentence case.
    pub label: &'static str,
    /// One or two sentences: what it does.
    pub doc: &'static str,
    /// The unit it is written in.
    pub unit: Unit,
    /// The values it may take.
    pub domain: Domain,
    /// The stages that read the parameter itself; [`Stages::with_consequences`] adds those that follow.
    pub stages: Stages,
}

impl Param {
    /// The range in words, with the unit: `"0.1 to 200 km"`. Empty for flags, colours, seeds and text.
    pub fn range_text(&self) -> String {
        let unit = self.unit.symbol();
        let gap = if unit.is_empty() || unit == "°" { "" } else { " " };
        match self.domain {
            Domain::Number { min, max, .. } => format!("{min} to {max}{gap}{unit}"),
            Domain::Count { min, max } => format!("{min} to {max}"),
            Domain::Triple { max } => format!("0 to {max}{gap}{unit} each"),
            Domain::Color => "0 to 1 each".to_owned(),
            Domain::Text { max_chars }
            | Domain::MaskName { max_chars }
            | Domain::PopulationName { max_chars, .. }
            | Domain::File { max_chars } => {
                format!("at most {max_chars} characters")
            }
            Domain::BiomeKeys => format!("at most {MAX_BIOMES} keys of biomes"),
            Domain::Letter | Domain::BiomeKey => "one letter, digit or punctuation mark".to_owned(),
            Domain::Curve { most, .. } => {
                format!("2 to {MAX_CURVE_POINTS} points, each from {} to {most}{gap}{unit}", -most)
            }
            Domain::Seed | Domain::Flag | Domain::Choice => String::new(),
        }
    }
}
