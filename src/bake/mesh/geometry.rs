//! The triangles of one level of detail of a square, with plain arrays of its vertices. Triangles are anticlockwise,
//! seen from outside.

use super::patch::{Patch, Vertex};
use glam::{DVec3, Vec2, Vec3};

/// A mesh of triangles.
#[derive(Default)]
pub(super) struct Geometry {
    /// In units of the file.
    pub(super) positions: Vec<Vec3>,
    /// Unit vectors.
    pub(super) normals: Vec<Vec3>,
    /// Unit vectors where `u` grows; empty for water.
    pub(super) tangents: Vec<Vec3>,
    /// `u` to the right and `v` downwards, 0 to 1.
    pub(super) uvs: Vec<Vec2>,
    /// Linear sRGB; empty for water.
    pub(super) colors: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Geometry {
    /// The surface of a patch with each `stride`th vertex, which must divide its cells, and its skirt.
    pub(super) fn new(patch: &Patch, stride: usize, skirt_m: f64, scale: f64) -> Self {
        let mut geometry = Self::default();
        let cells = (patch.side - 1) / stride;
        let side = cells + 1;
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            let vertex = patch.at(row * stride, column * stride);
            geometry.push(vertex, vertex.position_m * scale, place(row, column, cells));
        }
        for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
            let at = |below: usize, beside: usize| ((row + below) * side + column + beside) as u32;
            geometry.triangles.push([at(0, 0), at(1, 0), at(0, 1)]);
            geometry.triangles.push([at(0, 1), at(1, 0), at(1, 1)]);
        }
        if skirt_m > 0.0 {
            geometry.add_skirt(patch, stride, skirt_m, scale);
        }
        geometry
    }

    /// A strip of triangles around the border, from the surface down to `skirt_m` below it.
    fn add_skirt(&mut self, patch: &Patch, stride: usize, skirt_m: f64, scale: f64) {
        let cells = (patch.side - 1) / stride;
        // Anticlockwise seen from above, from the lower left corner.
        let border: Vec<(usize, usize)> = (0..cells)
            .map(|i| (cells, i))
            .chain((0..cells).map(|i| (cells - i, cells)))
            .chain((0..cells).map(|i| (0, cells - i)))
            .chain((0..cells).map(|i| (i, 0)))
            .collect();
        let first = self.positions.len() as u32;
        for &(row, column) in &border {
            let vertex = patch.at(row * stride, column * stride);
            let up = (vertex.position_m - patch.center_m).normalize();
            self.push(vertex, (vertex.position_m - up * skirt_m) * scale, place(row, column, cells));
        }
        for i in 0..border.len() {
            let next = (i + 1) % border.len();
            let above = |(row, column): (usize, usize)| (row * (cells + 1) + column) as u32;
            let [p, q] = [above(border[i]), above(border[next])];
            let [p_below, q_below] = [first + i as u32, first + next as u32];
            self.triangles.push([p, p_below, q]);
            self.triangles.push([q, p_below, q_below]);
        }
    }

    fn push(&mut self, vertex: &Vertex, position: DVec3, uv: Vec2) {
        self.positions.push(position.as_vec3());
        self.normals.push(vertex.normal);
        self.tangents.push(vertex.tangent);
        self.uvs.push(uv);
        self.colors.push(vertex.color);
    }

    /// The water over a patch; None if there is none. A cell has water if one of its corners has: at the others the
    /// water goes on at the mean level of the wet vertices around them, under the ground.
    pub(super) fn water(patch: &Patch, stride: usize, scale: f64) -> Option<Self> {
        let mut geometry = Self::default();
        let cells = (patch.side - 1) / stride;
        let is_wet = |(row, column): (usize, usize)| patch.at(row * stride, column * stride).water_radius_m.is_some();
        // The index of each vertex in the mesh of the water.
        let mut numbers = vec![u32::MAX; (cells + 1) * (cells + 1)];
        for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
            let corners = [(row, column), (row + 1, column), (row, column + 1), (row + 1, column + 1)];
            if !corners.into_iter().any(is_wet) {
                continue;
            }
            let [top_left, bottom_left, top_right, bottom_right] = corners.map(|(row, column)| {
                let number = &mut numbers[row * (cells + 1) + column];
                if *number == u32::MAX {
                    *number = geometry.positions.len() as u32;
                    let up = (patch.at(row * stride, column * stride).position_m - patch.center_m).normalize();
                    let position_m = patch.center_m + up * water_radius_m(patch, row, column, stride);
                    geometry.positions.push((position_m * scale).as_vec3());
                    geometry.normals.push(up.as_vec3());
                    geometry.uvs.push(place(row, column, cells));
                }
                *number
            });
            geometry.triangles.push([top_left, bottom_left, top_right]);
            geometry.triangles.push([top_right, bottom_left, bottom_right]);
        }
        (!geometry.triangles.is_empty()).then_some(geometry)
    }

    /// The least box around the positions.
    pub(super) fn bounds(&self) -> [Vec3; 2] {
        let least = self.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        [least, self.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max)]
    }
}

/// Distance of the water from the planet's centre at a vertex, or its mean at the wet vertices around it: there is at
/// least one.
fn water_radius_m(patch: &Patch, row: usize, column: usize, stride: usize) -> f64 {
    let radius_m = |row: usize, column: usize| patch.at(row * stride, column * stride).water_radius_m;
    radius_m(row, column).unwrap_or_else(|| {
        let last = (patch.side - 1) / stride;
        let near = |middle: usize| middle.saturating_sub(1)..=(middle + 1).min(last);
        let around = near(row).flat_map(|row| near(column).map(move |column| (row, column)));
        let (sum_m, count) = around
            .filter_map(|(row, column)| radius_m(row, column))
            .fold((0.0, 0.0), |(sum_m, count), radius_m| (sum_m + radius_m, count + 1.0));
        sum_m / count
    })
}

fn place(row: usize, column: usize, cells: usize) -> Vec2 {
    Vec2::new((column as f64 / cells as f64) as f32, (row as f64 / cells as f64) as f32)
}
