//! The open system: its bodies, its file, its undo steps.
//!
//! - this file: the document; [`presets`]: where the presets of its bodies are
//! - [`on_disk`]: saving it; files that other programs change
//! - [`trial`]: the run that shows whether it lasts

pub mod on_disk;
pub mod presets;
pub mod trial;

use super::history::History;
use crate::planet::Planet;
use crate::planet::file::read_text;
use crate::planet::param::ParamPath;
use crate::render::Worlds;
use crate::system::{EARTH_MASS_KG, Light, Member, System, limits, shipped as systems};
pub use on_disk::News;
use on_disk::Watch;
pub use presets::{Origin, Preset};
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::Arc;
use trial::TrialRun;

/// Masses of planets whose radius alone is known: density of the Earth and of Saturn and Jupiter, kg/m³.
const ROCK_KG_M3: f64 = 5514.0;
const GAS_KG_M3: f64 = 1000.0;

/// A system that is open.
pub struct OpenSystem {
    /// Where it comes from.
    pub origin: Origin,
    /// Its bodies, as the newest valid system has them.
    pub worlds: Arc<Worlds>,
    /// What about it does not last.
    pub warnings: Vec<String>,
    /// What is wrong with it.
    pub problems: Vec<(ParamPath, String)>,
    /// Whether it was changed after the planet was: undo then takes its steps.
    pub was_changed_last: bool,
    /// The run that shows whether it lasts.
    pub trial: TrialRun,
    system: Arc<System>,
    history: History<System, ()>,
    /// Whether it is unsaved work that a crash left.
    is_recovered: bool,
    /// What its file holds; None if no file holds it.
    saved: Option<Arc<System>>,
    /// The text of the file when it was last read or written.
    text: Option<String>,
    /// Planets by the presets of the bodies.
    planets: HashMap<String, Arc<Planet>>,
    /// Names of the bodies that random orbits leave alone.
    locked: BTreeSet<String>,
    watch: Option<Watch>,
}

