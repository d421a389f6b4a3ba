//! The pictures, texture sets and meshes of a planet: where it refers to them, and reading those that are missing.

use super::life::{Form, population_path};
use super::mesh::{self, MeshData, MeshFile};
use super::param::{ParamPath, Segment};
use super::picture::{Budget, Picture, PictureExtent, PictureFile, PictureKey};
use super::textures::{self, TextureSet, TextureSetFile};
use super::{Planet, Shape, Tool, edits};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The source of a file that a planet refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileKey {
    /// A picture of heights.
    Picture(PictureKey),
    /// The colour picture of a texture set.
    Textures(PathBuf),
    /// The mesh of a population.
    Mesh(PathBuf),
}

/// Content of a file that a planet refers to. Clones share it.
#[derive(Clone, Debug, PartialEq)]
pub enum FileContent {
    /// Pixels.
    Picture(Arc<Picture>),
    /// Textures.
    Textures(Arc<TextureSet>),
    /// Triangles.
    Mesh(Arc<MeshData>),
}

impl FileContent {
    /// The files that belong to it, beside the one that the planet names.
    pub fn others(&self) -> &[PathBuf] {
        match self {
            FileContent::Picture(_) => &[],
            FileContent::Textures(set) => set.others(),
            FileContent::Mesh(mesh) => mesh.others(),
        }
    }
}

impl FileKey {
    /// Where the file is.
    pub fn file(&self) -> &Path {
        match self {
            FileKey::Picture(key) => &key.file,
            FileKey::Textures(file) | FileKey::Mesh(file) => file,
        }
    }

    /// Reads the file, or shares a picture in use. Its size is taken from the budget of the planet.
    ///
    /// # Errors
    /// Problem of the file, and what would be right.
    pub fn load(&self, budget: &mut Budget) -> Result<FileContent, String> {
        match self {
            FileKey::Picture(key) => key.load(budget).map(FileContent::Picture),
            FileKey::Textures(file) => textures::load(file, budget).map(FileContent::Textures),
            FileKey::Mesh(file) => mesh::load(file, budget).map(FileContent::Mesh),
        }
    }

