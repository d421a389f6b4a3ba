//! The real editor without a window, and the steps of its tests.
#![allow(dead_code, unreachable_pub, clippy::panic)]

use crate::layered::layered;
use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui_wgpu::{self, RenderState, RendererOptions};
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use egui_kittest::{Harness, HarnessBuilder};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};
use tellus::editor::EditorApp;
use tellus::editor::command::Command;
use tellus::editor::files::dialogs::{FileDialogs, NoDialogs, ScriptedDialogs};
use tellus::editor::viewport::pointer::KnownPlace;
use tellus::planet::Planet;
use tellus::render::Renderer;

/// Pixels for each point where no test looks at the picture: the software driver takes most of the time of a test.
const COARSE: f32 = 0.5;

pub type Editor = Harness<'static, EditorApp>;

/// An editor in a window of this size, after a few frames; file dialogs give these answers. It has no graphics device:
/// a picture of the planet would take most of the time of a test.
pub fn open(size: [f32; 2], answers: Vec<Option<PathBuf>>) -> Editor {
    start(Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 60.0), scripted(answers))
}

/// The same with a picture.
pub fn open_with_picture(size: [f32; 2], answers: Vec<Option<PathBuf>>) -> Editor {
    open_at_rate(size, answers, 60.0)
}

/// An editor with this number of frames a second.
pub fn open_at_rate(size: [f32; 2], answers: Vec<Option<PathBuf>>, frames_per_sec: f32) -> Editor {
    open_drawn(size, answers, frames_per_sec, COARSE)
}

/// An editor that is drawn, without a picture of a planet.
pub fn open_without_planet(size: [f32; 2]) -> Editor {
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 60.0);
    start(builder.renderer(WgpuTestRenderer::from_render_state(render_state())), |cc| {
        cc.wgpu_render_state = None;
        EditorApp::with_planet(cc, layered(), None, None).with_dialogs(Box::new(NoDialogs))
    })
}

/// An editor that is drawn with this many pixels for each point of the user interface.
pub fn open_drawn(size: [f32; 2], answers: Vec<Option<PathBuf>>, frames_per_sec: f32, pixels_per_point: f32) -> Editor {
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / frames_per_sec);
    let builder = builder.with_pixels_per_point(pixels_per_point);
    start(builder.renderer(WgpuTestRenderer::from_render_state(render_state())), scripted(answers))
}

/// An editor without a picture that starts with a file, asks through these dialogs, and keeps its working copy in a
/// folder.
pub fn open_file(file: Option<&Path>, dialogs: impl FileDialogs + 'static, recovery: &Path) -> Editor {
    let (file, recovery) = (file.map(Path::to_owned), recovery.to_owned());
    start(Harness::builder().with_size(egui::vec2(1024.0, 640.0)).with_step_dt(1.0 / 60.0), move |cc| {
        EditorApp::with_planet(cc, layered(), file, None).with_dialogs(Box::new(dialogs)).with_recovery(&recovery)
    })
}

/// An editor with a picture that starts with a file, with this number of frames a second.
pub fn open_file_with_picture(size: [f32; 2], file: &Path, frames_per_sec: f32) -> Editor {
    let file = file.to_owned();
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / frames_per_sec);
    let builder = builder.with_pixels_per_point(COARSE).renderer(WgpuTestRenderer::from_render_state(render_state()));
    start(builder, move |cc| EditorApp::with_planet(cc, layered(), Some(file), None).with_dialogs(Box::new(NoDialogs)))
}

/// The same without a file, with an answer to the loss of its graphics device.
pub fn open_watched(recovery: &Path, restart: impl FnMut() -> Result<(), String> + 'static) -> Editor {
    let recovery = recovery.to_owned();
    start(Harness::builder().with_size(egui::vec2(1024.0, 640.0)).with_step_dt(1.0 / 60.0), move |cc| {
        let app = EditorApp::with_planet(cc, layered(), None, None).watch_device(cc, restart);
        app.with_dialogs(Box::new(NoDialogs)).with_recovery(&recovery)
    })
}

/// The editor that takes over the work of one that lost its graphics device.
pub fn open_after_loss(recovery: &Path) -> Editor {
    let recovery = recovery.to_owned();
    start(Harness::builder().with_size(egui::vec2(1024.0, 640.0)).with_step_dt(1.0 / 60.0), move |cc| {
        let app = EditorApp::with_planet(cc, layered(), None, None).with_dialogs(Box::new(NoDialogs));
        app.with_recovery(&recovery).continue_after_loss()
    })
}

/// An editor with a picture that has run before, and kept this text under a key.
pub fn open_stored(size: [f32; 2], key: &'static str, text: String) -> Editor {
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 8.0);
    let builder = builder.with_pixels_per_point(COARSE).renderer(WgpuTestRenderer::from_render_state(render_state()));
    start(builder, move |cc| {
        // The context borrows it for as long as the editor may run.
        cc.storage = Some(Box::leak(Box::new(Stored { key, text })));
        EditorApp::with_planet(cc, layered(), None, None).with_dialogs(Box::new(NoDialogs))
    })
}

/// What eframe keeps between runs: one text, and that the editor has run.
struct Stored {
    key: &'static str,
    text: String,
}

impl eframe::Storage for Stored {
    fn get_string(&self, key: &str) -> Option<String> {
        match key {
            "tellus_toured" => Some("yes".to_owned()),
            _ => (key == self.key).then(|| self.text.clone()),
        }
    }

    fn set_string(&mut self, _: &str, _: String) {}

    fn remove_string(&mut self, _: &str) {}

    fn flush(&mut self) {}
}

fn scripted(answers: Vec<Option<PathBuf>>) -> impl FnOnce(&mut eframe::CreationContext<'_>) -> EditorApp {
    move |cc| EditorApp::with_planet(cc, layered(), None, None).with_dialogs(Box::new(ScriptedDialogs::new(answers)))
}

