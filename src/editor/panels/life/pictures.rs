//! Pictures of forms in textures for egui: the large one of a population, and a small one of each ready population.
//! Meshes are made on other threads; a picture is drawn again when what it shows has changed.

use crate::editor::state::job::Job;
use crate::editor::viewport::target::FORMAT;
use crate::life::Model;
use crate::life::form::Mesh;
use crate::planet::life::READY_POPULATIONS;
use crate::planet::param::Choice;
use crate::planet::{Form, Population};
use crate::render::{FormCamera, FormMesh, FormTarget, FormView};
use eframe::egui::{self, TextureId};
use eframe::egui_wgpu::RenderState;

/// Pixels of a picture for each pixel of the window, along a side: edges are smooth.
const FINER: f32 = 2.0;
/// Angle of the eye over the horizontal in small pictures, radians.
const RAISED_RAD: f64 = 0.2;

/// A mesh that is wanted: that of a variant of a form.
#[derive(Clone, Debug, PartialEq)]
struct Wanted {
    form: Form,
    seed: u32,
    variant: u8,
}

/// Everything that a picture depends on besides its mesh.
#[derive(Clone, PartialEq)]
struct Look {
    population: Population,
    camera: FormCamera,
    behind: egui::Color32,
}

/// A texture that egui knows.
struct Picture {
    target: FormTarget,
    id: TextureId,
    state: RenderState,
}

impl Picture {
    fn new(state: &RenderState, size_px: [u32; 2]) -> Self {
        let target = FormTarget::new(&state.device, size_px, FORMAT);
        let mut renderer = state.renderer.write();
        let id = renderer.register_native_texture(&state.device, target.view(), wgpu::FilterMode::Linear);
        drop(renderer);
        Self { target, id, state: state.clone() }
    }
}

impl Drop for Picture {
    fn drop(&mut self) {
        self.state.renderer.write().free_texture(&self.id);
    }
}

/// The form that is shown large.
struct Large {
    of: Wanted,
    mesh: FormMesh,
    picture: Option<Picture>,
    drawn: Option<Look>,
}

/// The pictures. Without a graphics device there are none.
#[derive(Default)]
pub(super) struct FormPictures {
    state: Option<RenderState>,
    /// The pipelines, once a picture was asked for; an inner None if they cannot be made.
    view: Option<Option<FormView>>,
    large: Option<Large>,
    under_way: Option<(Wanted, Job<Mesh>)>,
    ready: Vec<Picture>,
    ready_under_way: Option<Job<Mesh>>,
}

impl FormPictures {
    /// Pictures on the window's device.
    pub(super) fn new(state: Option<&RenderState>) -> Self {
        Self { state: state.cloned(), ..Self::default() }
    }

    /// Whether there is a device, and the pipelines are not known to fail.
    pub(super) fn can_draw(&self) -> bool {
        self.state.is_some() && !matches!(self.view, Some(None))
    }

    /// Whether pictures are drawn by the processor.
    pub(super) fn is_software(&self) -> bool {
        let is_cpu = |state: &RenderState| state.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        self.state.as_ref().is_none_or(is_cpu)
    }

    fn view(&mut self) -> Option<(&RenderState, &FormView)> {
        let state = self.state.as_ref()?;
        let made = self.view.get_or_insert_with(|| match FormView::new(&state.device, &state.queue, FORMAT) {
            Ok(view) => Some(view),
            Err(error) => {
                log::error!("no pictures of forms: {error}");
                None
            }
        });
        Some((state, made.as_ref()?))
    }

    /// Asks for the mesh of a variant of a population. Gives the greatest distance of its corners from the axis in
    /// heights of the form, of the newest mesh that is there; None before the first one, and without a device.
    pub(super) fn find(&mut self, ctx: &egui::Context, population: &Population, variant: u8) -> Option<f64> {
        self.view()?;
        let wanted = Wanted { form: population.form.clone(), seed: population.seed, variant };
        if let Some(mesh) = self.under_way.as_ref().and_then(|(_, job)| job.ended()) {
            let of = self.under_way.take().map(|(of, _)| of);
            if let (Some(of), Some(mesh), Some(state)) = (of, mesh, &self.state) {
                let picture = self.large.take().and_then(|large| large.picture);
                self.large = Some(Large { of, mesh: FormMesh::new(&state.device, &mesh), picture, drawn: None });
            }
        }
        let is_there = self.large.as_ref().is_some_and(|large| large.of == wanted);
        // One that is under way is shown before the next begins: a form changes while its slider is dragged.
        if !is_there && self.under_way.is_none() {
            let (population, ctx) = (population.clone(), ctx.clone());
            let job = Job::start(move |_| Model::nearest(&population, variant), move || ctx.request_repaint());
            self.under_way = Some((wanted, job));
        }
        // The mesh of another kind of form would have the wrong material.
        let fits = |large: &&Large| large.of.form.index() == population.form.index();
        self.large.as_ref().filter(fits).map(|large| large.mesh.radius())
    }

