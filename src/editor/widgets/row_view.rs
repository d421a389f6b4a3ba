//! What the rows of a panel show besides their values: problems, the filter, and the row that was searched for.

use super::curve_view::CurveView;
use crate::planet::Planet;
use crate::planet::locks::Locks;
use crate::planet::param::{Param, ParamPath, Params};
use eframe::egui::{self, Rect};
use std::cell::{Cell, RefCell};

/// Seconds for which a row that was searched for is highlighted, and those before the highlight fades.
const MARKED_SECS: f64 = 1.5;
const STEADY_SECS: f64 = 0.6;
/// Seconds for which the panel keeps scrolling to the row: sections above it may unfold meanwhile.
const SCROLLING_SECS: f64 = 0.3;
/// Longest step of the highlight's time in a frame: slow frames must not swallow it.
const LONGEST_FRAME_SECS: f64 = 0.2;

/// The words that a user typed to narrow a panel down.
#[derive(Debug, Default)]
pub struct Filter {
    words: Vec<String>,
    passed: Cell<usize>,
}

impl Filter {
    /// A filter by the words of a text.
    pub fn new(text: &str) -> Self {
        Self { words: text.split_whitespace().map(str::to_lowercase).collect(), passed: Cell::new(0) }
    }

    /// Whether anything was typed.
    pub fn is_active(&self) -> bool {
        !self.words.is_empty()
    }

    /// Whether each word is in one of the texts.
    fn fits(&self, texts: &[&str]) -> bool {
        let texts: Vec<String> = texts.iter().map(|text| text.to_lowercase()).collect();
        self.words.iter().all(|word| texts.iter().any(|text| text.contains(word.as_str())))
    }

    /// Whether a row with these texts is shown. Rows that are shown are counted.
    pub fn passes(&self, texts: &[&str]) -> bool {
        let passes = !self.is_active() || self.fits(texts);
        self.passed.set(self.passed.get() + usize::from(passes));
        passes
    }

    /// How many rows were shown.
    pub fn passed(&self) -> usize {
        self.passed.get()
    }
}

/// A parameter that was searched for: its panel scrolls to its row and highlights it for a moment.
#[derive(Debug)]
pub struct Revealed {
    /// The path of the parameter.
    pub path: ParamPath,
    /// Its name: the kind of a landform has the path of the part itself.
    pub name: &'static str,
    /// Time since the row was shown first.
    age_secs: Cell<Option<f64>>,
    rect: Cell<Option<Rect>>,
}

impl Revealed {
    /// A parameter that is searched for now.
    pub fn new(path: ParamPath, name: &'static str) -> Self {
        Self { path, name, age_secs: Cell::default(), rect: Cell::default() }
    }

    fn is_of(&self, path: &ParamPath, name: &str) -> bool {
        self.path == *path && self.name == name
    }

    /// The row on screen; None until it is shown.
    pub fn rect(&self) -> Option<Rect> {
        self.rect.get()
    }

    /// Lets the time of a frame pass. Gives whether the highlight has gone.
    pub fn is_over_after(&self, frame_secs: f64) -> bool {
        let age_secs = self.age_secs.get().map(|age_secs| age_secs + frame_secs.min(LONGEST_FRAME_SECS));
        self.age_secs.set(age_secs);
        age_secs.is_some_and(|age_secs| age_secs > MARKED_SECS)
    }

    /// Scrolls to the row, and highlights it with the shape at `place`, which is behind the row.
    fn mark(&self, ui: &egui::Ui, rect: Rect, place: egui::layers::ShapeIdx) {
        let age_secs = self.age_secs.get().unwrap_or(0.0);
        self.age_secs.set(Some(age_secs));
        self.rect.set(Some(rect));
        if age_secs <= SCROLLING_SECS {
            ui.scroll_to_rect(rect, Some(egui::Align::Center));
        }
        let left = ((MARKED_SECS - age_secs) / (MARKED_SECS - STEADY_SECS)).clamp(0.0, 1.0) as f32;
        let color = ui.visuals().selection.bg_fill.gamma_multiply(0.85 * left);
        ui.painter().set(place, egui::Shape::rect_filled(rect.expand2(egui::vec2(4.0, 2.0)), 3.0, color));
        ui.ctx().request_repaint();
    }
}

/// What the rows of a panel show besides their values.
#[derive(Clone, Copy)]
pub struct RowView<'a> {
    /// The planet at the start of the frame.
    pub planet: &'a Planet,
    /// Everything wrong with the planet.
    pub problems: &'a [(ParamPath, String)],
    /// The filter of the panel.
    pub filter: &'a Filter,
    /// The parameter that was searched for.
    pub revealed: Option<&'a Revealed>,
    /// What variations leave as it is.
    pub locks: &'a LockView,
    /// The numbers behind curves.
    pub curves: &'a CurveView<'a>,
}

