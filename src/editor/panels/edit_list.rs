//! The list of ground edits in the sculpt tab: found, hidden, moved, flown to, baked into a height picture.

use super::Draft;
use super::sculpt::SculptState;
use crate::bake::EditBake;
use crate::editor::command::{Action, BakeAction};
use crate::editor::finder::place::Place;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::number::length_text;
use crate::planet::Tool;
use crate::planet::edits::{EditPoint, GroundEdit};
use crate::planet::param::Choice;
use crate::sphere::LatLon;
use eframe::egui::{self, AtomExt};

/// Share of the tab's height that the list takes at most.
const LIST_SHARE: f32 = 0.3;
/// Height of a row of the list, in points.
const ROW: f32 = 20.0;

/// The edits, in the order in which they act.
pub fn show(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>) {
    let count = draft.planet.edits.len();
    ui.horizontal(|ui| {
        ui.strong("Edits");
        ui.weak(format!("{count}"));
        let chosen = state.selected;
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            buttons(ui, state, draft, chosen);
            let edit =
                egui::TextEdit::singleline(&mut state.find).hint_text("Find").desired_width(ui.available_width());
            ui.add(edit).accessible_name("Find edits");
        });
    });
    if count == 0 {
        ui.weak("There are none yet.");
        return;
    }
    if draft.planet.edits.is_full() {
        ui.weak("A planet may not have more edits: bake some of them into a picture.");
    }
    let words: Vec<String> = state.find.split_whitespace().map(str::to_lowercase).collect();
    let fits = |edit: &GroundEdit| {
        let text = format!("{} {}", edit.name, tool_label(edit)).to_lowercase();
        words.iter().all(|word| text.contains(word.as_str()))
    };
    let shown: Vec<usize> = match words.is_empty() {
        true => (0..draft.planet.edits.len()).collect(),
        false => draft.planet.edits.iter().enumerate().filter(|(_, edit)| fits(edit)).map(|(index, _)| index).collect(),
    };
    let height = (LIST_SHARE * ui.ctx().content_rect().height()).max(4.0 * ROW);
    let mut area = egui::ScrollArea::vertical().id_salt("list of edits").max_height(height).auto_shrink([false, true]);
    if let Some(row) = state.scroll_to.take().and_then(|index| shown.iter().position(|other| *other == index)) {
        let step = ROW + ui.spacing().item_spacing.y;
        area = area.vertical_scroll_offset((row as f32 * step - 0.5 * height).max(0.0));
    }
    area.show_rows(ui, ROW, shown.len(), |ui, rows| {
        ui.set_max_width(ui.available_width() - 10.0);
        for index in shown.get(rows).unwrap_or_default() {
            row(ui, state, draft, *index);
        }
    });
    baking(ui, state, draft, &shown);
}

/// Offers to bake the edits that the list shows, or tells how far that is.
fn baking(ui: &mut egui::Ui, state: &SculptState, draft: &mut Draft<'_>, shown: &[usize]) {
    ui.horizontal(|ui| {
        if let Some(done) = state.baked {
            ui.add(egui::ProgressBar::new(done as f32).desired_width(160.0).show_percentage());
            let stop = ui.button("Stop").on_hover_text("The edits stay as they are");
            if stop.accessible_name("Stop baking edits").clicked() {
                draft.commands.push(Action::Bake(BakeAction::CancelEdits));
            }
            return;
        }
        let edits = &draft.planet.edits;
        let bakes = |index: &&usize| edits.get(**index).is_some_and(EditBake::can_bake);
        let count = shown.iter().filter(bakes).count();
        let told = "Makes one height picture of the edits in the list that are on and change the ground, and puts it in \
                    their place as a stamp. Find fewer to bake a part of them. Undo brings them back.";
        let button = ui.add_enabled(count > 0, egui::Button::new(format!("Bake {count} into picture…")));
        let button = button.on_hover_text(told).on_disabled_hover_text("No edit in the list is on and changes the ground");
        if button.accessible_name("Bake edits").clicked() {
            draft.commands.push(Action::Bake(BakeAction::Edits(shown.iter().filter(bakes).copied().collect())));
        }
    });
}

