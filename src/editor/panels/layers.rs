//! The terrain tab: the list of layers, and the parameters of the selected one.

use super::{Draft, layer_edit, masks, owner_box, rest};
use crate::editor::command::{Action, ClipAction, PanelAction, SculptAction, Wanted};
use crate::editor::viewport::layer_view::{LayerOverlay, LayerQuantity};
use crate::editor::widgets::drag_row::dragged_row;
use crate::editor::widgets::icon::{Icon, icon_button, mark};
use crate::editor::widgets::number::length_text;
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::{menu_button, random_seed};
use crate::planet::layers::layer_path;
use crate::planet::param::Choice;
use crate::planet::{Layer, MAX_LAYERS, Shape};
use eframe::egui::{self, AtomExt};
use std::collections::BTreeSet;

/// Parameters of a layer that have no effect without a structure: they are not shown then.
pub const NEED_STRUCTURE: [&str; 3] = ["under", "folding", "follow_wind"];

/// Share of the tab's height that the list takes at most.
const LIST_SHARE: f32 = 0.42;

/// Index of the row that is dragged.
#[derive(Clone, Copy)]
struct Dragged(usize);

/// The selection, what is shown of it on the planet, and half-typed texts.
#[derive(Default)]
pub struct LayersState {
    /// Index of the layer whose parameters are shown.
    pub selected: usize,
    /// Indices of the other selected layers.
    also: BTreeSet<usize>,
    /// Whether the selected layers are seen alone.
    solo: bool,
    /// What is shown of the selected layer on the planet.
    quantity: Option<LayerQuantity>,
    /// Index of a layer and the name that is being typed. The layer gets the name when the field loses the focus, so
    /// that no mask refers to half a name.
    typed_name: Option<(usize, String)>,
}

impl LayersState {
    /// Indices of all selected layers, in order.
    pub fn chosen(&self) -> Vec<usize> {
        let mut all = self.also.clone();
        all.insert(self.selected);
        all.into_iter().collect()
    }

    /// Selects a layer alone.
    pub fn select(&mut self, index: usize) {
        self.selected = index;
        self.also.clear();
    }

    /// Selects layers.
    pub fn select_all(&mut self, indices: &[usize]) {
        self.also = indices.iter().copied().collect();
        self.selected = indices.first().copied().unwrap_or_default();
        self.also.remove(&self.selected);
    }

    /// A click on a row: with Ctrl it adds the layer to the selection or takes it out, with Shift it selects all up to
    /// there.
    fn clicked(&mut self, index: usize, modifiers: egui::Modifiers) {
        if modifiers.shift {
            let (first, last) = (self.selected.min(index), self.selected.max(index));
            self.also = (first..=last).filter(|other| *other != self.selected).collect();
        } else if !modifiers.command {
            self.select(index);
        } else if index != self.selected {
            if !self.also.remove(&index) {
                self.also.insert(index);
            }
        } else if let Some(other) = self.also.pop_first() {
            self.selected = other;
        }
    }

    /// What the tab shows on the planet.
    pub fn link(&self) -> (Vec<usize>, Option<LayerOverlay>) {
        let solo = if self.solo { self.chosen() } else { Vec::new() };
        (solo, self.quantity.map(|quantity| LayerOverlay { layer: self.selected, quantity }))
    }
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut LayersState, draft: &mut Draft<'_>) {
    let count = draft.planet.layers.len();
    state.selected = state.selected.min(count.saturating_sub(1));
    state.also.retain(|index| *index < count);
    if draft.shown.filter.is_active() {
        let names = draft.planet.layers.iter().map(|layer| layer.name.as_str());
        owner_box(ui, "Layer", names, &mut state.selected);
    } else {
        toolbar(ui, state, draft);
        if draft.top_stays {
            // The list stays in sight while the parameters of a layer scroll.
            let height = LIST_SHARE * ui.available_height();
            egui::ScrollArea::vertical().id_salt("list of layers").max_height(height).show(ui, |ui| {
                ui.set_max_width(ui.available_width() - 10.0);
                list(ui, state, draft);
            });
        } else {
            list(ui, state, draft);
        }
        if draft.planet.structure.is_some() {
            ui.weak("Continents, ranges and valleys come from the tab Structure; layers add to them.");
        }
        ui.separator();
    }
    rest(ui, draft, "layer", |ui, draft| {
        if state.selected < draft.planet.layers.len() {
            selected(ui, state, draft);
        } else {
            ui.weak("There are no layers yet: the planet is a smooth sphere. Add one above.");
        }
    });
}

