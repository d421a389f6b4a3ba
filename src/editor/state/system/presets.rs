//! Where the presets of a system's bodies are, and how a system names them from another folder.

use super::OpenSystem;
use crate::editor::files::file_names::readable_stem;
use crate::editor::state::document::Document;
use crate::planet::file::{read, write_atomically};
use crate::planet::picture::folder_of;
use crate::planet::sources::Sources;
use crate::planet::{Planet, shipped};
use crate::system::System;
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Where a system comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The shipped system of this index.
    Shipped(usize),
    /// A file.
    File(PathBuf),
    /// It was begun here.
    New,
}

/// Where a planet to open is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Preset {
    /// The shipped preset of this index.
    Shipped(usize),
    /// A file.
    File(PathBuf),
}

impl OpenSystem {
    /// The preset of a body; None for stars and points.
    pub fn preset(&self, body: usize) -> Option<Preset> {
        let member = self.system().bodies.get(body)?;
        if member.preset.is_empty() {
            return None;
        }
        let named = Path::new(&member.preset);
        match &self.origin {
            Origin::File(path) => {
                let path = folder_of(path).join(named);
                match shipped_preset(named).filter(|_| !path.exists()) {
                    // One that was added since and is written when the system is saved.
                    Some(shipped) => Some(Preset::Shipped(shipped)),
                    // Without `..` in the title.
                    None => Some(Preset::File(std::fs::canonicalize(&path).unwrap_or(path))),
                }
            }
            Origin::Shipped(_) | Origin::New if named.is_absolute() => Some(Preset::File(named.to_owned())),
            Origin::Shipped(_) | Origin::New => shipped_preset(named).map(Preset::Shipped),
        }
    }
}

/// The system's file, and the system for a working copy.
impl OpenSystem {
    /// The files of the system and of its presets.
    pub fn sources(&self) -> Sources {
        let mut sources = Sources::default();
        if let Some(path) = self.path() {
            sources.add(path, "the system file");
        }
        for number in 0..self.system().bodies.len() {
            if let Some(Preset::File(path)) = self.preset(number) {
                sources.add(&path, "a preset of the system");
            }
        }
        sources
    }

    /// The file of the system; None for one that no file holds.
    pub fn path(&self) -> Option<&Path> {
        match &self.origin {
            Origin::File(path) => Some(path),
            Origin::Shipped(_) | Origin::New => None,
        }
    }

    /// The system with whole paths of its presets: it can be read from any folder.
    pub fn with_whole_paths(&self) -> System {
        let mut system = (**self.system()).clone();
        for (number, body) in system.bodies.iter_mut().enumerate() {
            match self.preset(number) {
                None => {}
                Some(Preset::File(path)) => body.preset = path.display().to_string(),
                Some(Preset::Shipped(index)) => body.preset = name_of_shipped(index).unwrap_or_default(),
            }
        }
        system
    }
}

/// The shipped preset that a path names.
fn shipped_preset(path: &Path) -> Option<usize> {
    shipped::ALL.iter().position(|shipped| path.file_name().is_some_and(|name| name == shipped.file))
}

/// How a system names the shipped preset of an index before it is saved.
pub fn name_of_shipped(index: usize) -> Option<String> {
    shipped::ALL.get(index).map(|shipped| format!("../planets/{}", shipped.file))
}

/// The system with its presets as a file in `folder` names them. Shipped presets are written there, without replacing a
/// file.
///
/// # Errors
/// Why a preset could not be written.
pub(super) fn moved(open: &OpenSystem, folder: &Path) -> Result<System, String> {
    let mut system = (**open.system()).clone();
    let mut written: HashMap<usize, String> = HashMap::new();
    for (number, body) in system.bodies.iter_mut().enumerate() {
        match open.preset(number) {
            None => {}
            Some(Preset::File(path)) => body.preset = relative(&path, folder),
            Some(Preset::Shipped(index)) => {
                if let std::collections::hash_map::Entry::Vacant(place) = written.entry(index) {
                    place.insert(write_beside(folder, index)?);
                }
                body.preset.clone_from(&written[&index]);
            }
        }
    }
    Ok(system)
}

/// Writes a shipped preset into a folder, unless a file there holds it. Gives the file's name.
fn write_beside(folder: &Path, index: usize) -> Result<String, String> {
    let preset = &shipped::ALL[index];
    let stem = preset.file.trim_end_matches(".ron");
    let names = std::iter::once(preset.file.to_owned()).chain((2..).map(|number| format!("{stem}-{number}.ron")));
    for name in names {
        let path = folder.join(&name);
        match read(&path, preset.text.len() as u64) {
            Ok(bytes) if bytes == preset.text.as_bytes() => return Ok(name),
            Ok(_) => {}
            Err(_) if path.exists() => {}
            Err(_) => {
                write_atomically(&path, preset.text.as_bytes()).map_err(|why| format!("{}: {why}", path.display()))?;
                return Ok(name);
            }
        }
    }
    Err("there is no free name for a preset".to_owned())
}

/// A path from a folder, with `/` between its parts as on every system; the whole path where there is no way from one
/// to the other.
fn relative(path: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or(path.into());
    let (path, folder) = (whole(path), whole(folder));
    let (to, from): (Vec<Component>, Vec<Component>) = (path.components().collect(), folder.components().collect());
    let shared = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    // Another drive.
    if shared == 0 {
        return path.display().to_string();
    }
    let up = std::iter::repeat_n("..".to_owned(), from.len() - shared);
    let down = to[shared..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// The file of the open planet, or the shipped preset that it is, as a system names it.
///
/// # Errors
/// The planet has no file.
pub fn of_document(document: &Document) -> Result<(String, Arc<Planet>), String> {
    let planet = document.valid_planet();
    if let Some(path) = document.path() {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        return Ok((path.display().to_string(), Arc::clone(planet)));
    }
    // Only one of its name is read.
    let has_name = |preset: &shipped::Shipped| readable_stem(Path::new(preset.file)) == planet.name;
    let is_this =
        |preset: &shipped::Shipped| has_name(preset) && preset.load().is_ok_and(|shipped| shipped == **planet);
    let shipped = shipped::ALL.iter().position(is_this).and_then(name_of_shipped);
    let named = shipped.ok_or("Save the planet first: a system refers to the files of its planets.")?;
    Ok((named, Arc::clone(planet)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_from_one_folder_to_the_other() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(at("a/b")).unwrap();
        std::fs::write(at("a/b/one.ron"), "").unwrap();
        assert_eq!(relative(&at("a/b/one.ron"), &at("a")), "b/one.ron");
        assert_eq!(relative(&at("a/b/one.ron"), &at("a/b")), "one.ron");
        std::fs::create_dir(at("c")).unwrap();
        assert_eq!(relative(&at("a/b/one.ron"), &at("c")), "../a/b/one.ron");
    }
}
