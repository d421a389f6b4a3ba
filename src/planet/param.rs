//! One description for each parameter, and the visitor through which everything reaches them.
//!
//! A [`Param`] says what a value means, its unit, range, scale and default, and which [`Stages`] of a rebuild
//! an edit to it makes stale. Sliders, tooltips, validation messages, the comments of a saved file, random
//! planets and the diff of two planets are all written against [`Params::each_param`]; none of them knows a
//! parameter by name. The `params!` macro writes the struct, its defaults and its description from one place.

use std::fmt;

/// A part of what is made from a planet; an edit makes some of them stale.
///
/// The first four are kept in tiles; the rest lives in small textures and uniforms and rebuilds no vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Noise values and gradients of one layer: kind, seed, wavelength, octaves, ...
    Field,
    /// How layers are combined: amplitude, order, enabled, blend, masks.
    Height,
    /// Noise of temperature and moisture: seed, size of regions, octaves.
    ClimateNoise,
    /// Temperature and moisture at the surface, and with them the finished vertices.
    Climate,
    /// The biome table and its palette: one small texture.
    Material,
    /// The cloud coverage map.
    CloudMap,
    /// Scattering look-up tables.
    AirTables,
    /// Uniforms: water, star, rock, drift of the clouds.
    Uniform,
    /// Nothing that is drawn: names, figures.
    Label,
}

impl Stage {
    /// All of them, in the order in which they run.
    pub const ALL: [Stage; 9] = [
        Stage::Field,
        Stage::Height,
        Stage::ClimateNoise,
        Stage::Climate,
        Stage::Material,
        Stage::CloudMap,
        Stage::AirTables,
        Stage::Uniform,
        Stage::Label,
    ];

    /// The stages that take what this one makes.
    const fn consequences(self) -> Stages {
        match self {
            Stage::Field => Stages::of(&[Stage::Height, Stage::Climate]),
            Stage::Height | Stage::ClimateNoise => Stages::of(&[Stage::Climate]),
            // Drawn by shaders that read the parameters from the uniforms.
            Stage::CloudMap | Stage::AirTables => Stages::of(&[Stage::Uniform]),
            Stage::Climate | Stage::Material | Stage::Uniform | Stage::Label => Stages::NONE,
        }
    }
}

/// A set of stages.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Stages(u16);

impl Stages {
    /// No stage.
    pub const NONE: Stages = Stages(0);

    /// The stages whose results are kept in tiles.
    pub const OF_TILES: Stages = Stages::of(&[Stage::Field, Stage::Height, Stage::ClimateNoise, Stage::Climate]);

    /// These stages.
    pub const fn of(stages: &[Stage]) -> Self {
        let (mut set, mut i) = (0, 0);
        while i < stages.len() {
            set |= 1 << stages[i] as u16;
            i += 1;
        }
        Self(set)
    }

    /// Whether a stage is among them.
    pub const fn contains(self, stage: Stage) -> bool {
        self.0 & (1 << stage as u16) != 0
    }

    /// Whether there are none.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Those of either set.
    pub const fn and(self, other: Stages) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that are in both sets.
    pub const fn within(self, other: Stages) -> Self {
        Self(self.0 & other.0)
    }

    /// Those that are not in the other set.
    pub const fn without(self, other: Stages) -> Self {
        Self(self.0 & !other.0)
    }

    /// The stages in the order in which they run.
    pub fn iter(self) -> impl Iterator<Item = Stage> {
        Stage::ALL.into_iter().filter(move |stage| self.contains(*stage))
    }

    /// They and every stage that takes what one of them makes.
    pub fn with_consequences(self) -> Self {
        self.iter().fold(self, |all, stage| all.and(stage.consequences()))
    }

    /// Whether any of them rebuilds tiles on the CPU.
    pub const fn touches_tiles(self) -> bool {
        !self.within(Self::OF_TILES).is_empty()
    }
}

impl fmt::Debug for Stages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

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
    KilometresPerHour,
    Millimetres,
    Hours,
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
            Unit::KilometresPerHour => "km/h",
            Unit::Millimetres => "mm",
            Unit::Hours => "h",
        }
    }
}

/// Which values a parameter may take, and how a slider walks through them.
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
    /// A function drawn through points `[x, y]`, from left to right; none means that it changes nothing.
    Curve {
        /// Farthest a point may lie from zero, along either axis.
        most: f64,
        /// How far apart neighbouring points must be along x.
        least_step: f64,
    },
    /// One letter or digit.
    Letter,
    /// The key of a biome of the palette.
    BiomeKey,
    /// A line of text of at most this many characters.
    Text {
        /// Most characters allowed.
        max_chars: usize,
    },
    /// The path of a file, from the preset's folder on or whole; at most this many characters.
    File {
        /// Most characters allowed.
        max_chars: usize,
    },
}

