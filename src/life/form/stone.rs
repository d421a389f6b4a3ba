//! Stones: blocks cut by planes, with ledges and a rough skin.

use super::build::{Detail, Look, Mesh, SUNK};
use super::math::{GOLDEN, around, mix, pow, smooth};
use super::random::{Random, noise};
use super::sphere;
use crate::planet::life::Stone;
use glam::{Vec2, Vec3};

/// Plane that cuts the block: unit normal and distance from the middle.
#[derive(Clone, Copy, Debug)]
struct Cut {
    normal: Vec3,
    distance: f32,
}

/// Block before its mesh: everything that its shape depends on.
struct Block<'a> {
    form: &'a Stone,
    cuts: Vec<Cut>,
    axes: Vec3,
    heading: Vec3,
    seed: u32,
}

impl<'a> Block<'a> {
    /// Block of a seed.
    fn new(form: &'a Stone, seed: u32) -> Self {
        let mut random = Random::new(seed, 1);
        let count = form.cuts as f32;
        let spin = random.range(0.0, 7.0);
        // Few cuts go deep, many leave a body of facets.
        let deep = mix(0.5, 0.8, smooth(2.0, 14.0, count));
        let cuts = (0..form.cuts)
            .map(|i| {
                let z = 1.0 - 1.7 * (i as f32 + 0.5) / count;
                let ring = around(spin + i as f32 * GOLDEN) * (1.0 - z * z).max(0.0).sqrt();
                let normal = (ring + Vec3::Z * z + random.ball() * 0.45).normalize_or(Vec3::Z);
                Cut { normal, distance: random.range(deep, 0.92) }
            })
            .collect();
        let wide = (form.stretch as f32).sqrt();
        let axes = Vec3::new(wide, 1.0 / wide, mix(0.95, 0.3, form.flatness as f32)) * random.range(0.95, 1.05);
        Self { form, cuts, axes, heading: around(random.range(0.0, 7.0)), seed }
    }

    /// Direction moved onto the edge between the two nearest cuts, where it is close to one.
    fn snapped(&self, way: Vec3, near: f32) -> Vec3 {
        let mut hits: Vec<(f32, &Cut)> = self.cuts.iter().map(|c| (hit_at(c, way), c)).collect();
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [(first, a), (second, b), ..] = hits[..] else { return way };
        if second > 1.15 || first > 1.1 {
            return way;
        }
        let edge = (a.normal * b.distance - b.normal * a.distance).normalize_or_zero();
        let off = edge.dot(way);
        if off.abs() >= near {
            return way;
        }
        // Near a corner of three cuts, the edge may be hidden by the third.
        let moved = (way - edge * off).normalize_or(way);
        let hidden = hits.iter().any(|(_, c)| hit_at(c, moved) < hit_at(a, moved) * 0.985);
        if hidden { way } else { moved }
    }

    /// Place of the skin in a direction, in a frame whose middle is the block's.
    fn skin(&self, way: Vec3) -> Vec3 {
        let round = self.form.roundness as f32;
        let soft = mix(0.004, 0.25, round * (0.4 + 0.6 * round));
        // A broken block is bounded by its cuts, a pebble by a ball.
        let room = 1.0 + 0.2 * (1.0 - round) * smooth(5.0, 10.0, self.cuts.len() as f32);
        let mut reach = room + 0.1 * noise(way * 1.3 + Vec3::splat(9.0), self.seed);
        // The stone rests on a flat side.
        if way.z < -0.05 {
            reach = soft_least(reach, 0.62 / -way.z, 0.12);
        }
        for cut in &self.cuts {
            let facing = cut.normal.dot(way);
            if facing > 0.05 {
                reach = soft_least(reach, cut.distance / facing, soft);
            }
        }
        let rough = self.form.roughness as f32;
        let wave = noise(way * 2.6, self.seed ^ 1) * 0.09 + noise(way * 5.5, self.seed ^ 2) * 0.045;
        let grain = noise(way * 12.0, self.seed ^ 3) * 0.022 * (1.0 - 0.7 * round);
        let place = way * (reach * (1.0 + rough * (wave + grain))) * self.axes;
        let heading = Vec2::new(self.heading.x, self.heading.y);
        let flat = heading.rotate(place.truncate()) * self.ledge(place.z / self.axes.z);
        flat.extend(place.z)
    }

