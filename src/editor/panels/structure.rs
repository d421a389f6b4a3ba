//! The structure tab: plates, weather, rivers, and the plates that are changed by hand.

use super::Draft;
use super::parts::{TurnedOff, switch};
use crate::editor::command::Command;
use crate::editor::viewport::TabLink;
use crate::editor::viewport::pointer::KnownPlace;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::planet::param::{ParamPath, Params, Segment};
use crate::planet::{Planet, PlateByHand, Structure};
use crate::render::DebugView;
use eframe::egui;

/// The plate that is chosen.
#[derive(Default)]
pub struct StructureState {
    picked: Option<Picked>,
}

struct Picked {
    plate: u32,
    /// As it was laid out, if it was chosen on the planet.
    laid_out: Option<PlateByHand>,
    /// See [`layout_of`].
    layout: [u32; 3],
}

/// Numbers that decide which plate has which number.
fn layout_of(planet: &Planet) -> [u32; 3] {
    let plates = planet.structure.as_ref().map(|structure| &structure.plates);
    plates.map_or([0; 3], |plates| [planet.seed, plates.seed, plates.count])
}

impl StructureState {
    /// Which clicks and drags the tab takes.
    pub fn link(&self) -> TabLink {
        TabLink { plates: true, ..TabLink::default() }
    }

    /// Chooses the plate of this entry of the plates that are changed by hand.
    pub fn choose(&mut self, planet: &Planet, index: usize) {
        let plates = planet.structure.as_ref().map(|structure| &structure.plates);
        let layout = layout_of(planet);
        let entry = plates.and_then(|plates| plates.by_hand.get(index));
        self.picked = entry.map(|entry| Picked { plate: entry.plate, laid_out: None, layout });
    }

    /// A click on the planet: chooses the plate there.
    pub fn clicked(&mut self, planet: &Planet, under: &KnownPlace) {
        let layout = layout_of(planet);
        let picked = |entry: &PlateByHand| Picked { plate: entry.plate, laid_out: Some(entry.clone()), layout };
        self.picked = under.plate.as_ref().map(picked);
    }
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut StructureState, turned_off: &mut TurnedOff, draft: &mut Draft<'_>) {
    let shown = draft.shown;
    if !shown.filter.is_active() {
        ui.weak("Plates push up land, winds rain on it, rivers carve it. Layers lie over it, or under it.");
        ui.add_space(4.0);
    }
    let label = switch(ui, &shown, "structure", &mut draft.planet.structure, &mut turned_off.structure);
    draft.label = label.or(draft.label.take());
    if draft.planet.structure.is_none() {
        return;
    }
    for (title, field) in [("Plates", "plates"), ("Weather", "weather"), ("Rivers", "rivers")] {
        let base = ParamPath::from(vec![Segment::Field("structure"), Segment::Field(field)]);
        if shown.filter.is_active() {
            // Folded sections would hide what was found.
            filtered(ui, title, &base, draft);
            continue;
        }
        let header = egui::CollapsingHeader::new(title).default_open(field == "plates");
        header.open(shown.reveals_in(&base).then_some(true)).show(ui, |ui| {
            part(ui, field, draft);
            if field == "plates" {
                ui.add_space(4.0);
                by_hand(ui, state, draft);
            }
        });
    }
    ui.add_space(4.0);
    let base = ParamPath::from(vec![Segment::Field("structure")]);
    let skip: Vec<&str> = Structure::PARTS.iter().map(|part| part.name).collect();
    let grid = Grid { base, owner: "structure", skip: &skip, shown: draft.shown, biomes: &[] };
    if let Some(structure) = &mut draft.planet.structure {
        params_grid(ui, &grid, structure, &mut Structure::default());
    }
}

