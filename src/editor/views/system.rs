//! The window of the system: its bodies as a tree, a map of the orbits, and the time.

use crate::editor::command::{Action, Commands, Setting, SystemAction, Window};
use crate::editor::files::file_names::readable_stem;
use crate::editor::state::State;
use crate::editor::state::system::OpenSystem;
use crate::editor::widgets::menu_button;
use crate::system::limits::distance_text;
use crate::system::{Pose, System, shipped};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Sense, Stroke, Vec2};
use glam::DVec3;
use std::f64::consts::TAU;
use std::path::Path;

const WIDTH: f32 = 340.0;
/// Height of the map of orbits, in points.
const MAP_HEIGHT: f32 = 230.0;
/// Sides of a drawn orbit.
const ORBIT_SIDES: u32 = 128;
/// Margin around the widest orbit on the map, as a factor.
const ROOM: f64 = 1.12;
/// Least size of an orbit that is drawn, and of one whose body is told apart from its parent, in points.
const LEAST_ORBIT: f64 = 2.0;
const LEAST_APART: f64 = 6.0;
/// Distance from a body within which a click is on it, in points.
const REACH: f32 = 12.0;
const DAY_SECS: f64 = 86_400.0;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("system window")
}

/// The window, and what its map shows.
pub struct SystemWindow {
    /// The body in the middle of the map.
    center: usize,
    /// Magnification of the map.
    zoom: f64,
}

impl Default for SystemWindow {
    fn default() -> Self {
        Self { center: 0, zoom: 1.0 }
    }
}

/// The bodies of the open system now.
struct Now<'a> {
    open: &'a OpenSystem,
    poses: Vec<Pose>,
    parents: Vec<Option<usize>>,
    /// The body that is the open planet.
    here: Option<usize>,
}

impl Now<'_> {
    fn system(&self) -> &System {
        self.open.worlds.system()
    }

    /// Whether a body has a planet to open that is not open already.
    fn can_visit(&self, body: usize) -> bool {
        self.here != Some(body) && self.open.preset(body).is_some()
    }

    fn children(&self, body: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.parents.len()).filter(move |child| self.parents[*child] == Some(body))
    }
}

