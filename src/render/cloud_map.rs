//! The weather map (`cloud_map.wgsl`): six faces of a cube map, drawn again when scale, curl, seed or the solved
//! weather changes.

use super::shared::WEATHER_SIDE;
use super::{RenderError, gpu, shaders};
use wgpu::util::DeviceExt;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Centre, right and down of each face, in the order and orientation of cube textures.
const FACES: [[[f32; 4]; 3]; 6] = [
    [[1., 0., 0., 0.], [0., 0., -1., 0.], [0., -1., 0., 0.]],
    [[-1., 0., 0., 0.], [0., 0., 1., 0.], [0., -1., 0., 0.]],
    [[0., 1., 0., 0.], [1., 0., 0., 0.], [0., 0., 1., 0.]],
    [[0., -1., 0., 0.], [1., 0., 0., 0.], [0., 0., -1., 0.]],
    [[0., 0., 1., 0.], [1., 0., 0., 0.], [0., -1., 0., 0.]],
    [[0., 0., -1., 0.], [-1., 0., 0., 0.], [0., -1., 0., 0.]],
];

/// The weather map: the cube view for shaders, and a target for each face.
pub(crate) struct WeatherMap {
    pub(crate) cube: wgpu::TextureView,
    faces: Vec<wgpu::TextureView>,
}

impl WeatherMap {
    /// Creates a map without content.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("weather map"),
            size: wgpu::Extent3d { width: WEATHER_SIDE, height: WEATHER_SIDE, depth_or_array_layers: 6 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let cube = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::Cube),
            ..wgpu::TextureViewDescriptor::default()
        });
        let face = |layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..wgpu::TextureViewDescriptor::default()
            })
        };
        Self { cube, faces: (0..6).map(face).collect() }
    }
}

/// The pipeline and the orientation of each face.
pub(crate) struct CloudMapPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    faces: Vec<wgpu::Buffer>,
}

impl CloudMapPass {
    pub(crate) fn new(device: &wgpu::Device, uniforms: &wgpu::BindGroupLayout) -> Result<Self, RenderError> {
        let layout = gpu::layout(device, "cube face", &[gpu::Slot::Uniform, gpu::Slot::Cube]);
        let entry = "cloud_map.wgsl";
        let description = gpu::ScreenPipelineDescriptor {
            entry,
            layout: &gpu::pipeline_layout(device, entry, &[uniforms, &layout]),
            module: &shaders::module(device, entry)?,
            targets: &[Some(FORMAT.into())],
            writes_depth: false,
            encodes_srgb: false,
        };
        let pipeline = gpu::screen_pipeline(device, &description)?;
        let faces = FACES
            .iter()
            .map(|face| {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("cube face"),
                    contents: bytemuck::cast_slice(face),
                    usage: wgpu::BufferUsages::UNIFORM,
                })
            })
            .collect();
        Ok(Self { pipeline, layout, faces })
    }

    /// Draws the six faces of the map. `solved`: a cube; see the shader.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        uniforms: &wgpu::BindGroup,
        solved: &wgpu::TextureView,
        map: &WeatherMap,
    ) {
        for (view, face) in map.faces.iter().zip(&self.faces) {
            let resources = [face.as_entire_binding(), wgpu::BindingResource::TextureView(solved)];
            let face = gpu::group(device, "cube face", &self.layout, resources);
            gpu::draw_screen(encoder, "weather map", &self.pipeline, &[uniforms, &face], &[view]);
        }
    }
}
