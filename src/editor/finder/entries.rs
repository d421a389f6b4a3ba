//! Everything that can be found by name: commands, shipped planets, recent files, bookmarks, and every parameter of
//! the planet with a row in a panel. [`list`] makes the list, [`search`] puts what fits a text in order.

use super::fuzzy::{Text, folded};
use super::place::Place;
use crate::editor::command::{Action, BookmarkAction, Command, PanelAction};
use crate::editor::commands::{self, COMMANDS};
use crate::editor::files::file_names::readable_stem;
use crate::editor::panels::layers::NEED_STRUCTURE;
use crate::editor::panels::{PANELS, Panel};
use crate::editor::state::State;
use crate::editor::state::describe::lower_first;
use crate::editor::widgets::keys_text;
use crate::editor::widgets::number::{format_number, suffix};
use crate::editor::widgets::typed::Allowed;
use crate::planet::param::{Domain, Param, ParamPath, Segment, Value, ValueRef};
use crate::planet::{Planet, shipped};
use eframe::egui;
use std::path::Path;

/// Points that a word in the name has over a word in the place.
const IN_NAME: i32 = 12;
/// Points that commands, planets and bookmarks have over parameters. They are few and would be lost among parameters.
const NO_PARAMETER: i32 = 4;
/// Points of a word of the description.
const IN_DESCRIPTION: i32 = 14;
/// Points of an entry that was used lately.
const USED: i32 = 5;
/// Shortest word that is looked for in descriptions: shorter ones are in too many.
const LEAST_DESCRIBED: usize = 3;
/// Most entries that give a parameter a number.
const MOST_SETTINGS: usize = 5;
/// Most characters of a value.
const VALUE_CHARS: usize = 20;

/// Something that can be found.
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Where it is: "Terrain › Mountains".
    pub place: String,
    /// The shortcut of a command, the value of a parameter.
    pub hint: String,
    /// Whether it can be chosen now.
    pub enabled: bool,
    /// What happens when it is chosen.
    pub action: Action,
    /// Of a number: the parameter and the number.
    number: Option<(&'static Param, f64)>,
    /// What it does, in lower case.
    description: String,
    name_text: Text,
    place_text: Text,
}

/// An entry that fits a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Index of the entry.
    pub entry: usize,
    /// Indices of the letters of its name that were typed.
    pub letters: Vec<usize>,
}

impl Entry {
    fn new(name: &str, place: &str, description: &str, action: Action) -> Self {
        Self {
            name: name.to_owned(),
            place: place.to_owned(),
            hint: String::new(),
            enabled: true,
            action,
            number: None,
            description: description.to_lowercase(),
            name_text: Text::new(name),
            place_text: Text::new(place),
        }
    }

    /// The flight to a location that was typed.
    pub fn of_place(place: Place) -> Self {
        Self::new(&format!("Go to {place}"), "Camera", "", Action::GoToPlace(place))
    }

    /// The change of a parameter to a number that was typed behind its name. None unless it is a number that the
    /// parameter may have.
    fn to_number(&self, text: &str) -> Option<Self> {
        let (param, now) = self.number?;
        let Action::Panel(PanelAction::Reveal { path, .. }) = &self.action else { return None };
        let allowed = match param.domain {
            Domain::Number { min, max, .. } => Allowed::numbers(param.unit, min, max),
            Domain::Count { min, max } => Allowed::whole(min, max),
            _ => return None,
        };
        let number = allowed.read(text, Some(now)).ok()?;
        let name = format!("Set {} to {}{}", lower_first(&self.name), format_number(number), suffix(param.unit));
        let action = Action::SetNumber(path.clone(), number);
        Some(Self { hint: self.hint.clone(), ..Self::new(&name, &self.place, "", action) })
    }

    /// A name that is the same at every start: that of undo does not tell the step.
    pub fn key(&self) -> String {
        match &self.action {
            Action::Command(command) => commands::row(*command).map_or_else(String::new, |row| row.label.to_owned()),
            _ => self.accessible_name(),
        }
    }

    /// The name for screen readers and tests.
    pub fn accessible_name(&self) -> String {
        format!("{} › {}", self.place, self.name)
    }

