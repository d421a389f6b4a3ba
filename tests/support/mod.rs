//! A planet with an analytic surface, and a device to draw it on: what the renderer's tests need of the rest.
#![allow(dead_code, unreachable_pub, clippy::expect_used, clippy::panic)]

use glam::DVec3;
use std::collections::HashSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tellus::build::{BuildStats, Leaf, Surface};
use tellus::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES};
use tellus::lod::{Camera, Quality, Tile, Vertex, View};
use tellus::planet::{Atmosphere, Biome, Clouds, Planet, Table, Water};
use tellus::render::{DebugView, Frame, Renderer};
use tellus::sphere::{Edge, LatLon, NodeId};
use tellus::terrain::Terrain;

/// Height over the reference sphere: waves of all sizes, the shorter the lower.
pub fn height_m(dir: DVec3) -> f64 {
    let mut sum = 0.0;
    let mut p = dir * 2.1 + DVec3::new(0.3, 1.7, -0.4);
    let mut amplitude = 2600.0;
    for _ in 0..17 {
        sum += amplitude * (p.x + 1.3 * p.y.sin()).sin() * (p.y + 0.7 * p.z.sin()).cos();
        p = DVec3::new(p.y * 2.03 + 1.1, p.z * 2.11 - 0.7, p.x * 2.07 + 0.5);
        amplitude *= 0.52;
    }
    sum + 150.0
}

fn octahedral(n: DVec3) -> [i16; 2] {
    let n = n / (n.x.abs() + n.y.abs() + n.z.abs());
    let sign = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
    let (x, y) = if n.z >= 0.0 { (n.x, n.y) } else { ((1.0 - n.y.abs()) * sign(n.x), (1.0 - n.x.abs()) * sign(n.y)) };
    [x, y].map(|c| (c * 32767.0).round() as i16)
}

/// The tile of a node.
pub fn tile(id: NodeId, planet: &Planet, height_m: &dyn Fn(DVec3) -> f64) -> Tile {
    static SERIAL: AtomicU64 = AtomicU64::new(1);
    let radius_m = planet.radius_m();
    let at = |u: f64, v: f64| {
        let dir = id.direction(u, v);
        let height = height_m(dir);
        (dir, height, dir * (radius_m + height))
    };
    let mut vertices = Vec::with_capacity(TILE_VERTICES);
    let step = 1.0 / TILE_QUADS as f64;
    for y in 0..TILE_SIDE {
        for x in 0..TILE_SIDE {
            let (u, v) = (x as f64 * step, y as f64 * step);
            let (dir, height, position) = at(u, v);
            let e = step * 0.7;
            let normal = (at(u + e, v).2 - at(u - e, v).2).cross(at(u, v + e).2 - at(u, v - e).2).normalize();
            let temperature = planet.climate.equator_c
                + (planet.climate.pole_c - planet.climate.equator_c) * dir.z * dir.z
                - planet.climate.lapse_c_per_km * height.max(0.0) * 1e-3;
            let moisture = 0.5 + 0.4 * (dir.x * 5.0).sin() * (dir.y * 4.0 + 1.0).cos();
            let row = (temperature - planet.biomes.coldest_c) / (planet.biomes.hottest_c - planet.biomes.coldest_c);
            let high = position.to_array().map(|c| c as f32);
            let low = std::array::from_fn(|i| (position[i] - f64::from(high[i])) as f32);
            vertices.push(Vertex {
                position_high_m: high,
                height_m: height as f32,
                position_low_m: low,
                temperature_c: temperature as f32,
                climate_unorm: [moisture, row].map(|c| (c.clamp(0.0, 1.0) * 65535.0) as u16),
                normal_oct: octahedral(normal),
                parent_normal_oct: octahedral(normal),
            });
        }
    }
    let heights = vertices.iter().map(|v| f64::from(v.height_m));
    let center = id.direction(0.5, 0.5) * radius_m;
    let position = |v: &Vertex| DVec3::from_array(v.position_high_m.map(f64::from));
    Tile {
        id,
        serial: SERIAL.fetch_add(1, Ordering::Relaxed),
        min_height_m: heights.clone().fold(f64::MAX, f64::min),
        max_height_m: heights.fold(f64::MIN, f64::max),
        center_planet_m: center,
        bounding_radius_m: vertices.iter().map(|v| position(v).distance(center)).fold(0.0, f64::max) + 1.0,
        vertices,
    }
}

fn split(id: NodeId, eye: DVec3, radius_m: f64, finest: u8, out: &mut HashSet<NodeId>) {
    let side_m = radius_m * 1.6 / f64::from(1_u32 << id.level);
    let distance = (id.direction(0.5, 0.5) * radius_m).distance(eye);
    if id.level < 3 || (id.level < finest && distance < side_m * 1.9) {
        for child in id.children() {
            split(child, eye, radius_m, finest, out);
        }
    } else {
        out.insert(id);
    }
}