fn start(
    builder: HarnessBuilder<EditorApp>,
    app: impl FnOnce(&mut eframe::CreationContext<'_>) -> EditorApp,
) -> Editor {
    let mut harness = builder.build_eframe(app);
    // On a software driver each sample of a still picture takes as long as a test.
    harness.state_mut().viewport_mut().settings.refine = false;
    harness.run_steps(4);
    harness
}

/// The device that all editors of a binary share, and a renderer that lends them its pipelines: on a software driver
/// these take longer to compile than most tests.
fn render_state() -> RenderState {
    static FIRST: LazyLock<(RenderState, Renderer)> = LazyLock::new(|| {
        let state = create_render_state(default_wgpu_setup(), RendererOptions::PREDICTABLE);
        let renderer = Renderer::new(&state.device, &state.queue).unwrap_or_else(|error| panic!("{error}"));
        (state, renderer)
    });
    let (state, renderer) = &*FIRST;
    let mut egui = egui_wgpu::Renderer::new(&state.device, state.target_format, RendererOptions::PREDICTABLE);
    egui.callback_resources.insert(renderer.sibling());
    RenderState { renderer: Arc::new(egui::mutex::RwLock::new(egui)), ..state.clone() }
}

/// An editor with a picture of a planet.
pub fn open_planet_with_picture(size: [f32; 2], planet: Planet) -> Editor {
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 60.0);
    let builder = builder.with_pixels_per_point(COARSE).renderer(WgpuTestRenderer::from_render_state(render_state()));
    start(builder, move |cc| EditorApp::with_planet(cc, planet, None, None))
}

/// The same, with these answers of file dialogs.
pub fn open_planet_with_answers(size: [f32; 2], planet: Planet, answers: Vec<Option<PathBuf>>) -> Editor {
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 60.0);
    let builder = builder.with_pixels_per_point(COARSE).renderer(WgpuTestRenderer::from_render_state(render_state()));
    let dialogs = Box::new(ScriptedDialogs::new(answers));
    start(builder, move |cc| EditorApp::with_planet(cc, planet, None, None).with_dialogs(dialogs))
}

/// An editor without a picture of a planet.
pub fn open_planet(size: [f32; 2], planet: Planet) -> Editor {
    let builder = Harness::builder().with_size(egui::Vec2::from(size)).with_step_dt(1.0 / 60.0);
    start(builder, move |cc| EditorApp::with_planet(cc, planet, None, None))
}

/// Types a text into the field with the focus.
pub fn type_text(harness: &mut Editor, text: &str) {
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(3);
}

/// Steps until a condition holds.
pub fn until(harness: &mut Editor, what: &str, holds: impl Fn(&Editor) -> bool) {
    const PATIENCE: Duration = Duration::from_secs(120);
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE {
        harness.step();
        if holds(harness) {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("never: {what}");
}

/// Steps until the picture is complete.
pub fn wait_for_picture(harness: &mut Editor) {
    until(harness, "a complete picture", |harness| {
        let viewport = harness.state().viewport();
        viewport.surface().is_some_and(|surface| surface.complete) && !viewport.is_busy()
    });
    harness.run_steps(3);
}

pub fn planet(harness: &Editor) -> Planet {
    (**harness.state().document().planet()).clone()
}

pub fn undo_label(harness: &Editor) -> String {
    harness.state().document().history().undo_label().unwrap_or_default().to_owned()
}

pub fn undo_len(harness: &Editor) -> usize {
    harness.state().document().history().undo_len()
}

/// Drags from one point of the window to another.
pub fn drag(harness: &mut Editor, from: egui::Pos2, to: egui::Pos2) {
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(to);
    harness.run_steps(2);
    harness.drop_at(to);
    harness.run_steps(3);
}

/// Drags the row of a list with the first label to below the row with the second.
pub fn drag_row_below(harness: &mut Editor, row: &str, other: &str) {
    let from = harness.get_by_label(row).rect().center();
    let to = harness.get_by_label(other).rect().center_bottom() - egui::vec2(0.0, 2.0);
    drag(harness, from, to);
}

/// Asks for a command, and steps until it is carried out.
pub fn send(harness: &mut Editor, command: Command) {
    harness.state_mut().send(command);
    harness.run_steps(4);
}

/// Scrolls to the widget with this label.
pub fn scroll_to(harness: &mut Editor, label: &str) {
    harness.get_by_label(label).scroll_to_me();
    harness.run_steps(40);
}

/// Moves the pointer to the middle of the picture. Gives the ground there.
pub fn point_at_planet(harness: &mut Editor) -> KnownPlace {
    harness.hover_at(canvas(harness).center());
    until(harness, "the ground is known", |harness| harness.state().viewport().under_pointer().is_some());
    harness.state().viewport().under_pointer().cloned().unwrap_or_else(|| panic!("the ground is known"))
}

/// The picture of the planet on screen.
pub fn canvas(harness: &Editor) -> egui::Rect {
    harness.get_by_role_and_label(Role::Canvas, "View of the planet").rect()
}

/// Whether a button is disabled.
pub fn is_disabled(harness: &Editor, label: &str) -> bool {
    use egui_kittest::kittest::NodeT as _;
    harness.get_by_label(label).accesskit_node().is_disabled()
}

/// Unfolds a section of the open tab. Lists above it may have rows of the same name.
pub fn unfold(harness: &mut Editor, title: &str) {
    harness.get_all_by_label(title).last().unwrap().scroll_to_me();
    harness.run_steps(40);
    harness.get_all_by_label(title).last().unwrap().click();
    harness.run_steps(40);
}

pub fn click(harness: &mut Editor, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}
