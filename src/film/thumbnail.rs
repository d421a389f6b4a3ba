//! Small pictures of planets for grids and lists: quick rather than exact.
//!
//! The world maps are drafts unless those of another planet serve, tiles are as coarse as the picture allows, and cloud
//! maps are coarse from the second picture of a renderer on.

use crate::lod::{Camera, Quality, View};
use crate::planet::Planet;
use crate::render::{Photo, Renderer, Scene};
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use crate::terrain::coarse::CellFields;
use crate::tiles::build_over;
use crate::world::MapWork;
use std::sync::Arc;

/// Opening angle of the camera, and the share of it that the planet fills.
const FOV_Y_RAD: f64 = 0.5;
const FILLED: f64 = 0.94;

/// A small square picture of a whole planet to draw.
#[derive(Clone)]
pub struct Thumbnail {
    /// The planet.
    pub planet: Arc<Planet>,
    /// Terrain of a similar planet, whose world maps serve where they are the same.
    pub like: Option<Arc<Terrain>>,
    /// The place below the eye.
    pub place: LatLon,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// Width and height, pixels.
    pub side_px: u32,
}

impl Thumbnail {
    /// Draws the picture: linear display values from 0 to 1, row by row from the top.
    ///
    /// # Errors
    /// The planet is not valid, or the device fails.
    pub fn draw(&self, renderer: &mut Renderer) -> Result<Vec<[f32; 3]>, String> {
        let view = self.view();
        let terrain = Arc::new(self.terrain()?);
        // Finer meshes take the place of detail textures, which would take longer.
        let surface = build_over(&terrain, &View { quality: Quality::High, ..view });
        let sun = self.planet.star.place(self.time_secs);
        let mut scene = Scene::of_planet(&surface, view, sun.direction());
        scene.time_secs = self.time_secs;
        scene.drafts = true;
        let drawn = Photo::default().take(renderer, &scene, &mut |_| true);
        drawn.map_err(|error| error.to_string()).map(Option::unwrap_or_default)
    }

    fn view(&self) -> View {
        let radius_m = self.planet.radius_m() / (0.5 * FOV_Y_RAD * FILLED).sin();
        let camera = Camera::over(self.place, radius_m, 0.0, -std::f64::consts::FRAC_PI_2, FOV_Y_RAD);
        View { camera, size_px: [self.side_px; 2], quality: Quality::Low }
    }

    fn terrain(&self) -> Result<Terrain, String> {
        let planet = Arc::clone(&self.planet);
        let builder = Terrain::builder(planet);
        let builder = if let Some(like) = &self.like { builder.reuse(like) } else { builder };
        let terrain = builder.draft().map_err(|error| error.to_string())?;
        let drafted = terrain.with_draft_maps(&CellFields::default(), &mut MapWork::default());
        Ok(drafted.unwrap_or(terrain))
    }
}
