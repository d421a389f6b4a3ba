//! What is kept of a texture set: a layer for the renderer, and the mean colour.

use super::layer::Layer;
use crate::planet::linked::{Linked, LinkedFile};
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// Reference to a texture set: the path of its colour picture.
pub type TextureSetFile = LinkedFile<TextureSet>;

/// Texture set of an artist, ready to be drawn in place of a built-in pattern.
pub struct TextureSet {
    /// Mean of the colour picture (albedo, linear sRGB).
    pub color: [f64; 3],
    pub(super) layer: Layer,
    /// The pictures beside that of the colours.
    pub(super) others: Vec<PathBuf>,
    /// Hash of the layer and the colour.
    pub(super) hash: u64,
}

impl TextureSet {
    /// The layer that the renderer shows.
    #[cfg(feature = "render")]
    pub(crate) fn layer(&self) -> &Layer {
        &self.layer
    }

    /// Hash of the content.
    pub(in crate::planet) fn hash(&self) -> u64 {
        self.hash
    }

    /// Memory of the content.
    pub(in crate::planet) fn bytes(&self) -> u64 {
        self.layer.bytes()
    }

    /// The files that belong to it, beside the one that the preset names.
    pub(in crate::planet) fn others(&self) -> &[PathBuf] {
        &self.others
    }
}

/// Content keys are made of this.
impl fmt::Debug for TextureSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "TextureSet({:016x})", self.hash)
    }
}

impl PartialEq for TextureSet {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash
    }
}

impl Linked for TextureSet {
    type Key = PathBuf;
}

impl LinkedFile<TextureSet> {
    /// The set, if it is loaded.
    pub fn set(&self) -> Option<&Arc<TextureSet>> {
        self.current().map(|(_, set)| set)
    }
}

#[cfg(test)]
impl TextureSet {
    /// The set of a colour picture alone, of the size of a layer.
    pub(crate) fn of_colors(colors: Vec<[f32; 3]>) -> Self {
        super::compose::Maps::new(colors).composed(Vec::new())
    }
}

#[cfg(test)]
impl LinkedFile<TextureSet> {
    /// A reference to a set that is in no file.
    pub(crate) fn holding(set: TextureSet) -> Self {
        let mut file = Self::from("rock_albedo.png".to_owned());
        file.set_folder("".as_ref());
        file.give(&PathBuf::from("rock_albedo.png"), &Arc::new(set));
        file
    }
}
