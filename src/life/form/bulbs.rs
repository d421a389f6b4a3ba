//! Bulb stalks: strange plants whose curved stalks carry spheres of falling size.

use super::build::{Detail, Look, Mesh};
use super::math::{GOLDEN, TURN, around, mix, pow, turn};
use super::random::Random;
use super::sphere;
use super::tube::{self, Knot};
use crate::planet::life::Bulbs;
use glam::Vec3;

/// Sphere on a stalk.
#[derive(Clone, Copy, Debug)]
struct Bead {
    at: Vec3,
    radius: f32,
    /// Share of the way from the stalk's foot.
    share: f32,
}

/// Middle line of a stalk, in even steps.
fn stalk(form: &Bulbs, index: u32, seed: u32) -> Vec<Vec3> {
    let mut random = Random::new(seed, 20 + index);
    let out = around(index as f32 * GOLDEN + random.signed() * 0.4);
    let share = index as f32 / form.stalks as f32;
    let length = if index == 0 { 1.0 } else { random.range(0.5, 0.92) };
    let lean = mix(0.05, 0.75, share) * random.range(0.7, 1.1);
    let curl = form.curl as f32;
    let side = Vec3::Z.cross(out);
    let steps = 24;
    let mut at = out * (0.04 + 0.1 * share) - Vec3::Z * 0.06;
    let mut points = vec![at];
    let drift = random.signed() * curl * 1.2;
    for k in 0..steps {
        let s = (k as f32 + 0.5) / steps as f32;
        // The stalk leans out, rises again, and nods at its end.
        let angle = lean * (1.0 - 1.1 * s) + curl * (2.2 * pow(s, 3.0) - 0.5 * s);
        let way = turn(turn(Vec3::Z, side, angle), Vec3::Z, drift * s);
        at += way * (length / steps as f32);
        points.push(at);
    }
    points
}

/// Spheres of a stalk.
fn beads(form: &Bulbs, points: &[Vec3], index: u32, seed: u32) -> Vec<Bead> {
    let mut random = Random::new(seed, 60 + index);
    let size = form.size as f32 * 0.5 * if index == 0 { 1.0 } else { random.range(0.6, 0.95) };
    let count = form.spheres.max(1) as f32;
    let low = if form.spheres == 1 { 1.0 } else { 0.3 };
    (0..form.spheres)
        .map(|i| {
            let s = (i as f32 + 0.5 * low) / (count - 1.0 + 0.5 * low).max(0.5);
            let share = mix(low, 1.0, pow(s.min(1.0), 0.8));
            let place = share * (points.len() - 1) as f32;
            let i0 = (place as usize).min(points.len() - 2);
            let at = points[i0] + (points[i0 + 1] - points[i0]) * (place - i0 as f32);
            let radius = size * mix(1.0, 0.12, form.fall as f32 * s.min(1.0)) * random.range(0.88, 1.06);
            // Spheres sit on alternate sides of the stalk.
            let off = around(i as f32 * GOLDEN) * (radius * 0.45 * (1.0 - s).max(0.0));
            Bead { at: at + off, radius, share }
        })
        .collect()
}