/// Tiles that get finer towards the eye.
pub fn surface(planet: &Arc<Planet>, eye: DVec3, finest: u8, height_m: &dyn Fn(DVec3) -> f64) -> Surface {
    let mut nodes = HashSet::new();
    for root in NodeId::roots() {
        split(root, eye, planet.radius_m(), finest, &mut nodes);
    }
    let mut sorted: Vec<NodeId> = nodes.iter().copied().collect();
    sorted.sort();
    let leaves = sorted
        .into_iter()
        .map(|id| {
            let coarser = |edge: &Edge| {
                let over = id.neighbour(*edge);
                !nodes.contains(&over) && over.parent().is_some_and(|parent| nodes.contains(&parent))
            };
            let coarser_edges = Edge::ALL.into_iter().filter(coarser).map(Edge::bit).sum();
            Leaf { tile: Arc::new(tile(id, planet, height_m)), coarser_edges }
        })
        .collect();
    Surface { terrain: Arc::new(Terrain::new(planet.clone())), leaves, complete: true, stats: BuildStats::default() }
}

/// A planet like the Earth, with everything on.
pub fn earth() -> Planet {
    let mut planet = Planet {
        water: Some(Water::default()),
        atmosphere: Some(Atmosphere::default()),
        clouds: Some(Clouds::default()),
        ..Planet::default()
    };
    let kinds = [
        ('s', [0.42, 0.33, 0.2]),
        ('g', [0.16, 0.17, 0.06]),
        ('f', [0.05, 0.09, 0.03]),
        ('t', [0.20, 0.18, 0.14]),
        ('w', [0.78, 0.8, 0.84]),
    ];
    planet.biomes.palette = kinds.map(|(key, color)| Biome { key, color, variation: 0.3, ..Biome::default() }).to_vec();
    planet.biomes.table = Table::uniform('f', 8, 8);
    let rows = ["ssggffff", "ssggffff", "ssggffff", "sggfffff", "sggfffff", "ttgggfff", "tttttttt", "wwwwwwww"];
    for (row, text) in rows.iter().enumerate() {
        for (column, key) in text.chars().enumerate() {
            planet.biomes.table.set_key(column, row, key);
        }
    }
    planet
}

/// A device on whichever adapter there is.
pub struct Gpu {
    /// The adapter's name and driver, for messages.
    pub adapter: String,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub renderer: Renderer,
}

pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl Gpu {
    pub fn new() -> Self {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .expect("no adapter: install Mesa's lavapipe");
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_limits: Renderer::required_limits(),
            ..wgpu::DeviceDescriptor::default()
        }))
        .expect("a device");
        let renderer = Renderer::new(&device, &queue, FORMAT).unwrap_or_else(|error| panic!("{error}"));
        let info = adapter.get_info();
        Self { adapter: format!("{} ({})", info.name, info.driver_info), device, queue, renderer }
    }

    fn picture(&self, [width, height]: [u32; 2]) -> wgpu::Texture {
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Draws a frame so many times and waits.
    pub fn draw_only(&mut self, frame: &Frame<'_>, times: usize) {
        let texture = self.picture(frame.view.size_px);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        for _ in 0..times {
            self.renderer.render(&self.device, &self.queue, &view, frame);
            self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        }
    }

    /// Draws a frame and reads it back, RGBA.
    pub fn draw(&mut self, frame: &Frame<'_>) -> Vec<u8> {
        let [width, height] = frame.view.size_px;
        let texture = self.picture(frame.view.size_px);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.renderer.render(&self.device, &self.queue, &view, frame);
        let row = (width * 4).next_multiple_of(256);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        let mapped = buffer.slice(..).get_mapped_range().expect("mapped");
        mapped.chunks(row as usize).flat_map(|line| line[..width as usize * 4].to_vec()).collect()
    }
}

/// A camera over a place, `altitude_m` above the ground or the sea.
pub fn camera(planet: &Planet, lat: f64, lon: f64, altitude_m: f64, heading: f64, pitch: f64) -> Camera {
    let place = LatLon::from_degrees(lat, lon);
    let ground = height_m(place.direction()).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let radius_m = planet.radius_m() + ground + altitude_m;
    Camera::over(place, radius_m, heading.to_radians(), pitch.to_radians(), Camera::DEFAULT_FOV_Y_RAD)
}

/// A frame with the sun over a place.
pub fn frame<'a>(surface: &'a Surface, planet: &'a Planet, camera: Camera, sun: (f64, f64)) -> Frame<'a> {
    Frame {
        surface,
        planet,
        view: View { camera, size_px: [320, 180], quality: Quality::Medium },
        sun_dir_planet: LatLon::from_degrees(sun.0, sun.1).direction(),
        time_secs: 0.0,
        exposure_ev: 0.0,
        debug_view: DebugView::Shaded,
    }
}

/// Red, green and blue of each pixel, summed.
pub fn lights(picture: &[u8]) -> Vec<u32> {
    picture.chunks(4).map(|p| u32::from(p[0]) + u32::from(p[1]) + u32::from(p[2])).collect()
}

/// Whether the middle of each pixel of the picture lies well within the planet's disc.
pub fn inside_disc(frame: &Frame<'_>, lowest_m: f64) -> Vec<bool> {
    let [width, height] = frame.view.size_px;
    let eye = frame.view.camera.position_planet_m;
    let radius_m = frame.planet.radius_m() + lowest_m;
    (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let ndc = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
            let dir = frame.view.camera.ray_dir_planet(ndc(x, width), -ndc(y, height), frame.view.aspect());
            let closest = eye - dir * eye.dot(dir);
            eye.dot(dir) < 0.0 && closest.length() < radius_m * 0.999
        })
        .collect()
}
