//! Small helpers around wgpu that every pass uses: bind group layouts, full-screen pipelines, caught errors.

use super::{RenderError, shaders};
use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// What stands behind one binding of a layout; the binding's number is its place in the list.
#[derive(Clone, Copy)]
pub(crate) enum Slot {
    Uniform,
    Sampler,
    Float2d,
    Float2dArray,
    Float3d,
    Cube,
    Depth,
    /// A float texture that is only loaded, never filtered.
    Unfiltered2d,
}

/// A bind group layout from a list of slots, each visible to vertices and fragments.
pub(crate) fn layout(device: &wgpu::Device, label: &str, slots: &[Slot]) -> wgpu::BindGroupLayout {
    let texture =
        |sample_type, view_dimension| wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let float = wgpu::TextureSampleType::Float { filterable: true };
    let entries: Vec<_> = (0..)
        .zip(slots)
        .map(|(binding, slot)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: match slot {
                Slot::Uniform => wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                Slot::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                Slot::Float2d => texture(float, wgpu::TextureViewDimension::D2),
                Slot::Float2dArray => texture(float, wgpu::TextureViewDimension::D2Array),
                Slot::Float3d => texture(float, wgpu::TextureViewDimension::D3),
                Slot::Cube => texture(float, wgpu::TextureViewDimension::Cube),
                Slot::Depth => texture(wgpu::TextureSampleType::Depth, wgpu::TextureViewDimension::D2),
                Slot::Unfiltered2d => {
                    texture(wgpu::TextureSampleType::Float { filterable: false }, wgpu::TextureViewDimension::D2)
                }
            },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// A bind group of textures, bound in their order.
pub(crate) fn texture_group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    views: &[&wgpu::TextureView],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(views)
        .map(|(binding, view)| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// A texture that is drawn into and then read.
pub(crate) fn target(
    device: &wgpu::Device,
    label: &str,
    size_px: [u32; 2],
    format: wgpu::TextureFormat,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A pipeline that draws one triangle over the whole target.
pub(crate) fn screen_pipeline(
    device: &wgpu::Device,
    entry: &str,
    layouts: &[&wgpu::BindGroupLayout],
    formats: &[wgpu::TextureFormat],
) -> Result<wgpu::RenderPipeline, RenderError> {
    let module = shaders::module(device, entry)?;
    let layouts: Vec<_> = layouts.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let targets: Vec<_> = formats.iter().map(|&format| Some(format.into())).collect();
    checked(device, entry, || {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("screen_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            multiview_mask: None,
            cache: None,
        })
    })
}

/// Draws one full-screen triangle.
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

/// Runs `make` and turns what the driver or wgpu has against it into an error.
pub(crate) fn checked<T>(device: &wgpu::Device, name: &str, make: impl FnOnce() -> T) -> Result<T, RenderError> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make();
    // On native backends the answer is there at once; a browser's comes later and is not waited for.
    let mut answer = pin!(scope.pop());
    match answer.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(Some(error)) => Err(RenderError::Shader(format!("shaders/{name}: {error}"))),
        Poll::Ready(None) | Poll::Pending => Ok(made),
    }
}

/// The bytes of a buffer that has just been copied into; waits for the device.
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
