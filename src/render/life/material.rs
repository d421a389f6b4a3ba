//! Materials of objects, as `life_material.wgsl` draws them.

use crate::planet::Form;

/// Kind of material of a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Material {
    /// One without a pattern.
    Plain,
    /// Grain, cracks and stains.
    Rock,
    /// Bark, and leaves that are told apart.
    Leafy,
    /// Bark, and needles as the mesh has them.
    Needled,
}

impl Material {
    /// The material of a form.
    pub(super) fn of(form: &Form) -> Self {
        match form {
            Form::Stone(_) => Self::Rock,
            Form::Tree(_) => Self::Leafy,
            Form::Conifer(_) | Form::Palm(_) => Self::Needled,
            _ => Self::Plain,
        }
    }
}
