//! Loading, checking and saving a system file; see [`crate::planet::file`], which does the same for presets.

use super::{MAX_BODIES, MAX_ECCENTRICITY, Member, Start, System, VERSION};
use crate::planet::file::{LoadError, SaveError, all_placed, read_as, read_text, write_atomically};
use crate::planet::param::{ParamPath, Segment};
use crate::planet::picture::folder_of;
use crate::planet::root::Root;
use crate::planet::sources::Sources;
use crate::planet::{Planet, Version, explain, locate, text};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Radius of the smallest planet that a preset may describe, metres.
const LEAST_RADIUS_M: f64 = 1000.0;

/// The file: the version, then the fields of [`System`].
#[derive(Serialize, Deserialize)]
#[serde(rename = "System", default, deny_unknown_fields)]
pub(crate) struct File {
    version: Version,
    name: String,
    bodies: Vec<Member>,
}

impl Default for File {
    fn default() -> Self {
        System::default().into()
    }
}

impl From<System> for File {
    fn from(system: System) -> Self {
        Self { version: Version(VERSION), name: system.name, bodies: system.bodies }
    }
}

impl Root for System {
    type File = File;
    const VERSION: u32 = VERSION;
    const THING: &'static str = "system";
    const NOUN: &'static str = "system file";

    fn other(text: &str) -> Option<(&'static str, &'static str)> {
        let is_preset = |field: &&&str| locate::find(text, field).is_some();
        let field = PRESET_FIELDS.iter().find(is_preset).filter(|_| !System::is_system(text))?;
        Some((field, "this is a preset of one planet, not a system file; name a file with `bodies`"))
    }
}

/// Fields of presets, at least one of which every preset of a planet has.
const PRESET_FIELDS: [&str; 7] = ["radius_km", "layers", "biomes", "climate", "star", "structure", "giant"];

impl System {
    /// Reads and checks a system file, without the presets that it names.
    ///
    /// # Errors
    /// As [`Planet::load`].
    pub fn load(path: impl AsRef<Path>) -> Result<System, LoadError> {
        let path = path.as_ref();
        System::from_text(&path.display().to_string(), &read_text(path)?)
    }

    /// Reads and checks a system from text; `file` names it in messages.
    ///
    /// # Errors
    /// As [`Planet::from_text`].
    pub fn from_text(file: &str, text: &str) -> Result<System, LoadError> {
        let system = read_as::<System>(file, text, |_, text| {
            explain::parse::<System, File>(text).map(|File { name, bodies, .. }| System { name, bodies })
        })?;
        let problems = system.problems();
        if problems.is_empty() { Ok(system) } else { Err(all_placed(file, text, problems)) }
    }

    /// Whether a text looks like a system file rather than a preset.
    pub fn is_system(text: &str) -> bool {
        locate::find(text, "bodies").is_some()
    }

    /// The text of the system file, with comments. Stable: the text of a loaded text is the text.
    pub fn to_text(&self) -> String {
        text::write(self)
    }

