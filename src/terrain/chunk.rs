//! Chunks of ground for physics engines: triangle meshes in a local frame, which meet without a gap.

use super::Terrain;
use super::query::{Sample, Scratch, Wanted};
use crate::sphere::Tangent;
use glam::{DVec3, Vec3};

/// A grid of square chunks around a place. Positions are local: metres along east, north and up of the place, from an
/// origin at a height. Games place it near the player and begin a new grid when the player is some kilometres away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChunkGrid {
    /// The place and its axes.
    pub tangent: Tangent,
    /// Height of the origin over the reference sphere.
    pub origin_height_m: f64,
    /// Length of a side of a chunk along the ground.
    pub side_m: f64,
    /// Cells along a side of a chunk.
    pub cells: u32,
}

/// A square of ground as a triangle mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Chunk {
    /// Vertices row by row from the south west, in the local frame of the grid.
    pub positions_m: Vec<Vec3>,
    /// Unit normals of the ground in the local frame.
    pub normals: Vec<Vec3>,
    /// Height of the ground over the reference sphere.
    pub heights_m: Vec<f64>,
    /// Triangles, anticlockwise from above.
    pub triangles: Vec<[u32; 3]>,
}

impl ChunkGrid {
    /// A grid around the ground under a direction, with the origin on it.
    pub fn on_ground(terrain: &Terrain, dir_planet: DVec3, side_m: f64, cells: u32) -> Self {
        let up_planet = super::points::unit(dir_planet);
        let origin_height_m = terrain.height_m(up_planet);
        Self { tangent: Tangent::new(up_planet), origin_height_m, side_m, cells: cells.max(1) }
    }

    /// A position of the planet frame in the local frame.
    pub fn local_m(&self, terrain: &Terrain, position_planet_m: DVec3) -> DVec3 {
        self.tangent.local(position_planet_m - self.origin_planet_m(terrain))
    }

    /// A local position in the planet frame.
    pub fn planet_m(&self, terrain: &Terrain, position_local_m: DVec3) -> DVec3 {
        self.origin_planet_m(terrain) + self.tangent.planet(position_local_m)
    }

    /// The column (to the east) and row (to the north) of the chunk under a direction.
    pub fn chunk_under(&self, terrain: &Terrain, dir_planet: DVec3) -> [i32; 2] {
        let around = self.tangent.local(super::points::unit(dir_planet));
        let flat = libm::hypot(around.x, around.y);
        // The inverse of the projection in `Tangent::direction`.
        let away_m = libm::atan2(flat, around.z) * terrain.planet().radius_m();
        let per_m = if flat > 0.0 { away_m / flat / self.side_m } else { 0.0 };
        [around.x, around.y].map(|along| (along * per_m).floor() as i32)
    }

    /// The chunk of a column and a row; the origin is the south west corner of `[0, 0]`. Neighbours share the vertices
    /// of their border to the bit. Vertices are evaluated on the calling thread.
    pub fn chunk(&self, terrain: &Terrain, [column, row]: [i32; 2], scratch: &mut Scratch) -> Chunk {
        let (cells, origin_m) = (self.cells.max(1), self.origin_planet_m(terrain));
        let side = cells as usize + 1;
        let spacing_rad = self.side_m / f64::from(cells) / terrain.planet().radius_m();
        // Counted from the origin, so that a vertex has one direction, whichever chunk asks.
        let along = |chunk: i32, vertex: usize| (f64::from(chunk) * f64::from(cells) + vertex as f64) * spacing_rad;
        let dirs: Vec<DVec3> =
            (0..side * side).map(|i| self.tangent.direction(along(column, i % side), along(row, i / side))).collect();
        let mut samples = vec![Sample::default(); dirs.len()];
        terrain.samples_spaced_into(&dirs, 0.0, Wanted::HEIGHT.and_normal(), &mut samples, scratch);
        let radius_m = terrain.planet().radius_m();
        let position = |(dir, sample): (&DVec3, &Sample)| {
            self.tangent.local(*dir * (radius_m + sample.height_m) - origin_m).as_vec3()
        };
        let corners = (0..cells as usize).flat_map(|row| (0..cells as usize).map(move |column| row * side + column));
        let halves = |first: usize| {
            let [south_west, south_east, north_west, north_east] =
                [first, first + 1, first + side, first + side + 1].map(|vertex| vertex as u32);
            [[south_west, south_east, north_west], [south_east, north_east, north_west]]
        };
        Chunk {
            positions_m: dirs.iter().zip(&samples).map(position).collect(),
            normals: samples.iter().map(|sample| self.tangent.local(sample.normal_planet).as_vec3()).collect(),
            heights_m: samples.iter().map(|sample| sample.height_m).collect(),
            triangles: corners.flat_map(halves).collect(),
        }
    }

