//! A GPU without a window: adapter, device, and the pixels of a picture.
//!
//! wgpu's environment variables choose the adapter: `WGPU_BACKEND`, `WGPU_ADAPTER_NAME`, `WGPU_POWER_PREF`.

use crate::render::Renderer;
use std::sync::{Arc, Mutex, PoisonError};

/// Format of the pictures.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// wgpu's own variable: part of the name of the adapter to use.
const ADAPTER_NAME: &str = "WGPU_ADAPTER_NAME";

/// An open device.
pub(super) struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    /// Adapter and backend, for messages.
    pub(super) name: String,
    /// The first error of the device.
    error: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Opens a device for pictures up to this size.
    pub(super) fn open(size_px: [u32; 2]) -> Result<Self, String> {
        pollster::block_on(Self::open_async(size_px))
    }

    async fn open_async(size_px: [u32; 2]) -> Result<Self, String> {
        // OpenGL only if asked for or if there is nothing else: its drivers print on standard error.
        let asked = wgpu::Backends::from_env();
        let adapter = match adapter(asked.unwrap_or(wgpu::Backends::PRIMARY)).await {
            Err(_) if asked.is_none() && std::env::var_os(ADAPTER_NAME).is_none() => adapter(wgpu::Backends::GL).await,
            result => result,
        }?;
        let info = adapter.get_info();
        let name = format!("{} ({})", info.name, info.backend);
        let mut required_limits = Renderer::required_limits();
        let side = size_px[0].max(size_px[1]);
        required_limits.max_texture_dimension_2d = required_limits.max_texture_dimension_2d.max(side);
        if side > adapter.limits().max_texture_dimension_2d {
            let most = adapter.limits().max_texture_dimension_2d;
            return Err(format!("the GPU ({name}) draws at most {most} by {most} pixels; use a smaller --size"));
        }
        let descriptor =
            wgpu::DeviceDescriptor { label: Some("tellus"), required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) =
            adapter.request_device(&descriptor).await.map_err(|error| format!("the GPU ({name}): {error}"))?;
        let error = Arc::new(Mutex::new(None));
        let first = Arc::clone(&error);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            first.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
        }));
        Ok(Self { device, queue, name, error })
    }

    /// Draws a texture by `draw`. Gives its rows of RGBA bytes from the top.
    pub(super) fn picture(
        &self,
        size_px: [u32; 2],
        draw: impl FnOnce(&wgpu::TextureView) -> Result<(), String>,
    ) -> Result<Vec<u8>, String> {
        let [width, height] = size_px;
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        draw(&texture.create_view(&wgpu::TextureViewDescriptor::default()))?;

        // wgpu needs rows in a buffer that begin at multiples of 256 bytes.
        let row_bytes = width * 4;
        let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(padded_bytes) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_bytes), rows_per_image: Some(height) };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            size,
        );
        self.queue.submit([encoder.finish()]);
        let (send, receive) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            let _ = send.send(result);
        });
        let failed = |error: &dyn std::fmt::Display| match self.first_error() {
            Some(first) => format!("the GPU ({}): {first}", self.name),
            None => format!("the GPU ({}): {error}", self.name),
        };
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        receive.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        if let Some(first) = self.first_error() {
            return Err(format!("the GPU ({}): {first}", self.name));
        }
        let mapped = buffer.get_mapped_range(..).map_err(|error| failed(&error))?;
        Ok(mapped.chunks(padded_bytes as usize).flat_map(|row| &row[..row_bytes as usize]).copied().collect())
    }

    fn first_error(&self) -> Option<String> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

async fn adapter(backends: wgpu::Backends) -> Result<wgpu::Adapter, String> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    // wgpu's own helper panics if there is no adapter of that name.
    if let Ok(wanted) = std::env::var(ADAPTER_NAME) {
        let adapters = instance.enumerate_adapters(backends).await;
        let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        let named = |adapter: &wgpu::Adapter| adapter.get_info().name.to_lowercase().contains(&wanted.to_lowercase());
        return adapters
            .into_iter()
            .find(named)
            .ok_or_else(|| format!("no GPU is called like {ADAPTER_NAME}={wanted}; there is: {}", names.join(", ")));
    }
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::from_env().unwrap_or(wgpu::PowerPreference::HighPerformance),
        ..wgpu::RequestAdapterOptions::default()
    };
    instance.request_adapter(&options).await.map_err(|error| {
        format!(
            "no GPU that wgpu can use; install a Vulkan driver (Debian, Ubuntu: mesa-vulkan-drivers, which also draws \
             without a GPU): {error}"
        )
    })
}
