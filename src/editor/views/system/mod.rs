//! The window of the system: its bodies as a tree, and the time.
//!
//! - `map`: the orbits, to be dragged
//! - `body`: the parameters of the selected body
//! - `trial`: the run that shows whether the system lasts

mod body;
mod map;
mod trial;

use crate::editor::command::{Action, Commands, Setting, SystemAction, Window};
use crate::editor::files::file_names::readable_stem;
use crate::editor::state::State;
use crate::editor::state::system::OpenSystem;
use crate::editor::state::system::presets::of_document;
use crate::editor::viewport::travel::Arrival;
use crate::editor::views::look;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::menu_button;
use crate::system::kepler::Ellipse;
use crate::system::limits::distance_text;
use crate::system::{Pose, System, shipped};
use body::BodyEdit;
use eframe::egui;
use map::OrbitMap;
use std::path::Path;
use trial::TrialEdit;

const WIDTH: f32 = 350.0;
/// Height of what is not in the list of the window: its head, the menus, the status bar.
const BESIDES: f32 = 200.0;
const DAY_SECS: f64 = 86_400.0;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("system window")
}

/// The window, and what is selected in it.
#[derive(Default)]
pub struct SystemWindow {
    map: OrbitMap,
    body: BodyEdit,
    trial: TrialEdit,
}

/// The bodies of the open system now.
struct Now<'a> {
    open: &'a OpenSystem,
    poses: Vec<Pose>,
    parents: Vec<Option<usize>>,
    /// The body that is the open planet.
    here: Option<usize>,
    time_secs: f64,
}

impl Now<'_> {
    fn system(&self) -> &System {
        self.open.worlds.system()
    }

    fn orbit(&self, body: usize) -> Option<&Ellipse> {
        self.open.worlds.ephemeris().orbit(body)
    }

    /// Whether a body has a planet to open that is not open already.
    fn can_visit(&self, body: usize) -> bool {
        self.here != Some(body) && self.open.preset(body).is_some()
    }

    fn has_ground(&self, body: usize) -> bool {
        self.open.worlds.planet(body).is_some_and(|planet| planet.giant.is_none())
    }

    fn children(&self, body: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.parents.len()).filter(move |child| self.parents[*child] == Some(body))
    }
}

impl SystemWindow {
    /// Shows the window while it is open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.system {
            return;
        }
        let mut open = true;
        let window =
            egui::Window::new("System").id(id()).open(&mut open).default_pos(look::WINDOW_POS).resizable(false);
        window.show(ctx, |ui| {
            ui.set_width(WIDTH.min(ctx.content_rect().width() - 40.0));
            choices(ui, state, commands);
            let Some(system) = &state.system else {
                ui.weak("A system has stars, planets and moons. Each planet is a preset; the others stand in its sky.");
                return;
            };
            let height = (ctx.content_rect().height() - BESIDES).max(120.0);
            let area = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
            // Room for the scroll bar.
            let beside = egui::Frame::new().inner_margin(egui::Margin { right: 10, ..egui::Margin::ZERO });
            area.show(ui, |ui| beside.show(ui, |ui| self.content(ui, state, system, commands)));
        });
        if !open {
            commands.push(Action::Close(Window::System));
        }
    }

    fn content(&mut self, ui: &mut egui::Ui, state: &State, open: &OpenSystem, commands: &mut Commands) {
        let time_secs = state.viewport.settings.time_secs;
        let now = Now {
            open,
            poses: open.worlds.ephemeris().at(time_secs),
            parents: open.worlds.system().parents(),
            here: state.viewport.body(),
            time_secs,
        };
        // Another system may have fewer bodies.
        if self.map.center >= now.parents.len() {
            self.map = OrbitMap::default();
        }
        self.map.show(ui, &now, commands);
        time(ui, time_secs, commands);
        changes(ui, open, commands);
        ui.separator();
        for root in (0..now.parents.len()).filter(|body| now.parents[*body].is_none()) {
            self.branch(ui, &now, (root, 0), commands);
        }
        for warning in &open.warnings {
            ui.colored_label(ui.visuals().warn_fg_color, warning);
        }
        let selected = self.map.center;
        let name = now.system().bodies[selected].name.clone();
        egui::CollapsingHeader::new(format!("Body: {name}"))
            .id_salt("selected body")
            .show(ui, |ui| self.body.show(ui, &now, selected, commands));
        egui::CollapsingHeader::new("Does it last?").show(ui, |ui| self.trial.show(ui, &now, commands));
    }

    /// A body and those that orbit it.
    fn branch(&mut self, ui: &mut egui::Ui, now: &Now<'_>, (body, depth): (usize, u32), commands: &mut Commands) {
        let name = &now.system().bodies[body].name;
        ui.horizontal(|ui| {
            ui.add_space(14.0 * depth as f32);
            let mut text = egui::RichText::new(name);
            if self.map.center == body {
                text = text.strong().underline();
            }
            let label = ui.selectable_label(now.here == Some(body), text);
            let told = match now.can_visit(body) {
                true => "A click selects it and puts it in the middle of the map, a double click goes there",
                false => "A click selects it and puts it in the middle of the map",
            };
            let label = label.on_hover_text(told);
            if label.double_clicked() && now.can_visit(body) {
                commands.push(Action::System(SystemAction::Visit(body, Arrival::Orbit)));
            } else if label.clicked() {
                self.map.look_at(body);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if now.open.preset(body).is_some() {
                    let land = ui.add_enabled(now.has_ground(body), egui::Button::new("Land").small());
                    if land.on_hover_text(format!("Fly down to the ground of {name}")).clicked() {
                        commands.push(Action::System(SystemAction::Visit(body, Arrival::Ground)));
                    }
                    let go = ui.add_enabled(now.can_visit(body), egui::Button::new("Go").small());
                    if go.on_hover_text(format!("Fly to {name}")).clicked() {
                        commands.push(Action::System(SystemAction::Visit(body, Arrival::Orbit)));
                    }
                }
                if now.parents[body].is_some() {
                    lock(ui, now, body, commands);
                }
                if let Some(parent) = now.parents[body] {
                    ui.weak(distance_text(now.poses[body].position_m.distance(now.poses[parent].position_m)));
                }
            });
        });
        for child in now.children(body) {
            self.branch(ui, now, (child, depth + 1), commands);
        }
    }
}

