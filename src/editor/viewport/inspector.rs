//! The inspected place: the last one under the pointer, or one that is held while the planet and the time change.

use super::pointer::{Aim, KnownPlace, Probe};
use super::ring::Ground;
use crate::tiles::Surface;
use eframe::egui::{Color32, Painter, Stroke, vec2};
use glam::DVec3;
use std::sync::Arc;

/// Radius of the mark at a held place, in points.
const MARK: f32 = 7.0;
const INK: Color32 = Color32::from_rgb(255, 214, 90);

/// The inspected place.
pub struct Inspector {
    /// Whether anybody looks: else nothing is found out.
    pub is_open: bool,
    held: Option<DVec3>,
    probe: Probe,
    last: Option<KnownPlace>,
}

impl Inspector {
    /// Follows the pointer. `wake` is called after each answer.
    pub(super) fn new(wake: impl Fn() + Send + 'static) -> Self {
        Self { is_open: false, held: None, probe: Probe::new(wake), last: None }
    }

    /// The place: the held one as it is now, else the last one that was under the pointer.
    pub fn place(&self) -> Option<&KnownPlace> {
        self.last.as_ref()
    }

    /// Whether a place is held.
    pub fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// Holds the place, or follows the pointer again.
    pub fn toggle_held(&mut self) {
        self.held = match self.held {
            Some(_) => None,
            None => self.last.as_ref().map(|place| place.location.direction()),
        };
    }

    /// Takes the newest answers. `under`: the place under the pointer.
    pub(super) fn update(&mut self, under: Option<&KnownPlace>, surface: Option<&Arc<Surface>>, time_secs: f64) {
        if !self.is_open {
            self.probe.leave();
            (self.held, self.last) = (None, None);
            return;
        }
        match (self.held, surface) {
            (Some(dir), Some(surface)) => {
                self.probe.ask(Aim::Place(dir), surface, Some(time_secs));
                if let Some(place) = self.probe.answer() {
                    self.last = Some(place.clone());
                }
            }
            _ => {
                self.probe.leave();
                if let Some(under) = under {
                    self.last = Some(under.clone());
                }
            }
        }
    }

    /// Marks the held place.
    pub(super) fn paint(&self, painter: &Painter, ground: &Ground<'_>) {
        let Some(at) = self.held.and_then(|dir| ground.on_screen(dir)) else { return };
        for (width, color) in [(3.5, Color32::from_black_alpha(160)), (1.5, INK)] {
            painter.circle_stroke(at, MARK, Stroke::new(width, color));
            for side in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                painter.line_segment([at + MARK * side, at + 1.8 * MARK * side], Stroke::new(width, color));
            }
        }
    }
}
