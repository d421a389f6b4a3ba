//! Types of old preset versions: frozen fields, frozen defaults, and the step to the next version.

use crate::planet::picture::PictureFile;
use crate::planet::{Table, Version};

/// The step from a value of one version to the same value in the next.
pub(super) trait Migrate<To> {
    fn migrate(self) -> To;
}

macro_rules! same {
    ($($type:ty),+) => {
        $(impl Migrate<$type> for $type {
            fn migrate(self) -> $type {
                self
            }
        })+
    };
}
same!(f64, u32, bool, char, String, [f64; 2], [f64; 3]);

impl<T: Migrate<U>, U> Migrate<Vec<U>> for Vec<T> {
    fn migrate(self) -> Vec<U> {
        self.into_iter().map(T::migrate).collect()
    }
}

impl<T: Migrate<U>, U> Migrate<Option<U>> for Option<T> {
    fn migrate(self) -> Option<U> {
        self.map(T::migrate)
    }
}

/// Each step raises the version by one.
impl Migrate<Version> for Version {
    fn migrate(self) -> Version {
        Version(self.0 + 1)
    }
}

impl Migrate<Table> for Vec<String> {
    fn migrate(self) -> Table {
        Table::from_rows(self)
    }
}

impl Migrate<PictureFile> for String {
    fn migrate(self) -> PictureFile {
        self.into()
    }
}

/// Writes a struct of an old version with its defaults, and its step. `"Name"` is the struct's name in the file;
/// `adding` gives values to the fields that the next version has in addition.
macro_rules! frozen {
    (
        $(#[$attr:meta])*
        $file_name:literal $name:ident => $next:path { $($field:ident: $type:ty = $default:expr,)+ }
        $(adding { $($new:ident: $value:expr),+ $(,)? })?
    ) => {
        $(#[$attr])*
        #[derive(serde::Deserialize)]
        #[serde(rename = $file_name, default, deny_unknown_fields)]
        pub(super) struct $name { $(pub(super) $field: $type,)+ }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        impl Migrate<$next> for $name {
            fn migrate(self) -> $next {
                $next { $($field: self.$field.migrate(),)+ $($($new: $value,)+)? }
            }
        }
    };
}

/// Writes an enum without fields of an old version, and its step.
macro_rules! frozen_choice {
    ($name:ident => $next:path { $($variant:ident),+ $(,)? }) => {
        #[derive(serde::Deserialize)]
        pub(super) enum $name { $($variant,)+ }

        impl Migrate<$next> for $name {
            fn migrate(self) -> $next {
                use $next as Next;
                match self { $($name::$variant => Next::$variant,)+ }
            }
        }
    };
}

/// Writes an enum of kinds of an old version, and its step.
macro_rules! frozen_kinds {
    ($name:ident => $next:path { $($kind:ident($params:ident)),+ $(,)? }) => {
        #[derive(serde::Deserialize)]
        pub(super) enum $name { $($kind($params),)+ }

        impl Migrate<$next> for $name {
            fn migrate(self) -> $next {
                use $next as Next;
                match self { $($name::$kind(params) => Next::$kind(params.migrate()),)+ }
            }
        }
    };
}

pub(super) use {frozen, frozen_choice, frozen_kinds};
