//! What is known of a place on the ground: the one under the pointer, or one of a direction. It is found on another
//! thread: a ray cast at a grazing angle can take longer than a frame.

use crate::clouds::{CloudCover, CloudField};
use crate::lod::View;
use crate::planet::PlateByHand;
use crate::sphere::LatLon;
use crate::terrain::{Sample, Terrain};
use crate::tiles::Surface;
use eframe::egui;
use glam::DVec3;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Weak};

/// What is known of a place on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownPlace {
    /// Latitude and longitude.
    pub location: LatLon,
    /// The evaluator's answer there.
    pub sample: Sample,
    /// The name of its biome.
    pub biome: String,
    /// Change of the height by each layer, in metres.
    pub layers_m: Vec<f64>,
    /// The plate of the structure, as an entry that leaves it as it was laid out.
    pub plate: Option<PlateByHand>,
    /// The clouds over it, if they were asked for.
    pub cover: Option<CloudCover>,
}

/// Where the ground is looked at.
#[derive(Clone, PartialEq)]
pub enum Aim {
    /// A point of the picture.
    Picture {
        /// From -1 at the left to 1 at the right.
        x: f64,
        /// From -1 at the bottom to 1 at the top.
        y: f64,
        /// The picture.
        view: View,
    },
    /// A unit direction in the planet frame.
    Place(DVec3),
}

/// A question about a surface.
struct Question {
    number: u64,
    aim: Aim,
    surface: Arc<Surface>,
    /// The time of the clouds that are asked for.
    clouds_at_secs: Option<f64>,
}

/// The last question. It outlives the planet that it is about, and keeps nothing of it.
struct Asked {
    aim: Aim,
    surface: Weak<Surface>,
    clouds_at_secs: Option<f64>,
}

impl Asked {
    fn is(&self, question: &Question) -> bool {
        self.aim == question.aim
            && self.clouds_at_secs == question.clouds_at_secs
            && std::ptr::eq(self.surface.as_ptr(), Arc::as_ptr(&question.surface))
    }
}

/// Asks for the ground at a place, and keeps the newest answer.
pub struct Probe {
    questions: Sender<Question>,
    answers: Receiver<(u64, Option<KnownPlace>)>,
    asked: Option<Asked>,
    /// Number of the next question.
    next: u64,
    /// Answers to questions before this number are stale: the pointer has left since.
    first: u64,
    answer: Option<KnownPlace>,
}

impl Probe {
    /// Starts the thread, which calls `wake` after each answer and ends with the probe.
    pub fn new(wake: impl Fn() + Send + 'static) -> Self {
        let (questions, asked) = channel::<Question>();
        let (answered, answers) = channel();
        let spawned = std::thread::Builder::new().name("tellus-pointer".to_owned()).spawn(move || {
            let mut clouds = Clouds::default();
            while let Ok(question) = asked.recv() {
                // Only the newest question matters.
                let question = asked.try_iter().last().unwrap_or(question);
                if answered.send((question.number, look(&question, &mut clouds))).is_err() {
                    return;
                }
                wake();
            }
        });
        // Without a thread there are no answers, and nothing else breaks.
        debug_assert!(spawned.is_ok());
        Self { questions, answers, asked: None, next: 0, first: 0, answer: None }
    }

    /// Asks for a place, and for the clouds over it at a time, unless the last question was equal.
    pub fn ask(&mut self, aim: Aim, surface: &Arc<Surface>, clouds_at_secs: Option<f64>) {
        let question = Question { number: self.next, aim, surface: surface.clone(), clouds_at_secs };
        if !self.asked.as_ref().is_some_and(|asked| asked.is(&question)) {
            self.next += 1;
            self.asked = Some(Asked { aim: question.aim.clone(), surface: Arc::downgrade(surface), clouds_at_secs });
            // Fails only if the thread could not be started.
            let _ = self.questions.send(question);
        }
        let first = self.first;
        if let Some((_, answer)) = self.answers.try_iter().filter(|(number, _)| *number >= first).last() {
            self.answer = answer;
        }
    }

    /// The answer to the last question, once: the ground there, or an inner None where there is only sky.
    pub fn take(&mut self) -> Option<Option<KnownPlace>> {
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
    pub fn answer(&self) -> Option<&KnownPlace> {
        self.answer.as_ref()
    }
}

/// A point of the window in view coordinates: -1 to 1, right and up.
pub(super) fn in_view(rect: egui::Rect, pos: egui::Pos2) -> (f64, f64) {
    let (x, y) = ((pos.x - rect.center().x) / (0.5 * rect.width()), (rect.center().y - pos.y) / (0.5 * rect.height()));
    (f64::from(x), f64::from(y))
}

/// The clouds of the newest terrain.
#[derive(Default)]
struct Clouds(Option<(Weak<Terrain>, CloudField)>);

impl Clouds {
    fn over(&mut self, terrain: &Arc<Terrain>, dir_planet: DVec3, time_secs: f64) -> Option<CloudCover> {
        terrain.planet().clouds.as_ref()?;
        let known = self.0.take().filter(|(of, _)| of.as_ptr() == Arc::as_ptr(terrain));
        let (_, field) = self.0.insert(known.unwrap_or_else(|| (Arc::downgrade(terrain), CloudField::new(terrain))));
        Some(field.cover(dir_planet, time_secs))
    }
}

fn look(question: &Question, clouds: &mut Clouds) -> Option<KnownPlace> {
    let terrain = &question.surface.terrain;
    let dir = match &question.aim {
        Aim::Place(dir) => *dir,
        Aim::Picture { x, y, view } => {
            let camera = &view.camera;
            let ray = camera.ray_dir_planet(*x, *y, view.aspect());
            let distance_m = terrain.raycast(camera.position_planet_m, ray)?;
            (camera.position_planet_m + ray * distance_m).normalize_or(DVec3::Z)
        }
    };
    let sample = terrain.sample(dir);
    let palette = &terrain.planet().biomes.palette;
    Some(KnownPlace {
        location: LatLon::from_direction(dir),
        biome: palette.get(sample.biome).map_or_else(String::new, |biome| biome.name.clone()),
        layers_m: terrain.layers_m(dir),
        plate: terrain.plate_entry(dir),
        cover: question.clouds_at_secs.and_then(|secs| clouds.over(terrain, dir, secs)),
        sample,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Quality, opening};
    use crate::planet::Planet;
    use crate::tiles::build_now;
    use std::time::{Duration, Instant};

    /// Neither a click that was answered nor an inspected place keeps the tiles of a planet that is closed.
    #[test]
    fn an_answered_question_keeps_no_surface() {
        let planet = Arc::new(Planet::default());
        let view = opening::opening_view(&planet, [64, 64], Quality::Low);
        let surface = Arc::new(build_now(&planet, &view).unwrap());
        let mut probe = Probe::new(|| {});
        let begun = Instant::now();
        let wait = || {
            assert!(begun.elapsed() < Duration::from_secs(60), "it never came");
            std::thread::sleep(Duration::from_millis(1));
        };
        while probe.answer().is_none() {
            probe.ask(Aim::Place(DVec3::X), &surface, None);
            wait();
        }
        assert_eq!(probe.next, 1, "it was asked more than once");
        let left = Arc::downgrade(&surface);
        drop(surface);
        while left.upgrade().is_some() {
            wait();
        }
    }
}