    /// Factor on the width at a height, from layers that weather back by different amounts.
    fn ledge(&self, z: f32) -> f32 {
        let layers = self.form.layers as f32;
        let place = z * 3.6 + 20.0;
        let index = place.floor();
        let own = |i: f32| noise(Vec3::new(i * 7.31, 0.5, 0.5), self.seed ^ 77);
        let step = smooth(0.72, 1.0, place - index);
        1.0 + layers * 0.2 * mix(own(index), own(index + 1.0), step)
    }

    /// Mix of the colours: patches, bands of the layers, and dust on top.
    fn part(&self, way: Vec3) -> f32 {
        let patch = smooth(-0.1, 0.7, noise(way * 2.1, self.seed ^ 31) + 0.4 * noise(way * 7.0, self.seed ^ 32));
        let band = self.form.layers as f32 * (0.5 + 0.5 * noise(Vec3::new(way.z * 5.5, 0.3, 0.7), self.seed ^ 33));
        (0.55 * patch + 0.6 * band).min(1.0)
    }
}

/// Distance from the middle to a cut in a direction.
fn hit_at(cut: &Cut, way: Vec3) -> f32 {
    let facing = cut.normal.dot(way);
    if facing > 0.05 { cut.distance / facing } else { f32::MAX }
}

/// Lesser of two numbers, rounded where they are close.
fn soft_least(a: f32, b: f32, soft: f32) -> f32 {
    let h = (0.5 + 0.5 * (b - a) / soft).clamp(0.0, 1.0);
    mix(b, a, h) - soft * h * (1.0 - h)
}

/// Mesh of a stone.
pub(super) fn build(form: &Stone, detail: &Detail) -> Mesh {
    let block = Block::new(form, detail.seed);
    let frequency = detail.pick([14, 5, 2, 1]);
    let ball = sphere::sphere(frequency);
    let near = if form.roundness < 0.4 { 0.6 / frequency as f32 } else { 0.0 };
    let ways: Vec<Vec3> = ball.corners.iter().map(|&c| block.snapped(c, near)).collect();
    let points: Vec<Vec3> = ways.iter().map(|&w| block.skin(w)).collect();
    let low = points.iter().fold(f32::MAX, |z, p| z.min(p.z));
    let high = points.iter().fold(f32::MIN, |z, p| z.max(p.z));
    let tall = (high - low).max(0.05);
    // The stone stands so deep that its lowest part is in the ground.
    let lift = -low - tall * SUNK / (1.0 + SUNK);
    let mut mesh = Mesh::default();
    let swell = detail.swell();
    for (way, p) in ways.iter().zip(&points) {
        let z = (p.z + lift) / tall;
        let hollow = (p / block.axes).length() - 0.82;
        let open = mix(0.42, 1.0, pow(smooth(-0.12, 0.75, z), 0.8));
        let light = open * (0.92 + 0.5 * hollow.clamp(-0.4, 0.2)) * (0.88 + 0.12 * way.z);
        // The far level stands on its lower ring of corners.
        let low = detail.level == 3 && way.z < -0.2;
        let z = if low { -tall * SUNK / (1.0 + SUNK) } else { p.z + lift };
        let wide = if low { 0.92 * swell } else { swell };
        let at = Vec3::new(p.x * wide, p.y * wide, z);
        mesh.vertex(at, *way, Look { part: block.part(*way), light, sway: 0.0 });
    }
    mesh.triangles = ball.triangles;
    let crease = mix(0.86, -1.0, smooth(0.25, 0.75, form.roundness as f32));
    mesh.crease(detail.pick([crease, crease.min(0.72), crease.min(0.7), crease.min(0.6)]))
}
