//! Checks that serde cannot make: ranges, which come from the description of each parameter, and rules that involve
//! several parameters, such as references between names.

use super::edits::{
    self, LEAST_WIDTH, MAX_ALL_COPIES, MAX_ALL_PLACES, MAX_ALL_POINTS, MAX_EDIT_POINTS, MAX_EDITS, MOST_COURSES_RADII,
    MOST_WIDTH,
};
use super::notes::{MAX_BOOKMARKS, MAX_LOCKS};
use super::param::{ParamPath, Params as _, Segment};
use super::printable::number_text;
use super::structure::MAX_PLATES;
use super::{
    EditPoint, GroundEdit, GroundEdits, Layer, MAX_BIOMES, MAX_LAYERS, MAX_MASKS, MAX_POPULATIONS, MAX_SLOPE_DISTANCES,
    Mask, Planet, Steep, Table, Tool, layers, parts,
};
use std::collections::HashSet;

/// A planet that cannot be evaluated: a valid preset never describes it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the planet is not valid: {}", first_of(problems))]
pub struct InvalidPlanet {
    /// All problems: the path, what is wrong and what would be right.
    pub problems: Vec<(ParamPath, String)>,
}

fn first_of(problems: &[(ParamPath, String)]) -> String {
    match problems {
        [] => "the reason is unknown".to_owned(),
        [(path, message)] => format!("{path}: {message}"),
        [(path, message), more @ ..] => format!("{path}: {message} (and {} more)", more.len()),
    }
}

impl Planet {
    /// Whether the planet can be saved and evaluated. A planet from [`Planet::load`] always can.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn check(&self) -> Result<(), InvalidPlanet> {
        let problems = problems(self);
        if problems.is_empty() { Ok(()) } else { Err(InvalidPlanet { problems }) }
    }
}

/// All problems of a planet: the path, what is wrong and what would be right. In the order of the file where a problem
/// has one path.
pub fn problems(planet: &Planet) -> Vec<(ParamPath, String)> {
    let mut found = Found(Vec::new());
    // The problems of the elements of a list that is too long would bury the problem of the list.
    limits(planet, &mut found);
    if !found.0.is_empty() {
        return found.0;
    }
    // Edits may be thousands: each is checked once.
    let bare = Planet { edits: GroundEdits::default(), ..planet.clone() };
    bare.each_value(&mut |path, param, value| {
        if let Some(message) = value.get().problem(param) {
            found.0.push((path.clone(), message));
        }
    });
    names(&planet.layers, &mut found);
    for (index, layer) in planet.layers.iter().enumerate() {
        masks(&planet.layers, index, layer, &mut found);
    }
    slope_distances(&planet.layers, &mut found);
    plates(planet, &mut found);
    found.0.extend(planet.giant_problems());
    for (index, shared) in planet.edits.shared().iter().enumerate().filter(|(_, shared)| !shared.is_valid()) {
        let before = found.0.len();
        shared.edit.each_value(&mut edits::edit_path(index), &mut |path, param, value| {
            if let Some(message) = value.get().problem(param) {
                found.0.push((path.clone(), message));
            }
        });
        points(index, &shared.edit, &mut found);
        if found.0.len() == before {
            shared.note_valid();
        }
    }
    biomes(&planet.biomes, &mut found);
    found.0.extend(planet.life_problems());
    painted_biomes(planet, &mut found);
    found.0.extend(planet.painted_life_problems());
    courses(planet, &mut found);
    found.0
}

struct Found(Vec<(ParamPath, String)>);

impl Found {
    fn add(&mut self, path: ParamPath, message: impl Into<String>) {
        self.0.push((path, message.into()));
    }
}

fn biomes_path(field: &'static str) -> ParamPath {
    ParamPath::from(vec![Segment::Field("biomes"), Segment::Field(field)])
}

fn item(list: &ParamPath, index: usize, field: Option<&'static str>) -> ParamPath {
    let mut segments = list.segments().to_vec();
    segments.push(Segment::Index(index));
    segments.extend(field.map(Segment::Field));
    ParamPath::from(segments)
}

