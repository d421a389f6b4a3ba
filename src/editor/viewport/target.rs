//! The offscreen texture into which the planet is drawn, and which egui shows.
//!
//! egui blends in gamma space and samples its textures without decoding them, so the texture is `Rgba8Unorm` and holds
//! gamma-encoded values: the renderer's shader applies the gamma itself for that format.

use eframe::egui::TextureId;
use eframe::egui_wgpu::RenderState;

/// The format of the texture.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A texture registered with egui; it is recreated when the size changes and freed with the target.
pub struct Target {
    id: TextureId,
    view: wgpu::TextureView,
    size_px: [u32; 2],
    render_state: RenderState,
}

impl Target {
    /// A target of this size in pixels; no side is zero.
    pub fn new(render_state: &RenderState, size_px: [u32; 2]) -> Self {
        let view = make_view(&render_state.device, size_px);
        let id = render_state.renderer.write().register_native_texture(
            &render_state.device,
            &view,
            wgpu::FilterMode::Linear,
        );
        Self { id, view, size_px, render_state: render_state.clone() }
    }

    /// Changes the size. Gives whether it was another.
    pub fn resize(&mut self, size_px: [u32; 2]) -> bool {
        if self.size_px == size_px {
            return false;
        }
        self.view = make_view(&self.render_state.device, size_px);
        self.size_px = size_px;
        self.render_state.renderer.write().update_egui_texture_from_wgpu_texture(
            &self.render_state.device,
            &self.view,
            wgpu::FilterMode::Linear,
            self.id,
        );
        true
    }

    /// The texture for egui.
    pub fn id(&self) -> TextureId {
        self.id
    }

    /// The texture for the renderer.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        self.render_state.renderer.write().free_texture(&self.id);
    }
}

fn make_view(device: &wgpu::Device, size_px: [u32; 2]) -> wgpu::TextureView {
    let limit = device.limits().max_texture_dimension_2d;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("planet viewport"),
        size: wgpu::Extent3d {
            width: size_px[0].clamp(1, limit),
            height: size_px[1].clamp(1, limit),
            depth_or_array_layers: 1,
        },
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        dimension: wgpu::TextureDimension::D2,
        mip_level_count: 1,
        sample_count: 1,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
