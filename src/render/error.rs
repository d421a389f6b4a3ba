//! Errors of the renderer.

use super::MAX_SUNS;
use crate::planet::InvalidPlanet;

/// Why the renderer did not draw.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A shader does not compile. The text is naga's or the driver's, with file and line.
    #[error("{0}")]
    Shader(String),
    /// The device does not answer.
    #[error("the device: {0}")]
    Device(String),
    /// A target is not as large as the picture.
    #[error(
        "the {name} is {} x {} pixels and the picture {} x {}; make them the same size",
        target_px[0], target_px[1], picture_px[0], picture_px[1]
    )]
    TargetSize {
        /// Which target.
        name: &'static str,
        /// Width and height of the target's texture.
        target_px: [u32; 2],
        /// Size of the picture.
        picture_px: [u32; 2],
    },
    /// A target has another format than the passes write.
    #[error("the {name} is {found:?}; it has to be {wanted:?}")]
    TargetFormat {
        /// Which target.
        name: &'static str,
        /// Format of the target's texture.
        found: wgpu::TextureFormat,
        /// Format that the passes write.
        wanted: wgpu::TextureFormat,
    },
    /// A target lacks a usage: a texture that a later stage reads needs `TEXTURE_BINDING`.
    #[error("the {name} lacks the usages {missing:?}")]
    TargetUsage {
        /// Which target.
        name: &'static str,
        /// Usages to add to the texture.
        missing: wgpu::TextureUsages,
    },
    /// The viewport is empty or reaches beyond the targets.
    #[error(
        "the viewport {viewport_px:?} (x, y, width, height) is not inside targets of {} x {} pixels",
        target_px[0], target_px[1]
    )]
    Viewport {
        /// Left, top, width, height.
        viewport_px: [u32; 4],
        /// Size of the targets.
        target_px: [u32; 2],
    },
    /// The scene has more suns than the shaders light with.
    #[error("the scene has {0} suns; the renderer lights with at most {MAX_SUNS}")]
    TooManySuns(usize),
    /// Two bodies of the scene have one id.
    #[error("two bodies of the scene have the id {0}; give each its own")]
    BodyTwice(u32),
    /// The planet is one that no preset may describe.
    #[error(transparent)]
    Planet(#[from] InvalidPlanet),
}
