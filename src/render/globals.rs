//! The uniform buffer that every pass reads: the frame in the units of the shaders. Must match `shaders/globals.wgsl`.

use super::biome_table::{WRAP_FAR_M, WRAP_M};
use super::{DebugView, Frame, Tone, gpu, white_balance};
use crate::lod::Quality;
use crate::planet::{Planet, TableBlend, TableRows};
use crate::terrain::border::{self, OCTAVE_TURN};
use glam::{DVec3, Mat4};
use std::f64::consts::{PI, TAU};

/// Waves that are summed up for the sea near the eye.
const WAVES: usize = 16;
/// Octaves of the mottling, coarse to fine.
const MOTTLE_PERIODS_M: [f64; 7] = [330_000.0, 41_000.0, 5100.0, 640.0, 80.0, 10.0, 1.25];

/// See `shaders/globals.wgsl` for what each field holds.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Globals {
    clip_from_rel_m: [[f32; 4]; 4],
    eye_high_m: [f32; 4],
    eye_low_m: [f32; 4],
    eye_km: [f32; 4],
    eye_up: [f32; 4],
    ray_right: [f32; 4],
    ray_up: [f32; 4],
    ray_forward: [f32; 4],
    sun_dir: [f32; 4],
    sun_irradiance: [f32; 4],
    rayleigh: [f32; 4],
    mie_scattering: [f32; 4],
    mie_extinction: [f32; 4],
    absorber: [f32; 4],
    air: [f32; 4],
    ground_albedo: [f32; 4],
    water_absorption: [f32; 4],
    water_color: [f32; 4],
    ice_color: [f32; 4],
    water: [f32; 4],
    waves: [[f32; 4]; WAVES],
    cloud_color: [f32; 4],
    clouds: [f32; 4],
    cloud_bands: [[f32; 4]; CLOUD_BANDS],
    cloud_march: [f32; 4],
    cloud_turn: [f32; 4],
    cloud_seed: [u32; 4],
    mottle: [[f32; 4]; 7],
    eye_wrap_m: [f32; 4],
    eye_wrap_far_m: [f32; 4],
    misc: [f32; 4],
    modes: [u32; 4],
    chosen_eye_high_m: [f32; 4],
    chosen_eye_low_m: [f32; 4],
    border: [[f32; 4]; border::OCTAVES],
    table: [f32; 4],
    climate: [f32; 4],
    white: [f32; 4],
}

/// What of a frame is not in [`Frame`].
pub(crate) struct Setup {
    /// Size of the picture that is drawn before it is shrunk or enlarged to the target.
    pub(crate) size_px: [u32; 2],
    /// 2, 1, or 0 for a half: pixels drawn for each one shown, in one direction.
    pub(crate) scale: u32,
    /// Lowest and highest height of the surface's tiles.
    pub(crate) height_range_m: (f64, f64),
    /// Pixels along a face of the weather map.
    pub(crate) weather_side_px: u32,
    /// Whether the target encodes sRGB by itself.
    pub(crate) srgb_target: bool,
    /// Whether cells of the biome table are marked: clouds would hide the places that light up.
    pub(crate) marked: bool,
    /// Which curve makes the picture.
    pub(crate) tone: Tone,
}

/// The buffer, the two samplers, and their bind group (group 0 of every pass).
pub(crate) struct GlobalsBuffer {
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) group: wgpu::BindGroup,
    buffer: wgpu::Buffer,
    written: Option<Globals>,
    writes: u64,
}

impl GlobalsBuffer {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let layout = gpu::layout(device, "globals", &[gpu::Slot::Uniform, gpu::Slot::Sampler, gpu::Slot::Sampler]);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("globals"),
            size: size_of::<Globals>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let sampler = |label, mode| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                address_mode_u: mode,
                address_mode_v: mode,
                address_mode_w: mode,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..wgpu::SamplerDescriptor::default()
            })
        };
        let clamped = sampler("clamped", wgpu::AddressMode::ClampToEdge);
        let repeated = sampler("repeated", wgpu::AddressMode::Repeat);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("globals"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&clamped) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&repeated) },
            ],
        });
        Self { layout, group, buffer, written: None, writes: 0 }
    }

    /// Sets the frame that the passes submitted next will see.
    pub(crate) fn write(&mut self, queue: &wgpu::Queue, frame: &Frame<'_>, setup: &Setup) {
        let globals = globals(frame, setup);
        let same = |written: &Globals| bytemuck::bytes_of(written) == bytemuck::bytes_of(&globals);
        if !self.written.as_ref().is_some_and(same) {
            queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(&globals));
            self.written = Some(globals);
            self.writes += 1;
        }
    }

    /// How often it was written because something in it had changed.
    pub(crate) fn writes(&self) -> u64 {
        self.writes
    }
}

