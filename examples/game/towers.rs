//! The game's own mesh: a row of towers on the ground, drawn into the maps of shadows and between the renderer's
//! opaque stage and its air.

#![allow(dead_code)]

use tellus::glam::{DVec3, Vec3};
use tellus::render::wgpu::util::DeviceExt as _;
use tellus::render::{
    BodyId, DEPTH_FORMAT, PreparedFrame, RADIANCE_FORMAT, RenderError, Renderer, ShadowCaster, ShadowView, air_wgsl,
    caster_wgsl, wgpu,
};
use tellus::sphere::geo;
use tellus::terrain::Terrain;

/// Floats of a vertex: position and normal.
const VERTEX_FLOATS: usize = 6;
/// Floats of an instance: foot, three axes, and what the ground leaves of the sun.
const INSTANCE_FLOATS: usize = 16;
/// Heights at which a tower knows what the ground leaves of the sun.
const LEVELS: usize = 4;

/// A tower in the planet frame.
pub(crate) struct Tower {
    foot_planet_m: DVec3,
    width_m: f64,
    height_m: f64,
    /// Shares of the sun's disc that the ground leaves, from the foot to the top.
    sun_shares: [f64; LEVELS],
}

impl Tower {
    /// A tower on the ground under a direction.
    pub(crate) fn on_ground(terrain: &Terrain, dir_planet: DVec3, width_m: f64, height_m: f64) -> Self {
        let dir = dir_planet.normalize();
        Self::at(dir * (terrain.planet().radius_m() + terrain.height_m(dir) - 0.1 * height_m), width_m, height_m)
    }

    /// A tower that stands anywhere, upright.
    pub(crate) fn at(foot_planet_m: DVec3, width_m: f64, height_m: f64) -> Self {
        Self { foot_planet_m, width_m, height_m, sun_shares: [1.0; LEVELS] }
    }

    /// Finds the shadow of the ground on it. A game does so again when the sun has moved by its own width.
    pub(crate) fn shaded(mut self, terrain: &Terrain, sun_dir_planet: DVec3) -> Self {
        let sun_radius_rad = terrain.planet().star.radius_deg.to_radians();
        let up = self.foot_planet_m.normalize();
        for (level, share) in self.sun_shares.iter_mut().enumerate() {
            let point_m = self.foot_planet_m + up * (self.height_m * level as f64 / (LEVELS - 1) as f64);
            *share = terrain.sun_share(point_m, sun_dir_planet, sun_radius_rad);
        }
        self
    }

    /// A ball around it.
    fn ball(&self) -> (DVec3, f64) {
        let middle_m = self.foot_planet_m + self.foot_planet_m.normalize() * (0.5 * self.height_m);
        (middle_m, (0.5 * self.height_m).hypot(self.width_m))
    }

    fn instance(&self, eye_planet_m: DVec3) -> [f32; INSTANCE_FLOATS] {
        let up = self.foot_planet_m.normalize();
        let (east, north) = geo::east_north(up);
        // Subtracted in 64 bits: a tower at the camera's feet does not tremble.
        let foot_m = (self.foot_planet_m - eye_planet_m).as_vec3();
        let axes = [east * self.width_m, north * self.width_m, up * self.height_m].map(DVec3::as_vec3);
        let mut floats = [0.0; INSTANCE_FLOATS];
        for (floats, vector) in floats.chunks_mut(3).zip([foot_m].into_iter().chain(axes)) {
            floats.copy_from_slice(&vector.to_array());
        }
        for (float, share) in floats[12..].iter_mut().zip(self.sun_shares) {
            *float = share as f32;
        }
        floats
    }
}

/// Pipelines and buffers.
pub(crate) struct Towers {
    pipeline: wgpu::RenderPipeline,
    /// Into the maps of shadows.
    casting: wgpu::RenderPipeline,
    mesh: wgpu::Buffer,
    vertices: u32,
    towers: Vec<Tower>,
}

impl Towers {
    /// Compiles the game's shaders behind the renderer's.
    pub(crate) fn new(device: &wgpu::Device, renderer: &Renderer, towers: Vec<Tower>) -> Result<Self, RenderError> {
        let common = include_str!("towers.wgsl");
        let lit = air_wgsl()? + common + include_str!("towers_lit.wgsl");
        let cast = caster_wgsl()? + common + include_str!("towers_cast.wgsl");
        // Depth is reversed: nearer is greater.
        let depth = wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        };
        let pipeline = pipeline(device, lit, &renderer.body_layouts(), Some(RADIANCE_FORMAT), depth);
        // Into the maps of shadows goes depth alone.
        let casting = self::pipeline(device, cast, &[renderer.caster_layout()], None, ShadowView::depth_state());
        let mesh = prism(8);
        let vertices = (mesh.len() / VERTEX_FLOATS) as u32;
        Ok(Self { pipeline, casting, mesh: upload(device, &mesh), vertices, towers })
    }

    /// The towers as an eye sees them, for one frame.
    pub(crate) fn seen_from(&self, device: &wgpu::Device, eye_planet_m: DVec3) -> Seen<'_> {
        let instances: Vec<f32> = self.towers.iter().flat_map(|tower| tower.instance(eye_planet_m)).collect();
        Seen { towers: self, instances: upload(device, &instances) }
    }
}

