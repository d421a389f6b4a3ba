//! Pictures that a preset refers to: the reference as it stands in the file, and the pixels it leads to.
//!
//! - `read`: opens the file; `from_png`, `from_exr`: its rows or blocks; `canvas`: where they are put; `contain`:
//!   panics of decoders
//! - `budget`: what all pictures of a planet may take
//! - `known`: pictures in use, so that none is read twice
//! - `place`: paths as they are written in a preset of a folder
//!
//! A planet carries its pixels with it, shared and never saved, so that its evaluator needs no file. [`Planet::load`]
//! fetches them; a planet whose pixels are missing is flat where they would count.

mod budget;
mod canvas;
mod contain;
mod from_exr;
mod from_png;
mod known;
mod place;
mod read;

pub use budget::{Budget, MAX_BYTES, MAX_PIXELS, MAX_WORK_BYTES};
pub use contain::is_contained;

use super::param::{ParamPath, ParamValue, Segment, ValueMut, ValueRef, choice};
use super::{Planet, Shape};
use crate::sphere::raster::{Place, Raster};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

choice! {
    /// How a picture covers the planet.
    pub enum PictureLayout {
        /// Twice as wide as high, north up, longitude 0 in the middle, east to the right.
        Equirectangular = "Equirectangular",
        /// 4 x 3 squares: the faces -Y, +X, +Y, -X in the middle row, +Z above and -Z below +X.
        CubeCross = "CubeCross",
        /// Six squares in a row or a column, in the order of [`crate::sphere::Face`], each turned as in the cross.
        CubeStrip = "CubeStrip",
    }
}

/// The pixels of a picture, ready to be sampled at a direction: black is 0, white is 1.
pub struct Picture {
    texels: Texels,
    /// Of the pixels and their layout: equal pictures have equal hashes.
    hash: u64,
    /// Of the pixels alone, without the coarser levels.
    bytes: u64,
}

enum Texels {
    Grey16(Raster<u16>),
    Float(Raster<f32>),
}

impl Picture {
    /// Lowest and greatest number a sample can be.
    pub fn bounds(&self) -> (f64, f64) {
        match &self.texels {
            Texels::Grey16(raster) => (raster.bounds().0 / 65535.0, raster.bounds().1 / 65535.0),
            Texels::Float(raster) => raster.bounds(),
        }
    }

    /// Lowest and greatest number that a sample can be within an angle of a unit direction. Conservative.
    pub fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        match &self.texels {
            Texels::Grey16(raster) => {
                let (lo, hi) = raster.bounds_near(dir_planet, angle_rad);
                (lo / 65535.0, hi / 65535.0)
            }
            Texels::Float(raster) => raster.bounds_near(dir_planet, angle_rad),
        }
    }

    /// The finest level that points so far apart (as an angle) can show; 0 is the picture itself.
    pub fn level_for(&self, spacing_rad: f64) -> usize {
        match &self.texels {
            Texels::Grey16(raster) => raster.level_for(spacing_rad),
            Texels::Float(raster) => raster.level_for(spacing_rad),
        }
    }

    /// Where a unit direction meets the picture, for samples of any level.
    pub fn place(&self, dir_planet: DVec3) -> Place {
        match &self.texels {
            Texels::Grey16(raster) => raster.place(dir_planet),
            Texels::Float(raster) => raster.place(dir_planet),
        }
    }

    /// The number at a place, and its gradient by the direction.
    pub fn sample(&self, place: &Place, level: usize) -> (f64, DVec3) {
        match &self.texels {
            Texels::Grey16(raster) => {
                let (value, gradient) = raster.sample(place, level);
                (value * (1.0 / 65535.0), gradient * (1.0 / 65535.0))
            }
            Texels::Float(raster) => raster.sample(place, level),
        }
    }
}

impl PartialEq for Picture {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash
    }
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Picture({:016x})", self.hash)
    }
}

/// What leads to a picture: a file, read in a layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureKey {
    /// Where the file is.
    pub file: PathBuf,
    /// How it is read.
    pub layout: PictureLayout,
}

impl PictureKey {
    /// Reads the picture, or takes the one that is there from before if its file has not changed; takes what it needs
    /// from the budget of its planet.
    ///
    /// # Errors
    /// What is wrong with the file, and what would be right.
    pub fn load(&self, budget: &mut Budget) -> Result<Arc<Picture>, String> {
        known::load(self, budget)
    }
}

/// A reference to a picture. In a preset it is the path alone.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct PictureFile {
    path: String,
    /// What a relative path counts from.
    folder: Option<Arc<Path>>,
    loaded: Option<(PictureKey, Arc<Picture>)>,
}

impl From<String> for PictureFile {
    fn from(path: String) -> Self {
        Self { path, ..Self::default() }
    }
}

impl From<PictureFile> for String {
    fn from(file: PictureFile) -> Self {
        file.path
    }
}

/// Equal references lead to the same place and have the same pixels, however the path is written.
impl PartialEq for PictureFile {
    fn eq(&self, other: &Self) -> bool {
        let place = |file: &Self| file.location().map(|path| place::tidy(&path));
        let same_place = match (place(self), place(other)) {
            (None, None) => self.path == other.path,
            (a, b) => a == b,
        };
        same_place && self.current() == other.current()
    }
}