    /// Saves atomically: the old file stays until the new one is complete. A system that could not be loaded again is
    /// refused.
    ///
    /// # Errors
    /// Why it was not saved.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let failed = |message: String| SaveError { path: path.to_owned(), message };
        if let Some((place, message)) = self.problems().into_iter().next() {
            return Err(failed(format!("the system is not valid and was not saved: {place}: {message}")));
        }
        write_atomically(path, self.to_text().as_bytes()).map_err(failed)
    }

    /// The preset of each body, None for stars and points. `file`: the system file, from whose folder the paths start.
    /// Bodies that name one preset share one planet.
    ///
    /// # Errors
    /// What is wrong with the first preset that cannot be loaded, told at the place of the system file that names it.
    pub fn load_planets(&self, file: &Path) -> Result<Vec<Option<std::sync::Arc<Planet>>>, LoadError> {
        let mut loaded: HashMap<PathBuf, std::sync::Arc<Planet>> = HashMap::new();
        let mut planets = Vec::new();
        for (number, body) in self.bodies.iter().enumerate() {
            if body.preset.is_empty() {
                planets.push(None);
                continue;
            }
            let path = folder_of(file).join(&body.preset);
            let planet = match loaded.get(&path) {
                Some(planet) => planet.clone(),
                None => match Planet::load(&path) {
                    Ok(planet) => loaded.entry(path).or_insert(planet.into()).clone(),
                    Err(LoadError::Read { source, .. }) => {
                        let message =
                            format!("{}: {source}; name a preset, from the folder of this file", path.display());
                        let text = read_text(file).unwrap_or_default();
                        let problems = vec![(path_of(number, "preset"), message)];
                        return Err(all_placed(&file.display().to_string(), &text, problems));
                    }
                    Err(other) => return Err(other),
                },
            };
            planets.push(Some(planet));
        }
        Ok(planets)
    }

    /// The files of the system: its own, those of its presets and those that they name. `planets`: those of
    /// [`Self::load_planets`].
    pub fn sources(&self, file: &Path, planets: &[Option<std::sync::Arc<Planet>>]) -> Sources {
        let mut sources = Sources::default();
        sources.add(file, "the system file");
        for (body, planet) in self.bodies.iter().zip(planets) {
            if let Some(planet) = planet {
                sources.extend(Sources::of_preset(&folder_of(file).join(&body.preset), planet));
            }
        }
        sources
    }

    /// Whether the system can be saved and moved.
    ///
    /// # Errors
    /// Everything that is wrong with it: the path, what is wrong and what would be right.
    pub fn check(&self) -> Result<(), Vec<(ParamPath, String)>> {
        let problems = self.problems();
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }

    fn problems(&self) -> Vec<(ParamPath, String)> {
        let mut found = Vec::new();
        let all = || ParamPath::default().join("bodies");
        if self.bodies.len() > MAX_BODIES {
            return vec![(all(), format!("{} bodies are too many; use at most {MAX_BODIES}", self.bodies.len()))];
        }
        if self.bodies.is_empty() {
            return vec![(all(), "there are no bodies; write at least one".to_owned())];
        }
        self.look(&mut |path, param, value| {
            if let Some(message) = value.get().problem(param) {
                found.push((path.clone(), message));
            }
        });
        for number in 0..self.bodies.len() {
            self.problems_of(number, &mut found);
        }
        // Only bodies that have orbits have places.
        if found.is_empty() {
            found = self.problems_of_places(&|_| None);
        }
        found
    }

    /// Whether bodies overlap at time zero, with the sizes of their planets. `file`: the system file; `planets`: as of
    /// [`System::load_planets`].
    ///
    /// # Errors
    /// The bodies that do, at their places in the file.
    pub fn check_places(&self, file: &Path, planets: &[Option<std::sync::Arc<Planet>>]) -> Result<(), LoadError> {
        let radius_m = |body: usize| planets.get(body)?.as_ref().map(|planet| planet.radius_m());
        let problems = self.problems_of_places(&radius_m);
        if problems.is_empty() {
            return Ok(());
        }
        Err(all_placed(&file.display().to_string(), &read_text(file).unwrap_or_default(), problems))
    }

    /// Bodies that are at one place at time zero. `radius_m`: of a planet; None for the least that it can have.
    fn problems_of_places(&self, radius_m: &dyn Fn(usize) -> Option<f64>) -> Vec<(ParamPath, String)> {
        let poses = super::Ephemeris::new(self).at(0.0);
        let size_m = |body: usize| match &self.bodies[body].light {
            Some(light) => light.radius_m(),
            None => radius_m(body).unwrap_or(LEAST_RADIUS_M),
        };
        let real: Vec<usize> = (0..self.bodies.len()).filter(|body| !self.bodies[*body].is_point()).collect();
        let mut found = Vec::new();
        for (count, &body) in real.iter().enumerate() {
            let apart_m = |other: usize| (poses[body].position_m - poses[other].position_m).length();
            // A distance that is no number is none.
            let touches =
                |other: &&usize| apart_m(**other).is_nan() || apart_m(**other) < size_m(body) + size_m(**other);
            let Some(&other) = real[..count].iter().find(touches) else { continue };
            let field = if self.bodies[body].orbit.is_some() { "orbit" } else { "start" };
            let [a, b] = [body, other].map(|body| &self.bodies[body].name);
            let (apart_km, least_km) = (apart_m(other) / 1000.0, (size_m(body) + size_m(other)) / 1000.0);
            let message = if apart_km.is_nan() {
                format!("the places of `{a}` and `{b}` at time zero cannot be computed; use another orbit")
            } else {
                format!(
                    "`{a}` and `{b}` are at one place at time zero: their centres are {apart_km:.3} km apart, and \
                     their sizes ask for {least_km:.0} km; use another orbit or anomaly_deg"
                )
            };
            found.push((path_of(body, field), message));
        }
        found
    }

    fn problems_of(&self, number: usize, found: &mut Vec<(ParamPath, String)>) {
        let body = &self.bodies[number];
        let mut add = |field: &'static str, message: String| found.push((path_of(number, field), message));
        if body.name.is_empty() {
            add("name", "a body needs a name".to_owned());
        }
        if self.find(&body.name).is_some_and(|first| first < number) {
            add("name", format!("there is another body called `{}`; names must differ", body.name));
        }
        if body.light.is_some() && !body.preset.is_empty() {
            add("preset", "a body that shines has no surface; remove the preset or the light".to_owned());
        }
        if body.is_point() && body.mass_earths > 0.0 {
            add("mass_earths", "a point has no mass; name a preset, give it light or use 0".to_owned());
        }
        if body.light.is_some() && body.mass_earths <= 0.0 {
            add("mass_earths", "a star needs a mass; the Sun has 332946".to_owned());
        }
        let parent = match body.parent.as_str() {
            "" => None,
            name => match self.find(name) {
                Some(parent) if parent < number => Some(parent),
                Some(_) => {
                    return add("parent", format!("`{name}` comes later in the list; a body comes after its parent"));
                }
                None => return add("parent", format!("there is no body `{name}`; {}", self.known_before(number))),
            },
        };
        if body.orbit.is_some() && body.start.is_some() {
            return add("start", "the body has an orbit already; remove the start or the orbit".to_owned());
        }
        if let (Some(parent), Some(start)) = (parent, &body.start) {
            let of = &self.bodies[parent];
            let why = match (of.is_point(), body.ellipse(of.gravity_m3_s2()).map(|ellipse| ellipse.eccentricity)) {
                (true, _) => Some(format!("`{}` has no mass to hold the body; write an orbit with a period", of.name)),
                (false, None) => Some(escape(start, of, body)),
                (false, Some(e)) if e > MAX_ECCENTRICITY => {
                    Some(format!("the orbit has an eccentricity of {e:.4}; use at most {MAX_ECCENTRICITY}"))
                }
                _ => None,
            };
            return why.map_or((), |why| add("start", why));
        }
        if parent.is_none() && body.start.is_some() {
            return add("start", "the body at the root is at rest in the origin; name a parent or use None".to_owned());
        }
        match (parent, &body.orbit) {
            (None, Some(_)) => add("orbit", "the body at the root has no orbit; name a parent or use None".to_owned()),
            (None, None) if number > 0 => {
                add(
                    "parent",
                    format!("only the first body is at the root; name a parent; {}", self.known_before(number)),
                );
            }
            (Some(_), None) => add(
                "orbit",
                "the orbit around the parent is missing; write `orbit: (...)` or `start: (...)`".to_owned(),
            ),
            (Some(parent), Some(orbit)) => {
                let mass = self.bodies[parent].mass_earths + body.mass_earths;
                if orbit.period_hours <= 0.0 && (mass <= 0.0 || self.bodies[parent].is_point()) {
                    let mut path = path_of(number, "orbit").segments().to_vec();
                    path.push(Segment::Field("period_hours"));
                    let message = format!("`{}` has no mass to tell the period; write one", body.parent);
                    found.push((ParamPath::from(path), message));
                }
            }
            (None, None) => {}
        }
    }

    fn known_before(&self, number: usize) -> String {
        let names: Vec<String> = self.bodies[..number].iter().map(|body| format!("`{}`", body.name)).collect();
        if names.is_empty() { "the first body has none".to_owned() } else { format!("use {}", names.join(", ")) }
    }
}

/// Why a body does not stay with its parent.
fn escape(start: &Start, parent: &Member, body: &Member) -> String {
    let (distance_m, speed) = (start.position_m().length(), start.velocity().length());
    let gravity = parent.gravity_m3_s2() + body.gravity_m3_s2();
    let least = (2.0 * gravity / distance_m.max(1.0)).sqrt();
    match speed < least {
        true => format!("the body falls straight into `{}`; give it a velocity across the line to it", parent.name),
        false => format!(
            "at {:.3} km/s the body leaves `{}`, which holds less than {:.3} km/s there; use less",
            speed / 1000.0,
            parent.name,
            least / 1000.0
        ),
    }
}

fn path_of(body: usize, field: &'static str) -> ParamPath {
    ParamPath::from(vec![Segment::Field("bodies"), Segment::Index(body), Segment::Field(field)])
}
