//! The window of the system: its bodies as a tree, a map of the orbits, and the time.

use crate::editor::command::{Action, Commands, SystemAction, Window};
use crate::editor::state::State;
use crate::editor::state::system::OpenSystem;
use crate::editor::widgets::menu_button;
use crate::system::limits::{distance_text, warnings};
use crate::system::{Pose, shipped};
use eframe::egui::{self, Color32, Sense, Stroke, Vec2};
use glam::DVec3;

const WIDTH: f32 = 340.0;
/// Height of the map of orbits, in points.
const MAP_HEIGHT: f32 = 230.0;
/// Points of a drawn orbit.
const ORBIT_POINTS: usize = 128;
/// Margin around the widest orbit on the map, as a factor.
const ROOM: f64 = 1.12;
const DAY_SECS: f64 = 86_400.0;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("system window")
}

/// The window, and what its map shows.
#[derive(Default)]
pub struct SystemWindow {
    /// The body in the middle of the map; None: the one at the root.
    center: Option<usize>,
    /// Magnification of the map.
    zoom: f64,
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
            match &state.system {
                Some(system) => {
                    let height = (ctx.content_rect().height() - 150.0).max(120.0);
                    let area = egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height);
                    area.show(ui, |ui| {
                        self.content(ui, state, system, commands);
                    });
                }
                None => {
                    ui.weak(
                        "A system has stars, planets and moons. Each planet is a preset; the others stand in its sky.",
                    );
                }
            }
        });
        if !open {
            commands.push(Action::Close(Window::System));
        }
    }

    fn content(&mut self, ui: &mut egui::Ui, state: &State, open: &OpenSystem, commands: &mut Commands) {
        let time_secs = state.viewport.settings.time_secs;
        let poses = open.worlds.ephemeris().at(time_secs);
        self.map(ui, open, &poses, time_secs, commands);
        time(ui, time_secs, commands);
        ui.separator();
        let parents = open.worlds.system().parents();
        for (number, parent) in parents.iter().enumerate() {
            if parent.is_none() {
                self.branch(ui, open, &poses, (number, 0), commands);
            }
        }
        for warning in warnings(open.worlds.system(), &open.worlds.radii_m()) {
            ui.colored_label(ui.visuals().warn_fg_color, warning.message);
        }
    }

    /// A body and those that orbit it.
    fn branch(
        &mut self,
        ui: &mut egui::Ui,
        open: &OpenSystem,
        poses: &[Pose],
        (number, depth): (usize, usize),
        commands: &mut Commands,
    ) {
        let system = open.worlds.system();
        let (body, parents) = (&system.bodies[number], system.parents());
        ui.horizontal(|ui| {
            ui.add_space(14.0 * depth as f32);
            let is_here = open.here == Some(number);
            let name = ui.selectable_label(is_here, &body.name);
            let told = match open.preset(number) {
                Some(_) if is_here => "The open planet. A click puts it in the middle of the map",
                Some(_) => "A click puts it in the middle of the map, a double click goes there",
                None => "A click puts it in the middle of the map",
            };
            if name.on_hover_text(told).clicked() {
                (self.center, self.zoom) = (Some(number), 1.0);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if open.preset(number).is_some() {
                    let go = ui.add_enabled(!is_here, egui::Button::new("Go").small());
                    if go.on_hover_text(format!("Open {} and stand near it", body.name)).clicked() {
                        commands.push(Action::System(SystemAction::Visit(number)));
                    }
                }
                if let Some(parent) = parents[number] {
                    let apart_m = poses[number].position_m.distance(poses[parent].position_m);
                    ui.weak(distance_text(apart_m));
                }
            });
        });
        for child in (0..parents.len()).filter(|child| parents[*child] == Some(number)) {
            self.branch(ui, open, poses, (child, depth + 1), commands);
        }
    }

    /// The orbits around the body in the middle, seen from the north.
    fn map(&mut self, ui: &mut egui::Ui, open: &OpenSystem, poses: &[Pose], time_secs: f64, commands: &mut Commands) {
        let system = open.worlds.system();
        let (parents, ephemeris) = (system.parents(), open.worlds.ephemeris());
        let center = self.center.filter(|center| *center < system.bodies.len()).unwrap_or(0);
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), MAP_HEIGHT), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Map of the orbits"));
        self.zoom = if self.zoom > 0.0 { self.zoom } else { 1.0 };
        if response.hovered() {
            let scroll = f64::from(ui.input(|input| input.smooth_scroll_delta().y));
            self.zoom = (self.zoom * (scroll * 0.004).exp()).clamp(0.2, 1e4);
        }
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, Color32::from_gray(12));
        let around: Vec<usize> = (0..parents.len()).filter(|body| parents[*body] == Some(center)).collect();
        let orbits = around.iter().chain([&center]).filter_map(|body| ephemeris.orbit(*body));
        let widest_m = around
            .iter()
            .filter_map(|body| ephemeris.orbit(*body))
            .map(|orbit| orbit.semi_major_m * (1.0 + orbit.eccentricity))
            .fold(0.0, f64::max);
        // A body without moons is shown on its own orbit.
        let widest_m =
            if widest_m > 0.0 { widest_m } else { orbits.map(|orbit| orbit.semi_major_m).fold(1.0, f64::max) };
        let per_m = 0.5 * f64::from(rect.height().min(rect.width())) / (widest_m * ROOM) * self.zoom;
        // Roots of distances: inner orbits are not crowded together.
        let at = |position_m: DVec3| {
            let away_m = position_m - poses[center].position_m;
            let away = away_m * (per_m * (widest_m / away_m.truncate().length().max(1.0)).sqrt());
            rect.center() + Vec2::new(away.x as f32, -away.y as f32)
        };
        for (number, parent) in parents.iter().enumerate() {
            let (Some(orbit), Some(parent)) = (ephemeris.orbit(number), *parent) else { continue };
            if orbit.semi_major_m * per_m < 2.0 {
                continue;
            }
            let period_secs = orbit.period_secs();
            let point = |index: usize| {
                let (position_m, _) = orbit.state(time_secs + period_secs * index as f64 / ORBIT_POINTS as f64);
                at(poses[parent].position_m + position_m)
            };
            let is_here = open.here == Some(number);
            let color = if is_here { Color32::from_rgb(120, 170, 230) } else { Color32::from_gray(70) };
            let line: Vec<egui::Pos2> = (0..=ORBIT_POINTS).map(point).collect();
            painter.add(egui::Shape::line(line, Stroke::new(1.0, color)));
        }
        let mut nearest: Option<(f32, usize)> = None;
        for (number, pose) in poses.iter().enumerate() {
            let body = &system.bodies[number];
            let (place, is_star) = (at(pose.position_m), body.light.is_some());
            if !rect.contains(place) || body.is_point() {
                continue;
            }
            // Moons of a planet that is drawn as a point are not told apart from it.
            let is_apart = ephemeris.orbit(number).is_none_or(|orbit| orbit.semi_major_m * per_m > 6.0);
            if !is_apart {
                continue;
            }
            let color = match &body.light {
                Some(light) => {
                    let [r, g, b] = light.color().map(|c| (c.powf(1.0 / 2.2) * 255.0) as u8);
                    Color32::from_rgb(r, g, b)
                }
                None if open.here == Some(number) => Color32::from_rgb(140, 190, 250),
                None => Color32::from_gray(190),
            };
            painter.circle_filled(place, if is_star { 5.0 } else { 3.0 }, color);
            let font = egui::TextStyle::Small.resolve(ui.style());
            painter.text(
                place + Vec2::new(6.0, -6.0),
                egui::Align2::LEFT_BOTTOM,
                &body.name,
                font,
                Color32::from_gray(200),
            );
            if let Some(pointer) = response.interact_pointer_pos() {
                let away = pointer.distance(place);
                if away < 12.0 && nearest.is_none_or(|(best, _)| away < best) {
                    nearest = Some((away, number));
                }
            }
        }
        if let Some((_, number)) = nearest {
            if response.double_clicked() && open.preset(number).is_some() && open.here != Some(number) {
                commands.push(Action::System(SystemAction::Visit(number)));
            } else if response.clicked() {
                (self.center, self.zoom) = (Some(number), 1.0);
            }
        }
        response.on_hover_text(
            "From the north. The wheel zooms, a click puts a body in the middle, a double click goes there",
        );
    }
}

/// The menu of systems.
fn choices(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let name = state.system.as_ref().map_or("Choose a system", |system| &system.worlds.system().name);
        menu_button(ui, name, |ui| {
            for (index, shipped) in shipped::ALL.iter().enumerate() {
                let title = shipped.file.trim_end_matches(".ron");
                let title = title[..1].to_uppercase() + &title[1..];
                if ui.button(title).clicked() {
                    commands.push(Action::System(SystemAction::Open(index)));
                    ui.close();
                }
            }
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
            commands.push(Action::System(SystemAction::SetTime(days * DAY_SECS)));
        }
    });
}
