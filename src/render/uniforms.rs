//! The uniforms of every pass: [`Frame`] for the view, [`Body`] for the planet that a pass draws.
//!
//! [`frame`] and [`body`] compute them; `shaders/uniforms.wgsl` binds them.

mod air;
pub(crate) mod clouds;
mod giant;
mod ground;
mod neighbours;
mod rings;
mod water;

use super::debug_view::DebugView;
use super::scene::{self, Matrices, Scene, height_range_m, split_position};
pub(crate) use super::shared::{Body, Frame};
use super::shared::{MAX_POINTS, MAX_SUNS, MIXTURE_ENTRIES, Octave, Point, Sun};
use super::white_balance::{camera_balance, white_balance};
use super::{gpu, wgsl};
use crate::lod::Quality;
use glam::{DQuat, DVec2, DVec3, Mat4, UVec2, Vec2, Vec3};
use std::f64::consts::PI;

/// Where the picture lies and how it is drawn.
pub(crate) struct Drawn {
    /// Left, top, width and height in the targets.
    pub(crate) viewport_px: [u32; 4],
    /// Pixels drawn for each pixel shown, in one direction.
    pub(crate) render_scale: f32,
    /// The scene's, found once for all uniforms of the frame.
    pub(crate) matrices: Matrices,
}

/// Angle of a pixel in the middle of the picture.
fn pixel_rad(scene: &Scene<'_>, drawn: &Drawn) -> f32 {
    (2.0 * scene.projection.half_extent()[1] / f64::from(drawn.viewport_px[3])) as f32
}

/// The uniforms of a frame.
pub(crate) fn frame(scene: &Scene<'_>, drawn: &Drawn) -> Frame {
    let [x, y, width, height] = drawn.viewport_px;
    let [half_x, half_y] = scene.projection.half_extent();
    let [center_x, center_y] = scene.projection.center(scene.size_px);
    let (air_steps, pattern_quality) = match scene.quality {
        Quality::Low => (12.0, 0.0),
        Quality::Medium => (20.0, 1.0),
        Quality::High => (32.0, 2.0),
    };
    // The nearest body's sky decides how white the picture is.
    let nearest = scene.bodies.iter().min_by(|a, b| away_m(a).total_cmp(&away_m(b)));
    let daylight = nearest.map_or([1.0; 3], |body| white_balance(body.planet()));
    let white = DVec3::from_array(daylight) * DVec3::from_array(camera_balance(scene.post.white_k));
    let whole = scene.whole.unwrap_or(scene.projection);
    let whole_half = DVec2::from_array(whole.half_extent());
    let half = DVec2::new(half_x, half_y);
    let aside = DVec2::new(center_x, center_y) - DVec2::from_array(whole.center(scene.size_px));
    Frame {
        origin_px: UVec2::new(x, y).as_vec2(),
        size_px: UVec2::new(width, height).as_vec2(),
        lens_shift: Vec2::new((center_x / half_x) as f32, (center_y / half_y) as f32),
        near_m: drawn.matrices.near_m as f32,
        pixel_rad: pixel_rad(scene, drawn),
        render_scale: drawn.render_scale,
        time_secs: scene.time_secs as f32,
        exposure: scene.post.exposure_ev.exp2() as f32,
        debug_view: DebugView::ALL.iter().position(|&view| view == scene.debug_view).unwrap_or(0) as u32,
        tone: scene.post.tone as u32,
        white: white.as_vec3(),
        vignette: scene.post.vignette.clamp(0.0, 1.0) as f32,
        vignette_extent: (half / whole_half.length()).as_vec2(),
        whole_scale: (half / whole_half).as_vec2(),
        whole_offset: (aside / whole_half).as_vec2(),
        bloom: scene.post.bloom.clamp(0.0, 1.0) as f32,
        air_steps,
        pattern_quality,
        mixture_entries: MIXTURE_ENTRIES,
        still_scale: 1.0,
        ..Frame::default()
    }
}

/// Distance of the ground of a body, metres.
pub(crate) fn away_m(body: &scene::Body<'_>) -> f64 {
    body.position_m.length() - body.planet().radius_m()
}

