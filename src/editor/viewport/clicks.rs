//! Clicks on the planet that are for the open tab.

use super::layer_view::LayerOverlay;
use super::pointer::{Aim, KnownPlace, Probe, in_view};
use super::sculpt::SculptLink;
use crate::editor::painter::is_chord;
use crate::lod::View;
use crate::render::MarkedCells;
use crate::tiles::Surface;
use eframe::egui;
use std::sync::Arc;

/// The use of a click on the planet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Click {
    /// Choose the biome there.
    Pick,
    /// Paint the cell of the biome table that the climate there falls into.
    Paint,
    /// Choose the plate there.
    Plate,
    /// Add a ready population in the biome there: its index in
    /// [`READY_POPULATIONS`](crate::planet::life::READY_POPULATIONS).
    Plant(usize),
}

/// A ready population that is dragged: its index.
#[derive(Clone, Copy)]
pub struct ReadyDrag(pub usize);

/// What the open tab shows on the planet, and which clicks and drags it takes.
#[derive(Clone, Debug, Default)]
pub struct TabLink {
    /// Cells whose ground lights up.
    pub marked: Option<Arc<MarkedCells>>,
    /// Whether a click with Ctrl paints.
    pub paints: bool,
    /// Whether a plain click picks a biome.
    pub picks: bool,
    /// Whether a plain click picks a plate, and a drag with Ctrl moves it.
    pub plates: bool,
    /// Indices of the layers that are seen alone; empty for all.
    pub solo: Vec<usize>,
    /// The tool in hand, and the edit whose points are shown.
    pub sculpt: SculptLink,
    /// What is shown of a layer.
    pub overlay: Option<LayerOverlay>,
}

/// The newest click for the open tab. The ground there is found on another thread.
pub(super) struct Clicks {
    probe: Probe,
    clicked: Option<Click>,
}

impl Clicks {
    /// No click yet; `wake` is called from another thread when the ground is known.
    pub(super) fn new(wake: impl Fn() + Send + 'static) -> Self {
        Self { probe: Probe::new(wake), clicked: None }
    }

    /// Takes a click of this frame, if the open tab wants it.
    pub(super) fn look(
        &mut self,
        (ui, response): (&egui::Ui, &egui::Response),
        link: &TabLink,
        view: &View,
        surface: Option<&Arc<Surface>>,
    ) {
        if let (Some(pos), Some(surface)) = (dragged_over(ui, response), surface) {
            if ui.input(|input| input.pointer.any_released())
                && let Some(ready) = egui::DragAndDrop::take_payload::<ReadyDrag>(ui.ctx())
            {
                self.ask(response.rect, pos, view, surface, Click::Plant(ready.0));
            }
            return;
        }
        let chord = ui.input(|i| is_chord(i.modifiers));
        let click = match (chord, link) {
            (true, TabLink { paints: true, .. }) => Click::Paint,
            (false, TabLink { picks: true, .. }) => Click::Pick,
            (false, TabLink { plates: true, .. }) => Click::Plate,
            _ => return,
        };
        if response.hovered() && click != Click::Plate {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
        }
        if response.clicked()
            && let (Some(pos), Some(surface)) = (response.interact_pointer_pos(), surface)
        {
            self.ask(response.rect, pos, view, surface, click);
        }
    }

    fn ask(&mut self, rect: egui::Rect, pos: egui::Pos2, view: &View, surface: &Arc<Surface>, click: Click) {
        let (x, y) = in_view(rect, pos);
        self.probe.leave();
        self.probe.ask(Aim::Picture { x, y, view: *view }, surface, None);
        self.clicked = Some(click);
    }

    /// The click and the ground there, once, when the ground is known.
    pub(super) fn take(&mut self) -> Option<(Click, KnownPlace)> {
        let click = self.clicked?;
        let answer = self.probe.take()?;
        self.clicked = None;
        answer.map(|under| (click, under))
    }
}

/// Where a ready population is dragged over the picture.
pub(super) fn dragged_over(ui: &egui::Ui, response: &egui::Response) -> Option<egui::Pos2> {
    let is_over = egui::DragAndDrop::has_payload_of_type::<ReadyDrag>(ui.ctx()) && response.contains_pointer();
    ui.ctx().pointer_interact_pos().filter(|_| is_over)
}
