//! The side panel: one tab for each part of the planet.
//!
//! Panels change a draft of the planet; the application makes an undo step of a changed draft. [`PANELS`] lists the
//! tabs: a new panel is a file and a row there.
//!
//! - [`finding`]: filters, and the parameter that was searched for
//! - [`parts`]: planet, star, climate, and the optional parts; [`structure`]: plates, weather, rivers
//! - [`layers`], [`masks`], [`layer_edit`]: the terrain layers, and edits of their list
//! - [`biomes`], [`biome_table`], [`biome_canvas`], [`biome_palette`], [`biome_edit`]: the biome table: the tab, the
//!   table under the pointer, its picture, the palette, edits of both

pub mod biome_canvas;
pub mod biome_edit;
pub mod biome_palette;
pub mod biome_table;
pub mod biomes;
pub mod finding;
pub mod layer_edit;
pub mod layers;
pub mod masks;
pub mod parts;
pub mod structure;

use crate::editor::command::{Action, ClipAction, Commands, PanelAction, Wanted};
use crate::editor::painter::survey::Survey;
use crate::editor::viewport::pointer::UnderPointer;
use crate::editor::viewport::{Click, TabLink};
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::row_view::{LockView, RowView};
use crate::planet::Planet;
use crate::planet::param::{ParamPath, Segment};
use eframe::egui;
use finding::Finding;

/// A tab of the side panel.
pub struct Panel {
    /// The name of the tab.
    pub label: &'static str,
    /// The part of the planet that the tab shows: the field of a preset; empty for the planet's own parameters.
    pub part: &'static str,
    /// Whether the tab paints the biome table.
    pub paints: bool,
    /// Whether the tab changes plates.
    plates: bool,
    show: fn(&mut egui::Ui, &mut PanelState, &mut Draft<'_>),
}

impl Panel {
    const fn new(
        label: &'static str,
        part: &'static str,
        show: fn(&mut egui::Ui, &mut PanelState, &mut Draft<'_>),
    ) -> Self {
        Self { label, part, paints: false, plates: false, show }
    }

    /// Index of the tab with the parameter at `path`; None if no tab shows it.
    pub fn of(path: &ParamPath) -> Option<usize> {
        PANELS.iter().position(|panel| panel.part == path.part())
    }

    /// What one can do with all that is in the tab.
    fn menu(&self, ui: &mut egui::Ui, locks: &LockView, commands: &mut Commands) {
        let what = if self.part.is_empty() { "whole planet" } else { self.part };
        for (verb, told, action) in [
            ("Copy", "As text: for another planet, for a file, for a message", ClipAction::CopyPart(self.part)),
            ("Paste", "What was copied here or elsewhere; undo goes back", ClipAction::Ask(Wanted::Part(self.part))),
        ] {
            if ui.button(format!("{verb} {what}")).on_hover_text(told).clicked() {
                commands.push(Action::Clip(action));
                ui.close();
            }
        }
        if !self.part.is_empty() {
            locks.entry(ui, &ParamPath::default().join(self.part));
        }
    }

    const fn painting(self) -> Self {
        Self { paints: true, ..self }
    }

    const fn of_plates(self) -> Self {
        Self { plates: true, ..self }
    }
}

/// The tabs, in the order shown.
pub static PANELS: [Panel; 9] = [
    Panel::new("Planet", "", |ui, _, draft| parts::planet(ui, draft)),
    Panel::new("Terrain", "layers", |ui, state, draft| layers::show(ui, &mut state.layers, draft)),
    Panel::new("Structure", "structure", |ui, state, draft| {
        structure::show(ui, &mut state.structure, &mut state.turned_off, draft);
    })
    .of_plates(),
    Panel::new("Climate", "climate", |ui, _, draft| parts::climate(ui, draft)),
    Panel::new("Biomes", "biomes", |ui, state, draft| biomes::show(ui, &mut state.biomes, draft)).painting(),
    Panel::new("Water", "water", |ui, state, draft| parts::water(ui, &mut state.turned_off, draft)),
    Panel::new("Atmosphere", "atmosphere", |ui, state, draft| parts::atmosphere(ui, &mut state.turned_off, draft)),
    Panel::new("Clouds", "clouds", |ui, state, draft| parts::clouds(ui, &mut state.turned_off, draft)),
    Panel::new("Star", "star", |ui, _, draft| parts::star(ui, draft)),
];

/// Index of the tab that is open at the start: the terrain.
const FIRST_TAB: usize = 1;

/// The planet as the panels change it.
pub struct Draft<'a> {
    /// A copy of the document's planet. If it differs from the document after the frame, it becomes an edit.
    pub planet: &'a mut Planet,
    /// The name of the edit; None names it after the changed parameters.
    pub label: Option<String>,
    /// Problems of the document's planet, the filter, and the parameter that was searched for.
    pub shown: RowView<'a>,
    /// The ground under the pointer.
    pub under_pointer: Option<&'a UnderPointer>,
    /// How the planet's land is spread over its biome table.
    pub survey: Option<&'a Survey>,
    /// The commands of the panels, beside edits.
    pub commands: &'a mut Commands,
    /// Longitude of the eye, in degrees.
    pub eye_lon_deg: f64,
    /// Seconds since time zero.
    pub time_secs: f64,
}

impl Draft<'_> {
    /// Names the edit made in this frame.
    pub fn name_edit(&mut self, label: impl Into<String>) {
        self.label = Some(label.into());
    }
}