    fn decode(
        &self,
        fetch: &mut impl FnMut(&Path) -> Result<Vec<u8>, String>,
        budget: &mut Budget,
    ) -> Result<FileContent, String> {
        let bytes = fetch(self.file())?;
        match self {
            FileKey::Picture(key) => key.decode(&bytes, budget).map(FileContent::Picture),
            FileKey::Textures(file) => textures::decoded(file, &bytes, fetch, budget).map(FileContent::Textures),
            FileKey::Mesh(file) => mesh::decoded(file, &bytes, fetch, budget).map(FileContent::Mesh),
        }
    }
}

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

    /// Calls `visit` for each reference to a texture set, to be changed.
    pub fn each_texture_set(&mut self, mut visit: impl FnMut(ParamPath, &mut TextureSetFile)) {
        for (index, biome) in self.biomes.palette.iter_mut().enumerate().filter(|(_, biome)| !biome.textures.is_none())
        {
            visit(path_in_biome(index), &mut biome.textures);
        }
    }

    /// All references to texture sets.
    pub fn texture_sets(&self) -> impl Iterator<Item = (ParamPath, &TextureSetFile)> {
        let named = self.biomes.palette.iter().enumerate().filter(|(_, biome)| !biome.textures.is_none());
        named.map(|(index, biome)| (path_in_biome(index), &biome.textures))
    }

    /// Calls `visit` for each reference to a mesh, to be changed.
    pub fn each_mesh(&mut self, mut visit: impl FnMut(ParamPath, &mut MeshFile)) {
        for (index, population) in self.life.iter_mut().enumerate() {
            if let Form::Mesh(form) = &mut population.form {
                visit(path_in_population(index), &mut form.file);
            }
        }
    }

    /// All references to meshes.
    pub fn meshes(&self) -> impl Iterator<Item = (ParamPath, &MeshFile)> {
        self.life.iter().enumerate().filter_map(|(index, population)| match &population.form {
            Form::Mesh(form) => Some((path_in_population(index), &form.file)),
            _ => None,
        })
    }

    /// The places and sources of all files that the planet refers to.
    #[cfg(feature = "editor")]
    pub(crate) fn linked_places(&self) -> impl Iterator<Item = (ParamPath, FileKey)> {
        let pictures =
            self.pictures().filter_map(|(path, file, extent)| Some((path, FileKey::Picture(file.key(extent)?))));
        let sets = self.texture_sets().filter_map(|(path, file)| Some((path, FileKey::Textures(file.location()?))));
        let meshes = self.meshes().filter_map(|(path, file)| Some((path, FileKey::Mesh(file.location()?))));
        pictures.chain(sets).chain(meshes)
    }

    /// The sources of all files that the planet refers to, and what was read of them: pictures first.
    pub fn linked_files(&self) -> impl Iterator<Item = (FileKey, Option<FileContent>)> {
        let pictures = self.pictures().filter_map(|(_, file, extent)| {
            Some((FileKey::Picture(file.key(extent)?), file.picture(extent).cloned().map(FileContent::Picture)))
        });
        let sets = self.texture_sets().filter_map(|(_, file)| {
            Some((FileKey::Textures(file.location()?), file.set().cloned().map(FileContent::Textures)))
        });
        let meshes = self.meshes().filter_map(|(_, file)| {
            Some((FileKey::Mesh(file.location()?), file.mesh().cloned().map(FileContent::Mesh)))
        });
        pictures.chain(sets).chain(meshes)
    }

    /// Where all files are that the planet refers to, with those that belong to texture sets and meshes.
    pub(crate) fn linked_paths(&self) -> Vec<PathBuf> {
        let paths = self.linked_files().flat_map(|(key, content)| {
            let others = content.iter().flat_map(FileContent::others).cloned().collect::<Vec<_>>();
            others.into_iter().chain([key.file().to_owned()])
        });
        paths.collect()
    }

    /// Relative paths without a folder become relative to this one.
    pub fn set_folder(&mut self, folder: &Path) {
        // Edits stay shared where there is nothing to change.
        if self.pictures().any(|(_, file, _)| !file.has_folder()) {
            self.each_picture(|_, file, _| file.set_folder(folder));
        }
        self.each_texture_set(|_, file| file.set_folder(folder));
        self.each_mesh(|_, file| file.set_folder(folder));
    }

    /// The same planet with its paths rewritten for a preset in this folder.
    pub fn moved_to(&self, folder: &Path) -> Planet {
        let mut planet = self.clone();
        planet.each_picture(|_, file, _| file.move_to(folder));
        planet.each_texture_set(|_, file| file.move_to(folder));
        planet.each_mesh(|_, file| file.move_to(folder));
        planet
    }

    /// The pictures, texture sets and meshes that are not loaded yet: the path of the parameter, and the source or why
    /// there is none.
    pub fn missing_files(&self) -> Vec<(ParamPath, Result<FileKey, String>)> {
        let source = |written: &str, key: Option<FileKey>| {
            key.ok_or_else(|| {
                format!("{written:?} is relative to the preset's folder, and there is none yet; use an absolute path")
            })
        };
        let pictures =
            self.pictures().filter(|(_, file, extent)| !file.path().is_empty() && file.picture(*extent).is_none());
        let pictures =
            pictures.map(|(path, file, extent)| (path, source(file.path(), file.key(extent).map(FileKey::Picture))));
        let meshes = self.meshes().filter(|(_, file)| !file.path().is_empty() && file.mesh().is_none());
        let meshes = meshes.map(|(path, file)| (path, source(file.path(), file.location().map(FileKey::Mesh))));
        let sets = self.texture_sets().filter(|(_, file)| file.set().is_none());
        let sets = sets.map(|(path, file)| (path, source(file.path(), file.location().map(FileKey::Textures))));
        pictures.chain(sets).chain(meshes).collect()
    }

    /// Gives content to every reference to its source.
    pub fn give_file(&mut self, key: &FileKey, content: &FileContent) {
        match (key, content) {
            (FileKey::Picture(key), FileContent::Picture(picture)) => self.each_picture(|_, file, extent| {
                if file.key(extent).as_ref() == Some(key) {
                    file.give(key, picture);
                }
            }),
            (FileKey::Textures(key), FileContent::Textures(set)) => self.each_texture_set(|_, file| {
                if file.location().as_ref() == Some(key) {
                    file.give(key, set);
                }
            }),
            (FileKey::Mesh(key), FileContent::Mesh(mesh)) => self.each_mesh(|_, file| {
                if file.location().as_ref() == Some(key) {
                    file.give(key, mesh);
                }
            }),
            _ => {}
        }
    }

    /// The budget that is left for missing pictures, texture sets and meshes.
    pub fn file_budget(&self) -> Budget {
        self.budget_beside(None)
    }

    /// The budget that is left for a file that is read again, or for a missing one.
    pub(crate) fn budget_beside(&self, again: Option<&FileKey>) -> Budget {
        let mut budget = Budget::default();
        for (_, content) in self.linked_files().filter(|(key, _)| again != Some(key)) {
            // A planet beyond the budget only gets no further file.
            let _ = match content {
                Some(FileContent::Picture(picture)) => budget.keep(&picture),
                Some(FileContent::Textures(set)) => budget.keep_layer(set.hash(), set.bytes()),
                Some(FileContent::Mesh(mesh)) => budget.keep_mesh(mesh.hash(), mesh.triangles()),
                None => Ok(()),
            };
        }
        budget
    }

    /// Reads all missing pictures, texture sets and meshes. Returns what is wrong with those that could not be read;
    /// their layers stay flat, their stamps do nothing, their biomes show built-in patterns, their populations stand
    /// with a plain form.
    pub fn load_pictures(&mut self) -> Vec<(ParamPath, String)> {
        self.load_pictures_with(FileKey::load)
    }

    /// The problems of [`Planet::load_pictures`] that leave the ground as it is, those of texture sets, and the others.
    pub(crate) fn harmless_problems(&self, problems: Vec<(ParamPath, String)>) -> [Vec<(ParamPath, String)>; 2] {
        let sets: Vec<ParamPath> = self.texture_sets().map(|(path, _)| path).collect();
        let (harmless, others) = problems.into_iter().partition(|(path, _)| sets.contains(path));
        [harmless, others]
    }

    /// As [`Planet::load_pictures`], from the bytes of files that `fetch` gives for paths as they are written in the
    /// preset, for those of buffers and pictures that a mesh names, and for names that the other pictures of a texture
    /// set may have: what it has none for, the set lacks. Files on the disk are not touched. See [`Planet::from_pack`].
    pub fn load_pictures_from(
        &mut self,
        mut fetch: impl FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Vec<(ParamPath, String)> {
        self.set_folder(Path::new(""));
        self.load_pictures_with(|key, budget| key.decode(&mut fetch, budget))
    }

    fn load_pictures_with(
        &mut self,
        mut load: impl FnMut(&FileKey, &mut Budget) -> Result<FileContent, String>,
    ) -> Vec<(ParamPath, String)> {
        let mut budget = self.file_budget();
        // A file that failed for one layer is not tried again for the next.
        let mut failed: Vec<(FileKey, String)> = Vec::new();
        // One that was read was given to all that refer to it.
        let mut read: Vec<FileKey> = Vec::new();
        let mut problems = Vec::new();
        for (path, key) in self.missing_files() {
            if key.as_ref().is_ok_and(|key| read.contains(key)) {
                continue;
            }
            let loaded = key.and_then(|key| match failed.iter().find(|(other, _)| *other == key) {
                Some((_, problem)) => Err(problem.clone()),
                None => match load(&key, &mut budget) {
                    Ok(content) => Ok((key, content)),
                    Err(problem) => {
                        failed.push((key, problem.clone()));
                        Err(problem)
                    }
                },
            });
            match loaded {
                Ok((key, content)) => {
                    self.give_file(&key, &content);
                    read.push(key);
                }
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

/// Path of the texture set of a biome.
fn path_in_biome(index: usize) -> ParamPath {
    let steps =
        [Segment::Field("biomes"), Segment::Field("palette"), Segment::Index(index), Segment::Field("textures")];
    ParamPath::from(steps.to_vec())
}

/// Path of the mesh of a population.
fn path_in_population(index: usize) -> ParamPath {
    population_path(index).join("form").join("file")
}
