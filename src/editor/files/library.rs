//! The library: planets and parts that the user keeps, as preset files in a folder of the editor.
//!
//! A part is a preset that holds nothing but, say, clouds. What is removed moves to a folder beside, so that nothing is
//! lost by a click. The user's tags are in a text file: a line for each preset, its name and the tags between tabs.

use crate::planet::file::{read_text, write_atomically};
use crate::planet::open::read_whole_text;
use crate::planet::picture::folder_of;
use crate::planet::{Planet, snippet};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Most files that are listed.
const MOST: usize = 300;
/// The file of the tags.
const TAGS: &str = "tags.txt";
const MOST_TAG_BYTES: u64 = 1 << 20;
/// Most letters of a name and of a tag.
const MOST_LETTERS: usize = 64;
/// The folder of what was removed.
const REMOVED: &str = "removed";
/// Parts that can be kept, with their names. Empty: a whole planet.
pub const PARTS: [(&str, &str); 11] = [
    ("", "planet"),
    ("layers", "terrain"),
    ("structure", "structure"),
    ("climate", "climate"),
    ("biomes", "biomes"),
    ("water", "water"),
    ("atmosphere", "atmosphere"),
    ("clouds", "clouds"),
    ("giant", "gas giant"),
    ("rings", "rings"),
    ("star", "star"),
];

/// What a file of the library holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// The file.
    pub path: PathBuf,
    /// The name of the file without its ending.
    pub name: String,
    /// The part that it holds; empty: a whole planet.
    pub part: &'static str,
    /// The user's tags.
    pub tags: Vec<String>,
    /// The planet of the file without its pictures, or what is wrong with it. Of a part, all else is at its defaults.
    pub planet: Result<Planet, String>,
}

/// The folder of the library.
#[derive(Clone, Debug)]
pub struct Library {
    folder: PathBuf,
}

impl Library {
    /// The library in a folder, which need not be there yet.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// What is in it, by name.
    pub fn list(&self) -> Vec<Kept> {
        let Ok(read) = fs::read_dir(&self.folder) else { return Vec::new() };
        let is_preset = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|ending| ending == "ron");
        let mut paths: Vec<PathBuf> = read.filter_map(|entry| Some(entry.ok()?.path())).filter(is_preset).collect();
        paths.sort_by_cached_key(|path| path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()));
        paths.truncate(MOST);
        let tags = self.tags();
        paths.into_iter().map(|path| kept(path, &tags)).collect()
    }

    /// Gives a file of the library another name and tags. Gives the file, which has a number after the name if that is
    /// taken.
    ///
    /// # Errors
    /// The file or the tags cannot be written. Without the tags, the file has its new name.
    pub fn label(&self, path: &Path, name: &str, tags: &[String]) -> Result<PathBuf, String> {
        let told = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let (before, name) = (stem(path), file_stem(name));
        let to = if name.is_empty() || name == before { path.to_owned() } else { free(&self.folder, &name) };
        if to != path {
            fs::rename(path, &to).map_err(|error| told(&error))?;
        }
        let mut all = self.tags();
        all.remove(&before);
        if !tags.is_empty() {
            all.insert(stem(&to), tags.to_vec());
        }
        let line = |(name, tags): (&String, &Vec<String>)| format!("{name}\t{}\n", tags.join("\t"));
        let text: String = all.iter().map(line).collect();
        write_atomically(&self.folder.join(TAGS), text.as_bytes()).map_err(|error| told(&error))?;
        Ok(to)
    }

    /// The user's tags, by the name of the file without its ending.
    fn tags(&self) -> BTreeMap<String, Vec<String>> {
        let text = read_whole_text(&self.folder.join(TAGS), MOST_TAG_BYTES).unwrap_or_default();
        let line = |line: &str| {
            let mut words = line.split('\t').map(str::to_owned);
            Some((words.next()?, words.collect()))
        };
        text.lines().filter_map(line).collect()
    }

    /// Keeps a part of a planet under a name that is free. Gives the file.
    ///
    /// # Errors
    /// The planet does not have the part, or the file cannot be written.
    pub fn keep(&self, planet: &Planet, part: &str) -> Result<PathBuf, String> {
        // Paths of pictures are relative to the folder of their preset.
        let moved = planet.moved_to(&self.folder);
        let text = snippet::of_part(&moved, part).ok_or_else(|| format!("{} has no {part}", planet.name))?;
        let told = |error: &dyn std::fmt::Display| format!("{}: {error}", self.folder.display());
        fs::create_dir_all(&self.folder).map_err(|error| told(&error))?;
        let label = PARTS.iter().find(|(other, _)| *other == part).map_or(part, |(_, label)| label);
        let stem = match (file_stem(&planet.name).as_str(), part) {
            ("", _) => label.to_owned(),
            (stem, "") => stem.to_owned(),
            (stem, _) => format!("{stem} {label}"),
        };
        let path = free(&self.folder, &stem);
        write_atomically(&path, text.as_bytes()).map_err(|error| told(&error))?;
        Ok(path)
    }

    /// Moves a file of the library out of it. Gives its new place.
    ///
    /// # Errors
    /// The file cannot be moved.
    pub fn remove(&self, path: &Path) -> Result<PathBuf, String> {
        let folder = self.folder.join(REMOVED);
        let stem = stem(path);
        let moved = fs::create_dir_all(&folder).and_then(|()| {
            let to = free(&folder, &stem);
            fs::rename(path, &to).map(|()| to)
        });
        moved.map_err(|error| format!("{}: {error}", path.display()))
    }
}

