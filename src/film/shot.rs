//! A photograph of a planet from a view: builds the ground for it and draws it.

use super::place::InSystem;
use crate::lod::View;
use crate::planet::Key;
use crate::render::{DebugView, Photo, Post, RenderError, Renderer, Scene};
use crate::sphere::LatLon;
use crate::terrain::{Revision, Terrain};
use crate::tiles::{Limits, Surface, add_detail_within, build_within};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest side in pixels of the picture whose ground is drawn: the tiles of a larger one would not fit into memory.
const GROUND_PX: u32 = 3840;
/// Share of a limited time for the mesh of the ground; the rest is for its detail textures.
const MESH_SHARE: f64 = 0.6;
/// Distance in focus where the middle of the picture is sky, metres.
const SKY_M: f64 = 1e9;

/// A photograph to take.
#[derive(Clone)]
pub struct Shot {
    /// The ground.
    pub terrain: Arc<Terrain>,
    /// The planet for everything that is not ground: sea, air, clouds, star.
    pub revision: Revision,
    /// The camera, and the size of the picture.
    pub view: View,
    /// Seconds since time zero: clouds and waves, and the place of the star unless `sun` gives it.
    pub time_secs: f64,
    /// Where the star is overhead, if not where it is at that time.
    pub sun: Option<LatLon>,
    /// The planet, or a debug view.
    pub debug_view: DebugView,
    /// Index of the population that [`DebugView::Density`] shows.
    pub population: usize,
    /// Exposure, white balance, tone curve.
    pub post: Post,
    /// Samples, lens, and kind of the pixels.
    pub photo: Photo,
    /// The system that the planet is in, if it is not alone: its stars light the planet, and its bodies are drawn.
    pub system: Option<InSystem>,
    /// Whether the lens is in focus where the middle of the picture is, whatever it says itself.
    pub focuses: bool,
    /// Seconds for building the ground, which then stays as fine as it is. None: until it is done.
    pub ground_secs: Option<f64>,
    /// Bytes for the ground, [`Limits::bytes`].
    pub ground_bytes: Option<usize>,
}

impl Shot {
    /// Takes the photograph: pixels row by row from the top, or none if `progress` said no. It hears the share that is
    /// done.
    ///
    /// # Errors
    /// As [`Renderer::render`]; and [`RenderError::Planet`] for a body of the system that cannot be evaluated.
    pub fn take(
        &self,
        renderer: &mut Renderer,
        progress: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Option<Vec<[f32; 3]>>, RenderError> {
        // The ground of a large picture is as fine as that of a smaller one.
        let ground_view = View { size_px: fitted(self.view.size_px), ..self.view };
        let surface = self.ground(&ground_view);
        let sun = self.sun.unwrap_or_else(|| self.revision.planet().star.place(self.time_secs));
        let mut scene = Scene::of_revision(self.revision.clone(), &surface, self.view, sun.direction());
        let others = self.system.as_ref().map(|system| system.others(&mut scene, self.time_secs)).transpose()?;
        for other in others.iter().flatten() {
            scene.bodies.push(other.body());
        }
        for body in &mut scene.bodies {
            body.frozen = (ground_view.size_px != self.view.size_px).then_some(ground_view);
        }
        scene.time_secs = self.time_secs;
        (scene.debug_view, scene.population) = (self.debug_view, self.population);
        scene.post = self.post;
        let mut photo = self.photo;
        if let (true, Some(lens)) = (self.focuses, &mut photo.lens) {
            let camera = &self.view.camera;
            let middle_m = self.terrain.raycast(camera.position_planet_m, camera.forward_planet());
            lens.focus_m = middle_m.unwrap_or(SKY_M);
        }
        photo.take(renderer, &scene, progress)
    }

    /// The key of what all frames of a film share: the planet, and the system that it is in.
    pub(super) fn shared(&self) -> Key {
        let system = self.system.as_ref().map(|system| {
            let worlds = system.worlds();
            let planets = (0..worlds.system().bodies.len()).map(|body| worlds.planet(body));
            let planets: Vec<_> = planets.map(|planet| planet.map(|planet| Key::of_planet(planet))).collect();
            Key::of(&(worlds.system(), system.body(), planets))
        });
        Key::of(&(Key::of_planet(self.revision.planet()), system))
    }

    /// Everything else that the picture depends on.
    pub(super) fn own(&self) -> impl std::fmt::Debug + use<> {
        let Self { view, time_secs, sun, post, photo, focuses, ground_secs, ground_bytes, .. } = *self;
        (view, time_secs, sun, (self.debug_view, self.population), post, photo, (focuses, ground_secs, ground_bytes))
    }

    /// The ground for a view, in the time and the memory that there are.
    fn ground(&self, view: &View) -> Surface {
        let begun = Instant::now();
        let limits = |share: f64| Limits {
            until: self.ground_secs.map(|secs| begun + Duration::from_secs_f64(secs * share)),
            bytes: self.ground_bytes,
        };
        let mut surface = build_within(&self.terrain, view, &limits(MESH_SHARE));
        let has_detail = add_detail_within(&mut surface, view, &limits(1.0));
        if let (Some(secs), false) = (self.ground_secs, has_detail && surface.complete) {
            log::warn!("the ground is coarser than the picture shows: {secs} s were not enough; allow more");
        }
        surface
    }
}

/// A size that is not larger than [`GROUND_PX`], of the same shape.
fn fitted(size_px: [u32; 2]) -> [u32; 2] {
    let longer = size_px[0].max(size_px[1]);
    if longer <= GROUND_PX {
        return size_px;
    }
    size_px.map(|side| (u64::from(side) * u64::from(GROUND_PX) / u64::from(longer)).max(1) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_is_as_fine_as_that_of_a_picture_that_fits() {
        assert_eq!(fitted([1920, 1080]), [1920, 1080]);
        assert_eq!(fitted([15_360, 8640]), [3840, 2160]);
        assert_eq!(fitted([16_384, 1]), [3840, 1]);
    }
}