fn row(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>, index: usize) {
    let Some(edit) = draft.planet.edits.get(index) else { return };
    let (name, mut enabled, label) = (edit.name.clone(), edit.enabled, tool_label(edit));
    let details = format!("{label} · {}", length_text(edit.radius_km * 1000.0));
    ui.horizontal(|ui| {
        let check = ui.add(egui::Checkbox::without_text(&mut enabled)).on_hover_text("Whether it changes the ground");
        if check.accessible_name(format!("Enabled of {name}")).changed()
            && let Some(edit) = draft.planet.edits.get_mut(index)
        {
            edit.enabled = enabled;
            draft.name_edit(format!("{} {name}", if enabled { "Show" } else { "Hide" }));
        }
        let text = egui::RichText::new(&name);
        let text = if enabled { text } else { text.weak() };
        let atoms =
            (egui::Atom::from(text).atom_shrink(true), egui::Atom::grow(), egui::RichText::new(details).weak().small());
        let button = egui::Button::selectable(state.selected == Some(index), atoms).truncate();
        let response = ui.add(button.min_size(egui::vec2(ui.available_width(), ROW)));
        let response = response.on_hover_text("Click to select; double-click to fly there");
        if response.clicked() {
            state.selected = Some(index);
        }
        if response.double_clicked() {
            go_to(draft, index);
        }
        response.accessible_name(format!("Edit {name}"));
    });
}

/// What can be done with the selected edit.
fn buttons(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>, chosen: Option<usize>) {
    let count = draft.planet.edits.len();
    let name = chosen.and_then(|index| draft.planet.edits.get(index)).map(|edit| edit.name.clone()).unwrap_or_default();
    ui.add_enabled_ui(chosen.is_some(), |ui| {
        if icon_button(ui, Icon::Remove, "Remove edit", "Remove the selected edit").clicked()
            && let Some(index) = chosen
        {
            draft.planet.edits.remove(index);
            state.selected = (count > 1).then(|| index.min(count - 2));
            draft.name_edit(format!("Remove {name}"));
        }
    });
    for (icon, verb, down) in [(Icon::Down, "Move edit down", true), (Icon::Up, "Move edit up", false)] {
        let to =
            chosen.and_then(|index| if down { Some(index + 1).filter(|to| *to < count) } else { index.checked_sub(1) });
        ui.add_enabled_ui(to.is_some(), |ui| {
            if icon_button(ui, icon, verb, "Edits act from first to last").clicked()
                && let (Some(from), Some(to)) = (chosen, to)
            {
                draft.planet.edits.shift(from, to);
                state.select(to);
                draft.name_edit(format!("Move {name}"));
            }
        });
    }
    ui.add_enabled_ui(chosen.is_some() && !draft.planet.edits.is_full(), |ui| {
        if icon_button(ui, Icon::Duplicate, "Duplicate edit", "Add a copy behind the selected edit").clicked()
            && let Some(index) = chosen
            && let Some(copy) = draft.planet.edits.get(index).cloned()
        {
            draft.planet.edits.insert(index + 1, copy);
            state.select(index + 1);
            draft.name_edit(format!("Duplicate {name}"));
        }
    });
    ui.add_enabled_ui(chosen.is_some(), |ui| {
        if ui.button("Go to").on_hover_text("Fly to the selected edit").accessible_name("Go to edit").clicked()
            && let Some(index) = chosen
        {
            go_to(draft, index);
        }
    });
}

/// Flies to an edit, as high as it is wide.
fn go_to(draft: &mut Draft<'_>, index: usize) {
    let Some(edit) = draft.planet.edits.get(index) else { return };
    let middle: glam::DVec3 = edit.points.0.iter().map(EditPoint::direction).sum();
    let middle = middle.try_normalize().unwrap_or(glam::DVec3::Z);
    let spread_rad = edit.points.0.iter().map(|point| point.direction().angle_between(middle)).fold(0.0, f64::max);
    let size_m = spread_rad * draft.planet.radius_m() + edit.radius_km * 1000.0;
    let (lat_deg, lon_deg) = LatLon::from_direction(middle).to_degrees();
    draft.commands.push(Action::GoToPlace(Place { lat_deg, lon_deg, altitude_m: Some(3.0 * size_m) }));
}

fn tool_label(edit: &GroundEdit) -> &'static str {
    Tool::LABELS.get(edit.tool.index()).copied().unwrap_or_default()
}
