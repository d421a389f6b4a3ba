//! The parts of the life tab, and the parameters of the selected population.

use super::form_box::FormBox;
use super::pictures::FormPictures;
use super::{list, ready};
use crate::editor::command::{Action, Command};
use crate::editor::panels::{Draft, biomes, owner_box, rest};
use crate::editor::state::surveyor::{Asked, Surveyor, same_heights};
use crate::editor::viewport::ReadyDrag;
use crate::editor::viewport::pointer::KnownPlace;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::random_seed;
use crate::planet::life::{free_seed, population_path};
use crate::planet::param::Choice;
use crate::planet::{Form, Planet, Population};
use crate::render::DebugView;
use crate::terrain::Terrain;
use eframe::egui;
use eframe::egui_wgpu::RenderState;

/// Share of the tab's height that the list takes at most.
const LIST_SHARE: f32 = 0.42;

/// About how many objects of each population stand on a planet.
pub(super) struct Census(Vec<(String, u32, Option<f64>)>);

impl Census {
    fn new(terrain: &Terrain) -> Self {
        let counts = terrain.planet().life.iter().zip(terrain.estimated_objects());
        Self(counts.map(|(population, count)| (population.name.clone(), population.seed, count)).collect())
    }

    /// The count of a population, if it is known.
    pub(super) fn of(&self, population: &Population) -> Option<f64> {
        let is_it = |name: &str, seed: u32| *name == population.name && seed == population.seed;
        self.0.iter().find(|(name, seed, _)| is_it(name, *seed)).and_then(|(.., count)| *count)
    }
}

/// Whether two terrains have as many objects.
fn same_census(asked: &Asked, terrain: &Terrain) -> bool {
    let (a, b) = (&asked.planet, terrain.planet());
    let places = |planet: &Planet| planet.life.iter().map(Population::placed).collect::<Vec<_>>();
    let names = |planet: &Planet| planet.life.iter().map(|population| population.name.clone()).collect::<Vec<_>>();
    let same_rules = a.biomes == b.biomes && a.climate == b.climate && a.edits == b.edits;
    same_rules && places(a) == places(b) && names(a) == names(b) && same_heights(asked, terrain)
}

/// The selection, and what the tab has found.
#[derive(Default)]
pub struct LifeState {
    /// Index of the population whose parameters are shown.
    pub selected: usize,
    /// Whether the ready populations are shown; None: while there is no population.
    shows_ready: Option<bool>,
    form_box: FormBox,
    pictures: FormPictures,
    census: Option<Surveyor<Census>>,
}

impl LifeState {
    /// The tab with pictures on the window's device.
    pub fn new(state: Option<&RenderState>) -> Self {
        Self { pictures: FormPictures::new(state), ..Self::default() }
    }

    /// The tab for another document.
    #[must_use]
    pub fn for_other_document(self) -> Self {
        Self { pictures: self.pictures, ..Self::default() }
    }

    /// The newest census.
    pub(super) fn census(&self) -> Option<&Census> {
        self.census.as_ref()?.found()
    }

    /// Asks for a census while no slider is dragged: the picture comes first.
    fn count(&mut self, ui: &egui::Ui, draft: &Draft<'_>) {
        let census = self.census.get_or_insert_with(|| {
            let ctx = ui.ctx().clone();
            Surveyor::new(Census::new, same_census, move || ctx.request_repaint())
        });
        if let Some(surface) = draft.viewport.surface().filter(|_| !ui.input(|input| input.pointer.any_down())) {
            census.ask(&surface.terrain);
        }
    }

