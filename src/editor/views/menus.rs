//! The menu bar, made from the table of commands. Menus only send commands.

use crate::editor::command::{Action, BookmarkAction, Command, Commands, Setting};
use crate::editor::commands::{self, Menu, Row};
use crate::editor::files::file_names::readable_stem;
use crate::editor::state::State;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::editor::widgets::{keys_text, menu_button};
use crate::lod::Quality;
use crate::planet::param::Unit;
use crate::planet::shipped;
use crate::render::{Post, Tone};
use eframe::egui;
use std::path::{Path, PathBuf};

/// Range of the exposure slider, in stops.
const EXPOSURE_EV: f64 = 8.0;
/// Fastest time, in seconds of the planet for each second: a day of 24 hours.
const MAX_TIME_SPEED: f64 = 86_400.0;

/// Shows the bar: menus to the left, time and the document's name to the right.
pub fn show(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    egui::MenuBar::new().ui(ui, |ui| {
        for menu in Menu::ALL {
            menu_button(ui, menu.label(), |ui| {
                for (i, group) in commands::menu_groups(menu).iter().enumerate() {
                    if i > 0 {
                        ui.separator();
                    }
                    if menu == Menu::View && i == 0 {
                        debug_views(ui, state, commands, group);
                    } else {
                        group.iter().for_each(|row| entry(ui, state, commands, row));
                    }
                    if i == 0 && menu == Menu::File {
                        recent(ui, state, commands);
                    }
                }
                match menu {
                    Menu::View => settings(ui, state, commands),
                    Menu::Bookmarks => bookmarks(ui, state, commands),
                    Menu::Planets => planets(ui, commands),
                    Menu::File | Menu::Edit | Menu::Camera | Menu::Sculpt | Menu::Help => {}
                }
            });
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            time(ui, state, commands);
            ui.separator();
            ui.add(egui::Label::new(egui::RichText::new(state.document.title()).weak()).truncate());
        });
    });
}

/// The button of a command, with its shortcut; highlighted if it makes the current setting.
fn entry(ui: &mut egui::Ui, state: &State, commands: &mut Commands, row: &Row) {
    let label = row.label_now(state);
    let mut button = match row.is_chosen(state) {
        Some(chosen) => egui::Button::selectable(chosen, label),
        None => egui::Button::new(label),
    };
    if let Some(shortcut) = row.shortcuts.first() {
        button = button.shortcut_text(keys_text(ui.ctx(), shortcut));
    }
    if ui.add_enabled(row.is_enabled(state), button).on_hover_text(row.tooltip).clicked() {
        commands.send(row.command);
        ui.close();
    }
}

/// The debug views in a menu of their own: there are too many for one.
fn debug_views(ui: &mut egui::Ui, state: &State, commands: &mut Commands, rows: &[&Row]) {
    let now = state.viewport.settings.debug_view.label().to_lowercase();
    ui.menu_button(format!("Show: {now}"), |ui| rows.iter().for_each(|row| entry(ui, state, commands, row)))
        .response
        .on_hover_text("The planet as it looks, or one of its quantities in colours");
}

fn planets(ui: &mut egui::Ui, commands: &mut Commands) {
    ui.separator();
    for (index, preset) in shipped::ALL.iter().enumerate() {
        if ui.button(readable_stem(Path::new(preset.file))).clicked() {
            commands.push(Action::OpenShipped(index));
            ui.close();
        }
    }
}

/// The files that were opened or saved last, without the one that is open.
fn recent(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let open = state.document.path().and_then(|path| std::path::absolute(path).ok());
    let others: Vec<&PathBuf> = state.recent.paths().iter().filter(|path| Some(*path) != open.as_ref()).collect();
    if others.is_empty() {
        return;
    }
    ui.menu_button("Open recent", |ui| {
        for path in others {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                commands.push(Action::OpenPath(path.clone()));
                ui.close();
            }
        }
        ui.separator();
        if ui.button("Clear this list").clicked() {
            commands.push(Action::ClearRecent);
            ui.close();
        }
    });
}

/// One submenu for each bookmark.
fn bookmarks(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let bookmarks = state.document.bookmarks();
    if !bookmarks.is_empty() {
        ui.separator();
    }
    for (index, bookmark) in bookmarks.iter().enumerate() {
        let submenu = ui.menu_button(&bookmark.name, |ui| {
            for (label, tooltip, action) in [
                ("Go there", "Fly to this view.", BookmarkAction::GoTo(index)),
                ("Rename…", "Give this view another name.", BookmarkAction::AskName(index)),
                ("Move here", "Replace this view with what you see now.", BookmarkAction::Update(index)),
                ("Delete", "Remove this view.", BookmarkAction::Delete(index)),
            ] {
                if ui.button(label).on_hover_text(tooltip).clicked() {
                    commands.push(Action::Bookmark(action));
                    ui.close();
                }
            }
        });
        if let Some(shortcut) = commands::row(Command::GoTo(index)).and_then(|row| row.shortcuts.first()) {
            submenu.response.on_hover_text(keys_text(ui.ctx(), shortcut));
        }
    }
}