fn toolbar(ui: &mut egui::Ui, state: &mut LayersState, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        let (chosen, count) = (state.chosen(), draft.planet.layers.len());
        let (first, last) = (chosen[0], chosen[chosen.len() - 1]);
        ui.add_enabled_ui(count < MAX_LAYERS, |ui| {
            menu_button(ui, "Add layer", |ui| {
                for (kind, (name, doc)) in Shape::LABELS.iter().zip(Shape::DOCS).enumerate() {
                    if ui.button(*name).on_hover_text(*doc).clicked() {
                        let after = (count > 0).then_some(last);
                        let seed = random_seed() as u32;
                        state.select(layer_edit::add(draft.planet, kind, after, seed).unwrap_or(last));
                        draft.name_edit(format!("Add layer: {}", name.to_lowercase()));
                        ui.close();
                    }
                }
            });
        });
        ui.add_enabled_ui(count > 0 && count + chosen.len() <= MAX_LAYERS, |ui| {
            if icon_button(ui, Icon::Duplicate, "Duplicate layer", "Duplicate the selected layers").clicked() {
                if let Some(copies) = layer_edit::duplicate_all(draft.planet, &chosen) {
                    state.select_all(&copies);
                }
                draft.name_edit(layer_edit::counted("Duplicate", chosen.len()));
            }
        });
        ui.add_enabled_ui(count > 0, |ui| {
            let told = "Remove the selected layers, and the masks on them (Delete over the list)";
            if icon_button(ui, Icon::Remove, "Remove layer", told).clicked() {
                remove_chosen(state, draft);
            }
        });
        for (icon, name, by, possible) in
            [(Icon::Up, "Move layer up", -1, first > 0), (Icon::Down, "Move layer down", 1, last + 1 < count)]
        {
            ui.add_enabled_ui(possible, |ui| {
                if icon_button(ui, icon, name, "Layers apply from first to last").clicked() {
                    let moved = layer_edit::shift_all(draft.planet, &chosen, by);
                    state.select_all(&moved);
                    draft.name_edit(if chosen.len() == 1 { name.to_owned() } else { name.replace("layer", "layers") });
                }
            });
        }
        ui.separator();
        let told = "See the selected layers alone: all others are off, and so is the structure. The planet stays";
        ui.toggle_value(&mut state.solo, "Solo").on_hover_text(told);
        for (quantity, name, told) in [
            (LayerQuantity::Mask, "Mask", "Colour the planet where the masks let the layer act"),
            (LayerQuantity::Change, "Effect", "Colour the planet where the layer raises or lowers the ground"),
        ] {
            let mut on = state.quantity == Some(quantity);
            if ui.toggle_value(&mut on, name).on_hover_text(told).changed() {
                state.quantity = on.then_some(quantity);
            }
        }
    });
}

