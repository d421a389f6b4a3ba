//! A layer on the planet: the planet with some of its layers alone, and an overlay that colours where a layer acts or
//! by how much it changes the height.
//!
//! The overlay is evaluated on another thread at a grid of points over the picture, so that it shows any quantity the
//! evaluator knows, at any distance, and costs the renderer nothing.

use crate::editor::state::job::{GoOn, Job};
use crate::editor::widgets::number::length_text;
use crate::lod::View;
use crate::planet::Planet;
use crate::render::Legend;
use crate::tiles::Surface;
use eframe::egui::{self, Color32, Rect};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// Distance between points of the grid, in points of the window: at first, and once the view rests.
const SPACINGS: [f32; 2] = [7.0, 2.0];
/// Most points of the grid along a side.
const MOST: [f32; 2] = [240.0, 800.0];
/// Rows of the grid that are evaluated before the work may be stopped.
const STRIP: usize = 8;
/// Opacity of the overlay.
const OPACITY: f32 = 0.72;
/// Height of the eye, in units of the tallest relief, from which points lie on the mean sphere.
const FAR: f64 = 30.0;

/// What an overlay shows of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerQuantity {
    /// How far its masks let it act, 0 to 1.
    Mask,
    /// By how much it changes the height.
    Change,
}

/// The overlay that is wanted: the layer of an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerOverlay {
    /// Index of the layer.
    pub layer: usize,
    /// What it shows.
    pub quantity: LayerQuantity,
}

/// Values at a grid of points over the picture, row by row from the top; NaN where there is no ground.
#[derive(Clone, Debug, Default)]
struct Values {
    size: [usize; 2],
    values: Vec<f32>,
    /// The greatest absolute value.
    most: f32,
}

#[derive(Clone)]
struct Question {
    view: View,
    surface: Arc<Surface>,
    overlay: LayerOverlay,
    size: [usize; 2],
}

impl Question {
    /// Whether both ask the same, at any spacing.
    fn same_as(&self, other: &Self) -> bool {
        self.view == other.view && self.overlay == other.overlay && Arc::ptr_eq(&self.surface, &other.surface)
    }
}

/// A planet in the place of another one.
struct Seen {
    of: Arc<Planet>,
    solo: Vec<usize>,
    planet: Arc<Planet>,
}

/// The overlay, and the planet of the layers that are seen alone.
#[derive(Default)]
pub struct LayerView {
    seen: Option<Seen>,
    shown: Option<(Question, Values)>,
    texture: Option<egui::TextureHandle>,
    under_way: Option<(Question, Job<Option<Values>>)>,
}

impl LayerView {
    /// The planet as it is seen: with the layers `solo` alone, without its structure and sea, unless there are none;
    /// and without clouds over those or over an overlay.
    pub(super) fn seen(&mut self, planet: &Arc<Planet>, solo: &[usize], has_overlay: bool) -> Arc<Planet> {
        if solo.is_empty() && !has_overlay {
            self.seen = None;
            return Arc::clone(planet);
        }
        if let Some(seen) = &self.seen
            && Arc::ptr_eq(&seen.of, planet)
            && seen.solo == solo
        {
            return Arc::clone(&seen.planet);
        }
        let mut bare = Planet::clone(planet);
        bare.clouds = None;
        if !solo.is_empty() {
            (bare.structure, bare.water) = (None, None);
            for (index, layer) in bare.layers.iter_mut().enumerate() {
                layer.enabled = solo.contains(&index);
            }
        }
        let bare = Arc::new(bare);
        self.seen = Some(Seen { of: Arc::clone(planet), solo: solo.to_vec(), planet: Arc::clone(&bare) });
        bare
    }

    /// What the overlay on screen shows.
    pub fn quantity(&self) -> Option<LayerQuantity> {
        self.shown.as_ref().map(|(question, _)| question.overlay.quantity)
    }

    /// What the colours of the overlay on screen mean.
    pub fn legend(&self) -> Option<Legend> {
        let (question, values) = self.shown.as_ref()?;
        let quantity = question.overlay.quantity;
        let (steps, ends) = match quantity {
            LayerQuantity::Mask => (0..=8, ["off".to_owned(), "on".to_owned()]),
            LayerQuantity::Change => (
                -8..=8,
                [format!("−{}", length_text(values.most.into())), format!("+{}", length_text(values.most.into()))],
            ),
        };
        let linear = |step: i32| {
            let over_grey = Color32::from_gray(60).blend(color(quantity, step as f32, 8.0));
            let [r, g, b, _] = egui::Rgba::from(over_grey).to_array();
            [r, g, b].map(f64::from)
        };
        Some(Legend::Ramp { colors: steps.map(linear).collect(), ends })
    }

