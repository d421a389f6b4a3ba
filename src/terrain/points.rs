//! The points of a batch: unit directions, and their coordinates skewed for the noise loops.

use super::noise;
use glam::DVec3;

/// Points on the unit sphere, each coordinate of the skewed points in its own array.
#[derive(Debug, Default)]
pub(crate) struct Points {
    /// Coordinates skewed onto the simplex grid (see [`noise::skew`]).
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) z: Vec<f64>,
    /// The unit directions.
    pub(crate) dirs: Vec<DVec3>,
    /// The distance between neighbouring points, as an angle; 0 for points that stand alone.
    pub(crate) spacing_rad: f64,
}

impl Points {
    /// Points at unit directions.
    pub(crate) fn new(dirs: Vec<DVec3>) -> Self {
        Self::spaced(dirs, 0.0)
    }

    /// Points of a grid, `spacing_rad` apart.
    pub(crate) fn spaced(dirs: Vec<DVec3>, spacing_rad: f64) -> Self {
        let mut points = Self { dirs, spacing_rad, ..Self::default() };
        points.skew();
        points
    }

    /// Other points in the same memory, `spacing_rad` apart.
    pub(crate) fn refill(&mut self, dirs: impl Iterator<Item = DVec3>, spacing_rad: f64) {
        self.spacing_rad = spacing_rad;
        self.dirs.clear();
        self.dirs.extend(dirs);
        self.skew();
    }

    /// The points of another batch for which `is_wanted` holds, in the same memory.
    pub(crate) fn refill_from(&mut self, others: &Points, is_wanted: impl Fn(usize) -> bool) {
        self.clear_skewed();
        self.dirs.clear();
        self.spacing_rad = others.spacing_rad;
        for i in (0..others.len()).filter(|&i| is_wanted(i)) {
            self.x.push(others.x[i]);
            self.y.push(others.y[i]);
            self.z.push(others.z[i]);
            self.dirs.push(others.dirs[i]);
        }
    }

    fn skew(&mut self) {
        self.clear_skewed();
        let Self { x, y, z, dirs, .. } = self;
        for dir in dirs {
            let skewed = noise::skew(dir.to_array());
            x.push(skewed[0]);
            y.push(skewed[1]);
            z.push(skewed[2]);
        }
    }

    fn clear_skewed(&mut self) {
        for axis in [&mut self.x, &mut self.y, &mut self.z] {
            axis.clear();
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.dirs.len()
    }
}

/// The direction as a unit vector. One that is of unit length already (to rounding) stays as it is, to the bit. One
/// without a direction (zero, infinite or NaN) counts as the north pole.
pub(crate) fn unit(dir: DVec3) -> DVec3 {
    let length2 = dir.length_squared();
    if (length2 - 1.0).abs() < 1e-12 {
        return dir;
    }
    // Beyond this range the square of the length loses digits or overflows.
    if (1e-200..1e200).contains(&length2) {
        return dir.normalize();
    }
    let largest = dir.abs().max_element();
    if dir.is_finite() && largest > 0.0 { (dir / largest).normalize() } else { DVec3::Z }
}