/// The towers around an eye.
pub(crate) struct Seen<'a> {
    towers: &'a Towers,
    instances: wgpu::Buffer,
}

impl ShadowCaster for Seen<'_> {
    fn ball(&self) -> (DVec3, f64) {
        let towers = &self.towers.towers;
        let middle_m = towers.iter().map(|tower| tower.foot_planet_m).sum::<DVec3>() / towers.len().max(1) as f64;
        let reaches = towers.iter().map(Tower::ball).map(|(center_m, radius_m)| center_m.distance(middle_m) + radius_m);
        (middle_m, reaches.fold(0.0, f64::max))
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, to: &ShadowView) {
        pass.set_pipeline(&self.towers.casting);
        for (number, tower) in (0..).zip(&self.towers.towers) {
            let (center_m, radius_m) = tower.ball();
            if to.sees(center_m, radius_m) {
                self.draw_instances(pass, number..number + 1);
            }
        }
    }
}

impl Seen<'_> {
    /// Draws the towers into targets that hold the ground.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &PreparedFrame<'_>,
        [radiance, depth]: [&wgpu::TextureView; 2],
    ) {
        let Some(groups) = frame.body_groups(BodyId::default()) else { return };
        let kept = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("towers"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: radiance,
                depth_slice: None,
                resolve_target: None,
                ops: kept,
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.towers.pipeline);
        pass.set_bind_group(0, groups[0], &[]);
        pass.set_bind_group(1, groups[1], &[]);
        self.draw_instances(&mut pass, 0..self.towers.towers.len() as u32);
    }

    fn draw_instances(&self, pass: &mut wgpu::RenderPass<'_>, instances: std::ops::Range<u32>) {
        pass.set_vertex_buffer(0, self.towers.mesh.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
        pass.draw(0..self.towers.vertices, instances);
    }
}

/// A pipeline that draws towers.
fn pipeline(
    device: &wgpu::Device,
    text: String,
    groups: &[&wgpu::BindGroupLayout],
    color: Option<wgpu::TextureFormat>,
    depth: wgpu::DepthStencilState,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("towers"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("towers"),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let vertex = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let instance =
        wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 6 => Float32x4];
    let buffer = |floats: usize, step_mode, attributes| {
        Some(wgpu::VertexBufferLayout { array_stride: floats as u64 * 4, step_mode, attributes })
    };
    let targets = [color.map(wgpu::ColorTargetState::from)];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("towers"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("tower_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[
                buffer(VERTEX_FLOATS, wgpu::VertexStepMode::Vertex, &vertex[..]),
                buffer(INSTANCE_FLOATS, wgpu::VertexStepMode::Instance, &instance[..]),
            ],
        },
        fragment: color.is_some().then(|| wgpu::FragmentState {
            module: &module,
            entry_point: Some("tower_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth),
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

fn upload(device: &wgpu::Device, floats: &[f32]) -> wgpu::Buffer {
    let bytes: Vec<u8> = floats.iter().flat_map(|float| float.to_le_bytes()).collect();
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("towers"),
        contents: &bytes,
        usage: wgpu::BufferUsages::VERTEX,
    })
}

/// A tower with `sides` walls, radius 1 and height 1, and a pointed roof. A triangle list: position and normal of each
/// corner.
fn prism(sides: usize) -> Vec<f32> {
    let corner = |i: usize, radius: f32, z: f32| {
        let angle = i as f32 / sides as f32 * std::f32::consts::TAU;
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    let mut mesh = Vec::new();
    let mut triangle = |corners: [Vec3; 3], outwards: Vec3| {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        let normal = if normal.dot(outwards) < 0.0 { -normal } else { normal };
        for corner in corners {
            mesh.extend(corner.to_array());
            mesh.extend(normal.to_array());
        }
    };
    for i in 0..sides {
        let [a, b] = [i, i + 1].map(|i| corner(i, 1.0, 0.0));
        let [c, d] = [i, i + 1].map(|i| corner(i, 0.6, 0.8));
        triangle([a, b, d], a + b);
        triangle([a, d, c], a + b);
        triangle([c, d, Vec3::Z], Vec3::Z);
    }
    mesh
}
