//! A lander flies from orbit to the ground: gravity and an autopilot in 64 bits, legs that touch the very heights that
//! are drawn, the lander's own mesh in the planet's air, a preset that changes while it flies, a walk on the ground.
//!
//! ```sh
//! cargo run --release --example lander             # pictures in the folder for temporary files
//! cargo run --release --example lander -- OUT.png  # the last picture here, the others beside it
//! ```

#![allow(clippy::print_stdout)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../game/towers.rs"]
mod towers;

use common::{Failure, open_gpu, picture_path, save_png, view};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tellus::glam::DVec3;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::Planet;
use tellus::planet::watch::PresetWatch;
use tellus::render::{DEPTH_FORMAT, Metering, OpaqueTargets, RADIANCE_FORMAT, Renderer, Scene, texture, wgpu};
use tellus::sphere::{LatLon, Tangent};
use tellus::terrain::{GroundPatch, Scratch, Terrain, Walker, WalkerBody};
use tellus::tiles::{add_detail, build_now};
use towers::{Tower, Towers};

const PRESET: &str = "planets/cinnabar.ron";
const SITE_DEG: (f64, f64) = (4.0, -61.0);
const SIZE_PX: [u32; 2] = [640, 360];

const GRAVITY_M_S2: f64 = 3.7;
const THRUST_M_S2: f64 = 25.0;
const START_ALTITUDE_M: f64 = 60_000.0;
const STEP_S: f64 = 0.1;
/// A landing faster than this breaks the legs.
const SOFTEST_M_S: f64 = 3.0;
/// The feet lie on a circle around the middle.
const FEET: usize = 4;
const FEET_RADIUS_M: f64 = 4.0;
const HEIGHT_M: f64 = 9.0;
/// Altitude at which the preset changes.
const CHANGE_ALTITUDE_M: f64 = 20_000.0;

/// The lander: its foot, in the planet frame.
struct Lander {
    position_m: DVec3,
    velocity_m_s: DVec3,
    fuel_m_s: f64,
}

impl Lander {
    /// In orbit, on the way to the site.
    fn in_orbit(planet: &Planet) -> Self {
        let site = Tangent::at(LatLon::from_degrees(SITE_DEG.0, SITE_DEG.1));
        let radius_m = planet.radius_m() + START_ALTITUDE_M;
        let speed_m_s = (GRAVITY_M_S2 * radius_m).sqrt();
        // Braking takes this much of the way.
        let ahead_rad = 0.5 * speed_m_s * speed_m_s / THRUST_M_S2 / radius_m;
        let up = site.direction(-ahead_rad, 0.0);
        Self { position_m: up * radius_m, velocity_m_s: Tangent::new(up).east_planet * speed_m_s, fuel_m_s: 0.0 }
    }

    fn up(&self) -> DVec3 {
        self.position_m.normalize()
    }

    /// Least height of a foot above the ground.
    fn clearance_m(&self, terrain: &Terrain, scratch: &mut Scratch) -> Result<f64, Failure> {
        let around = Tangent::new(self.up());
        let feet: [DVec3; FEET] = std::array::from_fn(|i| {
            let (sin, cos) = (i as f64 / FEET as f64 * std::f64::consts::TAU).sin_cos();
            self.position_m + (around.east_planet * cos + around.north_planet * sin) * FEET_RADIUS_M
        });
        let mut heights_m = [0.0; FEET];
        terrain.heights_into(&feet, &mut heights_m, scratch)?;
        let clearances = feet
            .iter()
            .zip(heights_m)
            .map(|(foot_m, height_m)| foot_m.length() - terrain.planet().radius_m() - height_m);
        Ok(clearances.fold(f64::MAX, f64::min))
    }

    /// One step: the autopilot kills the speed over ground and sinks ever slower.
    fn fly(&mut self, clearance_m: f64) {
        let up = self.up();
        let sink_m_s = (0.8 * (THRUST_M_S2 - GRAVITY_M_S2) * clearance_m.max(0.0)).sqrt().min(600.0) * 0.5 + 0.5;
        let wanted_m_s2 = (-up * sink_m_s - self.velocity_m_s) * 3.0 + up * GRAVITY_M_S2;
        let thrust_m_s2 = wanted_m_s2.clamp_length_max(THRUST_M_S2);
        self.fuel_m_s += thrust_m_s2.length() * STEP_S;
        self.velocity_m_s += (thrust_m_s2 - up * GRAVITY_M_S2) * STEP_S;
        self.position_m += self.velocity_m_s * STEP_S;
    }
}

