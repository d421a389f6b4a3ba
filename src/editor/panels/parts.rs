//! The panels of the parts that are lists of parameters: planet, star, climate, and the optional parts but the
//! structure.

use super::Draft;
use crate::editor::widgets::menu_button;
use crate::editor::widgets::param_row::labelled_row;
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::row_view::RowView;
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::param::{ParamPath, Params, Segment, Unit};
use crate::planet::{
    Atmosphere, Climate, Clouds, Giant, GroundEdits, Layer, Planet, Population, Rings, STAR_KELVIN, STARTING_AIRS,
    STARTING_GIANTS, STARTING_RINGS, STARTING_SEAS, STARTING_SKIES, Star, Starting, Structure, Water, star_color,
    star_kelvin,
};
use eframe::egui;

/// Optional parts that were turned off, with their last values.
#[derive(Default)]
pub struct TurnedOff {
    pub(super) structure: Option<Structure>,
    water: Option<Water>,
    atmosphere: Option<Atmosphere>,
    clouds: Option<Clouds>,
    rings: Option<Rings>,
    giant: Option<Giant>,
    /// The ground of a planet that became a giant.
    ground: Option<Ground>,
}

/// What a giant has none of.
#[derive(Default)]
struct Ground {
    layers: Vec<Layer>,
    edits: GroundEdits,
    life: Vec<Population>,
    structure: Option<Structure>,
    water: Option<Water>,
}

/// The planet's own parameters: name, seed, radius.
pub fn planet(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    // Parts have panels of their own, or none.
    let skip: Vec<&str> = Planet::PARTS.iter().map(|part| part.name).collect();
    let grid = Grid { base: ParamPath::default(), owner: "planet", skip: &skip, shown: draft.shown, biomes: &[] };
    params_grid(ui, &grid, draft.planet, &mut Planet::default());
}

/// The star.
pub fn star(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    if draft.in_system {
        ui.label(
            "The stars of the system light the planet. This one shines when the planet is alone: leave the system in \
             its window.",
        );
        ui.add_space(4.0);
    }
    labelled_row(ui, &draft.shown, "Temperature", |ui, label| {
        let mut kelvin = star_kelvin(draft.planet.star.color).round();
        let allowed = Allowed::numbers(Unit::None, *STAR_KELVIN.start(), *STAR_KELVIN.end()).marked(" K");
        let response = plain_field(ui, &mut kelvin, 20.0, 5, allowed).labelled_by(label);
        let told = "Sets the colour to that of a star of this temperature; the Sun has 5772 K";
        if response.on_hover_text(told).changed() {
            draft.planet.star.color = star_color(kelvin);
        }
    });
    calendar(ui, draft);
    ui.add_space(4.0);
    whole(ui, "star", &mut draft.planet.star, &mut Star::default(), draft.shown);
    if !draft.shown.filter.is_active() && !draft.in_system {
        ui.add_space(4.0);
        ui.weak("Shift and drag on the planet turns the star.");
    }
}

/// The location under the star, by the hour below the eye and by the season.
fn calendar(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    let (lon_deg, time_secs, shown) = (draft.eye_lon_deg, draft.time_secs, draft.shown);
    let star = &mut draft.planet.star;
    labelled_row(ui, &shown, "Hour here", |ui, label| {
        let mut hour = (star.hour(lon_deg, time_secs) * 100.0).round() / 100.0;
        let response = plain_field(ui, &mut hour, 0.02, 4, Allowed::numbers(Unit::Hours, 0.0, 24.0)).labelled_by(label);
        if response.on_hover_text("The hour of a day of 24 below the camera; sets the star's longitude").changed() {
            star.set_hour(hour, lon_deg, time_secs);
        }
    });
    labelled_row(ui, &shown, "Season", |ui, label| {
        let mut season_deg = star.season_deg().round();
        let allowed = Allowed::numbers(Unit::Degrees, -90.0, 90.0);
        let response = plain_field(ui, &mut season_deg, 0.5, 3, allowed).labelled_by(label);
        let told =
            "From -90, midwinter in the north, to 90, midsummer; sets the star's latitude by the tilt of the axis";
        if response.on_hover_text(told).changed() {
            star.set_season(season_deg);
        }
    });
}

