//! Pictures of single forms (`form_view.wgsl`): a mesh in the colours of its population, on a floor, in the sun.

use super::material::Material;
use super::models::{ATTRIBUTES, Vertex, packed};
use crate::life::form::Mesh;
use crate::planet::Population;
use crate::render::targets::DEPTH_FORMAT;
use crate::render::{RenderError, gpu, shaders};
use glam::{Mat4, Vec2, Vec3, Vec4};
use wgpu::util::DeviceExt;

const ENTRY: &str = "form_view.wgsl";
/// Angle of the sun over the floor, and from the eye to the side, radians.
const SUN_RAD: [f32; 2] = [0.9, 0.9];
/// Radius of the floor in radii of the form.
const FLOOR: f32 = 1.9;

/// The uniforms of `form_view.wgsl`.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Uniforms {
    clip_from_form: [[f32; 4]; 4],
    to_sun: [f32; 3],
    size_m: f32,
    to_eye: [f32; 3],
    pixel_m: f32,
    first: [f32; 3],
    material: u32,
    second: [f32; 3],
    floor: f32,
    behind: [f32; 3],
    rest: f32,
}

/// Where the eye is: the picture has no perspective, so that lengths can be read from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormCamera {
    /// Turn of the form about its axis, radians.
    pub turn_rad: f64,
    /// Angle of the eye over the horizontal, radians.
    pub raised_rad: f64,
    /// Width and height of the picture in heights of the form.
    pub extent: [f64; 2],
    /// Middle of the picture from the foot of the form, in heights of the form: to the right and up in the picture.
    pub middle: [f64; 2],
}

/// A picture to draw into, with its depth.
pub struct FormTarget {
    view: wgpu::TextureView,
    depth: wgpu::TextureView,
    size_px: [u32; 2],
}

impl FormTarget {
    /// A picture of this size; no side is zero.
    pub fn new(device: &wgpu::Device, size_px: [u32; 2], format: wgpu::TextureFormat) -> Self {
        let view = gpu::target(device, "form", size_px, format);
        Self { view, depth: gpu::target(device, "depth of a form", size_px, DEPTH_FORMAT), size_px }
    }

    /// The texture.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Its width and height, pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }
}

/// A mesh of a form on the GPU.
pub struct FormMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    /// Greatest distance of a corner from the axis, in heights of the form.
    radius: f64,
}

impl FormMesh {
    /// Uploads a mesh.
    pub fn new(device: &wgpu::Device, mesh: &Mesh) -> Self {
        let vertices: Vec<Vertex> = mesh.vertices.iter().map(|vertex| packed(vertex, 0, 0)).collect();
        let mut indices: Vec<u16> = mesh.triangles.iter().flatten().copied().collect();
        let count = indices.len() as u32;
        // Buffers are copied in words.
        if !indices.len().is_multiple_of(2) {
            indices.push(0);
        }
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("form"), contents, usage })
        };
        let away = mesh.vertices.iter().map(|vertex| vertex.position.truncate().length());
        Self {
            vertices: buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            count,
            radius: f64::from(away.fold(0.05, f32::max)),
        }
    }

    /// Greatest distance of a corner from the axis, in heights of the form.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// Draws forms.
pub struct FormView {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    floor: wgpu::RenderPipeline,
    shadow: wgpu::RenderPipeline,
    form: wgpu::RenderPipeline,
}

