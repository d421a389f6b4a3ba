//! The editor: shape a planet with live sliders and look at it.
//!
//! Views read the state and send commands; handlers change the state.
//!
//! - [`app`]: the eframe application: the order of a frame
//! - [`gesture`]: when a gesture ends
//! - [`late_input`]: input that waits for a later frame
//! - [`command`]: the messages from views to handlers; [`commands`]: the table of commands; [`apply`]: carries them out
//! - [`state`]: the document, its undo steps, questions, notices, the working copy
//! - [`handlers`]: the effects of the commands
//! - [`files`]: file dialogs, changes on disk, other windows
//! - [`finder`]: finding things by name: what the finder searches, locations as text
//! - [`views`]: menus, status bar, questions, windows
//! - [`panels`], [`widgets`]: the side panel; the rows it is made of
//! - [`painter`]: painting the biome table, apart from any widget
//! - [`viewport`]: the picture, the camera, the measurements

pub mod app;
pub mod apply;
pub mod command;
pub mod commands;
pub mod files;
pub mod finder;
pub mod gesture;
pub mod handlers;
pub mod late_input;
pub mod painter;
pub mod panels;
pub mod state;
pub mod viewport;
pub mod views;
pub mod widgets;

pub use app::EditorApp;

use crate::render::Renderer;
use crate::terrain::MapStore;
use eframe::{egui, egui_wgpu};
use files::crash::{self, Doing};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The name of the editor for the desktop, and of the folder that keeps the layout.
const APP_ID: &str = "tellus";

/// The environment variable of an editor that another one started because its graphics device was lost.
const RESTARTED: &str = "TELLUS_RESTARTED";

/// Opens the editor's window, with a preset if one is given, and stays until it is closed. `maps`: where solved world
/// maps are kept.
pub fn run(path: Option<PathBuf>, maps: Option<Arc<MapStore>>) -> Result<(), String> {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Tellus")
            .with_app_id(APP_ID)
            .with_inner_size([1240.0, 700.0])
            .with_min_inner_size([800.0, 500.0])
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: wgpu_configuration(),
        ..Default::default()
    };
    let folder = folder();
    let doing = Doing::default();
    if let Some(folder) = &folder {
        crash::report_panics(folder, &doing);
    }
    let create = |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        let app = EditorApp::new(cc, path.clone(), maps).tell(doing).watch_device(cc, restarts(path));
        let app = match folder {
            Some(folder) => app.with_recovery(&folder),
            None => app,
        };
        let follows_loss = std::env::var_os(RESTARTED).is_some();
        Ok(Box::new(if follows_loss { app.continue_after_loss() } else { app }))
    };
    eframe::run_native(APP_ID, options, Box::new(create)).map_err(|error| explain(&error))
}

/// The folder of the editor's own files: layout, working copies, reports and log. None where the system has none.
pub fn folder() -> Option<PathBuf> {
    eframe::storage_dir(APP_ID)
}

/// Starts another editor with the same file, and ends this process.
fn restarts(path: Option<PathBuf>) -> impl FnMut() -> Result<(), String> {
    let started = Instant::now();
    move || {
        may_restart(std::env::var_os(RESTARTED).is_some(), started.elapsed())?;
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut command = std::process::Command::new(program);
        command.args(&path).env(RESTARTED, "1").spawn().map_err(|error| error.to_string())?;
        std::process::exit(0)
    }
}

/// Whether the editor can begin with this file: it can be read, or a new planet can be saved under its name.
///
/// # Errors
/// What is wrong with the file, and what would be right.
pub fn check_first(path: &Path) -> Result<(), String> {
    if handlers::system::is_system(path) {
        return state::system::OpenSystem::file(path.to_owned()).map(drop);
    }
    handlers::opening::first_document(path).map(drop).map_err(|error| error.to_string())
}

/// eframe's device, with the limits the renderer asks for.
fn wgpu_configuration() -> egui_wgpu::WgpuConfiguration {
    let mut configuration =
        egui_wgpu::WgpuConfiguration::default().with_surface_config(egui_wgpu::SurfaceConfig::LOW_LATENCY);
    if let egui_wgpu::WgpuSetup::CreateNew(setup) = &mut configuration.wgpu_setup {
        // An adapter of OpenGL would open a window without a planet.
        setup.instance_descriptor.backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
        setup.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
            label: Some("tellus"),
            required_limits: wgpu::Limits {
                // egui draws to the whole window, which may be larger than any texture of the renderer.
                max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
                ..Renderer::required_limits()
            },
            // Small blocks: those of a large window are given back with it.
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        });
    }
    configuration
}

/// Time after a restart within which a lost device starts no further editor.
const SOON: Duration = Duration::from_secs(60);

/// Whether an editor whose device was lost may start another one: a device that is lost again and again would start
/// editors for ever.
fn may_restart(follows_loss: bool, ran: Duration) -> Result<(), String> {
    if follows_loss && ran < SOON {
        return Err("It was lost again right after a restart. Update its driver, or choose another adapter with \
                    WGPU_ADAPTER_NAME. Unsaved work is offered at the next start."
            .to_owned());
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_is_lost_again_and_again_starts_one_editor() {
        let secs = Duration::from_secs;
        assert!(may_restart(false, secs(0)).is_ok(), "the first loss");
        assert!(may_restart(true, secs(5)).unwrap_err().contains("lost again"));
        assert!(may_restart(true, secs(3600)).is_ok(), "another loss, an hour later");
    }
}
