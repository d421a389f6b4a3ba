//! What there is to the selected body: its name, its preset, its parameters.

use super::Now;
use crate::editor::command::{Action, Commands, NewBody, SystemAction};
use crate::editor::files::file_names::readable_stem;
use crate::editor::widgets::curve_view::CurveView;
use crate::editor::widgets::menu_button;
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::row_view::{Filter, LockView, RowView};
use crate::planet::param::{ParamPath, Segment};
use crate::planet::{Planet, shipped};
use crate::system::{Light, Member, Orbit, Start};
use eframe::egui;
use std::path::Path;

/// Fields with rows of their own.
const SKIPPED: &[&str] = &["name", "preset", "parent"];

/// The name that is being typed.
#[derive(Default)]
pub(super) struct BodyEdit {
    typed: Option<(usize, String)>,
}

impl BodyEdit {
    /// Shows the parameters of a body.
    pub(super) fn show(&mut self, ui: &mut egui::Ui, now: &Now<'_>, body: usize, commands: &mut Commands) {
        let Some(member) = now.open.system().bodies.get(body) else { return };
        self.name(ui, now, body, commands);
        if !member.preset.is_empty() {
            ui.weak(format!("Surface: {}", member.preset));
        }
        let mut changed = member.clone();
        parameters(ui, now, body, &mut changed);
        if changed != *member {
            let mut system = (**now.open.system()).clone();
            let label = format!("Change {}", member.name);
            system.bodies[body] = changed;
            commands.push(Action::System(SystemAction::Edit(Box::new(system), label)));
        }
        ui.horizontal(|ui| {
            menu_button(ui, "Add", |ui| additions(ui, body, &member.name, commands));
            let remove = ui.add_enabled(now.parents[body].is_some(), egui::Button::new("Remove"));
            let told = format!("Remove {} and what orbits it; undo brings them back", member.name);
            if remove.on_hover_text(told).on_disabled_hover_text("The others orbit this one").clicked() {
                commands.push(Action::System(SystemAction::Remove(body)));
            }
        });
    }

    fn name(&mut self, ui: &mut egui::Ui, now: &Now<'_>, body: usize, commands: &mut Commands) {
        let name = &now.open.system().bodies[body].name;
        ui.horizontal(|ui| {
            let label = ui.label("Name");
            let mut text = match &self.typed {
                Some((of, typed)) if *of == body => typed.clone(),
                _ => name.clone(),
            };
            let field = egui::TextEdit::singleline(&mut text).char_limit(64).desired_width(f32::INFINITY);
            let response = ui.add(field).labelled_by(label.id);
            if response.has_focus() {
                self.typed = Some((body, text));
            } else if response.lost_focus() {
                self.typed = None;
                if text.trim() != name {
                    let mut system = (**now.open.system()).clone();
                    system.rename(body, &text);
                    let label = format!("Rename {name}");
                    commands.push(Action::System(SystemAction::Edit(Box::new(system), label)));
                }
            }
        });
    }
}

fn parameters(ui: &mut egui::Ui, now: &Now<'_>, body: usize, member: &mut Member) {
    let (filter, locks, planet) = (Filter::default(), LockView::none(), Planet::default());
    let (problems, curves) = (&now.open.problems, CurveView::default());
    let shown = RowView { planet: &planet, problems, filter: &filter, revealed: None, locks: &locks, curves: &curves };
    let base = ParamPath::from(vec![Segment::Field("bodies"), Segment::Index(body)]);
    let mut default = Member {
        light: member.light.as_ref().map(|_| Light::default()),
        orbit: member.orbit.as_ref().map(|_| Orbit::default()),
        start: member.start.as_ref().map(|_| Start::default()),
        ..Member::default()
    };
    let owner = member.name.clone();
    params_grid(ui, &Grid { base, owner: &owner, skip: SKIPPED, shown, biomes: &[] }, member, &mut default);
    for (_, problem) in &now.open.problems {
        ui.colored_label(ui.visuals().error_fg_color, problem);
    }
}

/// What can be added about a body.
fn additions(ui: &mut egui::Ui, parent: usize, name: &str, commands: &mut Commands) {
    ui.weak(format!("About {name}"));
    let mut add = |ui: &mut egui::Ui, text: &str, told: &str, body: NewBody| {
        if ui.button(text).on_hover_text(told).clicked() {
            commands.push(Action::System(SystemAction::Add(parent, body)));
            ui.close();
        }
    };
    add(ui, "The open planet", "The planet in the window, by its file", NewBody::Open);
    add(ui, "From a file…", "A planet of yours, by its file", NewBody::Ask);
    add(ui, "A star", "A small orange star", NewBody::Star);
    ui.separator();
    for (index, preset) in shipped::ALL.iter().enumerate() {
        let told = "A planet that comes with the program; it is written beside the system when that is saved";
        add(ui, &readable_stem(Path::new(preset.file)), told, NewBody::Shipped(index));
    }
}