impl SystemWindow {
    /// Shows the window while it is open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.system {
            return;
        }
        let mut open = true;
        let window = egui::Window::new("System").id(id()).open(&mut open).default_pos([12.0, 40.0]).resizable(false);
        window.show(ctx, |ui| {
            ui.set_width(WIDTH.min(ctx.content_rect().width() - 40.0));
            choices(ui, state, commands);
            let Some(system) = &state.system else {
                ui.weak("A system has stars, planets and moons. Each planet is a preset; the others stand in its sky.");
                return;
            };
            let height = (ctx.content_rect().height() - 150.0).max(120.0);
            let area = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
            area.show(ui, |ui| self.content(ui, state, system, commands));
        });
        if !open {
            commands.push(Action::Close(Window::System));
        }
    }

    fn content(&mut self, ui: &mut egui::Ui, state: &State, open: &OpenSystem, commands: &mut Commands) {
        let time_secs = state.viewport.settings.time_secs;
        let now = Now {
            open,
            poses: open.worlds.ephemeris().at(time_secs),
            parents: open.worlds.system().parents(),
            here: state.viewport.body(),
        };
        // Another system may have fewer bodies.
        if self.center >= now.parents.len() {
            *self = Self::default();
        }
        self.map(ui, &now, commands);
        time(ui, time_secs, commands);
        ui.separator();
        for root in (0..now.parents.len()).filter(|body| now.parents[*body].is_none()) {
            self.branch(ui, &now, (root, 0), commands);
        }
        for warning in &open.warnings {
            ui.colored_label(ui.visuals().warn_fg_color, warning);
        }
    }

    fn look_at(&mut self, body: usize) {
        (self.center, self.zoom) = (body, 1.0);
    }

    /// A body and those that orbit it.
    fn branch(&mut self, ui: &mut egui::Ui, now: &Now<'_>, (body, depth): (usize, u32), commands: &mut Commands) {
        let name = &now.system().bodies[body].name;
        ui.horizontal(|ui| {
            ui.add_space(14.0 * depth as f32);
            let label = ui.selectable_label(now.here == Some(body), name);
            let told = match now.can_visit(body) {
                true => "A click puts it in the middle of the map, a double click goes there",
                false => "A click puts it in the middle of the map",
            };
            let label = label.on_hover_text(told);
            if label.double_clicked() && now.can_visit(body) {
                commands.push(Action::System(SystemAction::Visit(body)));
            } else if label.clicked() {
                self.look_at(body);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if now.open.preset(body).is_some() {
                    let go = ui.add_enabled(now.can_visit(body), egui::Button::new("Go").small());
                    if go.on_hover_text(format!("Open {name} and stand near it")).clicked() {
                        commands.push(Action::System(SystemAction::Visit(body)));
                    }
                }
                if let Some(parent) = now.parents[body] {
                    ui.weak(distance_text(now.poses[body].position_m.distance(now.poses[parent].position_m)));
                }
            });
        });
        for child in now.children(body) {
            self.branch(ui, now, (child, depth + 1), commands);
        }
    }

    /// The orbits around the body in the middle, seen from the north.
    fn map(&mut self, ui: &mut egui::Ui, now: &Now<'_>, commands: &mut Commands) {
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), MAP_HEIGHT), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Map of the orbits"));
        if response.hovered() {
            let scroll = f64::from(ui.input(|input| input.smooth_scroll_delta().y));
            self.zoom = (self.zoom * (scroll * 0.004).exp()).clamp(0.2, 1e4);
        }
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, Color32::from_gray(12));
        let map = Map::new(now, self.center, rect, self.zoom);
        map.draw_orbits(&painter);
        let bodies = map.bodies();
        let font = egui::TextStyle::Small.resolve(ui.style());
        for (body, at) in &bodies {
            draw_body(&painter, &font, now, *body, *at);
        }
        let pointer = response.interact_pointer_pos();
        let clicked = pointer.and_then(|pointer| {
            let near = bodies.iter().map(|(body, at)| (at.distance(pointer), *body)).filter(|near| near.0 < REACH);
            near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, body)| body)
        });
        if let Some(body) = clicked {
            if response.double_clicked() && now.can_visit(body) {
                commands.push(Action::System(SystemAction::Visit(body)));
            } else if response.clicked() {
                self.look_at(body);
            }
        }
        response.on_hover_text(
            "From the north; distances as their roots. The wheel zooms, a click puts a body in the middle, a double click \
             goes there",
        );
    }
}

/// The map of orbits in a rectangle.
struct Map<'a> {
    now: &'a Now<'a>,
    center_m: DVec3,
    rect: Rect,
    widest_m: f64,
    /// Points for each metre at the widest orbit.
    per_m: f64,
}

impl<'a> Map<'a> {
    fn new(now: &'a Now<'a>, center: usize, rect: Rect, zoom: f64) -> Self {
        let size_m = |body: usize| {
            now.open.worlds.ephemeris().orbit(body).map_or(0.0, |orbit| orbit.semi_major_m * (1.0 + orbit.eccentricity))
        };
        let widest_m = now.children(center).map(size_m).fold(0.0, f64::max);
        // A body without moons is shown on its own orbit.
        let widest_m = if widest_m > 0.0 { widest_m } else { size_m(center).max(1.0) };
        let per_m = 0.5 * f64::from(rect.height().min(rect.width())) / (widest_m * ROOM) * zoom;
        Self { now, center_m: now.poses[center].position_m, rect, widest_m, per_m }
    }

    /// Where a position is. Distances are roots, so that inner orbits are not crowded together.
    fn at(&self, position_m: DVec3) -> Pos2 {
        let away_m = position_m - self.center_m;
        let away = away_m * (self.per_m * (self.widest_m / away_m.truncate().length().max(1.0)).sqrt());
        self.rect.center() + Vec2::new(away.x as f32, -away.y as f32)
    }

