//! The docks at the sides of the picture and the windows that hold the tabs. A tab is dragged by its name to another
//! place; its context menu moves it too.

use super::layout::Dock;
use super::{Draft, PANELS, PanelState};
use crate::editor::command::Commands;
use crate::editor::painter::survey::Survey;
use crate::editor::viewport::Viewport;
use crate::editor::widgets::curve_view::CurveView;
use crate::editor::widgets::random_seed;
use crate::editor::widgets::row_view::{LockView, RowView};
use crate::planet::param::ParamPath;
use crate::planet::{Planet, random};
use eframe::egui::{self, Rect};

/// Width of a dock at the start, and its range, in points. In a small window docks are narrower.
const WIDTH: f32 = 376.0;
const WIDTHS: std::ops::RangeInclusive<f32> = 320.0..=560.0;
/// Width that the docks leave to the picture.
const PICTURE_WIDTH: f32 = 160.0;
/// Least height of either half of the side panel.
const LEAST_HEIGHT: f32 = 140.0;
/// Height of a window at the start.
const WINDOW_HEIGHT: f32 = 460.0;
/// Width of the strips at the sides of the picture where a dragged tab makes a new dock.
const STRIP: f32 = 110.0;
/// Tabs side by side, at most.
const COLUMNS: usize = 4;

/// The tab that is dragged.
#[derive(Clone, Copy)]
struct Dragged(usize);

/// What the tabs show and change.
pub struct Bench<'a> {
    /// The planet at the start of the frame.
    pub before: &'a Planet,
    /// The planet as the tabs change it.
    pub planet: &'a mut Planet,
    /// The name of the edit; None names it after the changed parameters.
    pub label: Option<String>,
    /// Everything wrong with the planet.
    pub problems: &'a [(ParamPath, String)],
    /// What variations leave as it is.
    pub locks: &'a LockView,
    /// The numbers behind curves.
    pub curves: &'a CurveView<'a>,
    /// The picture of the planet.
    pub viewport: &'a Viewport,
    /// How the planet's land is spread over its biome table.
    pub survey: Option<&'a Survey>,
    /// The commands of the tabs, beside edits.
    pub commands: &'a mut Commands,
    /// Longitude of the eye, in degrees.
    pub eye_lon_deg: f64,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// How far the dice of a tab stray, 0 to 1.
    pub stray: f64,
    /// Whether the stars of a system light the planet.
    pub in_system: bool,
}

impl PanelState {
    /// Shows all docks and windows.
    pub fn show_docks(&mut self, ui: &mut egui::Ui, bench: &mut Bench<'_>) {
        let room = ui.available_rect_before_wrap();
        let has_left = self.layout.open_tab(Dock::Left).is_some();
        let most = ((room.width() - PICTURE_WIDTH) / if has_left { 2.0 } else { 1.0 }).clamp(200.0, *WIDTHS.end());
        let widths = WIDTHS.start().min(most)..=most;
        if has_left {
            let left = egui::Panel::left("parts at the left").default_size(WIDTH).size_range(widths.clone());
            left.show(ui, |ui| self.dock(&mut inside(ui), Dock::Left, bench));
        }
        let [upper, lower] = [Dock::Right, Dock::Below].map(|dock| self.layout.open_tab(dock).is_some());
        if upper || lower {
            let right = egui::Panel::right("parts").default_size(WIDTH).size_range(widths);
            right.show(ui, |ui| {
                let ui = &mut inside(ui);
                let height = ui.available_height();
                if upper && lower {
                    let heights = LEAST_HEIGHT..=(height - LEAST_HEIGHT).max(LEAST_HEIGHT);
                    let below = egui::Panel::bottom("parts below").resizable(true).default_size(0.5 * height);
                    let below = below.size_range(heights).frame(egui::Frame::NONE);
                    below.show(ui, |ui| {
                        ui.add_space(4.0);
                        self.dock(&mut inside(ui), Dock::Below, bench);
                    });
                }
                self.dock(ui, if upper { Dock::Right } else { Dock::Below }, bench);
            });
        }
        self.windows(ui, bench);
        self.drop_zones(ui, room);
    }