fn list(ui: &mut egui::Ui, state: &mut LayersState, draft: &mut Draft<'_>) {
    let changes_m = draft.under_pointer.map(|under| under.layers_m.as_slice());
    let (mut moved, locks) = (None, draft.shown.locks);
    let top = ui.cursor().top();
    let (chosen, mut switched) = (state.chosen(), None);
    for (index, layer) in draft.planet.layers.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            draft.shown.marked(ui, &layer_path(index).join("enabled"), "enabled", |ui| {
                let check = ui.add(egui::Checkbox::without_text(&mut layer.enabled));
                let check = check.on_hover_text("Whether the layer changes the height; off, it can still be a mask");
                if check.accessible_name(format!("Enabled of {}", layer.name)).changed() {
                    switched = Some((index, layer.enabled));
                }
            });
            let change_m = changes_m.and_then(|changes| changes.get(index)).filter(|_| layer.enabled);
            // The padlock covers no text.
            let room = if locks.is_on(&layer_path(index)) { "      " } else { "" };
            let details = details(layer, change_m.copied()) + room;
            let details = egui::RichText::new(details).weak().small();
            let name = egui::RichText::new(&layer.name);
            let name = if layer.enabled { name } else { name.weak() };
            let width = ui.available_width();
            let atoms = (egui::Atom::from(name).atom_shrink(true), egui::Atom::grow(), details);
            let button = egui::Button::selectable(chosen.contains(&index), atoms)
                .truncate()
                .min_size(egui::vec2(width, 20.0))
                .sense(egui::Sense::click_and_drag());
            let response = ui.add(button);
            if response.clicked() {
                state.clicked(index, ui.input(|input| input.modifiers));
            } else if response.secondary_clicked() && !chosen.contains(&index) {
                state.select(index);
            }
            moved = moved.or(dragged_row(ui, &response, index, Dragged(index)).map(|(Dragged(from), gap)| (from, gap)));
            let path = layer_path(index);
            if locks.is_on(&path) {
                let right = response.rect.right_center() - egui::vec2(10.0, 0.0);
                mark(ui, Icon::Lock, egui::Rect::from_center_size(right, egui::Vec2::splat(10.0)));
            }
            response.context_menu(|ui| {
                for (label, action) in [
                    ("Copy", ClipAction::CopyLayers(state.chosen())),
                    ("Cut", ClipAction::CutLayers(state.chosen())),
                    ("Paste after", ClipAction::Ask(Wanted::Layers { after: Some(index) })),
                ] {
                    if ui.button(label).clicked() {
                        draft.commands.push(Action::Clip(action));
                        ui.close();
                    }
                }
                locks.entry(ui, &path);
            });
            let told = "Drag to change the order; Ctrl or Shift selects several; right-click to copy, paste or lock";
            response.on_hover_text(told).accessible_name(format!("Layer {}", layer.name));
        });
    }
    if let Some((_, enabled)) = switched.filter(|(index, _)| chosen.contains(index) && chosen.len() > 1) {
        for (other, layer) in draft.planet.layers.iter_mut().enumerate() {
            if chosen.contains(&other) {
                layer.enabled = enabled;
            }
        }
        draft.name_edit(layer_edit::counted(if enabled { "Turn on" } else { "Turn off" }, chosen.len()));
    }
    list_keys(ui, top, state, draft);
    if let Some((from, gap)) = moved {
        let to = layer_edit::move_to_gap(draft.planet, from, gap);
        state.select(to);
        if to != from {
            draft.name_edit("Move layer");
        }
    }
}

/// The clipboard keys of the desktop and Delete, for the selected layers while the pointer is over the list.
fn list_keys(ui: &egui::Ui, top: f32, state: &mut LayersState, draft: &mut Draft<'_>) {
    let list = egui::Rect::from_min_max(egui::pos2(ui.min_rect().left(), top), ui.min_rect().max);
    if ui.ctx().text_edit_focused() || !ui.rect_contains_pointer(list) {
        return;
    }
    let wanted = Wanted::Layers { after: state.chosen().last().copied() };
    let action = ui.input(|input| {
        input.events.iter().find_map(|event| match event {
            egui::Event::Copy => Some(ClipAction::CopyLayers(state.chosen())),
            egui::Event::Cut => Some(ClipAction::CutLayers(state.chosen())),
            egui::Event::Paste(text) => Some(ClipAction::Paste(wanted, text.clone())),
            _ => None,
        })
    });
    draft.commands.extend(action.map(Action::Clip));
    if !draft.planet.layers.is_empty()
        && ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Delete))
    {
        remove_chosen(state, draft);
    }
}