/// Selections and half-typed names. Not part of the document.
pub struct PanelState {
    tab: usize,
    document_number: u64,
    /// Filters, and the parameter that was searched for.
    pub finding: Finding,
    layers: layers::LayersState,
    /// The biomes tab.
    pub biomes: biomes::BiomesState,
    structure: structure::StructureState,
    turned_off: parts::TurnedOff,
}

impl Default for PanelState {
    fn default() -> Self {
        Self {
            tab: FIRST_TAB,
            document_number: 0,
            finding: Finding::default(),
            layers: layers::LayersState::default(),
            biomes: biomes::BiomesState::default(),
            structure: structure::StructureState::default(),
            turned_off: parts::TurnedOff::default(),
        }
    }
}

impl PanelState {
    /// Forgets selections and texts if they belong to another document than the one of this number. Filters stay: one
    /// may look at the same parameters of many random planets.
    pub fn keep_to_document(&mut self, document_number: u64) {
        if self.document_number != document_number {
            let finding = std::mem::take(&mut self.finding);
            *self = Self { tab: self.tab, document_number, finding, ..Self::default() };
        }
    }

    /// Whether the open tab paints the biome table.
    pub fn paints(&self) -> bool {
        PANELS.get(self.tab).is_some_and(|panel| panel.paints)
    }

    /// What the open tab shows on the planet, and which clicks and drags it takes.
    pub fn tab_link(&self) -> TabLink {
        match PANELS.get(self.tab) {
            Some(Panel { paints: true, .. }) => self.biomes.link(),
            Some(Panel { plates: true, .. }) => self.structure.link(),
            _ => TabLink::default(),
        }
    }

    /// A click on the planet. Gives the name of the edit.
    pub fn clicked(&mut self, planet: &mut Planet, click: Click, under: &UnderPointer) -> Option<String> {
        if click == Click::Plate {
            self.structure.clicked(planet, under);
            return None;
        }
        self.biomes.clicked(planet, click, under)
    }

