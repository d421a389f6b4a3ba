//! Tufts of grass, reeds and ferns: blades that rise from one foot.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf, Rib};
use super::math::{GOLDEN, around, mix, pow, sin, turn};
use super::random::Random;
use crate::planet::life::Tuft;
use glam::Vec3;

/// Blade's middle line.
struct Stem {
    points: Vec<Vec3>,
    side: Vec3,
    head: bool,
}

/// Mesh of a tuft.
pub(super) fn build(form: &Tuft, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let budget: usize = detail.pick([120, 40, 12, 4]);
    let count = (form.blades as usize).min(detail.pick([40, 13, 12, 4]));
    let merged = form.blades as f32 / count as f32;
    let each = budget / count.max(1);
    for i in 0..count {
        let head = (i as f32 + 0.5) * form.head as f32 % 1.0 + form.head as f32 >= 1.0 && form.head > 0.0;
        let cost = usize::from(head && each >= 3) * 2;
        // A strip of k segments takes 2 k - 1 triangles.
        let room = each - cost;
        let segments = if form.leaflets { 1 } else { room.div_ceil(2).clamp(1, 4) };
        let segments = if 2 * segments - 1 > room { segments - 1 } else { segments }.max(1);
        let stem = stem(form, detail, i, count, segments.max(if form.leaflets { 6 } else { 1 }), head);
        let width = form.width as f32 * detail.fill * merged;
        if form.leaflets && each < 3 {
            half_frond(&mut mesh, &stem, width * if i % 2 == 0 { 1.0 } else { -1.0 });
        } else if form.leaflets {
            frond(&mut mesh, &stem, each, width, form.width as f32 / 0.05);
        } else {
            blade(&mut mesh, &stem, segments, width);
            if cost > 0 {
                seeds(&mut mesh, &stem, detail);
            }
        }
    }
    mesh
}

/// Middle line of a blade.
fn stem(form: &Tuft, detail: &Detail, index: usize, count: usize, segments: usize, head: bool) -> Stem {
    let mut random = Random::new(detail.seed, 10 + index as u32);
    let share = (index as f32 + 0.5) / count as f32;
    let out = around(index as f32 * GOLDEN + random.signed() * 0.5);
    let (spread, arch) = (form.spread as f32, form.arch as f32);
    // Inner blades stand up and are long; outer ones lean out.
    let lean = spread * mix(0.1, 1.15, pow(share, 0.8)) * random.range(0.75, 1.15);
    let curl = arch * mix(0.5, 1.5, share) * random.range(0.7, 1.2);
    let length = mix(1.0, 0.72, share) * random.range(0.78, 1.05) * if head { 1.12 } else { 1.0 };
    let length = if index == 0 { 1.08 } else { length };
    let side = turn(Vec3::Z.cross(out), Vec3::Z, random.signed() * 0.5);
    let mut at = out * (0.05 + 0.06 * spread) * pow(share, 0.5) * random.range(0.4, 1.3) - Vec3::Z * 0.03;
    let mut points = vec![at];
    for k in 0..segments {
        let s = (k as f32 + 0.5) / segments as f32;
        let angle = (lean + curl * 1.3 * s * s * if head { 0.4 } else { 1.0 }).min(2.3);
        at += turn(Vec3::Z, Vec3::Z.cross(out), angle) * (length / segments as f32);
        at.z = at.z.max(-0.03);
        points.push(at);
    }
    Stem { points, side, head }
}

/// Look at a share of a blade's length.
fn look(s: f32) -> Look {
    Look { part: mix(0.45, 1.0, pow(s, 0.6)), light: mix(0.42, 1.0, pow(s, 0.8)), sway: pow(s, 1.4) }
}

/// Normal of a blade: mostly up and outward, so that a meadow is lit softly.
fn normal(at: Vec3) -> Vec3 {
    Vec3::new(at.x, at.y, 0.0) * 0.9 + Vec3::Z * 0.8
}

