//! The tabs: one for each part of the planet, in docks at the sides of the picture or in windows.
//!
//! Panels change a draft of the planet; the application makes an undo step of a changed draft. [`PANELS`] lists the
//! tabs: a new panel is a file and a row there.
//!
//! - [`layout`]: where each tab stands; [`docks`]: the docks and windows on screen
//! - [`finding`]: filters, and the parameter that was searched for
//! - [`sections`]: which parameters stand under which heading
//! - [`parts`]: planet, star, climate, and the optional parts; [`structure`]: plates, weather, rivers
//! - [`sculpt`], [`edit_list`], [`edit_points`]: tools, the list of ground edits, the points of one
//! - [`layers`], [`masks`], [`layer_edit`]: the terrain layers, and edits of their list
//! - [`life`]: populations of plants, stones and other objects
//! - [`biomes`], [`biome_table`], [`biome_canvas`], [`biome_palette`], [`biome_edit`]: the biome table: the tab, the
//!   table under the pointer, its picture, the palette, edits of both

pub mod biome_canvas;
pub mod biome_edit;
pub mod biome_palette;
pub mod biome_table;
pub mod biomes;
pub mod docks;
pub mod edit_list;
pub mod edit_points;
pub mod finding;
pub mod layer_edit;
pub mod layers;
pub mod layout;
pub mod life;
pub mod masks;
pub mod parts;
pub mod sculpt;
pub mod sections;
pub mod structure;

use crate::editor::command::{Action, ClipAction, Commands, PanelAction, Wanted};
use crate::editor::painter::survey::Survey;
use crate::editor::viewport::pointer::KnownPlace;
use crate::editor::viewport::{Click, TabLink, Viewport};
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::row_view::{LockView, RowView};
use crate::planet::param::{ParamPath, Segment};
use crate::planet::{Planet, Tool};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use finding::Finding;
use layout::Layout;
use life::LifeState;

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
    /// Whether the tab sculpts.
    sculpts: bool,
    /// Height in points from which the top of the tab stays and only the rest of it scrolls; None: all scrolls.
    stays_from: Option<f32>,
    show: fn(&mut egui::Ui, &mut PanelState, &mut Draft<'_>),
}

impl Panel {
    const fn new(
        label: &'static str,
        part: &'static str,
        show: fn(&mut egui::Ui, &mut PanelState, &mut Draft<'_>),
    ) -> Self {
        Self { label, part, paints: false, plates: false, sculpts: false, stays_from: None, show }
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

    const fn staying_from(self, height: f32) -> Self {
        Self { stays_from: Some(height), ..self }
    }

    const fn sculpting(self) -> Self {
        Self { sculpts: true, ..self }
    }

    const fn of_plates(self) -> Self {
        Self { plates: true, ..self }
    }
}

/// The tabs, in the order shown.
pub static PANELS: [Panel; 13] = [
    Panel::new("Planet", "", |ui, _, draft| parts::planet(ui, draft)),
    Panel::new("Terrain", "layers", |ui, state, draft| layers::show(ui, &mut state.layers, draft)).staying_from(320.0),
    Panel::new("Sculpt", "edits", |ui, state, draft| sculpt::show(ui, &mut state.sculpt, draft)).sculpting(),
    Panel::new("Structure", "structure", |ui, state, draft| {
        structure::show(ui, &mut state.structure, &mut state.turned_off, draft);
    })
    .of_plates(),
    Panel::new("Climate", "climate", |ui, _, draft| parts::climate(ui, draft)),
    Panel::new("Biomes", "biomes", |ui, state, draft| biomes::show(ui, &mut state.biomes, draft))
        .painting()
        .staying_from(560.0),
    Panel::new("Life", "life", |ui, state, draft| life::show(ui, &mut state.life, draft)).staying_from(320.0),
    Panel::new("Water", "water", |ui, state, draft| parts::water(ui, &mut state.turned_off, draft)),
    Panel::new("Atmosphere", "atmosphere", |ui, state, draft| parts::atmosphere(ui, &mut state.turned_off, draft)),
    Panel::new("Clouds", "clouds", |ui, state, draft| parts::clouds(ui, &mut state.turned_off, draft)),
    Panel::new("Gas giant", "giant", |ui, state, draft| parts::giant(ui, &mut state.turned_off, draft)),
    Panel::new("Rings", "rings", |ui, state, draft| parts::rings(ui, &mut state.turned_off, draft)),
    Panel::new("Star", "star", |ui, _, draft| parts::star(ui, draft)),
];

/// The planet as the panels change it.
pub struct Draft<'a> {
    /// A copy of the document's planet. If it differs from the document after the frame, it becomes an edit.
    pub planet: &'a mut Planet,
    /// The name of the edit; None names it after the changed parameters.
    pub label: Option<String>,
    /// Problems of the document's planet, the filter, and the parameter that was searched for.
    pub shown: RowView<'a>,
    /// The picture of the planet.
    pub viewport: &'a Viewport,
    /// The ground under the pointer.
    pub under_pointer: Option<&'a KnownPlace>,
    /// How the planet's land is spread over its biome table.
    pub survey: Option<&'a Survey>,
    /// Whether the top of the tab stays and only the rest of it scrolls.
    pub top_stays: bool,
    /// The commands of the panels, beside edits.
    pub commands: &'a mut Commands,
    /// Longitude of the eye, in degrees.
    pub eye_lon_deg: f64,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// Whether the stars of a system light the planet.
    pub in_system: bool,
}

impl Draft<'_> {
    /// Names the edit made in this frame.
    pub fn name_edit(&mut self, label: impl Into<String>) {
        self.label = Some(label.into());
    }
}

