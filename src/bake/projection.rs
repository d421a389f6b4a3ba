//! How the pixels of a picture lie on the globe. A value stands for the centre of its pixel.
//!
//! - Equirectangular: `width` x `width / 2` pixels, north up, the left edge at longitude -180°.
//! - Cube: six flat faces in the order +X, -X, +Y, -Y, +Z, -Z of [`Face::ALL`](crate::sphere::Face::ALL), turned as
//!   WebGPU, Vulkan, Direct3D and OpenGL expect the faces of a cube texture that is sampled with directions in the
//!   planet frame.
//! - Region: azimuthal equidistant about a centre, see [`Tangent::direction`]: true distances and bearings from the
//!   centre; north is up there. Square pixels.
//! - Landscapes and quadtrees have many pictures: see [`super::pieces`].

use super::MAX_SIZE;
use super::pieces::{Landscape, Quadtree};
use crate::planet::Planet;
use crate::sphere::cube::texture_direction;
use crate::sphere::{Face, LatLon, Tangent};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// How pixels lie on the globe.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Projection {
    /// Longitude to the right, latitude upwards: the whole globe in one picture, twice as wide as high.
    Equirect,
    /// Six square faces of a cube texture.
    Cube,
    /// A square region about a centre, azimuthal equidistant.
    Region(Region),
    /// A square region in tiles that share their border, for terrain engines. A size is that of a tile in vertices.
    Landscape(Landscape),
    /// The tiles of a quadtree of the whole globe, with aprons. A size is that of a tile without its apron.
    Quadtree(Quadtree),
}

/// A square region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Latitude of the centre, degrees.
    pub lat_deg: f64,
    /// Longitude of the centre, degrees.
    pub lon_deg: f64,
    /// Length of a side, from the outer edge of the first pixel to that of the last, through the centre.
    pub side_km: f64,
}

impl Region {
    /// What is wrong with it.
    pub(super) fn check(&self, planet: &Planet) -> Result<(), String> {
        let Self { lat_deg, lon_deg, side_km } = self;
        let longest_km = longest_side_km(planet.radius_km);
        if !(*side_km > 0.0 && *side_km <= longest_km) {
            return Err(format!(
                "a region of {side_km} km is out of range; use more than 0 and at most {longest_km:.0} km on {}",
                planet.name
            ));
        }
        if !((-90.0..=90.0).contains(lat_deg) && lon_deg.abs() <= 360.0) {
            return Err(format!("{lat_deg},{lon_deg} is no location; use -90 to 90 and -360 to 360 degrees"));
        }
        Ok(())
    }
}

impl Projection {
    /// Whether a planet can be baked like this, `size` pixels wide.
    pub(super) fn check(&self, planet: &Planet, size: u32) -> Result<(), String> {
        if !(2..=MAX_SIZE).contains(&size) {
            return Err(format!("a size of {size} is out of range; use 2 to {MAX_SIZE}"));
        }
        match self {
            Projection::Equirect if !size.is_multiple_of(2) => {
                Err(format!("{size} is odd, and the map is half as high as wide; use {}", size + 1))
            }
            Projection::Equirect | Projection::Cube => Ok(()),
            Projection::Region(region) => region.check(planet),
            Projection::Landscape(landscape) => landscape.check(planet, size),
            Projection::Quadtree(tree) => tree.check(size),
        }
    }

    /// Angle between two pixels beside each other, where they are farthest apart.
    pub(super) fn spacing_rad(&self, size: u32, radius_km: f64) -> f64 {
        match self {
            Projection::Equirect => TAU / f64::from(size),
            Projection::Cube => 2.0 / f64::from(size),
            Projection::Region(region) => region.side_km / radius_km / f64::from(size),
            Projection::Landscape(landscape) => landscape.pixel_m(size) / (radius_km * 1000.0),
            // Of the finest level.
            Projection::Quadtree(tree) => Quadtree::pixel_rad(tree.levels, size),
        }
    }

    /// Its name in the JSON beside a map.
    pub fn name(&self) -> &'static str {
        match self {
            Projection::Equirect => "equirect",
            Projection::Cube => "cube",
            Projection::Region(_) | Projection::Landscape(_) => "azimuthal_equidistant",
            Projection::Quadtree(_) => "cube_sphere",
        }
    }
}

/// The pixels of a bake: one picture, or several of the same size.
pub(super) struct Grid {
    pub(super) width: u32,
    pub(super) height: u32,
    spacing_rad: f64,
    kind: Kind,
}

enum Kind {
    /// Sine and cosine of the latitude of each row, and of the longitude of each column.
    Equirect {
        rows: Vec<(f64, f64)>,
        columns: Vec<(f64, f64)>,
    },
    Cube,
    /// The plane of a region.
    Region(Tangent),
    Landscape(Tangent, Landscape),
    /// With the size of a tile.
    Quadtree(Quadtree, u32),
}

