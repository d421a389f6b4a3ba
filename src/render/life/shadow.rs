//! Shadows: maps of the depth from the sun around the eye, of objects and of a game's things.
//!
//! The maps turn with the sun and stand still on the planet: their centre moves by whole texels, so that edges do not
//! crawl while the camera moves. The ground's own shadows come from its horizon angles.
//!
//! Objects are in two cascades. A game's things are in the nearer one and, beyond it, in a wider map of their own: the
//! wide cascade of objects tells how much sky crowns hide, which says nothing about a tower.

use super::canopy::through_leaves;
use super::view::populations;
use crate::life::scenery::{Scenery, SceneryCell};
use crate::lod::Quality;
use crate::render::caster::ShadowView;
use crate::render::debug_view::DebugView;
use crate::render::scene::{Body, Scene};
use crate::render::shared;
use crate::render::targets::DEPTH_FORMAT;
use crate::terrain::Terrain;
use glam::{DVec3, Mat4, Vec3, Vec4};

/// Cascades of objects, nearest first.
pub(crate) const CASCADES: usize = 2;
/// All maps: the cascades, and the map of a game's things.
pub(crate) const SHADOW_MAPS: usize = CASCADES + 1;
/// The map that tells of the sky.
pub(super) const SKY_MAP: usize = 1;
/// Radius of the map of a game's things, as a multiple of the wide cascade's.
const CASTER_RADII: f64 = 4.0;
/// Half the depth of a map along the sunlight, as a multiple of its radius, and at least these metres.
const DEPTH_RADII: f64 = 2.0;
const LEAST_DEPTH_M: f64 = 150.0;
/// Greatest depth towards the sun, which grows with what a game lets fly over the map: 32 bits tell millimetres there.
const MOST_DEPTH_M: f64 = 50_000.0;
/// Least height of an object that casts a shadow, in texels.
const LEAST_TEXELS: f64 = 5.0;
/// Sine of the sun's elevation below which nothing casts a shadow: the light of dusk has no edges.
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
    maps: [ShadowView; SHADOW_MAPS],
    /// Middle of the maps, metres from the eye.
    center_rel_m: DVec3,
    through_leaves: Vec3,
    has_objects: bool,
    has_casters: bool,
    side_px: u32,
}

impl Cascades {
    /// The maps of a body in a scene; None where nothing casts a shadow.
    pub(crate) fn new(scene: &Scene<'_>, body: &Body<'_>) -> Option<Self> {
        let scenery = &body.surface.scenery;
        let (has_objects, has_casters) = (!scenery.cells.is_empty(), !body.casters.is_empty());
        if !(has_objects || has_casters) || !matches!(scene.debug_view, DebugView::Shaded) {
            return None;
        }
        let sun = scene.suns_of(body.id).next()?.at(body.position_m);
        let sun_dir = body.scene_from_body.inverse() * sun.dir_scene;
        let eye_m = body.eye_planet_m();
        let up = eye_m.normalize_or(DVec3::Z);
        if up.dot(sun_dir) < LEAST_SUN_SINE {
            return None;
        }
        let foot_m = ground_below(scenery, &body.surface.terrain, eye_m);
        let altitude_m = (eye_m.length() - foot_m.length()).max(0.0);
        let ([near_m, far_m], side_px) = extent(scene.quality, altitude_m);
        let (across, along) = sun_dir.any_orthonormal_pair();
        let map = |number: usize| {
            let radius_m = [near_m, far_m, CASTER_RADII * far_m][number];
            let texel_m = 2.0 * radius_m / f64::from(side_px);
            let snapped = |axis: DVec3| (foot_m.dot(axis) / texel_m).round() * texel_m - eye_m.dot(axis);
            let beyond_m = (DEPTH_RADII * radius_m).max(LEAST_DEPTH_M);
            let towards_m =
                if number == SKY_MAP { beyond_m } else { highest_m(body, foot_m, sun_dir, radius_m, beyond_m) };
            let depth_m = towards_m + beyond_m;
            let row = |axis: DVec3, middle: f64, half: f64| {
                let axis = axis / half;
                Vec4::new(axis.x as f32, axis.y as f32, axis.z as f32, (-middle / half) as f32)
            };
            // Depth 0 is nearest to the sun.
            let mut depth = row(-sun_dir, -(foot_m - eye_m).dot(sun_dir), depth_m);
            depth.w += (towards_m / depth_m) as f32;
            let rows = [row(across, snapped(across), radius_m), row(along, snapped(along), radius_m), depth, Vec4::W];
            let clip_from_rel_m = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
            ShadowView { clip_from_rel_m, eye_planet_m: eye_m, texel_m, radius_m, depth_m }
        };
        let (maps, center_rel_m) = (std::array::from_fn(map), foot_m - eye_m);
        let through_leaves = through_leaves(scenery, populations(body));
        Some(Self { maps, center_rel_m, through_leaves, has_objects, has_casters, side_px })
    }

