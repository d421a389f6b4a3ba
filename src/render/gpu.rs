//! Small wgpu helpers for all passes: bind group layouts, full-screen pipelines, error scopes, reading back.

use super::RenderError;
use super::targets::DEPTH_FORMAT;
use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Type of one binding of a layout. The number of the binding is its index in the list.
#[derive(Clone, Copy)]
pub(crate) enum Slot {
    Uniform,
    /// A buffer that shaders read.
    Storage,
    Sampler,
    Comparison,
    Float2d,
    Float2dArray,
    Float3d,
    Cube,
    CubeArray,
    Depth,
    DepthArray,
    /// A float texture that is loaded without filtering.
    Unfiltered2d,
}

/// A bind group layout from a list of slots, visible to vertex and fragment shaders.
pub(crate) fn layout(device: &wgpu::Device, label: &str, slots: &[Slot]) -> wgpu::BindGroupLayout {
    let texture =
        |sample_type, view_dimension| wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let float = wgpu::TextureSampleType::Float { filterable: true };
    let entries: Vec<_> = (0..)
        .zip(slots)
        .map(|(binding, slot)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty: match slot {
                Slot::Uniform => wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                Slot::Storage => wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: true },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                Slot::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                Slot::Comparison => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
                Slot::Float2d => texture(float, wgpu::TextureViewDimension::D2),
                Slot::Float2dArray => texture(float, wgpu::TextureViewDimension::D2Array),
                Slot::Float3d => texture(float, wgpu::TextureViewDimension::D3),
                Slot::Cube => texture(float, wgpu::TextureViewDimension::Cube),
                Slot::CubeArray => texture(float, wgpu::TextureViewDimension::CubeArray),
                Slot::Depth => texture(wgpu::TextureSampleType::Depth, wgpu::TextureViewDimension::D2),
                Slot::DepthArray => texture(wgpu::TextureSampleType::Depth, wgpu::TextureViewDimension::D2Array),
                Slot::Unfiltered2d => {
                    texture(wgpu::TextureSampleType::Float { filterable: false }, wgpu::TextureViewDimension::D2)
                }
            },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// A bind group of resources in the order of their bindings.
pub(crate) fn group<'a>(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: impl IntoIterator<Item = wgpu::BindingResource<'a>>,
) -> wgpu::BindGroup {
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// The layout of a pipeline with these groups.
pub(crate) fn pipeline_layout(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// A texture to draw into, to bind, and to copy from.
pub fn texture(device: &wgpu::Device, label: &str, size_px: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
    layered_texture(device, label, size_px, 1, format)
}

fn layered_texture(
    device: &wgpu::Device,
    label: &str,
    size_px: [u32; 2],
    layers: u32,
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// All of such a texture.
pub(crate) fn target(
    device: &wgpu::Device,
    label: &str,
    size_px: [u32; 2],
    format: wgpu::TextureFormat,
) -> wgpu::TextureView {
    texture(device, label, size_px, format).create_view(&wgpu::TextureViewDescriptor::default())
}

/// Memory of a texture: all levels and layers.
pub(crate) fn texture_bytes(texture: &wgpu::Texture) -> u64 {
    let level = |level| {
        let wgpu::Extent3d { width, height, depth_or_array_layers } =
            texture.size().mip_level_size(level, texture.dimension());
        u64::from(width) * u64::from(height) * u64::from(depth_or_array_layers)
    };
    let texels: u64 = (0..texture.mip_level_count()).map(level).sum();
    texels * u64::from(texture.format().block_copy_size(None).unwrap_or(0))
}

/// Memory of the textures behind some views.
pub(crate) fn view_bytes<'a>(views: impl IntoIterator<Item = &'a wgpu::TextureView>) -> u64 {
    views.into_iter().map(|view| texture_bytes(view.texture())).sum()
}

/// A texture with several layers: the views of all of them together, and of each for drawing into it.
pub(crate) fn layered_target(
    device: &wgpu::Device,
    label: &str,
    size_px: [u32; 2],
    layers: u32,
    format: wgpu::TextureFormat,
) -> (wgpu::TextureView, Vec<wgpu::TextureView>) {
    let texture = layered_texture(device, label, size_px, layers, format);
    let view = |dimension, base_array_layer, array_layer_count| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(dimension),
            base_array_layer,
            array_layer_count: Some(array_layer_count),
            ..wgpu::TextureViewDescriptor::default()
        })
    };
    let each = (0..layers).map(|layer| view(wgpu::TextureViewDimension::D2, layer, 1)).collect();
    (view(wgpu::TextureViewDimension::D2Array, 0, layers), each)
}

/// A pipeline that draws one triangle over all pixels of its targets.
pub(crate) struct ScreenPipelineDescriptor<'a> {
    /// Shader file.
    pub(crate) entry: &'a str,
    pub(crate) layout: &'a wgpu::PipelineLayout,
    pub(crate) module: &'a wgpu::ShaderModule,
    pub(crate) targets: &'a [Option<wgpu::ColorTargetState>],
    /// Whether the shader writes depth. Nearer depth is kept.
    pub(crate) writes_depth: bool,
    /// Whether the target encodes sRGB in hardware: the shader constant TARGET_ENCODES_SRGB.
    pub(crate) encodes_srgb: bool,
    /// Whether the target takes linear values: the shader constant TARGET_IS_LINEAR.
    pub(crate) is_linear: bool,
    /// Further constants of the shader.
    pub(crate) constants: &'a [(&'static str, f64)],
}