impl OpenSystem {
    /// A shipped system.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn shipped(index: usize) -> Result<Self, String> {
        let shipped = systems::ALL.get(index).ok_or("there is no such system")?;
        let system = shipped.load().map_err(|error| error.to_string())?;
        let planets = shipped.planets(&system);
        Ok(Self::new(Origin::Shipped(index), system, planets))
    }

    /// A system file, with the presets that it names.
    ///
    /// # Errors
    /// What is wrong with the file or with a preset.
    pub fn file(path: PathBuf) -> Result<Self, String> {
        let text = read_text(&path).map_err(|error| error.to_string())?;
        let system = System::from_text(&path.display().to_string(), &text).map_err(|error| error.to_string())?;
        let planets = system.load_planets(&path).map_err(|error| error.to_string())?;
        let mut open = Self::new(Origin::File(path), system, planets);
        open.text = Some(text);
        Ok(open)
    }

    /// A new system: a planet, and a star like the Sun that lights it.
    pub fn around(preset: String, planet: Arc<Planet>) -> Self {
        let star = Member {
            name: "Sun".to_owned(),
            mass_earths: 332_946.0,
            light: Some(Light::default()),
            ..Member::default()
        };
        let mut system = System { name: format!("System of {}", planet.name), bodies: vec![star] };
        let member = member_of(&planet, preset);
        system.add(0, member, &[Light::default().radius_m()], planet.radius_m());
        let mut open = Self::new(Origin::New, system, vec![None, Some(planet)]);
        open.saved = None;
        open
    }

    /// Unsaved work that a crash left, and why planets of it could not be read: their bodies are points.
    pub fn recovered(system: System, file: Option<PathBuf>) -> (Self, Vec<String>) {
        let planets = vec![None; system.bodies.len()];
        let mut open = Self::new(file.map_or(Origin::New, Origin::File), system, planets);
        let mut problems = Vec::new();
        for number in 0..open.system.bodies.len() {
            let read = match open.preset(number) {
                None => continue,
                Some(Preset::File(path)) => Planet::load(&path).map_err(|error| error.to_string()),
                Some(Preset::Shipped(index)) => crate::planet::shipped::ALL[index].load().map_err(|e| e.to_string()),
            };
            let preset = open.system.bodies[number].preset.clone();
            match read {
                Ok(planet) => drop(open.planets.insert(preset, Arc::new(planet))),
                Err(why) => problems.extend(why.lines().map(str::to_owned)),
            }
        }
        (open.saved, open.is_recovered) = (None, true);
        open.show();
        (open, problems)
    }

    fn new(origin: Origin, system: System, planets: Vec<Option<Arc<Planet>>>) -> Self {
        let presets = system.bodies.iter().map(|body| body.preset.clone());
        let known = presets.zip(&planets).filter_map(|(preset, planet)| Some((preset, planet.clone()?))).collect();
        let system = Arc::new(system);
        let mut open = Self {
            origin,
            worlds: Arc::new(Worlds::new((*system).clone(), planets)),
            warnings: Vec::new(),
            problems: Vec::new(),
            was_changed_last: false,
            trial: TrialRun::default(),
            history: History::default(),
            is_recovered: false,
            saved: Some(Arc::clone(&system)),
            text: None,
            planets: known,
            locked: BTreeSet::new(),
            watch: None,
            system,
        };
        open.show();
        open
    }

    /// The system as edited.
    pub fn system(&self) -> &Arc<System> {
        &self.system
    }

    /// The undo steps.
    pub fn history(&self) -> &History<System, ()> {
        &self.history
    }

    /// Whether no file holds what was changed. A system that was just begun is nobody's work.
    pub fn is_dirty(&self) -> bool {
        match &self.saved {
            Some(saved) => *saved != self.system,
            None => self.is_recovered || !self.history.is_empty(),
        }
    }

    /// Whether undo takes a step of the system.
    pub fn takes_undo(&self) -> bool {
        self.was_changed_last && self.history.undo_label().is_some()
    }

    /// Whether redo takes a step of the system.
    pub fn takes_redo(&self) -> bool {
        self.was_changed_last && self.history.redo_label().is_some()
    }

    /// Replaces the system: an undo step, or a part of the step under way of the same name.
    pub fn edit(&mut self, system: System, label: &str) {
        if system == *self.system {
            return;
        }
        self.history.record(&self.system, label);
        self.replace(Arc::new(system));
    }

    /// Ends the gesture under way.
    pub fn settle(&mut self) {
        self.history.settle(&self.system);
    }

    /// Goes one step back.
    pub fn undo(&mut self) {
        if let Some(system) = self.history.undo(&self.system, &mut ()) {
            self.replace(system);
        }
    }

    /// Goes one step forward.
    pub fn redo(&mut self) {
        if let Some(system) = self.history.redo(&self.system, &mut ()) {
            self.replace(system);
        }
    }

    fn replace(&mut self, system: Arc<System>) {
        if let Some(body) = renamed(&self.system, &system)
            && self.locked.remove(&self.system.bodies[body].name)
        {
            self.locked.insert(system.bodies[body].name.clone());
        }
        self.system = system;
        self.was_changed_last = true;
        self.trial = TrialRun::default();
        self.show();
    }

    /// Shows the system if it is valid; the last valid one stays else.
    fn show(&mut self) {
        self.problems = self.system.check().err().unwrap_or_default();
        if !self.problems.is_empty() {
            return;
        }
        let planets = planets_of(&self.system, &self.planets);
        self.worlds = Arc::new(Worlds::new((*self.system).clone(), planets));
        let warnings = limits::warnings(&self.system, &self.worlds.radii_m());
        self.warnings = warnings.into_iter().map(|warning| warning.message).collect();
    }

    /// Adds a planet about a body. `preset`: its file, as the bodies of this system name theirs.
    pub fn add_planet(&mut self, parent: usize, preset: String, planet: Arc<Planet>) {
        let member = member_of(&planet, preset.clone());
        let radius_m = planet.radius_m();
        self.planets.insert(preset, planet);
        self.add(parent, member, radius_m);
    }

    /// Adds a body. The parent may be gone since a file was asked for.
    fn add(&mut self, parent: usize, member: Member, radius_m: f64) {
        if parent >= self.system.bodies.len() {
            return;
        }
        let mut system = (*self.system).clone();
        let number = system.add(parent, member, &self.radii_m(), radius_m);
        let label = format!("Add {}", system.bodies[number].name);
        self.edit(system, &label);
    }

    /// Radius of each body as edited, metres; 0 for points.
    fn radii_m(&self) -> Vec<f64> {
        Worlds::new((*self.system).clone(), planets_of(&self.system, &self.planets)).radii_m()
    }

    /// Adds a small star about a body.
    pub fn add_star(&mut self, parent: usize) {
        let light = Light { radius_km: 400_000.0, kelvin: 4200.0, luminosity_suns: 0.1 };
        let radius_m = light.radius_m();
        let star = Member { name: "Star".to_owned(), mass_earths: 200_000.0, light: Some(light), ..Member::default() };
        self.add(parent, star, radius_m);
    }

    /// Removes a body and what orbits it.
    pub fn remove(&mut self, body: usize) {
        let mut system = (*self.system).clone();
        let Some(label) = system.bodies.get(body).map(|body| format!("Remove {}", body.name)) else { return };
        system.remove(body);
        self.edit(system, &label);
    }

    /// Puts the bodies that are not locked on random orbits.
    pub fn roll(&mut self, seed: u64) {
        let is_locked = |body: usize| self.locked.contains(&self.system.bodies[body].name);
        let rolled = self.system.rolled(seed, &is_locked, &self.radii_m());
        self.edit(rolled, "Random orbits");
        self.settle();
    }

    /// Whether random orbits leave a body alone.
    pub fn is_locked(&self, body: usize) -> bool {
        self.system.bodies.get(body).is_some_and(|body| self.locked.contains(&body.name))
    }

    /// Locks a body, or unlocks it.
    pub fn toggle_lock(&mut self, body: usize) {
        let Some(body) = self.system.bodies.get(body) else { return };
        if !self.locked.remove(&body.name) {
            self.locked.insert(body.name.clone());
        }
    }

    /// The body to begin with: the first planet.
    pub fn first_planet(&self) -> Option<usize> {
        (0..self.system.bodies.len()).find(|body| self.worlds.planet(*body).is_some())
    }
}