fn main() -> Result<(), Failure> {
    // A copy of the preset, so that the flight may change it.
    let folder = std::env::temp_dir().join(format!("tellus-lander-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let flown = fly(&folder.join("planet.ron"));
    std::fs::remove_dir_all(&folder)?;
    flown
}

fn fly(preset: &Path) -> Result<(), Failure> {
    Planet::load(PRESET)?.save(preset)?;
    let mut watch = PresetWatch::every(preset, Duration::ZERO);
    let mut terrain = Arc::new(Terrain::try_new(Planet::load(preset)?.into())?);
    let mut lander = Lander::in_orbit(terrain.planet());
    let mut scratch = Scratch::default();
    let mut camera = Pictures::new(&picture_path("tellus_lander.png"))?;
    camera.take("orbit", &terrain, &lander)?;

    let (mut seconds, mut reloads, mut is_changed) = (0.0, 0, false);
    loop {
        let clearance_m = lander.clearance_m(&terrain, &mut scratch)?;
        if clearance_m <= 0.0 {
            break;
        }
        if clearance_m < CHANGE_ALTITUDE_M && !is_changed {
            // An artist saves another version. (Here the game itself does, so that the flight is always the same.)
            camera.take("descent", &terrain, &lander)?;
            let mut planet = Planet::load(preset)?;
            planet.layers.iter_mut().for_each(|layer| layer.amplitude_m *= 1.25);
            planet.save(preset)?;
            is_changed = true;
        }
        match watch.poll() {
            Some(Ok(planet)) => {
                // What has not changed stays: of a planet with a structure that is most of the work.
                terrain = Arc::new(Terrain::builder(planet.into()).reuse(&terrain).build()?);
                reloads += 1;
                let rise_m = clearance_m - lander.clearance_m(&terrain, &mut scratch)?;
                println!("{seconds:.0} s: the preset has changed; the ground here has moved by {rise_m:+.0} m");
            }
            Some(Err(error)) => println!("{error}"),
            None => {}
        }
        lander.fly(clearance_m);
        seconds += STEP_S;
        if seconds > 3600.0 {
            return Err("the lander did not come down".into());
        }
    }
    let speed_m_s = lander.velocity_m_s.length();
    let (lat, lon) = LatLon::from_direction(lander.position_m).to_degrees();
    println!(
        "{seconds:.0} s: touched down at {lat:.3}, {lon:.3} with {speed_m_s:.1} m/s; {:.0} m/s of fuel",
        lander.fuel_m_s
    );
    camera.take("ground", &terrain, &lander)?;
    if speed_m_s > SOFTEST_M_S {
        return Err("the lander broke".into());
    }
    let walked_m = walk_around(&terrain, &lander);
    println!("an astronaut walked {walked_m:.0} m around the lander");
    if reloads != 1 {
        return Err(format!("the preset changed once and was reloaded {reloads} times").into());
    }
    Ok(())
}

/// An astronaut walks around the lander for a minute, sixty steps a second, over whatever ground is there: how far.
fn walk_around(terrain: &Arc<Terrain>, lander: &Lander) -> f64 {
    let mut patch = GroundPatch::new(Arc::clone(terrain));
    let body = WalkerBody { gravity_m_s2: GRAVITY_M_S2, ..WalkerBody::default() };
    let start = lander.position_m + Tangent::new(lander.up()).east_planet * (2.0 * FEET_RADIUS_M);
    let mut walker = Walker::on_ground(body, &mut patch, start);
    let mut walked_m = 0.0;
    for _ in 0..3600 {
        let before_m = walker.feet_planet_m();
        let outward = (before_m - lander.position_m).normalize_or(DVec3::X);
        walker.step(&mut patch, lander.up().cross(outward) * 1.2, 1.0 / 60.0);
        walked_m += walker.feet_planet_m().distance(before_m);
    }
    walked_m
}

/// Takes pictures of the lander.
struct Pictures {
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
    path: PathBuf,
}

impl Pictures {
    fn new(path: &Path) -> Result<Self, Failure> {
        let (device, queue) = open_gpu()?;
        let renderer = Renderer::new(&device, &queue)?;
        Ok(Self { device, queue, renderer, path: path.to_owned() })
    }

    /// The lander with the planet behind it: `NAME-WHEN.png`, or the name itself on the ground.
    fn take(&mut self, when: &str, terrain: &Terrain, lander: &Lander) -> Result<(), Failure> {
        let around = Tangent::new(lander.up());
        // From the south, a little above; over the ground, wherever that is.
        let mut eye_m = lander.position_m + around.planet(DVec3::new(10.0, -38.0, 9.0));
        let least_m = terrain.planet().radius_m() + terrain.height_m(eye_m) + 2.0;
        eye_m *= (least_m / eye_m.length()).max(1.0);
        let ahead = lander.position_m + lander.up() * HEIGHT_M * 0.7 - eye_m;
        let camera = Camera::looking(eye_m, ahead, lander.up(), Camera::DEFAULT_FOV_Y_RAD);
        let camera_view = View { camera, size_px: SIZE_PX, quality: Quality::Low };
        let mut surface = build_now(terrain.planet(), &camera_view)?;
        add_detail(&mut surface, &camera_view);
        let sun_dir_planet = LatLon::from_degrees(SITE_DEG.0 - 25.0, SITE_DEG.1 - 40.0).direction();
        let mut scene = Scene::of_planet(&surface, camera_view, sun_dir_planet);
        scene.post.metering = Metering::Instant;
        // From orbit the renderer's own near plane lies behind the lander.
        scene.projection.near_m = Some(1.0);
        let lander = Tower::at(lander.position_m, FEET_RADIUS_M, HEIGHT_M).shaded(terrain, sun_dir_planet);
        let mesh = Towers::new(&self.device, &self.renderer, vec![lander])?;
        let seen = mesh.seen_from(&self.device, eye_m);
        scene.bodies[0].casters.push(&seen);
        let target = texture(&self.device, "picture", SIZE_PX, wgpu::TextureFormat::Rgba8UnormSrgb);
        let [radiance, depth, composite] = [RADIANCE_FORMAT, DEPTH_FORMAT, RADIANCE_FORMAT]
            .map(|format| view(&texture(&self.device, "lander", SIZE_PX, format)));
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let [width, height] = SIZE_PX;
        let frame = self.renderer.prepare(&mut encoder, &scene, SIZE_PX, [0, 0, width, height])?;
        frame.draw_opaque(&mut encoder, &OpaqueTargets::cleared(&radiance, &depth))?;
        seen.draw(&mut encoder, &frame, [&radiance, &depth]);
        frame.draw_air(&mut encoder, &radiance, &depth, &composite)?;
        frame.draw_post(&mut encoder, &composite, &view(&target))?;
        self.queue.submit([encoder.finish()]);
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = if when == "ground" { stem } else { format!("{stem}-{when}") };
        save_png(&self.device, &self.queue, &target, &self.path.with_file_name(name + ".png"))
    }
}
