//! The window of photographs and films: size, samples, lens, and how much is done.

use super::look;
use crate::editor::command::{Action, Commands, Shoot, Window};
use crate::editor::state::State;
use crate::editor::state::shooting::{PhotoSettings, Shooting, Subject};
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::lod::Quality;
use crate::planet::param::Unit;
use eframe::egui;

/// Sizes to choose from.
const SIZES: [(&str, [u32; 2]); 6] = [
    ("HD", [1280, 720]),
    ("Full HD", [1920, 1080]),
    ("4K", [3840, 2160]),
    ("8K", [7680, 4320]),
    ("Square", [2048, 2048]),
    ("Portrait", [1080, 1920]),
];
/// Longest side of a picture, pixels.
const MOST_PX: f64 = 16_384.0;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("photo window")
}

/// Shows the window if it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.photo;
    let window = egui::Window::new("Picture").id(id()).open(&mut open);
    window.resizable(false).default_pos(look::WINDOW_POS).show(ctx, |ui| {
        let mut photo = state.photo;
        egui::Grid::new("photo").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| settings(ui, &mut photo));
        if photo != state.photo {
            commands.push(Action::Shoot(Shoot::Set(photo)));
        }
        ui.separator();
        match &state.shooting {
            Some(shooting) => under_way(ui, shooting, commands),
            None => buttons(ui, state, commands),
        }
    });
    if open != state.shows.photo {
        commands.push(Action::Close(Window::Photo));
    }
}

fn settings(ui: &mut egui::Ui, photo: &mut PhotoSettings) {
    ui.label("Size").on_hover_text("Large pictures are drawn in tiles");
    ui.horizontal(|ui| {
        let name = SIZES.iter().find(|(_, size)| *size == photo.size_px).map_or("Own", |(name, _)| name);
        egui::ComboBox::from_id_salt("size").selected_text(name).width(90.0).show_ui(ui, |ui| {
            for (name, size) in SIZES {
                ui.selectable_value(&mut photo.size_px, size, name);
            }
        });
        for (side, name) in photo.size_px.iter_mut().zip(["Width", "Height"]) {
            let mut px = f64::from(*side);
            plain_field(ui, &mut px, 8.0, 0, Allowed::whole(1.0, MOST_PX)).accessible_name(name);
            *side = px as u32;
        }
    });
    ui.end_row();
    ui.label("Quality");
    ui.horizontal(|ui| {
        for quality in Quality::ALL {
            ui.selectable_value(&mut photo.quality, quality, quality.label());
        }
    });
    ui.end_row();
    ui.label("Samples").on_hover_text("Along each side of a pixel: 4 makes 16 pictures of one. A lens needs 4 or more");
    let mut samples = f64::from(photo.samples);
    plain_field(ui, &mut samples, 0.1, 0, Allowed::whole(1.0, 16.0)).accessible_name("Samples");
    photo.samples = samples as u32;
    ui.end_row();
    ui.label("Lens")
        .on_hover_text("Diameter: 0 is sharp everywhere, 0.01 m a camera, 1000 m makes a model of a continent");
    let metres = |least: f64| Allowed::numbers(Unit::Metres, least, 1e7);
    plain_field(ui, &mut photo.aperture_m, 0.01, 4, metres(0.0)).accessible_name("Diameter of the lens");
    ui.end_row();
    ui.label("Focus");
    ui.horizontal(|ui| {
        let mut by_itself = photo.focus_m.is_none();
        ui.checkbox(&mut by_itself, "Middle of the picture");
        match (&mut photo.focus_m, by_itself) {
            (focus_m, true) => *focus_m = None,
            (Some(focus_m), false) => {
                plain_field(ui, focus_m, 1.0, 2, metres(1e-3)).accessible_name("Distance in focus");
            }
            (focus_m @ None, false) => *focus_m = Some(1000.0),
        }
    });
    ui.end_row();
    ui.label("Film").on_hover_text("A flight over the bookmarks, as numbered pictures");
    ui.horizontal(|ui| {
        let secs = Allowed::numbers(Unit::None, 0.1, 3600.0).marked(" s");
        plain_field(ui, &mut photo.film_secs, 0.1, 1, secs).accessible_name("Length of the film");
        let mut fps = f64::from(photo.fps);
        plain_field(ui, &mut fps, 0.2, 0, Allowed::whole(1.0, 240.0).marked(" fps")).accessible_name("Frames a second");
        photo.fps = fps as u32;
    });
    ui.end_row();
}

fn buttons(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    ui.horizontal(|ui| {
        if ui.button("Save picture…").on_hover_text("This view, as PNG or OpenEXR").clicked() {
            commands.push(Action::Shoot(Shoot::Ask(Subject::Picture)));
        }
        let bookmarks = state.document.bookmarks().len();
        let film = ui.add_enabled(bookmarks > 0, egui::Button::new("Save film…"));
        let told = "A flight over the bookmarks, as numbered pictures";
        if film.on_hover_text(told).on_disabled_hover_text("Add bookmarks to fly over: Ctrl+B").clicked() {
            commands.push(Action::Shoot(Shoot::Ask(Subject::Film)));
        }
    });
}

fn under_way(ui: &mut egui::Ui, shooting: &Shooting, commands: &mut Commands) {
    let name = shooting.first.file_name().unwrap_or_default().to_string_lossy();
    ui.label(if shooting.count > 1 { format!("{name} and {} more", shooting.count - 1) } else { name.into_owned() });
    ui.horizontal(|ui| {
        let bar = egui::ProgressBar::new(shooting.done() as f32).desired_width(200.0);
        ui.add(bar.show_percentage());
        if ui.button("Cancel").clicked() {
            commands.push(Action::Shoot(Shoot::Cancel));
        }
    });
}
