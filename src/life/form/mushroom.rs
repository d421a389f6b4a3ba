//! Mushrooms: stems with round caps, in groups.

use super::build::{Detail, Look, Mesh};
use super::math::{GOLDEN, TURN, around, cos, mix, pow, sin};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Mushroom;
use glam::Vec3;

/// One mushroom of a group.
struct Single {
    foot: Vec3,
    lean: Vec3,
    height: f32,
    spin: f32,
}

/// Mesh of a group of mushrooms.
pub(super) fn build(form: &Mushroom, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let mut random = Random::new(detail.seed, 1);
    let all: Vec<Single> = (0..form.cluster).map(|i| single(form, i, &mut random)).collect();
    let few = all.len() <= 1;
    let used = all.len().min(detail.pick([9, 9, 6, if few { 1 } else { 5 }]));
    let budget = detail.pick([3900, 690, 138, 28]) / used.max(1);
    for one in &all[..used] {
        if detail.level == 3 && !few {
            far(&mut mesh, form, detail, one);
            continue;
        }
        draw(&mut mesh, form, detail, one, budget);
    }
    mesh
}

/// Place of a mushroom: the first stands tallest in the middle.
fn single(form: &Mushroom, i: u32, random: &mut Random) -> Single {
    let out = around(i as f32 * GOLDEN + random.signed() * 0.4);
    let height = if i == 0 { 1.0 } else { random.range(0.35, 0.85) };
    let ring = if form.cluster == 1 { 0.0 } else { pow(i as f32, 0.5) };
    let apart = 0.11 + 0.2 * form.cap_width as f32;
    let foot = out * (ring * apart * random.range(0.7, 1.1));
    let lean = out * (form.lean as f32 * 0.22 * height * if i == 0 { 0.4 } else { 1.0 });
    Single { foot, lean, height, spin: random.range(0.0, TURN) }
}

/// Profile of a cap from the gills' middle over the rim to the top: radius and height shares with part and light.
fn profile(form: &Mushroom, fine: usize) -> Vec<(f32, f32, f32, f32)> {
    let round = form.cap_round as f32;
    let mut rows = Vec::new();
    let under = if fine >= 8 { 3 } else { usize::from(fine >= 4) };
    for i in 0..under {
        let s = (i as f32 + 0.3) / under as f32;
        rows.push((s * 0.94, 0.12 + 0.12 * round * (1.0 - s), 0.12, mix(0.2, 0.42, s)));
    }
    let over = fine.saturating_sub(under).max(1);
    for i in 0..over {
        let a = i as f32 / over as f32;
        let angle = a * TURN * 0.25;
        let bell = pow(cos(angle), mix(0.8, 1.25, round));
        let part = mix(0.72, 1.0, pow(a, 0.5));
        rows.push((bell, pow(sin(angle), mix(0.95, 0.8, round)), part, mix(0.72, 1.0, a)));
    }
    rows
}

/// Stem and cap within a number of triangles.
fn draw(mesh: &mut Mesh, form: &Mushroom, detail: &Detail, one: &Single, budget: usize) {
    let h = one.height;
    let cap = form.cap_width as f32 * 0.5 * h * detail.swell();
    let deep = form.cap_width as f32 * 0.5 * h * mix(0.2, 0.95, form.cap_round as f32);
    let deep = deep.min(0.62 * h);
    let (stem_sides, stem_rings, fine) = match budget {
        0..=16 => (3, 1, 1),
        17..=30 => (3, 1, 2),
        31..=80 => (4, 2, 3),
        81..=170 => (5, 3, 5),
        171..=340 => (7, 5, 8),
        _ => (10, 8, 11),
    };
    let stem_cost = tube::triangles(stem_rings + 1, stem_sides);
    let rows = profile(form, fine);
    let sides = ((budget.saturating_sub(stem_cost)) / (2 * rows.len())).clamp(3, 26);
    let at = |t: f32| one.foot + one.lean * t * t + Vec3::Z * ((h - deep * 0.75) * t);
    let stem = form.stem_width as f32 * 0.5 * h;
    let knot = |i: usize| {
        let t = mix(-0.06, 1.0, i as f32 / stem_rings as f32);
        let girth = 1.0 - 0.35 * t + 0.35 * super::math::exp(-t.max(0.0) / 0.12);
        let look =
            Look { part: 0.0, light: mix(0.55, 0.7, (2.0 * t).min(1.0)) - 0.3 * pow(t.max(0.0), 3.0), sway: 0.1 * t };
        let place = if t < 0.0 { one.foot + Vec3::Z * (t * h) } else { at(t) };
        let open = if i == stem_rings { 0.6 } else { 1.0 };
        Knot { at: place, radius: stem * girth * open, look }
    };
    tube::tube(mesh, &(0..=stem_rings).map(knot).collect::<Vec<_>>(), stem_sides);
    let axis = (at(1.0) - at(0.8)).normalize_or(Vec3::Z);
    let base = at(1.0) - axis * (deep * 0.25);
    let start = mesh.vertices.len();
    lathe(mesh, &rows, &Cap { base, axis, wide: cap, deep, sides, spin: one.spin });
    detail.flatten_part(mesh, start, base + axis * deep);
}

