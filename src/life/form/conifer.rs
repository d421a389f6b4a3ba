//! Conifers: a straight trunk with whorls of branches, each a feather of needle twigs.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf};
use super::math::{GOLDEN, TURN, around, mix, pow, smooth};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Conifer;
use glam::Vec3;

/// Branch of a whorl.
#[derive(Clone, Copy, Debug)]
struct Branch {
    foot: Vec3,
    out: Vec3,
    length: f32,
    /// Rise per length at the foot and its change along the branch.
    slope: f32,
    lift: f32,
    /// Share of the crown's height.
    high: f32,
}

impl Branch {
    /// Point at a share of the length.
    fn at(&self, s: f32) -> Vec3 {
        self.foot + self.out * (self.length * s) + Vec3::Z * (self.length * (self.slope * s + self.lift * s * s))
    }

    /// Direction at a share of the length.
    fn along(&self, s: f32) -> Vec3 {
        (self.out + Vec3::Z * (self.slope + 2.0 * self.lift * s)).normalize_or(self.out)
    }
}

/// Radius of the crown at a share of its height, as a share of the largest.
fn profile(form: &Conifer, h: f32) -> f32 {
    let cone = 1.0 - h;
    let dome = (1.0 - h * h).max(0.0).sqrt() * smooth(-0.5, 0.35, h);
    mix(dome, cone, form.point as f32) * (0.8 + 0.2 * smooth(0.0, 0.12, h))
}

/// Branches from the lowest on.
fn branches(form: &Conifer, seed: u32) -> Vec<Branch> {
    let mut random = Random::new(seed, 1);
    let (wild, droop) = (form.irregular as f32, form.droop as f32);
    let (foot, radius) = (form.trunk as f32, form.crown_width as f32 * 0.5);
    let height = 0.985 - foot;
    let mut out = Vec::new();
    let gap = random.range(0.0, TURN);
    for w in 0..form.whorls {
        let level = (w as f32 + 0.3 + random.signed() * 0.3 * wild) / form.whorls as f32;
        let h = pow(level.clamp(0.0, 1.0), 0.92);
        let count = if h > 0.85 { 5 } else { 7 };
        let turn = gap + w as f32 * GOLDEN;
        for b in 0..count {
            let angle = turn + TURN * b as f32 / count as f32 + random.signed() * (0.2 + 0.4 * wild);
            let length = radius * profile(form, h) * (1.0 + random.signed() * (0.12 + 0.4 * wild));
            let rise = smooth(0.55, 1.0, h) * 0.9;
            let steep = (-droop * 0.95 + rise) * (1.0 + random.signed() * 0.2) + random.signed() * 0.12 * wild;
            let z = foot + height * h + random.signed() * 0.012 * (1.0 + 2.0 * wild);
            if random.unit() < 0.3 * wild * wild {
                continue;
            }
            let lift = 0.38 * droop.max(0.0) + 0.08;
            let out_way = around(angle);
            // A hanging branch starts so high that its tip stays above the ground.
            let z = z.max(0.04 + length * (-steep - lift).max(0.0) * 0.8);
            out.push(Branch { foot: Vec3::Z * z, out: out_way, length: length.max(0.02), slope: steep, lift, high: h });
        }
    }
    out
}

/// Mesh of a conifer.
pub(super) fn build(form: &Conifer, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    trunk(&mut mesh, form, detail);
    if detail.level == 3 {
        cones(&mut mesh, form, detail, 4, 1.0);
        return mesh;
    }
    let all = branches(form, detail.seed);
    if detail.level == 2 {
        cones(&mut mesh, form, detail, 11, 0.85);
    }
    let most = detail.pick([200, 130, 21, 0]);
    let used: Vec<Branch> = if all.len() <= most {
        all
    } else {
        {
            // A random step keeps the branches that stay from gathering on one side.
            let step = all.len() / most;
            let jump = |i: usize| super::random::hash(i as u32 ^ detail.seed) as usize % step.max(1);
            (0..most).map(|i| all[(i * all.len() / most + jump(i)).min(all.len() - 1)]).collect()
        }
    };
    let room = detail.pick([6800, 640, 64, 0]);
    let each = (room / used.len().max(1)).clamp(2, 72);
    let needles = mix(0.55, 1.0, form.needles as f32);
    let each = if detail.level == 0 { (each as f32 * needles) as usize } else { each };
    for (i, branch) in used.iter().enumerate() {
        let mut random = Random::new(detail.seed, 100 + i as u32);
        feather(&mut mesh, branch, detail, each, needles, &mut random);
    }
    leader(&mut mesh, detail);
    mesh
}

/// Trunk.
fn trunk(mesh: &mut Mesh, form: &Conifer, detail: &Detail) {
    let wide = 0.012 + 0.02 * form.crown_width as f32 + 0.006 * form.trunk as f32;
    let shares: &[f32] = match detail.level {
        0 => &[-0.1, 0.0, 0.03, 0.1, 0.25, 0.45, 0.7, 0.97],
        1 => &[-0.1, 0.03, 0.3, 0.97],
        2 => &[-0.1, 0.97],
        _ => &[-0.1, 0.7],
    };
    let knots: Vec<Knot> = shares
        .iter()
        .map(|&z| {
            let flare = 1.0 + 0.5 * super::math::exp(-z.max(0.0) / 0.025);
            let light = mix(0.6, 0.4, smooth(form.trunk as f32, form.trunk as f32 + 0.2, z));
            let look = Look { part: 0.0, light, sway: 0.5 * pow(z.max(0.0), 1.6) };
            Knot { at: Vec3::Z * z, radius: wide * (1.0 - 0.93 * z.max(0.0)) * flare, look }
        })
        .collect();
    tube::tube(mesh, &knots, detail.pick([9, 5, 3, 3]));
}

