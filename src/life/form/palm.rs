//! Palms: a curved, ringed trunk and arched fronds with leaflets on both sides.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf, Rib};
use super::math::{GOLDEN, around, mix, pow, sin, turn};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Palm;
use glam::Vec3;

/// Path of a frond: points and directions.
struct Frond {
    points: Vec<Vec3>,
    side: Vec3,
}

/// Mesh of a palm.
pub(super) fn build(form: &Palm, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let mut random = Random::new(detail.seed, 1);
    let lean = around(random.range(0.0, 7.0));
    let head = 1.0 - 0.42 * form.frond_length as f32;
    let trunk_at = |t: f32| lean * (form.bend as f32 * pow(t, 1.7) * head) + Vec3::Z * (head * t);
    trunk(&mut mesh, form, detail, &trunk_at);
    let crown = trunk_at(1.0);
    let way = (trunk_at(1.0) - trunk_at(0.93)).normalize_or(Vec3::Z);
    let count = (form.fronds as usize).min(detail.pick([40, 40, 20, 9]));
    let merged = form.fronds as f32 / count as f32;
    for i in 0..count {
        let age = (i as f32 + 0.5) / count as f32;
        let frond = frond(form, detail, crown, way, i, age);
        match detail.level {
            0 | 1 => feather(&mut mesh, form, detail, &frond, count, age, &mut random),
            _ => strip(&mut mesh, form, detail, &frond, age, merged.sqrt()),
        }
    }
    mesh
}

/// Trunk with rings.
fn trunk(mesh: &mut Mesh, form: &Palm, detail: &Detail, at: &impl Fn(f32) -> Vec3) {
    let rings = detail.pick([44, 8, 3, 2]);
    let wide = form.trunk_width as f32 * 0.5;
    let knots: Vec<Knot> = (0..=rings)
        .map(|i| {
            let t = mix(-0.08, 1.015, i as f32 / rings as f32);
            let notch = if detail.level == 0 && i % 2 == 1 { 0.9 } else { 1.0 };
            let flare = 1.0 + 0.7 * super::math::exp(-t.max(0.0) / 0.06);
            let light = (0.85 - 0.3 * pow(t.max(0.0), 6.0)) * if notch < 1.0 { 0.85 } else { 1.0 };
            let place = if t < 0.0 { Vec3::Z * t } else { at(t) };
            let look = Look { part: 0.0, light, sway: 0.5 * pow(t.max(0.0), 1.6) };
            Knot { at: place, radius: wide * mix(1.0, 0.68, t.max(0.0)) * notch * flare, look }
        })
        .collect();
    tube::tube(mesh, &knots, detail.pick([9, 5, 3, 3]));
}

/// Path of a frond: the youngest stand up, the oldest hang.
fn frond(form: &Palm, detail: &Detail, crown: Vec3, way: Vec3, index: usize, age: f32) -> Frond {
    let mut random = Random::new(detail.seed, 50 + (age * 997.0) as u32);
    let out = around(index as f32 * GOLDEN + random.signed() * 0.25);
    let arch = form.arch as f32;
    let length = form.frond_length as f32 * random.range(0.88, 1.1) * mix(0.8, 1.0, sin(3.0 * age.min(1.0)));
    let steps = detail.pick([14, 7, 3, 2]);
    let side = Vec3::Z.cross(out).normalize_or(Vec3::X);
    // Pitch above the horizon at the foot, and how far it turns down on the way.
    let pitch = mix(1.22, -0.3, pow(age, 0.85)) + random.signed() * 0.1;
    let fall = mix(0.35, 2.1, arch) * mix(0.75, 1.1, age);
    let mut points = vec![crown + (way * 0.2 + out) * (form.trunk_width as f32 * 0.25)];
    let mut at = points[0];
    for k in 0..steps {
        let s = (k as f32 + 0.5) / steps as f32;
        let angle = pitch - fall * pow(s, 1.4);
        let direction = turn(out, -side, angle);
        // Gravity stops a frond from curling back under itself.
        let direction = if direction.dot(out) < -0.1 { -Vec3::Z + out * 0.1 } else { direction };
        at += direction.normalize_or(out) * (length / steps as f32);
        points.push(at);
    }
    Frond { points, side }
}

