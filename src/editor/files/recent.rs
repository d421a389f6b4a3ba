//! The files that were opened or saved last. They are kept in a text file that all windows share, a path on each line.

use crate::planet::file::write_atomically;
use crate::planet::open::read_whole_text;
use std::path::{Path, PathBuf};

/// Most files that are kept.
const MOST: usize = 12;
const FILE_NAME: &str = "recent.txt";
/// Longest list that is read.
const MOST_BYTES: u64 = 1 << 20;

/// The files that were opened or saved last, newest first.
#[derive(Default)]
pub struct Recent {
    /// Where they are kept; None: only while this window is open.
    file: Option<PathBuf>,
    paths: Vec<PathBuf>,
}

impl Recent {
    /// The files that are kept in `folder`.
    pub fn open(folder: &Path) -> Self {
        let file = folder.join(FILE_NAME);
        Self { paths: read(&file), file: Some(file) }
    }

    /// The files, newest first. Some may be gone.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// Notes that a file was opened or saved.
    pub fn note(&mut self, path: &Path) {
        let Ok(path) = std::path::absolute(path) else { return };
        if self.paths.first() == Some(&path) {
            return;
        }
        // Another window may have noted others meanwhile.
        if let Some(file) = &self.file {
            self.paths = read(file);
        }
        self.paths.retain(|other| *other != path);
        self.paths.insert(0, path);
        self.paths.truncate(MOST);
        self.write();
    }

    /// Forgets all files.
    pub fn clear(&mut self) {
        self.paths.clear();
        self.write();
    }

    fn write(&self) {
        let Some(file) = &self.file else { return };
        // A path with a line break, or one that is no text, is known in this window alone.
        let lines = self.paths.iter().filter_map(|path| path.to_str()).filter(|path| !path.contains('\n'));
        let text: String = lines.map(|path| format!("{path}\n")).collect();
        if let Err(error) = write_atomically(file, text.as_bytes()) {
            log::warn!("{}: recent files are not kept: {error}", file.display());
        }
    }
}

fn read(file: &Path) -> Vec<PathBuf> {
    let text = read_whole_text(file, MOST_BYTES).unwrap_or_default();
    text.lines().filter(|line| !line.is_empty()).take(MOST).map(PathBuf::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_is_first_and_windows_share_the_list() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let (mut one, mut two) = (Recent::open(folder.path()), Recent::open(folder.path()));
        one.note(&path("a.ron"));
        two.note(&path("b.ron"));
        one.note(&path("c.ron"));
        one.note(&path("a.ron"));
        assert_eq!(one.paths(), [path("a.ron"), path("c.ron"), path("b.ron")]);
        assert_eq!(Recent::open(folder.path()).paths(), one.paths());
        (0..20).for_each(|number| two.note(&path(&number.to_string())));
        assert_eq!((two.paths().len(), &two.paths()[0]), (MOST, &path("19")));
        two.clear();
        assert!(Recent::open(folder.path()).paths().is_empty());
    }

    #[test]
    fn without_a_folder_the_list_lasts_as_long_as_the_window() {
        let mut recent = Recent::default();
        recent.note(Path::new("a.ron"));
        assert!(recent.paths()[0].is_absolute());
    }
}
