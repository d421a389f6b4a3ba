//! The application: shape a planet with live sliders and look at it.
//!
//! - [`app`]: the eframe application: what happens in a frame, in which order
//! - [`command`], [`handle`]: everything a person can tell the editor to do, and the one place that does it
//! - [`document`], [`history`], [`describe`]: the planet being edited, undo steps, changes in words
//! - [`files`], [`answers`], [`dialogs`], `path_field`, `file_names`, [`prompts`], [`recovery`]: opening and saving
//!   without losing work, even in a crash
//! - [`disk`], [`claim`]: others who write the open file, or have it open
//! - `notices`: what the editor says by itself
//! - [`viewport`]: the picture, the camera, the measurements
//! - [`pictures`]: pictures of height maps, read in the background
//! - [`bookmarks`]: views kept in the preset
//! - [`painter`]: painting the biome table, apart from any widget; `table_files`: import and export
//! - [`panels`], [`widgets`]: the side panel; the rows it is made of
//! - [`menus`], [`status`], [`controls`], [`performance`], [`look`]: the rest of the window

pub mod answers;
pub mod app;
pub mod bookmarks;
pub mod claim;
pub mod command;
pub mod controls;
pub mod describe;
pub mod dialogs;
pub mod disk;
pub mod document;
mod file_names;
pub mod files;
pub mod handle;
pub mod history;
pub mod look;
pub mod menus;
mod notices;
pub mod painter;
pub mod panels;
mod path_field;
pub mod performance;
pub mod pictures;
pub mod prompts;
pub mod recovery;
pub mod status;
mod table_files;
pub mod viewport;
pub mod widgets;

pub use app::EditorApp;

use crate::render::Renderer;
use eframe::{egui, egui_wgpu};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What the desktop and the layout's folder know the editor by.
const APP_ID: &str = "tellus";

/// Opens the editor's window, with a preset if one is given, and stays until it is closed.
pub fn run(path: Option<PathBuf>) -> Result<(), String> {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Tellus")
            .with_app_id(APP_ID)
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([720.0, 480.0])
            .with_min_inner_size([800.0, 500.0])
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: wgpu_configuration(),
        ..Default::default()
    };
    let create = |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        let app = EditorApp::new(cc, path);
        Ok(Box::new(match eframe::storage_dir(APP_ID) {
            Some(folder) => app.with_recovery(&folder),
            None => app,
        }))
    };
    eframe::run_native(APP_ID, options, Box::new(create)).map_err(|error| explain(&error))
}

/// Whether the editor can begin with this file: it can be read, or a new planet can be saved under its name.
///
/// # Errors
/// What is wrong with it, and what would be right.
pub fn check_first(path: &Path) -> Result<(), String> {
    files::first_document(path).map(drop).map_err(|error| error.to_string())
}

/// eframe's device, with the limits the renderer asks for.
fn wgpu_configuration() -> egui_wgpu::WgpuConfiguration {
    let mut configuration =
        egui_wgpu::WgpuConfiguration::default().with_surface_config(egui_wgpu::SurfaceConfig::LOW_LATENCY);
    if let egui_wgpu::WgpuSetup::CreateNew(setup) = &mut configuration.wgpu_setup {
        setup.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
            label: Some("tellus"),
            required_limits: wgpu::Limits {
                // The window may be larger than the renderer's own textures ever are.
                max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
                ..Renderer::required_limits()
            },
            ..Default::default()
        });
    }
    configuration
}

fn explain(error: &eframe::Error) -> String {
    match error {
        eframe::Error::Wgpu(error) => format!(
            "no usable graphics adapter: {error}\n\
             Tellus needs Vulkan, Metal or DirectX 12. Without a graphics card, Mesa's software Vulkan will do: \
             on Debian and Ubuntu it is the package mesa-vulkan-drivers."
        ),
        other => format!("the window could not be opened: {other}"),
    }
}
