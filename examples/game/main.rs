//! A game that draws its own things in front of a planet: towers that are lit by the planet's sun and sky, cast shadows
//! on the ground and stand in those of mountains, are hidden by mountains and hazed by the air.
//!
//! ```sh
//! cargo run --example game              # a window; the arrow keys turn the camera
//! cargo run --example game -- OUT.png   # a picture, as without a display
//! ```

#![allow(clippy::print_stdout)]

#[path = "../common/mod.rs"]
mod common;
mod towers;
mod window;

use common::{Failure, open_gpu, picture_path, save_png, view};
use std::sync::Arc;
use tellus::glam::DVec3;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::render::{
    DEPTH_FORMAT, Metering, OpaqueTargets, RADIANCE_FORMAT, RenderError, Renderer, Scene, texture, wgpu,
};
use tellus::sphere::{LatLon, geo};
use tellus::terrain::Terrain;
use tellus::tiles::{Surface, add_detail, build_now};
use towers::{Tower, Towers};

const SIZE_PX: [u32; 2] = [960, 540];
/// Where the camera stands, and its height over the ground.
const PLACE_DEG: (f64, f64) = (30.0, 145.0);
const EYE_HEIGHT_M: f64 = 130.0;
/// The direction of the row of towers, clockwise from north.
const ROW_HEADING_DEG: f64 = 20.0;
/// Where the sun is in the zenith.
const SUN_DEG: (f64, f64) = (10.0, PLACE_DEG.1 - 65.0);

/// The game: a planet, its ground for collision, and the things on it.
pub(crate) struct Game {
    planet: Arc<Planet>,
    terrain: Terrain,
    towers: Towers,
    /// Clockwise from north.
    pub(crate) heading_rad: f64,
}

impl Game {
    fn new(device: &wgpu::Device, renderer: &Renderer) -> Result<Self, Failure> {
        let planet = Arc::new(shipped::default_planet());
        let terrain = Terrain::try_new(Arc::clone(&planet))?;
        let up = LatLon::from_degrees(PLACE_DEG.0, PLACE_DEG.1).direction();
        let (east, north) = geo::east_north(up);
        let heading_rad = ROW_HEADING_DEG.to_radians();
        let ahead = north * heading_rad.cos() + east * heading_rad.sin();
        // Each tower is half as far away again as the one before, and larger: mountains hide some of them.
        let row = (0..11).map(|i| {
            let distance_m = 350.0 * 1.5_f64.powi(i);
            let aside = f64::from(i % 3 - 1) * 0.18 + f64::from(i) * 0.02;
            let dir = up + (ahead + aside * ahead.cross(up)) * (distance_m / planet.radius_m());
            Tower::on_ground(&terrain, dir, 0.02 * distance_m, 0.12 * distance_m).shaded(&terrain, sun_dir_planet())
        });
        let towers = Towers::new(device, renderer, row.collect())?;
        Ok(Self { planet, terrain, towers, heading_rad })
    }

    /// The camera of a frame.
    pub(crate) fn view(&self, size_px: [u32; 2], quality: Quality) -> View {
        let place = LatLon::from_degrees(PLACE_DEG.0, PLACE_DEG.1);
        let radius_m = self.planet.radius_m() + self.terrain.height_m(place.direction()) + EYE_HEIGHT_M;
        let camera = Camera::over(place, radius_m, self.heading_rad, -0.14, Camera::DEFAULT_FOV_Y_RAD);
        View { camera, size_px, quality }
    }

    /// One frame: ground and sea, the game's own things, air over all of it, tone curve.
    pub(crate) fn draw(
        &self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        renderer: &mut Renderer,
        surface: &Surface,
        camera_view: View,
        output: &wgpu::TextureView,
    ) -> Result<(), RenderError> {
        let size_px = camera_view.size_px;
        let mut scene = Scene::of_planet(surface, camera_view, sun_dir_planet());
        let eye_planet_m: DVec3 = camera_view.camera.position_planet_m;
        let towers = self.towers.seen_from(device, eye_planet_m);
        scene.bodies[0].casters.push(&towers);
        scene.post.metering = Metering::Instant;
        let [radiance, depth, composite] = [RADIANCE_FORMAT, DEPTH_FORMAT, RADIANCE_FORMAT]
            .map(|format| view(&texture(device, "game", size_px, format)));
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let frame = renderer.prepare(&mut encoder, &scene, size_px, [0, 0, size_px[0], size_px[1]])?;
        frame.draw_opaque(&mut encoder, &OpaqueTargets::cleared(&radiance, &depth))?;
        towers.draw(&mut encoder, &frame, [&radiance, &depth]);
        frame.draw_air(&mut encoder, &radiance, &depth, &composite)?;
        frame.draw_post(&mut encoder, &composite, output)?;
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

fn sun_dir_planet() -> DVec3 {
    LatLon::from_degrees(SUN_DEG.0, SUN_DEG.1).direction()
}

fn main() -> Result<(), Failure> {
    let has_display = ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some());
    if has_display && std::env::args_os().len() == 1 { window::run() } else { picture() }
}

/// One picture, without a window.
fn picture() -> Result<(), Failure> {
    let (device, queue) = open_gpu()?;
    let mut renderer = Renderer::new(&device, &queue)?;
    let game = Game::new(&device, &renderer)?;
    let camera_view = game.view(SIZE_PX, Quality::Medium);
    let mut surface = build_now(&game.planet, &camera_view)?;
    add_detail(&mut surface, &camera_view);
    let target = texture(&device, "picture", SIZE_PX, wgpu::TextureFormat::Rgba8UnormSrgb);
    game.draw((&device, &queue), &mut renderer, &surface, camera_view, &view(&target))?;
    save_png(&device, &queue, &target, &picture_path("tellus_game.png"))
}