impl FormView {
    /// Prepares pictures of a format: one without conversion to sRGB, since colours are encoded already.
    ///
    /// # Errors
    /// [`RenderError::Shader`], [`RenderError::Device`]: the shader does not compile on this device.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self, RenderError> {
        let module = shaders::module(device, ENTRY)?;
        let layout = gpu::layout(device, "form", &[gpu::Slot::Uniform]);
        let own = gpu::pipeline_layout(device, ENTRY, &[&layout]);
        let vertices = Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &ATTRIBUTES,
        });
        let pipeline = |entries: [&str; 2], buffers: &[Option<wgpu::VertexBufferLayout<'_>>], strip: bool| {
            let is_form = entries[0] == "vertex";
            let depth = wgpu::DepthStencilState {
                depth_write_enabled: Some(is_form),
                ..gpu::depth_state(if is_form { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Always })
            };
            let topology = match strip {
                true => wgpu::PrimitiveTopology::TriangleStrip,
                false => wgpu::PrimitiveTopology::TriangleList,
            };
            gpu::checked(device, ENTRY, || {
                device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some(entries[0]),
                    layout: Some(&own),
                    vertex: wgpu::VertexState {
                        module: &module,
                        entry_point: Some(entries[0]),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        buffers,
                    },
                    fragment: Some(wgpu::FragmentState {
                        module: &module,
                        entry_point: Some(entries[1]),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        targets: &[Some(format.into())],
                    }),
                    primitive: wgpu::PrimitiveState { topology, ..wgpu::PrimitiveState::default() },
                    depth_stencil: Some(depth),
                    multisample: wgpu::MultisampleState::default(),
                    multiview_mask: None,
                    cache: None,
                })
            })
        };
        let floor = pipeline(["floor_vertex", "floor_fragment"], &[], true)?;
        let shadow = pipeline(["shadow_vertex", "shadow_fragment"], std::slice::from_ref(&vertices), false)?;
        let form = pipeline(["vertex", "fragment"], &[vertices], false)?;
        Ok(Self { device: device.clone(), queue: queue.clone(), layout, floor, shadow, form })
    }

    /// Draws a form of a population, of the mean height of its objects, and submits it. `behind`: the colour around
    /// the floor, as the picture has it, 0 to 1.
    pub fn draw(
        &self,
        to: &FormTarget,
        mesh: &FormMesh,
        population: &Population,
        camera: &FormCamera,
        behind: [f32; 3],
    ) {
        let uniforms = uniforms(to.size_px, mesh, population, camera, behind);
        let buffer = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("form"),
            contents: bytemuck::bytes_of(&uniforms),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let group = gpu::group(&self.device, "form", &self.layout, [buffer.as_entire_binding()]);
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("form") });
        let [r, g, b] = behind.map(f64::from);
        let clear = wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("form"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &to.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: clear, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(gpu::depth_attachment(&to.depth, false)),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &group, &[]);
        pass.set_pipeline(&self.floor);
        pass.draw(0..4, 0..1);
        if mesh.count > 0 {
            pass.set_vertex_buffer(0, mesh.vertices.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint16);
            for pipeline in [&self.shadow, &self.form] {
                pass.set_pipeline(pipeline);
                pass.draw_indexed(0..mesh.count, 0, 0..1);
            }
        }
        drop(pass);
        self.queue.submit([encoder.finish()]);
    }
}

fn uniforms(
    size_px: [u32; 2],
    mesh: &FormMesh,
    population: &Population,
    camera: &FormCamera,
    behind: [f32; 3],
) -> Uniforms {
    let (turn, raised) = (camera.turn_rad as f32, camera.raised_rad as f32);
    // Directions of the picture in the frame of the form, which turns under the eye and the sun.
    let level = |aside_rad: f32| Vec2::from_angle(aside_rad - turn);
    let ahead = level(std::f32::consts::FRAC_PI_2);
    let right = level(0.0).extend(0.0);
    let to_eye = (-ahead * raised.cos()).extend(raised.sin());
    let up = to_eye.cross(right);
    let [sun_up, sun_aside] = SUN_RAD;
    let to_sun = (level(-std::f32::consts::FRAC_PI_2 + sun_aside) * sun_up.cos()).extend(sun_up.sin());
    let [width, height] = camera.extent.map(|side| side as f32);
    let [x, y] = camera.middle.map(|part| part as f32);
    let floor = FLOOR * mesh.radius as f32;
    // Nearer is greater, as everywhere.
    let deep = 2.0 * (floor + 2.0);
    let rows = [
        (right * (2.0 / width)).extend(-2.0 * x / width),
        (up * (2.0 / height)).extend(-2.0 * y / height),
        (to_eye / deep).extend(0.5),
        Vec4::W,
    ];
    let size_m = population.height_m;
    let [first, second] = population.colors();
    let color = |color: [f64; 3]| Vec3::from_array(color.map(|part| part as f32)).to_array();
    Uniforms {
        clip_from_form: Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose().to_cols_array_2d(),
        to_sun: to_sun.to_array(),
        size_m: size_m as f32,
        to_eye: to_eye.to_array(),
        pixel_m: (size_m * camera.extent[1] / f64::from(size_px[1].max(1))) as f32,
        first: color(first),
        material: Material::of(&population.form) as u32,
        second: color(second),
        floor,
        behind,
        rest: 0.0,
    }
}