    fn draw_orbits(&self, painter: &Painter) {
        for (body, parent) in self.now.parents.iter().enumerate() {
            let (Some(orbit), Some(parent)) = (self.now.open.worlds.ephemeris().orbit(body), *parent) else { continue };
            if orbit.semi_major_m * self.per_m < LEAST_ORBIT {
                continue;
            }
            let around_m = self.now.poses[parent].position_m;
            let point =
                |side: u32| self.at(around_m + orbit.at_anomaly(TAU * f64::from(side) / f64::from(ORBIT_SIDES)));
            let line: Vec<Pos2> = (0..=ORBIT_SIDES).map(point).collect();
            let is_here = self.now.here == Some(body);
            let color = if is_here { Color32::from_rgb(120, 170, 230) } else { Color32::from_gray(70) };
            painter.add(egui::Shape::line(line, Stroke::new(1.0, color)));
        }
    }

    /// The bodies on the map, without points, and without moons that are not told apart from their planet.
    fn bodies(&self) -> Vec<(usize, Pos2)> {
        let is_apart = |body: &usize| {
            let orbit = self.now.open.worlds.ephemeris().orbit(*body);
            orbit.is_none_or(|orbit| orbit.semi_major_m * self.per_m > LEAST_APART)
        };
        (0..self.now.poses.len())
            .filter(|body| !self.now.system().bodies[*body].is_point())
            .filter(is_apart)
            .map(|body| (body, self.at(self.now.poses[body].position_m)))
            .filter(|(_, at)| self.rect.contains(*at))
            .collect()
    }
}

fn draw_body(painter: &Painter, font: &egui::FontId, now: &Now<'_>, body: usize, at: Pos2) {
    let member = &now.system().bodies[body];
    let (radius, color) = match &member.light {
        Some(light) => {
            let [r, g, b] = light.color().map(|c| c as f32);
            (5.0, egui::Rgba::from_rgb(r, g, b).into())
        }
        None if now.here == Some(body) => (3.0, Color32::from_rgb(140, 190, 250)),
        None => (3.0, Color32::from_gray(190)),
    };
    painter.circle_filled(at, radius, color);
    let beside = at + Vec2::new(6.0, -6.0);
    painter.text(beside, egui::Align2::LEFT_BOTTOM, &member.name, font.clone(), Color32::from_gray(200));
}

/// The menu of systems.
fn choices(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let name = state.system.as_ref().map_or("Choose a system", |system| &system.worlds.system().name);
        menu_button(ui, name, |ui| {
            for (index, shipped) in shipped::ALL.iter().enumerate() {
                if ui.button(readable_stem(Path::new(shipped.file))).clicked() {
                    commands.push(Action::System(SystemAction::Open(index)));
                    ui.close();
                }
            }
            ui.weak("Others: File, Open");
        });
        if state.system.is_some()
            && ui.button("Leave").on_hover_text("Draw the planet alone, under its own star").clicked()
        {
            commands.push(Action::System(SystemAction::Leave));
        }
    });
    ui.add_space(4.0);
}

/// The time as days since time zero.
fn time(ui: &mut egui::Ui, time_secs: f64, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let mut days = time_secs / DAY_SECS;
        let label = ui.label("Day");
        let field = ui.add(egui::DragValue::new(&mut days).speed(0.02).max_decimals(3)).labelled_by(label.id);
        let told = "Days of 24 hours since time zero. Drag to let the bodies move";
        let mut changed = field.on_hover_text(told).changed();
        for (text, step) in [("−30", -30.0), ("−1", -1.0), ("+1", 1.0), ("+30", 30.0)] {
            if ui.small_button(text).on_hover_text(format!("{text} days")).clicked() {
                days += step;
                changed = true;
            }
        }
        if changed {
            commands.push(Action::Set(Setting::TimeSecs(days * DAY_SECS)));
        }
    });
}
