//! The run that shows whether the system lasts.

use super::Now;
use crate::editor::command::{Action, Commands, SystemAction};
use crate::editor::state::system::trial::TrialRun;
use crate::system::YEAR_SECS;
use eframe::egui;

/// Events that are listed.
const MOST_LISTED: usize = 6;

/// The length of the run.
pub(super) struct TrialEdit {
    years: f64,
}

impl Default for TrialEdit {
    fn default() -> Self {
        Self { years: 10.0 }
    }
}

impl TrialEdit {
    pub(super) fn show(&mut self, ui: &mut egui::Ui, now: &Now<'_>, commands: &mut Commands) {
        ui.horizontal(|ui| {
            let label = ui.label("Run for");
            let years = egui::DragValue::new(&mut self.years).range(0.1..=10_000.0).speed(0.5).suffix(" years");
            ui.add(years).labelled_by(label.id);
            match &now.open.trial {
                TrialRun::Running(job) => {
                    if ui.button("Stop").clicked() {
                        commands.push(Action::System(SystemAction::StopTrial));
                    }
                    ui.add(egui::ProgressBar::new(job.done() as f32).show_percentage());
                }
                TrialRun::None | TrialRun::Done(_) | TrialRun::Refused(_) => {
                    let told = "Moves all bodies under the attraction of all others, and says whether they stay";
                    let is_valid = now.open.problems.is_empty();
                    if ui.add_enabled(is_valid, egui::Button::new("Try it out")).on_hover_text(told).clicked() {
                        commands.push(Action::System(SystemAction::Try(self.years)));
                    }
                }
            }
        });
        let tried = match &now.open.trial {
            TrialRun::Done(tried) => tried,
            TrialRun::Refused(why) => {
                ui.colored_label(ui.visuals().warn_fg_color, why);
                return;
            }
            TrialRun::None | TrialRun::Running(_) => return,
        };
        let trial = &tried.trial;
        ui.label(format!(
            "{:.1} years: the energy is off by {:.1e} at most. The last orbits are on the map.",
            trial.secs / YEAR_SECS,
            trial.energy_error
        ));
        let doubts = trial.doubts(now.system());
        for doubt in &doubts {
            ui.colored_label(ui.visuals().error_fg_color, format!("Not to be trusted: {doubt}"));
        }
        for event in trial.events.iter().take(MOST_LISTED) {
            ui.colored_label(ui.visuals().warn_fg_color, event.told(now.system()));
        }
        match trial.events.len() {
            0 if doubts.is_empty() => drop(ui.label("No body met another or left its parent.")),
            count if count > MOST_LISTED => drop(ui.weak(format!("and {} more", count - MOST_LISTED))),
            _ => {}
        }
    }
}