/// The menu of systems, and the file.
fn choices(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let name = state.system.as_ref().map_or("Choose a system", |system| &system.system().name);
        let mark = if state.system_is_dirty() { "• " } else { "" };
        menu_button(ui, format!("{mark}{name}"), |ui| {
            let mut entry = |ui: &mut egui::Ui, text: &str, told: &str, action: SystemAction| {
                let can_begin = action != SystemAction::Begin || of_document(&state.document).is_ok();
                let button = ui.add_enabled(can_begin, egui::Button::new(text)).on_hover_text(told);
                if button
                    .on_disabled_hover_text("Save the planet first: a system refers to the files of its planets")
                    .clicked()
                {
                    commands.push(Action::System(action));
                    ui.close();
                }
            };
            for (index, shipped) in shipped::ALL.iter().enumerate() {
                let told = "A system that comes with the program";
                entry(ui, &readable_stem(Path::new(shipped.file)), told, SystemAction::Open(index));
            }
            entry(ui, "New around this planet", "A star, and the open planet about it", SystemAction::Begin);
            if state.system.is_some() {
                ui.separator();
                entry(ui, "Save system", "Save it to its file", SystemAction::Save);
                entry(ui, "Save system as…", "Save it to another file", SystemAction::SaveAs);
            }
            ui.weak("Others: File, Open");
        });
        if state.system.is_some()
            && ui.button("Leave").on_hover_text("Draw the planet alone, under its own star").clicked()
        {
            commands.push(Action::System(SystemAction::Leave));
        }
    });
    ui.add_space(4.0);
}

/// Undo, redo and random orbits.
fn changes(ui: &mut egui::Ui, open: &OpenSystem, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let mut step = |ui: &mut egui::Ui, text: &str, label: Option<&str>, action: SystemAction| {
            let button = ui.add_enabled(label.is_some(), egui::Button::new(text).small());
            if button.on_hover_text(label.unwrap_or_default()).clicked() {
                commands.push(Action::System(action));
            }
        };
        step(ui, "Undo change", open.history().undo_label(), SystemAction::Undo);
        step(ui, "Redo change", open.history().redo_label(), SystemAction::Redo);
        let told = "Put every body that is not locked on a random orbit where it lasts";
        if ui.small_button("Random orbits").on_hover_text(told).clicked() {
            commands.push(Action::System(SystemAction::Roll));
        }
    });
}

/// The lock of a body.
fn lock(ui: &mut egui::Ui, now: &Now<'_>, body: usize, commands: &mut Commands) {
    let name = &now.system().bodies[body].name;
    let (icon, label, told) = match now.open.is_locked(body) {
        true => (Icon::Lock, format!("Unlock {name}"), "Random orbits leave it alone; a click unlocks it"),
        false => (Icon::Open, format!("Lock {name}"), "Let random orbits leave it alone"),
    };
    if icon_button(ui, icon, &label, told).clicked() {
        commands.push(Action::System(SystemAction::Lock(body)));
    }
}

/// The time as days since time zero.
fn time(ui: &mut egui::Ui, time_secs: f64, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let mut days = time_secs / DAY_SECS;
        let label = ui.label("Day");
        let field = ui.add(egui::DragValue::new(&mut days).speed(0.02).max_decimals(3)).labelled_by(label.id);
        let told = "Days of 24 hours since time zero. Drag to let the bodies move";
        let mut changed = field.on_hover_text(told).changed();
        for (text, step) in [("−30", -30.0), ("−1", -1.0), ("+1", 1.0), ("+30", 30.0)] {
            if ui.small_button(text).on_hover_text(format!("{text} days")).clicked() {
                days += step;
                changed = true;
            }
        }
        if changed {
            commands.push(Action::Set(Setting::TimeSecs(days * DAY_SECS)));
        }
    });
}
