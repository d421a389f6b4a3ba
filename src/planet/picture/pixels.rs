//! The pixels of a picture, and how they cover the sphere.

use crate::planet::param::choice;
use crate::sphere::raster::{Place, Raster};
use glam::DVec3;
use std::fmt;

choice! {
    /// How a picture covers the planet.
    pub enum PictureLayout {
        /// Twice as wide as high, north up, longitude 0 in the middle, east to the right.
        Equirectangular = "Equirectangular",
        /// 4 x 3 squares: the faces -Y, +X, +Y, -X in the middle row, +Z above and -Z below +X.
        CubeCross = "Cube cross",
        /// Six squares in a row or a column, in the order of [`crate::sphere::Face`], each turned as in the cross.
        CubeStrip = "Cube strip",
    }
}

/// What a picture covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureExtent {
    /// The whole planet, in a layout.
    Globe(PictureLayout),
    /// A place: the picture is flat and of any shape.
    Place,
}

impl From<PictureLayout> for PictureExtent {
    fn from(layout: PictureLayout) -> Self {
        PictureExtent::Globe(layout)
    }
}

impl PictureExtent {
    /// A number for hashes.
    pub(super) fn number(self) -> u64 {
        match self {
            PictureExtent::Globe(layout) => layout as u64,
            PictureExtent::Place => 7,
        }
    }
}

/// The pixels of a picture, to be sampled by direction, or by position if it covers a place. Black is 0, white is 1.
pub struct Picture {
    pub(super) texels: Texels,
    /// Of the pixels and their layout: equal pictures have equal hashes.
    pub(super) hash: u64,
    /// Of the pixels alone, without the coarser levels.
    pub(super) bytes: u64,
}

pub(super) enum Texels {
    Grey16(Raster<u16>),
    Float(Raster<f32>),
}

impl Picture {
    /// Least and greatest value of any sample.
    pub fn bounds(&self) -> (f64, f64) {
        match &self.texels {
            Texels::Grey16(raster) => (raster.bounds().0 / 65535.0, raster.bounds().1 / 65535.0),
            Texels::Float(raster) => raster.bounds(),
        }
    }

    /// Conservative bounds of the samples within an angle of a unit direction.
    pub fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        match &self.texels {
            Texels::Grey16(raster) => {
                let (lo, hi) = raster.bounds_near(dir_planet, angle_rad);
                (lo / 65535.0, hi / 65535.0)
            }
            Texels::Float(raster) => raster.bounds_near(dir_planet, angle_rad),
        }
    }

    /// The finest level that points of this spacing in radians can show; level 0 is the picture itself. Of a picture of
    /// a place the spacing counts as its positions do.
    pub fn level_for(&self, spacing_rad: f64) -> usize {
        match &self.texels {
            Texels::Grey16(raster) => raster.level_for(spacing_rad),
            Texels::Float(raster) => raster.level_for(spacing_rad),
        }
    }

    /// The location of a unit direction in the picture, for samples of any level. In a picture of a place: that of
    /// (x, y, 0), to the right and up from the middle, the longer side from -1 to 1.
    pub fn place(&self, dir_planet: DVec3) -> Place {
        match &self.texels {
            Texels::Grey16(raster) => raster.place(dir_planet),
            Texels::Float(raster) => raster.place(dir_planet),
        }
    }

    /// The value at a location, and its gradient by the direction, or by x and y.
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
