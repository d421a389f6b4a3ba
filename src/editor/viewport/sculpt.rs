//! Sculpting on the planet: strokes, stamps, lines by clicks, and points that are moved.
//!
//! A gesture changes the newest edit of the planet in every frame, so that its picture follows the hand; the frames of
//! a gesture are one undo step. Rays are cast at the ground as it was when the gesture began: a brush that raises the
//! ground would else climb its own hill.

use super::handles::{self, HOLD, Handle, Others};
use super::measure::Measure;
use super::pointer::in_view;
use super::ring;
use crate::editor::widgets::random_seed;
use crate::lod::{Camera, View};
use crate::planet::edits::{EditPoint, GroundEdit, MAX_ALL_COPIES, PaintMode};
use crate::planet::param::Choice;
use crate::planet::{Planet, Tool};
use crate::tiles::Surface;
use eframe::egui;
use glam::DVec3;
use std::sync::Arc;

/// Distance between the points of a stroke, in radii.
const SPACING: f64 = 0.3;
/// Names of the undo steps of a point that is moved, of an edit that is moved, turned and scaled, and of its radius.
const MOVE_STEP: &str = "Move point of edit";
const SHIFT_STEP: &str = "Move edit";
const TURN_STEP: &str = "Turn edit";
const RADIUS_STEP: &str = "Radius of edit";
/// Name of the undo step of a point that is added to a line.
const POINT_STEP: &str = "Add point to edit";

/// What the sculpt tab has in hand.
#[derive(Clone, Debug, Default)]
pub struct SculptLink {
    /// The edit that a drag or a click makes; None: drags move the camera.
    pub brush: Option<Arc<GroundEdit>>,
    /// Index of the edit whose points are shown and can be moved.
    pub selected: Option<usize>,
    /// Whether drags and clicks measure.
    pub measures: bool,
}

/// What is under way.
#[derive(Default)]
enum Gesture {
    #[default]
    None,
    /// A stroke or a line; the points before `fixed` stay, the last follows the pointer.
    Stroke { index: usize, fixed: usize, on: Arc<Surface> },
    /// A stamp, whose radius follows the pointer.
    Stamp { index: usize, middle: DVec3, on: Arc<Surface> },
    /// A point of an edit, whose points were these.
    Point { edit: usize, point: usize, before: Vec<EditPoint>, others: Others, on: Arc<Surface> },
    /// The radius of an edit.
    Radius { edit: usize, on: Arc<Surface> },
}

/// What is on screen.
pub(super) struct Scene<'a> {
    pub(super) surface: &'a Arc<Surface>,
    pub(super) camera: Camera,
    pub(super) rect: egui::Rect,
}

impl Scene<'_> {
    /// The ground or the sea under a point of the window.
    pub(super) fn ground(&self, on: &Surface, pos: egui::Pos2) -> Option<DVec3> {
        let (x, y) = in_view(self.rect, pos);
        let ray = self.camera.ray_dir_planet(x, y, f64::from(self.rect.width() / self.rect.height()));
        let away_m = on.terrain.raycast(self.camera.position_planet_m, ray)?;
        Some((self.camera.position_planet_m + ray * away_m).normalize())
    }
}

/// What the hand did in a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Held {
    /// Whether the first button of the pointer is the hand's.
    pub(super) taken: bool,
    /// The name of the edit, if the planet was changed.
    pub(super) edit: Option<&'static str>,
}

/// The hand of the sculptor.
#[derive(Default)]
pub(super) struct Hand {
    gesture: Gesture,
    /// The edit that grows by a point with each click, and its seed: the list may change meanwhile.
    line: Option<(usize, u32)>,
    /// Where the ring of the brush is.
    ring: Option<DVec3>,
    /// The edit that was made or changed last, once.
    touched: Option<usize>,
    measure: Measure,
    /// How hard a pen presses, 0 to 1; None without one that tells.
    pressure: Option<f64>,
}

impl Hand {
    /// The edit that was made or changed since the last call.
    pub(super) fn take_touched(&mut self) -> Option<usize> {
        self.touched.take()
    }

    /// Whether a gesture or a line of clicks is under way.
    pub(super) fn is_drawing(&self) -> bool {
        self.line.is_some() || !matches!(self.gesture, Gesture::None)
    }