    fn windows(&mut self, ui: &egui::Ui, bench: &mut Bench<'_>) {
        let windows: Vec<usize> = self.layout.tabs(Dock::Window).collect();
        for tab in windows {
            let mut open = true;
            let at = self.dropped_at.unwrap_or(egui::pos2(60.0, 60.0));
            let window = egui::Window::new(PANELS[tab].label)
                .id(egui::Id::unique(("window of a tab", tab)))
                .default_pos(at)
                .default_size([WIDTH, WINDOW_HEIGHT])
                .min_size([320.0, LEAST_HEIGHT])
                .open(&mut open);
            window.show(ui.ctx(), |ui| {
                if ui.ui_contains_pointer() && ui.input(|input| input.pointer.any_pressed()) {
                    self.layout.open(tab);
                }
                self.body(ui, tab, bench);
            });
            if !open {
                self.layout.move_to(tab, Dock::Right);
            }
        }
    }

    /// The tabs of a dock, and the open one.
    fn dock(&mut self, ui: &mut egui::Ui, dock: Dock, bench: &mut Bench<'_>) {
        let rect = ui.max_rect();
        self.tabs(ui, dock, bench);
        ui.separator();
        let Some(tab) = self.layout.open_tab(dock) else { return };
        let pressed_here = ui.input(|input| {
            input.pointer.any_pressed() && input.pointer.interact_pos().is_some_and(|at| rect.contains(at))
        });
        if pressed_here {
            self.layout.open(tab);
        }
        self.body(ui, tab, bench);
    }

    fn tabs(&mut self, ui: &mut egui::Ui, dock: Dock, bench: &mut Bench<'_>) {
        ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
        let tabs: Vec<usize> = self.layout.tabs(dock).collect();
        let open = self.layout.open_tab(dock);
        let columns = tabs.len().clamp(1, COLUMNS);
        let room = ui.available_width() - 4.0 * (columns - 1) as f32;
        // Of equal widths, those of long names would push the row beyond the panel.
        let share = |tab: usize| PANELS[tab].label.len() as f32 + 3.0;
        for row in tabs.chunks(columns) {
            let all: f32 = row.iter().map(|tab| share(*tab)).sum();
            let room = room * row.len() as f32 / columns as f32;
            ui.horizontal(|ui| {
                for &tab in row {
                    let panel = &PANELS[tab];
                    let button =
                        egui::Button::selectable(open == Some(tab), panel.label).sense(egui::Sense::click_and_drag());
                    let response = ui.add_sized([room * share(tab) / all, 22.0], button);
                    response.dnd_set_drag_payload(Dragged(tab));
                    if response.clicked() {
                        self.layout.open(tab);
                    }
                    response.context_menu(|ui| {
                        panel.menu(ui, bench.locks, bench.commands);
                        ui.separator();
                        let stands = self.layout.dock(tab);
                        for dock in Dock::ALL.into_iter().filter(|dock| *dock != stands) {
                            if ui.button(dock.label()).on_hover_text("Or drag the name of the tab there").clicked() {
                                self.layout.move_to(tab, dock);
                                ui.close();
                            }
                        }
                    });
                }
            });
        }
    }

