//! What the library window shows: shipped planets, files that were open, and what the user keeps.

use super::job::Job;
use super::sheet::Sheet;
use crate::editor::files::library::{Kept, Library};
use crate::editor::state::templates;
use crate::planet::{Planet, shipped};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where an item comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The shipped preset of this index.
    Shipped(usize),
    /// A file that was open.
    File(PathBuf),
    /// A file of the library.
    Library(PathBuf),
}

/// A planet or a part to choose.
pub struct Item {
    /// Where it comes from.
    pub origin: Origin,
    /// Its name.
    pub name: String,
    /// The part that it holds; empty: a whole planet.
    pub part: &'static str,
    /// Words that find it: what it is and what it has.
    pub tags: Vec<&'static str>,
    /// Words of the user that find it.
    pub own_tags: Vec<String>,
    /// The planet without its pictures, or what is wrong with the file.
    pub planet: Result<Arc<Planet>, String>,
}

/// The items, with their pictures.
#[derive(Default)]
pub struct Shelf {
    /// The folder of what the user keeps; None: nowhere.
    pub library: Option<Library>,
    /// The items, in the order shown.
    pub items: Vec<Item>,
    /// Their pictures, in the same order.
    pub sheet: Sheet,
    /// The number of the document that parts are shown on; None: the files are to be read again.
    read_for: Option<u64>,
    reading: Option<Job<Vec<Item>>>,
}

impl Shelf {
    /// Reads the files again when the items are asked for next.
    pub fn forget(&mut self) {
        self.read_for = None;
    }

    /// Reads the items on another thread, unless they are there. `recent`: files that were open. `here`: the open
    /// planet, which parts are shown on, and the number of its document. Gives whether there are other items now.
    pub fn update(
        &mut self,
        recent: &[PathBuf],
        (here, document_number): (&Arc<Planet>, u64),
        wake: impl Fn() + Send + Sync + 'static,
    ) -> bool {
        if self.read_for != Some(document_number) {
            self.read_for = Some(document_number);
            let (library, recent, here) = (self.library.clone(), recent.to_vec(), Arc::clone(here));
            self.reading = Some(Job::start(move |_| read(library.as_ref(), &recent, &here), wake));
        }
        let Some(ended) = self.reading.as_ref().and_then(Job::ended) else { return false };
        self.reading = None;
        self.items = ended.unwrap_or_default();
        true
    }

    /// The user's tags, each once, by name.
    pub fn own_tags(&self) -> Vec<&str> {
        let tags: BTreeSet<&str> = self.items.iter().flat_map(|item| &item.own_tags).map(String::as_str).collect();
        tags.into_iter().collect()
    }

    /// Indices of the items whose name or tags have all words of a text.
    pub fn found(&self, text: &str) -> Vec<usize> {
        let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
        let fits = |item: &Item| {
            let name = item.name.to_lowercase();
            let tags = || item.tags.iter().copied().chain(item.own_tags.iter().map(String::as_str));
            words.iter().all(|word| name.contains(word) || tags().any(|tag| tag.starts_with(word.as_str())))
        };
        (0..self.items.len()).filter(|index| fits(&self.items[*index])).collect()
    }
}

fn read(library: Option<&Library>, recent: &[PathBuf], here: &Planet) -> Vec<Item> {
    let mut items: Vec<Item> = library.into_iter().flat_map(Library::list).map(|kept| of_kept(kept, here)).collect();
    items.extend(recent.iter().filter(|path| path.is_file()).map(|path| of_file(path)));
    items.extend(shipped::ALL.iter().enumerate().map(|(index, preset)| {
        let planet = preset.load().map_err(|error| error.to_string());
        let told = templates::ALL.iter().find(|entry| entry.template == templates::Template::Shipped(preset.file));
        let name = planet.as_ref().map_or(preset.file.to_owned(), |planet| planet.name.clone());
        let name = told.map_or(name.clone(), |entry| format!("{name}: {}", entry.name.to_lowercase()));
        item(Origin::Shipped(index), name, "", planet)
    }));
    items
}

fn of_kept(kept: Kept, here: &Planet) -> Item {
    let Kept { path, name, part, tags, planet } = kept;
    // A part is shown on the open planet.
    let planet = planet.map(|planet| {
        if part.is_empty() {
            return planet;
        }
        let mut with = here.clone();
        with.take_part(&planet, part);
        with
    });
    Item { own_tags: tags, ..item(Origin::Library(path), name, part, planet) }
}

fn of_file(path: &Path) -> Item {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    item(Origin::File(path.to_owned()), name, "", Planet::open(path).map_err(|error| error.to_string()))
}

fn item(origin: Origin, name: String, part: &'static str, planet: Result<Planet, String>) -> Item {
    let mut tags = vec![match origin {
        Origin::Shipped(_) => "shipped",
        Origin::File(_) => "recent",
        Origin::Library(_) => "library",
    }];
    if part.is_empty() {
        tags.push("planet");
        if let Ok(planet) = &planet {
            let has = [
                (planet.water.is_some(), "sea"),
                (planet.atmosphere.is_some(), "air"),
                (planet.clouds.is_some(), "clouds"),
                (planet.rings.is_some(), "rings"),
                (planet.structure.is_some(), "rivers"),
                (planet.structure.is_some(), "structure"),
                (planet.atmosphere.is_none(), "airless"),
                (planet.settlements > 0.0, "settled"),
            ];
            tags.extend(has.into_iter().filter(|(has, _)| *has).map(|(_, tag)| tag));
        }
    } else {
        tags.extend(["part", part]);
    }
    Item { origin, name, part, tags, own_tags: Vec::new(), planet: planet.map(Arc::new) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_found_by_name_and_by_what_they_have() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::new(folder.path().to_owned());
        let planet = shipped::default_planet();
        let kept = library.keep(&planet, "clouds").unwrap();
        library.label(&kept, "Towers", &["sky".to_owned()]).unwrap();
        let mut shelf = Shelf { library: Some(library), ..Shelf::default() };
        shelf.items = read(shelf.library.as_ref(), &[], &Planet::default());
        assert_eq!(shelf.items.len(), 1 + shipped::ALL.len());
        let found = |text: &str| shelf.found(text).len();
        assert_eq!((found(""), found("part clouds"), found("shipped")), (shelf.items.len(), 1, shipped::ALL.len()));
        assert!(found("rivers sea") >= 2 && found("rivers sea") < shipped::ALL.len());
        assert_eq!(found("no such thing"), 0);
        assert_eq!((found("sky"), found("sky towers part"), shelf.own_tags()), (1, 1, vec!["sky"]));
        let part = shelf.items[0].planet.as_ref().unwrap();
        assert_eq!((&part.clouds, part.layers.len()), (&planet.clouds, 0), "a part is shown on the open planet");
    }
}