/// Creates a full-screen pipeline.
pub(crate) fn screen_pipeline(
    device: &wgpu::Device,
    of: &ScreenPipelineDescriptor<'_>,
) -> Result<wgpu::RenderPipeline, RenderError> {
    let constants = [("TARGET_ENCODES_SRGB", of.encodes_srgb), ("TARGET_IS_LINEAR", of.is_linear)];
    let constants: Vec<_> = constants
        .into_iter()
        .filter(|(_, holds)| *holds)
        .map(|(name, _)| (name, 1.0))
        .chain(of.constants.iter().copied())
        .collect();
    checked(device, of.entry, || {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(of.entry),
            layout: Some(of.layout),
            vertex: wgpu::VertexState {
                module: of.module,
                entry_point: Some("screen_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            fragment: Some(wgpu::FragmentState {
                module: of.module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..wgpu::PipelineCompilationOptions::default()
                },
                targets: of.targets,
            }),
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: of.writes_depth.then(|| depth_state(wgpu::CompareFunction::GreaterEqual)),
            multisample: wgpu::MultisampleState::default(),
            multiview_mask: None,
            cache: None,
        })
    })
}

/// State for depth that is tested and written. Depth is reversed: greater is nearer.
pub(crate) fn depth_state(depth_compare: wgpu::CompareFunction) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(depth_compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// A depth attachment, loaded if `load`, else cleared to infinity (reverse-Z: 0).
pub(crate) fn depth_attachment(view: &wgpu::TextureView, load: bool) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let load = if load { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) };
    let depth_ops = Some(wgpu::Operations { load, store: wgpu::StoreOp::Store });
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }
}

/// Limits drawing to a rectangle: x, y, width, height in pixels.
pub(crate) fn set_viewport(pass: &mut wgpu::RenderPass<'_>, [x, y, width, height]: [u32; 4]) {
    pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
    pass.set_scissor_rect(x, y, width, height);
}

/// Draws one full-screen triangle into cleared targets.
pub(crate) fn draw_screen(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &wgpu::RenderPipeline,
    groups: &[&wgpu::BindGroup],
    targets: &[&wgpu::TextureView],
) {
    let attachments: Vec<_> = targets
        .iter()
        .map(|view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })
        })
        .collect();
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &attachments,
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(pipeline);
    for (i, group) in (0..).zip(groups) {
        pass.set_bind_group(i, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}

/// Runs `make` and returns validation errors of wgpu or of the driver.
pub(crate) fn checked<T>(device: &wgpu::Device, name: &str, make: impl FnOnce() -> T) -> Result<T, RenderError> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make();
    // Native backends answer at once. In a browser the answer comes later; it is not waited for.
    let mut answer = pin!(scope.pop());
    match answer.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(Some(error)) => Err(RenderError::Shader(format!("shaders/{name}: {error}"))),
        Poll::Ready(None) | Poll::Pending => Ok(made),
    }
}

/// The sampler of shadow maps: the share of texels that are farther than a depth.
pub(crate) fn comparison_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("comparison"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..wgpu::SamplerDescriptor::default()
    })
}

/// The two samplers of every pass, both linear: clamped to the edge, and repeated.
pub(crate) fn samplers(device: &wgpu::Device) -> [wgpu::Sampler; 2] {
    let sampler = |(label, mode)| {
        device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(label),
            address_mode_u: mode,
            address_mode_v: mode,
            address_mode_w: mode,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        })
    };
    [("clamped", wgpu::AddressMode::ClampToEdge), ("repeated", wgpu::AddressMode::Repeat)].map(sampler)
}

/// Reads the texels of a texture, row by row. Blocks until the device is done.
///
/// # Errors
/// [`RenderError::Device`]: the device does not answer.
pub fn read_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, RenderError> {
    let texel_bytes = texture.format().block_copy_size(None).unwrap_or(4);
    let row_bytes = texture.width() * texel_bytes;
    let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("texels"),
        size: u64::from(padded_bytes) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("texels") });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_bytes), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    queue.submit([encoder.finish()]);
    let bytes = read(device, &buffer)?;
    Ok(bytes.chunks(padded_bytes as usize).flat_map(|row| &row[..row_bytes as usize]).copied().collect())
}

/// Reads a buffer after a submitted copy into it. Blocks until the device is done.
pub(crate) fn read(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Result<Vec<u8>, RenderError> {
    let failed = |error: &dyn std::fmt::Display| RenderError::Device(error.to_string());
    let (send, receive) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        let _ = send.send(result);
    });
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
    receive.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
    let mapped = buffer.get_mapped_range(..).map_err(|error| failed(&error))?;
    Ok(mapped.to_vec())
}

/// A texture of one mip level that passes read and the CPU writes; `size` counts layers as depth.
pub(crate) fn written_texture(
    device: &wgpu::Device,
    label: &str,
    size: wgpu::Extent3d,
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}
