//! Materials of objects, as `life_material.wgsl` draws them.

use crate::planet::Form;

/// Kind of material of a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Material {
    /// Colour of the mesh, without a pattern.
    Plain,
    /// Grain, cracks and stains of stone.
    Rock,
    /// Bark on wood, and single leaves on blades.
    Leafy,
    /// Bark on wood, and needles on twigs.
    Needled,
    /// Bark on wood; leaves are those of the mesh.
    Fronded,
    /// Stains and a fine grain on blades.
    Bladed,
    /// Bark along wood that lies, and moss.
    Fallen,
    /// Moss.
    Mossy,
}

impl Material {
    /// The material of a form.
    pub(super) fn of(form: &Form) -> Self {
        match form {
            Form::Stone(_) => Self::Rock,
            Form::Tree(_) => Self::Leafy,
            Form::Conifer(_) => Self::Needled,
            Form::Palm(_) => Self::Fronded,
            Form::Tuft(_) => Self::Bladed,
            Form::Wood(_) => Self::Fallen,
            Form::Cushion(_) => Self::Mossy,
            _ => Self::Plain,
        }
    }
}