/// The uniforms of a body. `is_backmost`: whether it is the farthest.
pub(crate) fn body(scene: &Scene<'_>, body: &scene::Body<'_>, drawn: &Drawn, is_backmost: bool) -> Body {
    let planet = body.planet();
    let eye_m = body.eye_planet_m();
    let body_from_view = body.scene_from_body.inverse() * scene.scene_from_view;
    let mut out = Body { march_block: 1, ..planet_only(planet) };
    place(&mut out, scene, drawn, planet.radius_m(), eye_m, body_from_view);
    out.is_backmost = u32::from(is_backmost);
    let (low_m, high_m) = height_range_m(body.surface);
    out.height_range_m = Vec2::new(low_m as f32, high_m as f32);
    let view = scene.view_of(body.position_m, body.scene_from_body);
    let chosen = body.frozen.as_ref().unwrap_or(&view);
    [out.chosen_eye_high_m, out.chosen_eye_low_m] =
        split_position(body.surface.morphing_eye_m(chosen.camera.position_planet_m));
    out.chosen_pixel_rad = chosen.pixel_rad() as f32;
    let body_from_scene = body.scene_from_body.inverse();
    let suns: Vec<(&scene::Sun, scene::Sun)> =
        scene.suns_of(body.id).map(|sun| (sun, sun.at(body.position_m))).take(MAX_SUNS).collect();
    out.sun_count = suns.len() as u32;
    for (slot, (seen, sun)) in out.suns.iter_mut().zip(&suns) {
        *slot = sun_uniform(sun, seen, body_from_scene);
    }
    let discs = suns.iter().filter(|(_, sun)| sun.has_disc);
    out.lut_sun_radius_rad = discs.map(|(_, sun)| sun.radius_rad).fold(0.0, f64::max) as f32;
    neighbours::of(&mut out, scene, body, suns.iter().map(|(_, sun)| *sun));
    if is_backmost {
        out.point_count = scene.points.len().min(MAX_POINTS) as u32;
        for (slot, point) in out.points.iter_mut().zip(&scene.points) {
            let dir = (body_from_scene * point.dir_scene).as_vec3();
            *slot = Point { dir, light: DVec3::from_array(point.light).as_vec3() };
        }
    }
    let marked = body.marked.is_some();
    out.marked = u32::from(marked);
    ground::from_eye(&mut out, planet, eye_m);
    let moment = (scene.time_secs, scene.quality);
    let pixel_rad = pixel_rad(scene, drawn);
    rings::from_eye(&mut out, planet, eye_m, scene.quality, pixel_rad);
    giant::at(&mut out, planet, scene.time_secs, eye_m, pixel_rad);
    water::from_eye(&mut out, &body.surface.terrain, planet, eye_m, moment);
    if !marked {
        clouds::from_eye(&mut out, planet, eye_m, scene, pixel_rad);
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
    rings::of(&mut out, planet);
    out
}

/// The eye, its rays and matrices in the body's frame.
fn place(out: &mut Body, scene: &Scene<'_>, drawn: &Drawn, radius_m: f64, eye_m: DVec3, body_from_view: DQuat) {
    let [_, _, width, height] = drawn.viewport_px;
    let eye_r = eye_m.length().max(1.0);
    let [half_x, half_y] = scene.projection.half_extent();
    let [center_x, center_y] = scene.projection.center(scene.size_px);
    let turned = |v: DVec3| (body_from_view * v).as_vec3();
    let view_from_rel = Mat4::from_quat(body_from_view.inverse().as_quat());
    out.clip_from_rel_m = drawn.matrices.clip_from_view * view_from_rel;
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

/// A light at a body, and as it is at the eye.
fn sun_uniform(sun: &scene::Sun, seen: &scene::Sun, body_from_scene: DQuat) -> Sun {
    // White ground under a sun of brightness 1 overhead has radiance 1.
    let irradiance = DVec3::from_array(sun.color) * (sun.brightness * PI);
    // A disc as bright as the Sun's would exceed 16 bits.
    let disc = (1.0 / (PI * sun.radius_rad.sin().powi(2))).min(15_000.0 / sun.brightness.max(1e-3));
    Sun {
        dir: (body_from_scene * sun.dir_scene).as_vec3(),
        radius_rad: sun.radius_rad as f32,
        irradiance: irradiance.as_vec3(),
        disc_gain: if sun.has_disc { disc as f32 } else { 0.0 },
        seen_dir: (body_from_scene * seen.dir_scene).as_vec3(),
        seen_radius_rad: seen.radius_rad as f32,
        per_km: (1000.0 / sun.distance_m) as f32,
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

/// Layout of group 0: frame, body, the two samplers, and the shadows of objects with their sampler.
pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    use gpu::Slot::{Comparison, DepthArray, Sampler, Storage, Uniform};
    gpu::layout(device, "uniforms", &[Uniform, Uniform, Sampler, Sampler, DepthArray, Comparison, Storage])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use crate::render::Projection;

    /// The matrix projects the ray of a pixel to that pixel, in any projection, with jitter, at any render scale.
    #[test]
    fn rays_and_matrix_agree() {
        let mut projection = Projection::off_axis([-0.3, 0.9, -0.5, 0.4]);
        (projection.jitter_px, projection.near_m) = ([7.0, -3.0], Some(1.0));
        let scene = Scene::new(DQuat::from_rotation_x(0.7), projection, [120, 90], Quality::High);
        let drawn = Drawn { viewport_px: [0, 0, 240, 180], render_scale: 2.0, matrices: scene.matrices() };
        // Its radius in kilometres is no number of 32 bits.
        let planet = Planet { radius_km: 6371.2345, ..Planet::default() };
        let eye_m = DVec3::Y * (planet.radius_m() + 2.0);
        let mut body = planet_only(&planet);
        place(&mut body, &scene, &drawn, planet.radius_m(), eye_m, DQuat::from_rotation_y(1.1));
        assert!((body.eye_altitude_km - 0.002).abs() < 1e-7, "{} km", body.eye_altitude_km);
        for (x, y) in [(0.0, 0.0), (1.0, 1.0), (-1.0, 0.5)] {
            let ray = body.ray_center + x * body.ray_right + y * body.ray_up;
            let clip = body.clip_from_rel_m * (ray * 1000.0).extend(1.0);
            let ndc = clip.truncate() / clip.w;
            assert!((ndc.x - x).abs() < 1e-5 && (ndc.y - y).abs() < 1e-5, "({x}, {y}) went to {ndc}");
            assert!((ndc.z - 1e-3).abs() < 1e-8, "depth is the near plane over the distance: {ndc}");
        }
    }
}
