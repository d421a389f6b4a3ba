//! References to files beside a preset: the path that is written, and the content once it is read.
//!
//! A planet carries the content with it, shared and never saved, so that what is made of the planet needs no file.

use super::param::{ParamValue, ValueMut, ValueRef};
use super::picture::place;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The content of a file that a preset refers to.
pub trait Linked: PartialEq + fmt::Debug {
    /// The source of the content: the file, and what else decides how it is read.
    type Key: LinkedKey;
}

/// The source of a linked file's content.
pub trait LinkedKey: Clone + PartialEq + fmt::Debug {
    /// The file.
    fn file(&self) -> &Path;

    /// The same source in a file of another name.
    fn renamed(self, file: PathBuf) -> Self;
}

/// The source of content that depends on the file alone.
impl LinkedKey for PathBuf {
    fn file(&self) -> &Path {
        self
    }

    fn renamed(self, file: PathBuf) -> Self {
        file
    }
}

/// A reference to a file. A preset holds only the path.
#[derive(Serialize, Deserialize)]
#[serde(from = "String", into = "String", bound = "")]
pub struct LinkedFile<L: Linked> {
    path: String,
    /// The folder to which a relative path is relative.
    folder: Option<Arc<Path>>,
    loaded: Option<(L::Key, Arc<L>)>,
}

impl<L: Linked> Default for LinkedFile<L> {
    fn default() -> Self {
        Self { path: String::new(), folder: None, loaded: None }
    }
}

impl<L: Linked> Clone for LinkedFile<L> {
    fn clone(&self) -> Self {
        Self { path: self.path.clone(), folder: self.folder.clone(), loaded: self.loaded.clone() }
    }
}

impl<L: Linked> fmt::Debug for LinkedFile<L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, folder, loaded } = self;
        f.debug_struct("LinkedFile").field("path", path).field("folder", folder).field("loaded", loaded).finish()
    }
}

impl<L: Linked> From<String> for LinkedFile<L> {
    fn from(path: String) -> Self {
        Self { path, ..Self::default() }
    }
}

impl<L: Linked> From<LinkedFile<L>> for String {
    fn from(file: LinkedFile<L>) -> Self {
        file.path
    }
}

/// Equal references lead to the same file and have the same content, however the path is written.
impl<L: Linked> PartialEq for LinkedFile<L> {
    fn eq(&self, other: &Self) -> bool {
        let place = |file: &Self| file.location().map(|path| place::tidy(&path));
        let same_place = match (place(self), place(other)) {
            (None, None) => self.path == other.path,
            (a, b) => a == b,
        };
        let content = |file: &Self| {
            let (key, content) = file.current()?;
            Some((key.clone().renamed(place::tidy(key.file())), content.clone()))
        };
        same_place && content(self) == content(other)
    }
}

impl<L: Linked> ParamValue for LinkedFile<L> {
    fn value_mut(&mut self) -> ValueMut<'_> {
        ValueMut::Text(&mut self.path)
    }

    fn value_ref(&self) -> ValueRef<'_> {
        ValueRef::Text(&self.path)
    }
}

impl<L: Linked> LinkedFile<L> {
    /// The path as it is written.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Whether it names no file.
    pub fn is_none(&self) -> bool {
        self.path.is_empty()
    }

    /// Where the file is. None without a path, or with a relative path before the planet has a folder.
    pub fn location(&self) -> Option<PathBuf> {
        let path = Path::new(&self.path);
        match &self.folder {
            _ if self.path.is_empty() => None,
            Some(folder) => Some(folder.join(path)),
            None => path.is_absolute().then(|| path.to_owned()),
        }
    }

    /// The loaded content and its source, unless the path has changed since.
    pub(super) fn current(&self) -> Option<&(L::Key, Arc<L>)> {
        self.loaded.as_ref().filter(|(key, _)| self.location().as_deref() == Some(key.file()))
    }

    /// Whether its relative paths are relative to something.
    pub(super) fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// A relative path without a folder becomes relative to this one.
    pub(super) fn set_folder(&mut self, folder: &Path) {
        self.folder.get_or_insert_with(|| folder.into());
    }

    /// Takes over content that was read from its source.
    pub(super) fn give(&mut self, key: &L::Key, content: &Arc<L>) {
        self.loaded = Some((key.clone(), content.clone()));
    }

    /// Takes over content from another reference to the same file, if one has it.
    #[cfg(feature = "editor")]
    pub(crate) fn share<'a>(&mut self, others: impl Iterator<Item = &'a Self>)
    where
        L: 'a,
    {
        let place = self.location();
        let loaded = others.filter_map(Self::current);
        if let Some(loaded) = loaded.filter(|(key, _)| Some(key.file()) == place.as_deref()).last() {
            self.loaded = Some(loaded.clone());
        }
    }

    /// Rewrites the path for a preset in this folder.
    pub(super) fn move_to(&mut self, folder: &Path) {
        let Some(old) = self.location() else { return };
        if self.folder.as_deref() == Some(folder) && Path::new(&self.path).is_relative() {
            return;
        }
        let moved = Self { path: place::written_from(&old, folder), folder: Some(folder.into()), loaded: None };
        let loaded = self.current().cloned();
        *self = moved;
        if let (Some((key, content)), Some(file)) = (loaded, self.location()) {
            self.loaded = Some((key.renamed(file), content));
        }
    }
}
