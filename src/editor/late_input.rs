//! Input that waits for a later frame, so that slow frames do what quick ones do.
//!
//! - Keys in the same frame as a click or Tab, or right after it, belong to the field that gets the focus. It takes the
//!   focus at the end of that frame, and shows its text in the next one: until then the digits would be shortcuts.
//! - egui looks at the place of the pointer at the end of a frame alone. A press counts where it was made only if the
//!   pointer is still there, and a drag that begins and ends in one frame is none. So motion away from a press waits
//!   for the next frame, and a release after motion waits as well.

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2};

/// Frames from a click until the field under it takes text.
const FRAMES: u8 = 2;
/// Distance that counts as motion, in points: less than what makes a click a drag.
const MOTION: f32 = 4.0;

/// Events that wait for their frame.
#[derive(Default)]
pub struct LateInput {
    held: Vec<Event>,
    /// Frames until text is let through.
    wait: u8,
    /// Where the pointer was at the end of the frame before.
    pointer: Option<Pos2>,
}

impl LateInput {
    /// Replaces the events of a frame by those whose time has come. Gives whether some wait for another frame.
    pub fn admit(&mut self, events: &mut Vec<Event>) -> bool {
        let mut all = std::mem::take(&mut self.held);
        all.append(events);
        self.wait = self.wait.saturating_sub(1);
        let mut frame = Frame { began_at: self.pointer, ..Frame::default() };
        for (i, event) in all.iter().enumerate() {
            let is_late = self.wait > 0 && is_typed(event);
            if is_late || !frame.takes(event) {
                self.held = all.split_off(i);
                break;
            }
            if opens_field(event) {
                self.wait = FRAMES;
            }
        }
        self.pointer = frame.pointer.or(self.pointer);
        *events = all;
        !self.held.is_empty()
    }
}

/// The pointer within a frame.
#[derive(Default)]
struct Frame {
    began_at: Option<Pos2>,
    pointer: Option<Pos2>,
    /// Where a button was pressed or released last.
    button: Option<Pos2>,
}

impl Frame {
    /// Whether an event belongs to this frame.
    fn takes(&mut self, event: &Event) -> bool {
        match event {
            Event::PointerMoved(pos) => {
                // What was clicked must still be under the pointer.
                if self.button.is_some_and(|button| button.distance(*pos) > MOTION) {
                    return false;
                }
                self.pointer = Some(*pos);
            }
            Event::PointerButton { pos, pressed, .. } => {
                let elsewhere = self.button.is_some_and(|button| button.distance(*pos) > MOTION);
                let begun = self.began_at.filter(|_| self.pointer.is_some());
                let dragged = !pressed && self.button.is_none() && begun.is_some_and(|at| at.distance(*pos) > MOTION);
                if elsewhere || dragged {
                    return false;
                }
                self.button = Some(*pos);
                self.pointer = Some(*pos);
            }
            _ => {}
        }
        true
    }
}

/// Whether an event may give a field the focus: a click, Tab, or a chord that opens a window.
fn opens_field(event: &Event) -> bool {
    match event {
        Event::PointerButton { button, pressed, .. } => *button == PointerButton::Primary && !pressed,
        Event::Key { key, pressed, modifiers, .. } => *pressed && (*key == Key::Tab || is_chord(*modifiers)),
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
        let mut late = LateInput::default();
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
        let mut late = LateInput::default();
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

    #[test]
    fn what_is_typed_after_tab_waits_for_the_next_field() {
        let mut late = LateInput::default();
        let [five, six] = ["5", "6"].map(|text| Event::Text(text.to_owned()));
        let tab = key(Key::Tab, Modifiers::NONE);
        let mut events = vec![five.clone(), tab.clone(), six.clone()];
        assert!(late.admit(&mut events));
        assert_eq!(events, [five, tab]);
        events.clear();
        assert!(late.admit(&mut events) && events.is_empty());
        assert!(!late.admit(&mut events));
        assert_eq!(events, [six]);
    }

    fn frames(late: &mut LateInput, events: Vec<Event>) -> Vec<Vec<Event>> {
        let mut frames = Vec::new();
        let mut events = events;
        loop {
            let waits = late.admit(&mut events);
            frames.push(std::mem::take(&mut events));
            if !waits {
                return frames;
            }
        }
    }

    fn button(x: f32, pressed: bool) -> Event {
        Event::PointerButton { pos: pos2(x, 5.0), button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
    }

    fn moved(x: f32) -> Event {
        Event::PointerMoved(pos2(x, 5.0))
    }

    #[test]
    fn a_click_and_a_drag_elsewhere_in_one_slow_frame_are_what_they_are_in_quick_ones() {
        let mut late = LateInput::default();
        assert_eq!(frames(&mut late, vec![moved(10.0)]).len(), 1);
        let click = vec![moved(100.0), button(100.0, true), button(100.0, false)];
        let drag = [moved(300.0), button(300.0, true), moved(350.0), moved(400.0), button(400.0, false), moved(401.0)];
        let all = click.iter().chain(&drag).cloned().collect();
        let wanted = vec![
            click,
            vec![moved(300.0), button(300.0, true)],
            vec![moved(350.0), moved(400.0)],
            vec![button(400.0, false), moved(401.0)],
        ];
        assert_eq!(frames(&mut late, all), wanted);
    }

    #[test]
    fn quick_input_does_not_wait() {
        let mut late = LateInput::default();
        for events in [
            vec![moved(50.0)],
            vec![moved(60.0), button(60.0, true)],
            vec![moved(90.0)],
            vec![button(90.0, false)],
            vec![moved(91.0), button(91.0, true), moved(92.0), button(92.0, false)],
            vec![moved(20.0), moved(30.0)],
        ] {
            assert_eq!(frames(&mut late, events.clone()), [events]);
        }
    }
}
