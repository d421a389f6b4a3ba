//! A planet to draw in tests, a device to draw it on, and how to read the picture.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod dice;
pub mod edits;

use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Atmosphere, Biome, Clouds, Fbm, Layer, Planet, Shape, Table, Water};
use tellus::render::{DebugView, Frame, FrameStats, RenderError, Renderer};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::tiles::{Builder, Surface, add_detail, build_now};

pub const SIZE_PX: [u32; 2] = [320, 180];

/// The surface that a camera sees, coarse.
pub fn surface(planet: &Arc<Planet>, camera: &Camera) -> Surface {
    surface_of(planet, &View { camera: *camera, size_px: SIZE_PX, quality: Quality::Low })
}

/// The surface that a view sees, with all its detail.
pub fn surface_of(planet: &Arc<Planet>, view: &View) -> Surface {
    let mut surface = build_now(planet, view).unwrap();
    add_detail(&mut surface, view);
    surface
}

/// The surface of a view once a builder has made everything.
pub fn settled(builder: &Builder, planet: &Arc<Planet>, view: &View) -> Arc<Surface> {
    builder.request(planet, view);
    while builder.is_busy() {
        std::thread::sleep(Duration::from_millis(1));
    }
    builder.surface().expect("a surface")
}

/// A planet like the Earth, with everything on.
pub fn earth() -> Planet {
    let layer = |name: &str, wavelength_km, octaves, amplitude_m| Layer {
        name: name.to_owned(),
        amplitude_m,
        shape: Shape::Fbm(Fbm { wavelength_km, octaves, ..Fbm::default() }),
        ..Layer::default()
    };
    let mut planet = Planet {
        layers: vec![layer("Continents", 6000.0, 8, 4000.0), layer("Hills", 60.0, 10, 500.0)],
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
            self.renderer.render(&self.device, &self.queue, &view, frame).unwrap();
            self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        }
    }

    /// Draws a frame into a target of any size.
    pub fn draw_into(&mut self, frame: &Frame<'_>, target_px: [u32; 2]) -> Result<FrameStats, RenderError> {
        let view = self.picture(target_px).create_view(&wgpu::TextureViewDescriptor::default());
        self.renderer.render(&self.device, &self.queue, &view, frame)
    }

    /// Draws a frame and reads it back, RGBA.
    pub fn draw(&mut self, frame: &Frame<'_>) -> Vec<u8> {
        let [width, height] = frame.view.size_px;
        let texture = self.picture(frame.view.size_px);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.renderer.render(&self.device, &self.queue, &view, frame).unwrap();
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

/// A camera over a place, `altitude_m` above the ground or the sea; angles in degrees.
pub fn camera(planet: &Planet, lat: f64, lon: f64, altitude_m: f64, heading: f64, pitch: f64) -> Camera {
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let (place, angles) = (LatLon::from_degrees(lat, lon), [heading, pitch].map(f64::to_radians));
    camera_over(&terrain, place, altitude_m, angles)
}

/// The same of a terrain that is there already; heading and pitch in radians.
pub fn camera_over(terrain: &Terrain, place: LatLon, altitude_m: f64, [heading, pitch]: [f64; 2]) -> Camera {
    let planet = terrain.planet();
    let surface_m = terrain.height_m(place.direction()).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let radius_m = planet.radius_m() + surface_m + altitude_m;
    Camera::over(place, radius_m, heading, pitch, Camera::DEFAULT_FOV_Y_RAD)
}

/// A frame with the sun over a place.
pub fn frame<'a>(surface: &'a Surface, planet: &'a Planet, camera: Camera, sun: (f64, f64)) -> Frame<'a> {
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
    frame_of(surface, planet, view, LatLon::from_degrees(sun.0, sun.1).direction())
}

/// A frame of a view.
pub fn frame_of<'a>(surface: &'a Surface, planet: &'a Planet, view: View, sun_dir_planet: DVec3) -> Frame<'a> {
    Frame {
        surface,
        planet,
        view,
        frozen: None,
        sun_dir_planet,
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
