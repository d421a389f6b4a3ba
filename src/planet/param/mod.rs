//! One description for each parameter, and the visitors through which other code reaches all parameters.
//!
//! - `description`: [`Param`]: meaning, unit, domain, stages
//! - `stage`: the stages of a rebuild
//! - `value`: values, copied or borrowed
//! - `part`: fields that hold parameters of their own
//! - `path`: the path of a parameter in a planet
//! - `macros`: `params!` and `choice!`, which write a type and its description from one list
//!
//! Sliders, tooltips, validation, the comments of a saved file, random planets, content keys and undo names use
//! [`Params`]; none of them names a parameter.

mod description;
mod macros;
mod part;
mod path;
mod stage;
mod value;

pub use description::{Curve, Domain, MAX_CURVE_POINTS, Param, Unit, count, linear, log, triple};
pub(crate) use macros::{choice, params};
pub use part::{Form, Part, PartType};
pub use path::{ParamPath, Segment};
pub use stage::{Stage, Stages};
pub use value::{Choice, Value, ValueMut, ValueRef};

/// Called for each parameter with its path, its description and its value to be written.
pub type Visit<'a> = dyn FnMut(&ParamPath, &'static Param, ValueMut<'_>) + 'a;

/// Called for each parameter with its path, its description and its value.
pub type Look<'a> = dyn FnMut(&ParamPath, &'static Param, ValueRef<'_>) + 'a;

/// A type that holds parameters.
pub trait Params {
    /// Calls `visit` for each parameter in the order of the file.
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>);

    /// Calls `look` for each parameter in the order of the file.
    fn each_value(&self, path: &mut ParamPath, look: &mut Look<'_>);
}

impl<T: Params> Params for Option<T> {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        if let Some(inner) = self {
            inner.each_param(path, visit);
        }
    }

    fn each_value(&self, path: &mut ParamPath, look: &mut Look<'_>) {
        if let Some(inner) = self {
            inner.each_value(path, look);
        }
    }
}

impl<T: Params> Params for Vec<T> {
    fn each_param(&mut self, path: &mut ParamPath, visit: &mut Visit<'_>) {
        for (i, item) in self.iter_mut().enumerate() {
            path.within(Segment::Index(i), |path| item.each_param(path, visit));
        }
    }

    fn each_value(&self, path: &mut ParamPath, look: &mut Look<'_>) {
        for (i, item) in self.iter().enumerate() {
            path.within(Segment::Index(i), |path| item.each_value(path, look));
        }
    }
}

/// A type that a single parameter can have.
pub trait ParamValue {
    /// The value, borrowed to be written.
    fn value_mut(&mut self) -> ValueMut<'_>;

    /// The value, borrowed.
    fn value_ref(&self) -> ValueRef<'_>;
}

macro_rules! param_value {
    ($($type:ty => $variant:ident $(($read:tt))?),*) => {
        $(impl ParamValue for $type {
            fn value_mut(&mut self) -> ValueMut<'_> {
                ValueMut::$variant(self)
            }

            fn value_ref(&self) -> ValueRef<'_> {
                ValueRef::$variant($($read)? self)
            }
        })*
    };
}
param_value!(
    f64 => Number(*), u32 => Count(*), bool => Flag(*), char => Letter(*), [f64; 3] => Triple(*),
    String => Text, Curve => Curve
);