    /// The picture of the form that was found last.
    pub(super) fn large(
        &mut self,
        size: egui::Vec2,
        population: &Population,
        camera: FormCamera,
        behind: egui::Color32,
    ) -> Option<TextureId> {
        let look = Look { population: population.clone(), camera, behind };
        let mut large = self.large.take()?;
        if let Some((state, view)) = self.view() {
            let size_px = [size.x, size.y].map(|side| (side * FINER).round().max(1.0) as u32);
            let picture = large.picture.take().filter(|picture| picture.target.size_px() == size_px);
            let is_drawn = picture.is_some() && large.drawn.as_ref() == Some(&look);
            let picture = picture.unwrap_or_else(|| Picture::new(state, size_px));
            if !is_drawn {
                view.draw(&picture.target, &large.mesh, population, &look.camera, gamma(behind));
            }
            (large.picture, large.drawn) = (Some(picture), Some(look));
        }
        let id = large.picture.as_ref().map(|picture| picture.id);
        self.large = Some(large);
        id
    }

    /// The small picture of a ready population. Those that are not there yet are made one after the other.
    pub(super) fn ready(&mut self, ctx: &egui::Context, index: usize, size: egui::Vec2) -> Option<TextureId> {
        if let Some(picture) = self.ready.get(index) {
            return Some(picture.id);
        }
        let next = READY_POPULATIONS.get(self.ready.len())?.population();
        self.view()?;
        let Some(mesh) = self.ready_under_way.as_ref().and_then(Job::ended) else {
            if self.ready_under_way.is_none() {
                let ctx = ctx.clone();
                let job = Job::start(move |_| Model::nearest(&next, 0), move || ctx.request_repaint());
                self.ready_under_way = Some(job);
            }
            return None;
        };
        self.ready_under_way = None;
        let (state, view) = self.view()?;
        let size_px = [size.x, size.y].map(|side| (side * FINER).round().max(1.0) as u32);
        let picture = Picture::new(state, size_px);
        let mesh = FormMesh::new(&state.device, &mesh.unwrap_or_default());
        let camera = fitted(mesh.radius(), RAISED_RAD, 0.6, [0.0, 1.0], size);
        view.draw(&picture.target, &mesh, &next, &camera, gamma(BEHIND_SMALL));
        self.ready.push(picture);
        ctx.request_repaint();
        self.ready.get(index).map(|picture| picture.id)
    }
}

/// Colour around the floor in small pictures: they are made once, for both themes.
pub(super) const BEHIND_SMALL: egui::Color32 = egui::Color32::from_rgb(40, 44, 50);

/// A colour as it stands in the texture.
fn gamma(color: egui::Color32) -> [f32; 3] {
    [color.r(), color.g(), color.b()].map(|part| f32::from(part) / 255.0)
}

/// The camera that shows a form and what stands beside it: from `[left, top]`, heights of the form from its foot, if
/// that is beyond the form. `radius`: greatest distance of its corners from the axis.
pub(super) fn fitted(
    radius: f64,
    raised_rad: f64,
    turn_rad: f64,
    [left, top]: [f64; 2],
    size: egui::Vec2,
) -> FormCamera {
    const MARGIN: f64 = 1.1;
    let (sin, cos) = raised_rad.sin_cos();
    let (left, right) = (left.min(-radius), radius);
    let (low, high) = (-1.3 * radius * sin, (cos + 0.5 * radius * sin).max(top * cos).max(radius * sin));
    let aspect = f64::from(size.x / size.y.max(1.0));
    let height = MARGIN * (high - low).max((right - left) / aspect);
    let middle = [0.5 * (left + right), 0.5 * (low + high)];
    FormCamera { turn_rad, raised_rad, extent: [height * aspect, height], middle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_form_and_what_stands_beside_it_lie_within_the_picture() {
        for (radius, left, top) in [(0.3, -0.5, 1.0), (3.0, -3.5, 0.4), (0.2, -0.3, 4.0)] {
            for size in [egui::vec2(340.0, 200.0), egui::vec2(64.0, 64.0)] {
                let camera = fitted(radius, 0.2, 0.0, [left, top], size);
                let half = camera.extent.map(|side| 0.5 * side);
                assert!(camera.middle[0] - half[0] < left.min(-radius) && camera.middle[0] + half[0] > radius);
                let top = f64::max(1.0, top) * f64::cos(0.2);
                assert!(camera.middle[1] + half[1] > top && camera.middle[1] - half[1] < 0.0, "{radius} {camera:?}");
                assert!((camera.extent[0] / camera.extent[1] - f64::from(size.x / size.y)).abs() < 1e-6);
            }
        }
    }
}
