//! Things of a game in the maps of shadows: what they shade, and what shades them.

use crate::support::{Gpu, frame_of, gpu, rays, surface_of};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::life::{ReadyPopulation, Stone};
use tellus::planet::{Biome, Form, Planet, Population, Table, Water};
use tellus::render::{
    BodyId, DEPTH_FORMAT, OpaqueTargets, RADIANCE_FORMAT, Scene, ShadowCaster, ShadowView, air_wgsl, caster_wgsl,
    read_texture,
};
use tellus::sphere::{LatLon, Tangent};
use tellus::tiles::Surface;
use wgpu::util::DeviceExt as _;

const SIZE_PX: [u32; 2] = [240, 135];
const RADIUS_M: f64 = 500_000.0;
const PLACE: (f64, f64) = (10.0, 20.0);

/// A bare, even, grey sphere.
fn planet() -> Planet {
    let mut planet = Planet { radius_km: RADIUS_M * 1e-3, ..Planet::default() };
    planet.biomes.palette = vec![Biome { color: [0.3; 3], variation: 0.0, ..Biome::default() }];
    planet.biomes.table = Table::uniform('a', 2, 2);
    (planet.biomes.snow, planet.biomes.beach_m) = (false, 0.0);
    planet
}

fn around() -> Tangent {
    Tangent::at(LatLon::from_degrees(PLACE.0, PLACE.1))
}

/// A camera over the place that looks north.
fn view(altitude_m: f64, pitch_deg: f64) -> View {
    let place = LatLon::from_degrees(PLACE.0, PLACE.1);
    let camera = Camera::over(place, RADIUS_M + altitude_m, 0.0, pitch_deg.to_radians(), Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px: SIZE_PX, quality: Quality::Medium }
}

/// The sun in the south-west, at an angle from the zenith of the place.
fn sun(away_deg: f64) -> DVec3 {
    let (sin, cos) = away_deg.to_radians().sin_cos();
    let aside = DVec2::new(-0.5, -1.0).normalize() * sin;
    around().planet(DVec3::new(aside.x, aside.y, cos))
}

/// A box of a game, which is drawn into the maps of shadows alone.
struct Caster {
    middle_m: DVec3,
    half_m: DVec3,
    pipeline: wgpu::RenderPipeline,
    corners: wgpu::Buffer,
    draws: AtomicUsize,
}

const CAST: &str = "
@vertex
fn cast_vertex(@location(0) rel_m: vec3f) -> @builtin(position) vec4f {
    return shadow_view.clip_from_rel_m * vec4f(rel_m, 1.0);
}
";

impl Caster {
    /// A box around a point: metres to the east, to the north and up from the place.
    fn new(gpu: &Gpu, eye_m: DVec3, local_m: DVec3, half_m: DVec3) -> Self {
        let middle_m = around().up_planet * RADIUS_M + around().planet(local_m);
        let mut corners: Vec<[f32; 3]> = Vec::new();
        for (axis, side) in [0, 1, 2].into_iter().flat_map(|axis| [-1.0, 1.0].map(|side| (axis, side))) {
            for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let mut at = DVec3::ZERO;
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, u, v);
                corners.push((middle_m + around().planet(at * half_m) - eye_m).as_vec3().to_array());
            }
        }
        let text = caster_wgsl().unwrap() + CAST;
        let layouts = [gpu.renderer.caster_layout()];
        let pipeline = pipeline(gpu, text, ("cast_vertex", None), &layouts, ShadowView::depth_state());
        Self { middle_m, half_m, pipeline, corners: buffer(gpu, &corners), draws: AtomicUsize::new(0) }
    }

    /// Whether a ray meets the box, made larger by some metres on each side.
    fn is_met(&self, from_m: DVec3, dir: DVec3, more_m: f64) -> bool {
        let (from, dir) = (around().local(from_m - self.middle_m), around().local(dir));
        let half = self.half_m + more_m;
        let (a, b) = ((-half - from) / dir, (half - from) / dir);
        let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
        leave > enter.max(0.0)
    }

    /// What a point should be: in the light, in the shadow, or too near its edge.
    fn is_shaded(&self, point_m: DVec3, sun_dir: DVec3, margin_m: f64) -> Option<bool> {
        let [least, most] = [-margin_m, margin_m].map(|more_m| self.is_met(point_m, sun_dir, more_m));
        (least == most).then_some(least)
    }
}