fn vec4(v: DVec3, w: f64) -> [f32; 4] {
    [v.x as f32, v.y as f32, v.z as f32, w as f32]
}

fn rgbw(c: [f64; 3], w: f64) -> [f32; 4] {
    vec4(DVec3::from_array(c), w)
}

/// Fraction of each component, so that 32 bits hold it well.
fn wrapped(v: DVec3) -> DVec3 {
    v - v.floor()
}

fn globals(frame: &Frame<'_>, setup: &Setup) -> Globals {
    let planet = frame.planet;
    let camera = &frame.view.camera;
    let eye = camera.position_planet_m;
    let radius_m = planet.radius_m();
    let eye_r = eye.length().max(1.0);
    let up = eye / eye_r;
    let altitude_m = eye_r - radius_m;

    // Reverse-Z with the far plane at infinity: depth = near / distance.
    let clearance_m = altitude_m - setup.height_range_m.1;
    let near_m = (clearance_m * 0.05).clamp(0.05, 1000.0);
    let tan_y = (camera.fov_y_rad * 0.5).tan();
    let tan_x = tan_y * frame.view.aspect();
    let clip_from_view = Mat4::from_cols_array_2d(&[
        [(1.0 / tan_x) as f32, 0.0, 0.0, 0.0],
        [0.0, (1.0 / tan_y) as f32, 0.0, 0.0],
        [0.0, 0.0, 0.0, -1.0],
        [0.0, 0.0, near_m as f32, 0.0],
    ]);
    let view_from_rel = Mat4::from_quat(camera.planet_from_view.inverse().as_quat());
    let chosen = frame.frozen.as_ref().unwrap_or(&frame.view);
    let (high, low) = high_low(eye);
    let (chosen_high, chosen_low) = high_low(frame.surface.morphing_eye_m(chosen.camera.position_planet_m));
    let turn = |v: DVec3| camera.planet_from_view * v;

    let star = &planet.star;
    let sun_radius_rad = star.radius_deg.to_radians();
    // White ground under a star of brightness 1 overhead has radiance 1.
    let irradiance = star.color.map(|c| c * star.brightness * PI);
    let disc = (1.0 / (PI * sun_radius_rad.sin().powi(2))).min(15_000.0 / star.brightness.max(1e-3));

    let mut g: Globals = bytemuck::Zeroable::zeroed();
    g.clip_from_rel_m = (clip_from_view * view_from_rel).to_cols_array_2d();
    g.eye_high_m = vec4(high, near_m);
    g.eye_low_m = vec4(low, 2.0 * tan_y / f64::from(setup.size_px[1]));
    g.eye_km = vec4(eye * 1e-3, planet.radius_km);
    g.eye_up = vec4(up, altitude_m * 1e-3);
    g.ray_right = vec4(turn(DVec3::X * tan_x), f64::from(setup.size_px[0]));
    g.ray_up = vec4(turn(DVec3::Y * tan_y), f64::from(setup.size_px[1]));
    g.ray_forward = vec4(turn(DVec3::NEG_Z), frame.time_secs);
    g.sun_dir = vec4(frame.sun_dir_planet.normalize_or(DVec3::X), sun_radius_rad);
    g.sun_irradiance = rgbw(irradiance, disc);
    set_air(&mut g, frame);
    set_water(&mut g, planet, frame, altitude_m);
    set_clouds(&mut g, planet, frame, setup);
    let mut place = eye;
    for (slot, period) in g.mottle.iter_mut().zip(MOTTLE_PERIODS_M) {
        *slot = vec4(wrapped(place / period), period);
        place = OCTAVE_TURN * place;
    }
    g.eye_wrap_m = vec4(wrapped(eye / WRAP_M) * WRAP_M, planet.climate.lapse_c_per_km * 1e-3);
    let patterns = match frame.view.quality {
        Quality::Low => 0.0,
        Quality::Medium => 1.0,
        Quality::High => 2.0,
    };
    g.eye_wrap_far_m = vec4(wrapped(eye / WRAP_FAR_M) * WRAP_FAR_M, patterns);
    g.misc = [
        // Shaders count to it: a loop that is written out makes software drivers compile for minutes.
        10.0,
        setup.height_range_m.0 as f32,
        setup.height_range_m.1 as f32,
        frame.exposure_ev.exp2() as f32,
    ];
    let view = DebugView::ALL.iter().position(|&v| v == frame.debug_view).unwrap_or(0) as u32;
    g.modes = [view, setup.scale, u32::from(setup.srgb_target), setup.tone as u32];
    g.chosen_eye_high_m = vec4(chosen_high, 0.0);
    g.chosen_eye_low_m = vec4(chosen_low, chosen.pixel_rad());
    set_table(&mut g, planet, up * radius_m, setup.marked);
    g.white = rgbw(white_balance(planet), 0.0);
    g
}

