//! Locks: parameters and parts that variations and random planets leave as they are.
//!
//! A lock is kept in the preset as the path of a parameter or a part ([`super::notes::Lock`]). Such a path names a
//! layer by its name and a biome by its key, so that the lock follows them when their lists change:
//! `layers["Hills"].amplitude_m`, `biomes.palette["f"].color`, `clouds`.

use super::notes::{EditorNotes, Lock, MAX_LOCKS};
use super::param::{ParamPath, Segment, Value};
use super::{Planet, validate};
use std::collections::{BTreeSet, HashMap};
use std::mem::discriminant;

/// The locks of a planet.
#[derive(Clone, Debug, Default)]
pub struct Locks {
    layers: Vec<String>,
    biomes: Vec<char>,
    locked: BTreeSet<String>,
}

impl Locks {
    /// The locks of a planet as it is now.
    pub fn of(planet: &Planet) -> Self {
        let locks = planet.editor.iter().flat_map(|notes| &notes.locks);
        let locked: BTreeSet<String> = locks.map(|lock| lock.path.clone()).collect();
        if locked.is_empty() {
            return Self::default();
        }
        Self { locked, ..Self::naming(planet) }
    }

    /// No locks, but the names of the layers and the keys of the biomes.
    fn naming(planet: &Planet) -> Self {
        let layers = planet.layers.iter().map(|layer| layer.name.clone()).collect();
        Self { layers, biomes: planet.biomes.palette.iter().map(|biome| biome.key).collect(), locked: BTreeSet::new() }
    }

    /// How many locks there are.
    pub fn len(&self) -> usize {
        self.locked.len()
    }

    /// Whether there are no locks.
    pub fn is_empty(&self) -> bool {
        self.locked.is_empty()
    }

    /// Whether the lock is on this parameter or part itself.
    pub fn is_on(&self, path: &ParamPath) -> bool {
        !self.is_empty() && self.locked.contains(&self.text(path))
    }

    /// Whether this parameter or part is locked, by itself or by what holds it.
    pub fn hold(&self, path: &ParamPath) -> bool {
        if self.is_empty() {
            return false;
        }
        let segments = path.segments();
        (1..=segments.len()).any(|count| self.locked.contains(&self.text(&segments[..count].to_vec().into())))
    }

    /// A path as locks write it.
    fn text(&self, path: &ParamPath) -> String {
        let segments = path.segments();
        let mut text = String::new();
        for (depth, segment) in segments.iter().enumerate() {
            match (&segments[..depth], segment) {
                ([], Segment::Field(name)) => text += name,
                (_, Segment::Field(name)) => text += &format!(".{name}"),
                ([Segment::Field("layers")], Segment::Index(index)) if *index < self.layers.len() => {
                    text += &format!("[{:?}]", self.layers[*index]);
                }
                ([Segment::Field("biomes"), Segment::Field("palette")], Segment::Index(index))
                    if *index < self.biomes.len() =>
                {
                    text += &format!("[\"{}\"]", self.biomes[*index]);
                }
                (_, Segment::Index(index)) => text += &format!("[{index}]"),
            }
        }
        text
    }
}

/// Puts a lock on a parameter or a part, or takes it off. Gives whether there is one now.
pub fn toggle(planet: &mut Planet, path: &ParamPath) -> bool {
    let text = Locks::naming(planet).text(path);
    let locks = &mut planet.editor.get_or_insert_default().locks;
    let count = locks.len();
    locks.retain(|lock| lock.path != text);
    let adds = locks.len() == count && count < MAX_LOCKS;
    if adds {
        locks.push(Lock { path: text });
    }
    drop_empty_notes(planet);
    adds
}

/// Takes all locks off.
pub fn clear(planet: &mut Planet) {
    if let Some(notes) = &mut planet.editor {
        notes.locks.clear();
    }
    drop_empty_notes(planet);
}

/// Writes the new name of a layer into its locks.
pub fn rename_layer(planet: &mut Planet, old: &str, new: &str) {
    let [old, new] = [old, new].map(|name| format!("layers[{name:?}]"));
    for lock in planet.editor.iter_mut().flat_map(|notes| &mut notes.locks) {
        if let Some(rest) = lock.path.strip_prefix(&old) {
            lock.path = format!("{new}{rest}");
        }
    }
}

/// A preset without notes does not mention them.
fn drop_empty_notes(planet: &mut Planet) {
    planet.editor = planet.editor.take().filter(|notes| *notes != EditorNotes::default());
}

/// Gives a planet what is locked in another one: parts, layers and values, and the locks themselves. None if the two do
/// not fit together.
pub fn keep(from: &Planet, to: &Planet) -> Option<Planet> {
    let locks = Locks::of(from);
    if locks.is_empty() {
        return Some(to.clone());
    }
    let mut kept = to.clone();
    keep_parts(from, &locks, &mut kept);
    keep_layers(from, &locks, &mut kept);
    keep_values(from, &locks, &mut kept);
    // Edits of populations that are gone go last: values are found by the index of their edit.
    kept.edits.drop_strangers(&kept.life);
    let notes = kept.editor.get_or_insert_default();
    notes.locks = from.editor.as_ref().map(|notes| notes.locks.clone()).unwrap_or_default();
    validate::problems(&kept).is_empty().then_some(kept)
}

fn keep_parts(from: &Planet, locks: &Locks, to: &mut Planet) {
    for part in Planet::PARTS {
        if locks.is_on(&ParamPath::default().join(part.name)) {
            to.take_part(from, part.name);
        }
    }
}