impl ShadowCaster for Caster {
    fn ball(&self) -> (DVec3, f64) {
        (self.middle_m, self.half_m.length())
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &ShadowView) {
        self.draws.fetch_add(1, Ordering::Relaxed);
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.draw(0..36, 0..1);
    }
}

fn buffer(gpu: &Gpu, corners: &[[f32; 3]]) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(corners),
        usage: wgpu::BufferUsages::VERTEX,
    })
}

fn pipeline(
    gpu: &Gpu,
    text: String,
    (vertex, fragment): (&str, Option<&str>),
    groups: &[&wgpu::BindGroupLayout],
    depth: wgpu::DepthStencilState,
) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let compilation_options = wgpu::PipelineCompilationOptions::default();
    let targets = [Some(RADIANCE_FORMAT.into())];
    let attributes = wgpu::vertex_attr_array![0 => Float32x3];
    let corners =
        wgpu::VertexBufferLayout { array_stride: 12, step_mode: wgpu::VertexStepMode::Vertex, attributes: &attributes };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: compilation_options.clone(),
            buffers: &[Some(corners)],
        },
        fragment: fragment.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options,
            targets: &targets,
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth),
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

/// Where the rays of a scene meet a sphere over the reference sphere.
fn points(scene: &Scene<'_>, over_m: f64) -> Vec<Option<DVec3>> {
    let eye_m = scene.bodies[0].eye_planet_m();
    let meet = |dir: DVec3| {
        let b = eye_m.dot(dir);
        let root = b * b - eye_m.length_squared() + (RADIUS_M + over_m).powi(2);
        (b < 0.0 && root > 0.0).then(|| eye_m + dir * (-b - root.sqrt()))
    };
    rays(scene).into_iter().map(meet).collect()
}

/// The radiance of a scene. The device is taken for one picture alone.
fn light(scene: &Scene<'_>) -> Vec<[f32; 3]> {
    gpu().radiance(scene)
}

/// The shares of light that a caster leaves to the ground: of points that should be lit and of those that should not.
fn shares(scene: &Scene<'_>, caster: &Caster, margin_m: f64, over_m: f64) -> [Vec<f32>; 2] {
    let sun_dir = scene.suns[0].dir_scene;
    let mut cast = scene.clone();
    cast.bodies[0].casters.push(caster);
    let without = light(scene);
    let with = light(&cast);
    let mut found = [Vec::new(), Vec::new()];
    for (at, point_m) in points(scene, over_m).into_iter().enumerate() {
        let Some(point_m) = point_m else { continue };
        let Some(is_shaded) = caster.is_shaded(point_m, sun_dir, margin_m) else { continue };
        found[usize::from(is_shaded)].push(with[at][1] / without[at][1]);
    }
    found
}

fn scene<'a>(surface: &'a Surface, planet: &Planet, view: View, sun_dir: DVec3) -> Scene<'a> {
    frame_of(surface, planet, view, sun_dir)
}

/// Whether the ground is dark where the box hides the sun, and as before everywhere else. `local_m`: the middle of the
/// box; `texel_m`: of the map that tells.
fn compare(view: View, (local_m, half_m): (DVec3, DVec3), away_deg: f64, texel_m: f64) {
    let planet = Arc::new(planet());
    let surface = surface_of(&planet, &view);
    let scene = scene(&surface, &planet, view, sun(away_deg));
    let caster = Caster::new(&gpu(), view.camera.position_planet_m, local_m, half_m);
    let [lit, dark] = shares(&scene, &caster, 4.0 * texel_m, 0.0);
    let told = format!("box at {local_m}, {away_deg} degrees: {} lit, {} dark", lit.len(), dark.len());
    println!("{told}");
    assert!(lit.len() > 1000 && dark.len() > 60, "{told}");
    let least = lit.iter().copied().fold(1.0, f32::min);
    let most = dark.iter().copied().fold(0.0, f32::max);
    assert!(least > 0.999 && most < 0.01, "{told}; the darkest lit point has {least}, the lightest dark one {most}");
}

