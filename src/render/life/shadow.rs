//! Shadows of objects: a map of the depth from the sun around the eye, in cascades.
//!
//! The map turns with the sun and stands still on the planet: its centre moves by whole texels, so that edges do not
//! crawl while the camera moves. The ground's own shadows come from its horizon angles.

use super::canopy::through_leaves;
use super::view::populations;
use crate::life::scenery::{Scenery, SceneryCell};
use crate::lod::Quality;
use crate::render::scene::{Body, DebugView, Scene};
use crate::render::shared;
use crate::render::targets::DEPTH_FORMAT;
use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};

/// Cascades of a map, nearest first.
pub(crate) const CASCADES: usize = 2;
/// Half the depth of a map along the sunlight, as a multiple of its radius, and at least these metres.
const DEPTH_RADII: f64 = 2.0;
const LEAST_DEPTH_M: f64 = 150.0;
/// Least height of an object that casts a shadow, in texels.
const LEAST_TEXELS: f64 = 5.0;
/// Sine of the sun's elevation below which objects cast no shadows: the light of dusk has no edges.
const LEAST_SUN_SINE: f64 = 0.02;

/// Radii of the cascades in metres at an altitude, and texels along a side. From above more of the ground is in sight,
/// and smaller.
fn extent(quality: Quality, altitude_m: f64) -> ([f64; CASCADES], u32) {
    let ([near_m, far_m], side_px): ([f64; CASCADES], u32) = match quality {
        Quality::Low => ([45.0, 180.0], 1024),
        Quality::Medium => ([45.0, 360.0], 2048),
        Quality::High => ([40.0, 480.0], 4096),
    };
    ([near_m.max(1.5 * altitude_m), far_m.max(5.0 * altitude_m)], side_px)
}

/// The light of a frame around its eye.
pub(crate) struct Cascades {
    /// Metres from the eye to clip space of each map.
    pub(crate) clip_from_rel_m: [Mat4; CASCADES],
    /// Middle of the maps, metres from the eye.
    pub(super) center_rel_m: DVec3,
    pub(super) radii_m: [f64; CASCADES],
    through_leaves: Vec3,
    pub(crate) side_px: u32,
}

impl Cascades {
    /// The cascades of a body in a scene; None where no object casts a shadow.
    pub(crate) fn new(scene: &Scene<'_>, body: &Body<'_>) -> Option<Self> {
        let is_empty = body.surface.scenery.cells.is_empty();
        if is_empty || !matches!(scene.debug_view, DebugView::Shaded) {
            return None;
        }
        let sun = scene.suns_of(body.id).next()?.at(body.position_m);
        let sun_dir = body.scene_from_body.inverse() * sun.dir_scene;
        let eye_m = body.eye_planet_m();
        let up = eye_m.normalize_or(DVec3::Z);
        if up.dot(sun_dir) < LEAST_SUN_SINE {
            return None;
        }
        let foot_m = ground_below(&body.surface.scenery, eye_m)?;
        let altitude_m = (eye_m.length() - foot_m.length()).max(0.0);
        let (radii_m, side_px) = extent(scene.quality, altitude_m);
        let (across, along) = sun_dir.any_orthonormal_pair();
        let maps = radii_m.map(|radius_m| {
            let texel_m = 2.0 * radius_m / f64::from(side_px);
            let snapped = |axis: DVec3| (foot_m.dot(axis) / texel_m).round() * texel_m - eye_m.dot(axis);
            let depth_m = (DEPTH_RADII * radius_m).max(LEAST_DEPTH_M);
            let row = |axis: DVec3, middle: f64, half: f64| {
                let axis = axis / half;
                Vec4::new(axis.x as f32, axis.y as f32, axis.z as f32, (-middle / half) as f32)
            };
            // Depth 0 is nearest to the sun.
            let depth = row(-sun_dir, -(foot_m - eye_m).dot(sun_dir), 2.0 * depth_m) + Vec4::new(0.0, 0.0, 0.0, 0.5);
            let rows = [row(across, snapped(across), radius_m), row(along, snapped(along), radius_m), depth, Vec4::W];
            Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
        });
        let through_leaves = through_leaves(&body.surface.scenery, populations(body));
        Some(Self { clip_from_rel_m: maps, center_rel_m: foot_m - eye_m, radii_m, through_leaves, side_px })
    }

    /// Tells the shaders.
    pub(crate) fn write(&self, out: &mut shared::Body) {
        out.shadow_from_rel_m = self.clip_from_rel_m;
        out.shadow_texel_m =
            Vec2::from_array(self.radii_m.map(|radius_m| (2.0 * radius_m) as f32 / self.side_px as f32));
        out.through_leaves = self.through_leaves;
        out.has_shadows = 1;
    }

    /// Whether objects of a cell may cast shadows into any cascade. `reach`: distance from its foot within which an object
    /// lies, in heights.
    pub(super) fn reaches(&self, cell: &SceneryCell, reach: f64, eye_m: DVec3) -> bool {
        let reach_m = 1.5 * self.radii_m[CASCADES - 1] + cell.radius_m(reach);
        (cell.center_planet_m - eye_m).distance(self.center_rel_m) < reach_m
    }

    /// Whether an object casts a shadow into a cascade that is worth drawing.
    pub(super) fn takes(&self, cascade: usize, rel_m: DVec3, size_m: f64) -> bool {
        let radius_m = self.radii_m[cascade];
        let texel_m = 2.0 * radius_m / f64::from(self.side_px);
        size_m > LEAST_TEXELS * texel_m && rel_m.distance(self.center_rel_m) < 1.5 * radius_m + 4.0 * size_m
    }
}

/// Point of the ground below the eye, at the height of the nearest cell of objects.
fn ground_below(scenery: &Scenery, eye_m: DVec3) -> Option<DVec3> {
    let cells = scenery.cells.iter();
    let nearest = cells.min_by(|a, b| {
        let away = |cell: &SceneryCell| cell.center_planet_m.distance_squared(eye_m);
        away(a).total_cmp(&away(b))
    })?;
    Some(eye_m.normalize_or(DVec3::Z) * nearest.center_planet_m.length())
}

/// The map of a view.
pub(crate) struct ShadowMap {
    /// All cascades.
    pub(crate) view: wgpu::TextureView,
    /// Each cascade.
    pub(super) layers: Vec<wgpu::TextureView>,
    pub(crate) side_px: u32,
}

impl ShadowMap {
    pub(crate) fn new(device: &wgpu::Device, side_px: u32) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("shadows of objects"),
            size: wgpu::Extent3d { width: side_px, height: side_px, depth_or_array_layers: CASCADES as u32 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = |dimension, base_array_layer, array_layer_count| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(dimension),
                base_array_layer,
                array_layer_count: Some(array_layer_count),
                ..wgpu::TextureViewDescriptor::default()
            })
        };
        let layers = (0..CASCADES as u32).map(|layer| view(wgpu::TextureViewDimension::D2, layer, 1)).collect();
        Self { view: view(wgpu::TextureViewDimension::D2Array, 0, CASCADES as u32), layers, side_px }
    }

    /// Memory of the map.
    pub(crate) fn resident_bytes(&self) -> u64 {
        u64::from(self.side_px).pow(2) * 4 * CASCADES as u64
    }
}