    /// A ready population was dropped on the planet: it is on in the biome there. Gives the name of the edit.
    pub fn planted(&mut self, planet: &mut Planet, ready: usize, under: &KnownPlace) -> Option<String> {
        let biome = planet.biomes.palette.get(under.sample.biome).map(|biome| biome.key);
        let last = planet.life.len();
        ready::add(self, planet, ready, last, biome)
    }
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) {
    state.selected = state.selected.min(draft.planet.life.len().saturating_sub(1));
    if draft.shown.filter.is_active() {
        let names = draft.planet.life.iter().map(|population| population.name.as_str());
        owner_box(ui, "Population", names, &mut state.selected);
    } else {
        let whole = ui.available_rect_before_wrap();
        state.count(ui, draft);
        toolbar(ui, state, draft);
        let mut dropped = None;
        if state.shows_ready.unwrap_or(draft.planet.life.is_empty()) && ready::has_room(draft.planet) {
            let last = draft.planet.life.len();
            if let Some(clicked) = ready::grid(ui, &mut state.pictures) {
                dropped = Some((clicked, last));
                state.shows_ready = Some(true);
            }
        }
        let below = egui::Rect::from_min_max(ui.cursor().min, whole.max);
        if draft.top_stays {
            let height = LIST_SHARE * ui.available_height();
            egui::ScrollArea::vertical().id_salt("list of populations").max_height(height).show(ui, |ui| {
                ui.set_max_width(ui.available_width() - 10.0);
                dropped = dropped.or(list::show(ui, state, draft));
            });
        } else {
            dropped = dropped.or(list::show(ui, state, draft));
        }
        ready::ghost(ui, &mut state.pictures, draft);
        if let Some((index, gap)) = dropped.or_else(|| dropped_below(ui, below, draft.planet.life.len())) {
            draft.label = ready::add(state, draft.planet, index, gap, None).or_else(|| draft.label.take());
        }
        ui.separator();
    }
    rest(ui, draft, "population", |ui, draft| match draft.planet.life.get(state.selected) {
        Some(_) => selected(ui, state, draft),
        None if draft.planet.giant.is_some() => {
            ui.weak("A gas giant has no ground on which something could stand.");
        }
        None => {
            ui.weak("Nothing stands on the ground yet. Click plants or stones above, or drag them onto the planet.");
        }
    });
}

/// The ready population that was dropped in the room below the grid, but between no rows: it goes to the end.
fn dropped_below(ui: &egui::Ui, below: egui::Rect, last: usize) -> Option<(usize, usize)> {
    let is_over = ui.ctx().pointer_interact_pos().is_some_and(|at| below.contains(at) && ui.clip_rect().contains(at));
    if !is_over || !ui.input(|input| input.pointer.any_released()) {
        return None;
    }
    egui::DragAndDrop::take_payload::<ReadyDrag>(ui.ctx()).map(|ready| (ready.0, last))
}

fn toolbar(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        let (count, at) = (draft.planet.life.len(), state.selected);
        let has_room = ready::has_room(draft.planet);
        ui.add_enabled_ui(has_room, |ui| {
            let is_open = state.shows_ready.unwrap_or(count == 0);
            let button = egui::Button::new("Add population").selected(is_open && has_room);
            if ui.add(button).on_hover_text("Show plants and stones to start from").clicked() {
                state.shows_ready = Some(!is_open);
            }
        });
        ui.add_enabled_ui(count > 0 && has_room, |ui| {
            let told = "Duplicate the selected population";
            if icon_button(ui, Icon::Duplicate, "Duplicate population", told).clicked() {
                let copy = draft.planet.life[at].clone();
                let seed = free_seed(&draft.planet.life, random_seed() as u32);
                let name = ready::unique_name(draft.planet, &copy.name);
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
            let is_shown = draft.viewport.settings.debug_view == DebugView::Density;
            let button = egui::Button::new("Show density").selected(is_shown);
            let told = "Colour the planet by how many objects of the selected population stand where";
            if ui.add(button).on_hover_text(told).clicked() {
                draft.commands.send(Command::Show(if is_shown { DebugView::Shaded } else { DebugView::Density }));
            }
        });
    });
}

fn selected(ui: &mut egui::Ui, state: &mut LifeState, draft: &mut Draft<'_>) {
    let index = state.selected;
    if !draft.shown.filter.is_active() {
        state.form_box.show(ui, &mut state.pictures, &draft.planet.life[index]);
    }
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
