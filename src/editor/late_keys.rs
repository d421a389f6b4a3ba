//! Keys that arrive in the same frame as a click, or right after it: they belong to what the click opens.
//!
//! While frames are slow, a click on a number and the digits after it come together. The field takes the focus at the
//! end of the frame of the click, and shows its text in the next one: until then the digits would be shortcuts.

use eframe::egui::{Event, Modifiers, PointerButton};

/// Frames from a click until the field under it takes text.
const FRAMES: u8 = 2;

/// Events that wait for their field.
#[derive(Default)]
pub struct LateKeys {
    held: Vec<Event>,
    /// Frames until text is let through.
    wait: u8,
}

impl LateKeys {
    /// Replaces the events of a frame by those whose time has come. Gives whether some wait for another frame.
    pub fn admit(&mut self, events: &mut Vec<Event>) -> bool {
        let mut all = std::mem::take(&mut self.held);
        all.append(events);
        self.wait = self.wait.saturating_sub(1);
        for (i, event) in all.iter().enumerate() {
            if opens_field(event) {
                self.wait = FRAMES;
            } else if self.wait > 0 && is_typed(event) {
                self.held = all.split_off(i);
                break;
            }
        }
        *events = all;
        !self.held.is_empty()
    }
}

/// Whether an event may give a field the focus: a click, or a chord that opens a window.
fn opens_field(event: &Event) -> bool {
    match event {
        Event::PointerButton { button, pressed, .. } => *button == PointerButton::Primary && !pressed,
        Event::Key { pressed, modifiers, .. } => *pressed && is_chord(*modifiers),
        _ => false,
    }
}

fn is_typed(event: &Event) -> bool {
    match event {
        Event::Text(_) | Event::Paste(_) | Event::Ime(_) => true,
        Event::Key { pressed, modifiers, .. } => *pressed && !is_chord(*modifiers),
        _ => false,
    }
}

fn is_chord(modifiers: Modifiers) -> bool {
    modifiers.command || modifiers.ctrl || modifiers.mac_cmd
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Key, pos2};

    fn click() -> [Event; 2] {
        [true, false].map(|pressed| Event::PointerButton {
            pos: pos2(5.0, 5.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        })
    }

    fn key(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    #[test]
    fn what_is_typed_right_after_a_click_waits_for_the_field() {
        let mut late = LateKeys::default();
        let typed = [key(Key::Minus, Modifiers::NONE), Event::Text("-".to_owned()), Event::Text("3".to_owned())];
        let mut events: Vec<Event> = click().into_iter().chain(typed.clone()).collect();
        assert!(late.admit(&mut events));
        assert_eq!(events, click());
        let mut events = vec![Event::Text("km".to_owned())];
        assert!(late.admit(&mut events), "the field has the focus, and no text yet");
        assert!(events.is_empty());
        let mut events = vec![key(Key::Enter, Modifiers::NONE)];
        assert!(!late.admit(&mut events));
        let wanted = typed.into_iter().chain([Event::Text("km".to_owned()), key(Key::Enter, Modifiers::NONE)]);
        assert_eq!(events, wanted.collect::<Vec<_>>(), "in order");
    }

    #[test]
    fn keys_without_a_click_and_chords_in_a_row_do_not_wait() {
        let mut late = LateKeys::default();
        let undo = key(Key::Z, Modifiers::COMMAND | Modifiers::CTRL);
        for events in [vec![key(Key::Num2, Modifiers::NONE)], vec![undo.clone(), undo.clone(), undo]] {
            let mut admitted = events.clone();
            assert!(!late.admit(&mut admitted));
            assert_eq!(admitted, events);
        }
        let mut events = vec![key(Key::G, Modifiers::COMMAND | Modifiers::CTRL), Event::Text("45".to_owned())];
        assert!(late.admit(&mut events), "the window opens first");
        assert_eq!(events.len(), 1);
    }
}
