//! The real editor without a window, and what its tests do with it.
#![allow(dead_code, unreachable_pub, clippy::panic)]

use eframe::egui;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tellus::editor::EditorApp;
use tellus::editor::files::dialogs::{FileDialogs, ScriptedDialogs};
use tellus::planet::Planet;

pub type Editor = Harness<'static, EditorApp>;

/// An editor in a window of a size, a few frames old; file dialogs give these answers.
pub fn open(size: [f32; 2], answers: Vec<Option<PathBuf>>) -> Editor {
    open_at_rate(size, answers, 60.0)
}

/// The same with so many frames to a second.
pub fn open_at_rate(size: [f32; 2], answers: Vec<Option<PathBuf>>, frames_per_sec: f32) -> Editor {
    let mut harness = Harness::builder()
        .with_size(egui::Vec2::from(size))
        .with_step_dt(1.0 / frames_per_sec)
        .wgpu()
        .build_eframe(|cc| EditorApp::new(cc, None).with_dialogs(Box::new(ScriptedDialogs::new(answers))));
    harness.run_steps(4);
    harness
}

/// An editor that begins with a file, asks for others through these dialogs, and keeps what it must in a folder.
pub fn open_file(file: Option<&Path>, dialogs: impl FileDialogs + 'static, recovery: &Path) -> Editor {
    let (file, recovery) = (file.map(Path::to_owned), recovery.to_owned());
    let mut harness = Harness::builder()
        .with_size([1024.0, 640.0])
        .with_step_dt(1.0 / 60.0)
        .wgpu()
        .build_eframe(move |cc| EditorApp::new(cc, file).with_dialogs(Box::new(dialogs)).with_recovery(&recovery));
    harness.run_steps(4);
    harness
}

/// Steps until something holds.
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

pub fn click(harness: &mut Editor, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}