/// The biome table's borders. `foot_m`: the point of the reference sphere under the eye.
fn set_table(g: &mut Globals, planet: &Planet, foot_m: DVec3, marked: bool) {
    let mut place_m = foot_m;
    for (slot, period_m) in g.border.iter_mut().zip(border::periods_m(planet.radius_m())) {
        *slot = vec4(wrapped(place_m / period_m), period_m);
        place_m = OCTAVE_TURN * place_m;
    }
    let flag = |on: bool| f32::from(u8::from(on));
    let is_crisp = planet.biomes.blend == TableBlend::Crisp;
    g.table = [planet.biomes.border_jitter as f32, flag(is_crisp), flag(marked), 0.0];
    g.climate = climate_by_height(planet).map(|number| number as f32);
}

/// The row of the biome table where temperature and height are 0, its change by °C and by metre, and that of moisture by metre.
fn climate_by_height(planet: &Planet) -> [f64; 4] {
    let biomes = &planet.biomes;
    let moisture_per_m = -planet.climate.drying_per_km * 1e-3;
    match biomes.rows {
        TableRows::Temperature => {
            let per_c = 1.0 / (biomes.hottest_c - biomes.coldest_c);
            [-biomes.coldest_c * per_c, per_c, 0.0, moisture_per_m]
        }
        TableRows::Elevation => {
            let per_m = 1.0 / (biomes.highest_m - biomes.lowest_m);
            [-biomes.lowest_m * per_m, 0.0, per_m, moisture_per_m]
        }
    }
}

/// A position as the sum of two that 32 bits hold.
fn high_low(position: DVec3) -> (DVec3, DVec3) {
    let high = position.as_vec3().as_dvec3();
    (high, position - high)
}

fn set_air(g: &mut Globals, frame: &Frame<'_>) {
    let steps = match frame.view.quality {
        Quality::Low => 12.0,
        Quality::Medium => 20.0,
        Quality::High => 32.0,
    };
    // Without air the scale heights still stand in denominators.
    let none = crate::planet::Atmosphere::default();
    let (air, height_km) = frame.planet.atmosphere.as_ref().map_or((&none, 0.0), |air| (air, air.height_km));
    let extinction: [f64; 3] = std::array::from_fn(|i| air.mie_scattering_per_km[i] + air.mie_absorption_per_km[i]);
    g.rayleigh = rgbw(air.rayleigh_per_km, air.rayleigh_scale_km);
    g.mie_scattering = rgbw(air.mie_scattering_per_km, air.mie_scale_km);
    g.mie_extinction = rgbw(extinction, air.mie_anisotropy);
    g.absorber = rgbw(air.absorber_per_km, air.absorber_height_km);
    g.air = [height_km as f32, air.absorber_width_km as f32, steps, 0.0];
    g.ground_albedo = rgbw(air.ground_albedo, 0.0);
}

