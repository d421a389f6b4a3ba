//! The uniforms of every pass: [`Frame`] for the view, [`Body`] for the planet that a pass draws.
//!
//! [`frame`] and [`body`] compute them; `shaders/uniforms.wgsl` binds them.

mod air;
mod clouds;
mod ground;
mod water;

use super::scene::{self, MAX_SUNS, Scene, height_range_m, split_position};
use super::shared::{BORDER_OCTAVES, CLOUD_BANDS, MOTTLE_OCTAVES, WAVES};
use super::wgsl::uniform_struct;
use super::{gpu, wgsl, white_balance};
use crate::lod::Quality;
use glam::{DQuat, DVec3, Mat4, UVec2, Vec2, Vec3};
use std::f64::consts::PI;

uniform_struct! {
    /// Uniforms of a frame.
    Frame {
        /// Left upper corner of the picture in its targets, pixels.
        origin_px: Vec2,
        /// Width and height of the picture, pixels.
        size_px: Vec2,
        /// The view axis in the picture: right and up, 0 in a symmetric projection, +-1 at the edges.
        lens_shift: Vec2,
        /// Distance of the near plane. Depth = near_m / distance along the view axis.
        near_m: f32,
        /// Angle of a pixel in the middle of the picture.
        pixel_rad: f32,
        /// Pixels drawn for each pixel shown, in one direction: 2, 1 or 0.5.
        render_scale: f32,
        /// Seconds since time zero.
        time_secs: f32,
        /// Factor on radiance, set by hand.
        exposure: f32,
        /// VIEW_SHADED, ...
        debug_view: u32,
        /// TONE_AGX, ...
        tone: u32,
        /// White balance: gains on radiance.
        white: Vec3,
        /// Steps of a march through the air.
        air_steps: f32,
        /// Quality of the ground's patterns: 0 (one tap of one pattern) to 2.
        pattern_quality: f32,
        /// Biomes in a mixture: MIXTURE_ENTRIES. Loops count to a uniform: software drivers compile an unrolled one for
        /// minutes.
        mixture_entries: u32,
    }
}

uniform_struct! {
    /// A light at infinity.
    Sun {
        /// Unit vector towards it.
        dir: Vec3,
        /// Angular radius of its disc.
        radius_rad: f32,
        /// Irradiance outside the air on a surface that faces it.
        irradiance: Vec3,
        /// Radiance of its disc over its irradiance.
        disc_gain: f32,
    }
}

uniform_struct! {
    /// An octave of a noise that repeats.
    Octave {
        /// The eye in the octave's own frame, in periods, 0 to 1.
        offset: Vec3,
        /// Length after which it repeats, in the unit of the noise's positions.
        period: f32,
    }
}

uniform_struct! {
    /// A plane wave of the sea.
    Wave {
        /// Wave vector, radians per metre.
        vector_per_m: Vec3,
        /// Phase at the eye.
        phase: f32,
    }
}

