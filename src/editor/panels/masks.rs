//! The masks of a layer: they limit where it acts.

use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::row_view::RowView;
use crate::planet::layers::layer_path;
use crate::planet::param::{Choice, ParamPath, Segment};
use crate::planet::{HeightMask, Layer, LayerMask, MAX_MASKS, Mask};
use eframe::egui;

/// What the masks ask for.
#[derive(Default)]
pub struct Asked {
    /// The name of an edit that adds or removes a mask.
    pub label: Option<String>,
    /// Take the mask tool, to paint the mask of this number.
    pub paint: Option<usize>,
}

/// Shows the masks of the layer at `index`.
pub fn show(ui: &mut egui::Ui, index: usize, layer: &mut Layer, names: &[String], shown: RowView<'_>) -> Asked {
    let mut asked = Asked::default();
    let others: Vec<&String> = names.iter().enumerate().filter(|(i, _)| *i != index).map(|(_, name)| name).collect();
    if !shown.filter.is_active() {
        asked.label = head(ui, layer, &others);
    }
    let mut removed = None;
    for (number, mask) in layer.masks.iter_mut().enumerate() {
        let owner = format!("mask {} of {}", number + 1, layer.name);
        let mut path = layer_path(index).segments().to_vec();
        path.extend([Segment::Field("masks"), Segment::Index(number)]);
        let base = ParamPath::from(path);
        if !shown.passes_any(&base, mask, &["layer"]) {
            continue;
        }
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ui.horizontal(|ui| {
                if let Mask::Layer(mask) = mask {
                    shown.marked(ui, &base.join("layer"), "layer", |ui| {
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
                    });
                }
                if matches!(mask, Mask::Painted(_)) {
                    let button = ui.button("Paint").on_hover_text("Paint where the layer acts; with Shift erase");
                    if button.accessible_name(format!("Paint {owner}")).clicked() {
                        asked.paint = Some(number);
                    }
                }
                if icon_button(ui, Icon::Remove, &format!("Remove {owner}"), "Remove this mask").clicked() {
                    removed = Some(number);
                }
            });
            let grid = Grid { base, owner: &owner, skip: &["layer"], shown, biomes: &[] };
            let mut default = Mask::default();
            default.set_index(mask.index());
            params_grid(ui, &grid, mask, &mut default);
        });
    }
    if let Some(number) = removed {
        layer.masks.remove(number);
        asked.label = Some("Remove mask".to_owned());
    }
    asked
}

/// The heading, with the button that adds a mask. Gives the name of the edit.
fn head(ui: &mut egui::Ui, layer: &mut Layer, others: &[&String]) -> Option<String> {
    let mut label = None;
    ui.horizontal(|ui| {
        ui.strong("Masks");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let button = ui.add_enabled(layer.masks.len() < MAX_MASKS, egui::Button::new("Add mask"));
            if button.on_hover_text("Limit where this layer acts").clicked() {
                layer.masks.push(match others.first() {
                    Some(other) => Mask::Layer(LayerMask { layer: (*other).clone(), ..LayerMask::default() }),
                    None => Mask::Height(HeightMask::default()),
                });
                label = Some("Add mask".to_owned());
            }
        });
    });
    label
}