    /// Takes drags and clicks of this frame.
    pub(super) fn handle(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        link: &SculptLink,
        scene: &Scene<'_>,
        planet: &mut Planet,
    ) -> Held {
        let (modifiers, origin) = ui.input(|i| (i.modifiers, i.pointer.press_origin()));
        self.pressure =
            ui.input(|i| pressure(&i.events, self.pressure, i.pointer.any_down() || i.pointer.any_released()));
        // With Alt, drags move the camera as without a brush.
        let brush = link.brush.as_deref().filter(|_| !modifiers.alt);
        if link.measures && !modifiers.alt {
            self.measure.handle(ui, response, scene);
            return Held { taken: true, edit: None };
        }
        self.follow_line(ui, link, planet);
        let pos = response.interact_pointer_pos().or(response.hover_pos());
        self.ring = pos.filter(|_| brush.is_some()).and_then(|pos| scene.ground(self.ground_on(scene), pos));
        // A tool in hand takes hold of no point: strokes often begin where the last one was.
        let held_under = |pos| link.brush.is_none().then(|| handle_under(link, scene, planet, pos)).flatten();
        let over_point = pos.and_then(held_under);
        if response.hovered() && (brush.is_some() || over_point.is_some()) {
            let icon = if over_point.is_some() { egui::CursorIcon::Grab } else { egui::CursorIcon::Crosshair };
            ui.ctx().set_cursor_icon(icon);
        }
        let mut edit = None;
        if response.drag_started_by(egui::PointerButton::Primary)
            && let Some(origin) = origin
        {
            let under = link.brush.is_none().then(|| handle_under(link, scene, planet, origin)).flatten();
            edit = match (under, brush) {
                (Some((edit, handle)), _) => {
                    self.hold(edit, handle, modifiers, scene, planet);
                    None
                }
                (None, Some(brush)) => self.begin(brush, modifiers.shift, scene, origin, planet),
                (None, None) => None,
            };
        }
        // The place of the release counts as well.
        if (response.dragged_by(egui::PointerButton::Primary) || response.drag_stopped_by(egui::PointerButton::Primary))
            && let Some(pos) = response.interact_pointer_pos()
        {
            edit = self.drag(scene, pos, planet).or(edit);
        }
        if response.drag_stopped() {
            self.gesture = Gesture::None;
        }
        if response.double_clicked() {
            self.line = None;
        } else if response.clicked()
            && let (Some(brush), Some(pos)) = (brush, response.interact_pointer_pos())
        {
            edit = self.click(brush, modifiers.shift, scene, pos, planet);
        }
        let taken = brush.is_some() || over_point.is_some() || !matches!(self.gesture, Gesture::None);
        Held { taken, edit }
    }

    /// The ground that rays are cast at.
    fn ground_on<'a>(&'a self, scene: &Scene<'a>) -> &'a Surface {
        match &self.gesture {
            Gesture::Stroke { on, .. } | Gesture::Stamp { on, .. } => on,
            Gesture::Point { on, .. } | Gesture::Radius { on, .. } => on,
            Gesture::None => scene.surface,
        }
    }

    /// Enter and Escape end a line; so do another tool and an undo.
    fn follow_line(&mut self, ui: &egui::Ui, link: &SculptLink, planet: &Planet) {
        let ends = ui.input(|i| i.key_pressed(egui::Key::Enter) || i.key_pressed(egui::Key::Escape));
        let fits = |(index, seed): &(usize, u32)| {
            let tools = (planet.edits.get(*index), link.brush.as_ref());
            matches!(tools, (Some(edit), Some(brush)) if edit.tool.index() == brush.tool.index() && edit.seed == *seed)
        };
        self.line = self.line.filter(fits).filter(|_| !ends);
    }

    /// Takes hold of a handle: with Ctrl the whole edit moves, with Shift it turns.
    fn hold(&mut self, edit: usize, handle: Handle, keys: egui::Modifiers, scene: &Scene<'_>, planet: &Planet) {
        let on = scene.surface.clone();
        let before = planet.edits.get(edit).map(|edit| edit.points.0.clone()).unwrap_or_default();
        let others = match (keys.command, keys.shift) {
            (true, _) => Others::Move,
            (_, true) => Others::Turn,
            _ => Others::Stay,
        };
        self.gesture = match handle {
            Handle::Point(point) => Gesture::Point { edit, point, before, others, on },
            Handle::Radius => Gesture::Radius { edit, on },
        };
    }

