//! What the pointer and the keys do to the view and to the sun.

use super::camera_controller::{CameraController, Ground, turn_sun};
use crate::planet::Planet;
use crate::sphere::LatLon;
use eframe::egui;

/// Label of the undo step of a drag of the sun.
pub const SUN_STEP: &str = "Turn the sun";

/// What a drag does, decided when it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drag {
    /// Nothing is dragged.
    #[default]
    None,
    /// The ground is held.
    Globe,
    /// The head turns.
    Head,
    /// The sun turns.
    Sun,
}

/// Turns this frame's input into movement. Gives whether another frame is due, and the planet with the sun turned.
pub fn handle(
    ui: &egui::Ui,
    response: &egui::Response,
    drag: &mut Drag,
    controller: &mut CameraController,
    ground: &dyn Ground,
    planet: &mut Planet,
) -> Moved {
    let rect = response.rect;
    let aspect = f64::from(rect.width() / rect.height());
    let to_view = |pos: egui::Pos2| {
        let x = (pos.x - rect.center().x) / (0.5 * rect.width());
        let y = (rect.center().y - pos.y) / (0.5 * rect.height());
        (f64::from(x), f64::from(y))
    };
    let mut moved = Moved::default();

    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if response.drag_started() {
        let (shift, origin) = ui.input(|i| (i.modifiers.shift, i.pointer.press_origin()));
        *drag = if response.drag_started_by(egui::PointerButton::Secondary) {
            Drag::Head
        } else if response.drag_started_by(egui::PointerButton::Middle) || shift {
            Drag::Sun
        } else {
            Drag::Globe
        };
        if let (Drag::Globe, Some(origin)) = (*drag, origin) {
            let (x, y) = to_view(origin);
            controller.grab(x, y, aspect, ground);
        }
    }
    if response.dragged() {
        let delta = response.drag_delta() / rect.height();
        let (right, up) = (f64::from(delta.x), f64::from(-delta.y));
        match *drag {
            Drag::None => {}
            Drag::Globe => {
                if let Some(pos) = response.interact_pointer_pos() {
                    let (x, y) = to_view(pos);
                    controller.drag(x, y, aspect, ground);
                }
            }
            Drag::Head if delta != egui::Vec2::ZERO => controller.tilt(-right * 1.6, -up * 1.6, ground),
            Drag::Sun if delta != egui::Vec2::ZERO => {
                let sun = LatLon::from_degrees(planet.star.latitude_deg, planet.star.longitude_deg).direction();
                let (lat_deg, lon_deg) = turn_sun(sun, &controller.camera(ground), right, up).to_degrees();
                planet.star.latitude_deg = round_hundredth(lat_deg).clamp(-90.0, 90.0);
                planet.star.longitude_deg = round_hundredth(lon_deg).clamp(-180.0, 180.0);
                moved.sun = true;
            }
            Drag::Head | Drag::Sun => {}
        }
    }
    if response.drag_stopped() {
        controller.release();
        *drag = Drag::None;
    }

    if response.double_clicked()
        && let Some(pos) = response.interact_pointer_pos()
    {
        let (x, y) = to_view(pos);
        controller.fly_to(x, y, aspect, ground);
    }
    if response.hovered() {
        let (scroll, pinch) = ui.input(|i| (f64::from(i.smooth_scroll_delta.y), f64::from(i.zoom_delta())));
        let steps = scroll * 0.005 + if pinch > 0.0 { pinch.ln() } else { 0.0 };
        if steps != 0.0 {
            controller.zoom(steps, response.hover_pos().map(to_view), aspect, ground);
        }
    }
    if response.has_focus() {
        moved.animating |= keys(ui, response.id, controller, aspect, ground);
    }
    if controller.is_flying() {
        controller.advance(f64::from(ui.input(|i| i.stable_dt).min(0.1)), ground);
        moved.animating |= controller.is_flying();
    }
    moved
}

/// What [`handle`] did.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moved {
    /// Something goes on moving by itself: another frame is due.
    pub animating: bool,
    /// The sun was turned: an edit of the planet.
    pub sun: bool,
}

/// Arrow keys travel, with Shift they turn the head; Page up and Page down change the altitude.
fn keys(ui: &egui::Ui, id: egui::Id, controller: &mut CameraController, aspect: f64, ground: &dyn Ground) -> bool {
    use egui::Key;
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
    let (down, shift, dt) = ui.input(|i| {
        let down = |key: Key| f64::from(u8::from(i.key_down(key)));
        let axes = [
            down(Key::ArrowRight) - down(Key::ArrowLeft),
            down(Key::ArrowUp) - down(Key::ArrowDown),
            down(Key::PageDown) - down(Key::PageUp),
        ];
        (axes, i.modifiers.shift, f64::from(i.stable_dt.min(0.1)))
    });
    let [right, up, nearer] = down;
    if right != 0.0 || up != 0.0 {
        if shift {
            controller.tilt(right * dt, up * dt, ground);
        } else {
            controller.travel(right * dt, up * dt, ground);
        }
    }
    if nearer != 0.0 {
        controller.zoom(nearer * dt * 1.5, None, aspect, ground);
    }
    down != [0.0; 3]
}

fn round_hundredth(degrees: f64) -> f64 {
    (degrees * 100.0).round() / 100.0
}
