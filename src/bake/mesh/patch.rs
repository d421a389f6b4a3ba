//! The vertices of a square.

use super::square::Square;
use super::surface::{BAND, Point, Surface};
use crate::bake::progress::Progress;
use crate::sphere::NodeId;
use glam::{DVec3, Vec3};

/// A square of vertices in the frame of the mesh, row by row from the top.
pub(super) struct Patch {
    /// Vertices along a side.
    pub(super) side: usize,
    pub(super) vertices: Vec<Vertex>,
    /// The centre of the planet, metres.
    pub(super) center_m: DVec3,
}

pub(super) struct Vertex {
    pub(super) position_m: DVec3,
    pub(super) normal: Vec3,
    /// Linear sRGB.
    pub(super) color: Vec3,
    /// Distance of the water over the vertex from the planet's centre, where that is a mesh of its own, metres; else
    /// NaN.
    water_radius_m: f64,
}

impl Patch {
    pub(super) fn new(square: &Square, cells: u32, surface: &Surface<'_>, progress: &Progress<'_>) -> Self {
        let side = cells as usize + 1;
        let direction = |row: usize, column: usize| {
            square.direction(NodeId::side_share(column as u32, cells), NodeId::side_share(row as u32, cells))
        };
        let mut vertices = Vec::with_capacity(side * side);
        for first in (0..side).step_by(BAND) {
            let rows = first..(first + BAND).min(side);
            let points = surface.band(rows, side, &direction, square.spacing_rad(cells), progress);
            vertices.extend(points.iter().map(|point| vertex(square, point)));
        }
        Self { side, vertices, center_m: square.center_m() }
    }

    /// A row of vertices at these positions, metres.
    #[cfg(test)]
    pub(super) fn of(positions_m: impl Iterator<Item = DVec3>, center_m: DVec3) -> Self {
        let (normal, color) = (Vec3::Y, Vec3::ONE);
        let vertices: Vec<_> =
            positions_m.map(|position_m| Vertex { position_m, normal, color, water_radius_m: f64::NAN }).collect();
        Self { side: vertices.len(), vertices, center_m }
    }

    /// Least and greatest distance of water in a mesh of its own from the planet's centre, metres.
    pub(super) fn water_m(&self) -> Option<[f64; 2]> {
        let levels_m = self.vertices.iter().filter_map(Vertex::water_radius_m);
        levels_m.fold(None, |found: Option<[f64; 2]>, level_m| {
            let [least_m, most_m] = found.unwrap_or([level_m; 2]);
            Some([least_m.min(level_m), most_m.max(level_m)])
        })
    }

    /// The vertex of a row and a column.
    pub(super) fn at(&self, row: usize, column: usize) -> &Vertex {
        &self.vertices[row * self.side + column]
    }

    /// Unit vector along the surface to where `u` grows.
    pub(super) fn tangent(&self, row: usize, column: usize) -> DVec3 {
        let last = self.side - 1;
        let (before, after) = (self.at(row, column.saturating_sub(1)), self.at(row, (column + 1).min(last)));
        let vertex = self.at(row, column);
        let (up, normal) = ((vertex.position_m - self.center_m).normalize(), vertex.normal.as_dvec3());
        let along = after.position_m - before.position_m;
        // The vector of the tangent plane whose horizontal part is that of `along`.
        (along - up * (normal.dot(along) / normal.dot(up))).normalize()
    }

    /// Normal and tangent between vertices, as a renderer interpolates them over a triangle. Not of unit length.
    pub(super) fn between(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let cells = self.side - 1;
        let cell = |w: f64| {
            let at = w * cells as f64;
            let first = (at as usize).min(cells - 1);
            (first, at - first as f64)
        };
        let ((column, right), (row, down)) = (cell(u), cell(v));
        // The diagonal of a cell runs from its lower left to its upper right corner.
        let (corners, weights) = if right + down <= 1.0 {
            ([(0, 0), (0, 1), (1, 0)], [1.0 - right - down, right, down])
        } else {
            ([(1, 1), (1, 0), (0, 1)], [right + down - 1.0, 1.0 - right, 1.0 - down])
        };
        let mut sums = (DVec3::ZERO, DVec3::ZERO);
        for ((below, beside), weight) in corners.into_iter().zip(weights) {
            let vertex = self.at(row + below, column + beside);
            sums.0 += vertex.normal.as_dvec3() * weight;
            sums.1 += self.tangent(row + below, column + beside) * weight;
        }
        sums
    }
}

impl Vertex {
    /// Distance of the water over the vertex from the planet's centre, metres.
    pub(super) fn water_radius_m(&self) -> Option<f64> {
        Some(self.water_radius_m).filter(|radius_m| !radius_m.is_nan())
    }
}

fn vertex(square: &Square, point: &Point) -> Vertex {
    Vertex {
        position_m: square.position_m(point.dir_planet, point.height_m),
        normal: square.turned(point.normal_planet).as_vec3(),
        color: DVec3::from_array(point.color).as_vec3(),
        water_radius_m: point.water_level_m.map_or(f64::NAN, |level_m| square.radius_m + level_m),
    }
}