impl ParamValue for PictureFile {
    fn value_mut(&mut self) -> ValueMut<'_> {
        ValueMut::Text(&mut self.path)
    }

    fn value_ref(&self) -> ValueRef<'_> {
        ValueRef::Text(&self.path)
    }
}

impl PictureFile {
    /// The path as it is written.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Where the file is; None without a path, or with a relative one before its planet has a folder.
    pub fn location(&self) -> Option<PathBuf> {
        let path = Path::new(&self.path);
        match &self.folder {
            _ if self.path.is_empty() => None,
            Some(folder) => Some(folder.join(path)),
            None => path.is_absolute().then(|| path.to_owned()),
        }
    }

    /// What leads to the pixels in this layout.
    pub fn key(&self, layout: PictureLayout) -> Option<PictureKey> {
        Some(PictureKey { file: self.location()?, layout })
    }

    /// The pixels in this layout, if they are there.
    pub fn picture(&self, layout: PictureLayout) -> Option<&Arc<Picture>> {
        self.current().filter(|(key, _)| key.layout == layout).map(|(_, picture)| picture)
    }

    /// What was loaded, unless the path has changed since.
    fn current(&self) -> Option<&(PictureKey, Arc<Picture>)> {
        self.loaded.as_ref().filter(|(key, _)| self.location().as_ref() == Some(&key.file))
    }

    /// Writes the path anew for a preset in this folder.
    fn move_to(&mut self, folder: &Path) {
        let Some(old) = self.location() else { return };
        if self.folder.as_deref() == Some(folder) && Path::new(&self.path).is_relative() {
            return;
        }
        let moved = Self { path: place::written_from(&old, folder), folder: Some(folder.into()), loaded: None };
        let loaded = self.current().cloned();
        *self = moved;
        if let (Some((key, picture)), Some(file)) = (loaded, self.location()) {
            self.loaded = Some((PictureKey { file, ..key }, picture));
        }
    }
}

impl Planet {
    /// Calls `visit` for each reference to a picture.
    pub fn each_picture(&mut self, mut visit: impl FnMut(ParamPath, &mut PictureFile, PictureLayout)) {
        for (index, layer) in self.layers.iter_mut().enumerate() {
            if let Shape::HeightMap(map) = &mut layer.shape {
                let steps = ["shape", "file"].map(Segment::Field);
                let path = [[Segment::Field("layers"), Segment::Index(index)], steps].concat();
                visit(ParamPath::from(path), &mut map.file, map.layout);
            }
        }
    }

    /// Lets relative paths that count from nowhere count from this folder.
    pub fn set_folder(&mut self, folder: &Path) {
        self.each_picture(|_, file, _| {
            file.folder.get_or_insert_with(|| folder.into());
        });
    }

    /// The same planet with its paths written for a preset in this folder.
    pub fn moved_to(&self, folder: &Path) -> Planet {
        let mut planet = self.clone();
        planet.each_picture(|_, file, _| file.move_to(folder));
        planet
    }

    /// The pictures that are not there yet: where they are wanted, and what leads to them or why nothing does.
    pub fn missing_pictures(&self) -> Vec<(ParamPath, Result<PictureKey, String>)> {
        let mut missing = Vec::new();
        self.clone().each_picture(|path, file, layout| {
            if !file.path.is_empty() && file.picture(layout).is_none() {
                let nowhere = || {
                    format!("{:?} counts from the preset's folder, and there is none yet; use a whole path", file.path)
                };
                missing.push((path, file.key(layout).ok_or_else(nowhere)));
            }
        });
        missing
    }

    /// Hands over pixels to every reference that leads to them.
    pub fn give_picture(&mut self, key: &PictureKey, picture: &Arc<Picture>) {
        self.each_picture(|_, file, layout| {
            if file.key(layout).as_ref() == Some(key) {
                file.loaded = Some((key.clone(), picture.clone()));
            }
        });
    }

    /// What the pictures that are there leave for those that are missing.
    pub fn picture_budget(&self) -> Budget {
        let mut budget = Budget::default();
        self.clone().each_picture(|_, file, layout| {
            if let Some(picture) = file.picture(layout) {
                // A planet that has more already gets no more.
                let _ = budget.keep(picture);
            }
        });
        budget
    }

    /// Reads all pictures that are missing; what is wrong with any of them. Their layers stay flat.
    pub fn load_pictures(&mut self) -> Vec<(ParamPath, String)> {
        let mut budget = self.picture_budget();
        // What could not be read for one layer is not tried again for the next.
        let mut failed: Vec<(PictureKey, String)> = Vec::new();
        let mut problems = Vec::new();
        for (path, key) in self.missing_pictures() {
            let loaded = key.and_then(|key| match failed.iter().find(|(other, _)| *other == key) {
                Some((_, problem)) => Err(problem.clone()),
                None => match key.load(&mut budget) {
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

/// The folder of a preset, as references keep it.
pub(crate) fn folder_of(preset: &Path) -> PathBuf {
    let whole = std::path::absolute(preset).unwrap_or_else(|_| preset.to_owned());
    whole.parent().map_or_else(PathBuf::new, Path::to_owned)
}