/// Selections and half-typed names. Not part of the document.
#[derive(Default)]
pub struct PanelState {
    /// Where each tab stands, and which ones are open.
    pub layout: Layout,
    /// Where a tab was dropped last: its window opens there.
    dropped_at: Option<egui::Pos2>,
    document_number: u64,
    /// Filters, and the parameter that was searched for.
    pub finding: Finding,
    layers: layers::LayersState,
    /// The biomes tab.
    pub biomes: biomes::BiomesState,
    life: LifeState,
    structure: structure::StructureState,
    /// The sculpt tab.
    pub sculpt: sculpt::SculptState,
    turned_off: parts::TurnedOff,
}

impl PanelState {
    /// The tabs in their places, with pictures on the window's device.
    pub fn new(layout: Layout, device: Option<&RenderState>) -> Self {
        Self { layout, life: LifeState::new(device), ..Self::default() }
    }

    /// Forgets selections and texts if they belong to another document than the one of this number. Filters stay: one
    /// may look at the same parameters of many random planets.
    pub fn keep_to_document(&mut self, document_number: u64) {
        if self.document_number != document_number {
            let (finding, layout) = (std::mem::take(&mut self.finding), self.layout.clone());
            let life = std::mem::take(&mut self.life).for_other_document();
            *self = Self { layout, document_number, finding, life, ..Self::default() };
        }
    }

    /// Whether a tab on screen paints the biome table.
    pub fn paints(&self) -> bool {
        self.layout.visible().any(|tab| PANELS[tab].paints)
    }

    /// What the tabs show on the planet, and which clicks and drags they take: the tab that was used last if it takes
    /// any, or else the first one on screen that does.
    pub fn tab_link(&self) -> TabLink {
        let links = |tab: &usize| PANELS[*tab].paints || PANELS[*tab].plates;
        let active = Some(self.layout.active()).filter(|tab| links(tab) && self.layout.visible().any(|t| t == *tab));
        let link = match active.or_else(|| self.layout.visible().find(links)).map(|tab| &PANELS[tab]) {
            Some(Panel { paints: true, .. }) => self.biomes.link(),
            Some(_) => self.structure.link(),
            None => TabLink::default(),
        };
        // A tool in hand takes all clicks.
        let sculpts = self.layout.visible().any(|tab| PANELS[tab].sculpts);
        let sculpt = if sculpts { self.sculpt.link() } else { Default::default() };
        // The mask of a layer shows while it is painted.
        let paints_mask = sculpt.brush.as_ref().is_some_and(|brush| matches!(brush.tool, Tool::Mask(_)));
        let shows_layers = self.layout.visible().any(|tab| PANELS[tab].part == "layers");
        let (mut solo, overlay) = self.layers.link();
        if !shows_layers {
            solo.clear();
        }
        let overlay = overlay.filter(|_| shows_layers || paints_mask);
        match sculpt.brush.is_some() || sculpt.measures {
            true => TabLink { solo, overlay, sculpt, ..TabLink::default() },
            false => TabLink { solo, overlay, sculpt, ..link },
        }
    }