    /// Paints the overlay over the picture once it is evaluated. `wanted`: None takes it away.
    pub(super) fn paint(
        &mut self,
        ui: &egui::Ui,
        rect: Rect,
        wanted: Option<LayerOverlay>,
        (view, surface): (&View, &Arc<Surface>),
    ) {
        let Some(overlay) = wanted else {
            (self.shown, self.texture, self.under_way) = (None, None, None);
            return;
        };
        let [coarse, fine] = [0, 1].map(|step| {
            [rect.width(), rect.height()].map(|side| (side / SPACINGS[step]).clamp(2.0, MOST[step]) as usize)
        });
        let mut question = Question { view: *view, surface: Arc::clone(surface), overlay, size: coarse };
        self.receive(ui);
        // The fine grid takes long: the coarse one of another view does not wait for it.
        self.under_way.take_if(|(asked, _)| asked.size != coarse && !asked.same_as(&question));
        let shown = self.shown.as_ref().filter(|(shown, _)| shown.same_as(&question)).map(|(shown, _)| shown.size);
        if shown.is_some() {
            question.size = fine;
        }
        if shown != Some(fine) && self.under_way.is_none() {
            self.ask(ui, question.clone());
        }
        // An overlay of another view would lie in the wrong place.
        let fits = |(shown, _): &(Question, Values)| shown.view == question.view && shown.overlay == question.overlay;
        if let Some(texture) = self.texture.as_ref().filter(|_| self.shown.as_ref().is_some_and(fits)) {
            let uv = Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, uv, Color32::WHITE);
        }
    }

    fn ask(&mut self, ui: &egui::Ui, question: Question) {
        let (asked, ctx) = (question.clone(), ui.ctx().clone());
        let job = Job::start(move |go_on| evaluate(&asked, go_on), move || ctx.request_repaint());
        self.under_way = Some((question, job));
    }

    fn receive(&mut self, ui: &egui::Ui) {
        let Some(ended) = self.under_way.as_ref().and_then(|(_, job)| job.ended()) else { return };
        let Some((question, _)) = self.under_way.take() else { return };
        let ended = ended.flatten();
        // What could not be evaluated is not asked again: it has no values.
        let values = ended.unwrap_or_default();
        let pixels = values.values.iter().map(|value| color(question.overlay.quantity, *value, values.most));
        let image = egui::ColorImage::new(values.size, pixels.collect());
        let is_empty = values.values.is_empty();
        let load = || ui.ctx().load_texture("layer overlay", image, egui::TextureOptions::LINEAR);
        self.texture = (!is_empty).then(load);
        self.shown = Some((question, values));
    }
}

/// The colour of a value: masks from nothing to amber, changes from blue (lowered) over nothing to red (raised).
pub fn color(quantity: LayerQuantity, value: f32, most: f32) -> Color32 {
    let share = if most > 0.0 { (value / most).clamp(-1.0, 1.0) } else { 0.0 };
    if !share.is_finite() {
        return Color32::TRANSPARENT;
    }
    let full = match quantity {
        LayerQuantity::Mask => Color32::from_rgb(255, 176, 32),
        LayerQuantity::Change if share < 0.0 => Color32::from_rgb(40, 120, 255),
        LayerQuantity::Change => Color32::from_rgb(255, 70, 40),
    };
    // Small values stay visible.
    full.gamma_multiply(OPACITY * share.abs().sqrt())
}

