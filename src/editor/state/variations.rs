//! Variations of the planet: nine at a time, each with a small picture, to take one and go on from there.

use super::sheet::{Seen, Sheet};
use super::thumbnails::Thumbnails;
use crate::lod::opening;
use crate::planet::param::Segment;
use crate::planet::{Planet, random};
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use eframe::egui;
use std::sync::Arc;

/// How many variations there are at a time.
pub const COUNT: usize = 9;
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
            None => {
                !matches!(path.segments(), [Segment::Field("star"), Segment::Field("latitude_deg" | "longitude_deg")])
            }
        })
    }
}

/// The variations on screen.
pub struct Variations {
    /// What varies, and how far.
    pub wish: Wish,
    /// The variations; empty while they are not shown.
    pub sheet: Sheet,
    /// The planet and the wish of these variations.
    of: Option<(Arc<Planet>, Wish)>,
}

impl Default for Variations {
    fn default() -> Self {
        Self { wish: Wish { stray: 0.25, part: None, seed: 1 }, sheet: Sheet::default(), of: None }
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
    pub fn update(&mut self, ctx: &egui::Context, around: &Around<'_>, start: impl FnOnce() -> Option<Thumbnails>) {
        let is_same =
            self.of.as_ref().is_some_and(|(planet, wish)| Arc::ptr_eq(planet, around.planet) && *wish == self.wish);
        if !is_same {
            let planets = (0..COUNT).map(|number| Arc::new(self.wish.of(around.planet, number)));
            let seen = Seen {
                place: Some(place(around)),
                time_secs: around.time_secs,
                without_clouds: self.wish.part.is_some_and(|part| UNDER_CLOUDS.contains(&part)),
                like: around.terrain.clone(),
            };
            self.sheet.set(planets.collect(), &seen, start);
            self.of = Some((Arc::clone(around.planet), self.wish));
        }
        self.sheet.poll(ctx);
    }

    /// Forgets the variations: the window is closed.
    pub fn close(&mut self) {
        (self.sheet, self.of) = (Sheet::default(), None);
    }
}

/// The place that the pictures show: below the eye, or where the planet is seen first if the eye is over the night.
fn place(around: &Around<'_>) -> LatLon {
    let star = around.planet.star.place(around.time_secs).direction();
    let is_lit = around.eye.direction().dot(star) >= LEAST_LIT;
    if is_lit { around.eye } else { opening::opening_place(around.planet) }
}
