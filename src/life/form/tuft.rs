//! Tufts of grass, reeds and ferns: blades that rise from one foot.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf, Rib};
use super::math::{GOLDEN, around, mix, pow, sin, turn};
use super::random::Random;
use crate::planet::life::Tuft;
use glam::Vec3;

/// Triangles of the nearest level, at most.
const NEAR: usize = 400;

/// Blade's middle line.
struct Stem {
    points: Vec<Vec3>,
    side: Vec3,
    /// Turn of the blade about its line, from foot to tip.
    twist: f32,
    head: bool,
}

/// Mesh of a tuft.
pub(super) fn build(form: &Tuft, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let budget: usize = detail.pick([NEAR, 40, 12, 4]);
    let count = (form.blades as usize).min(detail.pick([40, 13, 12, 4]));
    let merged = form.blades as f32 / count as f32;
    let near = detail.level == 0;
    // Near by some triangles are left for short blades around the foot.
    let each = if near && !form.leaflets { (budget * 2 / 3 / count.max(1)).min(16) } else { budget / count.max(1) };
    for i in 0..count {
        let head = (i as f32 + 0.5) * form.head as f32 % 1.0 + form.head as f32 >= 1.0 && form.head > 0.0;
        let cost = if head && each >= 3 { if near { each.min(8) - 2 } else { 2 } } else { 0 };
        // A strip of k segments takes 2 k - 1 triangles.
        let room = each - cost;
        let segments = if form.leaflets { 1 } else { room.div_ceil(2).clamp(1, 5) };
        let segments = if 2 * segments - 1 > room { segments - 1 } else { segments }.max(1);
        let points = if form.leaflets { detail.pick([12, 12, 6, 6]) } else { segments };
        let stem = stem(form, detail, i, count, points, head);
        let width = form.width as f32 * detail.fill * merged;
        if form.leaflets && each < 3 {
            half_frond(&mut mesh, &stem, detail, width * if i % 2 == 0 { 1.0 } else { -1.0 });
        } else if form.leaflets && !near {
            far_frond(&mut mesh, &stem, detail, width);
        } else if form.leaflets {
            let mut random = Random::new(detail.seed, 400 + i as u32);
            frond(&mut mesh, &stem, each.min(61), form.width as f32 / 0.05, &mut random);
        } else {
            blade(&mut mesh, &stem, segments, width);
            if cost > 0 && near {
                spike(&mut mesh, &stem, cost, detail);
            } else if cost > 0 {
                seeds(&mut mesh, &stem, detail);
            }
        }
    }
    if near && !form.leaflets {
        undergrowth(&mut mesh, form, detail);
    }
    mesh
}

/// Short thin blades around the foot, in the triangles that are left.
fn undergrowth(mesh: &mut Mesh, form: &Tuft, detail: &Detail) {
    let left = NEAR.saturating_sub(mesh.triangles.len()) / 3;
    let count = left.min(form.blades as usize * 3 / 2);
    for i in 0..count {
        let mut stem = stem(form, detail, 100 + i, count, 2, false);
        let mut random = Random::new(detail.seed, 300 + i as u32);
        let short = random.range(0.3, 0.75);
        stem.points.iter_mut().for_each(|p| *p *= Vec3::new(short.max(0.5), short.max(0.5), short));
        blade(mesh, &stem, 2, form.width as f32 * random.range(0.5, 0.9));
    }
}