/// Strip with `segments` segments.
fn blade(mesh: &mut Mesh, stem: &Stem, segments: usize, width: f32) {
    let last = stem.points.len() - 1;
    let rib = |i: usize| {
        let s = i as f32 / segments as f32;
        let at = stem.points[(i * last / segments).min(last)];
        let thin = if stem.head { 0.55 } else { 1.0 };
        let half = stem.side * (width * 0.5 * thin * (1.0 - 0.75 * s * s));
        Rib { at, half, normal: normal(at), look: look(s) }
    };
    leaf::blade(mesh, &(0..=segments).map(rib).collect::<Vec<_>>());
}

/// Seed head at the top of a blade.
fn seeds(mesh: &mut Mesh, stem: &Stem, detail: &Detail) {
    let [.., before, tip] = stem.points[..] else { return };
    let along = (tip - before).normalize_or(Vec3::Z);
    let look = Look { part: 0.0, light: 0.95, sway: 1.0 };
    let width = 0.045 * detail.swell();
    let across = turn(stem.side, along, 0.8);
    let at = tip - along * 0.17;
    let one = Leaf { at, along, across, length: 0.22, width, normal: normal(tip) + Vec3::Z * 0.3, look, tip: look };
    leaf::pair(mesh, &one, 0.3);
}

/// Far fern frond: one triangle from the foot over a broad side to the tip.
fn half_frond(mesh: &mut Mesh, stem: &Stem, width: f32) {
    let last = stem.points.len() - 1;
    let corner = |mesh: &mut Mesh, i: usize, aside: f32| {
        let at = stem.points[i] + stem.side * aside;
        mesh.vertex(at, normal(at), look(i as f32 / last as f32))
    };
    let [a, b, c] = [(0, 0.0), (last / 2, width * 1.5), (last, 0.0)].map(|(i, aside)| corner(mesh, i, aside));
    mesh.triangle(a, b, c);
}

/// Fern frond: a strip's worth of leaflets to both sides, longest below the middle.
fn frond(mesh: &mut Mesh, stem: &Stem, count: usize, width: f32, broad: f32) {
    let last = stem.points.len() - 1;
    let at = |s: f32| {
        let place = s.clamp(0.0, 1.0) * last as f32;
        let i = (place as usize).min(last - 1);
        let (a, b) = (stem.points[i], stem.points[i + 1]);
        (a + (b - a) * (place - i as f32), (b - a).normalize_or(Vec3::Z))
    };
    // One triangle is the stalk with the tip.
    let stalk = |s: f32, half: f32| Rib { at: at(s).0, half: stem.side * half, normal: normal(at(s).0), look: look(s) };
    leaf::blade(mesh, &[stalk(0.0, 0.008), stalk(1.0, 0.0)]);
    let pairs = (count - 1) / 2;
    for k in 0..pairs {
        let s = mix(0.14, 0.95, (k as f32 + 0.5) / pairs.max(1) as f32);
        let (place, along) = at(s);
        let long = 0.2 * broad.clamp(0.4, 2.5) * (0.15 + 0.85 * pow(sin(3.1 * mix(0.13, 0.93, s)), 0.9));
        for hand in [-1.0_f32, 1.0] {
            let way = (stem.side * hand + along * mix(0.25, 1.5, s * s) - Vec3::Z * 0.12).normalize_or(along);
            let up = stem.side.cross(along);
            let up = if up.z < 0.0 { -up } else { up };
            let across = (along - way * along.dot(way)).normalize_or(along);
            let girth = (width * 2.4).clamp(0.02, 1.15 / pairs.max(1) as f32);
            let (look, tip) = (look(s * 0.9), look((s + 0.15).min(1.0)));
            let one =
                Leaf { at: place, along: way, across, length: long, width: girth, normal: up + Vec3::Z, look, tip };
            leaf::triangle(mesh, &one, 0.0);
        }
    }
}
