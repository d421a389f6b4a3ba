//! When a gesture ends: its changes are one undo step.

use eframe::egui;

/// Seconds within which a held key repeats.
const KEY_REPEAT_SECS: f64 = 0.8;

/// The gesture under way.
pub struct Gesture {
    /// When a key was pressed last, on egui's clock.
    last_key_secs: f64,
    /// The widget that had the focus in the frame before.
    focus: Option<egui::Id>,
}

impl Default for Gesture {
    fn default() -> Self {
        Self { last_key_secs: f64::NEG_INFINITY, focus: None }
    }
}

impl Gesture {
    /// Whether another gesture begins with this frame.
    pub fn begins(ctx: &egui::Context) -> bool {
        ctx.input(|input| input.pointer.any_pressed())
    }

    /// Whether no gesture goes on after this frame: the user neither drags, nor types into one field, nor holds a key.
    pub fn has_ended(&mut self, ctx: &egui::Context) -> bool {
        let focus = ctx.memory(egui::Memory::focused);
        let is_key = |event: &egui::Event| matches!(event, egui::Event::Key { pressed: true, .. });
        let (now_secs, is_down, keys_down) = ctx.input(|input| {
            if input.events.iter().any(is_key) {
                self.last_key_secs = input.time;
            }
            (input.time, input.pointer.any_down(), !input.keys_down.is_empty())
        });
        // Not all keys that were pressed are ever released: their names change with Shift. One that is held repeats.
        let is_held = keys_down && now_secs - self.last_key_secs < KEY_REPEAT_SECS;
        let is_typed = ctx.text_edit_focused() && focus == self.focus;
        self.focus = focus;
        !(is_down || is_held || is_typed)
    }
}
