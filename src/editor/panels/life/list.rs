//! The list of populations: whether each is there, its colours, and about how many objects of it stand on the planet.

use super::tab::LifeState;
use crate::editor::command::{Action, PanelAction, SculptAction};
use crate::editor::panels::Draft;
use crate::editor::viewport::ReadyDrag;
use crate::editor::widgets::choice_field::swatch;
use crate::editor::widgets::drag_row::{dragged_row, gap_under};
use crate::planet::life::population_path;
use crate::planet::param::Choice;
use eframe::egui::{self, AtomExt};

/// Width of the button behind a row, with its gap.
const PAINT_WIDTH: f32 = 52.0;

/// Index of the row that is dragged.
#[derive(Clone, Copy)]
struct Dragged(usize);

/// Shows the list. Gives the ready population that was dropped between its rows, and the gap.
pub(super) fn show(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) -> Option<(usize, usize)> {
    let (mut moved, mut dropped) = (None, None);
    for (index, population) in draft.planet.life.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            draft.shown.marked(ui, &population_path(index).join("enabled"), "enabled", |ui| {
                let check = ui.add(egui::Checkbox::without_text(&mut population.enabled));
                let check = check.on_hover_text("Whether the population is there");
                check.accessible_name(format!("Enabled of {}", population.name));
            });
            for color in population.colors() {
                let (rect, _) = ui.allocate_exact_size(egui::vec2(10.0, 20.0), egui::Sense::hover());
                swatch(ui, rect.expand2(egui::vec2(3.0, 0.0)), color);
            }
            let form = population.form.labels()[population.form.index()];
            // A name that was changed has no count until the next census.
            let count = state.census().and_then(|census| census.of(population)).map(count_text);
            let details = match &count {
                Some(count) => format!("{count} · {form}"),
                None => form.to_owned(),
            };
            let details = egui::RichText::new(details).weak().small();
            let name = egui::RichText::new(&population.name);
            let name = if population.enabled { name } else { name.weak() };
            let atoms = (egui::Atom::from(name).atom_shrink(true), egui::Atom::grow(), details);
            let button = egui::Button::selectable(state.selected == index, atoms)
                .truncate()
                .min_size(egui::vec2(ui.available_width() - PAINT_WIDTH, 20.0))
                .sense(egui::Sense::click_and_drag());
            let response = ui.add_sized(egui::vec2(ui.available_width() - PAINT_WIDTH, 20.0), button);
            let told = "Plant the population by hand; with Shift clear it";
            let paint = ui.small_button("Paint").on_hover_text(told);
            if paint.accessible_name(format!("Paint {}", population.name)).clicked() {
                let action = SculptAction::PaintLife(index);
                draft.commands.push(Action::Panel(PanelAction::Sculpt(action)));
            }
            if response.clicked() {
                state.selected = index;
            }
            moved = moved.or(dragged_row(ui, &response, index, Dragged(index)).map(|(Dragged(from), gap)| (from, gap)));
            dropped = dropped.or(gap_under::<ReadyDrag>(ui, &response, index).map(|(ready, gap)| (ready.0, gap)));
            let on_planet = count.map_or_else(String::new, |count| format!("About {count} objects on the planet. "));
            let per_hectare = population.per_hectare;
            let told = format!("{on_planet}{per_hectare} on a hectare where all suits them. Drag to change the order");
            response.on_hover_text(told).accessible_name(format!("Population {}", population.name));
        });
    }
    if let Some((from, gap)) = moved.filter(|(from, gap)| gap != from && *gap != from + 1) {
        let population = draft.planet.life.remove(from);
        state.selected = if gap > from { gap - 1 } else { gap };
        draft.planet.life.insert(state.selected, population);
        draft.name_edit("Move population");
    }
    dropped
}

/// A number of objects in three figures at most: 950, 1.2 k, 34 M, 1.2 G.
fn count_text(count: f64) -> String {
    let (mut count, mut unit) = (count, "");
    for greater in ["k", "M", "G", "T", "P"] {
        if count < 999.5 {
            break;
        }
        (count, unit) = (count / 1000.0, greater);
    }
    let digits = if unit.is_empty() || count >= 9.95 { 0 } else { 1 };
    let text = format!("{count:.digits$}");
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_three_figures_at_most() {
        let cases = [(0.0, "0"), (950.2, "950"), (999.6, "1.0 k"), (34_512_000.0, "35 M"), (1.23e9, "1.2 G")];
        for (count, text) in cases.into_iter().chain([(9.96e12, "10 T"), (4e17, "400 P")]) {
            assert_eq!(count_text(count), text);
        }
    }
}
