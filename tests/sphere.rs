//! How evenly the cube mapping spreads its cells over the sphere, against the mappings it was chosen from. The figures stand
//! in the README's design notes.
#![allow(clippy::unwrap_used)]

use glam::DVec3;
use tellus::sphere::{Face, cube};

/// Cells along the side of a face, and how often a triangle of the icosphere is halved: about as many cells.
const SIDE: i32 = 128;
const HALVINGS: u32 = 6;

/// Over all cells: largest area over smallest, largest ratio of the two principal stretches of a cell, and longest over shortest
/// of those stretches (the spacing of vertices).
#[derive(Debug, PartialEq)]
struct Distortion {
    area: f64,
    stretch: f64,
    spacing: f64,
}

/// Of cells given by the images of two unit vectors at right angles.
fn distortion(cells: impl Iterator<Item = (DVec3, DVec3)>) -> Distortion {
    let (mut areas, mut stretch, mut spacings) = ((f64::MAX, 0.0_f64), 0.0_f64, (f64::MAX, 0.0_f64));
    for (a, b) in cells {
        // Principal stretches: square roots of the eigenvalues of the first fundamental form.
        let (e, f, g) = (a.length_squared(), a.dot(b), b.length_squared());
        let (mean, half) = (0.5 * (e + g), (0.25 * (e - g) * (e - g) + f * f).sqrt());
        let (least, most) = ((mean - half).sqrt(), (mean + half).sqrt());
        areas = (areas.0.min(least * most), areas.1.max(least * most));
        spacings = (spacings.0.min(least), spacings.1.max(most));
        stretch = stretch.max(most / least);
    }
    Distortion { area: areas.1 / areas.0, stretch, spacing: spacings.1 / spacings.0 }
}

/// Of a mapping from a face's square, -1..1, to the sphere.
fn of_cube(direction: impl Fn(f64, f64) -> DVec3) -> Distortion {
    // From edge to edge, where the extremes are; differences reach half a millionth to both sides, or to the inside.
    let at = |i: i32| f64::from(i) / f64::from(SIDE / 2) - 1.0;
    let step = 5e-7;
    distortion((0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| (at(i), at(j)))).map(|(s, t)| {
        let (s0, s1) = ((s - step).max(-1.0), (s + step).min(1.0));
        let (t0, t1) = ((t - step).max(-1.0), (t + step).min(1.0));
        let along_s = (direction(s1, t) - direction(s0, t)) / (s1 - s0);
        let along_t = (direction(s, t1) - direction(s, t0)) / (t1 - t0);
        (along_s, along_t)
    }))
}

/// The cube pushed out onto the sphere.
fn normalise(s: f64, t: f64) -> DVec3 {
    DVec3::new(1.0, s, t).normalize()
}

/// Nowell, Mapping a Cube to a Sphere (2005).
fn nowell(s: f64, t: f64) -> DVec3 {
    let bent = |a: f64, b: f64, c: f64| a * (1.0 - 0.5 * (b * b + c * c) + b * b * c * c / 3.0).sqrt();
    DVec3::new(bent(1.0, s, t), bent(s, 1.0, t), bent(t, 1.0, s))
}

/// One face of an icosahedron (all are alike), each edge halved again and again and pushed out onto the sphere.
fn icosphere() -> Distortion {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let corners = [DVec3::new(0.0, 1.0, golden), DVec3::new(golden, 0.0, 1.0), DVec3::new(0.0, -1.0, golden)];
    let mut triangles = vec![corners.map(DVec3::normalize)];
    for _ in 0..HALVINGS {
        let halve = |[a, b, c]: [DVec3; 3]| {
            let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(halve).collect();
    }
    // What an equilateral triangle is stretched by: the second vector from its base to its tip.
    let height = 0.75_f64.sqrt();
    distortion(triangles.into_iter().map(|[a, b, c]| (b - a, (c - 0.5 * (a + b)) / height)))
}

#[test]
fn our_mapping_spreads_its_cells_as_evenly_as_the_table_says() {
    let rounded = |d: Distortion| [d.area, d.stretch, d.spacing].map(|x| (x * 1000.0).round() / 1000.0);
    let table = [
        ("ours", rounded(of_cube(|s, t| cube::direction(Face::PosX, s, t))), [0.0, 0.0, 0.0]),
        ("normalise", rounded(of_cube(normalise)), [0.0, 0.0, 0.0]),
        ("Nowell", rounded(of_cube(nowell)), [0.0, 0.0, 0.0]),
        ("icosphere", rounded(icosphere()), [0.0, 0.0, 0.0]),
    ];
    for (name, measured, stated) in table {
        assert_eq!(measured, stated, "{name}: area, stretch, spacing");
    }
    let stretch = |i: usize| table[i].1[1];
    let _ = stretch;
}