/// Mesh of a group of bulb stalks.
pub(super) fn build(form: &Bulbs, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let stalks = form.stalks.min(detail.pick([9, 9, 7, 4]));
    if detail.level == 3 {
        (0..stalks).for_each(|i| spindle(&mut mesh, form, detail, i));
        return mesh;
    }
    let mut all = Vec::new();
    for i in 0..stalks {
        let points = stalk(form, i, detail.seed);
        let rings = detail.pick([12, 4, 2, 2]);
        let knot = |k: usize| {
            let s = k as f32 / rings as f32;
            let at = points[k * (points.len() - 1) / rings];
            let look = Look { part: 0.25 * s, light: mix(0.5, 0.85, s), sway: pow(s, 1.5) * 0.8 };
            Knot { at, radius: form.size as f32 * 0.11 * (1.0 - 0.8 * s) * detail.swell(), look }
        };
        let knots: Vec<Knot> = (0..=rings).map(knot).collect();
        tube::tube(&mut mesh, &knots, detail.pick([6, 4, 3, 3]));
        all.extend(beads(form, &points, i, detail.seed));
    }
    all.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    let budget = detail.pick([3990, 695, 138, 28]) - mesh.triangles.len();
    let kinds: &[usize] =
        detail.pick([&[8, 20, 80, 180, 320], &[8, 20, 80, 80, 80], &[6, 8, 20, 20, 20], &[6, 8, 8, 8, 8]]);
    let mut sizes = vec![0; all.len()];
    let mut left = budget;
    // The largest spheres are refined first, one step at a time.
    for (step, &cost) in kinds.iter().enumerate() {
        let before = if step == 0 { 0 } else { kinds[step - 1] };
        for size in &mut sizes {
            let more = cost - before.min(cost);
            if *size == before && more <= left {
                left -= more;
                *size = cost;
            }
        }
    }
    for (one, &size) in all.iter().zip(&sizes) {
        let start = mesh.vertices.len();
        bead(&mut mesh, one, size, detail.swell());
        detail.flatten_part(&mut mesh, start, one.at);
    }
    mesh
}

/// Far level: a stalk with its spheres as one spindle of six triangles.
fn spindle(mesh: &mut Mesh, form: &Bulbs, detail: &Detail, index: u32) {
    let points = stalk(form, index, detail.seed);
    let beads = beads(form, &points, index, detail.seed);
    let radius = beads.iter().fold(0.0_f32, |r, b| r.max(b.radius)) * 1.4 * detail.swell();
    let belly = points[points.len() * 2 / 5];
    let look = |part: f32, light: f32, sway: f32| Look { part, light, sway };
    let foot = mesh.vertex(points[0], -Vec3::Z, look(0.1, 0.5, 0.0));
    let tip = mesh.vertex(points[points.len() - 1], Vec3::Z, look(0.9, 1.0, 0.8));
    let ring = [0, 1, 2].map(|s| {
        let out = around(TURN * s as f32 / 3.0 + index as f32);
        mesh.vertex(belly + out * radius, out, look(0.75, 0.75, 0.3))
    });
    for s in 0..3 {
        let n = (s + 1) % 3;
        mesh.triangle(ring[s], ring[n], tip);
        mesh.triangle(ring[n], ring[s], foot);
    }
}

/// Sphere in a number of triangles.
fn bead(mesh: &mut Mesh, one: &Bead, size: usize, swell: f32) {
    let radius = one.radius * swell;
    let look = |way: Vec3| {
        let light = mix(0.45, 1.0, 0.5 + 0.5 * way.z) * mix(0.75, 1.0, one.share);
        Look { part: 0.62 + 0.38 * way.z.max(-0.6), light, sway: pow(one.share, 1.5) * 0.8 }
    };
    let corner = |mesh: &mut Mesh, way: Vec3| mesh.vertex(one.at + way * radius, way, look(way));
    if size >= 20 {
        let ball = sphere::sphere((size as f32 / 20.0).sqrt() as usize);
        let index: Vec<u16> = ball.corners.iter().map(|&w| corner(mesh, w)).collect();
        ball.triangles.iter().for_each(|t| {
            let [a, b, c] = t.map(|i| index[i as usize]);
            mesh.triangle(a, b, c);
        });
    } else if size >= 6 {
        let sides = size / 2;
        let (top, foot) = (corner(mesh, Vec3::Z), corner(mesh, -Vec3::Z));
        let ring: Vec<u16> = (0..sides).map(|s| corner(mesh, around(TURN * s as f32 / sides as f32))).collect();
        for s in 0..sides {
            let n = (s + 1) % sides;
            mesh.triangle(ring[s], ring[n], top);
            mesh.triangle(ring[n], ring[s], foot);
        }
    }
}
