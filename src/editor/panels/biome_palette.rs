//! The palette: the biomes with their shares of the land; add, rename, recolour, reorder, remove.

use super::{Draft, biome_edit};
use crate::editor::widgets::color_field::color_button;
use crate::editor::widgets::drag_row::dragged_row;
use crate::editor::widgets::{color32, ink_on, menu_button};
use crate::planet::MAX_BIOMES;
use eframe::egui::{self, AtomExt};

/// Least share of the sea that is named: less would read 0.0 %.
const SEA_SHOWN: f64 = 0.0005;

/// Index of the row that is dragged.
#[derive(Clone, Copy)]
struct Dragged(usize);

/// The selection and half-typed texts.
#[derive(Default)]
pub struct PaletteState {
    /// Index of the biome to paint.
    pub selected: usize,
    /// The row whose name is being typed, and the text.
    renaming: Option<(usize, String)>,
    /// Why a typed key was refused.
    pub(super) refused: Option<(usize, String)>,
}

/// Shows the palette. Gives the index of the biome under the pointer.
pub fn show(ui: &mut egui::Ui, state: &mut PaletteState, draft: &mut Draft<'_>) -> Option<usize> {
    toolbar(ui, state, draft);
    let shares: Vec<f64> = draft.survey.map(|survey| survey.biomes.clone()).unwrap_or_default();
    let (mut hovered, mut moved) = (None, None);
    for index in 0..draft.planet.biomes.palette.len() {
        ui.push_id(index, |ui| {
            ui.horizontal(|ui| {
                let Some(biome) = draft.planet.biomes.palette.get_mut(index) else { return };
                color_button(ui, &format!("Palette colour of {}", biome.name), &mut biome.color);
                let fill = color32(biome.color);
                let key = egui::RichText::new(format!(" {} ", biome.key)).monospace();
                ui.label(key.background_color(fill).color(ink_on(fill)));
                if state.renaming.as_ref().is_some_and(|(renamed, _)| *renamed == index) {
                    rename_field(ui, state, draft);
                    return;
                }
                let share = shares.get(index).map_or_else(String::new, |share| percent(*share));
                let share = egui::RichText::new(share).weak();
                let atoms = (egui::Atom::from(biome.name.as_str()).atom_shrink(true), egui::Atom::grow(), share);
                let button = egui::Button::selectable(state.selected == index, atoms)
                    .truncate()
                    .min_size(egui::vec2(ui.available_width(), 20.0))
                    .sense(egui::Sense::click_and_drag());
                let name = biome.name.clone();
                let response = ui.add(button);
                if response.clicked() {
                    state.selected = index;
                }
                if response.double_clicked() {
                    state.renaming = Some((index, name.clone()));
                }
                if response.hovered() {
                    hovered = Some(index);
                }
                moved =
                    moved.or(dragged_row(ui, &response, index, Dragged(index)).map(|(Dragged(from), gap)| (from, gap)));
                let tooltip = "Share of the land. Drag to change the order, double-click to rename.";
                response.on_hover_text(tooltip).accessible_name(format!("Biome {name}"));
            });
        });
    }
    if let Some((from, gap)) = moved {
        state.selected = biome_edit::move_to_gap(&mut draft.planet.biomes, from, gap, state.selected);
        draft.name_edit("Move biome");
    }
    hovered
}

/// A share in percent: "–" for none, "< 0.1 %", or with the digits that matter.
fn percent(share: f64) -> String {
    match share * 100.0 {
        0.0 => "–".to_owned(),
        percent if percent < 0.1 => "< 0.1 %".to_owned(),
        percent if percent < 10.0 => format!("{percent:.1} %"),
        percent => format!("{percent:.0} %"),
    }
}

fn toolbar(ui: &mut egui::Ui, state: &mut PaletteState, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        ui.strong("Palette");
        // Always there: if it appeared with the survey, the buttons behind it would move under the pointer.
        let sea = draft.survey.filter(|survey| survey.sea > SEA_SHOWN);
        ui.weak(sea.map_or_else(String::new, |survey| format!("of the land; {} is sea", percent(survey.sea))));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let planet = &mut *draft.planet;
            let mut label = None;
            ui.add_enabled_ui(planet.biomes.palette.len() > 1, |ui| {
                menu_button(ui, "Remove", |ui| {
                    ui.weak("Its cells become");
                    for replacement in 0..planet.biomes.palette.len() {
                        let name = planet.biomes.palette[replacement].name.clone();
                        if replacement != state.selected && ui.button(name).clicked() {
                            let index = std::mem::replace(&mut state.selected, replacement);
                            biome_edit::remove(planet, index, replacement);
                            state.selected -= usize::from(replacement > index);
                            label = Some("Remove biome");
                            ui.close();
                            break;
                        }
                    }
                });
            });
            if ui.add_enabled(planet.biomes.palette.len() < MAX_BIOMES, egui::Button::new("Add biome")).clicked() {
                state.selected = biome_edit::add(&mut planet.biomes).unwrap_or(state.selected);
                label = Some("Add biome");
            }
            if let Some(label) = label {
                draft.name_edit(label);
            }
        });
    });
}

fn rename_field(ui: &mut egui::Ui, state: &mut PaletteState, draft: &mut Draft<'_>) {
    let Some((index, mut name)) = state.renaming.take() else { return };
    let edit = egui::TextEdit::singleline(&mut name).char_limit(48).desired_width(ui.available_width());
    let response = ui.add(edit).accessible_name("New name of biome");
    if response.lost_focus() {
        let kept = ui.input(|i| i.key_pressed(egui::Key::Escape)) || name.trim().is_empty();
        if let Some(biome) = draft.planet.biomes.palette.get_mut(index).filter(|biome| !kept && biome.name != name) {
            biome.name = name;
            draft.name_edit("Rename biome");
        }
        return;
    }
    if !response.has_focus() {
        response.request_focus();
    }
    state.renaming = Some((index, name));
}
