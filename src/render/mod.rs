//! Draws a planet with wgpu into any texture view on the caller's own device.
use crate::build::Surface;
use crate::lod::View;
use crate::planet::Planet;
use glam::DVec3;

/// What is drawn of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum DebugView {
    #[default]
    Shaded,
    Height,
    Normal,
    Biome,
    Slope,
    Lod,
    Wireframe,
    Coverage,
}

impl DebugView {
    /// All of them.
    pub const ALL: [DebugView; 8] = [
        DebugView::Shaded,
        DebugView::Height,
        DebugView::Normal,
        DebugView::Biome,
        DebugView::Slope,
        DebugView::Lod,
        DebugView::Wireframe,
        DebugView::Coverage,
    ];
    /// The name a person reads.
    pub fn label(self) -> &'static str {
        "x"
    }
}

/// One picture.
pub struct Frame<'a> {
    /// The tiles.
    pub surface: &'a Surface,
    /// The planet for everything that is not in the tiles: it may be newer than the surface's.
    pub planet: &'a Planet,
    /// Camera, size of the target, quality.
    pub view: View,
    /// Unit vector from the planet to its star.
    pub sun_dir_planet: DVec3,
    /// Seconds since time zero: drift of the clouds, waves.
    pub time_secs: f64,
    /// Exposure in stops; 0 suits a sunlit planet.
    pub exposure_ev: f64,
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
}

/// Why the renderer could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// A shader does not compile: what naga or the driver says, with the file and line it comes from.
    #[error("{0}")]
    Shader(String),
}

/// What one frame drew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Tiles drawn after culling.
    pub tiles_drawn: usize,
    /// Triangles drawn.
    pub triangles: usize,
}

/// All GPU state of one viewport.
pub struct Renderer {}

impl Renderer {
    /// Features and limits to ask of the device; works on every adapter of the WebGPU default limits.
    pub fn required_limits() -> wgpu::Limits {
        wgpu::Limits::default()
    }
    /// Compiles the pipelines. `target_format` is what [`Renderer::render`] will draw into: `Rgba8UnormSrgb`,
    /// `Bgra8UnormSrgb` or their linear variants (`Rgba8Unorm`: gamma is then applied by the shader).
    pub fn new(
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        _target_format: wgpu::TextureFormat,
    ) -> Result<Self, RenderError> {
        Ok(Self {})
    }
    /// Draws one frame and submits it.
    pub fn render(
        &mut self,
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        _target: &wgpu::TextureView,
        _frame: &Frame<'_>,
    ) -> FrameStats {
        FrameStats::default()
    }
    /// What is wrong with a shader that was just edited on disk (debug builds); the last good one goes on drawing.
    pub fn shader_error(&self) -> Option<&str> {
        None
    }
}