fn limits(planet: &Planet, found: &mut Found) {
    let mut limit = |path: ParamPath, what: &str, count: usize, most: usize| {
        if count > most {
            found.add(path, format!("{count} {what} are too many; use at most {most}"));
        }
    };
    limit(ParamPath::default().join("layers"), "layers", planet.layers.len(), MAX_LAYERS);
    limit(ParamPath::default().join("edits"), "edits", planet.edits.len(), MAX_EDITS);
    let all_points = planet.edits.iter().map(|edit| edit.points.0.len()).sum();
    limit(ParamPath::default().join("edits"), "points of all edits", all_points, MAX_ALL_POINTS);
    let places = planet.edits.place_count();
    limit(ParamPath::default().join("edits"), "points of all edits with copies and images", places, MAX_ALL_PLACES);
    limit(ParamPath::default().join("life"), "populations", planet.life.len(), MAX_POPULATIONS);
    limit(biomes_path("palette"), "biomes", planet.biomes.palette.len(), MAX_BIOMES);
    let notes = |field| ParamPath::from(vec![Segment::Field("editor"), Segment::Field(field)]);
    if let Some(editor) = &planet.editor {
        limit(notes("bookmarks"), "bookmarks", editor.bookmarks.len(), MAX_BOOKMARKS);
        limit(notes("locks"), "locks", editor.locks.len(), MAX_LOCKS);
    }
    let by_hand = planet.structure.as_ref().map_or(0, |structure| structure.plates.by_hand.len());
    limit(by_hand_path(), "plates", by_hand, MAX_PLATES as usize);
    for (index, edit) in planet.edits.iter().enumerate().take(MAX_EDITS) {
        if edit.points.0.len() > MAX_EDIT_POINTS {
            limit(edits::edit_path(index).join("points"), "points", edit.points.0.len(), MAX_EDIT_POINTS);
        }
    }
    for (index, layer) in planet.layers.iter().enumerate().take(MAX_LAYERS) {
        limit(layers::layer_path(index).join("masks"), "masks", layer.masks.len(), MAX_MASKS);
    }
}

fn names(layers: &[Layer], found: &mut Found) {
    let mut seen = HashSet::new();
    for (index, layer) in layers.iter().enumerate() {
        let path = || layers::layer_path(index).join("name");
        if layer.name.trim().is_empty() {
            found.add(path(), "a layer needs a name, so that masks can refer to it; use any text");
        } else if !seen.insert(layer.name.as_str()) {
            found.add(path(), format!("another layer is called {:?} too; use a name of its own", layer.name));
        }
    }
}

fn masks(layers: &[Layer], index: usize, layer: &Layer, found: &mut Found) {
    for (number, mask) in layer.masks.iter().enumerate() {
        let path = |field| item(&layers::layer_path(index).join("masks"), number, Some(field));
        if let Some(name) = mask.layer()
            && let Some(message) = stranger(layers, index, name)
        {
            found.add(path("layer"), message);
        }
        let [from, to] = mask.ends();
        if from.1 == to.1 {
            let message = format!("`{}` equals `{}` ({}); use two different numbers", to.0, from.0, number_text(to.1));
            found.add(path(to.0), message);
        }
    }
}

/// What is wrong with the layer name in a mask, if anything.
fn stranger(layers: &[Layer], own: usize, name: &str) -> Option<String> {
    let others: Vec<&str> =
        layers.iter().enumerate().filter(|(i, _)| *i != own).map(|(_, layer)| layer.name.as_str()).collect();
    if others.contains(&name) {
        return None;
    }
    let wrong = match layers.get(own) {
        Some(own) if own.name == name => "a layer cannot mask itself".to_owned(),
        _ => format!("there is no layer called {name:?}"),
    };
    Some(match others.as_slice() {
        [] => format!("{wrong}; there is no other layer: remove the mask or add a layer"),
        some => format!("{wrong}; use {}", one_of(some)),
    })
}

fn by_hand_path() -> ParamPath {
    ParamPath::from(vec![Segment::Field("structure"), Segment::Field("plates"), Segment::Field("by_hand")])
}

fn plates(planet: &Planet, found: &mut Found) {
    let by_hand = planet.structure.iter().flat_map(|structure| &structure.plates.by_hand);
    let mut seen = HashSet::new();
    for (index, plate) in by_hand.enumerate() {
        if !seen.insert(plate.plate) {
            let message = format!("another entry changes plate {} too; use one entry for each plate", plate.plate);
            found.add(item(&by_hand_path(), index, Some("plate")), message);
        }
    }
}

/// Greatest height of a point of an edit, either way.
const MOST_POINT_M: f64 = 100_000.0;
/// Least cosine of the angle between neighbouring points of a line: 120 degrees.
const LEAST_COSINE: f64 = -0.5;