    /// Points and letters for the words of a text; None unless each word fits.
    fn fit(&self, words: &[Vec<char>]) -> Option<(i32, Vec<usize>)> {
        let (mut points, mut letters) = (0, Vec::new());
        for word in words {
            let in_name = self.name_text.fit(word).map(|fit| (fit.points + IN_NAME, fit.letters));
            let in_place = self.place_text.fit(word).map(|fit| (fit.points, Vec::new()));
            let text: String = word.iter().collect();
            let is_described = word.len() >= LEAST_DESCRIBED && self.description.contains(&text);
            let described = is_described.then(|| (IN_DESCRIPTION, Vec::new()));
            // Of equal points the last would be taken: the name is.
            let ways = described.into_iter().chain(in_place).chain(in_name);
            let (more, marked) = ways.max_by_key(|(points, _)| *points)?;
            points += more;
            letters.extend(marked);
        }
        Some((points, letters))
    }
}

/// Everything that can be found now.
pub fn list(state: &State, ctx: &egui::Context) -> Vec<Entry> {
    let mut entries = commands_now(state, ctx);
    entries.extend(shipped::ALL.iter().enumerate().map(|(index, preset)| {
        let name = readable_stem(Path::new(preset.file));
        Entry::new(&name, "Planets", "open shipped planet", Action::OpenShipped(index))
    }));
    entries.extend(state.recent.paths().iter().map(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let folder = path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy().into_owned();
        Entry { hint: folder, ..Entry::new(&name, "Recent files", "open file", Action::OpenPath(path.clone())) }
    }));
    entries.extend(state.document.bookmarks().iter().enumerate().map(|(index, bookmark)| {
        let action = Action::Bookmark(BookmarkAction::GoTo(index));
        let shortcut = commands::row(Command::GoTo(index)).and_then(|row| row.shortcuts.first());
        let hint = shortcut.map_or_else(String::new, |shortcut| keys_text(ctx, shortcut));
        Entry { hint, ..Entry::new(&bookmark.name, "Bookmarks", "fly to view", action) }
    }));
    entries.extend(parameters(state.document.planet()));
    entries
}

/// The commands, but for the finder itself, and for those that fly to bookmarks: the bookmarks stand for them.
fn commands_now(state: &State, ctx: &egui::Context) -> Vec<Entry> {
    let rows = COMMANDS.iter().filter(|row| !matches!(row.command, Command::Finder | Command::GoTo(_)));
    rows.map(|row| {
        let menu = row.menu.map_or("Commands", |(menu, _)| menu.label());
        let hint = row.shortcuts.first().map_or_else(String::new, |shortcut| keys_text(ctx, shortcut));
        let entry = Entry::new(&row.label_now(state), menu, row.tooltip, Action::Command(row.command));
        Entry { hint, enabled: row.is_enabled(state), ..entry }
    })
    .collect()
}

/// The parameters that have a row in a panel.
pub fn parameters(planet: &Planet) -> Vec<Entry> {
    let mut entries = Vec::new();
    planet.each_value(&mut |path, param, value| {
        let hidden = planet.structure.is_none() && NEED_STRUCTURE.contains(&param.name);
        let Some(place) = place_of(planet, path).filter(|_| !hidden) else { return };
        let action = Action::Panel(PanelAction::Reveal { path: path.clone(), name: param.name });
        let part = Planet::PARTS.iter().find(|part| path.segments().first() == Some(&Segment::Field(part.name)));
        let description = format!("{} {path} {}", param.doc, part.map_or("", |part| part.doc));
        let hint = value_text(param, &value);
        let number = match value {
            ValueRef::Number(number) => Some((param, number)),
            ValueRef::Count(count) => Some((param, f64::from(count))),
            _ => None,
        };
        entries.push(Entry { hint, number, ..Entry::new(param.label, &place, &description, action) });
    });
    entries
}

