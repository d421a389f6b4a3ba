//! Automatic exposure: a histogram of the finished radiance (`histogram.wgsl`) and what follows from it (`exposure.wgsl`). All of
//! it stays on the GPU; the tone mapping reads the result from a buffer.

use super::{RenderError, gpu, shaders};

/// How [`super::Frame::exposure_ev`] is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Metering {
    /// As the exposure itself: the manual lock.
    #[default]
    Manual,
    /// As a correction to what suits the picture, at once.
    Instant,
    /// The same, but exposure follows as an eye would: so many seconds have passed since the last picture.
    Adapting {
        /// Seconds since the last picture.
        secs: f64,
    },
}

impl Metering {
    /// Share of the way to the exposure wanted that is gone in this picture; `None` for manual exposure.
    fn share(self) -> Option<f32> {
        match self {
            Metering::Manual => None,
            Metering::Instant => Some(1.0),
            Metering::Adapting { secs } => Some((1.0 - (-secs.max(0.0) / ADAPTATION_SECS).exp()) as f32),
        }
    }
}

/// Time in which the eye goes two thirds of its way.
const ADAPTATION_SECS: f64 = 0.35;
/// Bytes of the histogram and its counter of white pixels; must match `meter.wgsl`.
const HISTOGRAM_BYTES: u64 = (128 + 1) * 4;
/// Pixels along a side that one workgroup looks at; must match `meter.wgsl`.
const GROUP_PX: u32 = 16 * 4;

/// Pipelines and buffers.
pub(crate) struct ExposurePass {
    histogram: wgpu::ComputePipeline,
    exposure: wgpu::ComputePipeline,
    bins: wgpu::Buffer,
    /// Factor on radiance and its logarithm.
    pub(crate) result: wgpu::Buffer,
    step: wgpu::Buffer,
    /// What `exposure` reads and writes.
    set: wgpu::BindGroup,
}

impl ExposurePass {
    pub(crate) fn new(device: &wgpu::Device) -> Result<Self, RenderError> {
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let written = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let exposure = pipeline(device, "exposure.wgsl")?;
        let bins = buffer("histogram", HISTOGRAM_BYTES, storage);
        let result = buffer("exposure", 16, storage | written);
        let step = buffer("exposure step", 16, written);
        let set = group(device, &exposure, [&bins, &result, &step].map(wgpu::Buffer::as_entire_binding));
        Ok(Self { histogram: pipeline(device, "histogram.wgsl")?, exposure, bins, result, step, set })
    }

    /// Binds the radiance it is to measure.
    pub(crate) fn bind(&self, device: &wgpu::Device, hdr: &wgpu::TextureView) -> wgpu::BindGroup {
        group(device, &self.histogram, [wgpu::BindingResource::TextureView(hdr), self.bins.as_entire_binding()])
    }

    /// Sets the exposure for the picture that [`Self::bind`] bound, of a size in pixels.
    pub(crate) fn draw(
        &self,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        input: &wgpu::BindGroup,
        size_px: [u32; 2],
        metering: Metering,
    ) {
        let Some(share) = metering.share() else {
            queue.write_buffer(&self.result, 0, bytemuck::cast_slice(&[1.0_f32, 0.0, 0.0, 0.0]));
            return;
        };
        queue.write_buffer(&self.step, 0, bytemuck::cast_slice(&[share, 0.0, 0.0, 0.0]));
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.histogram);
        pass.set_bind_group(0, input, &[]);
        pass.dispatch_workgroups(size_px[0].div_ceil(GROUP_PX), size_px[1].div_ceil(GROUP_PX), 1);
        pass.set_pipeline(&self.exposure);
        pass.set_bind_group(0, &self.set, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
}

/// Resources as the one bind group of a pipeline, in the order of their bindings.
fn group<const N: usize>(
    device: &wgpu::Device,
    pipeline: &wgpu::ComputePipeline,
    resources: [wgpu::BindingResource<'_>; N],
) -> wgpu::BindGroup {
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("exposure"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    })
}

fn pipeline(device: &wgpu::Device, entry: &'static str) -> Result<wgpu::ComputePipeline, RenderError> {
    let module = shaders::module(device, entry)?;
    gpu::checked(device, entry, || {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &module,
            entry_point: Some("compute"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    })
}
