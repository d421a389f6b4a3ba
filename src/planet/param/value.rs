//! The value of a parameter: copied out, borrowed, or borrowed to be written.

use super::description::{Curve, Domain, MAX_CURVE_POINTS, Param, Unit};
use crate::planet::MAX_BIOMES;
use crate::planet::printable::number_text;

/// A choice between named values.
pub trait Choice {
    /// The names of all values in files, in the order of their index.
    fn names(&self) -> &'static [&'static str];
    /// The names that a person reads, in the same order.
    fn labels(&self) -> &'static [&'static str];
    /// Index of the current value.
    fn index(&self) -> usize;
    /// Selects the value with an index. An index out of range changes nothing.
    fn set_index(&mut self, index: usize);
}

/// A parameter's value, borrowed from its planet.
#[derive(Clone, Copy)]
#[allow(missing_docs)]
pub enum ValueRef<'a> {
    Number(f64),
    Count(u32),
    Flag(bool),
    Triple([f64; 3]),
    Text(&'a str),
    Letter(char),
    Curve(&'a Curve),
    Choice(&'a dyn Choice),
}

impl ValueRef<'_> {
    /// A copy of the value.
    pub fn get(&self) -> Value {
        match *self {
            ValueRef::Number(v) => Value::Number(v),
            ValueRef::Count(v) => Value::Count(v),
            ValueRef::Flag(v) => Value::Flag(v),
            ValueRef::Triple(v) => Value::Triple(v),
            ValueRef::Text(v) => Value::Text(v.to_owned()),
            ValueRef::Letter(v) => Value::Letter(v),
            ValueRef::Curve(v) => Value::Curve(v.clone()),
            ValueRef::Choice(v) => Value::Choice(v.index()),
        }
    }

    /// The names of the values of a choice in files; empty for all other parameters.
    pub fn names(&self) -> &'static [&'static str] {
        if let ValueRef::Choice(choice) = self { choice.names() } else { &[] }
    }

    /// The names of the values of a choice that a person reads; empty for all other parameters.
    pub fn labels(&self) -> &'static [&'static str] {
        if let ValueRef::Choice(choice) = self { choice.labels() } else { &[] }
    }
}

/// A parameter's value, borrowed from its planet to be written.
pub enum ValueMut<'a> {
    /// See [`Domain::Number`].
    Number(&'a mut f64),
    /// See [`Domain::Count`] and [`Domain::Seed`].
    Count(&'a mut u32),
    /// See [`Domain::Flag`].
    Flag(&'a mut bool),
    /// See [`Domain::Color`] and [`Domain::Triple`].
    Triple(&'a mut [f64; 3]),
    /// See [`Domain::Text`], [`Domain::BiomeKeys`], [`Domain::MaskName`], [`Domain::PopulationName`] and
    /// [`Domain::File`].
    Text(&'a mut String),
    /// See [`Domain::Letter`] and [`Domain::BiomeKey`].
    Letter(&'a mut char),
    /// See [`Domain::Curve`].
    Curve(&'a mut Curve),
    /// See [`Domain::Choice`].
    Choice(&'a mut dyn Choice),
}

/// A copy of a parameter's value.
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
    /// The value, to be read.
    pub fn as_ref(&self) -> ValueRef<'_> {
        match self {
            ValueMut::Number(v) => ValueRef::Number(**v),
            ValueMut::Count(v) => ValueRef::Count(**v),
            ValueMut::Flag(v) => ValueRef::Flag(**v),
            ValueMut::Triple(v) => ValueRef::Triple(**v),
            ValueMut::Text(v) => ValueRef::Text(v),
            ValueMut::Letter(v) => ValueRef::Letter(**v),
            ValueMut::Curve(v) => ValueRef::Curve(v),
            ValueMut::Choice(v) => ValueRef::Choice(&**v),
        }
    }

    /// A copy of the value.
    pub fn get(&self) -> Value {
        self.as_ref().get()
    }

    /// Writes a value. A value of another type is ignored.
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
    /// What is wrong with the value for `param` and what would be right; `None` if it is valid.
    pub fn problem(&self, param: &Param) -> Option<String> {
        let out_of_range = |shown: String| Some(format!("{shown} is out of range; use {}", param.range_text()));
        match (self, param.domain) {
            (Value::Number(v), Domain::Number { .. }) if !v.is_finite() => {
                Some(format!("{v} is not a finite number; use {}", param.range_text()))
            }
            (Value::Number(v), Domain::Number { min, max, .. }) if *v < min || *v > max => {
                out_of_range(number_text(*v))
            }
            (Value::Count(v), Domain::Count { min, max }) if *v < min || *v > max => out_of_range(v.to_string()),
            (Value::Triple(v), Domain::Color | Domain::Triple { .. }) => {
                let max = if let Domain::Triple { max } = param.domain { max } else { 1.0 };
                let bad = v.iter().find(|c| !c.is_finite() || **c < 0.0 || **c > max)?;
                if bad.is_finite() {
                    out_of_range(number_text(*bad))
                } else {
                    Some(format!("{bad} is not a finite number; use {}", param.range_text()))
                }
            }
            (
                Value::Text(v),
                Domain::Text { max_chars }
                | Domain::MaskName { max_chars }
                | Domain::PopulationName { max_chars, .. }
                | Domain::File { max_chars },
            ) => {
                if v.chars().count() > max_chars {
                    Some(format!("{} characters are too many; use {}", v.chars().count(), param.range_text()))
                } else if v.chars().any(char::is_control) {
                    Some("control characters are not allowed; use plain text on one line".to_owned())
                } else {
                    None
                }
            }
            (Value::Text(v), Domain::BiomeKeys) => {
                let count = v.chars().count();
                (count > MAX_BIOMES).then(|| format!("{count} keys are too many; use {}", param.range_text()))
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

/// What is wrong with the points of a curve. Messages count points from 1.
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
            let bad = number_text(*bad);
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
