//! The ground under the pointer. It is found on another thread: a ray cast at a grazing angle can take longer than a
//! frame.

use crate::lod::View;
use crate::planet::PlateByHand;
use crate::sphere::LatLon;
use crate::tiles::Surface;
use eframe::egui;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The ground under the pointer.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct UnderPointer {
    pub location: LatLon,
    pub height_m: f64,
    pub temperature_c: f64,
    pub moisture: f64,
    pub biome: String,
    /// Column and row of the biome table.
    pub cell: [usize; 2],
    /// Index of the biome in the palette.
    pub biome_index: usize,
    /// Angle of the ground against the horizontal.
    pub slope_deg: f64,
    /// Change of the height by each layer, in metres.
    pub layers_m: Vec<f64>,
    /// The plate of the structure, as an entry that leaves it as it was laid out.
    pub plate: Option<PlateByHand>,
}

/// A question: a point of the picture (`x`, `y` from -1 to 1, right and up), the view, and its surface.
#[derive(Clone)]
struct Question {
    number: u64,
    x: f64,
    y: f64,
    view: View,
    surface: Arc<Surface>,
}

impl Question {
    fn same_as(&self, other: &Question) -> bool {
        (self.x, self.y) == (other.x, other.y) && self.view == other.view && Arc::ptr_eq(&self.surface, &other.surface)
    }
}

/// Asks for the ground at a point of the picture, and keeps the newest answer.
pub struct Probe {
    questions: Sender<Question>,
    answers: Receiver<(u64, Option<UnderPointer>)>,
    asked: Option<Question>,
    /// Number of the next question.
    next: u64,
    /// Answers to questions before this number are stale: the pointer has left since.
    first: u64,
    answer: Option<UnderPointer>,
}

impl Probe {
    /// Starts the thread, which calls `wake` after each answer and ends with the probe.
    pub fn new(wake: impl Fn() + Send + 'static) -> Self {
        let (questions, asked) = channel::<Question>();
        let (answered, answers) = channel();
        let spawned = std::thread::Builder::new().name("tellus-pointer".to_owned()).spawn(move || {
            while let Ok(question) = asked.recv() {
                // Only the newest question matters.
                let question = asked.try_iter().last().unwrap_or(question);
                if answered.send((question.number, look(&question))).is_err() {
                    return;
                }
                wake();
            }
        });
        // Without a thread there are no answers, and nothing else breaks.
        debug_assert!(spawned.is_ok());
        Self { questions, answers, asked: None, next: 0, first: 0, answer: None }
    }

    /// Asks for a point of the picture, unless the last question was equal.
    pub fn ask(&mut self, x: f64, y: f64, view: &View, surface: &Arc<Surface>) {
        let question = Question { number: self.next, x, y, view: *view, surface: surface.clone() };
        if !self.asked.as_ref().is_some_and(|asked| asked.same_as(&question)) {
            self.next += 1;
            self.asked = Some(question.clone());
            // Fails only if the thread could not be started.
            let _ = self.questions.send(question);
        }
        let first = self.first;
        if let Some((_, answer)) = self.answers.try_iter().filter(|(number, _)| *number >= first).last() {
            self.answer = answer;
        }
    }

    /// The answer to the last question, once: the ground there, or an inner None where there is only sky.
    pub fn take(&mut self) -> Option<Option<UnderPointer>> {
        let first = self.first;
        let newest = self.answers.try_iter().filter(|(number, _)| *number >= first).last().map(|(_, answer)| answer);
        // The answer may have come already in `ask`.
        newest.or_else(|| self.answer.take().map(Some))
    }

    /// Drops the question and its answer: the pointer is not over the picture.
    pub fn leave(&mut self) {
        (self.asked, self.answer, self.first) = (None, None, self.next);
    }

    /// The newest answer: the ground, if the pointer is over the globe.
    pub fn answer(&self) -> Option<&UnderPointer> {
        self.answer.as_ref()
    }
}

/// A point of the window in view coordinates: -1 to 1, right and up.
pub(super) fn in_view(rect: egui::Rect, pos: egui::Pos2) -> (f64, f64) {
    let (x, y) = ((pos.x - rect.center().x) / (0.5 * rect.width()), (rect.center().y - pos.y) / (0.5 * rect.height()));
    (f64::from(x), f64::from(y))
}

fn look(question: &Question) -> Option<UnderPointer> {
    let Question { view, surface, .. } = question;
    let camera = &view.camera;
    let ray = camera.ray_dir_planet(question.x, question.y, view.aspect());
    let distance_m = surface.terrain.raycast(camera.position_planet_m, ray)?;
    let dir = camera.position_planet_m + ray * distance_m;
    let sample = surface.terrain.sample(dir);
    let palette = &surface.terrain.planet().biomes.palette;
    Some(UnderPointer {
        location: LatLon::from_direction(dir),
        height_m: sample.height_m,
        temperature_c: sample.temperature_c,
        moisture: sample.moisture,
        biome: palette.get(sample.biome).map_or_else(String::new, |biome| biome.name.clone()),
        cell: sample.cell,
        biome_index: sample.biome,
        slope_deg: sample.slope_rad.to_degrees(),
        layers_m: surface.terrain.layers_m(dir),
        plate: surface.terrain.plate_entry(dir),
    })
}
