//! The textures a frame is drawn into; made anew when the size changes.

use super::{RenderError, gpu};

/// Radiance.
pub(crate) const HDR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Reverse-Z depth.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Temperature of the surface, °C (what is frozen follows the climate that a query gives), and the share of the star's light that
/// the ground around it takes; how far the ground within a pixel goes above and below its height, metres.
pub(crate) const SURFACE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Stars, see `air.wgsl`.
pub(crate) const STARS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Distance of the clouds.
pub(crate) const DISTANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Two radiance targets (which may be read back) that passes read and write in turn, depth, and what the passes of the clouds and
/// of the air leave behind.
pub(crate) struct Targets {
    pub(crate) size_px: [u32; 2],
    pub(crate) hdr: [wgpu::TextureView; 2],
    pub(crate) surface: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) stars: wgpu::TextureView,
    pub(crate) cloud_light: wgpu::TextureView,
    pub(crate) cloud_distance: wgpu::TextureView,
}

impl Targets {
    pub(crate) fn new(device: &wgpu::Device, size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            hdr: [
                gpu::target(device, "radiance 0", size_px, HDR_FORMAT),
                gpu::target(device, "radiance 1", size_px, HDR_FORMAT),
            ],
            surface: gpu::target(device, "surface", size_px, SURFACE_FORMAT),
            depth: gpu::target(device, "depth", size_px, DEPTH_FORMAT),
            stars: gpu::target(device, "stars", size_px, STARS_FORMAT),
            cloud_light: gpu::target(device, "cloud light", size_px, HDR_FORMAT),
            cloud_distance: gpu::target(device, "cloud distance", size_px, DISTANCE_FORMAT),
        }
    }

    /// Where the tone mapping puts what is to be shown of the scene in that radiance target: into the other one.
    pub(crate) fn toned(&self, scene: usize) -> &wgpu::TextureView {
        &self.hdr[1 - scene]
    }

    /// Where the same goes with smooth edges: the clouds are in the scene by then.
    pub(crate) fn smoothed(&self) -> &wgpu::TextureView {
        &self.cloud_light
    }
}

/// Whether a target is as large as a view says (or as the device allows, if that is less).
pub(crate) fn check_size(target: &wgpu::TextureView, view_px: [u32; 2], limit_px: u32) -> Result<(), RenderError> {
    let texture = target.texture();
    let target_px = [texture.width(), texture.height()];
    let wanted_px = view_px.map(|side| side.clamp(1, limit_px));
    // A view does not tell which mip level of its texture it shows.
    let fits = |level: u32| target_px.map(|side| (side >> level).max(1)) == wanted_px;
    if (0..texture.mip_level_count()).any(fits) { Ok(()) } else { Err(RenderError::TargetSize { target_px, view_px }) }
}
