//! Cushions: mounds of lumps with small leaves, as moss, lichen and dwarf shrubs form.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf};
use super::math::{GOLDEN, around, mix, pow};
use super::random::{Random, noise};
use super::sphere;
use crate::planet::life::Cushion;
use glam::Vec3;

/// Lump: a ball that bulges out of the mound.
struct Lump {
    centre: Vec3,
    radius: f32,
}

/// Lumps over the unit half-ball, the first ones near the top.
fn lumps(form: &Cushion, seed: u32) -> Vec<Lump> {
    let mut random = Random::new(seed, 1);
    let count = form.lumps as f32;
    let bulge = form.lumpiness as f32;
    (0..form.lumps)
        .map(|i| {
            let share = (i as f32 + 0.5) / count;
            let out = (pow(share, 0.5) * 0.95 + random.signed() * 0.1).clamp(0.0, 0.98);
            let z = (1.0 - out * out).max(0.0).sqrt();
            let way = around(i as f32 * GOLDEN + random.signed() * 0.4) * out + Vec3::Z * z * 0.9;
            let radius = (1.5 / count.max(1.0).sqrt()).min(0.8) * random.range(0.75, 1.25);
            Lump { centre: way * mix(0.5, 0.85, bulge), radius }
        })
        .collect()
}

/// Distance from the centre to the surface along a unit direction.
fn surface(way: Vec3, lumps: &[Lump], form: &Cushion, seed: u32) -> f32 {
    let core = 1.0 - 0.28 * form.lumpiness as f32;
    let hit = |lump: &Lump| {
        let along = lump.centre.dot(way);
        let inside = lump.radius * lump.radius - (lump.centre.length_squared() - along * along);
        if inside > 0.0 { along + inside.sqrt() } else { 0.0 }
    };
    let bumpy = lumps.iter().map(hit).fold(core, f32::max);
    let grain = noise(way * 7.0, seed) * 0.05 + noise(way * 15.0, seed ^ 5) * 0.035;
    mix(1.0, bumpy, 0.35 + 0.65 * form.lumpiness as f32) * (1.0 + grain * 2.0 * form.roughness as f32)
}

/// Mesh of a cushion.
pub(super) fn build(form: &Cushion, detail: &Detail) -> Mesh {
    let leafy = form.leaves as f32;
    let lumps = lumps(form, detail.seed);
    let ball = sphere::sphere(detail.pick([11, 5, 3, 1]));
    let mut dome = Mesh::default();
    let sides = form.width as f32 * 0.5 * detail.swell();
    let mut index = vec![None; ball.corners.len()];
    let mut corner = |mesh: &mut Mesh, i: u16| -> u16 {
        *index[i as usize].get_or_insert_with(|| {
            let way = ball.corners[i as usize];
            let up = Vec3::new(way.x, way.y, way.z.max(0.0)).normalize_or(Vec3::Z);
            let reach = surface(up, &lumps, form, detail.seed);
            let point = up * reach - Vec3::Z * if way.z < -0.05 { 0.12 } else { 0.0 };
            let crevice = (reach - 1.0 + 0.25 * form.lumpiness as f32).clamp(0.0, 0.5);
            let light = (0.5 + 0.4 * up.z) * (0.72 + 1.1 * crevice).min(1.15);
            let part = (0.35 + 1.3 * crevice + 0.4 * up.z).min(1.0);
            let at = point * Vec3::new(sides, sides, 1.0);
            mesh.vertex(at, Vec3::Z, Look { part, light, sway: 0.12 * leafy * up.z })
        })
    };
    for t in &ball.triangles {
        let middle: Vec3 = t.iter().map(|&i| ball.corners[i as usize]).sum();
        if middle.z > -0.75 {
            let [a, b, c] = t.map(|i| corner(&mut dome, i));
            dome.triangle(a, b, c);
        }
    }
    let mut mesh = dome.crease(-1.0);
    if detail.level < 2 && leafy > 0.01 {
        leaves(&mut mesh, &dome, form, detail);
    }
    mesh
}

/// Small leaves that stand out from the dome.
fn leaves(mesh: &mut Mesh, dome: &Mesh, form: &Cushion, detail: &Detail) {
    let room = detail.pick([4000, 700, 0, 0]) - mesh.triangles.len();
    let count = (form.leaves as f32 * room as f32) as usize;
    let smooth = mesh.clone();
    for i in 0..count {
        let mut random = Random::new(detail.seed, 300 + i as u32);
        let t = smooth.triangles[random.whole() as usize % dome.triangles.len()];
        let [a, b, c] = t.map(|i| smooth.vertices[i as usize]);
        let (u, v) = (random.unit(), random.unit());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let at = a.position + (b.position - a.position) * u + (c.position - a.position) * v;
        if at.z < 0.02 {
            continue;
        }
        let along = (a.normal * 0.8 + random.ball() * 0.9 + Vec3::Z * 0.3).normalize_or(Vec3::Z);
        let across = along.cross(random.direction()).normalize_or(Vec3::X);
        let length = detail.pick([0.1, 0.17, 0.0, 0.0]) * random.range(0.6, 1.3) * (0.6 + 0.4 * form.leaves as f32);
        let look = Look { part: b.part, light: b.light * 0.85, sway: 0.1 };
        let tip = Look { part: (b.part + 0.3).min(1.0), light: (b.light * 1.2).min(1.0), sway: 0.4 };
        let normal = a.normal + Vec3::Z * 0.2;
        let one = Leaf { at, along, across, length, width: length * 0.42, normal, look, tip };
        leaf::triangle(mesh, &one, 0.0);
    }
}