/// Where a parameter is: its panel, then its layer, biome, mask, plate or section. None if no panel shows it.
fn place_of(planet: &Planet, path: &ParamPath) -> Option<String> {
    let mut place = vec![PANELS.get(Panel::of(path)?)?.label.to_owned()];
    match path.segments() {
        [Segment::Field("layers"), Segment::Index(index), rest @ ..] => {
            place.push(planet.layers.get(*index)?.name.clone());
            if let [Segment::Field("masks"), Segment::Index(mask), ..] = rest {
                place.push(format!("Mask {}", mask + 1));
            }
        }
        // Of thousands of edits, each has one entry.
        [Segment::Field("edits"), Segment::Index(index), Segment::Field("name")] => {
            place.push(planet.edits.get(*index)?.name.clone());
        }
        [Segment::Field("edits"), ..] => return None,
        [Segment::Field("biomes"), Segment::Field("palette"), Segment::Index(index), ..] => {
            place.push(planet.biomes.palette.get(*index)?.name.clone());
        }
        [Segment::Field("structure"), Segment::Field(section), rest @ ..] if !rest.is_empty() => {
            let mut letters = section.chars();
            place.extend(letters.next().map(|first| first.to_uppercase().chain(letters).collect()));
            if let [Segment::Field("by_hand"), Segment::Index(index), ..] = rest {
                let entry = planet.structure.as_ref()?.plates.by_hand.get(*index)?;
                place.push(format!("Plate {}", entry.plate));
            }
        }
        _ => {}
    }
    Some(place.join(" › "))
}

/// A short value in words; empty for colours and curves.
fn value_text(param: &Param, value: &ValueRef<'_>) -> String {
    let text = match value.get() {
        Value::Number(number) => format!("{}{}", format_number(number), suffix(param.unit)),
        Value::Count(count) => format!("{count}{}", suffix(param.unit)),
        Value::Flag(flag) => if flag { "on" } else { "off" }.to_owned(),
        Value::Text(text) => text,
        Value::Letter(letter) => letter.to_string(),
        Value::Choice(index) => value.labels().get(index).copied().unwrap_or_default().to_owned(),
        Value::Triple(_) | Value::Curve(_) => String::new(),
    };
    if text.chars().count() <= VALUE_CHARS {
        return text;
    }
    text.chars().take(VALUE_CHARS - 1).chain(['…']).collect()
}

/// The entries that fit a text, best first. Without a text: those that were used lately, then all. `used`: their keys.
pub fn search(entries: &[Entry], text: &str, used: &[String]) -> Vec<Found> {
    let words: Vec<Vec<char>> = text.split_whitespace().map(|word| word.chars().map(folded).collect()).collect();
    let since = |entry: &Entry| {
        // Nobody asks for the key where nothing was used.
        let key = (!used.is_empty()).then(|| entry.key())?;
        used.iter().position(|used| *used == key)
    };
    let all = entries.iter().enumerate();
    if words.is_empty() {
        let mut order: Vec<(usize, usize)> =
            all.map(|(index, entry)| (since(entry).unwrap_or(usize::MAX), index)).collect();
        order.sort_unstable();
        return order.into_iter().map(|(_, entry)| Found { entry, letters: Vec::new() }).collect();
    }
    let mut fits: Vec<(i32, Found)> = all
        .filter_map(|(index, entry)| {
            let (mut points, letters) = entry.fit(&words)?;
            let is_parameter = matches!(entry.action, Action::Panel(PanelAction::Reveal { .. }));
            points += if is_parameter { 0 } else { NO_PARAMETER };
            points += if since(entry).is_some() { USED } else { 0 };
            Some((points, Found { entry: index, letters }))
        })
        .collect();
    // The sort is stable: equal fits stay in the order of the list.
    fits.sort_by_key(|(points, _)| -points);
    fits.into_iter().map(|(_, found)| found).collect()
}