    fn origin_planet_m(&self, terrain: &Terrain) -> DVec3 {
        self.tangent.up_planet * (terrain.planet().radius_m() + self.origin_height_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use crate::sphere::LatLon;

    fn grid() -> (Terrain, ChunkGrid) {
        let text = r#"(version: 3, name: "Islet", radius_km: 40.0,
            layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 12.0, octaves: 12))])"#;
        let terrain = Terrain::try_new(Planet::from_text("islet.ron", text).unwrap().into()).unwrap();
        let grid = ChunkGrid::on_ground(&terrain, LatLon::from_degrees(48.0, 16.0).direction(), 200.0, 16);
        (terrain, grid)
    }

    #[test]
    fn neighbours_meet_to_the_bit() {
        let (terrain, grid) = grid();
        let scratch = &mut Scratch::default();
        let mut chunk = |at| grid.chunk(&terrain, at, scratch);
        let (here, east, north) = (chunk([-3, 2]), chunk([-2, 2]), chunk([-3, 3]));
        for i in 0..17 {
            assert_eq!(here.positions_m[i * 17 + 16], east.positions_m[i * 17]);
            assert_eq!(here.normals[i * 17 + 16], east.normals[i * 17]);
            assert_eq!(here.positions_m[16 * 17 + i], north.positions_m[i]);
        }
        assert_eq!(here.triangles.len(), 2 * 16 * 16);
    }

    #[test]
    fn vertices_lie_on_the_ground_and_triangles_face_up() {
        let (terrain, grid) = grid();
        let chunk = grid.chunk(&terrain, [1, -1], &mut Scratch::default());
        for ((position, normal), height_m) in chunk.positions_m.iter().zip(&chunk.normals).zip(&chunk.heights_m) {
            let planet_m = grid.planet_m(&terrain, position.as_dvec3());
            // A float is a hundredth of a millimetre here.
            assert!((planet_m.length() - 40_000.0 - terrain.height_m(planet_m)).abs() < 1e-3);
            assert!((terrain.height_m(planet_m) - height_m).abs() < 1e-3);
            assert!(grid.tangent.local(terrain.sample(planet_m).normal_planet).as_vec3().dot(*normal) > 0.999);
            assert!(grid.local_m(&terrain, planet_m).distance(position.as_dvec3()) < 1e-6);
        }
        for triangle in &chunk.triangles {
            let [a, b, c] = triangle.map(|vertex| chunk.positions_m[vertex as usize]);
            assert!((b - a).cross(c - a).z > 0.0);
        }
        // The origin is on the ground.
        let first = grid.chunk(&terrain, [0, 0], &mut Scratch::default());
        assert!(first.positions_m[0].length() < 1e-6);
    }

    #[test]
    fn the_chunk_under_a_point_contains_it() {
        let (terrain, grid) = grid();
        for (east_m, north_m) in [(10.0, 10.0), (-10.0, 350.0), (1234.0, -777.0)] {
            let dir = grid.tangent.direction(east_m / 40_000.0, north_m / 40_000.0);
            let wanted = [(east_m / 200.0_f64).floor() as i32, (north_m / 200.0_f64).floor() as i32];
            assert_eq!(grid.chunk_under(&terrain, dir), wanted);
        }
        assert_eq!(grid.chunk_under(&terrain, grid.tangent.up_planet), [0, 0]);
    }
}