/// A scattering coefficient as a colour and a strength: another way to set red, green and blue.
fn scatterer(ui: &mut egui::Ui, shown: &RowView<'_>, name: &str, per_km: &mut [f64; 3]) {
    let strength = per_km.iter().copied().fold(0.0, f64::max);
    let share = |c: &f64| if strength > 0.0 { (c / strength) as f32 } else { 1.0 };
    let mut color: [f32; 3] = std::array::from_fn(|i| share(&per_km[i]));
    let mut changed = strength;
    labelled_row(ui, shown, &format!("{name} colour"), |ui, label| {
        let button = ui.color_edit_button_rgb(&mut color).labelled_by(label);
        let allowed = Allowed::numbers(Unit::PerKilometre, 0.0, 2.0);
        let drag = plain_field(ui, &mut changed, strength.max(1e-4) * 0.01, 4, allowed).labelled_by(label);
        let told = "The three coefficients in another form: the largest one, and a colour for their ratio";
        if button.on_hover_text(told).changed() || drag.on_hover_text(told).changed() {
            let most = color.iter().copied().fold(1e-6, f32::max);
            // Five digits keep the preset readable.
            let tidy = |x: f64| format!("{x:.4e}").parse().unwrap_or(x);
            *per_km = color.map(|c| tidy(f64::from(c / most) * changed).clamp(0.0, 2.0));
        }
    });
}

/// The climate.
pub fn climate(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    whole(ui, "climate", &mut draft.planet.climate, &mut Climate::default(), draft.shown);
}

/// A menu of values that a part may start from. A filter hides it.
fn start_from<T>(
    ui: &mut egui::Ui,
    draft: &mut Draft<'_>,
    part: &str,
    all: &[Starting<T>],
    set: impl Fn(&mut Planet, T),
) {
    if draft.shown.filter.is_active() {
        return;
    }
    menu_button(ui, "Start from …", |ui| {
        for one in all {
            if ui.button(one.name).on_hover_text(one.note).clicked() {
                set(draft.planet, one.make());
                draft.label = Some(format!("Start from {part}: {}", one.name));
                ui.close();
            }
        }
    });
}

/// The sea, if the planet has one.
pub fn water(ui: &mut egui::Ui, turned_off: &mut TurnedOff, draft: &mut Draft<'_>) {
    start_from(ui, draft, "sea", STARTING_SEAS, |planet, sea| {
        // The level belongs to the land, not to the liquid.
        let level_m = planet.water.as_ref().map_or(sea.level_m, |old| old.level_m);
        planet.water = Some(Water { level_m, ..sea });
    });
    ui.add_space(4.0);
    let label = optional(ui, "water", &mut draft.planet.water, &mut turned_off.water, draft.shown);
    draft.label = label.or(draft.label.take());
}

/// The atmosphere, if the planet has one.
pub fn atmosphere(ui: &mut egui::Ui, turned_off: &mut TurnedOff, draft: &mut Draft<'_>) {
    start_from(ui, draft, "air", STARTING_AIRS, |planet, air| planet.atmosphere = Some(air));
    if let Some(air) = &mut draft.planet.atmosphere {
        scatterer(ui, &draft.shown, "Rayleigh", &mut air.rayleigh_per_km);
        scatterer(ui, &draft.shown, "Mie", &mut air.mie_scattering_per_km);
    }
    ui.add_space(4.0);
    let (part, kept) = (&mut draft.planet.atmosphere, &mut turned_off.atmosphere);
    let label = optional(ui, "atmosphere", part, kept, draft.shown);
    draft.label = label.or(draft.label.take());
}

/// The clouds, if the planet has any.
pub fn clouds(ui: &mut egui::Ui, turned_off: &mut TurnedOff, draft: &mut Draft<'_>) {
    start_from(ui, draft, "clouds", STARTING_SKIES, |planet, sky| {
        let (seed, wind_km_h) =
            planet.clouds.as_ref().map_or((sky.seed, sky.wind_km_h), |old| (old.seed, old.wind_km_h));
        planet.clouds = Some(Clouds { seed, wind_km_h, ..sky });
    });
    ui.add_space(4.0);
    let label = optional(ui, "clouds", &mut draft.planet.clouds, &mut turned_off.clouds, draft.shown);
    draft.label = label.or(draft.label.take());
}

