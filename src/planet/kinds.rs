//! Enums whose variants carry parameters: kinds of layer, kinds of mask.
//!
//! `kinds!` writes the enum, its names, its choice in the panels and its form in the file from one list of variants.

use super::param::{ParamPath, Params, Unit, Value};

/// Writes an enum of kinds from a list. The first kind is the default. A file writes a value as `Kind(parameter: 1.0)`;
/// a person reads `"Label"`.
///
/// `"name", "Label", stage | stage` describe the choice between the kinds as a parameter. The documentation of the enum
/// is the tooltip of that parameter.
macro_rules! kinds {
    (
        $(#[doc = $enum_doc:literal])+
        pub enum $enum:ident: $name:literal, $label:literal, $($stage:path)|+;
        $( $(#[doc = $doc:literal])+ $kind:ident($params:ident) = $shown:literal, )+
    ) => {
        $(#[doc = $enum_doc])+
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub enum $enum { $( $(#[doc = $doc])+ $kind($params), )+ }

        impl $enum {
            /// The names of the kinds in files, in the order of [`Choice::index`](crate::planet::param::Choice::index).
            pub const NAMES: &'static [&'static str] = &[$( stringify!($kind), )+];

            /// The names that a person reads, in the same order.
            pub const LABELS: &'static [&'static str] = &[$( $shown, )+];

            /// The description of each kind, in the same order.
            pub const DOCS: &'static [&'static str] = &[$( concat!($($doc),+).trim_ascii_start(), )+];

            /// The choice between the kinds.
            pub const KIND: $crate::planet::param::Param = $crate::planet::param::Param {
                name: $name,
                label: $label,
                doc: concat!($($enum_doc),+).trim_ascii_start(),
                unit: $crate::planet::param::Unit::None,
                domain: $crate::planet::param::Domain::Choice,
                stages: $crate::planet::param::Stages::of(&[$($stage),+]),
            };

            /// Every kind with its default parameters.
            pub fn all() -> Vec<$enum> {
                vec![$( $enum::$kind($params::default()), )+]
            }

            /// A kind by its index, with its default parameters.
            pub fn of_kind(index: usize) -> Option<$enum> {
                Self::all().into_iter().nth(index)
            }

            /// The parameters of the kind.
            pub fn params(&mut self) -> &mut dyn $crate::planet::param::Params {
                match self { $( $enum::$kind(params) => params, )+ }
            }

            fn params_ref(&self) -> &dyn $crate::planet::param::Params {
                match self { $( $enum::$kind(params) => params, )+ }
            }
        }

        impl Default for $enum {
            fn default() -> Self {
                Self::all().swap_remove(0)
            }
        }

        impl $crate::planet::param::Choice for $enum {
            fn names(&self) -> &'static [&'static str] {
                Self::NAMES
            }
            fn labels(&self) -> &'static [&'static str] {
                Self::LABELS
            }
            fn index(&self) -> usize {
                let same = |kind: &Self| std::mem::discriminant(kind) == std::mem::discriminant(self);
                Self::all().iter().position(same).unwrap_or(0)
            }
            /// Changes the kind and keeps the parameters that both kinds have.
            fn set_index(&mut self, index: usize) {
                if let Some(mut kind) = Self::of_kind(index).filter(|_| index != self.index()) {
                    $crate::planet::kinds::take_over(kind.params(), self.params_ref());
                    *self = kind;
                }
            }
        }

        impl $crate::planet::param::PartType for $enum {
            const FORM: $crate::planet::param::Form = $crate::planet::param::Form::Kind;

            fn every_kind() -> Vec<Self> {
                Self::all()
            }
        }

        impl $crate::planet::param::Params for $enum {
            fn each_param(
                &mut self,
                path: &mut $crate::planet::param::ParamPath,
                visit: &mut $crate::planet::param::Visit<'_>,
            ) {
                visit(path, &Self::KIND, $crate::planet::param::ValueMut::Choice(self));
                self.params().each_param(path, visit);
            }

            fn each_value(
                &self,
                path: &mut $crate::planet::param::ParamPath,
                look: &mut $crate::planet::param::Look<'_>,
            ) {
                look(path, &Self::KIND, $crate::planet::param::ValueRef::Choice(self));
                self.params_ref().each_value(path, look);
            }
        }
    };
}
pub(crate) use kinds;

/// Copies from `before` the parameters that both kinds have: those of equal name and unit, and the size of the largest
/// feature, which is the first parameter in kilometres of each kind.
pub(super) fn take_over(kind: &mut dyn Params, before: &dyn Params) {
    let mut old = Vec::new();
    before.each_value(&mut ParamPath::default(), &mut |_, param, value| {
        old.push((param.name, param.unit, value.get()));
    });
    let old_size = old.iter().find(|(_, unit, _)| *unit == Unit::Kilometres).map(|(_, _, value)| value.clone());
    let mut size_seen = false;
    kind.each_param(&mut ParamPath::default(), &mut |_, param, mut value| {
        let is_size =
            param.unit == Unit::Kilometres && !std::mem::replace(&mut size_seen, param.unit == Unit::Kilometres);
        let same = old.iter().find(|(name, unit, _)| *name == param.name && *unit == param.unit);
        let new = if is_size { old_size.as_ref() } else { same.map(|(_, _, value)| value) };
        // Parameters of one name may have different types.
        let is_alike = |new: &&Value| std::mem::discriminant(*new) == std::mem::discriminant(&value.get());
        if let Some(new) = new.filter(is_alike).filter(|new| new.problem(param).is_none()) {
            value.set(new);
        }
    });
}
