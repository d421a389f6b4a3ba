//! Automatic exposure: a histogram of the finished radiance (`histogram.wgsl`), and the exposure computed from it
//! (`exposure.wgsl`). The result stays on the GPU in a buffer, which tone mapping reads.

use super::shared::{METER_BINS, METER_GROUP, METER_STRIDE, MeterStep};
use super::wgsl::{self, Uniform as _};
use super::{RenderError, gpu, shaders};
use glam::UVec2;

/// How the exposure of a picture is chosen, and the meaning of [`Post::exposure_ev`](super::Post::exposure_ev).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Metering {
    /// `exposure_ev` is the exposure: manual control.
    #[default]
    Manual,
    /// `exposure_ev` corrects the exposure metered from this picture.
    Instant,
    /// `exposure_ev` corrects an exposure that was metered before: [`Renderer::metered`](super::Renderer::metered).
    Fixed(Metered),
    /// As [`Metering::Instant`], but the exposure follows the picture over time, as an eye adapts.
    Adapting {
        /// Seconds since the last picture.
        secs: f64,
    },
}

/// What metering finds in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metered {
    /// The exposure, stops.
    pub ev: f64,
    /// Stops by which the highlights exceed white at that exposure: for them the curve of
    /// [`Tone::AgX`](super::Tone::AgX) bends gently.
    pub beyond_ev: f64,
    /// Stops by which dark parts are lifted before the curve: ground before a bright sky at dusk.
    pub fill_ev: f64,
}

impl Metering {
    /// What holds where this picture is not metered.
    fn fixed(self) -> Option<Metered> {
        match self {
            Metering::Manual => Some(Metered::default()),
            Metering::Fixed(metered) => Some(metered),
            Metering::Instant | Metering::Adapting { .. } => None,
        }
    }

    /// Share of the difference to the metered exposure that this picture closes.
    fn share(self) -> f32 {
        match self {
            Metering::Adapting { secs } => (1.0 - (-secs.max(0.0) / ADAPTATION_SECS).exp()) as f32,
            _ => 1.0,
        }
    }

    /// Most stops by which this picture changes the exposure.
    fn most_ev(self) -> f32 {
        match self {
            Metering::Adapting { secs } => (FASTEST_EV_S * secs.max(0.0)) as f32,
            _ => f32::MAX,
        }
    }
}

/// Time constant of adaptation in seconds: after it, 63% of the difference is closed.
const ADAPTATION_SECS: f64 = 0.35;
/// Greatest rate of adaptation: from a sunlit desert into space, a 60th of a second changes a fifth of a stop.
const FASTEST_EV_S: f64 = 12.0;
/// Bytes of the histograms and of the counter of white pixels (`meter.wgsl`).
const HISTOGRAM_BYTES: u64 = (3 * METER_BINS as u64 + 1) * 4;
/// Side in pixels of the square that one workgroup counts.
const GROUP_PX: u32 = METER_GROUP * METER_STRIDE;

/// The pipelines of metering.
pub(crate) struct ExposurePass {
    histogram: wgpu::ComputePipeline,
    exposure: wgpu::ComputePipeline,
}

/// Exposure of one view, on the GPU.
pub(crate) struct Exposure {
    bins: wgpu::Buffer,
    /// Four floats: factor on radiance, its base-2 logarithm (EV), stops by which highlights exceed white, and stops by
    /// which dark parts are lifted.
    pub(crate) result: wgpu::Buffer,
    step: wgpu::Buffer,
}

impl Exposure {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let written = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            bins: buffer("histogram", HISTOGRAM_BYTES, storage),
            result: buffer("exposure", 16, storage | written | wgpu::BufferUsages::COPY_SRC),
            step: buffer("exposure step", MeterStep::SIZE as u64, written),
        }
    }
}

impl ExposurePass {
    pub(crate) fn new(device: &wgpu::Device) -> Result<Self, RenderError> {
        Ok(Self { histogram: pipeline(device, "histogram.wgsl")?, exposure: pipeline(device, "exposure.wgsl")? })
    }

    /// Meters the radiance of a picture (viewport: x, y, width, height in the texture) and updates the exposure of a
    /// view.
    pub(crate) fn draw(
        &self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        of: &Exposure,
        radiance: &wgpu::TextureView,
        viewport_px: [u32; 4],
        metering: Metering,
    ) {
        if let Some(fixed) = metering.fixed() {
            let [ev, beyond_ev, fill_ev] = [fixed.ev, fixed.beyond_ev, fixed.fill_ev].map(|ev| ev as f32);
            queue.write_buffer(&of.result, 0, bytemuck::cast_slice(&[ev.exp2(), ev, beyond_ev, fill_ev]));
            return;
        }
        let [x, y, width, height] = viewport_px;
        let step = MeterStep {
            origin_px: UVec2::new(x, y),
            size_px: UVec2::new(width, height),
            share: metering.share(),
            most_ev: metering.most_ev(),
        };
        queue.write_buffer(&of.step, 0, &wgsl::bytes_of(&step));
        let [bins, result, step] = [&of.bins, &of.result, &of.step].map(wgpu::Buffer::as_entire_binding);
        let counted = [wgpu::BindingResource::TextureView(radiance), bins.clone(), step.clone()];
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.histogram);
        pass.set_bind_group(0, &group(device, &self.histogram, counted), &[]);
        pass.dispatch_workgroups(width.div_ceil(GROUP_PX), height.div_ceil(GROUP_PX), 1);
        pass.set_pipeline(&self.exposure);
        pass.set_bind_group(0, &group(device, &self.exposure, [bins, result, step]), &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
}

/// A bind group of the resources in the order of their bindings.
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