/// A path in the folder with this name, or with the first number after it that is free.
fn free(folder: &Path, stem: &str) -> PathBuf {
    let numbered = |number: u32| match number {
        1 => folder.join(format!("{stem}.ron")),
        number => folder.join(format!("{stem} {number}.ron")),
    };
    (1..).map(numbered).find(|path| !path.exists()).unwrap_or_else(|| folder.join(stem))
}

/// The name of a file without its ending.
fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// A name as that of a file: it never leaves the folder.
fn file_stem(name: &str) -> String {
    let letters = name.trim().chars().take(MOST_LETTERS);
    letters.map(|c| if c.is_alphanumeric() || c == ' ' { c } else { '-' }).collect::<String>().trim().to_owned()
}

/// The tags in a text, between commas.
pub fn read_tags(text: &str) -> Vec<String> {
    let tidy = |tag: &str| tag.split_whitespace().collect::<Vec<_>>().join("-").to_lowercase();
    let tags = text.split(',').map(tidy).filter(|tag| !tag.is_empty());
    tags.map(|tag| tag.chars().take(MOST_LETTERS).collect()).collect()
}

fn kept(path: PathBuf, tags: &BTreeMap<String, Vec<String>>) -> Kept {
    let name = stem(&path);
    let tags = tags.get(&name).cloned().unwrap_or_default();
    let read = read_text(&path).map_err(|error| error.to_string());
    let (part, planet) = match read.and_then(|text| snippet::read(&path.display().to_string(), &text)) {
        Ok(read) => {
            let part = PARTS.iter().map(|(part, _)| *part).find(|part| read.has(part)).unwrap_or_default();
            let mut planet = read.planet().clone();
            planet.set_folder(&folder_of(&path));
            (part, Ok(planet))
        }
        Err(why) => ("", Err(why)),
    };
    Kept { path, name, part, tags, planet }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{HeightMap, Layer, Shape, shipped};

    #[test]
    fn what_is_kept_is_listed_and_what_is_removed_is_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::new(folder.path().join("library"));
        assert!(library.list().is_empty());
        let planet = shipped::default_planet();
        let first = library.keep(&planet, "clouds").unwrap();
        let second = library.keep(&planet, "clouds").unwrap();
        assert_ne!(first, second, "nothing is replaced");
        library.keep(&planet, "").unwrap();
        let listed = library.list();
        let parts: Vec<_> = listed.iter().map(|kept| kept.part).collect();
        assert_eq!(parts, ["", "clouds", "clouds"]);
        assert_eq!(listed[1].planet.as_ref().unwrap().clouds, planet.clouds);
        let moved = library.remove(&first).unwrap();
        assert!(moved.exists() && library.list().len() == 2);
    }

    #[test]
    fn a_new_name_keeps_the_tags_and_replaces_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::new(folder.path().join("library"));
        let planet = shipped::default_planet();
        let first = library.keep(&planet, "clouds").unwrap();
        let second = library.keep(&planet, "clouds").unwrap();
        let tags = read_tags("  Sky , two words,, sky2");
        assert_eq!(tags, ["sky", "two-words", "sky2"]);
        let first = library.label(&first, "Towers", &tags).unwrap();
        assert_eq!(stem(&first), "Towers");
        let third = library.label(&second, "Towers", &[]).unwrap();
        assert_eq!(stem(&third), "Towers 2");
        let outside = library.label(&third, "../../etc", &[]).unwrap();
        assert_eq!(outside.parent(), first.parent(), "a name never leaves the folder");
        let tagged =
            |library: &Library| library.list().into_iter().map(|kept| (kept.name, kept.tags)).collect::<Vec<_>>();
        assert!(tagged(&library).contains(&("Towers".to_owned(), tags.clone())));
        let first = library.label(&first, "", &tags).unwrap();
        assert_eq!(stem(&first), "Towers", "without a name the old one stays");
        library.label(&first, "Heaps", &tags[..1]).unwrap();
        assert!(tagged(&library).contains(&("Heaps".to_owned(), vec!["sky".to_owned()])));
        assert!(tagged(&library).iter().all(|(name, _)| name != "Towers"));
    }

    #[test]
    fn a_height_map_is_found_from_the_library_too() {
        let folder = tempfile::tempdir().unwrap();
        let base = std::fs::canonicalize(folder.path()).unwrap();
        fs::create_dir(base.join("mine")).unwrap();
        fs::write(base.join("mine/map.png"), "").unwrap();
        let map = HeightMap { file: "map.png".to_owned().into(), ..HeightMap::default() };
        let layer = Layer { shape: Shape::HeightMap(map), ..Layer::default() };
        let mut planet = Planet { layers: vec![layer], ..Planet::default() };
        planet.set_folder(&base.join("mine"));
        let library = Library::new(base.join("library"));
        for part in ["", "layers"] {
            library.keep(&planet, part).unwrap();
        }
        for kept in library.list() {
            let kept = kept.planet.unwrap();
            let (_, file, _) = kept.pictures().next().unwrap();
            assert_eq!(fs::canonicalize(file.location().unwrap()).unwrap(), base.join("mine/map.png"));
        }
    }

    #[test]
    fn a_planet_without_the_part_and_a_broken_file_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::new(folder.path().to_owned());
        let bare = Planet { name: "Bare".to_owned(), ..Planet::default() };
        assert!(library.keep(&bare, "water").unwrap_err().contains("Bare has no water"));
        fs::write(folder.path().join("broken.ron"), "(version: 3, radius_km: \"x\")").unwrap();
        assert!(library.list()[0].planet.is_err());
        let named = Planet { name: "../a/b".to_owned(), ..Planet::default() };
        let path = library.keep(&named, "").unwrap();
        assert_eq!(path.parent(), Some(folder.path()), "a name never leaves the folder");
    }
}
