//! The life tab: the list of populations, and the parameters of the selected one.

use super::{Draft, biomes, owner_box, rest};
use crate::editor::command::{Action, PanelAction, SculptAction};
use crate::editor::widgets::choice_field::swatch;
use crate::editor::widgets::drag_row::dragged_row;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::{menu_button, random_seed};
use crate::planet::life::{READY_POPULATIONS, free_seed, population_path};
use crate::planet::param::Choice;
use crate::planet::{Form, MAX_POPULATIONS, Planet, Population};
use eframe::egui::{self, AtomExt};

/// Share of the tab's height that the list takes at most.
const LIST_SHARE: f32 = 0.42;

/// Width of the button behind a row, with its gap.
const PAINT_WIDTH: f32 = 52.0;

/// Index of the row that is dragged.
#[derive(Clone, Copy)]
struct Dragged(usize);

/// The selection.
#[derive(Default)]
pub struct LifeState {
    /// Index of the population whose parameters are shown.
    pub selected: usize,
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) {
    state.selected = state.selected.min(draft.planet.life.len().saturating_sub(1));
    if draft.shown.filter.is_active() {
        let names = draft.planet.life.iter().map(|population| population.name.as_str());
        owner_box(ui, "Population", names, &mut state.selected);
    } else {
        toolbar(ui, state, draft);
        if draft.top_stays {
            let height = LIST_SHARE * ui.available_height();
            egui::ScrollArea::vertical().id_salt("list of populations").max_height(height).show(ui, |ui| {
                ui.set_max_width(ui.available_width() - 10.0);
                list(ui, state, draft);
            });
        } else {
            list(ui, state, draft);
        }
        ui.separator();
    }
    rest(ui, draft, "population", |ui, draft| match draft.planet.life.get(state.selected) {
        Some(_) => selected(ui, state.selected, draft),
        None if draft.planet.giant.is_some() => {
            ui.weak("A gas giant has no ground on which something could stand.");
        }
        None => {
            ui.weak("Nothing stands on the ground yet. Add plants or stones above.");
        }
    });
}

fn toolbar(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        let (count, at) = (draft.planet.life.len(), state.selected);
        ui.add_enabled_ui(count < MAX_POPULATIONS && draft.planet.giant.is_none(), |ui| {
            menu_button(ui, "Add population", |ui| {
                egui::ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
                    for ready in READY_POPULATIONS {
                        let ready_one = ready.population();
                        let form = ready_one.form.labels()[ready_one.form.index()].to_lowercase();
                        let told =
                            format!("{} on a hectare, {} m high: {form}", ready_one.per_hectare, ready_one.height_m);
                        if ui.button(ready.name).on_hover_text(told).clicked() {
                            let seed = free_seed(&draft.planet.life, random_seed() as u32);
                            let name = unique_name(draft.planet, ready.name);
                            draft.planet.life.push(Population { seed, name, ..ready_one });
                            state.selected = draft.planet.life.len() - 1;
                            draft.name_edit(format!("Add population: {}", ready.name.to_lowercase()));
                            ui.close();
                        }
                    }
                });
            });
        });
        ui.add_enabled_ui(count > 0 && count < MAX_POPULATIONS, |ui| {
            let told = "Duplicate the selected population";
            if icon_button(ui, Icon::Duplicate, "Duplicate population", told).clicked() {
                let copy = draft.planet.life[at].clone();
                let seed = free_seed(&draft.planet.life, random_seed() as u32);
                let name = unique_name(draft.planet, &copy.name);
                draft.planet.life.insert(at + 1, Population { seed, name, ..copy });
                state.selected = at + 1;
                draft.name_edit("Duplicate population");
            }
        });
        ui.add_enabled_ui(count > 0, |ui| {
            let told = "Remove the selected population";
            if icon_button(ui, Icon::Remove, "Remove population", told).clicked() {
                draft.planet.life.remove(at);
                draft.name_edit("Remove population");
            }
        });
    });
}

fn list(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) {
    let mut moved = None;
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
            let details = egui::RichText::new(format!("{} /ha · {form}", population.per_hectare)).weak().small();
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
            let told = "Objects on a hectare, and their form. Drag to change the order";
            response.on_hover_text(told).accessible_name(format!("Population {}", population.name));
        });
    }
    if let Some((from, gap)) = moved.filter(|(from, gap)| gap != from && *gap != from + 1) {
        let population = draft.planet.life.remove(from);
        state.selected = if gap > from { gap - 1 } else { gap };
        draft.planet.life.insert(state.selected, population);
        draft.name_edit("Move population");
    }
}

fn selected(ui: &mut egui::Ui, index: usize, draft: &mut Draft<'_>) {
    let own = population_path(index).join("seed");
    for (_, why) in draft.planet.life_doubts().iter().filter(|(path, _)| *path == own) {
        ui.colored_label(ui.visuals().warn_fg_color, format!("Seed: {why}"));
    }
    let names = biomes::names(&draft.planet.biomes);
    let population = &mut draft.planet.life[index];
    let (owner, shown) = (population.name.clone(), draft.shown);
    let grid = Grid { base: population_path(index), owner: &owner, skip: &["enabled"], shown, biomes: &names };
    let form = Form::of_kind(population.form.index()).unwrap_or_default();
    let mut default = Population { form, ..Population::default() };
    let browse = params_grid(ui, &grid, population, &mut default);
    draft.commands.extend(browse.map(Action::Browse));
}

/// The name, with a number if another population has it.
fn unique_name(planet: &Planet, name: &str) -> String {
    let is_free = |name: &String| planet.life.iter().all(|population| population.name != *name);
    let numbered = (2..).map(|number| format!("{name} {number}"));
    [name.to_owned()].into_iter().chain(numbered).find(is_free).unwrap_or_default()
}
