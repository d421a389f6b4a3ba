//! The pictures of a planet: where it refers to them, and reading those that are missing.

use super::param::{ParamPath, Segment};
use super::picture::{Budget, Picture, PictureExtent, PictureFile, PictureKey};
use super::{Planet, Shape, Tool, edits};
use std::path::Path;
use std::sync::Arc;

impl Planet {
    /// Calls `visit` for each reference to a picture, to be changed.
    pub fn each_picture(&mut self, mut visit: impl FnMut(ParamPath, &mut PictureFile, PictureExtent)) {
        for (index, layer) in self.layers.iter_mut().enumerate() {
            if let Shape::HeightMap(map) = &mut layer.shape {
                visit(path_in(index), &mut map.file, map.layout.into());
            }
        }
        for index in 0..self.edits.len() {
            // Looked at first: what is taken to be changed is no longer shared.
            let is_picture = self.edits.get(index).is_some_and(|edit| matches!(edit.tool, Tool::Picture(_)));
            if is_picture && let Some(Tool::Picture(stamp)) = self.edits.get_mut(index).map(|edit| &mut edit.tool) {
                visit(path_in_edit(index), &mut stamp.file, PictureExtent::Place);
            }
        }
    }

    /// All references to pictures.
    pub fn pictures(&self) -> impl Iterator<Item = (ParamPath, &PictureFile, PictureExtent)> {
        let of_layers = self.layers.iter().enumerate().filter_map(|(index, layer)| match &layer.shape {
            Shape::HeightMap(map) => Some((path_in(index), &map.file, map.layout.into())),
            _ => None,
        });
        let of_edits = self.edits.iter().enumerate().filter_map(|(index, edit)| match &edit.tool {
            Tool::Picture(stamp) => Some((path_in_edit(index), &stamp.file, PictureExtent::Place)),
            _ => None,
        });
        of_layers.chain(of_edits)
    }

    /// Relative paths without a folder become relative to this one.
    pub fn set_folder(&mut self, folder: &Path) {
        // Edits stay shared where there is nothing to change.
        if self.pictures().all(|(_, file, _)| file.has_folder()) {
            return;
        }
        self.each_picture(|_, file, _| file.set_folder(folder));
    }

    /// The same planet with its paths rewritten for a preset in this folder.
    pub fn moved_to(&self, folder: &Path) -> Planet {
        let mut planet = self.clone();
        planet.each_picture(|_, file, _| file.move_to(folder));
        planet
    }

    /// The pictures that are not loaded yet: the path of the parameter, and the source or why there is none.
    pub fn missing_pictures(&self) -> Vec<(ParamPath, Result<PictureKey, String>)> {
        let missing =
            self.pictures().filter(|(_, file, extent)| !file.path().is_empty() && file.picture(*extent).is_none());
        let sources = missing.map(|(path, file, extent)| {
            let nowhere = || {
                let path = file.path();
                format!("{path:?} is relative to the preset's folder, and there is none yet; use an absolute path")
            };
            (path, file.key(extent).ok_or_else(nowhere))
        });
        sources.collect()
    }

    /// Gives pixels to every reference to their source.
    pub fn give_picture(&mut self, key: &PictureKey, picture: &Arc<Picture>) {
        self.each_picture(|_, file, extent| {
            if file.key(extent).as_ref() == Some(key) {
                file.give(key, picture);
            }
        });
    }

    /// The budget that is left for missing pictures.
    pub fn picture_budget(&self) -> Budget {
        let mut budget = Budget::default();
        for picture in self.pictures().filter_map(|(_, file, extent)| file.picture(extent)) {
            // A planet beyond the budget only gets no further picture.
            let _ = budget.keep(picture);
        }
        budget
    }

    /// Reads all missing pictures. Returns what is wrong with those that could not be read; their layers stay flat,
    /// their stamps do nothing.
    pub fn load_pictures(&mut self) -> Vec<(ParamPath, String)> {
        self.load_pictures_with(PictureKey::load)
    }

    /// As [`Planet::load_pictures`], from the bytes of PNG or OpenEXR files that `fetch` gives for paths as they are
    /// written in the preset. Files on the disk are not touched. See [`Planet::from_pack`].
    pub fn load_pictures_from(
        &mut self,
        mut fetch: impl FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Vec<(ParamPath, String)> {
        self.set_folder(Path::new(""));
        self.load_pictures_with(|key, budget| key.decode(&fetch(&key.file)?, budget))
    }

    fn load_pictures_with(
        &mut self,
        mut load: impl FnMut(&PictureKey, &mut Budget) -> Result<Arc<Picture>, String>,
    ) -> Vec<(ParamPath, String)> {
        let mut budget = self.picture_budget();
        // A file that failed for one layer is not tried again for the next.
        let mut failed: Vec<(PictureKey, String)> = Vec::new();
        let mut problems = Vec::new();
        for (path, key) in self.missing_pictures() {
            let loaded = key.and_then(|key| match failed.iter().find(|(other, _)| *other == key) {
                Some((_, problem)) => Err(problem.clone()),
                None => match load(&key, &mut budget) {
                    Ok(picture) => Ok((key, picture)),
                    Err(problem) => {
                        failed.push((key, problem.clone()));
                        Err(problem)
                    }
                },
            });
            match loaded {
                Ok((key, picture)) => self.give_picture(&key, &picture),
                Err(problem) => problems.push((path, problem)),
            }
        }
        problems
    }
}

/// Path of the picture in a height map layer.
fn path_in(layer: usize) -> ParamPath {
    let steps = ["shape", "file"].map(Segment::Field);
    ParamPath::from([[Segment::Field("layers"), Segment::Index(layer)], steps].concat())
}

/// Path of the picture in a ground edit.
fn path_in_edit(index: usize) -> ParamPath {
    edits::edit_path(index).join("tool").join("file")
}