/// Middle line of a blade.
fn stem(form: &Tuft, detail: &Detail, index: usize, count: usize, segments: usize, head: bool) -> Stem {
    let mut random = Random::new(detail.seed, 10 + index as u32);
    let share = (index % 100) as f32 / count as f32 + 0.5 / count as f32;
    let out = around(index as f32 * GOLDEN + random.signed() * 0.5);
    let (spread, arch) = (form.spread as f32, form.arch as f32);
    // Inner blades stand up and are long; outer ones lean out.
    let lean = spread * mix(0.1, 1.15, pow(share, 0.8)) * random.range(0.75, 1.15);
    let curl = arch * mix(0.5, 1.5, share) * random.range(0.7, 1.2);
    // Fronds rise and then bend over.
    let (lean, curl) =
        if form.leaflets { (lean * 0.62 + 0.08 * spread, curl * 0.8 + 0.35 * arch) } else { (lean, curl) };
    let length = mix(1.0, 0.75, share)
        * random.range(if form.leaflets { 0.78 } else { 0.62 }, 1.06)
        * if head { 1.12 } else { 1.0 };
    let length = if index == 0 && !form.leaflets { 1.08 } else { length };
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
    Stem { points, side, twist: random.signed() * 0.9, head }
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
        // Blades are narrow at the foot, taper to the tip and turn a little.
        let along = (at - stem.points[(i.max(1) - 1) * last / segments]).normalize_or(Vec3::Z);
        let broad = mix(0.72, 1.12, (s * 4.0).min(1.0)) * (1.0 - 0.8 * s * s);
        let half = turn(stem.side, along, stem.twist * s) * (width * 0.5 * thin * broad);
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
fn half_frond(mesh: &mut Mesh, stem: &Stem, detail: &Detail, width: f32) {
    let last = stem.points.len() - 1;
    let corner = |mesh: &mut Mesh, i: usize, aside: f32| {
        let at = stem.points[i] + detail.flatten(stem.side * aside - Vec3::Z * (0.3 * aside.abs()));
        mesh.vertex(at, normal(at), look(i as f32 / last as f32))
    };
    let [a, b, c] = [(0, 0.0), (last / 2, width * 1.5), (last, 0.0)].map(|(i, aside)| corner(mesh, i, aside));
    mesh.triangle(a, b, c);
}

/// Seed head near by: a loose spike of small ears around the top of a blade, one triangle each.
fn spike(mesh: &mut Mesh, stem: &Stem, count: usize, detail: &Detail) {
    let [.., before, tip] = stem.points[..] else { return };
    let along = (tip - before).normalize_or(Vec3::Z);
    let look = Look { part: 0.0, light: 0.8, sway: 1.0 };
    for k in 0..count {
        let share = k as f32 / count as f32;
        let across = turn(stem.side, along, k as f32 * GOLDEN);
        let way = (along + across * mix(0.32, 0.1, share)).normalize_or(along);
        let one = Leaf {
            at: tip - along * mix(0.16, 0.02, share),
            along: way,
            across: turn(across, along, 1.4),
            length: 0.085,
            width: 0.03 * detail.swell(),
            normal: normal(tip) + across * 0.6,
            look,
            tip: Look { light: 1.0, ..look },
        };
        leaf::triangle(mesh, &one, 0.2);
    }
}

/// Fern frond farther away: three arrowheads along the midrib, whose wings stand for the leaflets.
fn far_frond(mesh: &mut Mesh, stem: &Stem, detail: &Detail, width: f32) {
    let last = stem.points.len() - 1;
    let mut corner = |share: f32, aside: f32| {
        let i = ((share * last as f32) as usize).min(last);
        let at = stem.points[i] + detail.flatten(stem.side * aside - Vec3::Z * (0.3 * aside.abs()));
        mesh.vertex(at, normal(at) + stem.side * (aside * 2.0), look(share))
    };
    let heads = [(0.15, 0.6, 0.85), (0.38, 0.86, 1.3), (0.64, 1.0, 0.95)];
    let heads = heads.map(|(s, end, w)| [corner(s, -w * width), corner(s, w * width), corner(end, 0.0)]);
    heads.iter().for_each(|[a, b, c]| mesh.triangle(*a, *b, *c));
}

/// Fern frond: an arched midrib with narrow leaflets to both sides, longest below the middle.
fn frond(mesh: &mut Mesh, stem: &Stem, count: usize, broad: f32, random: &mut Random) {
    let last = stem.points.len() - 1;
    let at = |s: f32| {
        let place = s.clamp(0.0, 1.0) * last as f32;
        let i = (place as usize).min(last - 1);
        let (a, b) = (stem.points[i], stem.points[i + 1]);
        (a + (b - a) * (place - i as f32), (b - a).normalize_or(Vec3::Z))
    };
    let stalk = |s: f32| Rib {
        at: at(s).0,
        half: stem.side * mix(0.009, 0.003, s),
        normal: normal(at(s).0),
        look: Look { part: 0.3, ..look(s) },
    };
    let ribs = if count > 20 { &[0.0, 0.3, 0.6, 1.0][..] } else { &[0.0, 1.0] };
    leaf::blade(mesh, &ribs.iter().map(|&s| stalk(s)).collect::<Vec<_>>());
    let pairs = count.saturating_sub(2 * ribs.len() - 3).max(2) / 2;
    for k in 0..pairs {
        // Leaflets stand closer towards the tip, and the last of them close it.
        let share = (k as f32 + 0.5) / pairs as f32;
        let s = mix(0.16, 0.985, 1.0 - pow(1.0 - share, 1.25));
        let gap = 0.92 * pow(1.0 - share, 0.25) / pairs as f32;
        let (place, along) = at(s);
        let slim = pow(sin(3.1 * mix(0.2, 0.985, pow(s, 0.9))), 0.85).max(0.1);
        let long = 0.09 * broad.clamp(0.4, 2.5) * slim;
        let up = stem.side.cross(along);
        let up = if up.z < 0.0 { -up } else { up };
        for hand in [-1.0_f32, 1.0] {
            let forward = mix(0.12, 0.9, s * s) + random.signed() * 0.07;
            let way = stem.side * hand + along * forward - Vec3::Z * random.range(0.05, 0.3);
            let way = way.normalize_or(along);
            let across = (along - way * along.dot(way) + up * 0.25).normalize_or(along);
            let glow = random.range(0.85, 1.05);
            let [foot, tip] = [s * 0.85, (s + 0.15).min(1.0)].map(|s| Look { light: look(s).light * glow, ..look(s) });
            let normal = up * 0.7 + Vec3::Z * 0.7 + stem.side * (hand * 0.25);
            let length = long * random.range(0.88, 1.08);
            let one = Leaf { at: place, along: way, across, length, width: gap.max(0.013), normal, look: foot, tip };
            leaf::triangle(mesh, &one, 0.0);
        }
    }
}