fn points(index: usize, edit: &GroundEdit, found: &mut Found) {
    let list = || edits::edit_path(index).join("points");
    let points = &edit.points.0;
    if points.is_empty() {
        found.add(list(), "an edit needs a point; use `[(latitude, longitude)]`, or remove the edit");
    }
    for (number, point) in points.iter().enumerate() {
        for (value, least, most, what, unit) in [
            (point.latitude_deg, -90.0, 90.0, "latitude", "°"),
            (point.longitude_deg, -180.0, 180.0, "longitude", "°"),
            (point.height_m, -MOST_POINT_M, MOST_POINT_M, "height", " m"),
            (point.width, LEAST_WIDTH, MOST_WIDTH, "width", ""),
            (point.strength, 0.0, 1.0, "strength", ""),
        ] {
            if !(least..=most).contains(&value) {
                let value = number_text(value);
                let message = format!("the {what} {value} is out of range; use {least} to {most}{unit}");
                found.add(item(&list(), number, None), message);
                return;
            }
        }
    }
    if edit.tool.is_stamp() {
        let around = points.len() * edit.image_count();
        let all = around * edit.copies as usize;
        if all > MAX_ALL_COPIES {
            let most = MAX_ALL_COPIES / around.max(1);
            let message = format!("{all} copies around {around} points are too many; use at most {most}");
            found.add(edits::edit_path(index).join("copies"), message);
        }
        return;
    }
    let most = edit.most_points();
    if points.len() > most && points.len() <= MAX_EDIT_POINTS {
        let (images, count) = (edit.image_count(), points.len());
        let message =
            format!("{images} images of {count} points are too many; use fewer images, or at most {most} points");
        found.add(edits::edit_path(index).join("turns"), message);
    }
    let is_far = |[a, b]: [&EditPoint; 2]| a.direction().dot(b.direction()) < LEAST_COSINE;
    let turned_deg = |a: f64, b: f64| (a - b).abs();
    let far = |pair: &[EditPoint]| {
        let (a, b) = (&pair[0], &pair[1]);
        // Most are near, and need no sine to tell.
        let deg = turned_deg(a.latitude_deg, b.latitude_deg) + turned_deg(a.longitude_deg, b.longitude_deg);
        deg > 100.0 && is_far([a, b])
    };
    if let Some(number) = points.windows(2).position(far) {
        let message = "this point is more than 120° from the one before it; add points between them";
        found.add(item(&list(), number + 1, None), message);
    }
}

/// Each grid of rivers walks along all courses.
fn courses(planet: &Planet, found: &mut Found) {
    let rivers = planet.edits.iter().filter(|edit| matches!(edit.tool, Tool::River(_)));
    let length = |edit: &GroundEdit| -> f64 {
        edit.points.0.windows(2).map(|pair| pair[0].direction().angle_between(pair[1].direction())).sum()
    };
    let radii: f64 = rivers.map(|edit| length(edit) * edit.image_count() as f64).sum();
    if radii > MOST_COURSES_RADII {
        let message = format!(
            "the courses of its rivers are {radii:.0} radii of the planet long in all; use at most {MOST_COURSES_RADII}"
        );
        found.add(ParamPath::default().join("edits"), message);
    }
}

/// Each distance over which a slope is measured costs a gradient of every earlier layer.
fn slope_distances(layers: &[Layer], found: &mut Found) {
    let mut seen: Vec<f64> = Vec::new();
    for (index, layer) in layers.iter().enumerate() {
        for (number, mask) in layer.masks.iter().enumerate() {
            let Mask::Slope(slope) = mask else { continue };
            if seen.contains(&slope.over_m) {
                continue;
            }
            if seen.len() == MAX_SLOPE_DISTANCES {
                let path = item(&layers::layer_path(index).join("masks"), number, Some("over_m"));
                let known: Vec<String> = seen.iter().map(f64::to_string).collect();
                let message = format!(
                    "{} is one distance too many for this planet's slope masks; use one of the others: {} m",
                    slope.over_m,
                    known.join(", ")
                );
                found.add(path, message);
                return;
            }
            seen.push(slope.over_m);
        }
    }
}