/// The values of a grid; None if it was told to stop.
fn evaluate(question: &Question, go_on: GoOn<'_>) -> Option<Values> {
    let Question { view, surface, overlay, size } = question;
    let (terrain, camera) = (&surface.terrain, &view.camera);
    let (radius_m, eye) = (terrain.planet().radius_m(), camera.position_planet_m);
    let (low_m, high_m) = terrain.height_bounds_m();
    let relief_m = high_m.abs().max(low_m.abs()).max(1.0);
    let is_far = eye.length() - radius_m > FAR * relief_m;
    let [width, height] = *size;
    // Between points of the grid on the nearest ground.
    let altitude_m = (eye.length() - radius_m - high_m.max(0.0)).max(0.0);
    let spacing_rad = altitude_m * 2.0 * (0.5 * camera.fov_y_rad).tan() / height as f64 / radius_m;
    let hit = |i: usize| {
        let x = ((i % width) as f64 + 0.5) / width as f64 * 2.0 - 1.0;
        let y = 1.0 - ((i / width) as f64 + 0.5) / height as f64 * 2.0;
        let ray = camera.ray_dir_planet(x, y, view.aspect());
        let distance_m = if is_far { sphere(eye, ray, radius_m) } else { terrain.raycast(eye, ray) };
        distance_m.map(|distance_m| (eye + ray * distance_m).normalize_or(DVec3::Z))
    };
    let mut values = Vec::with_capacity(width * height);
    for top in (0..height).step_by(STRIP) {
        // The share stays 0: nothing shows it.
        if !go_on(0.0) {
            return None;
        }
        let points = top * width..(top + STRIP).min(height) * width;
        let hits: Vec<Option<DVec3>> = points.into_par_iter().with_min_len(16).map(hit).collect();
        let dirs: Vec<DVec3> = hits.iter().flatten().copied().collect();
        let mut effects = terrain.layer_effects(&dirs, overlay.layer, spacing_rad).into_iter();
        values.extend(hits.iter().map(|hit| {
            let effect = hit.and_then(|_| effects.next());
            effect.map_or(f32::NAN, |effect| match overlay.quantity {
                LayerQuantity::Mask => effect.mask as f32,
                LayerQuantity::Change => effect.change_m as f32,
            })
        }));
    }
    let most = match overlay.quantity {
        LayerQuantity::Mask => 1.0,
        LayerQuantity::Change => values.iter().fold(0.0_f32, |most, value| most.max(value.abs())),
    };
    Some(Values { size: *size, values, most })
}

/// Distance along a ray to a sphere about the centre.
fn sphere(eye: DVec3, dir: DVec3, radius_m: f64) -> Option<f64> {
    let along = -eye.dot(dir);
    let discriminant = along * along - eye.length_squared() + radius_m * radius_m;
    (discriminant >= 0.0 && along > 0.0).then(|| along - discriminant.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Camera, Quality};
    use crate::planet::shipped;
    use crate::sphere::LatLon;
    use crate::tiles::build_now;

    fn question(altitude_m: f64, quantity: LayerQuantity) -> Question {
        let planet = Arc::new(shipped::layered());
        let place = LatLon::from_degrees(20.0, 30.0);
        let camera = Camera::over(place, planet.radius_m() + altitude_m, 0.0, -1.5, Camera::DEFAULT_FOV_Y_RAD);
        let view = View { camera, size_px: [64, 64], quality: Quality::Low };
        let surface = build_now(&planet, &view).unwrap();
        Question { view, surface: Arc::new(surface), overlay: LayerOverlay { layer: 0, quantity }, size: [24, 24] }
    }

    #[test]
    fn the_grid_holds_what_the_layer_does_at_its_points_and_nothing_in_the_sky() {
        let far = question(6e7, LayerQuantity::Change);
        let values = evaluate(&far, &|_| true).unwrap();
        assert!(evaluate(&far, &|_| false).is_none(), "stopped");
        assert!(values.values[0].is_nan(), "the corner is sky");
        assert!(values.values[12 * 24 + 12].is_finite(), "the middle is ground");
        assert!(values.most > 1.0);
        let near = question(3000.0, LayerQuantity::Mask);
        let values = evaluate(&near, &|_| true).unwrap();
        assert!(values.values.iter().all(|mask| (0.0..=1.0).contains(mask)));
    }

    #[test]
    fn colours_tell_raised_from_lowered_and_ground_from_sky() {
        let color = |value| color(LayerQuantity::Change, value, 100.0);
        assert!(color(100.0).r() > color(100.0).b() && color(-100.0).b() > color(-100.0).r());
        assert_eq!((color(f32::NAN), color(0.0).a()), (Color32::TRANSPARENT, 0));
        assert!(color(5.0).a() > 20, "small changes are seen");
    }

    #[test]
    fn layers_alone_are_made_once() {
        let planet = Arc::new(shipped::layered());
        let mut view = LayerView::default();
        assert!(Arc::ptr_eq(&view.seen(&planet, &[], false), &planet));
        let seen = view.seen(&planet, &[1], false);
        assert!(Arc::ptr_eq(&seen, &view.seen(&planet, &[1], false)));
        let enabled: Vec<_> = seen.layers.iter().map(|layer| layer.enabled).collect();
        assert!(enabled[1] && enabled.iter().filter(|on| **on).count() == 1);
    }
}