/// The planet of each body; None for stars and points.
fn planets_of(system: &System, known: &HashMap<String, Arc<Planet>>) -> Vec<Option<Arc<Planet>>> {
    system.bodies.iter().map(|body| known.get(&body.preset).cloned()).collect()
}

/// A body with a planet's surface, of the mass that its size suggests.
fn member_of(planet: &Planet, preset: String) -> Member {
    let density_kg_m3 = if planet.giant.is_some() { GAS_KG_M3 } else { ROCK_KG_M3 };
    let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * planet.radius_m().powi(3);
    let mass_earths = density_kg_m3 * volume_m3 / EARTH_MASS_KG;
    let mass_earths = format!("{mass_earths:.2e}").parse().unwrap_or(mass_earths);
    Member { name: planet.name.clone(), preset, mass_earths, ..Member::default() }
}

/// The body whose name alone was changed.
fn renamed(before: &System, after: &System) -> Option<usize> {
    let differs = |body: &usize| before.bodies[*body].name != after.bodies[*body].name;
    let mut bodies = (0..before.bodies.len()).filter(differs);
    let is_same_count = before.bodies.len() == after.bodies.len();
    let body = is_same_count.then(|| bodies.next()).flatten()?;
    bodies.next().is_none().then_some(body)
}

/// The number of a body after a change of its system; None if it is gone.
pub fn follow(before: &System, after: &System, body: usize) -> Option<usize> {
    let old = before.bodies.get(body)?;
    let same_place =
        after.bodies.get(body).filter(|new| renamed(before, after) == Some(body) && new.preset == old.preset);
    same_place.map(|_| body).or_else(|| after.find(&old.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_planet_of_a_shipped_system_can_be_opened() {
        for index in 0..systems::ALL.len() {
            let open = OpenSystem::shipped(index).unwrap();
            for (number, body) in open.system().bodies.iter().enumerate() {
                assert_eq!(open.preset(number).is_some(), !body.preset.is_empty(), "{}", body.name);
            }
            assert!(open.first_planet().is_some() && !open.is_dirty());
        }
        assert!(OpenSystem::shipped(99).is_err());
    }

    #[test]
    fn changes_are_steps_and_locks_follow_names() {
        let mut open = OpenSystem::shipped(0).unwrap();
        let begun = open.system().clone();
        let aurel = begun.find("Aurel").unwrap();
        open.toggle_lock(aurel);
        let mut named = (*begun).clone();
        named.rename(aurel, "Home");
        open.edit(named, "Rename Aurel");
        open.settle();
        assert!(open.is_locked(aurel) && open.is_dirty());
        assert_eq!(follow(&begun, open.system(), aurel), Some(aurel));
        open.roll(7);
        assert_eq!(open.system().bodies[aurel], Member { name: "Home".to_owned(), ..begun.bodies[aurel].clone() });
        open.remove(aurel);
        assert_eq!(follow(&begun, open.system(), begun.bodies.len() - 1), Some(begun.bodies.len() - 3));
        assert_eq!(follow(&begun, open.system(), aurel), None);
        let labels: Vec<&str> = open.history().labels().collect();
        assert_eq!(labels, ["Rename Aurel", "Random orbits", "Remove Home"]);
        for _ in 0..3 {
            open.undo();
        }
        assert_eq!(*open.system(), begun);
        assert!(!open.is_dirty());
    }

    #[test]
    fn a_system_that_is_not_valid_is_told_and_the_last_valid_one_stays() {
        let mut open = OpenSystem::shipped(0).unwrap();
        let mut broken = (**open.system()).clone();
        broken.bodies[1].orbit = None;
        open.edit(broken, "Break it");
        assert!(!open.problems.is_empty());
        assert!(open.worlds.ephemeris().orbit(1).is_some());
        let folder = tempfile::tempdir().unwrap();
        assert!(open.save(&folder.path().join("x.ron")).unwrap_err().contains("orbit"));
        // Bodies can be added to it, and others rolled; one that is gone is no parent.
        let count = open.system().bodies.len();
        open.add_star(0);
        open.roll(3);
        open.add_star(99);
        open.remove(99);
        assert_eq!(open.system().bodies.len(), count + 1);
        while open.takes_undo() {
            open.undo();
        }
        assert!(open.problems.is_empty());
    }
}
