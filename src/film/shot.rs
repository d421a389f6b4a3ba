//! A photograph of a planet from a view: builds the ground for it and draws it.

use super::file::FileKind;
use crate::lod::View;
use crate::planet::file::write_atomically;
use crate::render::{DebugView, Photo, Post, RenderError, Renderer, Scene};
use crate::terrain::Terrain;
use crate::tiles::{add_detail, build_over};
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// Longest side in pixels of the picture whose ground is drawn: the tiles of a larger one would not fit into memory.
const GROUND_PX: u32 = 3840;

/// A photograph to take.
#[derive(Clone)]
pub struct Shot {
    /// The ground.
    pub terrain: Arc<Terrain>,
    /// The camera, and the size of the picture.
    pub view: View,
    /// Unit vector towards the star.
    pub sun_dir_planet: DVec3,
    /// Seconds since time zero: clouds and waves.
    pub time_secs: f64,
    /// The planet, or a debug view.
    pub debug_view: DebugView,
    /// Exposure, white balance, tone curve.
    pub post: Post,
    /// Samples, lens, and kind of the pixels.
    pub photo: Photo,
}

impl Shot {
    /// Takes the photograph: pixels row by row from the top, or none if `progress` said no. It hears the share that is
    /// done.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn take(
        &self,
        renderer: &mut Renderer,
        progress: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Option<Vec<[f32; 3]>>, RenderError> {
        // The ground of a large picture is as fine as that of a smaller one.
        let ground_view = View { size_px: fitted(self.view.size_px), ..self.view };
        let mut surface = build_over(&self.terrain, &ground_view);
        add_detail(&mut surface, &ground_view);
        let mut scene = Scene::of_planet(&surface, self.view, self.sun_dir_planet);
        for body in &mut scene.bodies {
            body.frozen = (ground_view.size_px != self.view.size_px).then_some(ground_view);
        }
        scene.time_secs = self.time_secs;
        scene.debug_view = self.debug_view;
        scene.post = self.post;
        self.photo.take(renderer, &scene, progress)
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

/// Photographs to take one after the other, each into a file.
pub struct Sequence {
    /// The photographs and their files.
    pub shots: Vec<(Shot, PathBuf)>,
    /// The kind of all files.
    pub kind: FileKind,
}

impl Sequence {
    /// Takes all photographs. A file is there whole or not at all. `progress` hears the share that is done and says
    /// whether to go on. Gives the number of files written.
    ///
    /// # Errors
    /// What went wrong, with the file.
    pub fn take(&self, renderer: &mut Renderer, progress: &mut dyn FnMut(f64) -> bool) -> Result<usize, String> {
        let all = self.shots.len() as f64;
        for (number, (shot, path)) in self.shots.iter().enumerate() {
            let told = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
            let mut shot = shot.clone();
            shot.photo.develop = self.kind.develop();
            let taken = shot.take(renderer, &mut |done| progress((number as f64 + done) / all));
            let Some(pixels) = taken.map_err(|error| told(&error))? else { return Ok(number) };
            let bytes = self.kind.encode(&pixels, shot.view.size_px).map_err(|error| told(&error))?;
            write_atomically(path, &bytes).map_err(|error| told(&error))?;
        }
        Ok(self.shots.len())
    }
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
