//! Fields for a choice: one of several names, a biome of the palette, or a population.

use super::param_row::BiomeName;
use crate::planet::Planet;
use crate::planet::param::Choice;
use eframe::egui;

/// The choice as a list that opens.
pub fn choice_box(ui: &mut egui::Ui, name: &str, choice: &mut dyn Choice) {
    let names = choice.labels();
    let current = choice.index();
    let mut chosen = current;
    egui::ComboBox::from_id_salt("choice")
        .selected_text(names.get(current).copied().unwrap_or_default())
        .width(ui.available_width().min(160.0))
        .show_ui(ui, |ui| {
            for (index, text) in names.iter().enumerate() {
                ui.selectable_value(&mut chosen, index, *text);
            }
        })
        .response
        .accessible_name(name);
    if chosen != current {
        choice.set_index(chosen);
    }
}

/// The biomes of the palette, by colour and name. A key of no biome shows as "None".
pub fn biome_box(ui: &mut egui::Ui, name: &str, key: &mut char, biomes: &[BiomeName]) {
    let chosen = biomes.iter().find(|biome| biome.key == *key);
    let height = ui.spacing().interact_size.y;
    if let Some(biome) = chosen {
        let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(height), egui::Sense::hover());
        swatch(ui, rect, biome.color);
    }
    egui::ComboBox::from_id_salt("biome")
        .selected_text(chosen.map_or("None", |biome| biome.name.as_str()))
        .width(ui.available_width().min(160.0))
        .truncate()
        .show_ui(ui, |ui| {
            for biome in biomes {
                ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(height), egui::Sense::hover());
                    swatch(ui, rect, biome.color);
                    ui.selectable_value(key, biome.key, &biome.name);
                });
            }
        })
        .response
        .accessible_name(name);
}

/// The populations of a planet by name. `none`: what an empty name means; it comes first.
pub fn population_box(ui: &mut egui::Ui, (name, none): (&str, &str), chosen: &mut String, planet: &Planet) {
    egui::ComboBox::from_id_salt("population")
        .selected_text(if chosen.is_empty() { none } else { chosen.as_str() })
        .width(ui.available_width().min(160.0))
        .truncate()
        .show_ui(ui, |ui| {
            ui.selectable_value(chosen, String::new(), none);
            for population in planet.life.iter().filter(|population| !population.name.is_empty()) {
                ui.selectable_value(chosen, population.name.clone(), &population.name);
            }
        })
        .response
        .accessible_name(name);
}

/// Keys of biomes: the colours of the palette, of which a click adds or takes one. Without any, all count.
pub fn biome_boxes(ui: &mut egui::Ui, name: &str, keys: &mut String, biomes: &[BiomeName]) {
    let size = ui.spacing().interact_size.y;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::splat(1.0);
        for biome in biomes {
            let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(size), egui::Sense::click());
            let is_in = keys.contains(biome.key);
            swatch(ui, rect, biome.color);
            let stroke = match is_in {
                true => egui::Stroke::new(2.0, ui.visuals().strong_text_color()),
                false => egui::Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color),
            };
            ui.painter().rect_stroke(rect.shrink(2.0), 3.0, stroke, egui::StrokeKind::Inside);
            if response.clicked() {
                match is_in {
                    true => keys.retain(|key| key != biome.key),
                    false => keys.push(biome.key),
                }
            }
            let told = if is_in { "in" } else { "not in" };
            let response = response.on_hover_text(format!("{}: {told}", biome.name));
            let info =
                || egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_in, format!("{name}: {}", biome.name));
            response.widget_info(info);
        }
        if keys.is_empty() {
            ui.weak(" all");
        }
    });
}

/// Paints a colour (linear sRGB) into a rectangle.
pub fn swatch(ui: &egui::Ui, rect: egui::Rect, color: [f64; 3]) {
    let [r, g, b] = color.map(|component| component as f32);
    ui.painter().rect_filled(rect.shrink(3.0), 3.0, egui::Rgba::from_rgb(r, g, b));
}