/// A number on a linear slider.
pub const fn linear(min: f64, max: f64) -> Domain {
    Domain::Number { min, max, logarithmic: false }
}

/// A number on a logarithmic slider; `min` may be zero (the slider then starts at a small value).
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

/// What a parameter is. Found by [`Params::each_param`]; never made at run time.
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
    /// The stages an edit makes stale by itself; what takes their results follows ([`Stages::with_consequences`]).
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
            Domain::Text { max_chars } | Domain::File { max_chars } => format!("at most {max_chars} characters"),
            Domain::Letter | Domain::BiomeKey => "one letter, digit or punctuation mark".to_owned(),
            Domain::Curve { most, .. } => {
                format!("2 to {MAX_CURVE_POINTS} points, each from {} to {most}{gap}{unit}", -most)
            }
            Domain::Seed | Domain::Flag | Domain::Choice => String::new(),
        }
    }
}

/// One of a few named values: an enum without fields.
pub trait Choice {
    /// The names, in the order of their index, as a person reads them.
    fn names(&self) -> &'static [&'static str];
    /// The current one.
    fn index(&self) -> usize;
    /// Makes the `index`th one current; an index out of range changes nothing.
    fn set_index(&mut self, index: usize);
}

/// A parameter's place in the planet, to read or to write.
pub enum ValueMut<'a> {
    /// See [`Domain::Number`].
    Number(&'a mut f64),
    /// See [`Domain::Count`] and [`Domain::Seed`].
    Count(&'a mut u32),
    /// See [`Domain::Flag`].
    Flag(&'a mut bool),
    /// See [`Domain::Color`] and [`Domain::Triple`].
    Triple(&'a mut [f64; 3]),
    /// See [`Domain::Text`] and [`Domain::File`].
    Text(&'a mut String),
    /// See [`Domain::Letter`] and [`Domain::BiomeKey`].
    Letter(&'a mut char),
    /// See [`Domain::Curve`].
    Curve(&'a mut Curve),
    /// See [`Domain::Choice`].
    Choice(&'a mut dyn Choice),
}

/// A parameter's value, taken out of its planet: for diffs, resets and messages.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Value {
    Number(f64),
    Count(u32),
    Flag(bool),
    Triple([f64; 3]),
    Text(String),
    Letter(char),
    Curve(Curve),
    Choice(usize),
}

impl ValueMut<'_> {
    /// A copy of the value.
    pub fn get(&self) -> Value {
        match self {
            ValueMut::Number(v) => Value::Number(**v),
            ValueMut::Count(v) => Value::Count(**v),
            ValueMut::Flag(v) => Value::Flag(**v),
            ValueMut::Triple(v) => Value::Triple(**v),
            ValueMut::Text(v) => Value::Text((*v).clone()),
            ValueMut::Letter(v) => Value::Letter(**v),
            ValueMut::Curve(v) => Value::Curve((*v).clone()),
            ValueMut::Choice(v) => Value::Choice(v.index()),
        }
    }

    /// Writes a value of the same type; a value of another type is left alone.
    pub fn set(&mut self, value: &Value) {
        match (self, value) {
            (ValueMut::Number(v), Value::Number(new)) => **v = *new,
            (ValueMut::Count(v), Value::Count(new)) => **v = *new,
            (ValueMut::Flag(v), Value::Flag(new)) => **v = *new,
            (ValueMut::Triple(v), Value::Triple(new)) => **v = *new,
            (ValueMut::Text(v), Value::Text(new)) => (*v).clone_from(new),
            (ValueMut::Letter(v), Value::Letter(new)) => **v = *new,
            (ValueMut::Curve(v), Value::Curve(new)) => (*v).clone_from(new),
            (ValueMut::Choice(v), Value::Choice(new)) => v.set_index(*new),
            _ => debug_assert!(false, "a parameter never changes its type"),
        }
    }
}

impl Value {
    /// What is wrong with this value for `param` and what would be right, or `None`.
    pub fn problem(&self, param: &Param) -> Option<String> {
        let out_of_range = |shown: String| Some(format!("{shown} is out of range; use {}", param.range_text()));
        match (self, param.domain) {
            (Value::Number(v), Domain::Number { .. }) if !v.is_finite() => {
                Some(format!("{v} is not a finite number; use {}", param.range_text()))
            }
            (Value::Number(v), Domain::Number { min, max, .. }) if *v < min || *v > max => out_of_range(v.to_string()),
            (Value::Count(v), Domain::Count { min, max }) if *v < min || *v > max => out_of_range(v.to_string()),
            (Value::Triple(v), Domain::Color | Domain::Triple { .. }) => {
                let max = if let Domain::Triple { max } = param.domain { max } else { 1.0 };
                let bad = v.iter().find(|c| !c.is_finite() || **c < 0.0 || **c > max)?;
                if bad.is_finite() {
                    out_of_range(bad.to_string())
                } else {
                    Some(format!("{bad} is not a finite number; use {}", param.range_text()))
                }
            }
            (Value::Text(v), Domain::Text { max_chars } | Domain::File { max_chars }) => {
                if v.chars().count() > max_chars {
                    Some(format!("{} characters are too many; use {}", v.chars().count(), param.range_text()))
                } else if v.chars().any(char::is_control) {
                    Some("control characters are not allowed; use plain text on one line".to_owned())
                } else {
                    None
                }
            }
            (Value::Curve(points), Domain::Curve { most, least_step }) => {
                curve_problem(points, most, least_step, param)
            }
            (Value::Letter(v), Domain::Letter | Domain::BiomeKey)
                if !v.is_ascii_graphic() || matches!(v, '"' | '\\') =>
            {
                Some(format!("{v:?} cannot be a key; use {}", param.range_text()))
            }
            _ => None,
        }
    }
}

/// What is wrong with the points of a curve; the first is number 1.
fn curve_problem(points: &[[f64; 2]], most: f64, least_step: f64, param: &Param) -> Option<String> {
    match points {
        [] => return None,
        [_] => return Some("one point makes no curve; add another, or use `[]` for none".to_owned()),
        _ if points.len() > MAX_CURVE_POINTS => {
            return Some(format!("{} points are too many; use at most {MAX_CURVE_POINTS}", points.len()));
        }
        _ => {}
    }
    for (i, point) in points.iter().enumerate() {
        if let Some(bad) = point.iter().find(|v| !v.is_finite() || v.abs() > most) {
            return Some(format!("point {} has {bad}, which is out of range; use {}", i + 1, param.range_text()));
        }
    }
    points.windows(2).enumerate().find(|(_, pair)| pair[1][0] - pair[0][0] < least_step).map(|(i, pair)| {
        let (number, x, before) = (i + 2, pair[1][0], pair[0][0]);
        let least = format!("{least_step}{}{}", if param.unit == Unit::None { "" } else { " " }, param.unit.symbol());
        format!(
            "point {number} has x {x}, the one before it {before}; let x grow by at least {least} from point to point"
        )
    })
}

/// Where a parameter stands: `layers[2].shape.octaves`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ParamPath(Vec<Segment>);

/// One step of a [`ParamPath`].
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Segment {
    /// A field of a struct.
    Field(&'static str),
    /// An element of a list.
    Index(usize),
}

impl ParamPath {
    /// The steps from the planet down.
    pub fn segments(&self) -> &[Segment] {
        &self.0
    }

    /// Runs `inside` with one more step on the path.
    pub fn within<R>(&mut self, segment: Segment, inside: impl FnOnce(&mut Self) -> R) -> R {
        self.0.push(segment);
        let result = inside(self);
        self.0.pop();
        result
    }

    /// The path with one more field.
    pub fn join(&self, field: &'static str) -> Self {
        let mut path = self.clone();
        path.0.push(Segment::Field(field));
        path
    }

    /// Whether `self` is `prefix` or lies below it.
    pub fn starts_with(&self, prefix: &ParamPath) -> bool {
        self.0.starts_with(&prefix.0)
    }
}

impl From<Vec<Segment>> for ParamPath {
    fn from(segments: Vec<Segment>) -> Self {
        Self(segments)
    }
}

impl fmt::Display for ParamPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            match segment {
                Segment::Field(name) if i == 0 => f.write_str(name)?,
                Segment::Field(name) => write!(f, ".{name}")?,
                Segment::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// What is called for each parameter: where it stands, what it is, its value.
pub type Visit<'a> = dyn FnMut(&ParamPath, &'static Param, ValueMut<'_>) + 'a;

/// Anything that holds parameters.
pub trait Params {
    /// Calls `visit` for each parameter in the order of the file.
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>);
}

impl<T: Params> Params for Option<T> {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        if let Some(inner) = self {
            inner.each_param(path, visit);
        }
    }
}

impl<T: Params> Params for Vec<T> {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        for (i, item) in self.iter_mut().enumerate() {
            path.within(Segment::Index(i), |path| item.each_param(path, visit));
        }
    }
}

/// A type that a single parameter can have.
pub trait ParamValue {
    /// The value's place, to read or to write.
    fn value_mut(&mut self) -> ValueMut<'_>;
}

macro_rules! param_value {
    ($($type:ty => $variant:ident),*) => {
        $(impl ParamValue for $type {
            fn value_mut(&mut self) -> ValueMut<'_> {
                ValueMut::$variant(self)
            }
        })*
    };
}
param_value!(f64 => Number, u32 => Count, bool => Flag, char => Letter, [f64; 3] => Triple, String => Text, Curve => Curve);

/// Writes a struct of parameters: its fields, defaults, serde rules and descriptions.
///
/// Each line is `name: type = default, "Label", unit, domain, stage | stage;`, its doc comment being the tooltip and
/// the comment in the saved file. `with { .. }` adds fields that hold parameters of their own.
macro_rules! params {
    (
        $(#[$struct_attr:meta])*
        pub struct $struct:ident {
            $(
                $(#[doc = $doc:literal])+
                $name:ident: $type:ty = $default:expr, $label:literal, $unit:expr, $domain:expr, $($stage:path)|+;
            )*
        }
        $(with {
            $(
                $(#[doc = $nested_doc:literal])+
                $nested:ident: $nested_type:ty = $nested_default:expr;
            )*
        })?
    ) => {
        $(#[$struct_attr])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $struct {
            $( $(#[doc = $doc])+ pub $name: $type, )*
            $($( $(#[doc = $nested_doc])+ pub $nested: $nested_type, )*)?
        }

        impl Default for $struct {
            fn default() -> Self {
                Self {
                    $( $name: $default, )*
                    $($( $nested: $nested_default, )*)?
                }
            }
        }

        impl $struct {
            /// The description of each parameter that stands directly in this struct.
            pub const PARAMS: &'static [$crate::planet::param::Param] = &[
                $( $crate::planet::param::Param {
                    name: stringify!($name),
                    label: $label,
                    doc: concat!($($doc),+).trim_ascii_start(),
                    unit: $unit,
                    domain: $domain,
                    stages: $crate::planet::param::Stages::of(&[$($stage),+]),
                }, )*
            ];

            /// Name and description of each field that holds parameters of its own.
            pub const PARTS: &'static [(&'static str, &'static str)] = &[
                $($( (stringify!($nested), concat!($($nested_doc),+).trim_ascii_start()), )*)?
            ];
        }

        impl $crate::planet::param::Params for $struct {
            #[allow(unused_assignments, unused_variables, unused_mut, unused_imports)]
            fn each_param(
                &mut self,
                path: &mut $crate::planet::param::ParamPath,
                visit: &mut $crate::planet::param::Visit<'_>,
            ) {
                use $crate::planet::param::{ParamValue, Params, Segment};
                let mut index = 0;
                $(
                    path.within(Segment::Field(stringify!($name)), |path| {
                        visit(path, &Self::PARAMS[index], ParamValue::value_mut(&mut self.$name));
                    });
                    index += 1;
                )*
                $($(
                    path.within(Segment::Field(stringify!($nested)), |path| self.$nested.each_param(path, visit));
                )*)?
            }
        }
    };
}

/// Writes an enum without fields that is a [`Choice`], with the names a person reads; its default is the first.
macro_rules! choice {
    (
        $(#[$enum_attr:meta])*
        pub enum $enum:ident { $( $(#[doc = $doc:literal])+ $variant:ident = $label:literal, )+ }
    ) => {
        $(#[$enum_attr])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $enum { $( $(#[doc = $doc])+ $variant, )+ }

        impl $enum {
            /// Every value, in the order it is offered.
            pub const ALL: &'static [$enum] = &[$( $enum::$variant, )+];
        }

        impl Default for $enum {
            fn default() -> Self {
                Self::ALL[0]
            }
        }

        impl $crate::planet::param::Choice for $enum {
            fn names(&self) -> &'static [&'static str] {
                &[$( $label, )+]
            }
            fn index(&self) -> usize {
                *self as usize
            }
            fn set_index(&mut self, index: usize) {
                if let Some(value) = Self::ALL.get(index) {
                    *self = *value;
                }
            }
        }

        impl $crate::planet::param::ParamValue for $enum {
            fn value_mut(&mut self) -> $crate::planet::param::ValueMut<'_> {
                $crate::planet::param::ValueMut::Choice(self)
            }
        }
    };
}

pub(crate) use {choice, params};
