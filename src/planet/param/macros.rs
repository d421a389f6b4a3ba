//! Macros that write a struct of parameters, or a choice, together with its description.

/// Writes a struct of parameters: its fields, defaults, serde rules and descriptions.
///
/// Each line is `name: type = default, "Label", unit, domain, stage | stage;`. Its doc comment is the tooltip and the
/// comment in the saved file. `#[serde(skip_serializing_if = "..")]` leaves a field out of files where it says nothing.
/// `with { .. }` adds fields that hold parameters of their own.
macro_rules! params {
    (
        $(#[$struct_attr:meta])*
        pub struct $struct:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde(skip_serializing_if = $unsaid:literal)])?
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
            $( $(#[doc = $doc])+ $(#[serde(skip_serializing_if = $unsaid)])? pub $name: $type, )*
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

            /// The description of each field that holds parameters of its own.
            pub const PARTS: &'static [$crate::planet::param::Part] = &[
                $($( $crate::planet::param::Part {
                    name: stringify!($nested),
                    doc: concat!($($nested_doc),+).trim_ascii_start(),
                    form: <$nested_type as $crate::planet::param::PartType>::FORM,
                }, )*)?
            ];
        }

        impl $crate::planet::param::PartType for $struct {
            const FORM: $crate::planet::param::Form = $crate::planet::param::Form::Struct;

            #[allow(unused_variables)]
            fn each_part(found: &mut dyn FnMut(&'static $crate::planet::param::Part)) {
                Self::PARTS.iter().for_each(&mut *found);
                $($( <$nested_type as $crate::planet::param::PartType>::each_part(found); )*)?
            }

            #[allow(unused_mut)]
            fn every_kind() -> Vec<Self> {
                let mut all = vec![Self::default()];
                $($(
                    let kinds = <$nested_type as $crate::planet::param::PartType>::every_kind();
                    all.resize(all.len().max(kinds.len()), all[0].clone());
                    for (value, kind) in all.iter_mut().zip(kinds.iter().cycle()) {
                        value.$nested.clone_from(kind);
                    }
                )*)?
                all
            }
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

            #[allow(unused_assignments, unused_variables, unused_mut, unused_imports)]
            fn each_value(
                &self,
                path: &mut $crate::planet::param::ParamPath,
                look: &mut $crate::planet::param::Look<'_>,
            ) {
                use $crate::planet::param::{ParamValue, Params, Segment};
                let mut index = 0;
                $(
                    path.within(Segment::Field(stringify!($name)), |path| {
                        look(path, &Self::PARAMS[index], ParamValue::value_ref(&self.$name));
                    });
                    index += 1;
                )*
                $($(
                    path.within(Segment::Field(stringify!($nested)), |path| self.$nested.each_value(path, look));
                )*)?
            }
        }
    };
}

/// Writes an enum without fields that is a [`Choice`](super::Choice), with its display names. The first value is the
/// default.
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
                &[$( stringify!($variant), )+]
            }
            fn labels(&self) -> &'static [&'static str] {
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
            fn value_ref(&self) -> $crate::planet::param::ValueRef<'_> {
                $crate::planet::param::ValueRef::Choice(self)
            }
        }
    };
}

pub(crate) use {choice, params};
