//! Tests of meshes of files as forms: levels that match, of trees and stones as an artist would make them.

use super::artist::MOST;
use super::{Form, mesh, meshes, sight};
use crate::planet::life::{FileMesh, ReadyPopulation};
use crate::planet::mesh::{MeshCorner, MeshFile, MeshNode};
use glam::{Vec2, Vec3};

/// The nearest mesh of a ready form as one of a file, 8 units high, in `parts` colours.
fn as_file(name: &str, seed: u32) -> Form {
    let near = mesh(&ReadyPopulation::named(name).unwrap().form, seed, 0);
    let corner = |v: &super::Vertex| MeshCorner {
        position: v.position * 8.0,
        normal: v.normal,
        color: Vec3::new(0.2, 0.3, 0.1) * (0.5 + v.position.z.max(0.0)),
        is_leaf: v.part > 0.5,
    };
    let triangles = near.triangles.iter().map(|triangle| triangle.map(u32::from)).collect();
    let corners = near.vertices.iter().map(corner).collect();
    let node = MeshNode { name: name.to_owned(), foot: Vec2::ZERO, corners, triangles };
    Form::Mesh(FileMesh { file: MeshFile::holding(vec![node]), ..FileMesh::default() })
}

#[test]
fn levels_of_files_cover_as_much_as_the_nearest() {
    // Bare branches have nothing that could grow or thin out.
    let most = |name: &str| if name == "Dead tree" { 0.2 } else { 0.08 };
    let names =
        ["Broadleaf tree", "Conifer", "Palm", "Shrub", "Dead tree", "Boulder", "Column cactus", "Crystals", "Grass"];
    for name in names {
        let form = as_file(name, 3);
        let all = meshes(&form, 3);
        let near = sight::look_from(&all[0], 8, 64);
        for (level, mesh) in all.iter().enumerate() {
            let count = mesh.triangles.len();
            assert!((4..=MOST[level]).contains(&count), "{name} level {level}: {count}");
            let top = mesh.vertices.iter().fold(0.0_f32, |top, v| top.max(v.position.z));
            assert!((top - 1.0).abs() < 1e-3, "{name} level {level}: {top}");
            for v in &mesh.vertices {
                assert!((v.normal.length() - 1.0).abs() < 1e-3 && v.position.z >= -0.1501, "{name} {level}: {v:?}");
                assert!([v.part, v.light, v.sway].iter().all(|share| (0.0..=1.0).contains(share)), "{v:?}");
            }
            let far = sight::look_from(mesh, 8, 64);
            let off = (far.cover / near.cover - 1.0).abs();
            assert!(off < most(name), "{name} level {level}: {near:?} {far:?}");
            assert!((far.part - near.part).abs() < 0.15, "{name} level {level}: {near:?} {far:?}");
            assert!((far.light - near.light).abs() < 0.15, "{name} level {level}: {near:?} {far:?}");
        }
    }
}

/// The mean of the factors on colours is 1 by area, so that all that knows two colours alone is right.
#[test]
fn factors_on_colours_have_the_mean_one() {
    let near = mesh(&as_file("Broadleaf tree", 3), 3, 0);
    let mut sums = [(Vec3::ZERO, 0.0_f32); 2];
    for triangle in &near.triangles {
        let [a, b, c] = triangle.map(|at| near.vertices[usize::from(at)]);
        let area = (b.position - a.position).cross(c.position - a.position).length();
        let (sum, whole) = &mut sums[usize::from(a.part > 0.5)];
        *sum += (a.tint + b.tint + c.tint) * (area / 3.0);
        *whole += area;
    }
    for (sum, whole) in sums {
        assert!((sum / whole).abs_diff_eq(Vec3::ONE, 0.01), "{}", sum / whole);
    }
}

#[test]
fn light_is_less_within_a_crown() {
    let near = mesh(&as_file("Broadleaf tree", 3), 3, 0);
    let mean = |of: &dyn Fn(&super::Vertex) -> bool| {
        let all: Vec<f32> = near.vertices.iter().filter(|v| of(v)).map(|v| v.light).collect();
        all.iter().sum::<f32>() / all.len() as f32
    };
    let (top, low) = (mean(&|v| v.position.z > 0.9), mean(&|v| v.part > 0.5 && v.position.z < 0.5));
    assert!(top > 0.8 && low < top - 0.1, "{top} {low}");
}
