//! The masks of a layer: where it acts.

use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::planet::layers::layer_path;
use crate::planet::param::{Choice, ParamPath, Segment};
use crate::planet::{Layer, MAX_MASKS, Mask};
use eframe::egui;

/// Shows the masks of the layer at `index`; gives the label of an edit that is more than a parameter.
pub fn show(
    ui: &mut egui::Ui,
    index: usize,
    layer: &mut Layer,
    names: &[String],
    problems: &[(ParamPath, String)],
) -> Option<String> {
    let mut label = None;
    let others: Vec<&String> = names.iter().enumerate().filter(|(i, _)| *i != index).map(|(_, name)| name).collect();
    ui.horizontal(|ui| {
        ui.strong("Masks");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let possible = layer.masks.len() < MAX_MASKS;
            ui.add_enabled_ui(possible, |ui| {
                ui.menu_button("Add mask", |ui| {
                    for (mut mask, doc) in Mask::all().into_iter().zip(Mask::DOCS) {
                        let other = others.first().map(|name| name.as_str());
                        mask.set_layer(other.unwrap_or_default());
                        let name = Mask::NAMES.get(mask.index()).copied().unwrap_or_default();
                        let button = ui.add_enabled(mask.layer().is_none() || other.is_some(), egui::Button::new(name));
                        let button = button.on_hover_text(*doc).on_disabled_hover_text("This mask needs another layer");
                        if button.clicked() {
                            layer.masks.push(mask);
                            label = Some("Add mask".to_owned());
                            ui.close();
                        }
                    }
                });
            });
        });
    });
    let mut removed = None;
    for (number, mask) in layer.masks.iter_mut().enumerate() {
        let owner = format!("mask {} of {}", number + 1, layer.name);
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ui.horizontal(|ui| {
                if let Mask::Layer(mask) = mask {
                    ui.label("Where");
                    egui::ComboBox::from_id_salt(("mask", number))
                        .selected_text(mask.layer.as_str())
                        .width((ui.available_width() - 40.0).max(60.0))
                        .truncate()
                        .show_ui(ui, |ui| {
                            for other in &others {
                                ui.selectable_value(&mut mask.layer, (*other).clone(), other.as_str());
                            }
                        })
                        .response
                        .accessible_name(format!("Layer of {owner}"));
                }
                if icon_button(ui, Icon::Remove, &format!("Remove {owner}"), "Remove this mask").clicked() {
                    removed = Some(number);
                }
            });
            let mut path = layer_path(index).segments().to_vec();
            path.extend([Segment::Field("masks"), Segment::Index(number)]);
            let grid = Grid { base: ParamPath::from(path), owner: &owner, skip: &["layer"], problems };
            let mut default = Mask::default();
            default.set_index(mask.index());
            params_grid(ui, &grid, mask, &mut default);
        });
    }
    if let Some(number) = removed {
        layer.masks.remove(number);
        label = Some("Remove mask".to_owned());
    }
    label
}
