//! Variations of the planet: nine at a time, each with a small picture, to take one and go on from there.

use super::thumbnails::Thumbnails;
use crate::film::Thumbnail;
use crate::lod::opening;
use crate::planet::param::Segment;
use crate::planet::{Planet, random};
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use eframe::egui;
use std::sync::Arc;

/// How many variations there are at a time.
pub const COUNT: usize = 9;
/// Side of their pictures, pixels.
const SIDE_PX: u32 = 224;
/// Parts of a planet that clouds hide.
const UNDER_CLOUDS: [&str; 5] = ["layers", "structure", "climate", "biomes", "water"];
/// Cosine of the angle between the eye and the star from which too much of the disc is dark to choose by.
const LEAST_LIT: f64 = 0.25;

/// What varies, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// How far numbers stray from those of the planet, 0 to 1 of their size.
    pub stray: f64,
    /// The part of the planet that varies, empty for the planet's own parameters; None: all.
    pub part: Option<&'static str>,
    /// Which nine of all variations.
    pub seed: u64,
}

impl Wish {
    /// One variation of a planet.
    pub fn of(&self, planet: &Planet, number: usize) -> Planet {
        let seed = self.seed.wrapping_mul(COUNT as u64).wrapping_add(number as u64);
        random::vary_some(planet, seed, self.stray, &|path| match self.part {
            Some(part) => path.part() == part,
            // Another place of the star would only darken the picture.
            None => !matches!(path.segments(), [Segment::Field("star"), Segment::Field("latitude_deg" | "longitude_deg")]),
        })
    }
}

/// A variation.
pub struct Cell {
    /// The planet.
    pub planet: Arc<Planet>,
    /// Its picture, once it is drawn, or why it cannot be drawn.
    pub picture: Option<Result<egui::TextureHandle, String>>,
}

/// The variations on screen.
pub struct Variations {
    /// What varies, and how far.
    pub wish: Wish,
    /// The variations; empty while they are not shown.
    pub cells: Vec<Cell>,
    /// The planet and the wish of these variations.
    of: Option<(Arc<Planet>, Wish)>,
    thumbnails: Option<Thumbnails>,
}

impl Default for Variations {
    fn default() -> Self {
        Self { wish: Wish { stray: 0.25, part: None, seed: 1 }, cells: Vec::new(), of: None, thumbnails: None }
    }
}

/// What the variations are made from.
pub struct Around<'a> {
    /// The planet.
    pub planet: &'a Arc<Planet>,
    /// Its terrain, if it is there.
    pub terrain: Option<Arc<Terrain>>,
    /// Where the eye stands over the planet.
    pub eye: LatLon,
    /// Seconds since time zero.
    pub time_secs: f64,
}

impl Variations {
    /// Makes the variations that are wished for, unless they are there, and takes the pictures that are done. `start`
    /// makes the thread that draws them.
    pub fn update(
        &mut self,
        ctx: &egui::Context,
        around: &Around<'_>,
        start: impl FnOnce() -> Option<Thumbnails>,
    ) {
        let is_same =
            self.of.as_ref().is_some_and(|(planet, wish)| Arc::ptr_eq(planet, around.planet) && *wish == self.wish);
        if !is_same {
            self.make(around.planet);
            self.of = Some((Arc::clone(around.planet), self.wish));
            self.thumbnails = self.thumbnails.take().or_else(start);
            match &self.thumbnails {
                Some(thumbnails) => thumbnails.draw(self.wanted(around)),
                None => {
                    let none = || Some(Err("There is no graphics device to draw with.".to_owned()));
                    self.cells.iter_mut().for_each(|cell| cell.picture = none());
                }
            }
        }
        while let Some((number, drawn)) = self.thumbnails.as_ref().and_then(Thumbnails::poll) {
            if let Some(cell) = self.cells.get_mut(number) {
                let loaded = drawn.map(|image| {
                    ctx.load_texture(format!("variation {number}"), image, egui::TextureOptions::LINEAR)
                });
                cell.picture = Some(loaded);
            }
        }
    }

    fn make(&mut self, planet: &Planet) {
        let cell = |number| Cell { planet: Arc::new(self.wish.of(planet, number)), picture: None };
        self.cells = (0..COUNT).map(cell).collect();
    }

    fn wanted(&self, around: &Around<'_>) -> Vec<Thumbnail> {
        let place = place(around);
        // Clouds would hide what is chosen by.
        let hides_clouds = self.wish.part.is_some_and(|part| UNDER_CLOUDS.contains(&part));
        let seen = |planet: &Arc<Planet>| match hides_clouds {
            true => Arc::new(Planet { clouds: None, ..(**planet).clone() }),
            false => Arc::clone(planet),
        };
        let thumbnail = |cell: &Cell| Thumbnail {
            planet: seen(&cell.planet),
            like: around.terrain.clone(),
            place,
            time_secs: around.time_secs,
            side_px: SIDE_PX,
        };
        self.cells.iter().map(thumbnail).collect()
    }

    /// Forgets the variations: the window is closed.
    pub fn close(&mut self) {
        (self.cells, self.of, self.thumbnails) = (Vec::new(), None, None);
    }

    /// How many pictures are still to be drawn.
    pub fn missing(&self) -> usize {
        self.cells.iter().filter(|cell| cell.picture.is_none()).count()
    }
}

/// The place that the pictures show: below the eye, or where the planet is seen first if the eye is over the night.
fn place(around: &Around<'_>) -> LatLon {
    let star = around.planet.star.place(around.time_secs).direction();
    let is_lit = around.eye.direction().dot(star) >= LEAST_LIT;
    if is_lit { around.eye } else { opening::opening_place(around.planet) }
}