/// Locked layers stay in their place. Their masks on layers that are gone go as well.
fn keep_layers(from: &Planet, locks: &Locks, to: &mut Planet) {
    for (index, layer) in from.layers.iter().enumerate() {
        if !locks.is_on(&super::layers::layer_path(index)) {
            continue;
        }
        let mut layer = layer.clone();
        let there = to.layers.iter().position(|other| other.name == layer.name);
        let others: Vec<&str> = to.layers.iter().map(|other| other.name.as_str()).collect();
        layer.masks.retain(|mask| mask.layer().is_none_or(|name| others.contains(&name)));
        match there {
            Some(at) => to.layers[at] = layer,
            None => to.layers.insert(index.min(to.layers.len()), layer),
        }
    }
}

fn keep_values(from: &Planet, locks: &Locks, to: &mut Planet) {
    let mut values: HashMap<(String, &'static str), Value> = HashMap::new();
    from.each_value(&mut |path, param, value| {
        if locks.hold(path) {
            values.insert((locks.text(path), param.name), value.get());
        }
    });
    let names = Locks::naming(to);
    to.each(&mut |path, param, mut value| {
        // Two landforms may have parameters of one name and of different types.
        let kept = values.get(&(names.text(path), param.name));
        if let Some(kept) = kept.filter(|kept| discriminant(*kept) == discriminant(&value.get())) {
            value.set(kept);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::edits::{EditPoint, LifePaint};
    use crate::planet::{Clouds, GroundEdit, Layer, Population, Tool, random};

    fn path(part: &'static str, field: &'static str) -> ParamPath {
        ParamPath::default().join(part).join(field)
    }

    fn planet() -> Planet {
        let layer = |name: &str| Layer { name: name.to_owned(), ..Layer::default() };
        Planet { layers: vec![layer("Hills"), layer("Dunes of mine")], ..random::random(3) }
    }

    #[test]
    fn a_lock_holds_what_is_below_it() {
        let mut planet = planet();
        let (clouds, cover) = (ParamPath::default().join("clouds"), path("clouds", "coverage"));
        assert!(toggle(&mut planet, &clouds));
        let locks = Locks::of(&planet);
        assert!(locks.is_on(&clouds) && locks.hold(&clouds) && locks.hold(&cover));
        assert!(!locks.is_on(&cover) && !locks.hold(&path("star", "tilt_deg")));
        assert!(!toggle(&mut planet, &clouds));
        assert_eq!(planet.editor, None, "no empty notes stay behind");
    }

    #[test]
    fn locked_edits_stay_without_those_of_populations_that_are_gone() {
        let stroke = |population: &str| {
            let paint = LifePaint { population: population.to_owned(), ..LifePaint::default() };
            GroundEdit {
                tool: Tool::Life(paint),
                points: [EditPoint::default()].into_iter().collect(),
                ..GroundEdit::default()
            }
        };
        let named = |name: &str| Population { name: name.to_owned(), ..Population::default() };
        let (mut from, mut to) = (planet(), planet());
        (from.life, to.life) = (vec![named("Oak"), named("Fern")], vec![named("Fern")]);
        from.edits = ["Oak", "Fern", ""].map(stroke).into_iter().collect();
        toggle(&mut from, &ParamPath::default().join("edits"));
        let kept = keep(&from, &to).unwrap();
        let names: Vec<_> = kept.edits.iter().map(GroundEdit::painted_population).collect();
        assert_eq!(names, [Some("Fern"), None]);
    }

    #[test]
    fn a_lock_follows_its_layer() {
        let mut planet = planet();
        let amplitude = |index| super::super::layers::layer_path(index).join("amplitude_m");
        toggle(&mut planet, &amplitude(0));
        planet.layers.swap(0, 1);
        let locks = Locks::of(&planet);
        assert!(locks.hold(&amplitude(1)) && !locks.hold(&amplitude(0)));
        planet.layers[1].name = "Downs \"old\"".to_owned();
        rename_layer(&mut planet, "Hills", "Downs \"old\"");
        assert!(Locks::of(&planet).hold(&amplitude(1)));
        let read = Planet::from_text("f.ron", &planet.to_text()).unwrap();
        assert!(Locks::of(&read).hold(&amplitude(1)), "locks are saved");
    }

    #[test]
    fn what_is_locked_is_kept() {
        let mut from = planet();
        from.clouds = Some(Clouds { coverage: 0.77, ..Clouds::default() });
        from.radius_km = 4321.0;
        from.layers[1].amplitude_m = 77.0;
        for path in [
            ParamPath::default().join("clouds"),
            ParamPath::default().join("radius_km"),
            super::super::layers::layer_path(1),
        ] {
            toggle(&mut from, &path);
        }
        let other = Planet { clouds: None, ..random::random(8) };
        let kept = keep(&from, &other).unwrap();
        assert_eq!((&kept.clouds, kept.radius_km), (&from.clouds, 4321.0));
        assert_eq!(kept.layers.len(), other.layers.len() + 1);
        assert!(kept.layers.contains(&from.layers[1]));
        assert_eq!(kept.climate, other.climate);
        assert_eq!(Locks::of(&kept).len(), 3);
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let mut from = planet();
        from.biomes.coldest_c = 500.0;
        from.biomes.hottest_c = 600.0;
        toggle(&mut from, &path("biomes", "coldest_c"));
        assert_eq!(keep(&from, &random::random(8)), None, "colder than 500 °C is warmer than the hottest");
    }
}
