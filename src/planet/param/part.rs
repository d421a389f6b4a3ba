//! The parts of a planet: fields that hold parameters of their own. `params!` lists them; file, messages and panels
//! follow from that list.

/// How a file writes a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `(field: value, ...)`
    Struct,
    /// `(field: value, ...)` or `None`
    Optional,
    /// `[..., ...]`
    List,
    /// `Kind(field: value, ...)`
    Kind,
    /// A list of rows of letters.
    Table,
}

/// The description of a part.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The field's name in the file.
    pub name: &'static str,
    /// One sentence: its meaning.
    pub doc: &'static str,
    /// How the file writes it.
    pub form: Form,
}

/// A type that a part can have.
pub trait PartType: Clone {
    /// How a file writes it.
    const FORM: Form;

    /// Calls `found` for the parts inside, at any depth.
    fn each_part(_found: &mut dyn FnMut(&'static Part)) {}

    /// A value of every kind. Optional parts are present, and lists hold an element of every kind, so that together the
    /// values have every parameter there is.
    fn every_kind() -> Vec<Self>;
}

impl<T: PartType> PartType for Option<T> {
    const FORM: Form = Form::Optional;

    fn each_part(found: &mut dyn FnMut(&'static Part)) {
        T::each_part(found);
    }

    fn every_kind() -> Vec<Self> {
        T::every_kind().into_iter().map(Some).collect()
    }
}

impl<T: PartType> PartType for Vec<T> {
    const FORM: Form = Form::List;

    fn each_part(found: &mut dyn FnMut(&'static Part)) {
        T::each_part(found);
    }

    fn every_kind() -> Vec<Self> {
        vec![T::every_kind()]
    }
}
