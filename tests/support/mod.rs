//! For tests of the renderer: a planet, a device, and reading pictures back.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod dice;
pub mod edits;
pub mod layered;
pub mod textures;

use glam::DVec3;
pub use layered::{LAYERED, layered};
use std::path::Path;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Atmosphere, Biome, Clouds, Fbm, Layer, Planet, Shape, Table, Water, shipped};
use tellus::render::{DebugView, FrameStats, Post, RenderError, Renderer, Scene, read_texture, texture};
use tellus::sphere::LatLon;
use tellus::terrain::{MapStore, Revision, Terrain};
use tellus::tiles::{Builder, Surface, add_detail, build_over};

pub const SIZE_PX: [u32; 2] = [320, 180];

/// Tiles for a camera at low quality, without horizon angles and detail textures: these take most of the time.
pub fn surface(planet: &Arc<Planet>, camera: &Camera) -> Surface {
    build_over(&terrain(planet), &View { camera: *camera, size_px: SIZE_PX, quality: Quality::Low })
}

/// The surface for a view, with horizon angles and detail textures.
pub fn surface_of(planet: &Arc<Planet>, view: &View) -> Surface {
    let mut surface = build_over(&terrain(planet), view);
    add_detail(&mut surface, view);
    surface
}

/// File names of [`LAYERED`] and of all shipped presets.
pub fn files() -> Vec<&'static str> {
    std::iter::once(LAYERED).chain(shipped::ALL.iter().map(|shipped| shipped.file)).collect()
}

/// A shipped preset or [`LAYERED`], by its file name.
pub fn preset(file: &str) -> Planet {
    if file == LAYERED {
        return layered();
    }
    let shipped = shipped::ALL.iter().find(|shipped| shipped.file == file);
    shipped.unwrap_or_else(|| panic!("no shipped preset {file}")).load().unwrap()
}

/// The terrain of a planet. The newest ones are kept for all tests of a binary, and solved world maps on disk:
/// structures take seconds to solve.
pub fn terrain(planet: &Arc<Planet>) -> Arc<Terrain> {
    static MAPS: LazyLock<Arc<MapStore>> =
        LazyLock::new(|| Arc::new(MapStore::new(Path::new(env!("CARGO_TARGET_TMPDIR")).join("maps"), 1 << 29)));
    const KEPT: usize = 6;
    static TERRAINS: Mutex<Vec<Arc<Terrain>>> = Mutex::new(Vec::new());
    let mut terrains = TERRAINS.lock().unwrap_or_else(PoisonError::into_inner);
    let known = terrains.iter().position(|terrain| terrain.planet() == planet).map(|at| terrains.remove(at));
    let terrain = known.unwrap_or_else(|| {
        let solved = Terrain::load(planet.clone(), Some(MAPS.clone()), &|_| true);
        Arc::new(solved.unwrap().expect("nobody stops the solvers"))
    });
    terrains.insert(0, terrain.clone());
    terrains.truncate(KEPT);
    terrain
}

/// The surface for a view, after the builder has finished.
pub fn settled(builder: &Builder, planet: &Arc<Planet>, view: &View) -> Arc<Surface> {
    builder.request(planet, view).unwrap();
    while builder.is_busy() {
        std::thread::sleep(Duration::from_millis(1));
    }
    builder.surface().expect("a surface")
}

/// A planet like the Earth, with sea, atmosphere and clouds.
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

/// A device on the default adapter, with a renderer.
pub struct Gpu {
    /// The adapter's name and driver, for messages.
    pub adapter: String,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub renderer: Renderer,
    /// Post-processing for all scenes; the exposure is each scene's own.
    pub post: Post,
}

pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The device that all tests of a binary share, with the default post-processing. On a software driver the pipelines of
/// a renderer take seconds to compile, longer than most pictures.
pub fn gpu() -> MutexGuard<'static, Gpu> {
    static GPU: LazyLock<Mutex<Gpu>> = LazyLock::new(|| Mutex::new(Gpu::new()));
    let mut gpu = GPU.lock().unwrap_or_else(PoisonError::into_inner);
    gpu.post = Post::default();
    gpu
}

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
        let renderer = Renderer::new(&device, &queue).unwrap_or_else(|error| panic!("{error}"));
        let info = adapter.get_info();
        let adapter = format!("{} ({})", info.name, info.driver_info);
        Self { adapter, device, queue, renderer, post: Post::default() }
    }

    pub fn texture(&self, size_px: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
        texture(&self.device, "picture", size_px, format)
    }

    fn render(&mut self, scene: &Scene<'_>, texture: &wgpu::Texture) -> Result<FrameStats, RenderError> {
        let mut scene = scene.clone();
        let exposure_ev = scene.post.exposure_ev;
        scene.post = self.post;
        scene.post.exposure_ev = exposure_ev;
        self.renderer.render(&texture.create_view(&wgpu::TextureViewDescriptor::default()), &scene)
    }

    /// Draws a scene several times and waits.
    pub fn draw_only(&mut self, scene: &Scene<'_>, times: usize) {
        let texture = self.texture(scene.size_px, FORMAT);
        for _ in 0..times {
            self.render(scene, &texture).unwrap();
            self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        }
    }

    /// Draws a scene into a target of any size.
    pub fn draw_into(&mut self, scene: &Scene<'_>, target_px: [u32; 2]) -> Result<FrameStats, RenderError> {
        let texture = self.texture(target_px, FORMAT);
        self.render(scene, &texture)
    }

    /// Draws a scene and reads its radiance back, before the tone curve.
    pub fn radiance(&mut self, scene: &Scene<'_>) -> Vec<[f32; 3]> {
        self.draw_only(scene, 1);
        self.renderer.radiance().unwrap().1
    }

    /// Draws a scene and reads it back, RGBA.
    pub fn draw(&mut self, scene: &Scene<'_>) -> Vec<u8> {
        let texture = self.texture(scene.size_px, FORMAT);
        self.render(scene, &texture).unwrap();
        read_texture(&self.device, &self.queue, &texture).unwrap()
    }
}

/// A camera above a location, `altitude_m` above the ground or the sea; angles in degrees.
pub fn camera(planet: &Planet, lat: f64, lon: f64, altitude_m: f64, heading: f64, pitch: f64) -> Camera {
    let terrain = terrain(&Arc::new(planet.clone()));
    let (place, angles) = (LatLon::from_degrees(lat, lon), [heading, pitch].map(f64::to_radians));
    camera_over(&terrain, place, altitude_m, angles)
}

/// The same for a compiled terrain; heading and pitch in radians.
pub fn camera_over(terrain: &Terrain, place: LatLon, altitude_m: f64, [heading, pitch]: [f64; 2]) -> Camera {
    let planet = terrain.planet();
    let surface_m = terrain.height_m(place.direction()).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let radius_m = planet.radius_m() + surface_m + altitude_m;
    Camera::over(place, radius_m, heading, pitch, Camera::DEFAULT_FOV_Y_RAD)
}

/// A scene with the sun overhead at a location (degrees).
pub fn frame<'a>(surface: &'a Surface, planet: &Planet, camera: Camera, sun: (f64, f64)) -> Scene<'a> {
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
    frame_of(surface, planet, view, LatLon::from_degrees(sun.0, sun.1).direction())
}

/// A scene of a view.
pub fn frame_of<'a>(surface: &'a Surface, planet: &Planet, view: View, sun_dir_planet: DVec3) -> Scene<'a> {
    let revision = Revision::try_new(Arc::new(planet.clone())).unwrap();
    Scene::of_revision(revision, surface, view, sun_dir_planet)
}

/// A scene that shows a debug view.
pub fn debug(mut scene: Scene<'_>, debug_view: DebugView) -> Scene<'_> {
    scene.debug_view = debug_view;
    scene
}

/// The view of a scene's one body.
pub fn view_of(scene: &Scene<'_>) -> View {
    scene.view_of(scene.bodies[0].position_m, scene.bodies[0].scene_from_body)
}

/// The sum of red, green and blue for each pixel.
pub fn lights(picture: &[u8]) -> Vec<u32> {
    picture.chunks(4).map(|p| u32::from(p[0]) + u32::from(p[1]) + u32::from(p[2])).collect()
}

/// Direction through the middle of each pixel, in the frame of the first body.
pub fn rays(scene: &Scene<'_>) -> Vec<DVec3> {
    let view = view_of(scene);
    let [width, height] = scene.size_px;
    let ndc = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
    (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| view.camera.ray_dir_planet(ndc(x, width), -ndc(y, height), view.aspect()))
        .collect()
}

/// For each pixel, whether its centre lies well inside the planet's disc.
pub fn inside_disc(frame: &Scene<'_>, lowest_m: f64) -> Vec<bool> {
    let eye = view_of(frame).camera.position_planet_m;
    let radius_m = frame.bodies[0].planet().radius_m() + lowest_m;
    let is_inside = |dir: DVec3| {
        let closest = eye - dir * eye.dot(dir);
        eye.dot(dir) < 0.0 && closest.length() < radius_m * 0.999
    };
    rays(frame).into_iter().map(is_inside).collect()
}
