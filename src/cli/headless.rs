//! A GPU without a window: adapter, device, and pictures read back from them.
//!
//! The adapter is selected by wgpu's environment variables (`WGPU_BACKEND`, `WGPU_ADAPTER_NAME`, `WGPU_POWER_PREF`).

use crate::render::{Renderer, read_texture, texture};
use std::sync::{Arc, Mutex, PoisonError};

/// Format of pictures.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// wgpu's variable with a part of the name of the adapter to use.
const ADAPTER_NAME: &str = "WGPU_ADAPTER_NAME";

/// An open device.
pub(super) struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    /// Name of adapter and backend, for messages.
    pub(super) name: String,
    /// The first uncaptured error of the device.
    error: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Opens a device for pictures up to a size.
    pub(super) fn open(size_px: [u32; 2]) -> Result<Self, String> {
        pollster::block_on(Self::open_async(size_px))
    }

    async fn open_async(size_px: [u32; 2]) -> Result<Self, String> {
        let adapter = adapter(wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY)).await?;
        let info = adapter.get_info();
        let name = format!("{} ({})", info.name, info.backend);
        if !Renderer::can_use(&adapter) {
            return Err(format!(
                "the GPU ({name}) cannot draw what the renderer needs; use Vulkan, Metal or DirectX 12 \
                 (Debian, Ubuntu: mesa-vulkan-drivers, which also draws without a GPU)"
            ));
        }
        let mut required_limits = Renderer::required_limits();
        let side = size_px[0].max(size_px[1]);
        required_limits.max_texture_dimension_2d = required_limits.max_texture_dimension_2d.max(side);
        if side > adapter.limits().max_texture_dimension_2d {
            let most = adapter.limits().max_texture_dimension_2d;
            return Err(format!("the GPU ({name}) draws at most {most} by {most} pixels; use a smaller --size"));
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("tellus"),
            required_limits,
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) =
            adapter.request_device(&descriptor).await.map_err(|error| format!("the GPU ({name}): {error}"))?;
        let error = Arc::new(Mutex::new(None));
        let first = Arc::clone(&error);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            first.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
        }));
        Ok(Self { device, queue, name, error })
    }

    /// Draws a picture with `draw` and returns it as rows of RGBA bytes, from the top.
    pub(super) fn picture(
        &self,
        size_px: [u32; 2],
        draw: impl FnOnce(&wgpu::TextureView) -> Result<(), String>,
    ) -> Result<Vec<u8>, String> {
        self.checked(|| {
            let texture = texture(&self.device, "picture", size_px, FORMAT);
            draw(&texture.create_view(&wgpu::TextureViewDescriptor::default()))?;
            read_texture(&self.device, &self.queue, &texture)
                .map_err(|error| format!("the GPU ({}): {error}", self.name))
        })
    }

    /// Does something with the device; its first uncaptured error counts as a failure.
    pub(super) fn checked<T>(&self, work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
        let result = work();
        match self.first_error() {
            Some(first) => Err(format!("the GPU ({}): {first}", self.name)),
            None => result,
        }
    }

    fn first_error(&self) -> Option<String> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

async fn adapter(backends: wgpu::Backends) -> Result<wgpu::Adapter, String> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    // wgpu's own helper panics when no adapter has the requested name.
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