uniform_struct! {
    /// Uniforms of a body in a view, in the body's frame.
    Body {
        /// Metres from the eye, in the body's axes, to clip space.
        clip_from_rel_m: Mat4,
        /// The eye from the body's centre: greater part and rest.
        eye_high_m: Vec3,
        /// 1 for the body farthest away: behind it are stars.
        is_backmost: u32,
        eye_low_m: Vec3,
        /// 1 for the body nearest to the eye: before it the lens scatters light.
        is_frontmost: u32,
        /// The eye from the body's centre.
        eye_km: Vec3,
        /// Radius of the reference sphere.
        radius_km: f32,
        /// Unit vector from the centre to the eye.
        eye_up: Vec3,
        /// Height of the eye above the reference sphere.
        eye_altitude_km: f32,
        /// Ray of a pixel = ray_center + x ray_right + y ray_up with x, y from -1 to 1: one unit of it is one unit of
        /// depth.
        ray_right: Vec3,
        ray_up: Vec3,
        ray_center: Vec3,
        /// Unit vector along the view axis.
        view_axis: Vec3,
        /// Change of the ray from a pixel to the next on the right.
        pixel_right: Vec3,
        /// Change of the ray from a pixel to the next above.
        pixel_up: Vec3,
        /// Suns that shine.
        sun_count: u32,
        suns: [Sun; MAX_SUNS],
        /// Angular radius that the LUTs of the air were made with.
        lut_sun_radius_rad: f32,
        /// Rayleigh scattering at the reference sphere.
        rayleigh_per_km: Vec3,
        rayleigh_scale_km: f32,
        /// Mie scattering and extinction at the reference sphere.
        mie_scattering_per_km: Vec3,
        mie_scale_km: f32,
        mie_extinction_per_km: Vec3,
        /// Parameter g of the phase function of Cornette and Shanks.
        mie_anisotropy: f32,
        /// Absorption in the middle of the absorber, whose density is a triangle over height.
        absorber_per_km: Vec3,
        absorber_height_km: f32,
        /// Half width of the absorber.
        absorber_width_km: f32,
        /// Thickness of the air; 0 without air.
        air_height_km: f32,
        /// Mean albedo of the ground, for multiple scattering.
        ground_albedo: Vec3,
        /// 1 where there is a sea.
        has_sea: u32,
        water_absorption_per_m: Vec3,
        /// Height of the sea above the reference sphere.
        sea_level_km: f32,
        water_color: Vec3,
        /// Height of the eye above the sea.
        eye_over_sea_km: f32,
        ice_color: Vec3,
        freezing_c: f32,
        /// Variance of the slope of all waves (Cox and Munk).
        wave_slope_variance: f32,
        /// Temperature at the level of the sea.
        equator_c: f32,
        pole_c: f32,
        waves: [Wave; WAVES],
        cloud_color: Vec3,
        /// Of the layer from top to bottom.
        cloud_optical_depth: f32,
        cloud_bottom_km: f32,
        cloud_top_km: f32,
        /// Share of the sky that clouds cover; 0 without clouds.
        cloud_coverage: f32,
        /// Period of the noise band that makes puffs.
        cloud_puff_period_km: f32,
        /// Bands of the noise that shapes clouds, widest first; periods in km.
        cloud_bands: [Octave; CLOUD_BANDS],
        cloud_steps: f32,
        /// First step of a march that begins in the layer, and the ratio of each step to the one before.
        cloud_first_step_km: f32,
        cloud_step_growth: f32,
        /// Weather systems along the radius.
        cloud_systems_per_radius: f32,
        /// Cosine and sine of the drift about the pole.
        cloud_drift: Vec2,
        cloud_curl: f32,
        cloud_seed: u32,
        /// Octaves of the macro variation; periods in metres.
        mottle: [Octave; MOTTLE_OCTAVES],
        /// The eye's position modulo 1024 m, for patterns that repeat.
        eye_wrap_m: Vec3,
        /// How much colder it gets with each metre of height.
        lapse_c_per_m: f32,
        /// The eye's position modulo 2^20 m.
        eye_wrap_far_m: Vec3,
        /// Of the eye that the tiles were chosen for.
        chosen_pixel_rad: f32,
        /// The eye that the tiles were chosen for: greater part and rest.
        chosen_eye_high_m: Vec3,
        /// How far noise moves the borders between biomes, in cells of the biome table.
        border_jitter_cells: f32,
        chosen_eye_low_m: Vec3,
        /// 1 for crisp borders between biomes.
        crisp_borders: u32,
        /// Octaves of the border jitter at the point of the reference sphere under the eye; periods in metres.
        border: [Octave; BORDER_OCTAVES],
        /// Lowest and highest height of the tiles.
        height_range_m: Vec2,
        /// Row of the biome table, 0 to 1: row_offset + row_per_c temperature in °C + row_per_m height over the sea.
        row_offset: f32,
        row_per_c: f32,
        row_per_m: f32,
        /// Change of moisture with height.
        moisture_per_m: f32,
        /// 1 while cells of the biome table are highlighted.
        marked: u32,
    }
}

