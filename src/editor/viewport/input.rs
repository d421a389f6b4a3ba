//! Pointer and keys: how they move the cameras and the sun.

use super::camera::orbit::turn_sun;
use super::camera::{Cameras, Controls, Ground, Mode};
use super::plate_drag::{PLATE_STEP, PlateDrag};
use super::pointer::in_view;
use crate::editor::painter::is_chord;
use crate::editor::widgets::keys_are_taken;
use crate::planet::Planet;
use crate::terrain::Terrain;
use eframe::egui;

/// Name of the undo step of a drag of the sun.
pub const SUN_STEP: &str = "Turn the sun";

/// The effect of a drag, decided when it starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Drag {
    /// No drag.
    #[default]
    None,
    /// Holds the ground, or turns the view.
    Globe,
    /// Turns the view.
    View,
    /// Turns the sun.
    Sun,
    /// Moves a plate of the structure.
    Plate(PlateDrag),
}

/// What drags may change of the planet.
pub struct Edited<'a> {
    /// The planet.
    pub planet: &'a mut Planet,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// Whether drags turn the sun: it is the planet's own.
    pub turns_sun: bool,
    /// Whether the first button of the pointer is taken by a tool.
    pub held: bool,
    /// The terrain on screen, if a drag with Ctrl moves its plates.
    pub plates: Option<&'a Terrain>,
}

/// Moves the cameras, and the sun or a plate of the planet, by the input of this frame.
pub fn handle(
    ui: &egui::Ui,
    response: &egui::Response,
    drag: &mut Drag,
    cameras: &mut Cameras,
    ground: &dyn Ground,
    edited: Edited<'_>,
) -> Moved {
    let Edited { planet, time_secs, turns_sun, held: is_held, plates } = edited;
    let rect = response.rect;
    let aspect = f64::from(rect.width() / rect.height());
    let to_view = |pos: egui::Pos2| in_view(rect, pos);
    let mut moved = Moved::default();

    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if response.drag_started() {
        let (modifiers, origin) = ui.input(|i| (i.modifiers, i.pointer.press_origin()));
        let shift = modifiers.shift;
        let held = plates.zip(origin).filter(|_| is_chord(modifiers)).and_then(|(terrain, origin)| {
            PlateDrag::start(terrain, planet, &cameras.camera(ground), to_view(origin), aspect)
        });
        *drag = if response.drag_started_by(egui::PointerButton::Secondary) {
            Drag::View
        } else if is_held && response.drag_started_by(egui::PointerButton::Primary) {
            Drag::None
        } else if response.drag_started_by(egui::PointerButton::Middle) || shift {
            Drag::Sun
        } else {
            held.map_or(Drag::Globe, Drag::Plate)
        };
        if let (Drag::Globe, Some(origin)) = (&*drag, origin) {
            let (x, y) = to_view(origin);
            cameras.grab(x, y, aspect, ground);
        }
    }
    if response.dragged() {
        let delta = response.drag_delta() / rect.height();
        let (right, up) = (f64::from(delta.x), f64::from(-delta.y));
        match &*drag {
            Drag::None => {}
            Drag::Globe => {
                if let Some(pos) = response.interact_pointer_pos() {
                    cameras.drag(to_view(pos), (right, up), aspect, ground);
                }
            }
            Drag::View if delta != egui::Vec2::ZERO => cameras.look(-right, -up, ground),
            Drag::Sun if turns_sun && delta != egui::Vec2::ZERO => {
                let sun = planet.star.place(time_secs).direction();
                let (lat_deg, lon_deg) = turn_sun(sun, &cameras.camera(ground), right, up).to_degrees();
                planet.star.set_place(lat_deg, lon_deg, time_secs);
                moved.edit = Some(SUN_STEP);
            }
            Drag::Plate(held) if delta != egui::Vec2::ZERO => {
                if let (Some(pos), Some(terrain)) = (response.interact_pointer_pos(), plates)
                    && held.drag(terrain, planet, &cameras.camera(ground), to_view(pos), aspect)
                {
                    moved.edit = Some(PLATE_STEP);
                }
            }
            Drag::View | Drag::Sun | Drag::Plate(_) => {}
        }
    }
    if response.drag_stopped() {
        cameras.release();
        *drag = Drag::None;
    }

    if response.double_clicked()
        && !is_held
        && !ui.input(|i| is_chord(i.modifiers))
        && let Some(pos) = response.interact_pointer_pos()
    {
        let (x, y) = to_view(pos);
        cameras.fly_to(x, y, aspect, ground);
    }
    if response.hovered() {
        let (scroll, pinch) = ui.input(|i| (f64::from(i.smooth_scroll_delta.y), f64::from(i.zoom_delta())));
        let steps = scroll * 0.005 + if pinch > 0.0 { pinch.ln() } else { 0.0 };
        if steps != 0.0 {
            cameras.zoom(steps, response.hover_pos().map(to_view), aspect, ground);
        }
    }
    let focused = ui.memory(egui::Memory::focused);
    // The keys go to the picture unless another widget has the focus or a menu is open.
    let controls = if focused.is_none_or(|id| id == response.id) && !keys_are_taken(ui.ctx()) {
        keys(ui, response.id, cameras, ground)
    } else {
        Controls::default()
    };
    let duration_secs = f64::from(ui.input(|i| i.stable_dt).min(0.25));
    moved.animating |= cameras.advance(duration_secs, &controls, ground);
    moved
}

/// The effect of [`handle`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Moved {
    /// The camera goes on moving: another frame is due.
    pub animating: bool,
    /// The name of the edit, if the planet was changed.
    pub edit: Option<&'static str>,
}

/// The movement that the keys ask for. In orbit the arrow keys travel like WASD, and turn the view with Shift; in the
/// other modes they always turn the view.
fn keys(ui: &egui::Ui, id: egui::Id, cameras: &mut Cameras, ground: &dyn Ground) -> Controls {
    use egui::Key;
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
    let input = ui.input(Clone::clone);
    // With Ctrl or Alt the same keys are shortcuts.
    if input.modifiers.command || input.modifiers.alt {
        return Controls::default();
    }
    let axis = |more: &[Key], less: &[Key]| {
        let down = |keys: &[Key]| f64::from(u8::from(keys.iter().any(|key| input.key_down(*key))));
        down(more) - down(less)
    };
    let mut controls = Controls {
        right: axis(&[Key::D], &[Key::A]),
        up: axis(&[Key::E, Key::Space, Key::PageUp], &[Key::Q, Key::PageDown]),
        ahead: axis(&[Key::W], &[Key::S]),
        roll: axis(&[Key::C], &[Key::Z]),
        fast: input.modifiers.shift,
        jump: input.key_down(Key::Space),
    };
    let (right, up) = (axis(&[Key::ArrowRight], &[Key::ArrowLeft]), axis(&[Key::ArrowUp], &[Key::ArrowDown]));
    if cameras.mode() == Mode::Orbit && !input.modifiers.shift {
        controls.right += right;
        controls.ahead += up;
    } else if right != 0.0 || up != 0.0 {
        let turned = f64::from(input.stable_dt.min(0.1));
        cameras.look(right * turned, up * turned, ground);
    }
    controls
}
