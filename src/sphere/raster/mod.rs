//! Rasters: grids of numbers over the whole sphere, sampled smoothly, with analytic gradients.
//!
//! Samples are uniform cubic B-splines of the texels (de Boor 1978). They are twice continuously differentiable, so
//! that shading shows no grid; they stay within the range of the texels, so that nothing rings; and they are softer
//! than the texels by about one texel.
//!
//! - A *globe* is equirectangular: twice as wide as high, north up, longitude 0 in the middle, east to the right.
//!   Beyond a pole, rows continue on the opposite meridian. Towards the poles texels are averaged along their row
//!   until they are as wide as high, and around each pole the spline blends into a plane: no pinwheel, no crease.
//! - A *cube* is six square faces in the order of [`super::Face`], each seen from outside the sphere: the view of a
//!   camera in the centre with a field of view of 90°, mirrored. North is up; the right edge of the four around the
//!   equator is east; the bottom edge of +Z and the top edge of -Z meet +X. Faces overlap by two texels and are
//!   blended there.
//! - A *flat* raster covers a place, not the sphere: a rectangle with x to the right and y up from its middle, the
//!   longer side from -1 to 1. Beyond its edges the texels of the edges go on.
//!
//! Coarser levels, each half as fine, serve distant points. Everything is f64 with correctly rounded operations and
//! `libm`: the same bits on every machine.

mod batch;
mod cube;
mod flat;
mod globe;
mod near;
mod spline;
mod texels;

pub use batch::NearPoints;
use cube::{Cube, MARGIN};
pub use cube::{cube_direction, cube_point};
use flat::Flat;
use glam::DVec3;
use globe::Globe;
use near::Ranges;
use std::f64::consts::PI;
pub use texels::Texel;
use texels::{range, shrunk};

/// A raster and its coarser levels.
pub struct Raster<T> {
    /// The finest first.
    levels: Vec<Level<T>>,
    /// Ranges of the texels of the finest level.
    ranges: Ranges<T>,
    bounds: (f64, f64),
}

enum Level<T> {
    Globe(Globe<T>),
    Cube(Cube<T>),
    Flat(Flat<T>),
}

/// Least side of the coarsest level, in texels.
const LEAST_SIDE: usize = 4;

impl<T: Texel> Raster<T> {
    /// An equirectangular raster of `height` rows (at least 4), northernmost first, of `2 * height` texels each.
    pub fn globe(height: usize, texels: Vec<T>) -> Self {
        debug_assert!(height >= LEAST_SIDE && texels.len() == 2 * height * height, "a globe is twice as wide as high");
        let mut levels = vec![(height, texels)];
        while let Some((height, texels)) = levels.last()
            && height / 2 >= LEAST_SIDE
        {
            let half = height / 2;
            levels.push((half, shrunk(texels, [2 * height, *height], [2 * half, half])));
        }
        Self::new(levels.into_iter().map(|(height, texels)| Level::Globe(Globe::new(height, texels))).collect())
    }

    /// A cube of six faces of `side` by `side` texels (at least 4), top row first, one face behind the other.
    pub fn cube(side: usize, texels: Vec<T>) -> Self {
        debug_assert!(side >= LEAST_SIDE && texels.len() == 6 * side * side, "a cube has six square faces");
        let mut levels = vec![(side, texels)];
        while let Some((side, texels)) = levels.last()
            && side / 2 >= LEAST_SIDE
        {
            let half = side / 2;
            let faces = texels.chunks(side * side).flat_map(|face| shrunk(face, [*side; 2], [half; 2])).collect();
            levels.push((half, faces));
        }
        Self::new(levels.into_iter().map(|(side, texels)| Level::Cube(Cube::new(side, &texels))).collect())
    }

    /// A flat raster of rows of `width` texels, top row first; at least 4 each way.
    pub fn flat(width: usize, texels: Vec<T>) -> Self {
        let mut levels = vec![Flat::new(width, texels)];
        while let Some(Flat { width, texels, .. }) = levels.last()
            && let (width, height) = (*width, texels.len() / *width)
            && width.min(height) / 2 >= LEAST_SIDE
        {
            levels.push(Flat::new(width / 2, shrunk(texels, [width, height], [width / 2, height / 2])));
        }
        Self::new(levels.into_iter().map(Level::Flat).collect())
    }

    fn new(levels: Vec<Level<T>>) -> Self {
        let bounds = levels.first().map_or((0.0, 0.0), |finest| match finest {
            Level::Globe(globe) => globe.bounds(),
            Level::Cube(cube) => range(&cube.texels),
            Level::Flat(flat) => range(&flat.texels),
        });
        let ranges = levels.first().map_or_else(
            || Ranges::new(&[], 1),
            |finest| match finest {
                Level::Globe(globe) => Ranges::new(&globe.texels, 2 * globe.height),
                Level::Cube(cube) => Ranges::new(&cube.texels, cube.side + 2 * MARGIN),
                // Only its whole range is asked for.
                Level::Flat(_) => Ranges::new(&[], 1),
            },
        );
        Self { levels, ranges, bounds }
    }

    /// Lowest and greatest value of a sample.
    pub fn bounds(&self) -> (f64, f64) {
        self.bounds
    }

    /// The finest level whose texels are no closer together than points `spacing_rad` apart; 0 is the raster itself. Of
    /// a flat raster the spacing counts as its positions do.
    pub fn level_for(&self, spacing_rad: f64) -> usize {
        let too_fine = |level: &&Level<T>| {
            let texel_rad = match level {
                Level::Globe(globe) => PI / globe.height as f64,
                Level::Cube(cube) => 0.5 * PI / cube.side as f64,
                Level::Flat(flat) => flat.texel(),
            };
            texel_rad < spacing_rad
        };
        self.levels.iter().take_while(too_fine).count().min(self.levels.len() - 1)
    }

    /// The position of a unit direction on the raster, for samples of any level; of a flat raster, of (x, y, 0).
    pub fn place(&self, dir: DVec3) -> Place {
        match &self.levels[0] {
            Level::Globe(_) => Place::on_globe(dir),
            Level::Cube(_) | Level::Flat(_) => Place { dir, lon_rad: 0.0, from_pole_rad: 0.0 },
        }
    }

    /// The value at a position.
    pub fn value(&self, place: &Place, level: usize) -> f64 {
        self.sample(place, level).0
    }

    /// The value at a position, and its gradient by the direction. Only the tangential part of the gradient means
    /// anything. Of a flat raster the gradient is by x and y.
    #[inline(always)]
    pub fn sample(&self, place: &Place, level: usize) -> (f64, DVec3) {
        match &self.levels[level] {
            Level::Globe(globe) => globe.sample(place),
            Level::Cube(cube) => cube.sample(place.dir),
            Level::Flat(flat) => {
                let (value, by_x, by_y) = flat.sample(place.dir.x, place.dir.y);
                (value, DVec3::new(by_x, by_y, 0.0))
            }
        }
    }
}

/// A direction, with the angles that all levels of a raster need.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    dir: DVec3,
    /// On a globe alone: the longitude, and the angle from the nearer pole.
    lon_rad: f64,
    from_pole_rad: f64,
}

impl Place {
    fn on_globe(dir: DVec3) -> Self {
        let flat = (dir.x * dir.x + dir.y * dir.y).sqrt();
        Self { dir, lon_rad: libm::atan2(dir.y, dir.x), from_pole_rad: libm::atan2(flat, dir.z.abs()) }
    }
}

#[cfg(test)]
mod tests;