/// Where the picture lies and how it is drawn.
pub(crate) struct Drawn {
    /// Left, top, width and height in the targets.
    pub(crate) viewport_px: [u32; 4],
    /// Pixels drawn for each pixel shown, in one direction.
    pub(crate) render_scale: f32,
}

/// The uniforms of a frame.
pub(crate) fn frame(scene: &Scene<'_>, drawn: &Drawn) -> Frame {
    let [x, y, width, height] = drawn.viewport_px;
    let [half_x, half_y] = scene.projection.half_extent();
    let [center_x, center_y] = scene.projection.center([width, height]);
    let (air_steps, pattern_quality) = match scene.quality {
        Quality::Low => (12.0, 0.0),
        Quality::Medium => (20.0, 1.0),
        Quality::High => (32.0, 2.0),
    };
    // The nearest body's sky decides how white the picture is.
    let nearest = scene.bodies.iter().min_by(|a, b| away_m(a).total_cmp(&away_m(b)));
    let white = nearest.map_or([1.0; 3], |body| white_balance(body.planet));
    Frame {
        origin_px: UVec2::new(x, y).as_vec2(),
        size_px: UVec2::new(width, height).as_vec2(),
        lens_shift: Vec2::new((center_x / half_x) as f32, (center_y / half_y) as f32),
        near_m: scene.matrices().near_m as f32,
        pixel_rad: (2.0 * half_y / f64::from(height)) as f32,
        render_scale: drawn.render_scale,
        time_secs: scene.time_secs as f32,
        exposure: scene.post.exposure_ev.exp2() as f32,
        debug_view: scene::DebugView::ALL.iter().position(|&view| view == scene.debug_view).unwrap_or(0) as u32,
        tone: scene.post.tone as u32,
        white: DVec3::from_array(white).as_vec3(),
        air_steps,
        pattern_quality,
        mixture_entries: super::shared::MIXTURE_ENTRIES,
    }
}

/// Distance of the ground of a body, metres.
pub(crate) fn away_m(body: &scene::Body<'_>) -> f64 {
    body.position_m.length() - body.planet.radius_m()
}

/// The uniforms of a body. `order`: whether it is the farthest, and the nearest, of those whose air is drawn.
pub(crate) fn body(scene: &Scene<'_>, body: &scene::Body<'_>, drawn: &Drawn, order: [bool; 2]) -> Body {
    let planet = body.planet;
    let eye_m = body.eye_planet_m();
    let body_from_view = body.scene_from_body.inverse() * scene.scene_from_view;
    let (frame, mut out) = (frame(scene, drawn), planet_only(planet));
    place(&mut out, scene, drawn, eye_m, body_from_view);
    [out.is_backmost, out.is_frontmost] = order.map(u32::from);
    let (low_m, high_m) = height_range_m(body.surface);
    out.height_range_m = Vec2::new(low_m as f32, high_m as f32);
    let view = scene.view_of(body.position_m, body.scene_from_body);
    let chosen = body.frozen.as_ref().unwrap_or(&view);
    [out.chosen_eye_high_m, out.chosen_eye_low_m] =
        split_position(body.surface.morphing_eye_m(chosen.camera.position_planet_m));
    out.chosen_pixel_rad = chosen.pixel_rad() as f32;
    let body_from_scene = body.scene_from_body.inverse();
    out.sun_count = scene.suns.len().min(MAX_SUNS) as u32;
    for (slot, sun) in out.suns.iter_mut().zip(&scene.suns) {
        *slot = sun_uniform(sun, body_from_scene);
    }
    let widest = scene.suns.iter().map(|sun| sun.radius_rad).fold(0.0, f64::max);
    out.lut_sun_radius_rad = widest as f32;
    let marked = body.marked.is_some();
    out.marked = u32::from(marked);
    ground::from_eye(&mut out, planet, eye_m);
    water::from_eye(&mut out, planet, eye_m, scene.time_secs);
    if !marked {
        clouds::from_eye(&mut out, planet, eye_m, scene, frame.pixel_rad);
    }
    out
}