impl Frond {
    /// Point and direction at a share of the length.
    fn at(&self, s: f32) -> (Vec3, Vec3) {
        let last = self.points.len() - 1;
        let place = s.clamp(0.0, 1.0) * last as f32;
        let i = (place as usize).min(last - 1);
        let (a, b) = (self.points[i], self.points[i + 1]);
        (a + (b - a) * (place - i as f32), (b - a).normalize_or(Vec3::Z))
    }
}

/// Light along a frond.
fn look(age: f32, s: f32, shade: f32) -> Look {
    let light = mix(0.95, 0.55, age) * (0.6 + 0.4 * s) * shade;
    Look { part: mix(0.82, 1.0, s), light, sway: 0.5 + 0.5 * s }
}

/// Frond with single leaflets.
fn feather(mesh: &mut Mesh, form: &Palm, detail: &Detail, frond: &Frond, count: usize, age: f32, random: &mut Random) {
    let room = detail.pick([6400, 600, 0, 0]) / count.max(1);
    let stalk = detail.pick([5, 3, 2, 2]);
    let leaflets = room.saturating_sub(2 * stalk).clamp(4, 180) / 2;
    let length = form.frond_length as f32;
    let wide = length * form.leaflets as f32 * 0.62 * mix(0.55, 1.0, (age * 4.0).min(1.0));
    let rib = |i: usize| {
        let s = i as f32 / stalk as f32;
        let (at, along) = frond.at(s);
        let up = frond.side.cross(along);
        Rib { at, half: frond.side * (length * 0.012 * (1.0 - 0.7 * s)), normal: -up, look: look(age, s, 0.8) }
    };
    leaf::blade(mesh, &(0..=stalk).map(rib).collect::<Vec<_>>());
    let broad = length * 1.0 / leaflets as f32 * detail.swell() * mix(1.0, 1.15, age);
    for k in 0..leaflets {
        let s = mix(0.13, 1.0, (k as f32 + 0.5) / leaflets as f32);
        for hand in [-1.0_f32, 1.0] {
            let (at, along) = frond.at(s - random.unit() * 0.4 / leaflets as f32);
            let up = along.cross(frond.side);
            let up = if up.z < 0.0 && along.z.abs() < 0.9 { -up } else { up };
            let long = wide * pow(sin(3.0 * mix(0.12, 0.97, s)), 0.7).max(0.2) * random.range(0.85, 1.1);
            let way = along * mix(0.5, 1.1, s) + frond.side * hand - Vec3::Z * mix(0.25, 0.55, age) + up * 0.15;
            let way = way.normalize_or(along);
            let normal = up * 0.8 + frond.side * hand * 0.35 + Vec3::Z * 0.3;
            let (foot, tip) = (look(age, s, 0.75), look(age, s, 1.05));
            let across = (along - way * along.dot(way)).normalize_or(up);
            let one = Leaf { at, along: way, across, length: long, width: broad, normal, look: foot, tip };
            leaf::triangle(mesh, &one, 0.0);
        }
    }
}

/// Frond as one bent strip.
fn strip(mesh: &mut Mesh, form: &Palm, detail: &Detail, frond: &Frond, age: f32, merged: f32) {
    let last = frond.points.len() - 1;
    let wide = form.frond_length as f32 * form.leaflets as f32 * 0.3 * detail.fill * merged;
    let rib = |i: usize| {
        let s = i as f32 / last as f32;
        let (at, along) = frond.at(s);
        // The strip is tilted, so that it shows from the side as well.
        let tilt = if ((age * 40.0) as u32).is_multiple_of(2) { 0.3 } else { -0.3 };
        let across = turn(frond.side, along, tilt);
        let girth = if i == 0 { 0.45 } else { sin(3.0 * mix(0.3, 1.0, s)).max(0.35) };
        Rib {
            at,
            half: detail.flatten(across * (wide * girth)),
            normal: frond.side.cross(along) * -1.0 + Vec3::Z,
            look: look(age, s, 0.9),
        }
    };
    let ribs: Vec<Rib> = (0..=last).map(rib).collect();
    if detail.level < 3 {
        leaf::blade(mesh, &ribs);
        return;
    }
    let [foot, left, right, tip] = [(0, 0.0), (1, -1.6), (1, 1.6), (last, 0.0)]
        .map(|(i, h)| mesh.vertex(ribs[i].at + ribs[i].half * h, ribs[i].normal, ribs[i].look));
    mesh.triangle(foot, right, tip);
    mesh.triangle(foot, tip, left);
}