/// The locks as rows show them, and the one that a row toggles.
#[derive(Debug, Default)]
pub struct LockView {
    locks: Locks,
    /// Whether the rows are of no planet: they cannot be locked.
    is_of_none: bool,
    toggled: RefCell<Option<ParamPath>>,
}

impl LockView {
    /// The locks of a planet.
    pub fn of(planet: &Planet) -> Self {
        Self { locks: Locks::of(planet), ..Self::default() }
    }

    /// For rows that are not of a planet, such as those of a brush.
    pub fn none() -> Self {
        Self { is_of_none: true, ..Self::default() }
    }

    /// Whether the lock is on this parameter or part itself.
    pub fn is_on(&self, path: &ParamPath) -> bool {
        self.locks.is_on(path)
    }

    /// Whether this parameter or part is locked, by itself or by what holds it.
    pub fn hold(&self, path: &ParamPath) -> bool {
        self.locks.hold(path)
    }

    /// Asks to lock or unlock a parameter or part.
    pub fn toggle(&self, path: &ParamPath) {
        *self.toggled.borrow_mut() = Some(path.clone());
    }

    /// What was asked for.
    pub fn take_toggled(&self) -> Option<ParamPath> {
        self.toggled.take()
    }

    /// A menu entry that locks or unlocks.
    pub fn entry(&self, ui: &mut egui::Ui, path: &ParamPath) {
        if self.is_of_none {
            return;
        }
        let (label, told) = match (self.is_on(path), self.hold(path)) {
            (true, _) => ("Unlock", "Let variations and random planets change it again"),
            (false, true) => ("Lock", "Locked already, by the lock on what it belongs to"),
            (false, false) => ("Lock", "Variations and random planets leave it as it is"),
        };
        if ui.button(label).on_hover_text(told).clicked() {
            self.toggle(path);
            ui.close();
        }
    }
}

impl RowView<'_> {
    /// Whether the row of a parameter is shown.
    pub fn passes(&self, path: &ParamPath, param: &Param) -> bool {
        !self.filter.is_active() || self.filter.passes(&[param.label, param.doc, &path.to_string()])
    }

    /// Whether the row of any parameter of a part is shown, but for those of some names.
    pub fn passes_any(&self, base: &ParamPath, part: &dyn Params, skip: &[&str]) -> bool {
        let mut passes = !self.filter.is_active();
        part.each_value(&mut base.clone(), &mut |path, param, _| {
            let texts = [param.label, param.doc, &path.to_string()];
            passes = passes || (!skip.contains(&param.name) && self.filter.fits(&texts));
        });
        passes
    }

    /// Shows the widgets of the parameter at `path`, highlighted if it was searched for.
    pub fn marked<R>(
        &self,
        ui: &mut egui::Ui,
        path: &ParamPath,
        name: &str,
        add: impl FnOnce(&mut egui::Ui) -> R,
    ) -> R {
        let place = ui.painter().add(egui::Shape::Noop);
        // Always in a scope: the ids of the widgets must not change when the highlight goes.
        let shown = ui.scope(add);
        if let Some(revealed) = self.revealed.filter(|revealed| revealed.is_of(path, name)) {
            revealed.mark(ui, shown.response.rect, place);
        }
        shown.inner
    }

    /// Whether the parameter at `path` has just been searched for: its field takes the focus, so that one can type.
    pub fn takes_focus(&self, path: &ParamPath, name: &str) -> bool {
        self.revealed.is_some_and(|revealed| revealed.is_of(path, name) && revealed.age_secs.get().is_none())
    }

    /// Whether the parameter that was searched for is at `path` or below it.
    pub fn reveals_in(&self, path: &ParamPath) -> bool {
        self.revealed.is_some_and(|revealed| revealed.path.starts_with(path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Star;
    use crate::planet::param::Segment;

    #[test]
    fn every_word_must_be_in_a_text() {
        assert!(Filter::new("  ").passes(&["Size"]), "an empty filter passes everything");
        let filter = Filter::new("Km siz");
        assert!(filter.is_active());
        assert!(filter.passes(&["Size", "layers[0].shape.size_km"]));
        assert!(!filter.passes(&["Size", "layers[0].shape.size"]));
        assert_eq!(filter.passed(), 1);
    }

    #[test]
    fn a_part_is_shown_if_one_of_its_rows_is() {
        let (base, filter) = (ParamPath::from(vec![Segment::Field("star")]), Filter::new("tilt"));
        let locks = LockView::default();
        let planet = Planet::default();
        let curves = CurveView::default();
        let shown =
            RowView { planet: &planet, problems: &[], filter: &filter, revealed: None, locks: &locks, curves: &curves };
        assert!(shown.passes_any(&base, &Star::default(), &[]));
        assert!(!shown.passes_any(&base, &Star::default(), &["tilt_deg"]));
        assert_eq!(filter.passed(), 0, "only rows count");
    }
}