#[test]
fn a_box_near_the_eye_darkens_the_ground_where_it_hides_the_sun_and_nowhere_else() {
    // 60 m over the ground the nearest map is 180 m wide.
    let (at_m, half_m) = (DVec3::new(2.0, 18.0, 10.0), DVec3::new(4.0, 3.0, 10.0));
    compare(view(60.0, -70.0), (at_m, half_m), 35.0, 0.1);
    compare(view(60.0, -70.0), (at_m, half_m), 65.0, 0.1);
}

#[test]
fn a_tower_hundreds_of_metres_away_has_a_shadow_too() {
    // The map of a game's things is 2880 m wide.
    let (at_m, half_m) = (DVec3::new(-60.0, 560.0, 60.0), DVec3::new(45.0, 45.0, 60.0));
    compare(view(60.0, -8.0), (at_m, half_m), 60.0, 1.5);
}

#[test]
fn what_flies_high_over_the_map_shades_the_ground_under_it() {
    // Three kilometres up the way to the sun, from a point before the eye.
    let at_m = DVec3::new(0.0, 25.0, 0.0) + around().local(sun(50.0)) * 3000.0;
    compare(view(60.0, -70.0), (at_m, DVec3::new(9.0, 9.0, 3.0)), 50.0, 0.1);
}

#[test]
fn things_of_a_game_shade_the_sea() {
    let mut planet = planet();
    planet.water = Some(Water { level_m: 500.0, ..Water::default() });
    let (planet, view) = (Arc::new(planet), view(560.0, -60.0));
    let surface = surface_of(&planet, &view);
    let scene = scene(&surface, &planet, view, sun(40.0));
    let ship = (DVec3::new(0.0, 35.0, 515.0), DVec3::new(8.0, 12.0, 15.0));
    let caster = Caster::new(&gpu(), view.camera.position_planet_m, ship.0, ship.1);
    // Waves move the edge.
    let [lit, dark] = shares(&scene, &caster, 4.0, 500.0);
    assert!(lit.len() > 1000 && dark.len() > 60, "{} lit, {} dark", lit.len(), dark.len());
    let share = |of: &[f32], is_right: &dyn Fn(f32) -> bool| {
        of.iter().filter(|share| is_right(**share)).count() as f64 / of.len() as f64
    };
    let (right_lit, right_dark) = (share(&lit, &|share| share > 0.999), share(&dark, &|share| share < 0.05));
    assert!(right_lit > 0.99 && right_dark > 0.99, "{right_lit} of the lit, {right_dark} of the dark sea");
}

#[test]
fn without_the_sun_and_far_away_a_caster_changes_nothing() {
    let planet = Arc::new(planet());
    let view = view(60.0, -70.0);
    let surface = surface_of(&planet, &view);
    let eye_m = view.camera.position_planet_m;
    let near = Caster::new(&gpu(), eye_m, DVec3::new(2.0, 18.0, 10.0), DVec3::new(4.0, 3.0, 10.0));
    let far = Caster::new(&gpu(), eye_m, DVec3::new(20_000.0, 0.0, 10.0), DVec3::splat(10.0));
    let tiny = Caster::new(&gpu(), eye_m, DVec3::new(0.0, 18.0, 0.5), DVec3::splat(0.05));
    for (caster, away_deg) in [(&near, 100.0), (&near, 89.5), (&far, 40.0), (&tiny, 40.0)] {
        let scene = scene(&surface, &planet, view, sun(away_deg));
        let mut cast = scene.clone();
        cast.bodies[0].casters.push(caster);
        assert!(light(&scene) == light(&cast), "{away_deg}");
        assert_eq!(caster.draws.load(Ordering::Relaxed), 0, "{away_deg}");
    }
    // What is there is drawn into the nearest map and into that of a game's things.
    let mut cast = scene(&surface, &planet, view, sun(40.0));
    cast.bodies[0].casters.push(&near);
    gpu().draw_only(&cast, 1);
    assert_eq!(near.draws.load(Ordering::Relaxed), 2);
}