    /// A click on the planet. Gives the name of the edit.
    pub fn clicked(&mut self, planet: &mut Planet, click: Click, under: &KnownPlace) -> Option<String> {
        match click {
            Click::Plate => {
                self.structure.clicked(planet, under);
                None
            }
            Click::Plant(ready) => self.life.planted(planet, ready, under),
            Click::Pick | Click::Paint => self.biomes.clicked(planet, click, under),
        }
    }

    /// Index of the population that is selected.
    pub fn population(&self) -> usize {
        self.life.selected
    }

    /// Shows the filter of a tab with its lock and its dice. Gives whether the dice were clicked.
    fn head(&mut self, ui: &mut egui::Ui, tab: usize, locks: &LockView) -> bool {
        let panel = &PANELS[tab];
        let mut rolled = false;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            // Room for the scroll bar of the panel, so that the row ends where those below do.
            let buttons = 20.0 + if panel.part.is_empty() { 0.0 } else { 24.0 };
            self.finding.field(ui, tab, panel.label, ui.available_width() - buttons - 14.0);
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
        rolled
    }

    /// Shows the rows of a tab.
    fn rows(&mut self, ui: &mut egui::Ui, tab: usize, draft: &mut Draft<'_>) {
        let panel = &PANELS[tab];
        // A filter lists rows alone: all of them scroll.
        let stays = panel.stays_from.is_some_and(|height| ui.available_height() >= height);
        draft.top_stays = stays && !draft.shown.filter.is_active();
        if draft.top_stays {
            ui.add_space(2.0);
            (panel.show)(ui, self, draft);
        } else {
            scrolled(ui, panel.label, |ui| {
                ui.add_space(2.0);
                (panel.show)(ui, self, draft);
                self.finding.tell_if_empty(ui, tab, draft);
            });
        }
    }

    /// Does what another part of the editor has asked for.
    pub fn take(&mut self, planet: &Planet, asked: PanelAction) {
        match asked {
            PanelAction::Reveal { path, name } => self.reveal(planet, &path, name),
            PanelAction::TypeFilter => self.finding.take_focus(),
            PanelAction::ClearFilter => self.finding.clear(self.layout.active()),
            PanelAction::ResetLayout => self.layout = Layout::default(),
            PanelAction::SelectLayers(first, count) => self.layers.select_all(&Vec::from_iter(first..first + count)),
            PanelAction::Sculpt(action) => {
                if let Some(tab) = PANELS.iter().position(|panel| panel.sculpts) {
                    self.layout.open(tab);
                }
                self.sculpt.act(planet, action);
            }
        }
    }

    /// Opens the tab of a parameter, and selects its layer, biome or plate there.
    fn reveal(&mut self, planet: &Planet, path: &ParamPath, name: &'static str) {
        let Some(tab) = Panel::of(path) else { return };
        self.layout.open(tab);
        self.finding.reveal(tab, path.clone(), name);
        match path.segments() {
            [Segment::Field("layers"), Segment::Index(index), ..] => self.layers.select(*index),
            [Segment::Field("life"), Segment::Index(index), ..] => self.life.selected = *index,
            [Segment::Field("edits"), Segment::Index(index), ..] => self.sculpt.select(*index),
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

    /// Index of the tab that was used last.
    pub fn tab(&self) -> usize {
        self.layout.active()
    }
}

/// Shows widgets in a scroll area that takes the room that is left.
fn scrolled(ui: &mut egui::Ui, id: &str, add: impl FnOnce(&mut egui::Ui)) {
    egui::ScrollArea::vertical().id_salt(id).auto_shrink([false, false]).show(ui, |ui| {
        // Room for the scroll bar, so that it never covers a control.
        ui.set_max_width(ui.available_width() - 10.0);
        add(ui);
        ui.add_space(8.0);
    });
}

/// Shows the rest of a tab, which scrolls by itself if the top of the tab stays.
fn rest(ui: &mut egui::Ui, draft: &mut Draft<'_>, id: &str, add: impl FnOnce(&mut egui::Ui, &mut Draft<'_>)) {
    if draft.top_stays {
        scrolled(ui, id, |ui| add(ui, draft));
    } else {
        add(ui, draft);
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