    /// The filter of a tab with its lock and its dice, and its rows.
    fn body(&mut self, ui: &mut egui::Ui, tab: usize, bench: &mut Bench<'_>) {
        let panel = &PANELS[tab];
        if self.head(ui, tab, bench.locks) {
            let (seed, part) = (random_seed(), panel.part);
            *bench.planet = random::vary_some(bench.planet, seed, bench.stray, &|path| path.part() == part);
            bench.label = Some(format!("Vary {}", panel.label.to_lowercase()));
        }
        let (filter, revealed) = (self.finding.filter(tab), self.finding.revealed());
        let mut draft = Draft {
            label: bench.label.take(),
            shown: RowView {
                planet: bench.before,
                problems: bench.problems,
                filter: &filter,
                revealed: revealed.as_deref(),
                locks: bench.locks,
                curves: bench.curves,
            },
            viewport: bench.viewport,
            under_pointer: bench.viewport.under_pointer(),
            survey: bench.survey,
            top_stays: false,
            commands: bench.commands,
            eye_lon_deg: bench.eye_lon_deg,
            time_secs: bench.time_secs,
            in_system: bench.in_system,
            planet: bench.planet,
        };
        self.rows(ui, tab, &mut draft);
        bench.label = draft.label;
    }

    /// Shows where the dragged tab would go, and moves it when it is dropped.
    fn drop_zones(&mut self, ui: &egui::Ui, room: Rect) {
        let ctx = ui.ctx();
        let Some(dragged) = egui::DragAndDrop::payload::<Dragged>(ctx) else { return };
        let Some(pointer) = ctx.pointer_interact_pos().filter(|at| room.contains(*at)) else { return };
        let (dock, zone) = self.zone(ui.available_rect_before_wrap(), room, pointer);
        let painter = ctx.layer_painter(egui::LayerId::new(egui::Order::Tooltip, egui::Id::unique("drop zones")));
        let color = ui.visuals().selection.bg_fill;
        painter.rect(
            zone.shrink(3.0),
            4.0,
            color.gamma_multiply(0.35),
            egui::Stroke::new(1.5, ui.visuals().selection.stroke.color),
            egui::StrokeKind::Inside,
        );
        let text = format!("{}: {}", PANELS[dragged.0].label, dock.label().to_lowercase());
        let font = egui::TextStyle::Button.resolve(ui.style());
        let galley = painter.layout_no_wrap(text, font, ui.visuals().strong_text_color());
        // Beside the edge of the window: a strip at a side is narrower than the text.
        let size = galley.size();
        let most = (room.right() - size.x - 8.0).max(room.left());
        let at = (zone.center() - 0.5 * size)
            .clamp(egui::pos2(room.left() + 8.0, room.top()), egui::pos2(most, room.bottom()));
        painter.rect_filled(Rect::from_min_size(at, size).expand(4.0), 3.0, ui.visuals().window_fill);
        painter.galley(at, galley, ui.visuals().strong_text_color());
        if ctx.input(|input| input.pointer.any_released()) {
            egui::DragAndDrop::clear_payload(ctx);
            self.dropped_at = Some(pointer);
            if dock != self.layout.dock(dragged.0) {
                self.layout.move_to(dragged.0, dock);
            }
        }
    }

    /// The place under the pointer, and its rectangle. `picture`: what the docks leave of the `room`.
    fn zone(&self, picture: Rect, room: Rect, pointer: egui::Pos2) -> (Dock, Rect) {
        let strip = STRIP.min(0.25 * picture.width());
        let left = Rect::from_min_max(room.min, egui::pos2(picture.left().max(room.left() + strip), room.bottom()));
        let right = Rect::from_min_max(egui::pos2(picture.right().min(room.right() - strip), room.top()), room.max);
        let (upper, lower) = right.split_top_bottom_at_fraction(0.5);
        if left.contains(pointer) {
            (Dock::Left, left)
        } else if upper.contains(pointer) {
            (Dock::Right, upper)
        } else if lower.contains(pointer) {
            (Dock::Below, lower)
        } else {
            let size = egui::vec2(WIDTH, WINDOW_HEIGHT).min(picture.size());
            (Dock::Window, Rect::from_min_size(pointer, size).intersect(picture))
        }
    }
}

/// The rest of a panel. The user sets its width, never the content: wide content is cut off.
fn inside(ui: &mut egui::Ui) -> egui::Ui {
    let rect = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(rect);
    let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    inner.shrink_clip_rect(rect.expand(4.0));
    inner
}
