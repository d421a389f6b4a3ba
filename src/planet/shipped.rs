//! The presets that come with the program.
/// A preset that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// File name below `planets/`.
    pub file: &'static str,
    /// Its text.
    pub text: &'static str,
}
/// All of them, the default planet first.
pub const ALL: &[Shipped] = &[];