#[test]
fn objects_of_populations_stand_in_the_shadow_of_a_box() {
    let mut planet = planet();
    let form = Form::Stone(Stone { flatness: 0.0, stretch: 1.0, ..Stone::default() });
    let colors = [0.9, 0.05, 0.05];
    planet.life = vec![Population {
        per_hectare: 400.0,
        height_m: 1.0,
        height_spread: 0.0,
        color: colors,
        leaf_color: colors,
        clumping: 0.0,
        form,
        ..Population::default()
    }];
    let (planet, view) = (Arc::new(planet), view(40.0, -60.0));
    let surface = surface_of(&planet, &view);
    let scene = scene(&surface, &planet, view, sun(50.0));
    let place = (DVec3::new(-20.0, 10.0, 50.0), DVec3::new(12.0, 12.0, 1.0));
    let caster = Caster::new(&gpu(), view.camera.position_planet_m, place.0, place.1);
    let mut cast = scene.clone();
    cast.bodies[0].casters.push(&caster);
    let (without, with) = (light(&scene), light(&cast));
    let (mut shaded, mut lit) = (0, 0);
    for (at, point_m) in points(&scene, 0.5).into_iter().enumerate() {
        let is_stone = without[at][0] > 3.0 * without[at][1] && without[at][0] > 0.1;
        let Some(point_m) = point_m.filter(|_| is_stone) else { continue };
        let share = with[at][0] / without[at][0];
        match caster.is_shaded(point_m, sun(50.0), 2.0) {
            Some(true) => {
                shaded += 1;
                assert!(share < 0.4, "a stone in the shadow keeps {share}");
            }
            Some(false) => {
                lit += 1;
                assert!(share > 0.99, "a stone in the light keeps {share}");
            }
            None => {}
        }
    }
    assert!(shaded > 20 && lit > 100, "{shaded} {lit}");
}

const PLATE: &str = "
struct Corner {
    @builtin(position) position: vec4f,
    @location(0) rel_m: vec3f,
}

@vertex
fn plate_vertex(@location(0) rel_m: vec3f) -> Corner {
    return Corner(body.clip_from_rel_m * vec4f(rel_m, 1.0), rel_m);
}

@fragment
fn plate_fragment(in: Corner) -> @location(0) vec4f {
    let n = normalize(body.eye_km + in.rel_m * 0.001);
    let all = light_at(in.rel_m, n).sun.g;
    let left = shaded_light_at(in.rel_m, n, 1.0).sun.g;
    let behind_a_mountain = shaded_light_at(in.rel_m, n, 0.25).sun.g;
    return vec4f(sun_share_at(in.rel_m, n), left / all, behind_a_mountain / all, 1.0);
}
";