    /// Shows the tabs, and the filter of the open one with its lock and its dice. Gives the part to vary if the dice
    /// were clicked.
    pub fn head(&mut self, ui: &mut egui::Ui, locks: &LockView, commands: &mut Commands) -> Option<&'static Panel> {
        self.tabs(ui, locks, commands);
        ui.separator();
        let panel = PANELS.get(self.tab)?;
        let mut rolled = false;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            // Room for the scroll bar of the panel, so that the row ends where those below do.
            let buttons = 20.0 + if panel.part.is_empty() { 0.0 } else { 24.0 };
            self.finding.field(ui, self.tab, panel.label, ui.available_width() - buttons - 14.0);
            let part = panel.label.to_lowercase();
            if !panel.part.is_empty() {
                let path = ParamPath::default().join(panel.part);
                let (icon, verb, told) = match locks.is_on(&path) {
                    true => {
                        (Icon::Lock, "Unlock", "Locked: variations and random planets keep this tab. Click to unlock")
                    }
                    false => (Icon::Open, "Lock", "Let variations and random planets keep this tab as it is"),
                };
                if icon_button(ui, icon, &format!("{verb} {part}"), told).clicked() {
                    locks.toggle(&path);
                }
            }
            let told = "Vary what is in this tab, as far as set under Planets > Variations; undo goes back";
            rolled = icon_button(ui, Icon::Dice, &format!("Vary {part}"), told).clicked();
        });
        ui.add_space(2.0);
        rolled.then_some(panel)
    }

    /// Shows the open tab.
    pub fn show(&mut self, ui: &mut egui::Ui, draft: &mut Draft<'_>) {
        let Some(panel) = PANELS.get(self.tab) else { return };
        egui::ScrollArea::vertical().id_salt(panel.label).auto_shrink([false, false]).show(ui, |ui| {
            // Room for the scroll bar, so that it never covers a control.
            ui.set_max_width(ui.available_width() - 10.0);
            ui.add_space(2.0);
            (panel.show)(ui, self, draft);
            self.finding.tell_if_empty(ui, self.tab, draft);
            ui.add_space(8.0);
        });
    }

    /// Does what another part of the editor has asked for.
    pub fn take(&mut self, planet: &Planet, asked: PanelAction) {
        match asked {
            PanelAction::Reveal { path, name } => self.reveal(planet, &path, name),
            PanelAction::TypeFilter => self.finding.take_focus(),
            PanelAction::ClearFilter => self.finding.clear(self.tab),
        }
    }

    /// Opens the tab of a parameter, and selects its layer, biome or plate there.
    fn reveal(&mut self, planet: &Planet, path: &ParamPath, name: &'static str) {
        let Some(tab) = Panel::of(path) else { return };
        self.tab = tab;
        self.finding.reveal(tab, path.clone(), name);
        match path.segments() {
            [Segment::Field("layers"), Segment::Index(index), ..] => self.layers.selected = *index,
            [Segment::Field("biomes"), Segment::Field("palette"), Segment::Index(index), ..] => {
                self.biomes.palette.selected = *index;
            }
            [
                Segment::Field("structure"),
                Segment::Field("plates"),
                Segment::Field("by_hand"),
                Segment::Index(index),
                ..,
            ] => {
                self.structure.choose(planet, *index);
            }
            _ => {}
        }
    }

    /// Index of the open tab.
    pub fn tab(&self) -> usize {
        self.tab
    }

    fn tabs(&mut self, ui: &mut egui::Ui, locks: &LockView, commands: &mut Commands) {
        const COLUMNS: usize = 5;
        ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
        let width = (ui.available_width() - 4.0 * (COLUMNS - 1) as f32) / COLUMNS as f32;
        for (row, panels) in PANELS.chunks(COLUMNS).enumerate() {
            ui.horizontal(|ui| {
                for (column, panel) in panels.iter().enumerate() {
                    let tab = row * COLUMNS + column;
                    let button = egui::Button::selectable(self.tab == tab, panel.label);
                    let response = ui.add_sized([width, 22.0], button);
                    if response.clicked() {
                        self.tab = tab;
                    }
                    response.context_menu(|ui| panel.menu(ui, locks, commands));
                }
            });
        }
    }
}

/// A list to choose one of several owners of parameters, in the place of the panel's own list while a filter hides it.
fn owner_box<'n>(ui: &mut egui::Ui, kind: &str, names: impl Iterator<Item = &'n str>, selected: &mut usize) {
    let names: Vec<&str> = names.collect();
    ui.horizontal(|ui| {
        ui.label(kind);
        egui::ComboBox::from_id_salt(kind)
            .selected_text(names.get(*selected).copied().unwrap_or("none"))
            .width(ui.available_width() - 8.0)
            .truncate()
            .show_ui(ui, |ui| {
                for (index, name) in names.iter().enumerate() {
                    ui.selectable_value(selected, index, *name);
                }
            })
            .response
            .accessible_name(format!("{kind} with these parameters"));
    });
    ui.add_space(4.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_a_planet_has_a_tab_but_the_editors_own() {
        for part in Planet::PARTS.iter().filter(|part| part.name != "editor") {
            let path = ParamPath::default().join(part.name).join("any");
            assert!(Panel::of(&path).is_some(), "{}", part.name);
        }
        assert_eq!(Panel::of(&ParamPath::default().join("radius_km")), Some(0));
        assert_eq!(Panel::of(&ParamPath::default().join("editor").join("bookmarks")), None);
    }
}
