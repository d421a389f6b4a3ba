//! Planets with small pictures, which are drawn in the background.

use super::thumbnails::Thumbnails;
use crate::film::Thumbnail;
use crate::planet::Planet;
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use eframe::egui;
use std::sync::Arc;

/// Side of the pictures, pixels.
const SIDE_PX: u32 = 224;

/// A planet and its picture.
pub struct Cell {
    /// The planet.
    pub planet: Arc<Planet>,
    /// Its picture, once it is drawn, or why it cannot be drawn.
    pub picture: Option<Result<egui::TextureHandle, String>>,
}

/// How the planets of a sheet are seen.
#[derive(Clone, Default)]
pub struct Seen {
    /// The place below the eye; None: of each planet the one where it is seen first.
    pub place: Option<LatLon>,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// Whether clouds are left out, which would hide what is below.
    pub without_clouds: bool,
    /// Terrain of a similar planet, whose world maps serve where they are the same.
    pub like: Option<Arc<Terrain>>,
}

/// Planets with small pictures.
#[derive(Default)]
pub struct Sheet {
    /// The planets, in the order shown.
    pub cells: Vec<Cell>,
    thumbnails: Option<Thumbnails>,
}

impl Sheet {
    /// Shows these planets instead of others. `start` makes the thread that draws them, if it is not there yet.
    pub fn set(&mut self, planets: Vec<Arc<Planet>>, seen: &Seen, start: impl FnOnce() -> Option<Thumbnails>) {
        self.thumbnails = self.thumbnails.take().or_else(start);
        let none = || Err("There is no graphics device to draw with.".to_owned());
        let has_device = self.thumbnails.is_some();
        let cell = |planet| Cell { planet, picture: (!has_device).then(none) };
        self.cells = planets.into_iter().map(cell).collect();
        if let Some(thumbnails) = &self.thumbnails {
            thumbnails.draw(self.cells.iter().map(|cell| thumbnail(&cell.planet, seen)));
        }
    }

    /// Takes the pictures that are done.
    pub fn poll(&mut self, ctx: &egui::Context) {
        while let Some((number, drawn)) = self.thumbnails.as_ref().and_then(Thumbnails::poll) {
            if let Some(cell) = self.cells.get_mut(number) {
                let options = egui::TextureOptions::LINEAR;
                cell.picture = Some(drawn.map(|image| ctx.load_texture(format!("planet {number}"), image, options)));
            }
        }
    }

    /// How many pictures are still to be drawn.
    pub fn missing(&self) -> usize {
        self.cells.iter().filter(|cell| cell.picture.is_none()).count()
    }
}

fn thumbnail(planet: &Arc<Planet>, seen: &Seen) -> Thumbnail {
    let place = seen.place.unwrap_or_else(|| crate::lod::opening::opening_place(planet));
    let planet = match seen.without_clouds {
        true => Arc::new(Planet { clouds: None, ..(**planet).clone() }),
        false => Arc::clone(planet),
    };
    Thumbnail { planet, like: seen.like.clone(), place, time_secs: seen.time_secs, side_px: SIDE_PX }
}
