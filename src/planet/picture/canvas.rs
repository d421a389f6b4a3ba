//! The pixels of a picture during decoding, in the order of its raster, so that nothing is held twice.

use super::budget::MAX_PIXELS;
use super::pixels::{PictureExtent, PictureLayout};
use crate::sphere::raster::{Raster, Texel};

/// Fewest pixels on the side of a cube face or of a flat picture, and in the height of an equirectangular picture.
const LEAST_SIDE: usize = 4;

/// Width and height of a picture that fits what it covers and is not too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Size {
    /// Says what is wrong with the size of a picture that covers this.
    pub(super) fn checked([width, height]: [usize; 2], extent: PictureExtent) -> Result<Self, String> {
        let (right, words) = match extent {
            PictureExtent::Place => (width.min(height) >= LEAST_SIDE, "a picture of a place has any shape"),
            PictureExtent::Globe(PictureLayout::Equirectangular) => (
                width / 2 == height && width % 2 == 0 && height >= LEAST_SIDE,
                "an equirectangular picture is twice as wide as high",
            ),
            PictureExtent::Globe(PictureLayout::CubeCross) => (
                width.saturating_mul(3) == height.saturating_mul(4) && width >= 4 * LEAST_SIDE,
                "a cube cross is 4 squares wide and 3 high",
            ),
            PictureExtent::Globe(PictureLayout::CubeStrip) => (
                (width == height.saturating_mul(6) || height == width.saturating_mul(6))
                    && width.min(height) >= LEAST_SIDE,
                "a cube strip is 6 squares in a row or a column",
            ),
        };
        if (width as u64).saturating_mul(height as u64) > MAX_PIXELS {
            return Err(format!(
                "is {width} x {height} pixels; use a smaller picture, of at most {MAX_PIXELS} pixels (16384 x 8192)"
            ));
        }
        if !right {
            return Err(format!("is {width} x {height} pixels; {words}, with sides of at least {LEAST_SIDE} pixels"));
        }
        Ok(Self { width, height })
    }

    /// Width times height.
    pub(super) fn pixels(self) -> u64 {
        self.width as u64 * self.height as u64
    }
}

/// The pixels decoded so far.
pub(super) struct Canvas<T> {
    size: Size,
    extent: PictureExtent,
    /// Pixels along a square of a cube picture, or in a row of another, and the face of each square; None for a square
    /// without a face.
    side: usize,
    faces: Vec<Vec<Option<usize>>>,
    texels: Vec<T>,
}

impl<T: Texel> Canvas<T> {
    /// An empty canvas.
    pub(super) fn new(size: Size, extent: PictureExtent) -> Result<Self, String> {
        // The column and row of each face in squares, in the order of the faces.
        let cube: Option<(usize, [(usize, usize); 6])> = match extent {
            PictureExtent::Place | PictureExtent::Globe(PictureLayout::Equirectangular) => None,
            PictureExtent::Globe(PictureLayout::CubeCross) => {
                Some((size.height / 3, [(1, 1), (3, 1), (2, 1), (0, 1), (1, 0), (1, 2)]))
            }
            PictureExtent::Globe(PictureLayout::CubeStrip) if size.width > size.height => {
                Some((size.height, std::array::from_fn(|face| (face, 0))))
            }
            PictureExtent::Globe(PictureLayout::CubeStrip) => Some((size.width, std::array::from_fn(|face| (0, face)))),
        };
        let (side, mut faces, mut count) = (size.width, Vec::new(), size.width * size.height);
        let side = cube.map_or(side, |(side, squares)| {
            faces = vec![vec![None; size.width / side]; size.height.div_ceil(side)];
            for (face, (column, row)) in squares.into_iter().enumerate() {
                faces[row][column] = Some(face);
            }
            count = 6 * side * side;
            side
        });
        let mut texels = Vec::new();
        texels.try_reserve_exact(count).map_err(|_| "is too large for the memory that is free".to_owned())?;
        texels.resize(count, T::default());
        Ok(Self { size, extent, side, faces, texels })
    }

    /// Writes values side by side from a row and column on. Values outside of all faces are dropped.
    pub(super) fn put(&mut self, row: usize, mut column: usize, mut values: &[T]) {
        while !values.is_empty() && row < self.size.height && column < self.size.width {
            let (x, y) = (column % self.side, row % self.side);
            let (now, later) = values.split_at(values.len().min(self.side - x));
            let first = match self.faces.get(row / self.side) {
                Some(faces) => faces[column / self.side].map(|face| (face * self.side + y) * self.side + x),
                // No squares: the rows are one behind the other.
                None => Some(row * self.size.width + column),
            };
            if let Some(first) = first {
                self.texels[first..first + now.len()].copy_from_slice(now);
            }
            column += now.len();
            values = later;
        }
    }

    /// The raster, and a 64-bit hash of the picture. `bits` are those of a value.
    pub(super) fn finish(self, bits: impl Fn(T) -> u64) -> (Raster<T>, u64) {
        let start = [self.extent.number(), self.size.width as u64, self.size.height as u64].into_iter();
        let hash =
            start.chain(self.texels.iter().map(|texel| bits(*texel))).fold(0xcbf2_9ce4_8422_2325, |hash, number| {
                let mixed = (hash ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                mixed ^ (mixed >> 29)
            });
        let raster = match self.extent {
            PictureExtent::Place => Raster::flat(self.size.width, self.texels),
            PictureExtent::Globe(PictureLayout::Equirectangular) => Raster::globe(self.size.height, self.texels),
            PictureExtent::Globe(_) => Raster::cube(self.side, self.texels),
        };
        (raster, hash)
    }
}