/// Removes the selected layers.
fn remove_chosen(state: &mut LayersState, draft: &mut Draft<'_>) {
    let chosen = state.chosen();
    layer_edit::remove_all(draft.planet, &chosen);
    state.select(chosen[0]);
    draft.name_edit(layer_edit::counted("Remove", chosen.len()));
}

/// Blend mode and landform of a layer; while the pointer is over the ground, the layer's change of the height there.
fn details(layer: &Layer, change_m: Option<f64>) -> String {
    if let Some(change_m) = change_m {
        let sign = if change_m < 0.0 { "−" } else { "+" };
        return format!("{sign}{}", length_text(change_m.abs()));
    }
    let kind = layer.shape.labels().get(layer.shape.index()).copied().unwrap_or_default();
    let blend = layer.blend.labels().get(layer.blend.index()).copied().unwrap_or_default();
    format!("{blend} · {kind}")
}

fn selected(ui: &mut egui::Ui, state: &mut LayersState, draft: &mut Draft<'_>) {
    let index = state.selected;
    let shown = draft.shown;
    if !shown.filter.is_active() {
        let name_path = layer_path(index).join("name");
        shown.marked(ui, &name_path, "name", |ui| name_field(ui, state, draft));
    }
    let names: Vec<String> = draft.planet.layers.iter().map(|layer| layer.name.clone()).collect();
    let has_structure = draft.planet.structure.is_some();
    let Some(layer) = draft.planet.layers.get_mut(index) else { return };
    let name = layer.name.clone();
    let skip = [&["name", "enabled", "masks"][..], if has_structure { &[] } else { &NEED_STRUCTURE }].concat();
    let grid = Grid { base: layer_path(index), owner: &name, skip: &skip, shown, biomes: &[] };
    let shape = Shape::of_kind(layer.shape.index()).unwrap_or_default();
    let mut default = Layer { shape, ..Layer::default() };
    let browse = params_grid(ui, &grid, layer, &mut default);
    draft.commands.extend(browse.map(Action::Browse));
    ui.add_space(6.0);
    let masks::Asked { label, paint } = masks::show(ui, index, layer, &names, shown);
    if let Some(label) = label {
        draft.name_edit(label);
    }
    if let Some(mask) = paint {
        state.quantity = Some(LayerQuantity::Mask);
        let action = SculptAction::PaintMask { layer: index, mask };
        draft.commands.push(Action::Panel(PanelAction::Sculpt(action)));
    }
}

fn name_field(ui: &mut egui::Ui, state: &mut LayersState, draft: &mut Draft<'_>) {
    let index = state.selected;
    let Some(current) = draft.planet.layers.get(index).map(|layer| layer.name.clone()) else { return };
    let mut name = match state.typed_name.take() {
        Some((typed_for, name)) if typed_for == index => name,
        _ => current.clone(),
    };
    let others = draft.planet.layers.iter().enumerate().filter(|(i, _)| *i != index);
    let taken = others.into_iter().any(|(_, other)| other.name == name);
    ui.horizontal(|ui| {
        let label = ui.label("Name");
        let edit = egui::TextEdit::singleline(&mut name).char_limit(48).desired_width(ui.available_width());
        let response = ui.add(edit).labelled_by(label.id).accessible_name(format!("Name of {current}"));
        if response.has_focus() {
            state.typed_name = Some((index, name.clone()));
        } else if response.lost_focus() && layer_edit::rename(draft.planet, index, &name) {
            draft.name_edit("Rename layer");
        }
    });
    if taken {
        ui.colored_label(ui.visuals().error_fg_color, "Another layer has this name; masks need it to be unique.");
    }
}