/// `"a"`, `"a" or "b"`, `"a", "b" or "c"`; a long list is cut.
pub(super) fn one_of(names: &[&str]) -> String {
    const MOST: usize = 12;
    let shown: Vec<String> = names.iter().take(MOST).map(|name| format!("{name:?}")).collect();
    match shown.as_slice() {
        [most @ .., last] if !most.is_empty() && names.len() <= MOST => format!("{} or {last}", most.join(", ")),
        _ if names.len() > MOST => format!("{}, ...", shown.join(", ")),
        _ => shown.join(", "),
    }
}

fn biomes(biomes: &parts::Biomes, found: &mut Found) {
    let mut ordered = |low: f64, high: f64, low_name: &str, high_name: &'static str, strict: bool| {
        // Non-finite numbers are already reported.
        if low > high || (strict && low == high) {
            let right = if strict { "more than" } else { "at least" };
            let (low, high) = (number_text(low), number_text(high));
            found.add(biomes_path(high_name), format!("{high} is out of order; use {right} `{low_name}` ({low})"));
        }
    };
    ordered(biomes.coldest_c, biomes.hottest_c, "coldest_c", "hottest_c", true);
    ordered(biomes.lowest_m, biomes.highest_m, "lowest_m", "highest_m", true);
    ordered(biomes.cliff_start_deg, biomes.cliff_full_deg, "cliff_start_deg", "cliff_full_deg", false);

    if biomes.palette.is_empty() {
        found.add(biomes_path("palette"), "the palette is empty; give it at least one biome");
    }
    let mut keys = HashSet::new();
    for (index, biome) in biomes.palette.iter().enumerate() {
        if !keys.insert(biome.key) {
            let message = format!("another biome has the key {:?} too; use a key of its own", biome.key);
            found.add(item(&biomes_path("palette"), index, Some("key")), message);
        }
    }
    references(biomes, &keys, found);
    table(biomes, &keys, found);
}

/// Paint must name biomes.
fn painted_biomes(planet: &Planet, found: &mut Found) {
    for (index, edit) in planet.edits.iter().enumerate() {
        if let Tool::Biome(paint) = &edit.tool
            && planet.biomes.index_of(paint.biome).is_none()
        {
            let known: String = planet.biomes.palette.iter().map(|biome| biome.key).take(MAX_BIOMES).collect();
            let path = edits::edit_path(index).join("tool").join("biome");
            found.add(path, format!("{:?} is no key of the palette; use one of `{known}`", paint.biome));
        }
    }
}

/// Rules that are on must name biomes. The key of a rule that is off does not matter; loading resets it
/// ([`parts::Biomes::forget_idle_keys`]).
fn references(biomes: &parts::Biomes, keys: &HashSet<char>, found: &mut Found) {
    let known: String = biomes.palette.iter().map(|biome| biome.key).take(MAX_BIOMES).collect();
    let refer = |found: &mut Found, path: ParamPath, key: char, is_on: bool| {
        if is_on && !keys.contains(&key) {
            found.add(path, format!("{key:?} is no key of the palette; use one of `{known}`"));
        }
    };
    refer(found, biomes_path("beach_key"), biomes.beach_key, biomes.beach_m > 0.0);
    refer(found, biomes_path("snow_key"), biomes.snow_key, biomes.snow);
    for (index, biome) in biomes.palette.iter().enumerate() {
        let path = |field| item(&biomes_path("palette"), index, Some(field));
        let is_on = biome.steep == Steep::Biome;
        refer(found, path("steep_key"), biome.steep_key, is_on);
        if is_on && biome.steep_from_deg > biome.steep_to_deg {
            let message = format!(
                "{} is out of order; use at least `steep_from_deg` ({})",
                biome.steep_to_deg, biome.steep_from_deg
            );
            found.add(path("steep_to_deg"), message);
        }
    }
}

