//! What all examples with a picture do: open a GPU, make a texture, save it as PNG.

#![allow(dead_code)]

use std::error::Error;
use std::path::Path;
use tellus::render::{Renderer, read_texture, wgpu};

/// What can go wrong in an example.
pub(crate) type Failure = Box<dyn Error>;

/// A device without a window; wgpu's environment variables choose the adapter.
pub(crate) fn open_gpu() -> Result<(wgpu::Device, wgpu::Queue), Failure> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let required_limits = Renderer::required_limits();
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
    Ok(pollster::block_on(adapter.request_device(&descriptor))?)
}

/// All of a texture.
pub(crate) fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Writes an `Rgba8UnormSrgb` texture as PNG.
pub(crate) fn save_png(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
    path: &Path,
) -> Result<(), Failure> {
    let pixels = read_texture(device, queue, texture)?;
    image::save_buffer(path, &pixels, texture.width(), texture.height(), image::ColorType::Rgba8)?;
    println!("{}", path.display());
    Ok(())
}

/// The file that the first argument names, or `name` in the folder for temporary files.
pub(crate) fn picture_path(name: &str) -> std::path::PathBuf {
    std::env::args_os().nth(1).map_or_else(|| std::env::temp_dir().join(name), Into::into)
}
