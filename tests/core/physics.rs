//! Chunks in a physics engine: parry finds the evaluator's ground, and the same contacts as the library does.

use parry3d::math::Vector;
use parry3d::query::{PointQuery as _, Ray, RayCast as _};
use parry3d::shape::TriMesh;
use tellus::glam::{DVec3, Vec3};
use tellus::planet::Planet;
use tellus::sphere::LatLon;
use tellus::terrain::{Capsule, ChunkGrid, Scratch, Terrain};

const CELLS: u32 = 64;
const SIDE_M: f64 = 128.0;

fn grid() -> (Terrain, ChunkGrid) {
    let text = r#"(version: 3, name: "Islet", radius_km: 40.0,
        layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 8.0, octaves: 8))])"#;
    let terrain = Terrain::try_new(Planet::from_text("islet.ron", text).unwrap().into()).unwrap();
    let grid = ChunkGrid::on_ground(&terrain, LatLon::from_degrees(-31.0, 77.0).direction(), SIDE_M, CELLS);
    (terrain, grid)
}

fn mesh(terrain: &Terrain, grid: &ChunkGrid, place: [i32; 2]) -> TriMesh {
    let chunk = grid.chunk(terrain, place, &mut Scratch::default());
    let vertices = chunk.positions_m.iter().map(|Vec3 { x, y, z }| Vector::new(*x, *y, *z)).collect();
    TriMesh::new(vertices, chunk.triangles).unwrap()
}

/// Places over a chunk, away from its border.
fn places() -> impl Iterator<Item = (f32, f32)> {
    (0..40_u16).map(|i| {
        let along = |step: u16| 20.0 + f32::from(i * step % 89);
        (along(7), along(31))
    })
}

#[test]
fn rays_and_balls_meet_the_ground_of_the_evaluator() {
    let (terrain, grid) = grid();
    let mesh = mesh(&terrain, &grid, [0, 0]);
    let mut deepest: f64 = 0.0;
    for (east, north) in places() {
        let ray = Ray::new(Vector::new(east, north, 500.0), Vector::new(0.0, 0.0, -1.0));
        let hit = ray.point_at(mesh.cast_local_ray(&ray, 1e4, true).unwrap());
        let hit_m = grid.planet_m(&terrain, DVec3::new(hit.x.into(), hit.y.into(), hit.z.into()));
        // The ground bends between vertices 2 m apart.
        let over_m = hit_m.length() - 40_000.0 - terrain.height_m(hit_m);
        assert!(over_m.abs() < 0.1, "{over_m}");
        deepest = deepest.max(over_m.abs());
        // A ball of 5 m over the ground.
        let center = hit + Vector::new(0.3, -0.4, 6.0);
        let found = mesh.project_local_point(center, false).point;
        let gap_m = f64::from((found - center).length()) - 5.0;
        let center_m = grid.planet_m(&terrain, DVec3::new(center.x.into(), center.y.into(), center.z.into()));
        let contact = terrain.contact(&Capsule::sphere(center_m, 5.0), 10.0).unwrap();
        assert!((contact.gap_m - gap_m).abs() < 0.1, "{} {gap_m}", contact.gap_m);
    }
    assert!(deepest > 1e-6, "a mesh of triangles is not the ground");
}

#[test]
fn no_ray_falls_through_the_border_of_two_chunks() {
    let (terrain, grid) = grid();
    let meshes = [mesh(&terrain, &grid, [0, 0]), mesh(&terrain, &grid, [1, 0])];
    // The border is the column of vertices that both have.
    let border = &meshes[0].vertices()[CELLS as usize..];
    for vertex in border.iter().step_by(CELLS as usize + 1).skip(1).take(CELLS as usize - 1) {
        for aside in [-1e-4, 0.0, 1e-4] {
            let ray = Ray::new(*vertex + Vector::new(aside, 0.7, 50.0), Vector::new(0.0, 0.0, -1.0));
            assert!(meshes.iter().any(|mesh| mesh.cast_local_ray(&ray, 1e3, true).is_some()), "{vertex:?} {aside}");
        }
    }
}