fn set_water(g: &mut Globals, planet: &Planet, frame: &Frame<'_>, altitude_m: f64) {
    let none = crate::planet::Water::default();
    let water = planet.water.as_ref().unwrap_or(&none);
    let eye = frame.view.camera.position_planet_m;
    // Cox and Munk 1954: variance of the slope, up- and crosswind together.
    let variance = 0.003 + 0.00512 * water.wind_m_s;
    g.water_absorption = rgbw(water.absorption_per_m, f64::from(u8::from(planet.water.is_some())));
    g.water_color = rgbw(water.color, variance);
    g.ice_color = rgbw(water.ice_color, water.freezing_c);
    let (equator, pole) = (planet.climate.equator_c as f32, planet.climate.pole_c as f32);
    let over_sea_km = (altitude_m - water.level_m) * 1e-3;
    g.water = [(water.level_m * 1e-3) as f32, over_sea_km as f32, equator, pole];
    for (i, slot) in g.waves.iter_mut().enumerate() {
        // Directions spread over the sphere by the golden angle, lengths from 30 m down to 0.2 m.
        let x = (i as f64 + 0.5) / WAVES as f64;
        let length_m = 30.0 * (0.2_f64 / 30.0).powf(x);
        let z = 1.0 - 2.0 * ((i * 7 % WAVES) as f64 + 0.5) / WAVES as f64;
        let angle = i as f64 * 2.399_963;
        let flat = (1.0 - z * z).sqrt();
        let k = TAU / length_m;
        let wave = DVec3::new(flat * angle.cos(), flat * angle.sin(), z) * k;
        // Deep water: omega^2 = g k.
        let phase = wave.dot(eye) - (9.81 * k).sqrt() * frame.time_secs;
        *slot = vec4(wave, phase.rem_euclid(TAU));
    }
}

/// Bands of the clouds' noise, widest first; each is turned and finer by the ratio against the one before, so that the
/// repeats of their tile never fall together.
const CLOUD_BANDS: usize = 6;
/// The band whose tile holds four puffs along its side.
const CLOUD_PUFF_BAND: i32 = 3;
const CLOUD_BAND_RATIO: f64 = 3.3;
/// First step of a march that begins in the layer, in thicknesses of the layer.
const CLOUD_FIRST_STEP: f64 = 0.06;

/// Ratio of each of `steps` steps to the one before when their sum is `sum` first steps; above 1.
fn step_growth(sum: f64, steps: f64) -> f64 {
    let (mut low, mut high) = (1.001, 1e4);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let reached = (middle.powf(steps) - 1.0) / (middle - 1.0);
        (low, high) = if reached < sum { (middle, high) } else { (low, middle) };
    }
    high
}

fn set_clouds(g: &mut Globals, planet: &Planet, frame: &Frame<'_>, setup: &Setup) {
    let Some(clouds) = planet.clouds.as_ref().filter(|_| !setup.marked) else { return };
    let steps = match frame.view.quality {
        Quality::Low => 7.0,
        Quality::Medium => 16.0,
        Quality::High => 28.0,
    };
    let eye = frame.view.camera.position_planet_m;
    let eye_km = eye * 1e-3;
    let (bottom, top) = (clouds.altitude_km, clouds.altitude_km + clouds.thickness_km);
    let angle = clouds.wind_km_h / 3600.0 * frame.time_secs / planet.radius_km;
    let (s, c) = angle.rem_euclid(TAU).sin_cos();
    let turned = DVec3::new(c * eye_km.x + s * eye_km.y, c * eye_km.y - s * eye_km.x, eye_km.z);
    let period_km = clouds.puff_km * 4.0;
    // From so far away that the layer is thinner than a pixel a few samples tell all. One choice for the whole picture.
    let away_km = eye_km.length() - planet.radius_km - top;
    let thin = away_km * f64::from(g.eye_low_m[3]) > 0.5 * clouds.thickness_km;
    g.cloud_color = rgbw(clouds.color, clouds.density);
    g.clouds = [bottom as f32, top as f32, clouds.coverage as f32, period_km as f32];
    let mut place = turned;
    for (band, octave) in g.cloud_bands.iter_mut().enumerate() {
        let period_km = period_km * CLOUD_BAND_RATIO.powi(CLOUD_PUFF_BAND - band as i32);
        *octave = vec4(wrapped(place / period_km), period_km);
        place = OCTAVE_TURN * place;
    }
    // The longest way within the layer goes from its top down to its bottom and up again.
    let longest_km = 2.0 * (2.0 * (planet.radius_km + top) * clouds.thickness_km).sqrt();
    let first_km = CLOUD_FIRST_STEP * clouds.thickness_km;
    let steps = if thin { 3.0 } else { steps };
    let growth = step_growth(longest_km / first_km, steps);
    g.cloud_march = [steps as f32, first_km as f32, growth as f32, 0.0];
    g.cloud_turn = [c as f32, s as f32, (planet.radius_km / clouds.scale_km) as f32, clouds.curl as f32];
    g.cloud_seed = [clouds.seed ^ planet.seed.rotate_left(16), setup.weather_side_px, 0, 0];
}