/// Settings of the view that take a value.
fn settings(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let settings = state.viewport.settings;
    ui.separator();
    ui.menu_button(format!("Quality: {}", settings.quality.label().to_lowercase()), |ui| {
        for quality in Quality::ALL {
            if ui.radio(settings.quality == quality, quality.label()).clicked() {
                commands.push(Action::Set(Setting::Quality(quality)));
                ui.close();
            }
        }
    });
    let mut refine = settings.refine;
    let told = "Still pictures get finer while you touch nothing, and clouds are carried over from picture to picture \
                while the camera moves; off, each picture is drawn by itself";
    if ui.checkbox(&mut refine, "Refine pictures").on_hover_text(told).changed() {
        commands.push(Action::Set(Setting::Refine(refine)));
    }
    let tones = ui.menu_button(format!("Tones: {}", settings.post.tone.label()), |ui| {
        for tone in Tone::ALL {
            if ui.radio(settings.post.tone == tone, tone.label()).clicked() {
                commands.push(Action::Set(Setting::Tone(tone)));
                ui.close();
            }
        }
    });
    tones.response.on_hover_text("The tone curve from radiance to the picture: like film, neutral, or none");
    egui::Grid::new("camera settings").num_columns(4).show(ui, |ui| {
        exposure(ui, state, commands);
        camera(ui, state, commands);
    });
}

fn exposure(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let mut automatic = state.viewport.settings.auto_exposure;
    let told = "Brightness of the picture in stops; not part of the planet";
    let allowed = Allowed::numbers(Unit::None, -EXPOSURE_EV, EXPOSURE_EV).marked(" EV");
    let of = Slider { name: "Exposure", told, allowed, range: (-EXPOSURE_EV, EXPOSURE_EV), step: 0.02 };
    if let Some(exposure_ev) = of.show(ui, state.viewport.settings.post.exposure_ev) {
        commands.push(Action::Set(Setting::ExposureEv(exposure_ev)));
    }
    let told = "The exposure follows the brightness of the picture, and the slider corrects it; off, the slider \
                alone sets it";
    if ui.checkbox(&mut automatic, "Automatic").on_hover_text(told).changed() {
        commands.push(Action::Set(Setting::AutoExposure(automatic)));
    }
    ui.end_row();
}

/// What a photographer sets besides the exposure.
fn camera(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let post = state.viewport.settings.post;
    let (least, most) = Post::WHITE_K.into_inner();
    let white_balance = Slider {
        name: "White balance",
        told: "Colour temperature that is shown white: 6504 K is the planet's daylight, lower makes the picture bluer",
        allowed: Allowed::numbers(Unit::None, least, most).marked(" K"),
        range: (2500.0, 12_000.0),
        step: 20.0,
    };
    let share = Allowed::numbers(Unit::None, 0.0, 1.0);
    let vignette = Slider {
        name: "Vignette",
        told: "How much darker the corners are than the middle",
        allowed: share,
        range: (0.0, 1.0),
        step: 0.005,
    };
    let bloom = Slider {
        name: "Bloom",
        told: "Share of the light that the lens scatters: the glow of the sun and of highlights",
        allowed: share,
        range: (0.0, 0.2),
        step: 0.001,
    };
    let white_k = (white_balance, post.white_k, Setting::WhiteK as fn(f64) -> Setting);
    for (slider, value, setting) in
        [white_k, (vignette, post.vignette, Setting::Vignette), (bloom, post.bloom, Setting::Bloom)]
    {
        commands.extend(slider.show(ui, value).map(|value| Action::Set(setting(value))));
        ui.end_row();
    }
}

/// A labelled slider with a field beside it: three cells of a grid.
struct Slider<'a> {
    name: &'static str,
    told: &'static str,
    allowed: Allowed<'a>,
    /// Range of the slider; the field may allow more.
    range: (f64, f64),
    step: f64,
}

impl Slider<'_> {
    /// The value, where it was changed.
    fn show(self, ui: &mut egui::Ui, mut value: f64) -> Option<f64> {
        let label = ui.label(self.name);
        let slider = egui::Slider::new(&mut value, self.range.0..=self.range.1).clamping(egui::SliderClamping::Edits);
        let slid = ui.add(slider.show_value(false)).labelled_by(label.id).on_hover_text(self.told);
        let typed = plain_field(ui, &mut value, self.step, 3, self.allowed)
            .on_hover_text(self.told)
            .accessible_name(format!("{} as a number", self.name));
        (slid.changed() || typed.changed()).then_some(value)
    }
}

/// Right to left: speed, then the button.
fn time(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let settings = state.viewport.settings;
    let mut time_speed = settings.time_speed;
    let allowed = Allowed::numbers(Unit::None, -MAX_TIME_SPEED, MAX_TIME_SPEED).marked("×");
    let field = plain_field(ui, &mut time_speed, 20.0, 6, allowed)
        .on_hover_text("Speed of time: 3600 is an hour of the planet for each second")
        .accessible_name("Speed of time");
    if field.changed() {
        commands.push(Action::Set(Setting::TimeSpeed(time_speed)));
    }
    let (icon, name) = if settings.playing { (Icon::Pause, "Pause time") } else { (Icon::Play, "Play time") };
    let tooltip = commands::row(Command::PlayPause).map_or("", |row| row.tooltip);
    if icon_button(ui, icon, name, tooltip).clicked() {
        commands.send(Command::PlayPause);
    }
}