/// Entries that give parameters a number, for a text of a name and a number: "sea level 400 m". Best first.
pub fn settings(entries: &[Entry], text: &str) -> Vec<Entry> {
    let begins = |word: &str| word.starts_with(|c: char| c.is_ascii_digit() || "+-−*/.(".contains(c));
    let number = text.match_indices(' ').map(|(at, _)| at + 1).find(|at| begins(&text[*at..]));
    let Some((name, number)) = number.map(|at| text.split_at(at)).filter(|(name, _)| !name.trim().is_empty()) else {
        return Vec::new();
    };
    let found = search(entries, name, &[]);
    found.iter().filter_map(|found| entries.get(found.entry)?.to_number(number)).take(MOST_SETTINGS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Structure;
    use std::time::{Duration, Instant};

    fn names(entries: &[Entry], text: &str, used: &[String]) -> Vec<String> {
        search(entries, text, used).iter().map(|found| entries[found.entry].accessible_name()).collect()
    }

    #[test]
    fn parameters_are_found_by_name_and_place() {
        let planet = shipped::layered();
        let entries = parameters(&planet);
        let layer = &planet.layers[1].name;
        let first = names(&entries, &format!("ampl {layer}"), &[]).remove(0);
        assert_eq!(first, format!("Terrain › {layer} › Amplitude"));
        assert_eq!(names(&entries, &format!("{layer} ampl"), &[])[0], first, "in any order");
        assert_eq!(names(&entries, "axial", &[])[0], "Star › Axial tilt");
        assert_eq!(names(&entries, "radius", &[])[0], "Planet › Radius");
        assert!(names(&entries, "sea level", &[]).contains(&"Water › Sea level".to_owned()), "by its description");
        let seas = names(&entries, "sea col", &[]);
        assert_eq!(seas[0], "Water › Deep colour", "what belongs to the sea comes before strewn letters: {seas:?}");
        assert!(names(&entries, "xyzzy", &[]).is_empty());
    }

    #[test]
    fn a_number_behind_a_name_is_offered() {
        let planet = shipped::layered();
        let entries = parameters(&planet);
        let first = |text: &str| settings(&entries, text).into_iter().next().map(|entry| entry.accessible_name());
        assert_eq!(first("radius 3000").as_deref(), Some("Planet › Set radius to 3000 km"));
        let doubled = format!("Planet › Set radius to {} km", format_number(2.0 * planet.radius_km));
        assert_eq!(first("radius *2"), Some(doubled));
        assert_eq!(first("sea level -0.4 km").as_deref(), Some("Water › Set sea level to -400 m"));
        for none in ["radius", "3000", " 3000", "radius 5 parsecs", "xyzzy 3"] {
            assert!(first(none).is_none(), "{none}");
        }
    }

    #[test]
    fn a_value_is_told() {
        let entries = parameters(&Planet { radius_km: 1234.5, ..Planet::default() });
        let radius = entries.iter().find(|entry| entry.name == "Radius").unwrap();
        assert_eq!(radius.hint, "1234.5 km");
    }

    #[test]
    fn the_last_used_comes_first() {
        let entries = parameters(&Planet::default());
        let used = [entries[5].key(), entries[3].key()];
        let order: Vec<usize> = search(&entries, "", &used).iter().map(|found| found.entry).take(4).collect();
        assert_eq!(order, [5, 3, 0, 1]);
    }

    #[test]
    fn what_has_no_effect_and_no_row_is_not_found() {
        let mut planet = shipped::layered();
        assert!(names(&parameters(&planet), "folding", &[]).is_empty());
        planet.structure = Some(Structure::default());
        assert_eq!(names(&parameters(&planet), "folding", &[]).len(), planet.layers.len());
        assert!(
            names(&parameters(&planet), "belts plates", &[])
                .contains(&"Structure › Plates › Old belt height".to_owned())
        );
    }

    /// The finder answers within a frame, with the parameters of the planet that opens first.
    #[test]
    #[ignore = "long: reports times"]
    fn the_answer_takes_less_than_a_frame() {
        const FRAME: Duration = Duration::from_millis(16);
        let planet = shipped::default_planet();
        let least = |run: &dyn Fn()| {
            let once = |_| {
                let begun = Instant::now();
                run();
                begun.elapsed()
            };
            (0..5).map(once).min().unwrap()
        };
        let listed = least(&|| drop(parameters(&planet)));
        let entries = parameters(&planet);
        let longest =
            ["a", "s", "mountain amplitude", "e e e"].map(|text| least(&|| drop(search(&entries, text, &[]))));
        let longest = longest.into_iter().max().unwrap();
        println!("{} parameters listed in {listed:?}, searched in at most {longest:?}", entries.len());
        assert!(listed < FRAME && longest < FRAME, "{listed:?}, {longest:?}");
    }
}
