//! Values of a part to start from.

/// A named value of a part.
#[derive(Clone, Copy, Debug)]
pub struct Starting<T> {
    /// Display name.
    pub name: &'static str,
    /// A short description.
    pub note: &'static str,
    make: fn() -> T,
}

impl<T> Starting<T> {
    pub(super) const fn new(name: &'static str, note: &'static str, make: fn() -> T) -> Self {
        Self { name, note, make }
    }

    /// The value itself.
    pub fn make(&self) -> T {
        (self.make)()
    }
}