fn table(biomes: &parts::Biomes, keys: &HashSet<char>, found: &mut Found) {
    let (rows, columns) = (biomes.table.rows(), biomes.table.columns());
    let sides = Table::MIN_SIDE..=Table::MAX_SIDE;
    let range = format!("use {} to {}", Table::MIN_SIDE, Table::MAX_SIDE);
    if !sides.contains(&rows.len()) {
        found.add(biomes_path("table"), format!("the table has {} rows; {range}", rows.len()));
        return;
    }
    if !sides.contains(&columns) {
        let path = item(&biomes_path("table"), 0, None);
        found.add(path, format!("the table has {columns} columns; {range}"));
        return;
    }
    let known: String = biomes.palette.iter().map(|biome| biome.key).take(MAX_BIOMES).collect();
    for (index, row) in rows.iter().enumerate() {
        let path = || item(&biomes_path("table"), index, None);
        let length = row.chars().count();
        if length != columns {
            let message = format!("this row has {length} letters, the first has {columns}; make all equally long");
            found.add(path(), message);
        }
        let mut strangers: Vec<char> = row.chars().filter(|key| !keys.contains(key)).take(length).collect();
        strangers.sort_unstable();
        strangers.dedup();
        if let Some(stranger) = strangers.first() {
            found.add(path(), format!("{stranger:?} is no key of the palette; use one of `{known}`"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::biome::UNSET_KEY;
    use super::*;
    use crate::planet::{Biome, LayerMask};

    fn layer(name: &str, masked_by: &[&str]) -> Layer {
        let mask = |layer: &&str| Mask::Layer(LayerMask { layer: (*layer).to_owned(), ..LayerMask::default() });
        let masks = masked_by.iter().map(mask).collect();
        Layer { name: name.to_owned(), masks, ..Layer::default() }
    }

    fn found(planet: &Planet) -> Vec<String> {
        problems(planet).into_iter().map(|(path, message)| format!("{path}: {message}")).collect()
    }

    #[test]
    fn the_default_planet_is_valid() {
        assert_eq!(found(&Planet::default()), Vec::<String>::new());
    }

    #[test]
    fn masks_refer_to_other_layers_on_or_off() {
        let mut planet = Planet { layers: vec![layer("A", &["B"]), layer("B", &[])], ..Planet::default() };
        planet.layers[1].enabled = false;
        assert_eq!(found(&planet), Vec::<String>::new());
        planet.layers[0].masks[0].set_layer("A");
        assert_eq!(found(&planet), ["layers[0].masks[0].layer: a layer cannot mask itself; use \"B\""]);
        planet.layers[0].masks[0].set_layer("C");
        assert_eq!(found(&planet), ["layers[0].masks[0].layer: there is no layer called \"C\"; use \"B\""]);
    }

    #[test]
    fn a_list_that_is_too_long_is_one_problem() {
        let planet = Planet { layers: vec![layer("", &[]); 65], ..Planet::default() };
        assert_eq!(found(&planet), ["layers: 65 layers are too many; use at most 64"]);
    }

    #[test]
    fn rules_name_biomes_of_the_palette() {
        let mut planet = Planet::default();
        planet.biomes.palette[0] = Biome { key: 'g', ..Biome::default() };
        planet.biomes.table.replace_key('a', 'g');
        assert_eq!(found(&planet), Vec::<String>::new(), "rules that are off hold what they began with");
        (planet.biomes.beach_key, planet.biomes.beach_m) = ('q', 2.0);
        planet.biomes.snow = true;
        (planet.biomes.palette[0].steep_key, planet.biomes.palette[0].steep) = ('z', Steep::Biome);
        assert_eq!(
            found(&planet),
            [
                "biomes.beach_key: 'q' is no key of the palette; use one of `g`",
                "biomes.snow_key: 'a' is no key of the palette; use one of `g`",
                "biomes.palette[0].steep_key: 'z' is no key of the palette; use one of `g`",
            ]
        );
        planet.biomes.beach_m = 0.0;
        planet.biomes.forget_idle_keys();
        assert_eq!((planet.biomes.snow_key, planet.biomes.beach_key), ('a', UNSET_KEY));
        planet.biomes.name_missing(false);
        assert_eq!((planet.biomes.snow_key, planet.biomes.beach_key), ('g', UNSET_KEY));
        planet.biomes.name_missing(true);
        assert_eq!(found(&planet), Vec::<String>::new());
    }

    #[test]
    fn every_problem_is_found_at_once() {
        let mut planet = Planet { radius_km: f64::NAN, ..Planet::default() };
        planet.biomes.hottest_c = -40.0;
        planet.biomes.cliff_full_deg = 10.0;
        planet.biomes.palette.push(Biome::default());
        planet.biomes.table.set_key(3, 2, 'z');
        assert_eq!(
            found(&planet),
            [
                "radius_km: NaN is not a finite number; use 1 to 100000 km",
                "biomes.hottest_c: -40 is out of order; use more than `coldest_c` (-30)",
                "biomes.cliff_full_deg: 10 is out of order; use at least `cliff_start_deg` (28)",
                "biomes.palette[1].key: another biome has the key 'a' too; use a key of its own",
                "biomes.table[2]: 'z' is no key of the palette; use one of `aa`",
            ]
        );
    }
}
