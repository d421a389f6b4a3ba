//! Cacti: ribbed columns with arms, and barrels.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf};
use super::math::{GOLDEN, TURN, around, cos, mix, sin, smooth};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Cactus;
use glam::Vec3;

/// Column or arm: its path and how finely it is drawn.
struct Limb {
    knots: Vec<Knot>,
    sides: usize,
}

/// Knots along a path whose end is a dome.
fn limb(path: impl Fn(f32) -> Vec3, radius: impl Fn(f32) -> f32, rings: usize, sides: usize, dome: f32) -> Limb {
    let knot = |i: usize| {
        // A third of the rings make the dome at the end; on a barrel, most do.
        let least = [1, 1, 1, 2, 2][rings.min(4)].max(rings / 3).max(if rings > 4 { 3 } else { 1 });
        let crown = ((rings as f32 * dome * 0.8).ceil() as usize).max(least);
        let body = rings - crown.clamp(1, rings - 1);
        let bow = i.saturating_sub(body) as f32 / (rings - body) as f32 * TURN * 0.25;
        let (cap, round) = if i == rings { (1.0, 0.0) } else { (sin(bow), cos(bow)) };
        let t = (1.0 - dome) * (i as f32 / body as f32).min(1.0) + dome * cap;
        let at = path(t);
        let light = mix(0.5, 0.95, smooth(-0.05, 0.35, at.z));
        let look = Look { part: 0.15 * cap, light, sway: 0.06 * at.z.max(0.0) };
        Knot { at, radius: radius(t) * round, look }
    };
    Limb { knots: (0..=rings).map(knot).collect(), sides }
}

/// Column and arms.
fn limbs(form: &Cactus, detail: &Detail) -> Vec<Limb> {
    let mut random = Random::new(detail.seed, 1);
    let girth = form.girth as f32 * 0.5;
    let swell = detail.swell();
    let fine = |ribs: u32| (2 * ribs as usize).clamp(10, 48);
    let arms = if form.girth > 0.6 { 0 } else { form.arms as usize };
    let arms = arms.min(detail.pick([8, 6, 3, 1]));
    let room = detail.pick([if form.spines > 0.0 { 3000 } else { 3900 }, 640, 132, 28]);
    let sides = match detail.level {
        0 => fine(form.ribs),
        1 if arms == 0 || fine(form.ribs) <= 28 => fine(form.ribs),
        1 => 14,
        2 => 6,
        _ => {
            if arms > 0 {
                3
            } else {
                5
            }
        }
    };
    let rings = (room * if arms > 0 { 4 } else { 9 } / (10 * 2 * sides)).clamp(2, 26);
    let rings = if detail.level == 3 { 3 } else { rings };
    let lean = around(random.range(0.0, TURN)) * 0.03 * random.unit();
    let belly = |t: f32| girth * swell * mix(0.86, 1.06, smooth(0.0, 0.6, t)) * if girth > 0.3 { 1.1 } else { 1.0 };
    let dome = (girth * 1.1).clamp(0.06, 0.75);
    let mut out = vec![limb(|t| Vec3::Z * mix(-0.1, 1.0, t) + lean * t * t, belly, rings, sides, dome)];
    let spin = random.range(0.0, TURN);
    for a in 0..arms {
        let way = around(spin + a as f32 * GOLDEN + random.signed() * 0.3);
        let low = random.range(0.28, 0.55);
        let high = (low + random.range(0.18, 0.42)).min(0.93);
        let far = girth * random.range(2.1, 3.0) + 0.03;
        let thin = girth * random.range(0.58, 0.75) * swell;
        let path = move |t: f32| {
            // The elbow takes the first part, then the arm stands up.
            let e = (t / 0.38).min(1.0);
            let bow = 1.0 - (1.0 - e) * (1.0 - e);
            way * (far * bow) + Vec3::Z * (low + 0.06 * e * e + (high - low - 0.06) * ((t - 0.3) / 0.7).max(0.0))
        };
        let count = (room / (4 * arms)).max(3);
        let sides = match detail.level {
            0 => fine(form.ribs).min(24),
            1 => 7,
            _ => 3,
        };
        let rings = (count / sides).clamp(4, 16);
        let rings = if detail.level == 3 { 2 } else { rings };
        out.push(limb(path, move |_| thin, rings, sides, (thin / (high - low + far)).clamp(0.05, 0.4)));
    }
    out
}

/// Mesh of a cactus.
pub(super) fn build(form: &Cactus, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let limbs = limbs(form, detail);
    let ribs = form.ribs as f32;
    for limb in &limbs {
        let deep = if limb.sides >= 2 * form.ribs as usize { form.groove as f32 } else { 0.0 };
        let own = if deep > 0.0 { ribs } else { (limb.sides / 2) as f32 };
        let flat = if deep > 0.0 {
            deep
        } else if detail.level == 0 {
            form.groove as f32
        } else {
            0.0
        };
        let start = mesh.vertices.len();
        tube::fluted(&mut mesh, &limb.knots, limb.sides, |a, _| 1.0 - flat * (0.5 - 0.5 * cos(a * own)));
        groove(&mut mesh, start, limb.sides, flat > 0.0);
    }
    if detail.level == 0 && form.spines > 0.0 {
        spines(&mut mesh, form, detail);
    }
    mesh
}

/// Darkening of the grooves between the ribs: every second corner of a ring lies in one.
fn groove(mesh: &mut Mesh, start: usize, sides: usize, deep: bool) {
    if !deep {
        return;
    }
    for (i, v) in mesh.vertices[start..].iter_mut().enumerate() {
        if i % sides % 2 == 1 {
            v.light *= 0.62;
        } else {
            v.part = (v.part + 0.12).min(1.0);
        }
    }
}

/// Spines along the ribs.
fn spines(mesh: &mut Mesh, form: &Cactus, detail: &Detail) {
    let room = 3980_usize.saturating_sub(mesh.triangles.len());
    let count = (form.spines as f32 * room as f32) as usize;
    let body = mesh.vertices.clone();
    for i in 0..count {
        let mut random = Random::new(detail.seed, 500 + i as u32);
        let v = &body[random.whole() as usize % body.len()];
        // Corners with a lighter part are the crests of ribs.
        let crowded = v.normal.z > 0.75 && random.unit() < 0.7;
        if v.part < 0.1 || v.position.z < 0.03 || crowded {
            continue;
        }
        let along = (v.normal + random.ball() * 0.8).normalize_or(v.normal);
        let across = along.cross(random.direction()).normalize_or(Vec3::X);
        let length = (0.03 + 0.05 * form.girth as f32) * random.range(0.5, 1.1);
        let look = Look { part: 1.0, light: 0.9, sway: v.sway };
        let at = v.position + random.ball() * 0.01;
        let normal = v.normal + Vec3::Z * 0.3;
        let one = Leaf { at, along, across, length, width: 0.004 + length * 0.06, normal, look, tip: look };
        leaf::triangle(mesh, &one, 0.0);
    }
}