/// The uniforms that depend on the planet alone.
pub(crate) fn planet_only(planet: &crate::planet::Planet) -> Body {
    let mut out = Body { radius_km: planet.radius_km as f32, ..Body::default() };
    out.lut_sun_radius_rad = planet.star.radius_deg.to_radians() as f32;
    air::of(&mut out, planet);
    water::of(&mut out, planet);
    ground::of(&mut out, planet);
    out
}

/// The eye, its rays and matrices in the body's frame.
fn place(out: &mut Body, scene: &Scene<'_>, drawn: &Drawn, eye_m: DVec3, body_from_view: DQuat) {
    let [_, _, width, height] = drawn.viewport_px;
    let radius_m = f64::from(out.radius_km) * 1e3;
    let eye_r = eye_m.length().max(1.0);
    let [half_x, half_y] = scene.projection.half_extent();
    let [center_x, center_y] = scene.projection.center([width, height]);
    let turned = |v: DVec3| (body_from_view * v).as_vec3();
    let view_from_rel = Mat4::from_quat(body_from_view.inverse().as_quat());
    out.clip_from_rel_m = scene.matrices().clip_from_view * view_from_rel;
    [out.eye_high_m, out.eye_low_m] = split_position(eye_m);
    out.eye_km = (eye_m * 1e-3).as_vec3();
    out.eye_up = (eye_m / eye_r).as_vec3();
    out.eye_altitude_km = ((eye_r - radius_m) * 1e-3) as f32;
    out.ray_right = turned(DVec3::X * half_x);
    out.ray_up = turned(DVec3::Y * half_y);
    out.ray_center = turned(DVec3::new(center_x, center_y, -1.0));
    out.view_axis = turned(DVec3::NEG_Z);
    out.pixel_right = out.ray_right * (2.0 / width as f32);
    out.pixel_up = out.ray_up * (2.0 / height as f32);
}

fn sun_uniform(sun: &scene::Sun, body_from_scene: DQuat) -> Sun {
    // White ground under a sun of brightness 1 overhead has radiance 1.
    let irradiance = DVec3::from_array(sun.color) * (sun.brightness * PI);
    // A disc as bright as the Sun's would exceed 16 bits.
    let disc = (1.0 / (PI * sun.radius_rad.sin().powi(2))).min(15_000.0 / sun.brightness.max(1e-3));
    Sun {
        dir: (body_from_scene * sun.dir_scene).as_vec3(),
        radius_rad: sun.radius_rad as f32,
        irradiance: irradiance.as_vec3(),
        disc_gain: disc as f32,
    }
}

/// Fraction of each component, so that 32 bits hold it well.
fn wrapped(v: DVec3) -> DVec3 {
    v - v.floor()
}

/// An octave at a position, both in one unit.
fn octave(position: DVec3, period: f64) -> Octave {
    Octave { offset: wrapped(position / period).as_vec3(), period: period as f32 }
}

/// A colour as a vector.
fn rgb(color: [f64; 3]) -> Vec3 {
    DVec3::from_array(color).as_vec3()
}

/// A uniform buffer that is written when its value changes.
pub(crate) struct UniformBuffer {
    pub(crate) buffer: wgpu::Buffer,
    written: Vec<u8>,
}

impl UniformBuffer {
    /// Room for a `T`.
    pub(crate) fn new<T: wgsl::Uniform>(device: &wgpu::Device, label: &str) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: T::SIZE as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { buffer, written: Vec::new() }
    }

    /// Sets the value that passes submitted next will read; whether it is another than before.
    pub(crate) fn write<T: wgsl::Uniform>(&mut self, queue: &wgpu::Queue, value: &T) -> bool {
        let bytes = wgsl::bytes_of(value);
        let changed = bytes != self.written;
        if changed {
            queue.write_buffer(&self.buffer, 0, &bytes);
            self.written = bytes;
        }
        changed
    }
}

/// Layout of group 0: frame, body, and the two samplers.
pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    use gpu::Slot::{Sampler, Uniform};
    gpu::layout(device, "uniforms", &[Uniform, Uniform, Sampler, Sampler])
}