/// The parameters of a section that pass the filter, if there are any.
fn filtered(ui: &mut egui::Ui, title: &str, base: &ParamPath, draft: &mut Draft<'_>) {
    let Some(&Segment::Field(field)) = base.segments().last() else { return };
    let passes = draft.planet.structure.as_ref().is_some_and(|structure| {
        let part: &dyn Params = match field {
            "plates" => &structure.plates,
            "weather" => &structure.weather,
            _ => &structure.rivers,
        };
        draft.shown.passes_any(base, part, &["by_hand"])
    });
    if passes {
        ui.strong(title);
        part(ui, field, draft);
    }
}

fn part(ui: &mut egui::Ui, field: &'static str, draft: &mut Draft<'_>) {
    let (Some(structure), mut defaults) = (&mut draft.planet.structure, Structure::default()) else { return };
    let (part, default): (&mut dyn Params, &mut dyn Params) = match field {
        "plates" => (&mut structure.plates, &mut defaults.plates),
        "weather" => (&mut structure.weather, &mut defaults.weather),
        _ => (&mut structure.rivers, &mut defaults.rivers),
    };
    let base = ParamPath::from(vec![Segment::Field("structure"), Segment::Field(field)]);
    let grid = Grid { base, owner: field, skip: &["by_hand"], shown: draft.shown, biomes: &[] };
    params_grid(ui, &grid, part, default);
}

/// The path of a plate that is changed by hand.
fn by_hand_path(index: usize) -> ParamPath {
    let path = ["structure", "plates", "by_hand"].map(Segment::Field).into_iter().chain([Segment::Index(index)]);
    ParamPath::from(path.collect::<Vec<_>>())
}

/// The plates that are changed by hand, and the one that is chosen.
fn by_hand(ui: &mut egui::Ui, state: &mut StructureState, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        ui.strong("By hand");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.button("Show plates").on_hover_text("Show the plates and their motion on the planet").clicked() {
                draft.commands.send(Command::Show(DebugView::Plates));
            }
        });
    });
    ui.weak("Click a plate on the planet to choose it. Ctrl and drag moves it, with its continents.");
    let layout = layout_of(draft.planet);
    if state.picked.as_ref().is_some_and(|picked| picked.layout != layout) {
        state.picked = None;
    }
    let shown = draft.shown;
    let Some(structure) = &mut draft.planet.structure else { return };
    let plates = &mut structure.plates;
    let picked = state.picked.as_ref().map(|picked| picked.plate);
    let mut removed = None;
    for (index, entry) in plates.by_hand.iter().enumerate() {
        ui.horizontal(|ui| {
            let name = format!("Plate {}", entry.plate);
            let row = shown.marked(ui, &by_hand_path(index).join("plate"), "plate", |ui| {
                ui.selectable_label(picked == Some(entry.plate), &name)
            });
            if row.clicked() {
                state.picked = Some(Picked { plate: entry.plate, laid_out: None, layout });
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if icon_button(ui, Icon::Remove, &format!("Lay out {name}"), "Back to the layout").clicked() {
                    removed = Some(index);
                }
            });
        });
    }
    if let Some(index) = removed {
        let entry = plates.by_hand.remove(index);
        draft.label = Some(format!("Lay out plate {}", entry.plate));
        return;
    }
    let Some(picked) = &state.picked else { return };
    let found = plates.by_hand.iter().position(|entry| entry.plate == picked.plate);
    let index = found.unwrap_or(plates.by_hand.len());
    let Some(before) = found.map(|index| plates.by_hand[index].clone()).or_else(|| picked.laid_out.clone()) else {
        return;
    };
    let mut laid_out = picked.laid_out.clone().unwrap_or_else(|| before.clone());
    let mut entry = before.clone();
    let owner = format!("plate {}", entry.plate);
    if found.is_none() {
        ui.strong(format!("Plate {}", entry.plate));
    }
    let grid = Grid { base: by_hand_path(index), owner: &owner, skip: &["plate"], shown: draft.shown, biomes: &[] };
    params_grid(ui, &grid, &mut entry, &mut laid_out);
    if entry != before {
        draft.label = Some(format!("Change {owner}"));
        plates.set_by_hand(entry);
    }
}
