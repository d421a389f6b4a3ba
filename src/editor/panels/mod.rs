//! The side panel: one tab for each part of the planet.
//!
//! Panels change a draft of the planet; the application turns a changed draft into an undo step.
//!
//! - [`parts`]: planet, star, climate, and the parts a planet may lack
//! - [`layers`], [`masks`], [`layer_edit`]: the terrain layers; what is done to them
//! - [`biomes`], [`biome_table`], [`biome_canvas`], [`biome_palette`], [`biome_edit`]: the painter of the biome table: the tab, the
//!   table under the pointer, its picture, the palette, what is done to them

pub mod biome_canvas;
pub mod biome_edit;
pub mod biome_palette;
pub mod biome_table;
pub mod biomes;
pub mod layer_edit;
pub mod layers;
pub mod masks;
pub mod parts;

use crate::editor::command::Command;
use crate::editor::painter::survey::Survey;
use crate::editor::viewport::pointer::UnderPointer;
use crate::planet::Planet;
use crate::planet::param::ParamPath;
use eframe::egui;

/// A part of the planet, as a tab.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Tab {
    Planet,
    Star,
    #[default]
    Terrain,
    Climate,
    Biomes,
    Water,
    Atmosphere,
    Clouds,
}

impl Tab {
    /// All of them, in the order shown.
    pub const ALL: [Tab; 8] =
        [Tab::Planet, Tab::Terrain, Tab::Climate, Tab::Biomes, Tab::Water, Tab::Atmosphere, Tab::Clouds, Tab::Star];

    /// The name a person reads.
    pub fn label(self) -> &'static str {
        match self {
            Tab::Planet => "Planet",
            Tab::Star => "Star",
            Tab::Terrain => "Terrain",
            Tab::Climate => "Climate",
            Tab::Biomes => "Biomes",
            Tab::Water => "Water",
            Tab::Atmosphere => "Air",
            Tab::Clouds => "Clouds",
        }
    }
}

/// The planet under the panels' hands.
pub struct Draft<'a> {
    /// Changed freely; what differs from the document becomes an edit.
    pub planet: &'a mut Planet,
    /// What to call the edit; None names it after what changed.
    pub label: Option<String>,
    /// The parameter for which a file is to be chosen.
    pub browse: Option<ParamPath>,
    /// Everything wrong with the document's planet.
    pub problems: &'a [(ParamPath, String)],
    /// The ground under the pointer.
    pub under_pointer: Option<&'a UnderPointer>,
    /// Where the planet lies in its biome table.
    pub survey: Option<&'a Survey>,
    /// What is asked for beside edits.
    pub commands: Vec<Command>,
    /// Longitude of the eye, and seconds since time zero.
    pub here: (f64, f64),
}

impl Draft<'_> {
    /// Names the edit made in this frame.
    pub fn name_edit(&mut self, label: impl Into<String>) {
        self.label = Some(label.into());
    }
}

/// Live state of the panels: selections and half-typed names. Not part of the document.
#[derive(Default)]
pub struct PanelState {
    /// The tab on top.
    pub tab: Tab,
    /// The layers tab.
    pub layers: layers::LayersState,
    /// The biomes tab.
    pub biomes: biomes::BiomesState,
    /// Parts that were turned off.
    pub remembered: parts::Remembered,
}

impl PanelState {
    /// Forgets what belonged to another document.
    pub fn new_document(&mut self) {
        *self = Self { tab: self.tab, ..Self::default() };
    }

    /// Shows the tabs and the one on top.
    pub fn show(&mut self, ui: &mut egui::Ui, draft: &mut Draft<'_>) {
        self.tabs(ui);
        ui.separator();
        egui::ScrollArea::vertical().id_salt(self.tab.label()).auto_shrink([false, false]).show(ui, |ui| {
            // Room for the scroll bar, so that it never covers a control.
            ui.set_max_width(ui.available_width() - 10.0);
            ui.add_space(2.0);
            match self.tab {
                Tab::Planet => parts::planet(ui, draft),
                Tab::Star => parts::star(ui, draft),
                Tab::Terrain => layers::show(ui, &mut self.layers, draft),
                Tab::Climate => parts::climate(ui, draft),
                Tab::Biomes => biomes::show(ui, &mut self.biomes, draft),
                Tab::Water => parts::water(ui, &mut self.remembered, draft),
                Tab::Atmosphere => parts::atmosphere(ui, &mut self.remembered, draft),
                Tab::Clouds => parts::clouds(ui, &mut self.remembered, draft),
            }
            ui.add_space(8.0);
        });
    }

    fn tabs(&mut self, ui: &mut egui::Ui) {
        ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
        let columns = 4;
        let width = (ui.available_width() - 4.0 * (columns - 1) as f32) / columns as f32;
        for row in Tab::ALL.chunks(columns) {
            ui.horizontal(|ui| {
                for &tab in row {
                    let button = egui::Button::selectable(self.tab == tab, tab.label());
                    if ui.add_sized([width, 22.0], button).clicked() {
                        self.tab = tab;
                    }
                }
            });
        }
    }
}
