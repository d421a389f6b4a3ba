//! Stems: trunks, stalks and tendrils as rods between level sections of their mesh.

use super::rod::Rod;
use glam::DVec3;

/// Heights of the sections.
const HEIGHTS: [f64; 10] = [-0.06, 0.012, 0.05, 0.13, 0.25, 0.38, 0.52, 0.66, 0.8, 0.94];
/// A stem ends where it is thinner than this share of its width at the second section above the ground.
const LEAST: f64 = 0.3;
/// The section that has the width of a stem.
const BASE: usize = 2;
/// A section whose points are farther from its middle than this multiple of the mean is not one of a single stem.
const ROUND: f64 = 1.9;
/// A stem that goes aside by more than this multiple of its rise is a bough from there on.
const ASIDE: f64 = 1.0;
/// A section that is wider than the one below by this factor is that of a curl.
const WIDER: f64 = 1.25;

/// Slices of a rod in which its deviation is measured.
const SLICES: usize = 4;

/// A level section: its middle and mean radius.
#[derive(Clone, Copy, Debug)]
struct Section {
    middle: DVec3,
    radius: f64,
}

/// The rods of a part of a mesh that rises from the ground: none if it has no round sections.
pub(super) fn rods(part: &[[DVec3; 3]]) -> Vec<Rod> {
    let lowest = part.iter().flatten().map(|corner| corner.z).fold(0.0, f64::min);
    let heights = HEIGHTS.iter().map(|height| height.max(0.9 * lowest));
    let sections: Vec<Section> = heights.map_while(|height| section(part, height)).collect();
    let base = sections.get(BASE).or(sections.last()).map_or(0.0, |section| section.radius);
    let is_trunk = |pair: &&[Section]| {
        let along = pair[1].middle - pair[0].middle;
        let is_stem = pair[1].radius > LEAST * base && pair[1].radius < WIDER * pair[0].radius;
        is_stem && along.truncate().length() < ASIDE * along.z
    };
    let rod = |pair: &[Section]| {
        let along = (pair[1].middle - pair[0].middle).normalize_or(DVec3::Z);
        // A level section of a leaning stem is wider than the stem, half as much in the mean.
        let slant = 0.5 * (1.0 + along.z);
        Rod { ends: [pair[0].middle, pair[1].middle], radius: 0.5 * slant * (pair[0].radius + pair[1].radius) }
    };
    sections.windows(2).take_while(is_trunk).map(rod).collect()
}

/// How far sections of a part between two heights lie from the surface of its rods, at most.
pub(super) fn deviation(part: &[[DVec3; 3]], rods: &[Rod]) -> f64 {
    let over = |point: &DVec3| rods.iter().map(|rod| rod.over(*point)).fold(f64::INFINITY, f64::min).abs();
    let shares = (0..rods.len() * SLICES).map(|slice| {
        let ends = rods[slice / SLICES].ends;
        ends[0].lerp(ends[1], (slice % SLICES) as f64 / SLICES as f64).z
    });
    let points = shares.filter(|height| *height >= 0.0).flat_map(|height| outline(part, height));
    points.map(|point| over(&point)).fold(0.0, f64::max)
}

/// The section of a part at a height; None if there is none, or it is not that of one stem.
fn section(part: &[[DVec3; 3]], height: f64) -> Option<Section> {
    let points = outline(part, height);
    if points.len() < 3 {
        return None;
    }
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let away = |point: &DVec3| point.distance(middle);
    let radius = points.iter().map(away).sum::<f64>() / points.len() as f64;
    (points.iter().map(away).fold(0.0, f64::max) < ROUND * radius).then_some(Section { middle, radius })
}

/// The points at a height on the edges of a part.
fn outline(part: &[[DVec3; 3]], height: f64) -> Vec<DVec3> {
    let mut points = Vec::new();
    for triangle in part {
        for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(from, to)| (triangle[from], triangle[to])) {
            // Each edge of a closed stem belongs to two triangles; one of them goes up along it.
            if from.z < height && to.z >= height {
                points.push(from.lerp(to, (height - from.z) / (to.z - from.z)));
            }
        }
    }
    points
}
