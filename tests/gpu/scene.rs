//! Scenes and stages: several bodies in one picture, targets and passes of the caller, any projection and viewport.

use crate::support::{Gpu, LAYERED, camera, earth, frame, frame_of, gpu, lights, preset, surface, surface_of, view_of};
use glam::{DQuat, DVec3};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::Planet;
use tellus::render::{
    Body, BodyId, DEPTH_FORMAT, OpaqueTargets, Projection, RADIANCE_FORMAT, RenderError, Scene, Sun, ViewId,
    read_texture,
};
use tellus::sphere::LatLon;
use tellus::tiles::{Surface, build_now};

const SIZE_PX: [u32; 2] = [192, 108];

/// Two planets as the camera sees them: the near one in front of a part of the far one.
struct Pair {
    planets: [Arc<Planet>; 2],
    surfaces: [Surface; 2],
    positions_m: [DVec3; 2],
}

impl Pair {
    fn new() -> Self {
        let planets = ["cinnabar.ron", LAYERED].map(|file| Arc::new(preset(file)));
        let positions_m = [DVec3::new(-0.7, 0.0, -4.0), DVec3::new(0.5, 0.0, -6.0)];
        let positions_m = [positions_m[0] * planets[0].radius_m(), positions_m[1] * planets[1].radius_m()];
        let empty = scene();
        let surfaces = [0, 1].map(|i| build_now(&planets[i], &empty.view_of(positions_m[i], DQuat::IDENTITY)).unwrap());
        Self { planets, surfaces, positions_m }
    }

    fn body(&self, i: usize) -> Body<'_> {
        Body::new(BodyId(i as u32), &self.surfaces[i], self.positions_m[i])
    }

    /// The scene with some of the bodies, in this order.
    fn scene(&self, bodies: &[usize]) -> Scene<'_> {
        let mut scene = scene();
        scene.suns.push(Sun::new(&self.planets[1].star, DVec3::new(-0.6, 0.3, 0.7)));
        scene.bodies = bodies.iter().map(|&i| self.body(i)).collect();
        // One near plane for all pictures.
        scene.projection.near_m = Some(1000.0);
        scene
    }
}

fn scene() -> Scene<'static> {
    let aspect = f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]);
    Scene::new(DQuat::IDENTITY, Projection::symmetric(0.7, aspect), SIZE_PX, Quality::Medium)
}

/// For each pixel, distance of its ray from the centre of a body, in radii.
fn radii_from_center(pair: &Pair, i: usize) -> Vec<f64> {
    let scene = pair.scene(&[i]);
    let (position_m, radius_m) = (pair.positions_m[i], pair.planets[i].radius_m());
    let [left, right, bottom, top] = scene.projection.tangents;
    let [width, height] = SIZE_PX.map(f64::from);
    let ray = |x: u32, y: u32| {
        let (u, v) = ((f64::from(x) + 0.5) / width, (f64::from(y) + 0.5) / height);
        DVec3::new(left + u * (right - left), top + v * (bottom - top), -1.0).normalize()
    };
    let pixels = (0..SIZE_PX[1]).flat_map(|y| (0..SIZE_PX[0]).map(move |x| (x, y)));
    pixels.map(|(x, y)| position_m.reject_from(ray(x, y)).length() / radius_m).collect()
}

fn difference(a: &[u8], b: &[u8]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

/// Each planet is drawn as if it were alone where it is the only one, and the near one hides the far one.
#[test]
fn one_planet_stands_before_another() {
    let (pair, mut gpu) = (Pair::new(), gpu());
    gpu.post.smooth_edges = false;
    let mut draw = |bodies: &[usize]| {
        gpu.draw_only(&pair.scene(bodies), 1);
        gpu.renderer.radiance().unwrap().1
    };
    let [both, swapped, near, far] = [&[0, 1][..], &[1, 0], &[0], &[1]].map(&mut draw);
    assert!(both == swapped, "the order of the list shows");
    let (from_near, from_far) = (radii_from_center(&pair, 0), radii_from_center(&pair, 1));
    let (mut hidden, mut alone, mut through_air) = (0, 0, 0);
    for (i, (near_r, far_r)) in from_near.iter().zip(&from_far).enumerate() {
        let is_as = |alone: &[[f32; 3]]| {
            let apart = |channel: usize| (both[i][channel] - alone[i][channel]).abs();
            (0..3).all(|channel| apart(channel) <= 0.01 * alone[i][channel] + 1e-4)
        };
        if *near_r < 0.97 {
            hidden += usize::from(*far_r < 0.97);
            assert!(is_as(&near), "pixel {i}: the near planet is {:?}, alone {:?}", both[i], near[i]);
        } else if *near_r > 1.15 {
            alone += usize::from(*far_r < 0.97);
            assert!(is_as(&far), "pixel {i}: the far planet is {:?}, alone {:?}", both[i], far[i]);
        } else if *near_r > 1.005 && *near_r < 1.03 && *far_r < 0.9 {
            through_air += 1;
        }
    }
    assert!(
        hidden > 300 && alone > 600 && through_air > 20,
        "{hidden} hidden, {alone} alone, {through_air} behind air"
    );
}

/// A scene is lit by all of its suns.
#[test]
fn two_suns_light_as_one_that_is_twice_as_bright() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    let camera = camera(&planet, 10.0, 10.0, 2e5, 40.0, -60.0);
    let surface = surface(&planet, &camera);
    let mut scene = frame(&surface, &planet, camera, (20.0, 20.0));
    let mut bright = scene.clone();
    bright.suns[0].brightness = 0.5;
    scene.suns[0].brightness = 0.25;
    let second = scene.suns[0];
    scene.suns.push(second);
    gpu.draw_only(&bright, 1);
    let (_, one) = gpu.renderer.radiance().unwrap();
    gpu.draw_only(&scene, 1);
    let (_, two) = gpu.renderer.radiance().unwrap();
    for (i, (one, two)) in one.iter().zip(&two).enumerate() {
        let apart = (one[1] - two[1]).abs() / one[1].max(1e-3);
        assert!(apart < 0.02, "pixel {i}: {one:?} under one sun, {two:?} under two");
    }
    scene.suns = vec![second; 5];
    assert!(matches!(gpu.draw_into(&scene, scene.size_px), Err(RenderError::TooManySuns(5))));
}