impl Grid {
    /// The pixels of a projection. `size`: width of the picture, or of a face.
    pub(super) fn new(projection: &Projection, size: u32, radius_km: f64) -> Self {
        let (mut height, mut width, side) = (size, size, f64::from(size));
        let tangent = |region: &Region| Tangent::at(LatLon::from_degrees(region.lat_deg, region.lon_deg));
        let kind = match projection {
            Projection::Equirect => {
                height = size / 2;
                let lat_deg = |y: u32| 90.0 - (f64::from(y) + 0.5) * 180.0 / f64::from(height);
                let lon_deg = |x: u32| -180.0 + (f64::from(x) + 0.5) * 360.0 / side;
                Kind::Equirect {
                    rows: (0..height).map(|y| libm::sincos(lat_deg(y).to_radians())).collect(),
                    columns: (0..size).map(|x| libm::sincos(lon_deg(x).to_radians())).collect(),
                }
            }
            Projection::Cube => Kind::Cube,
            Projection::Region(region) => Kind::Region(tangent(region)),
            Projection::Landscape(landscape) => Kind::Landscape(tangent(&landscape.region), *landscape),
            Projection::Quadtree(tree) => {
                (width, height) = (tree.picture(size), tree.picture(size));
                Kind::Quadtree(*tree, size)
            }
        };
        Self { width, height, spacing_rad: projection.spacing_rad(size, radius_km), kind }
    }

    /// Angle between two pixels of a picture beside each other, where they are farthest apart.
    pub(super) fn spacing_rad(&self, picture: usize) -> f64 {
        match &self.kind {
            Kind::Quadtree(tree, size) => Quadtree::pixel_rad(tree.node(picture).level, *size),
            _ => self.spacing_rad,
        }
    }

    /// How many pictures there are.
    pub(super) fn pictures(&self) -> usize {
        match &self.kind {
            Kind::Cube => Face::ALL.len(),
            Kind::Landscape(_, landscape) => landscape.pictures(),
            Kind::Quadtree(tree, _) => tree.tiles() as usize,
            Kind::Equirect { .. } | Kind::Region(_) => 1,
        }
    }

    /// The face of a picture, if it is one.
    pub(super) fn face(&self, picture: usize) -> Option<&'static str> {
        Face::ALL.get(picture).filter(|_| matches!(self.kind, Kind::Cube)).map(|face| face.name())
    }

    /// Direction of the centre of a pixel. Rows count from the top.
    pub(super) fn direction(&self, picture: usize, x: u32, y: u32) -> DVec3 {
        match &self.kind {
            Kind::Equirect { rows, columns } => {
                let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (rows[y as usize], columns[x as usize]);
                DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
            }
            Kind::Cube => {
                let side = self.width as usize;
                texture_direction(picture, side, f64::from(x) + 0.5, f64::from(y) + 0.5)
            }
            Kind::Region(tangent) => {
                let middle = f64::from(self.width) / 2.0;
                let (right, up) = (f64::from(x) + 0.5 - middle, middle - f64::from(y) - 0.5);
                tangent.direction(right * self.spacing_rad, up * self.spacing_rad)
            }
            Kind::Landscape(tangent, landscape) => {
                landscape.direction(tangent, self.spacing_rad, self.width, picture, x, y)
            }
            Kind::Quadtree(tree, size) => tree.direction(*size, picture, x, y),
        }
    }
}

/// The longest side of a region, km: its corners are still nearer than the far side of the planet.
pub(super) fn longest_side_km(radius_km: f64) -> f64 {
    PI * radius_km
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lat_lon(grid: &Grid, picture: usize, x: u32, y: u32) -> (f64, f64) {
        LatLon::from_direction(grid.direction(picture, x, y)).to_degrees()
    }

    #[test]
    fn equirectangular_maps_begin_in_the_north_at_the_antimeridian() {
        let grid = Grid::new(&Projection::Equirect, 8, 1.0);
        assert_eq!((grid.width, grid.height, grid.pictures(), grid.face(0)), (8, 4, 1, None));
        let (lat, lon) = lat_lon(&grid, 0, 0, 0);
        assert!((lat - 67.5).abs() < 1e-9 && (lon + 157.5).abs() < 1e-9, "{lat} {lon}");
        let (lat, lon) = lat_lon(&grid, 0, 7, 3);
        assert!((lat + 67.5).abs() < 1e-9 && (lon - 157.5).abs() < 1e-9, "{lat} {lon}");
        // To the bit what a query at that location takes.
        assert_eq!(grid.spacing_rad(0), TAU / 8.0);
        assert_eq!(grid.direction(0, 5, 1), LatLon::from_degrees(22.5, 67.5).direction());
    }

    #[test]
    fn faces_are_those_of_the_planet_frame() {
        let grid = Grid::new(&Projection::Cube, 3, 1.0);
        for (picture, face) in Face::ALL.into_iter().enumerate() {
            let (axis, sign) = face.axis();
            assert_eq!(grid.direction(picture, 1, 1)[axis], sign as f64, "{face:?}");
        }
        assert_eq!((grid.pictures(), grid.face(5)), (6, Some("neg_z")));
    }

    #[test]
    fn regions_keep_distance_and_bearing_from_their_centre() {
        let region = Region { lat_deg: 10.0, lon_deg: 179.0, side_km: 500.0 };
        let grid = Grid::new(&Projection::Region(region), 5, 1000.0);
        let center = LatLon::from_degrees(10.0, 179.0).direction();
        assert_eq!(grid.direction(0, 2, 2), center);
        for (x, y, km) in [(4, 2, 200.0), (2, 0, 200.0), (0, 4, 200.0 * 2.0_f64.sqrt())] {
            let angle = grid.direction(0, x, y).dot(center).acos();
            assert!((angle * 1000.0 - km).abs() < 1e-6, "{angle}");
        }
        // The top is north, the right is east.
        let (lat, lon) = lat_lon(&grid, 0, 2, 0);
        assert!((lat - 10.0 - 0.2_f64.to_degrees()).abs() < 1e-9 && (lon - 179.0).abs() < 1e-9, "{lat} {lon}");
        assert!(lat_lon(&grid, 0, 4, 2).1 < -169.0);
    }
}
