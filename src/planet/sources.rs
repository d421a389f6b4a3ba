//! Files that a work reads, so that nothing it writes replaces one of them.
//!
//! Files are compared by their real paths: through links, and however the paths are written.

use super::{FileContent, FileKey, Planet, beside};
use std::fs::canonicalize;
use std::path::{Path, PathBuf};

/// The files that planets and systems were read from.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<Source>);

#[derive(Clone, Debug)]
struct Source {
    real: PathBuf,
    what: &'static str,
}

impl Sources {
    /// The files of a planet: its preset, the file of its edits, its pictures, texture sets and meshes.
    pub fn of_preset(preset: &Path, planet: &Planet) -> Self {
        let mut sources = Self::of_planet(planet);
        sources.add(preset, "the preset");
        if let Some(edits) = beside::of_preset(preset) {
            sources.add(&edits, "the file of the preset's edits");
        }
        sources
    }

    /// The pictures, texture sets and meshes of a planet, whose preset may have no file.
    pub fn of_planet(planet: &Planet) -> Self {
        let mut sources = Self::default();
        for (key, content) in planet.linked_files() {
            let what = match key {
                FileKey::Picture(_) => "a picture that the planet reads",
                FileKey::Textures(_) => "a texture that the planet reads",
                FileKey::Mesh(_) => "a mesh that the planet reads",
            };
            let others = content.iter().flat_map(FileContent::others);
            others.map(PathBuf::as_path).chain([key.file()]).for_each(|file| sources.add(file, what));
        }
        sources
    }

    /// Adds a file that is read: `what` completes "this is ...".
    pub fn add(&mut self, file: &Path, what: &'static str) {
        // What is not there cannot be replaced.
        if let Ok(real) = canonicalize(file) {
            self.0.push(Source { real, what });
        }
    }

    /// Adds all files of others.
    pub fn extend(&mut self, others: Self) {
        self.0.extend(others.0);
    }

    /// Whether a file can be written here without the loss of what is read.
    ///
    /// # Errors
    /// Which of the files it would replace.
    pub fn check(&self, output: &Path) -> Result<(), String> {
        let Ok(real) = canonicalize(output) else { return Ok(()) };
        match self.0.iter().find(|source| source.real == real) {
            Some(source) => Err(format!("is {}, which would be lost; write to another file", source.what)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_is_known_however_its_path_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("maps")).unwrap();
        for name in ["a.ron", "other", "maps/heights.png"] {
            std::fs::write(at(name), "").unwrap();
        }
        let text = "(version: 3, layers: [(shape: HeightMap(file: \"maps/heights.png\"))])";
        let mut planet = Planet::from_text("a.ron", text).unwrap();
        planet.set_folder(folder.path());
        let sources = Sources::of_preset(&at("a.ron"), &planet);
        assert!(sources.check(&at("a.ron")).unwrap_err().contains("is the preset, which would be lost"));
        assert!(
            sources.check(&at("maps/../maps/heights.png")).unwrap_err().contains("a picture that the planet reads")
        );
        assert_eq!((sources.check(&at("other")), sources.check(&at("new.png"))), (Ok(()), Ok(())));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("maps", at("link")).unwrap();
            std::os::unix::fs::symlink("a.ron", at("b.png")).unwrap();
            assert!(sources.check(&at("link/heights.png")).is_err() && sources.check(&at("b.png")).is_err());
        }
    }
}