    /// Begins a stroke or a stamp.
    fn begin(
        &mut self,
        brush: &GroundEdit,
        inverse: bool,
        scene: &Scene<'_>,
        origin: egui::Pos2,
        planet: &mut Planet,
    ) -> Option<&'static str> {
        let middle = scene.ground(scene.surface, origin)?;
        let point = pressed(point_at(scene.surface, brush, middle), self.pressure);
        let index = self.place(brush, inverse, point, planet)?;
        let on = scene.surface.clone();
        self.gesture = match brush.tool.is_stamp() {
            true => Gesture::Stamp { index, middle, on },
            false => Gesture::Stroke { index, fixed: 1, on },
        };
        self.line = None;
        label(brush)
    }

    /// Adds an edit with one point. Gives its index.
    fn place(&mut self, brush: &GroundEdit, inverse: bool, point: EditPoint, planet: &mut Planet) -> Option<usize> {
        let index = planet.edits.len();
        if planet.edits.is_full() {
            return None;
        }
        let mut edit = GroundEdit { seed: random_seed() as u32, ..brush.clone() };
        edit.copies = edit.copies.min((MAX_ALL_COPIES / edit.image_count()) as u32);
        edit.name = format!("{} {}", label(brush).unwrap_or("Edit"), index + 1);
        edit.points.0 = vec![point];
        if inverse {
            invert(&mut edit.tool);
        }
        if let Tool::Picture(stamp) = &mut edit.tool {
            stamp.file.share(planet.pictures().map(|(_, file, _)| file));
        }
        planet.edits.push(edit);
        self.touched = Some(index);
        Some(index)
    }

    /// Follows the pointer.
    fn drag(&mut self, scene: &Scene<'_>, pos: egui::Pos2, planet: &mut Planet) -> Option<&'static str> {
        let to = scene.ground(self.ground_on(scene), pos)?;
        let (radius_m, pressure) = (planet.radius_m(), self.pressure);
        match &mut self.gesture {
            Gesture::None => None,
            Gesture::Stroke { index, fixed, on } => {
                let edit = planet.edits.get_mut(*index)?;
                let last = edit.points.0.get(fixed.checked_sub(1)?)?.direction();
                edit.points.0.truncate(*fixed);
                let point = pressed(point_at(on, edit, to), pressure);
                let away_m = to.distance(last) * radius_m;
                if point != *edit.points.0.last()? && *fixed < edit.most_points() {
                    edit.points.0.push(point);
                    *fixed += usize::from(away_m >= SPACING * edit.radius_km * 1000.0);
                }
                label(edit)
            }
            Gesture::Stamp { index, middle, .. } => {
                let edit = planet.edits.get_mut(*index)?;
                edit.radius_km = tidy_km(to.angle_between(*middle) * radius_m / 1000.0);
                label(edit)
            }
            Gesture::Radius { edit, .. } => {
                self.touched = Some(*edit);
                handles::set_radius_dir(planet.edits.get_mut(*edit)?, to, radius_m)?;
                Some(RADIUS_STEP)
            }
            Gesture::Point { edit, point, before, others, on } => {
                self.touched = Some(*edit);
                let edit = planet.edits.get_mut(*edit)?;
                edit.points.0 = handles::dragged(before, *point, to, *others);
                match others {
                    Others::Stay => {
                        // Its width and strength stay.
                        let height_m = point_at(on, edit, to).height_m;
                        edit.points.0.get_mut(*point)?.height_m = height_m;
                        Some(MOVE_STEP)
                    }
                    Others::Move => Some(SHIFT_STEP),
                    Others::Turn => Some(TURN_STEP),
                }
            }
        }
    }

    /// A dab, a stamp, or the next point of a line.
    fn click(
        &mut self,
        brush: &GroundEdit,
        inverse: bool,
        scene: &Scene<'_>,
        pos: egui::Pos2,
        planet: &mut Planet,
    ) -> Option<&'static str> {
        let point = point_at(scene.surface, brush, scene.ground(scene.surface, pos)?);
        if let Some((index, _)) = self.line {
            let first = planet.edits.get(index)?.points.0.first().copied()?;
            // A river does not run in a ring.
            let may_close = !matches!(brush.tool, Tool::River(_));
            let closes = may_close && is_near(scene, &first, pos) && planet.edits.get(index)?.points.0.len() > 2;
            let edit = planet.edits.get_mut(index)?;
            if edit.points.0.len() < edit.most_points() {
                edit.points.0.push(if closes { first } else { point });
            } else if closes && let Some(last) = edit.points.0.last_mut() {
                *last = first;
            }
            self.line = self.line.filter(|_| !closes);
            self.touched = Some(index);
            return Some(POINT_STEP);
        }
        let index = self.place(brush, inverse, point, planet)?;
        if brush.tool.is_line() {
            self.line = planet.edits.get(index).map(|edit| (index, edit.seed));
        }
        label(brush)
    }

    /// Draws the ring of the brush, and the points of the selected edit.
    pub(super) fn paint(
        &mut self,
        painter: &egui::Painter,
        link: &SculptLink,
        scene: &Scene<'_>,
        view: &View,
        planet: &Planet,
    ) {
        let ground = ring::Ground { terrain: &scene.surface.terrain, view, rect: scene.rect };
        if link.measures {
            self.measure.paint(painter, &ground, &scene.surface.terrain);
        }
        if let Some(edit) = link.selected.and_then(|index| planet.edits.get(index)) {
            ring::paint_edit(painter, &ground, edit);
        }
        if let (Some(middle), Some(brush)) = (self.ring, &link.brush) {
            let held = match &self.gesture {
                Gesture::Stamp { index, middle, .. } => {
                    planet.edits.get(*index).map(|edit| (*middle, edit.radius_km, edit.softness))
                }
                _ => None,
            };
            let (middle, radius_km, softness) = held.unwrap_or((middle, brush.radius_km, brush.softness));
            ring::paint_brush(painter, &ground, middle, radius_km * 1000.0, softness);
            brush.images().for_each(|image| ring::paint_image(painter, &ground, image.of(middle), radius_km * 1000.0));
        }
    }
}

