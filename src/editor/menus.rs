//! The menu bar. Menus only send commands.

use super::app::EditorApp;
use super::bookmarks;
use super::command::Command;
use super::handle::Action;
use super::viewport::ViewSettings;
use super::viewport::camera::Mode;
use super::widgets::icon::{Icon, icon_button};
use super::widgets::menu_button;
use super::widgets::typed::{Allowed, plain_field};
use crate::lod::Quality;
use crate::planet::param::Unit;
use crate::planet::shipped;
use crate::render::{DebugView, Tone};
use eframe::egui;

/// Shows the bar: menus to the left, time and the document's name to the right.
pub fn show(ui: &mut egui::Ui, app: &mut EditorApp) {
    egui::MenuBar::new().ui(ui, |ui| {
        menu_button(ui, "File", |ui| {
            for command in [Command::New, Command::Open] {
                entry(ui, app, command, true, None);
            }
            ui.separator();
            let savable = app.document.is_dirty() || app.document.disk_bytes().is_none();
            entry(ui, app, Command::Save, savable, None);
            entry(ui, app, Command::SaveAs, true, None);
            ui.separator();
            entry(ui, app, Command::Quit, true, None);
        });
        menu_button(ui, "Edit", |ui| {
            let (undo, redo) = (app.document.history().undo_label(), app.document.history().redo_label());
            let undo = undo.map(|label| format!("Undo: {}", lower_first(label)));
            let redo = redo.map(|label| format!("Redo: {}", lower_first(label)));
            entry(ui, app, Command::Undo, undo.is_some(), undo);
            entry(ui, app, Command::Redo, redo.is_some(), redo);
        });
        menu_button(ui, "View", |ui| view(ui, app));
        menu_button(ui, "Camera", |ui| camera(ui, app));
        menu_button(ui, "Bookmarks", |ui| bookmarks::menu(ui, app));
        menu_button(ui, "Planets", |ui| {
            for (index, preset) in shipped::ALL.iter().enumerate() {
                if ui.button(readable(preset.file)).clicked() {
                    app.actions.push(Action::OpenShipped(index));
                    ui.close();
                }
            }
            ui.separator();
            entry(ui, app, Command::RandomPlanet, true, None);
        });
        menu_button(ui, "Help", |ui| entry(ui, app, Command::Controls, true, None));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            time(ui, app);
            ui.separator();
            ui.add(egui::Label::new(egui::RichText::new(app.document.title()).weak()).truncate());
        });
    });
}

/// A button for a command, with its shortcut.
pub(super) fn entry(ui: &mut egui::Ui, app: &mut EditorApp, command: Command, enabled: bool, label: Option<String>) {
    let label = label.unwrap_or_else(|| command.label().to_owned());
    let mut button = egui::Button::new(label);
    if let Some(shortcut) = command.shortcuts().first() {
        button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
    }
    if ui.add_enabled(enabled, button).on_hover_text(command.tooltip()).clicked() {
        app.send(command);
        ui.close();
    }
}

/// The same for one of several commands, or for one that is on or off.
fn choice(ui: &mut egui::Ui, app: &mut EditorApp, command: Command, chosen: bool) {
    let mut button = egui::Button::selectable(chosen, command.label());
    if let Some(shortcut) = command.shortcuts().first() {
        button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
    }
    if ui.add(button).on_hover_text(command.tooltip()).clicked() {
        app.send(command);
        ui.close();
    }
}

fn camera(ui: &mut egui::Ui, app: &mut EditorApp) {
    let (mode, dives) = (app.viewport.cameras().mode(), app.viewport.cameras().dives());
    for other in Mode::ALL {
        choice(ui, app, Command::Move(other), mode == other);
    }
    ui.separator();
    choice(ui, app, Command::Dive, dives);
    entry(ui, app, Command::LevelView, mode == Mode::Fly, None);
    entry(ui, app, Command::ResetView, true, None);
}

fn view(ui: &mut egui::Ui, app: &mut EditorApp) {
    let settings: ViewSettings = app.viewport.settings;
    for view in DebugView::ALL {
        choice(ui, app, Command::Show(view), settings.debug_view == view);
    }
    ui.separator();
    choice(ui, app, Command::FreezeDetail, settings.freeze_detail);
    ui.separator();
    ui.menu_button(format!("Quality: {}", settings.quality.label().to_lowercase()), |ui| {
        for quality in Quality::ALL {
            if ui.radio(settings.quality == quality, quality.label()).clicked() {
                app.actions.push(Action::Quality(quality));
                ui.close();
            }
        }
    });
    let tones = ui.menu_button(format!("Tones: {}", settings.tone.label()), |ui| {
        for tone in Tone::ALL {
            if ui.radio(settings.tone == tone, tone.label()).clicked() {
                app.viewport.settings.tone = tone;
                ui.close();
            }
        }
    });
    tones.response.on_hover_text("The curve from light to the picture: like film, colours as they are, or none");
    ui.horizontal(|ui| {
        let label = ui.label("Exposure");
        let told = "Brightness of the picture in stops; not part of the planet";
        let slider = egui::Slider::new(&mut app.viewport.settings.exposure_ev, -8.0..=8.0).show_value(false);
        ui.add(slider).labelled_by(label.id).on_hover_text(told);
        let allowed = Allowed::numbers(Unit::None, -8.0, 8.0).marked(" EV");
        plain_field(ui, &mut app.viewport.settings.exposure_ev, 0.02, 3, allowed)
            .on_hover_text(told)
            .accessible_name("Exposure as a number");
        ui.checkbox(&mut app.viewport.settings.auto_exposure, "Automatic").on_hover_text(
            "Exposure follows what there is to see, and the slider corrects it; off, the slider alone decides",
        );
    });
    ui.separator();
    for command in [Command::TogglePanel, Command::TogglePerformance, Command::ToggleFullscreen, Command::ToggleTheme] {
        entry(ui, app, command, true, None);
    }
}

/// Right to left: speed, then the button.
fn time(ui: &mut egui::Ui, app: &mut EditorApp) {
    let settings = &mut app.viewport.settings;
    let allowed = Allowed::numbers(Unit::None, -86_400.0, 86_400.0).marked("×");
    plain_field(ui, &mut settings.time_speed, 20.0, 6, allowed)
        .on_hover_text("Speed of time: 3600 is an hour of the planet for each second")
        .accessible_name("Speed of time");
    let (icon, name) = if settings.playing { (Icon::Pause, "Pause time") } else { (Icon::Play, "Play time") };
    if icon_button(ui, icon, name, Command::PlayPause.tooltip()).clicked() {
        app.send(Command::PlayPause);
    }
}

fn readable(file: &str) -> String {
    let stem = file.trim_end_matches(".ron").replace(['-', '_'], " ");
    let mut chars = stem.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_lowercase().chain(chars).collect())
}
