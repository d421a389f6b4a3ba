//! Ready populations as small pictures: a click adds one, and a drag brings it into the list or onto the planet, where
//! it is on in the biome under the pointer.

use super::pictures::{BEHIND_SMALL, FormPictures};
use super::tab::LifeState;
use crate::editor::panels::Draft;
use crate::editor::viewport::ReadyDrag;
use crate::editor::widgets::random_seed;
use crate::planet::life::{READY_POPULATIONS, free_seed};
use crate::planet::param::Choice;
use crate::planet::{MAX_POPULATIONS, Planet, Population};
use eframe::egui::{self, Align2, Color32, Rect, pos2, vec2};

/// Least width of an entry, height of its picture and of its name, points.
const WIDTH: f32 = 80.0;
const PICTURE: f32 = 60.0;
const NAME: f32 = 16.0;
const GAP: f32 = 4.0;
/// Most height of all of them: the row that is cut off tells that there are more.
const MOST_HEIGHT: f32 = 2.4 * (PICTURE + NAME + GAP);

/// Shows the ready populations. Gives the one that was clicked.
pub(super) fn grid(ui: &mut egui::Ui, pictures: &mut FormPictures) -> Option<usize> {
    let mut clicked = None;
    let room = ui.ctx().content_rect().height();
    let scroll = egui::ScrollArea::vertical().id_salt("ready populations").max_height(MOST_HEIGHT.min(0.3 * room));
    scroll.show(ui, |ui| {
        let width = ui.available_width() - 10.0;
        let columns = ((width + GAP) / (WIDTH + GAP)).floor().max(1.0);
        let size = vec2((width - (columns - 1.0) * GAP) / columns, PICTURE + NAME);
        ui.spacing_mut().item_spacing = egui::Vec2::splat(GAP);
        for row in (0..READY_POPULATIONS.len()).collect::<Vec<_>>().chunks(columns as usize) {
            ui.horizontal(|ui| {
                for index in row {
                    if entry(ui, pictures, *index, size).clicked() {
                        clicked = Some(*index);
                    }
                }
            });
        }
    });
    clicked
}

fn entry(ui: &mut egui::Ui, pictures: &mut FormPictures, index: usize, size: egui::Vec2) -> egui::Response {
    let ready = &READY_POPULATIONS[index];
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), ready.name));
    response.dnd_set_drag_payload(ReadyDrag(index));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact(&response);
        let (upper, lower) = rect.split_top_bottom_at_y(rect.bottom() - NAME);
        let painter = ui.painter();
        painter.rect_filled(rect, 3.0, BEHIND_SMALL);
        picture(ui.painter(), pictures.ready(ui.ctx(), index, upper.size() * ui.ctx().pixels_per_point()), upper);
        let font = egui::TextStyle::Small.resolve(ui.style());
        let clipped = ui.painter_at(lower.shrink2(vec2(2.0, 0.0)));
        clipped.text(lower.center(), Align2::CENTER_CENTER, ready.name, font, Color32::from_gray(225));
        if response.hovered() || response.has_focus() {
            painter.rect_stroke(rect, 3.0, (1.5, visuals.fg_stroke.color), egui::StrokeKind::Inside);
        }
    }
    response.on_hover_ui(|ui| {
        let population = ready.population();
        let form = population.form.labels()[population.form.index()].to_lowercase();
        let Population { per_hectare, height_m, .. } = population;
        ui.label(format!("{}: {per_hectare} on a hectare, {height_m} m high: {form}", ready.name));
        ui.weak("Click to add it, or drag it into the list or onto the planet");
    })
}

fn picture(painter: &egui::Painter, texture: Option<egui::TextureId>, rect: Rect) {
    if let Some(texture) = texture {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(texture, rect, whole, Color32::WHITE);
    }
}

/// Paints what is dragged beside the pointer, and where it would go.
pub(super) fn ghost(ui: &egui::Ui, pictures: &mut FormPictures, draft: &Draft<'_>) {
    let Some(dragged) = egui::DragAndDrop::payload::<ReadyDrag>(ui.ctx()) else { return };
    let Some((pointer, ready)) = ui.ctx().pointer_interact_pos().zip(READY_POPULATIONS.get(dragged.0)) else { return };
    ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
    let biome = draft.under_pointer.filter(|_| draft.viewport.rect().contains(pointer)).map(|under| &under.biome);
    let text = biome.map_or_else(|| ready.name.to_owned(), |biome| format!("{} in {biome}", ready.name));
    let layer = egui::LayerId::new(egui::Order::Tooltip, egui::Id::unique("dragged population"));
    let painter = ui.ctx().layer_painter(layer);
    let font = egui::TextStyle::Body.resolve(ui.style());
    let galley = painter.layout_no_wrap(text, font, ui.visuals().strong_text_color());
    let size = vec2(galley.size().x.max(PICTURE), PICTURE + galley.size().y + 4.0);
    // Within the window.
    let most = (ui.ctx().content_rect().right() - size.x - 8.0).max(0.0);
    let corner = pos2((pointer.x + 14.0).min(most), pointer.y + 10.0);
    let rect = Rect::from_min_size(corner, size).expand(5.0);
    painter.rect_filled(rect, 4.0, ui.visuals().window_fill.gamma_multiply(0.92));
    let own = Rect::from_min_size(corner, vec2(size.x.min(1.4 * PICTURE), PICTURE));
    let pixels = own.size() * ui.ctx().pixels_per_point();
    picture(&painter, pictures.ready(ui.ctx(), dragged.0, pixels), own);
    painter.galley(corner + vec2(0.0, PICTURE + 3.0), galley, ui.visuals().strong_text_color());
}

/// Whether one more population has room.
pub(super) fn has_room(planet: &Planet) -> bool {
    planet.life.len() < MAX_POPULATIONS && planet.giant.is_none()
}

/// Adds a ready population before the one of an index, in a biome alone if one is given, and selects it. Gives the name
/// of the edit.
pub(super) fn add(
    state: &mut LifeState,
    planet: &mut Planet,
    index: usize,
    at: usize,
    biome: Option<char>,
) -> Option<String> {
    let ready = READY_POPULATIONS.get(index).filter(|_| has_room(planet))?;
    let mut population = ready.population();
    population.seed = free_seed(&planet.life, random_seed() as u32);
    population.name = unique_name(planet, ready.name);
    population.biomes = biome.map_or(population.biomes, String::from);
    state.selected = at.min(planet.life.len());
    planet.life.insert(state.selected, population);
    Some(format!("Add population: {}", ready.name.to_lowercase()))
}

/// The name, with a number if another population has it.
pub(super) fn unique_name(planet: &Planet, name: &str) -> String {
    let is_free = |name: &String| planet.life.iter().all(|population| population.name != *name);
    let numbered = (2..).map(|number| format!("{name} {number}"));
    [name.to_owned()].into_iter().chain(numbered).find(is_free).unwrap_or_default()
}
