//! How evenly the cube mapping spreads its cells over the sphere, against the mappings it was chosen from.

use glam::DVec3;
use tellus::sphere::{Face, cube};

/// Cells along the side of a face, and how often a triangle of the icosphere is halved: about as many cells.
const SIDE: i32 = 128;
const HALVINGS: u32 = 6;

/// Over all cells: largest area over smallest; worst and mean ratio of the two principal stretches of a cell; longest
/// over shortest of those stretches (the spacing of vertices).
struct Distortion {
    area: f64,
    worst_stretch: f64,
    mean_stretch: f64,
    spacing: f64,
}

/// The figures of cells given by the images of two unit vectors at right angles.
fn distortion(cells: impl Iterator<Item = (DVec3, DVec3)>) -> Distortion {
    let (mut areas, mut spacings) = ((f64::MAX, 0.0_f64), (f64::MAX, 0.0_f64));
    let (mut worst_stretch, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for (a, b) in cells {
        // Principal stretches: square roots of the eigenvalues of the first fundamental form.
        let (e, f, g) = (a.length_squared(), a.dot(b), b.length_squared());
        let (middle, half) = (0.5 * (e + g), (0.25 * (e - g) * (e - g) + f * f).sqrt());
        let (least, most) = ((middle - half).sqrt(), (middle + half).sqrt());
        areas = (areas.0.min(least * most), areas.1.max(least * most));
        spacings = (spacings.0.min(least), spacings.1.max(most));
        worst_stretch = worst_stretch.max(most / least);
        (sum, count) = (sum + most / least, count + 1.0);
    }
    Distortion { area: areas.1 / areas.0, worst_stretch, mean_stretch: sum / count, spacing: spacings.1 / spacings.0 }
}

/// The figures of a mapping from a face's square, -1..1, to the sphere.
fn of_cube(direction: impl Fn(f64, f64) -> DVec3) -> Distortion {
    // From edge to edge, where the extremes are. Differences reach half a millionth to both sides, or inwards at the
    // edge.
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

/// The cube projected onto the sphere.
fn normalise(s: f64, t: f64) -> DVec3 {
    DVec3::new(1.0, s, t).normalize()
}

/// Nowell, Mapping a Cube to a Sphere (2005).
fn nowell(s: f64, t: f64) -> DVec3 {
    let bent = |a: f64, b: f64, c: f64| a * (1.0 - 0.5 * (b * b + c * c) + b * b * c * c / 3.0).sqrt();
    DVec3::new(bent(1.0, s, t), bent(s, 1.0, t), bent(t, 1.0, s))
}

/// One face of an icosahedron (all are alike), its edges halved repeatedly and projected onto the sphere.
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
    // The stretch of an equilateral triangle: the second vector runs from its base to its tip.
    let height = 0.75_f64.sqrt();
    distortion(triangles.into_iter().map(|[a, b, c]| (b - a, (c - 0.5 * (a + b)) / height)))
}

#[test]
fn the_mappings_distort_as_much_as_the_table_says() {
    let table = [
        ("ours", of_cube(|s, t| cube::direction(Face::PosX, s, t)), [1.268, 1.732, 1.277, 1.901]),
        ("normalise", of_cube(normalise), [5.196, 1.732, 1.285, 3.0]),
        ("Nowell", of_cube(nowell), [1.333, 1.732, 1.241, 2.0]),
        ("icosphere", icosphere(), [1.300, 1.258, 1.152, 1.279]),
    ];
    for (name, measured, stated) in table {
        let Distortion { area, worst_stretch, mean_stretch, spacing } = measured;
        let measured = [area, worst_stretch, mean_stretch, spacing].map(|x| (x * 1000.0).round() / 1000.0);
        assert_eq!(measured, stated, "{name}: area, worst stretch, mean stretch, spacing");
    }
}
