//! The triangles of one level of detail of a square, with plain arrays of its vertices. Triangles are anticlockwise,
//! seen from outside.

use super::patch::Patch;
use glam::{Vec2, Vec3};

/// A mesh of triangles.
#[derive(Default)]
pub(super) struct Geometry {
    /// In units of the file.
    pub(super) positions: Vec<Vec3>,
    /// Unit vectors.
    pub(super) normals: Vec<Vec3>,
    /// Unit vectors where `u` grows; empty without textures.
    pub(super) tangents: Vec<Vec3>,
    /// `u` to the right and `v` downwards, 0 to 1.
    pub(super) uvs: Vec<Vec2>,
    /// Linear sRGB; empty with textures, and for water.
    pub(super) colors: Vec<Vec3>,
    /// Cells along a side of the grid that the first vertices form, row by row; 0 without one.
    cells: u32,
    /// Triangles besides those of the grid.
    more: Vec<[u32; 3]>,
}

impl Geometry {
    /// The surface of a patch with each `stride`th vertex, which must divide its cells, and its skirt. With textures it
    /// has tangents, else colours.
    pub(super) fn new(patch: &Patch, stride: usize, skirt_m: f64, scale: f64, is_textured: bool) -> Self {
        let cells = (patch.side - 1) / stride;
        let side = cells + 1;
        let count = side * side + if skirt_m > 0.0 { 4 * cells } else { 0 };
        let (tangents, colors) = if is_textured { (count, 0) } else { (0, count) };
        let mut geometry = Self {
            positions: Vec::with_capacity(count),
            normals: Vec::with_capacity(count),
            tangents: Vec::with_capacity(tangents),
            uvs: Vec::with_capacity(count),
            colors: Vec::with_capacity(colors),
            cells: cells as u32,
            more: Vec::new(),
        };
        let mut push = |row: usize, column: usize, below_m: f64| {
            let vertex = patch.at(row * stride, column * stride);
            let mut position_m = vertex.position_m;
            if below_m > 0.0 {
                position_m -= (position_m - patch.center_m).normalize() * below_m;
            }
            geometry.positions.push((position_m * scale).as_vec3());
            geometry.normals.push(vertex.normal);
            geometry.uvs.push(place(row, column, cells));
            if is_textured {
                geometry.tangents.push(patch.tangent(row * stride, column * stride).as_vec3());
            } else {
                geometry.colors.push(vertex.color);
            }
        };
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            push(row, column, 0.0);
        }
        if skirt_m > 0.0 {
            let border = border(cells);
            for &(row, column) in &border {
                push(row, column, skirt_m);
            }
            geometry.add_skirt(&border);
        }
        geometry
    }

    /// The triangles.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let (cells, side) = (self.cells, self.cells + 1);
        let of_grid = (0..cells).flat_map(move |row| {
            (0..cells).flat_map(move |column| {
                let at = |below: u32, beside: u32| (row + below) * side + column + beside;
                [[at(0, 0), at(1, 0), at(0, 1)], [at(0, 1), at(1, 0), at(1, 1)]]
            })
        });
        of_grid.chain(self.more.iter().copied())
    }

    /// How many triangles there are.
    pub(super) fn triangle_count(&self) -> usize {
        2 * (self.cells as usize).pow(2) + self.more.len()
    }

    /// A strip of triangles between the border and the vertices below it, which come last.
    fn add_skirt(&mut self, border: &[(usize, usize)]) {
        let cells = self.cells as usize;
        let first = (self.positions.len() - border.len()) as u32;
        for i in 0..border.len() {
            let next = (i + 1) % border.len();
            let above = |(row, column): (usize, usize)| (row * (cells + 1) + column) as u32;
            let [p, q] = [above(border[i]), above(border[next])];
            let [p_below, q_below] = [first + i as u32, first + next as u32];
            self.more.push([p, p_below, q]);
            self.more.push([q, p_below, q_below]);
        }
    }

    /// The water over a patch; None if there is none. A cell has water if one of its corners has: at the others the
    /// water goes on at the mean level of the wet vertices around them, under the ground.
    pub(super) fn water(patch: &Patch, stride: usize, scale: f64) -> Option<Self> {
        let mut geometry = Self::default();
        let cells = (patch.side - 1) / stride;
        let is_wet = |(row, column): (usize, usize)| patch.at(row * stride, column * stride).water_radius_m().is_some();
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
            geometry.more.push([top_left, bottom_left, top_right]);
            geometry.more.push([top_right, bottom_left, bottom_right]);
        }
        (!geometry.more.is_empty()).then_some(geometry)
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
    let radius_m = |row: usize, column: usize| patch.at(row * stride, column * stride).water_radius_m();
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

/// The border of a grid, anticlockwise seen from above, from the lower left corner.
fn border(cells: usize) -> Vec<(usize, usize)> {
    (0..cells)
        .map(|i| (cells, i))
        .chain((0..cells).map(|i| (cells - i, cells)))
        .chain((0..cells).map(|i| (0, cells - i)))
        .chain((0..cells).map(|i| (i, 0)))
        .collect()
}

fn place(row: usize, column: usize, cells: usize) -> Vec2 {
    Vec2::new((column as f64 / cells as f64) as f32, (row as f64 / cells as f64) as f32)
}
