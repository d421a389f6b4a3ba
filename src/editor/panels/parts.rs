//! The parts that are nothing but parameters: planet, star, climate, and those a planet may lack.

use super::Draft;
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::planet::param::{ParamPath, Params, Segment};
use crate::planet::{
    Atmosphere, Climate, Clouds, Planet, STAR_KELVIN, STARTING_AIRS, Star, Water, star_color, star_kelvin,
};
use eframe::egui;

/// Parts that were turned off, with the values they had.
#[derive(Default)]
pub struct Remembered {
    water: Option<Water>,
    atmosphere: Option<Atmosphere>,
    clouds: Option<Clouds>,
}

/// Name, seed, radius.
pub fn planet(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    let skip = ["star", "layers", "climate", "biomes", "water", "atmosphere", "clouds"];
    let grid = Grid { base: ParamPath::default(), owner: "planet", skip: &skip, problems: draft.problems };
    params_grid(ui, &grid, draft.planet, &mut Planet::default());
}

/// The star.
pub fn star(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        let label = ui.label("Colour of a star of");
        let mut kelvin = star_kelvin(draft.planet.star.color).round();
        let value = egui::DragValue::new(&mut kelvin).range(STAR_KELVIN).speed(20.0).suffix(" K");
        let response = ui.add(value).labelled_by(label.id);
        if response.on_hover_text("Sets the colour to that of a star of this temperature; the Sun has 5772 K").changed()
        {
            draft.planet.star.color = star_color(kelvin);
        }
    });
    ui.add_space(4.0);
    whole(ui, "star", &mut draft.planet.star, &mut Star::default(), draft.problems);
    ui.add_space(4.0);
    ui.weak("Shift and drag on the planet turns the star.");
}

/// Temperature and moisture.
pub fn climate(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    whole(ui, "climate", &mut draft.planet.climate, &mut Climate::default(), draft.problems);
}

/// The sea, if there is one.
pub fn water(ui: &mut egui::Ui, remembered: &mut Remembered, draft: &mut Draft<'_>) {
    let label = optional(ui, "water", &mut draft.planet.water, &mut remembered.water, draft.problems);
    draft.label = label.or(draft.label.take());
}

/// The air, if there is any.
pub fn atmosphere(ui: &mut egui::Ui, remembered: &mut Remembered, draft: &mut Draft<'_>) {
    ui.menu_button("Start from …", |ui| {
        for air in STARTING_AIRS {
            if ui.button(air.name).on_hover_text(air.note).clicked() {
                draft.planet.atmosphere = Some(air.atmosphere());
                draft.label = Some(format!("Start from air: {}", air.name));
                ui.close();
            }
        }
    });
    ui.add_space(4.0);
    let (part, kept) = (&mut draft.planet.atmosphere, &mut remembered.atmosphere);
    let label = optional(ui, "atmosphere", part, kept, draft.problems);
    draft.label = label.or(draft.label.take());
}

/// The clouds, if there are any.
pub fn clouds(ui: &mut egui::Ui, remembered: &mut Remembered, draft: &mut Draft<'_>) {
    let label = optional(ui, "clouds", &mut draft.planet.clouds, &mut remembered.clouds, draft.problems);
    draft.label = label.or(draft.label.take());
}

fn whole(
    ui: &mut egui::Ui,
    field: &'static str,
    part: &mut dyn Params,
    default: &mut dyn Params,
    problems: &[(ParamPath, String)],
) {
    let base = ParamPath::from(vec![Segment::Field(field)]);
    params_grid(ui, &Grid { base, owner: field, skip: &[], problems }, part, default);
}

/// A part with a switch. Turned off and on again, it has the values it had. Gives the label of a switching.
fn optional<T: Params + Default + Clone>(
    ui: &mut egui::Ui,
    field: &'static str,
    part: &mut Option<T>,
    remembered: &mut Option<T>,
    problems: &[(ParamPath, String)],
) -> Option<String> {
    let mut label = None;
    let mut on = part.is_some();
    let text = match field {
        "atmosphere" => "This planet has an atmosphere".to_owned(),
        _ => format!("This planet has {field}"),
    };
    if ui.checkbox(&mut on, text).changed() {
        if on {
            *part = Some(remembered.clone().unwrap_or_default());
        } else {
            *remembered = part.take();
        }
        label = Some(format!("Turn {field} {}", if on { "on" } else { "off" }));
    }
    ui.add_space(4.0);
    if let Some(part) = part {
        whole(ui, field, part, &mut T::default(), problems);
    }
    label
}