/// Mushroom of five triangles: a stem and a cap without a lower side.
fn far(mesh: &mut Mesh, form: &Mushroom, detail: &Detail, one: &Single) {
    let h = one.height;
    let top = one.foot + one.lean + Vec3::Z * h;
    let cap = form.cap_width as f32 * 0.5 * h * detail.swell();
    let deep = (form.cap_width as f32 * 0.5 * h * mix(0.3, 0.9, form.cap_round as f32)).min(0.6 * h);
    let across = around(one.spin) * (form.stem_width as f32 * h * 0.6);
    let stalk = Look { part: 0.0, light: 0.6, sway: 0.0 };
    let front = Vec3::new(across.y, -across.x, 0.0);
    let ends =
        [one.foot - across, one.foot + across, top - Vec3::Z * (deep * 0.6)].map(|p| mesh.vertex(p, front, stalk));
    mesh.triangle(ends[0], ends[1], ends[2]);
    let start = mesh.vertices.len();
    let peak = mesh.vertex(top, Vec3::Z, Look { part: 1.0, light: 1.0, sway: 0.1 });
    let rim = [0, 1, 2, 3].map(|s| {
        let out = around(one.spin + TURN * s as f32 * 0.25);
        let at = top + out * (cap * 1.1) - Vec3::Z * deep;
        mesh.vertex(at, out + Vec3::Z * 0.4, Look { part: 0.8, light: 0.75, sway: 0.1 })
    });
    (0..4).for_each(|s| mesh.triangle(rim[s], rim[(s + 1) % 4], peak));
    detail.flatten_part(mesh, start, top);
}

/// Cap's place and size.
struct Cap {
    base: Vec3,
    axis: Vec3,
    wide: f32,
    deep: f32,
    sides: usize,
    spin: f32,
}

/// Surface of revolution, from the gills' middle to the top.
fn lathe(mesh: &mut Mesh, rows: &[(f32, f32, f32, f32)], cap: &Cap) {
    let across = cap.axis.any_orthonormal_vector();
    let other = cap.axis.cross(across);
    let middle = cap.base + cap.axis * (cap.deep * 0.2);
    let gills = mesh.vertex(middle, -cap.axis, Look { part: 0.1, light: 0.2, sway: 0.1 });
    let top_look = Look { part: 1.0, light: 1.0, sway: 0.1 };
    let mut previous: Option<Vec<u16>> = None;
    for (r, &(wide, high, part, light)) in rows.iter().enumerate() {
        let below = part < 0.3;
        let ring: Vec<u16> = (0..cap.sides)
            .map(|s| {
                let a = TURN * s as f32 / cap.sides as f32;
                let out = across * cos(a) + other * sin(a);
                let wave = 1.0 + 0.035 * sin(a * 3.0 + cap.spin) + 0.02 * sin(a * 5.0 - cap.spin);
                let at = cap.base + out * (cap.wide * wide * wave) + cap.axis * (cap.deep * high);
                let steep =
                    if below { out * 0.3 - cap.axis } else { out * (wide * cap.deep) + cap.axis * (high * cap.wide) };
                // Gills show as alternate light and dark spokes.
                let spoke = if below && s % 2 == 1 { 0.72 } else { 1.0 };
                mesh.vertex(at, steep, Look { part, light: light * spoke, sway: 0.1 })
            })
            .collect();
        for s in 0..cap.sides {
            let n = (s + 1) % cap.sides;
            match &previous {
                None => mesh.triangle(gills, ring[n], ring[s]),
                Some(old) => {
                    mesh.triangle(old[s], old[n], ring[n]);
                    mesh.triangle(old[s], ring[n], ring[s]);
                }
            }
        }
        if r + 1 == rows.len() {
            let top = mesh.vertex(cap.base + cap.axis * cap.deep, cap.axis, top_look);
            (0..cap.sides).for_each(|s| mesh.triangle(ring[s], ring[(s + 1) % cap.sides], top));
        }
        previous = Some(ring);
    }
}