    /// The maps that are drawn.
    pub(super) fn views(&self) -> &[ShadowView] {
        if self.has_casters { &self.maps } else { &self.maps[..CASCADES] }
    }

    /// Tells the shaders.
    pub(crate) fn write(&self, out: &mut shared::Body) {
        out.shadow_from_rel_m = self.maps.map(|map| map.clip_from_rel_m);
        out.shadow_texel_m = Vec3::from_array(self.maps.map(|map| map.texel_m as f32));
        out.through_leaves = self.through_leaves;
        (out.has_shadows, out.has_casters) = (u32::from(self.has_objects), u32::from(self.has_casters));
    }

    /// Whether objects of a cell may cast shadows into any cascade. `reach`: distance from its foot within which an
    /// object lies, in heights.
    pub(super) fn reaches(&self, cell: &SceneryCell, reach: f64, eye_m: DVec3) -> bool {
        let reach_m = 1.5 * self.maps[CASCADES - 1].radius_m + cell.radius_m(reach);
        (cell.center_planet_m - eye_m).distance(self.center_rel_m) < reach_m
    }

    /// Whether an object casts a shadow into a cascade that is worth drawing.
    pub(super) fn takes(&self, cascade: usize, rel_m: DVec3, size_m: f64) -> bool {
        let ShadowView { radius_m, texel_m, .. } = self.maps[cascade];
        size_m > LEAST_TEXELS * texel_m && rel_m.distance(self.center_rel_m) < 1.5 * radius_m + 4.0 * size_m
    }
}

/// Point of the ground or the sea below the eye: at the height of the nearest cell of objects, where there is one.
fn ground_below(scenery: &Scenery, terrain: &Terrain, eye_m: DVec3) -> DVec3 {
    let cells = scenery.cells.iter();
    let nearest = cells.min_by(|a, b| {
        let away = |cell: &SceneryCell| cell.center_planet_m.distance_squared(eye_m);
        away(a).total_cmp(&away(b))
    });
    let up = eye_m.normalize_or(DVec3::Z);
    let planet = terrain.planet();
    let below_m = || planet.radius_m() + terrain.height_m(up).max(planet.sea_level_m().unwrap_or(f64::MIN));
    up * nearest.map_or_else(below_m, |cell| cell.center_planet_m.length())
}

/// How far towards the sun a map must reach for the things of a game over it; at least `least_m`.
fn highest_m(body: &Body<'_>, foot_m: DVec3, sun_dir: DVec3, radius_m: f64, least_m: f64) -> f64 {
    let tops = body.casters.iter().filter_map(|caster| {
        let (center_planet_m, ball_m) = caster.ball();
        let rel_m = center_planet_m - foot_m;
        let is_over = rel_m.reject_from_normalized(sun_dir).length() < 1.5 * radius_m + ball_m;
        is_over.then(|| rel_m.dot(sun_dir) + ball_m)
    });
    tops.fold(least_m, f64::max).min(MOST_DEPTH_M.max(least_m))
}

/// The maps of a view.
pub(crate) struct ShadowMap {
    /// All of them.
    pub(crate) view: wgpu::TextureView,
    /// Each of them.
    pub(super) layers: Vec<wgpu::TextureView>,
    side_px: u32,
}

impl ShadowMap {
    pub(crate) fn new(device: &wgpu::Device, side_px: u32, maps: usize) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("shadows"),
            size: wgpu::Extent3d { width: side_px, height: side_px, depth_or_array_layers: maps as u32 },
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
        let layers = (0..maps as u32).map(|layer| view(wgpu::TextureViewDimension::D2, layer, 1)).collect();
        Self { view: view(wgpu::TextureViewDimension::D2Array, 0, maps as u32), layers, side_px }
    }

    /// Makes the maps anew if they do not suit those of a frame; whether it did. Room for a game's things is kept.
    pub(crate) fn fit(map: &mut Option<Self>, device: &wgpu::Device, cascades: &Cascades) -> bool {
        let (side_px, maps) = (cascades.side_px, cascades.views().len());
        let fits = map.as_ref().is_some_and(|map| map.side_px == side_px && map.layers.len() >= maps);
        if !fits {
            *map = Some(Self::new(device, side_px, maps));
        }
        !fits
    }

    /// Memory of the maps.
    pub(crate) fn resident_bytes(&self) -> u64 {
        u64::from(self.side_px).pow(2) * 4 * self.layers.len() as u64
    }
}