/// The clouds of a gas giant, if the planet is one. A giant has no ground: it is put aside, and comes back with it.
pub fn giant(ui: &mut egui::Ui, turned_off: &mut TurnedOff, draft: &mut Draft<'_>) {
    let was_giant = draft.planet.giant.is_some();
    start_from(ui, draft, "gas giant", STARTING_GIANTS, |planet, giant| {
        let seed = planet.giant.as_ref().map_or(giant.seed, |old| old.seed);
        planet.giant = Some(Giant { seed, ..giant });
    });
    ui.add_space(4.0);
    let label = optional(ui, "giant", &mut draft.planet.giant, &mut turned_off.giant, draft.shown);
    draft.label = label.or(draft.label.take());
    let planet = &mut *draft.planet;
    match (was_giant, planet.giant.is_some()) {
        (false, true) => {
            turned_off.ground = Some(Ground {
                layers: std::mem::take(&mut planet.layers),
                edits: std::mem::take(&mut planet.edits),
                life: std::mem::take(&mut planet.life),
                structure: planet.structure.take(),
                water: planet.water.take(),
            });
        }
        (true, false) => {
            if let Some(ground) = turned_off.ground.take() {
                (planet.layers, planet.edits, planet.life) = (ground.layers, ground.edits, ground.life);
                (planet.structure, planet.water) = (ground.structure, ground.water);
            }
        }
        _ => {}
    }
}

/// The rings, if the planet has any.
pub fn rings(ui: &mut egui::Ui, turned_off: &mut TurnedOff, draft: &mut Draft<'_>) {
    start_from(ui, draft, "rings", STARTING_RINGS, |planet, rings| {
        let seed = planet.rings.as_ref().map_or(rings.seed, |old| old.seed);
        planet.rings = Some(Rings { seed, ..rings });
    });
    ui.add_space(4.0);
    let label = optional(ui, "rings", &mut draft.planet.rings, &mut turned_off.rings, draft.shown);
    draft.label = label.or(draft.label.take());
}

fn whole(ui: &mut egui::Ui, field: &'static str, part: &mut dyn Params, default: &mut dyn Params, shown: RowView<'_>) {
    let base = ParamPath::from(vec![Segment::Field(field)]);
    params_grid(ui, &Grid { base, owner: field, skip: &[], shown, biomes: &[] }, part, default);
}

/// A part with a switch. A part that is turned off and on again keeps its values. Gives the name of the edit if the
/// switch was used.
fn optional<T: Params + Default + Clone>(
    ui: &mut egui::Ui,
    field: &'static str,
    part: &mut Option<T>,
    kept: &mut Option<T>,
    shown: RowView<'_>,
) -> Option<String> {
    let label = switch(ui, &shown, field, part, kept);
    if let Some(part) = part {
        whole(ui, field, part, &mut T::default(), shown);
    }
    label
}

/// The switch of such a part. A filter hides it unless the part is off: then there is nothing to filter.
pub(super) fn switch<T: Default + Clone>(
    ui: &mut egui::Ui,
    shown: &RowView<'_>,
    field: &'static str,
    part: &mut Option<T>,
    kept: &mut Option<T>,
) -> Option<String> {
    if shown.filter.is_active() && part.is_some() {
        return None;
    }
    let mut label = None;
    let mut on = part.is_some();
    let text = match field {
        "atmosphere" => "This planet has an atmosphere".to_owned(),
        "structure" => "This planet has a structure".to_owned(),
        "giant" => "This planet is a gas giant".to_owned(),
        _ => format!("This planet has {field}"),
    };
    if ui.checkbox(&mut on, text).changed() {
        if on {
            *part = Some(kept.clone().unwrap_or_default());
        } else {
            *kept = part.take();
        }
        label = Some(format!("Turn {field} {}", if on { "on" } else { "off" }));
    }
    ui.add_space(4.0);
    label
}
