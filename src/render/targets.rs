//! The textures that passes read and write, by name.
//!
//! A view owns those between the stages; the caller lends the others. All are as large as the caller's targets, so that
//! a pixel has the same coordinates in each of them.

use super::debug_view::DebugView;
use super::scene::Scene;
use super::{RenderError, gpu};
use crate::lod::Quality;
use std::collections::HashMap;

/// Format of radiance: linear RGB, 1 for sunlit white ground.
pub const RADIANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of depth: reversed, 0 at infinity. See [`super::Matrices`].
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A texture of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Target {
    /// Radiance of the ground under the sea; alpha: height over the sea, metres.
    GroundRadiance,
    /// Depth of the ground under the sea.
    GroundDepth,
    /// Of the ground at a pixel: temperature at the level of the sea in °C, share of the sun that the ground around
    /// takes, height range within the pixel in metres.
    GroundSurface,
    /// Radiance of ground and sea: the caller's.
    Radiance,
    /// Depth of ground and sea: the caller's.
    Depth,
    /// Radiance of the clouds, and their transmittance.
    CloudLight,
    /// Distance of the clouds, and of the end of the ray, km.
    CloudDistance,
    /// Both of one pixel of each block: see `history`.
    MarchedLight,
    MarchedDistance,
    /// Both of the frame before.
    LightBefore,
    DistanceBefore,
    /// Radiance that the air of a body is laid over.
    BeforeAir,
    /// The same with that air.
    AfterAir,
    /// Stars as square roots of what a display shows. They do not follow the exposure.
    Stars,
    /// Radiance of the whole scene: the caller's.
    Composite,
    /// Mean radiance and stars of the frames of a still scene; alpha: sum of the weights.
    MeanLight,
    MeanStars,
    /// Both without the newest frame.
    MeanLightBefore,
    MeanStarsBefore,
    /// Light that the lens scatters, exposed.
    Bloom,
    /// The picture after the tone curve, linear; alpha: perceived brightness.
    Toned,
    /// The same with smooth edges.
    Smoothed,
    /// The newest of the two above.
    Picture,
    /// The picture that is shown: the caller's.
    Output,
}

impl Target {
    /// Its format; `None` for the output, which has the caller's.
    pub(crate) fn format(self) -> Option<wgpu::TextureFormat> {
        Some(match self {
            Target::GroundDepth | Target::Depth => DEPTH_FORMAT,
            Target::CloudDistance | Target::MarchedDistance | Target::DistanceBefore => wgpu::TextureFormat::Rg32Float,
            Target::Stars => wgpu::TextureFormat::Rgba8Unorm,
            Target::Output => return None,
            _ => RADIANCE_FORMAT,
        })
    }
}

/// A texture that a view owns: a target, or one of two that change places: radiance that passes the scene from body to
/// body, and the mean of a still scene with its stars.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Owned {
    Target(Target),
    Between(usize),
    Mean(usize),
    MeanStars(usize),
}

/// The textures that a view owns, made when they are first needed.
pub(crate) struct Targets {
    pub(crate) size_px: [u32; 2],
    textures: HashMap<Owned, wgpu::TextureView>,
}

impl Targets {
    pub(crate) fn new(size_px: [u32; 2]) -> Self {
        Self { size_px, textures: HashMap::new() }
    }

    /// Makes a texture if it is not there.
    pub(crate) fn make(&mut self, device: &wgpu::Device, owned: Owned) {
        let size_px = self.size_px;
        let format = match owned {
            Owned::Target(target) => target.format().unwrap_or(RADIANCE_FORMAT),
            Owned::Between(_) | Owned::Mean(_) | Owned::MeanStars(_) => RADIANCE_FORMAT,
        };
        self.textures.entry(owned).or_insert_with(|| gpu::target(device, &format!("{owned:?}"), size_px, format));
    }

    /// Memory of all textures.
    pub(crate) fn resident_bytes(&self) -> u64 {
        gpu::view_bytes(self.textures.values())
    }

    /// A texture that was made.
    pub(crate) fn get(&self, owned: Owned) -> Option<&wgpu::TextureView> {
        self.textures.get(&owned)
    }
}

/// Checks a target that the caller lends.
pub(crate) fn check(
    name: &'static str,
    view: &wgpu::TextureView,
    format: Option<wgpu::TextureFormat>,
    usage: wgpu::TextureUsages,
) -> Result<(), RenderError> {
    let texture = view.texture();
    match format {
        Some(wanted) if texture.format() != wanted => {
            return Err(RenderError::TargetFormat { name, found: texture.format(), wanted });
        }
        _ => {}
    }
    let missing = usage - texture.usage();
    if missing.is_empty() { Ok(()) } else { Err(RenderError::TargetUsage { name, missing }) }
}

/// Checks that a target is as large as the picture, or as the device allows if that is less.
pub(crate) fn check_size(
    name: &'static str,
    view: &wgpu::TextureView,
    picture_px: [u32; 2],
    limit_px: u32,
) -> Result<(), RenderError> {
    let texture = view.texture();
    let target_px = [texture.width(), texture.height()];
    let wanted_px = picture_px.map(|side| side.clamp(1, limit_px));
    // A view does not tell which mip level of its texture it shows.
    let fits = |level: u32| target_px.map(|side| (side >> level).max(1)) == wanted_px;
    if (0..texture.mip_level_count()).any(fits) {
        Ok(())
    } else {
        Err(RenderError::TargetSize { name, target_px, picture_px })
    }
}

/// Pictures of more pixels than this are not supersampled: the targets would take gigabytes.
const MOST_SUPERSAMPLED_PX: u32 = 9_000_000;

/// Size of the picture before it is shown, and its render scale: 2 at high quality, 0.5 at low.
pub(crate) fn drawn_size(scene: &Scene<'_>, limit_px: u32) -> ([u32; 2], f32) {
    let size = scene.size_px.map(|side| side.clamp(1, limit_px));
    // These debug views show the mesh as it is.
    let plain = matches!(scene.debug_view, DebugView::Coverage | DebugView::Wireframe);
    match scene.quality {
        _ if plain => (size, 1.0),
        Quality::Low => (size.map(|side| side.div_ceil(2)), 0.5),
        Quality::High if size.iter().all(|side| side * 2 <= limit_px) && size[0] * size[1] <= MOST_SUPERSAMPLED_PX => {
            (size.map(|side| side * 2), 2.0)
        }
        Quality::Medium | Quality::High => (size, 1.0),
    }
}