/// A level plate of the game, ten metres over the ground, under a box.
#[test]
fn a_mesh_of_the_game_stands_in_the_shadow_of_its_box_and_of_the_ground() {
    let planet = Arc::new(planet());
    let view = view(60.0, -70.0);
    let surface = surface_of(&planet, &view);
    let mut scene = scene(&surface, &planet, view, sun(45.0));
    let mut gpu = gpu();
    let eye_m = view.camera.position_planet_m;
    let caster = Caster::new(&gpu, eye_m, DVec3::new(-8.0, 10.0, 16.0), DVec3::new(4.0, 4.0, 3.0));
    scene.bodies[0].casters.push(&caster);
    let middle_m = around().up_planet * RADIUS_M + around().planet(DVec3::new(0.0, 20.0, 10.0));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| {
        let at_m = middle_m + around().planet(DVec3::new(u, v, 0.0) * 14.0);
        (at_m - eye_m).as_vec3().to_array()
    });
    let plate = buffer(&gpu, &corners);
    let depth_state =
        wgpu::DepthStencilState { depth_compare: Some(wgpu::CompareFunction::Greater), ..ShadowView::depth_state() };
    let (text, entries) = (air_wgsl().unwrap() + PLATE, ("plate_vertex", Some("plate_fragment")));
    let pipeline = pipeline(&gpu, text, entries, &gpu.renderer.body_layouts(), depth_state);
    let radiance = gpu.texture(SIZE_PX, RADIANCE_FORMAT);
    let depth = gpu.texture(SIZE_PX, DEPTH_FORMAT);
    let [to, over] = [&radiance, &depth].map(|t| t.create_view(&wgpu::TextureViewDescriptor::default()));
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let queue = gpu.queue.clone();
    let frame = gpu.renderer.prepare(&mut encoder, &scene, SIZE_PX, [0, 0, SIZE_PX[0], SIZE_PX[1]]).unwrap();
    frame.draw_opaque(&mut encoder, &OpaqueTargets::cleared(&to, &over)).unwrap();
    let groups = frame.body_groups(BodyId::default()).unwrap();
    let kept = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &to,
            depth_slice: None,
            resolve_target: None,
            ops: kept,
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &over,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, groups[0], &[]);
    pass.set_bind_group(1, groups[1], &[]);
    pass.set_vertex_buffer(0, plate.slice(..));
    pass.draw(0..6, 0..1);
    drop(pass);
    queue.submit([encoder.finish()]);
    let bytes = read_texture(&gpu.device, &gpu.queue, &radiance).unwrap();
    let half = |at: usize| half::f16::from_le_bytes([bytes[at], bytes[at + 1]]).to_f32();
    let (mut lit, mut dark) = (0, 0);
    for (at, dir) in rays(&scene).into_iter().enumerate() {
        let up = around().up_planet;
        let point_m = eye_m + dir * ((middle_m - eye_m).dot(up) / dir.dot(up));
        if around().local(point_m - middle_m).abs().truncate().max_element() > 13.5 {
            continue;
        }
        let Some(is_shaded) = caster.is_shaded(point_m, sun(45.0), 0.4) else { continue };
        let [share, left, behind] = [0, 2, 4].map(|offset| half(8 * at + offset));
        *(if is_shaded { &mut dark } else { &mut lit }) += 1;
        let should_be = if is_shaded { 0.0 } else { 1.0 };
        assert!((share - should_be).abs() < 0.01, "the share is {share} at {point_m}, {is_shaded}");
        assert!((left - share).abs() < 0.01 && (behind - 0.25 * share).abs() < 0.01, "{share}: {left}, {behind}");
    }
    assert!(dark > 150 && lit > 1000, "{dark} {lit}");
}

#[test]
fn the_map_of_a_games_things_leaves_the_shadows_of_trees_as_they_are() {
    let mut planet = planet();
    let all = Population::default();
    let tree = ReadyPopulation::named("Broadleaf tree").unwrap();
    planet.life = vec![Population {
        per_hectare: 300.0,
        biomes: String::new(),
        temperature_from_c: all.temperature_from_c,
        temperature_to_c: all.temperature_to_c,
        moisture_from: all.moisture_from,
        moisture_to: all.moisture_to,
        ..tree
    }];
    // A caster that is far away still makes a map.
    let (planet, view) = (Arc::new(planet), view(60.0, -70.0));
    let surface = surface_of(&planet, &view);
    let scene = scene(&surface, &planet, view, sun(45.0));
    let caster = Caster::new(&gpu(), view.camera.position_planet_m, DVec3::new(30_000.0, 0.0, 0.0), DVec3::splat(10.0));
    let mut cast = scene.clone();
    cast.bodies[0].casters.push(&caster);
    let (without, with) = (light(&scene), light(&cast));
    let apart = without.iter().zip(&with).map(|(a, b)| (a[1] - b[1]).abs() / a[1].max(1e-3)).fold(0.0, f32::max);
    assert!(apart < 0.002, "{apart}");
}

/// Scenes are drawn on threads of their own.
#[test]
fn a_scene_with_casters_may_go_to_another_thread() {
    fn is_sent(_: &(impl Send + Sync)) -> bool {
        true
    }
    let planet = Arc::new(planet());
    let view = view(60.0, -70.0);
    let surface = surface_of(&planet, &view);
    assert!(is_sent(&scene(&surface, &planet, view, sun(40.0))));
}