/// Least strength of a stroke of a pen.
const LIGHTEST: f64 = 0.05;

/// How hard a pen presses after these events. Touches without force, and the mouse, tell nothing.
fn pressure(events: &[egui::Event], before: Option<f64>, is_held: bool) -> Option<f64> {
    let forces = events.iter().filter_map(|event| match event {
        egui::Event::Touch { force, .. } => force.map(f64::from),
        _ => None,
    });
    forces.rev().find(|force| *force > 0.0).or(before.filter(|_| is_held))
}

/// A point of a stroke: a pen that presses lightly does little.
fn pressed(point: EditPoint, pressure: Option<f64>) -> EditPoint {
    let strength = pressure.map_or(1.0, |pressure| (pressure.clamp(LIGHTEST, 1.0) * 1000.0).round() / 1000.0);
    EditPoint { strength, ..point }
}

/// Turns a tool around: what raises lowers, what is left is right, what plants clears.
fn invert(tool: &mut Tool) {
    match tool {
        Tool::Raise(raise) => raise.amount_m = -raise.amount_m,
        Tool::Picture(stamp) => stamp.height_m = -stamp.height_m,
        Tool::Fault(fault) => fault.throw_m = -fault.throw_m,
        Tool::Coast(coast) => coast.flip = !coast.flip,
        Tool::Moisture(paint) if paint.mode == PaintMode::Shift => paint.moisture = -paint.moisture,
        Tool::Temperature(paint) if paint.mode == PaintMode::Shift => paint.temperature_c = -paint.temperature_c,
        Tool::Clouds(paint) => paint.amount = -paint.amount,
        Tool::Mask(paint) => paint.amount = -paint.amount,
        Tool::Life(paint) => paint.density = 0.0,
        Tool::Uplift(paint) => paint.uplift_m = -paint.uplift_m,
        Tool::Rock(paint) => paint.hardness = -paint.hardness,
        Tool::Rain(paint) => paint.rain_mm = -paint.rain_mm,
        _ => {}
    }
}

/// Whether a point is under the pointer.
fn is_near(scene: &Scene<'_>, point: &EditPoint, pos: egui::Pos2) -> bool {
    let view = View { camera: scene.camera, ..scene.surface.view };
    let ground = ring::Ground { terrain: &scene.surface.terrain, view: &view, rect: scene.rect };
    ground.on_screen(point.direction()).is_some_and(|place| place.distance(pos) <= HOLD)
}

/// The name of the undo step of an edit with this tool.
fn label(edit: &GroundEdit) -> Option<&'static str> {
    Tool::LABELS.get(edit.tool.index()).copied()
}

/// The point of an edit at a direction. A road begins at the height of the ground.
fn point_at(on: &Surface, edit: &GroundEdit, dir: DVec3) -> EditPoint {
    let point = EditPoint::under(dir);
    let is_road = matches!(edit.tool, Tool::Road(_));
    let height_m = if is_road { (on.terrain.height_m(dir) * 10.0).round() / 10.0 } else { 0.0 };
    EditPoint { height_m, ..point }
}

/// A radius of three digits, within the limits of an edit.
pub fn tidy_km(radius_km: f64) -> f64 {
    let radius_km = radius_km.clamp(0.001, 5000.0);
    let unit = 10_f64.powf(radius_km.log10().floor() - 2.0);
    ((radius_km / unit).round() * unit * 1e6).round() / 1e6
}

/// The edit and the handle of it that the pointer can take hold of.
fn handle_under(link: &SculptLink, scene: &Scene<'_>, planet: &Planet, pos: egui::Pos2) -> Option<(usize, Handle)> {
    let index = link.selected?;
    let edit = planet.edits.get(index)?;
    let view = View { camera: scene.camera, ..scene.surface.view };
    let ground = ring::Ground { terrain: &scene.surface.terrain, view: &view, rect: scene.rect };
    handles::under(&ground, edit, pos).map(|handle| (index, handle))
}
