//! Casters: things of a game that are drawn into the maps of shadows, and the view of such a map.
//!
//! The renderer draws the maps in [`Renderer::prepare`], one pass each. A game's pipeline for them has group 0 of
//! [`Renderer::caster_layout`], [`ShadowView::depth_state`] and no colour; its shader begins with
//! [`super::caster_wgsl`].

use super::gpu;
use super::renderer::Renderer;
use glam::{DVec3, Mat4};

/// Least width of what is drawn into a map, in texels.
const LEAST_TEXELS: f64 = 5.0;

/// A thing of a game, or many of them, that casts shadows of the first sun on the ground, the sea, the objects of
/// populations and the game's own meshes.
///
/// It is a member of [`super::Body::casters`]:
///
/// ```
/// use tellus::glam::DVec3;
/// use tellus::render::{Scene, ShadowCaster, ShadowView, wgpu};
///
/// struct Hut {
///     /// Behind `caster_wgsl()`: `shadow_view.clip_from_rel_m * vec4f(rel_m, 1.0)`.
///     pipeline: wgpu::RenderPipeline,
///     /// Corners, metres from the eye of this frame.
///     corners: wgpu::Buffer,
///     middle_planet_m: DVec3,
/// }
///
/// impl ShadowCaster for Hut {
///     fn ball(&self) -> (DVec3, f64) {
///         (self.middle_planet_m, 6.0)
///     }
///     fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _to: &ShadowView) {
///         pass.set_pipeline(&self.pipeline);
///         pass.set_vertex_buffer(0, self.corners.slice(..));
///         pass.draw(0..36, 0..1);
///     }
/// }
///
/// fn show<'a>(scene: &mut Scene<'a>, hut: &'a Hut) {
///     scene.bodies[0].casters.push(hut);
/// }
/// ```
pub trait ShadowCaster: Sync {
    /// A ball around all of it: its middle in the frame of the body, metres, and its radius. No map is asked to draw
    /// what does not reach it.
    fn ball(&self) -> (DVec3, f64);

    /// Draws it into a map. Group 0 is set; [`ShadowView::sees`] tells which parts may be left out.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, to: &ShadowView);
}

/// A map of shadows: an orthographic view from the sun around the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShadowView {
    /// Metres from the eye, in the axes of the body, to clip space: `shadow_view.clip_from_rel_m` of the shader. Depth
    /// 0 is nearest to the sun.
    pub clip_from_rel_m: Mat4,
    /// The eye in the frame of the body, metres.
    pub eye_planet_m: DVec3,
    /// Width of a texel.
    pub texel_m: f64,
    /// Half of the map's width, and its depth along the sunlight.
    pub(crate) radius_m: f64,
    pub(crate) depth_m: f64,
}

impl ShadowView {
    /// The depth state of a pipeline that draws into maps: the format is [`super::DEPTH_FORMAT`], less is nearer.
    pub fn depth_state() -> wgpu::DepthStencilState {
        gpu::depth_state(wgpu::CompareFunction::Less)
    }

    /// Whether the shadow of a ball reaches the map and is wider than some texels. The middle is in the frame of the
    /// body, metres.
    pub fn sees(&self, center_planet_m: DVec3, radius_m: f64) -> bool {
        let at = self.clip_from_rel_m.transform_point3((center_planet_m - self.eye_planet_m).as_vec3());
        let reach = 1.0 + radius_m / self.radius_m;
        let is_over = f64::from(at.x).abs() < reach && f64::from(at.y).abs() < reach;
        is_over && f64::from(at.z) < 1.0 + radius_m / self.depth_m && 2.0 * radius_m > LEAST_TEXELS * self.texel_m
    }
}

impl Renderer {
    /// Layout of group 0 of a pipeline that draws a [`ShadowCaster`]: a uniform buffer.
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        self.pipelines.life.caster_layout()
    }
}
