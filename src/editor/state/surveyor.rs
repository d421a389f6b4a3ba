//! Figures of a whole planet that are found on another thread, and again when the ground changes.

use crate::planet::Planet;
use crate::terrain::Terrain;
use crate::terrain::revision::Keys;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// A terrain of which a survey was asked: not itself, so that its world maps end with the planet.
pub struct Asked {
    /// Its planet.
    pub planet: Arc<Planet>,
    /// Its content keys.
    pub keys: Keys,
}

/// Surveys terrains on another thread, and keeps the newest result.
pub struct Surveyor<T> {
    terrains: Sender<Arc<Terrain>>,
    answers: Receiver<T>,
    same: fn(&Asked, &Terrain) -> bool,
    asked: Option<Asked>,
    found: Option<T>,
}

impl<T: Send + 'static> Surveyor<T> {
    /// Starts the thread, which calls `wake` after each survey and ends with the surveyor. `same`: whether `survey`
    /// would find the same of two terrains.
    pub fn new(
        survey: fn(&Terrain) -> T,
        same: fn(&Asked, &Terrain) -> bool,
        wake: impl Fn() + Send + 'static,
    ) -> Self {
        let (terrains, asked) = channel::<Arc<Terrain>>();
        let (answered, answers) = channel();
        let spawned = std::thread::Builder::new().name("tellus-survey".to_owned()).spawn(move || {
            while let Ok(terrain) = asked.recv() {
                // Only the newest matters.
                let terrain = asked.try_iter().last().unwrap_or(terrain);
                if answered.send(survey(&terrain)).is_err() {
                    return;
                }
                wake();
            }
        });
        // Without the thread nothing is found, and nothing else breaks.
        debug_assert!(spawned.is_ok());
        Self { terrains, answers, same, asked: None, found: None }
    }

    /// Asks for a survey of a terrain, unless the newest request was for the same, or its world maps are not final yet.
    pub fn ask(&mut self, terrain: &Arc<Terrain>) {
        // With its own final maps, a planet has one terrain.
        let is_same = |asked: &Asked| Arc::ptr_eq(&asked.planet, terrain.planet()) || (self.same)(asked, terrain);
        if terrain.has_final_maps() && !self.asked.as_ref().is_some_and(is_same) {
            // Fails only if the thread could not be started.
            let _ = self.terrains.send(terrain.clone());
            self.asked = Some(Asked { planet: terrain.planet().clone(), keys: terrain.keys().clone() });
        }
        if let Some(found) = self.answers.try_iter().last() {
            self.found = Some(found);
        }
    }

    /// The newest result; it may be of an earlier revision.
    pub fn found(&self) -> Option<&T> {
        self.found.as_ref()
    }
}

/// Whether two terrains have the same heights.
pub fn same_heights(asked: &Asked, terrain: &Terrain) -> bool {
    !terrain.keys().changes_since(&asked.keys).touches_tiles()
}