/// Branch as a feather: twigs to both sides and hanging below, in `count` triangles.
fn feather(mesh: &mut Mesh, branch: &Branch, detail: &Detail, count: usize, needles: f32, random: &mut Random) {
    let side = Vec3::Z.cross(branch.out);
    let bough = if detail.level == 0 { 3 } else { 0 };
    if bough > 0 {
        let knot = |s: f32| Knot {
            at: branch.at(s),
            radius: branch.length * 0.028 * (1.0 - s) + 0.0008,
            look: Look { part: 0.15, light: 0.45, sway: 0.4 },
        };
        tube::tube(mesh, &[knot(0.0), knot(0.9)], 3);
    }
    let twigs = count.saturating_sub(bough).max(2);
    let size = detail.pick([1.0, 1.75, 2.6, 1.0]) * detail.swell() * mix(0.9, 1.05, needles);
    // Fewer twigs on a coarse level are longer, but the branch keeps its length.
    let crowd = (30.0 / twigs as f32).sqrt().min(1.6);
    let push = 0.45 * pow(branch.foot.z.max(0.0), 1.4);
    for k in 0..twigs {
        let s = mix(0.12, 0.97, pow((k as f32 + 0.5) / twigs as f32, 0.8));
        let hand = [1.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0][k % 7];
        let rest = (1.0 - s) * (0.55 + 0.45 * s);
        let along_branch = branch.along(s);
        let reach = branch.length * (0.10 + 0.62 * rest) * random.range(0.8, 1.2);
        let hangs = hand == 0.0;
        let along = if hangs {
            -Vec3::Z * 0.8 + branch.out * 0.75 + side * random.signed() * 0.5
        } else {
            along_branch * 0.8 + side * hand * random.range(0.55, 0.95) - Vec3::Z * random.range(0.05, 0.35)
        };
        let along = along.normalize_or(branch.out);
        let length = if hangs { reach * 0.55 + 0.03 * (1.3 - s) } else { reach * 0.85 };
        let length = length * mix(1.0, size, 0.45) * crowd.max(1.0);
        let width = (0.36 * length + 0.01) * mix(1.0, size, 0.75);
        let flat = if hangs {
            side + along_branch * random.signed() * 0.6
        } else {
            along.cross(Vec3::Z + random.ball() * 0.5)
        };
        let normal = branch.out * 0.9 + Vec3::Z * 0.45 + along * 0.25 + random.ball() * 0.12;
        let open = (0.25 + 0.75 * s) * mix(0.8, 1.0, branch.high) * if hangs { 0.8 } else { 1.0 };
        let light = open * random.range(0.9, 1.1) * detail.pick([1.0, 1.0, 1.25, 1.0]);
        let sway = push + 0.25 * s;
        let look = Look { part: mix(0.75, 1.0, s), light: light * 0.72, sway };
        let tip = Look { part: 1.0, light, sway: sway + 0.1 };
        let at = branch.at(s.min(1.0 - 0.5 * length / branch.length.max(length)));
        let across = flat.normalize_or(side);
        leaf::triangle(mesh, &Leaf { at, along, across, length, width, normal, look, tip }, 0.2);
    }
}

/// Spire above the last whorl.
fn leader(mesh: &mut Mesh, detail: &Detail) {
    let count = detail.pick([14, 6, 3, 0]);
    let size = detail.pick([0.02, 0.026, 0.034, 0.0]) * detail.swell();
    for i in 0..count {
        let share = (i as f32 + 0.5) / count as f32;
        let out = around(i as f32 * GOLDEN);
        let look = Look { part: 1.0, light: 0.9, sway: 0.7 };
        let at = Vec3::Z * (0.93 + 0.05 * share);
        let along = (Vec3::Z * 0.9 + out * (1.0 - 0.8 * share)).normalize_or(Vec3::Z);
        let across = out.cross(Vec3::Z);
        let one = Leaf { at, along, across, length: 0.035, width: size, normal: out, look, tip: look };
        leaf::triangle(mesh, &one, 0.0);
    }
}

/// Far levels: cones that overlap like tiers.
fn cones(mesh: &mut Mesh, form: &Conifer, detail: &Detail, tiers: usize, wide: f32) {
    let (foot, sides) = (form.trunk as f32, 6);
    let swell = detail.swell() * wide;
    for t in 0..tiers {
        let low = t as f32 / tiers as f32;
        let high = if t == tiers - 1 { 1.0 } else { (t as f32 + 1.55) / tiers as f32 };
        let radius = form.crown_width as f32 * 0.5 * profile(form, low + 0.06) * swell;
        let z = |h: f32| foot + (1.0 - foot) * h;
        let drop = radius * form.droop as f32 * 0.45;
        let top_look = Look { part: 1.0, light: 0.65, sway: 0.6 * low };
        let top = mesh.vertex(Vec3::Z * z(high), Vec3::Z, top_look);
        let ring: Vec<u16> = (0..sides)
            .map(|s| {
                let out = around(TURN * (s as f32 + 0.5 * (t % 2) as f32) / sides as f32);
                let wild = Random::new(detail.seed, (700 + t * sides + s) as u32).signed() * 0.18;
                let jag = if s % 2 == 0 { 1.18 } else { 0.8 } + wild;
                let at = out * (radius * jag) + Vec3::Z * (z(low) - drop * jag).max(0.02);
                mesh.vertex(at, out + Vec3::Z * 0.5, Look { part: 1.0, light: 0.7, sway: 0.6 * low + 0.1 })
            })
            .collect();
        for s in 0..sides {
            mesh.triangle(ring[s], ring[(s + 1) % sides], top);
        }
    }
}
