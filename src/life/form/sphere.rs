//! Spheres of triangles: icosahedra whose faces are divided evenly.

use glam::Vec3;

/// Unit sphere: directions and triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Sphere {
    /// Unit vectors to the corners.
    pub corners: Vec<Vec3>,
    /// Triples of corners, counter-clockwise from outside.
    pub triangles: Vec<[u16; 3]>,
}

/// Corners of an icosahedron that stands on a corner.
fn icosahedron() -> ([Vec3; 12], [[usize; 3]; 20]) {
    let (h, r) = (0.447_213_6, 0.894_427_2);
    let mut corners = [Vec3::Z; 12];
    corners[11] = -Vec3::Z;
    for i in 0..5 {
        let angle = super::math::TURN * i as f32 / 5.0;
        let half = super::math::TURN * 0.1;
        corners[1 + i] = super::math::around(angle) * r + Vec3::Z * h;
        corners[6 + i] = super::math::around(angle + half) * r - Vec3::Z * h;
    }
    let mut faces = [[0; 3]; 20];
    for i in 0..5 {
        let n = (i + 1) % 5;
        faces[i] = [0, 1 + i, 1 + n];
        faces[5 + i] = [1 + i, 6 + i, 1 + n];
        faces[10 + i] = [1 + n, 6 + i, 6 + n];
        faces[15 + i] = [11, 6 + n, 6 + i];
    }
    (corners, faces)
}

/// Sphere with 20 x `frequency`^2 triangles and shared corners.
pub(super) fn sphere(frequency: usize) -> Sphere {
    let n = frequency.max(1);
    let (corners, faces) = icosahedron();
    let mut out = Sphere::default();
    // Corners on edges are found again by their exact key: the two ends and the step between them.
    let mut known: std::collections::BTreeMap<[[usize; 2]; 3], u16> = std::collections::BTreeMap::new();
    for face in faces {
        let mut index = |out: &mut Sphere, i: usize, j: usize| -> u16 {
            let mut key = [(face[0], n - i - j), (face[1], i), (face[2], j)];
            key.sort_unstable();
            // Corners of weight 0 do not count.
            let mut parts = key.map(|(c, w)| if w == 0 { [usize::MAX, 0] } else { [c, w] });
            parts.sort_unstable();
            *known.entry(parts).or_insert_with(|| {
                let sum: Vec3 = key.iter().map(|&(c, w)| corners[c] * w as f32).sum();
                out.corners.push(sum.normalize_or(Vec3::Z));
                (out.corners.len() - 1) as u16
            })
        };
        for i in 0..n {
            for j in 0..n - i {
                let (a, b, c) = (index(&mut out, i, j), index(&mut out, i + 1, j), index(&mut out, i, j + 1));
                out.triangles.push([a, b, c]);
                if i + j + 1 < n {
                    let d = index(&mut out, i + 1, j + 1);
                    out.triangles.push([b, d, c]);
                }
            }
        }
    }
    out
}