/// Radiance of stage by stage drawing in a viewport of the caller's targets.
pub(super) struct Stages {
    radiance: wgpu::Texture,
    depth: wgpu::Texture,
    composite: wgpu::Texture,
    output: wgpu::Texture,
}

impl Stages {
    pub(super) fn new(gpu: &Gpu, size_px: [u32; 2]) -> Self {
        let texture = |format| gpu.texture(size_px, format);
        let [radiance, composite] = [texture(RADIANCE_FORMAT), texture(RADIANCE_FORMAT)];
        Self { radiance, depth: texture(DEPTH_FORMAT), composite, output: texture(wgpu::TextureFormat::Rgba8UnormSrgb) }
    }

    pub(super) fn draw(
        &self,
        gpu: &mut Gpu,
        scene: &Scene<'_>,
        viewport_px: [u32; 4],
        load: bool,
    ) -> Result<(), RenderError> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let [radiance, depth, composite, output] =
            [&self.radiance, &self.depth, &self.composite, &self.output].map(view);
        let size_px = [self.depth.width(), self.depth.height()];
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let frame = gpu.renderer.prepare(&mut encoder, scene, size_px, viewport_px)?;
        let opaque = match load {
            true => OpaqueTargets::loaded(&radiance, &depth),
            false => OpaqueTargets::cleared(&radiance, &depth),
        };
        frame.draw_opaque(&mut encoder, &opaque)?;
        frame.draw_air(&mut encoder, &radiance, &depth, &composite)?;
        frame.draw_post(&mut encoder, &composite, &output)?;
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    fn picture(&self, gpu: &Gpu) -> Vec<u8> {
        read_texture(&gpu.device, &gpu.queue, &self.output).unwrap()
    }

    /// Depths, row by row.
    pub(super) fn depths(&self, gpu: &Gpu) -> Vec<f32> {
        let bytes = read_texture(&gpu.device, &gpu.queue, &self.depth).unwrap();
        bytes.chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
    }
}

/// The rows of a rectangle of a picture.
fn cut(picture: &[u8], wide: u32, [x, y, width, height]: [u32; 4]) -> Vec<u8> {
    let row = |row: u32| &picture[4 * (row * wide + x) as usize..][..4 * width as usize];
    (y..y + height).flat_map(row).copied().collect()
}

/// The stages give the picture that `render` gives, in any rectangle of the targets, and leave the rest of them alone.
#[test]
fn a_viewport_is_a_picture_in_a_larger_one() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    let camera = camera(&planet, 10.0, 10.0, 3e5, 40.0, -20.0);
    let view = View { camera, size_px: [96, 54], quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let mut scene = frame_of(&surface, &planet, view, LatLon::from_degrees(20.0, 20.0).direction());
    scene.post.smooth_edges = false;
    gpu.post = scene.post;
    let whole = gpu.draw(&scene);
    let stages = Stages::new(&gpu, [224, 128]);
    let rectangles = [[0, 0, 96, 54], [120, 60, 96, 54]];
    for (number, rectangle) in rectangles.into_iter().enumerate() {
        scene.view_id = ViewId(number as u32);
        stages.draw(&mut gpu, &scene, rectangle, number > 0).unwrap();
    }
    let picture = stages.picture(&gpu);
    for rectangle in rectangles {
        let apart = difference(&cut(&picture, 224, rectangle), &whole);
        assert!(apart <= 2, "{rectangle:?}: {apart} apart");
    }
    let between = cut(&picture, 224, [97, 0, 22, 128]);
    assert!(lights(&between).iter().all(|light| *light == 0), "outside of both");
    for viewport_px in [[0, 0, 0, 54], [200, 0, 96, 54], [0, u32::MAX, 96, 54]] {
        let error = stages.draw(&mut gpu, &scene, viewport_px, false);
        assert!(matches!(error, Err(RenderError::Viewport { .. })), "{viewport_px:?}: {error:?}");
    }
}

/// An off-axis projection of a half of the picture draws that half.
#[test]
fn half_a_frustum_is_half_the_picture() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    gpu.post.smooth_edges = false;
    let camera = camera(&planet, 10.0, 10.0, 3e5, 40.0, -20.0);
    let view = View { camera, size_px: [160, 90], quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let whole = frame_of(&surface, &planet, view, LatLon::from_degrees(20.0, 20.0).direction());
    let mut half = whole.clone();
    half.size_px[0] /= 2;
    half.projection.tangents[0] = 0.0;
    half.projection.near_m = Some(whole.matrices().near_m);
    assert!(view_of(&half).aspect() < view.aspect(), "the tiles' view covers the half");
    let (whole, half) = (gpu.draw(&whole), gpu.draw(&half));
    let right = cut(&whole, 160, [80, 0, 80, 90]);
    let apart = right.iter().zip(&half).filter(|(a, b)| a.abs_diff(**b) > 3).count();
    assert!(apart < right.len() / 100, "{apart} of {} differ", right.len());
}

/// Depth is near plane over distance along the view axis, of ground and sea; what the caller drew before and is nearer
/// stays.
#[test]
fn depth_is_of_ground_and_sea_and_nearer_things_stay() {
    // A sea without land, seen from above.
    let planet = Arc::new(Planet { layers: Vec::new(), atmosphere: None, clouds: None, ..earth() });
    let sea_m = planet.sea_level_m().unwrap();
    let mut gpu = gpu();
    let mut ocean = Planet::clone(&planet);
    ocean.water.as_mut().unwrap().level_m = sea_m + 500.0;
    let ocean = Arc::new(ocean);
    let camera = camera(&ocean, 0.0, 0.0, 10_000.0, 0.0, -90.0);
    let view = View { camera, size_px: [32, 18], quality: Quality::Medium };
    let surface = surface_of(&ocean, &view);
    let scene = frame_of(&surface, &ocean, view, DVec3::X);
    let stages = Stages::new(&gpu, view.size_px);
    stages.draw(&mut gpu, &scene, [0, 0, 32, 18], false).unwrap();
    let middle = stages.depths(&gpu)[9 * 32 + 16];
    let distance_m = scene.matrices().near_m / f64::from(middle);
    assert!((distance_m - 10_000.0).abs() < 20.0, "the sea is {distance_m} m away");

    // Something nearer than the sea fills the targets.
    let nearer = wgpu::Color { r: 0.5, g: 0.25, b: 0.125, a: 0.0 };
    let near_depth = (scene.matrices().near_m / 5000.0) as f32;
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let views = [&stages.radiance, &stages.depth].map(|t| t.create_view(&wgpu::TextureViewDescriptor::default()));
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &views[0],
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(nearer), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &views[1],
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(near_depth), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    gpu.queue.submit([encoder.finish()]);
    stages.draw(&mut gpu, &scene, [0, 0, 32, 18], true).unwrap();
    assert!(stages.depths(&gpu).iter().all(|depth| *depth == near_depth), "the sea is behind");
    let bytes = read_texture(&gpu.device, &gpu.queue, &stages.composite).unwrap();
    let green = half::f16::from_le_bytes([bytes[2], bytes[3]]).to_f32();
    assert!((green - 0.25).abs() < 1e-3, "the radiance of the nearer thing became {green}");
}

/// Targets that do not fit are told by name.
#[test]
fn targets_that_do_not_fit_are_refused() {
    let planet = Arc::new(earth());
    let mut gpu = gpu();
    let camera = camera(&planet, 0.0, 0.0, 1e6, 0.0, -90.0);
    let surface = surface(&planet, &camera);
    let scene = frame(&surface, &planet, camera, (0.0, 0.0));
    let right = Stages::new(&gpu, scene.size_px);
    let viewport_px = [0, 0, scene.size_px[0], scene.size_px[1]];
    let wrong = Stages { depth: gpu.texture(scene.size_px, wgpu::TextureFormat::Depth24Plus), ..right };
    let error = wrong.draw(&mut gpu, &scene, viewport_px, false).unwrap_err();
    assert!(matches!(error, RenderError::TargetFormat { name: "depth target", .. }), "{error}");
    let wrong = Stages { radiance: gpu.texture([8, 8], RADIANCE_FORMAT), ..Stages::new(&gpu, scene.size_px) };
    let error = wrong.draw(&mut gpu, &scene, viewport_px, false).unwrap_err();
    assert!(matches!(error, RenderError::TargetSize { name: "radiance target", .. }), "{error}");
    let mut twice = scene.clone();
    twice.bodies.push(twice.bodies[0].clone());
    assert!(matches!(gpu.draw_into(&twice, twice.size_px), Err(RenderError::BodyTwice(0))));
}
