//! Conifers: a straight trunk with whorls of branches, each a flat spray of narrow blades like a comb.

use super::build::{Detail, Look, Mesh};
use super::leaf::{self, Leaf};
use super::math::{GOLDEN, TURN, around, cos, exp, mix, pow, smooth};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Conifer;
use glam::Vec3;

/// Widening of the trunk at the ground, as a share of its radius: its mean, and how far roots stand out.
const ROOTS: f32 = 0.75;
const ROOTS_SPREAD: f32 = 0.32;

/// Share of that widening which is left at a height.
fn rooted(z: f32) -> f32 {
    const BELOW: f32 = 0.01;
    const HIGH: f32 = 0.017;
    exp(-(z + BELOW).max(0.0) / HIGH)
}

/// Branch of a whorl or between two.
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
    /// Length of the twigs that hang below.
    hang: f32,
    /// Branch between two whorls.
    short: bool,
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
    let height = 0.955 - foot;
    let hang = (0.75 * height / form.whorls.max(1) as f32).clamp(0.02, 0.06);
    let mut out = Vec::new();
    let gap = random.range(0.0, TURN);
    // Between two whorls grow a few short branches.
    for w in 0..2 * form.whorls {
        let (whorl, short) = (w / 2, w % 2 == 1);
        let shift = if short { 0.8 } else { 0.3 };
        let level = (whorl as f32 + shift + random.signed() * 0.3 * wild) / form.whorls as f32;
        let h = pow(level.clamp(0.0, 1.0), 0.92);
        let count = if short { 4 } else { 7 - 2 * usize::from(h > 0.85) };
        let turn = gap + w as f32 * GOLDEN;
        for b in 0..count {
            let angle = turn + TURN * b as f32 / count as f32 + random.signed() * (0.2 + 0.4 * wild);
            let length = radius * profile(form, h) * (1.0 + random.signed() * (0.12 + 0.4 * wild));
            let length = (length * if short { 0.6 } else { 1.0 }).max(0.022);
            let rise = smooth(0.55, 1.0, h) * 0.9;
            let steep = (-droop * 0.95 + rise) * (1.0 + random.signed() * 0.2) + random.signed() * 0.12 * wild;
            let z = foot + height * h + random.signed() * 0.007 * (1.0 + 2.0 * wild);
            if random.unit() < 0.3 * wild * wild {
                continue;
            }
            let lift = 0.38 * droop.max(0.0) + 0.08;
            let out_way = around(angle);
            // A hanging branch starts so high that its tip stays above the ground.
            let z = z.max(0.04 + length * (-steep - lift).max(0.0) * 0.8);
            let hang = hang.min(0.8 * length);
            let foot = Vec3::Z * z;
            out.push(Branch { foot, out: out_way, length, slope: steep, lift, high: h, hang, short });
        }
    }
    out
}

/// Mesh of a conifer.
pub(super) fn build(form: &Conifer, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    trunk(&mut mesh, form, detail);
    if detail.level == 3 {
        cones(&mut mesh, form, detail, 5, [0.95, 0.7]);
        return mesh;
    }
    let used = chosen(branches(form, detail.seed), detail);
    match detail.level {
        1 => cones(&mut mesh, form, detail, 1, [0.2, 0.3]),
        2 => cones(&mut mesh, form, detail, 6, [0.6, 0.45]),
        _ => {}
    }
    let needles = mix(0.5, 1.0, form.needles as f32);
    let room = detail.pick([8600.0 * needles, 598.0, 106.0, 0.0]);
    // Long branches get more needles than short ones.
    let share = |branch: &Branch| 0.2 * form.crown_width as f32 + branch.length;
    let whole: f32 = used.iter().map(share).sum();
    let least = detail.pick([4, 1, 1, 0]);
    let spare = (room - (least * used.len()) as f32).max(0.0);
    let mut owed = 0.0;
    for (i, branch) in used.iter().enumerate() {
        let mut random = Random::new(detail.seed, 100 + i as u32);
        owed += spare * share(branch) / whole.max(1e-6);
        let more = owed as usize;
        owed -= more as f32;
        feather(&mut mesh, branch, detail, least + more, needles, &mut random);
    }
    leader(&mut mesh, detail);
    mesh
}

/// Branches that a level draws.
fn chosen(mut all: Vec<Branch>, detail: &Detail) -> Vec<Branch> {
    all.retain(|branch| detail.level < 2 || !branch.short);
    let most = detail.pick([400, 400, 84, 0]);
    if all.len() <= most {
        return all;
    }
    // A random step keeps the branches that stay from gathering on one side.
    let step = all.len() / most;
    let jump = |i: usize| super::random::hash(i as u32 ^ detail.seed) as usize % step.max(1);
    (0..most).map(|i| all[(i * all.len() / most + jump(i)).min(all.len() - 1)]).collect()
}

/// Trunk.
fn trunk(mesh: &mut Mesh, form: &Conifer, detail: &Detail) {
    let wide = 0.008 + 0.016 * form.crown_width as f32 + 0.006 * form.trunk as f32;
    let shares: &[f32] = match detail.level {
        0 => &[-0.1, -0.01, 0.006, 0.018, 0.04, 0.1, 0.25, 0.45, 0.7, 0.97],
        1 => &[-0.1, 0.03, 0.3, 0.97],
        _ => &[-0.1, 0.97],
    };
    let knots: Vec<Knot> = shares
        .iter()
        .map(|&z| {
            let flare = 1.0 + ROOTS * rooted(z);
            let light = mix(0.6, 0.25, smooth(form.trunk as f32, form.trunk as f32 + 0.2, z));
            let look = Look { part: 0.0, light, sway: 0.5 * pow(z.max(0.0), 1.6) };
            Knot { at: Vec3::Z * z, radius: wide * pow(1.0 - 0.97 * z.max(0.0), 1.2) * flare, look }
        })
        .collect();
    let (sides, spread) = detail.pick([(16, ROOTS_SPREAD), (5, 0.0), (3, 0.0), (3, 0.0)]);
    // Roots run out to some sides.
    let turn = Random::new(detail.seed, 2).range(0.0, TURN);
    let lobes = move |angle: f32| 0.6 * cos(3.0 * angle + turn) + 0.4 * cos(5.0 * angle - 2.0 * turn);
    let last = shares.len() - 1;
    tube::fluted(mesh, &knots, sides, |angle, share| {
        let z = shares[((share * last as f32).round() as usize).min(last)];
        1.0 + spread * lobes(angle) * rooted(z)
    });
}

/// Branch as a spray of `count` triangles: a blade along it and a comb of narrow blades to both sides and below.
fn feather(mesh: &mut Mesh, branch: &Branch, detail: &Detail, count: usize, needles: f32, random: &mut Random) {
    let bough = if detail.level == 0 { 3 } else { 0 };
    if bough > 0 {
        let knot = |s: f32| Knot {
            at: branch.at(s),
            radius: branch.length * 0.022 * (1.0 - s) + 0.0006,
            look: Look { part: 0.3, light: mix(0.25, 0.6, s), sway: 0.4 },
        };
        tube::tube(mesh, &[knot(0.0), knot(0.9)], 3);
    }
    spine(mesh, branch, detail, random);
    let comb = count.saturating_sub(bough + 1);
    for k in 0..comb {
        let s = mix(detail.pick([0.1, 0.2, 0.3, 0.0]), 0.95, pow((k as f32 + 0.5) / comb as f32, 0.9));
        let hand = if k % 2 == 0 { 1.0 } else { -1.0 };
        let hangs = k % 3 == detail.pick([2, 0, 0, 0]);
        let gap = 1.6 * branch.length / comb as f32 * needles;
        needle(mesh, branch, detail, &Place { s, hand, hangs, gap }, random);
    }
}

/// Blade along the outer part of a branch; on the far levels along nearly all of it.
fn spine(mesh: &mut Mesh, branch: &Branch, detail: &Detail, random: &mut Random) {
    let from = branch.at(detail.pick([0.6, 0.15, 0.1, 0.0]));
    let way = branch.at(1.0) - from;
    let length = way.length().max(0.01);
    let along = way.normalize_or(branch.out);
    // Far blades lie at all angles around their branch, so that they cover from the side as well.
    let up = Vec3::Z + random.ball() * detail.pick([0.4, 0.9, 0.7, 0.0]);
    let across = along.cross(up).normalize_or(branch.out.cross(Vec3::Z));
    let normal = branch.out * 0.5 + Vec3::Z * 0.8 + random.ball() * 0.15;
    let width = (length * detail.pick([0.12, 0.22, 0.36, 0.0])).min(detail.pick([0.03, 0.05, 0.09, 0.0]));
    let width = width.max(finest(detail)) * fill(detail);
    let push = push(branch);
    let look = Look { part: 0.9, light: detail.pick([0.6, 0.35, 0.4, 0.0]), sway: push + 0.1 };
    let tip = Look { part: 1.0, light: random.range(0.85, 1.0), sway: push + 0.3 };
    let start = mesh.vertices.len();
    leaf::triangle(mesh, &Leaf { at: from, along, across, length, width, normal, look, tip }, 0.0);
    // The tip stays, so that the crown keeps its outline.
    detail.flatten_part(mesh, start, branch.at(1.0));
}

/// Place of a blade in a branch's comb.
struct Place {
    /// Share of the branch's length.
    s: f32,
    /// Side: 1 or -1.
    hand: f32,
    /// Blade that hangs below the branch.
    hangs: bool,
    /// Distance to the next blade of the same side.
    gap: f32,
}

/// Blade of a comb.
fn needle(mesh: &mut Mesh, branch: &Branch, detail: &Detail, place: &Place, random: &mut Random) {
    let Place { s, hand, hangs, gap } = *place;
    let side = Vec3::Z.cross(branch.out) * hand;
    let along_branch = branch.along(s);
    let lance = (1.0 - s).sqrt() * mix(0.6, 1.0, smooth(0.0, 0.35, s));
    let most = (branch.length * 0.25).max(detail.pick([0.06, 0.08, 0.1, 0.0]));
    let reach = ((branch.length * 0.46).min(most) * lance + 0.012) * random.range(0.75, 1.2);
    let (way, length) = if hangs {
        let hang = branch.hang * random.range(0.5, 1.1) * detail.pick([1.1, 1.1, 1.3, 1.0]) * mix(1.1, 0.7, s);
        (branch.out * 0.6 - Vec3::Z + side * random.signed() * 0.7, hang.max(reach * 0.4))
    } else {
        (along_branch * random.range(0.7, 1.0) + side * 0.75 - Vec3::Z * random.range(0.0, 0.3), reach)
    };
    let along = way.normalize_or(branch.out);
    let flat = if hangs { side + along_branch * random.signed() } else { along.cross(Vec3::Z + random.ball() * 0.7) };
    let across = flat.normalize_or(side);
    let width = (gap * 1.6).clamp(0.13 * length, 0.32 * length).max(finest(detail)) * fill(detail);
    let normal = if hangs {
        branch.out + Vec3::Z * 0.1 + side * 0.2
    } else {
        branch.out * 0.5 + Vec3::Z * 0.8 + side * 0.3 + random.ball() * 0.2
    };
    // The inside of the crown and what hangs below a branch lie in the shade.
    let open = mix(0.28, 1.0, smooth(0.0, 0.9, s)) * mix(0.85, 1.0, branch.high) * if hangs { 0.6 } else { 1.0 };
    let light = open * random.range(0.88, 1.08);
    let sway = push(branch) + 0.25 * s;
    let look = Look { part: mix(0.82, 0.95, s), light: light * 0.62, sway };
    let tip = Look { part: 1.0, light, sway: sway + 0.1 };
    let start = mesh.vertices.len();
    leaf::triangle(mesh, &Leaf { at: branch.at(s), along, across, length, width, normal, look, tip }, 0.0);
    detail.flatten_part(mesh, start, branch.at(s));
}

/// Width of the narrowest blades of a level: about a pixel where the level is drawn.
fn finest(detail: &Detail) -> f32 {
    detail.pick([0.0, 0.009, 0.02, 0.0])
}

/// Factor on the width of blades that makes levels cover the same; blades stay slender.
fn fill(detail: &Detail) -> f32 {
    mix(1.0, detail.fill, 0.8).min(2.0) * detail.pick([1.0, 1.6, 1.3, 1.0])
}

/// Share of the wind's push at a branch's foot.
fn push(branch: &Branch) -> f32 {
    0.45 * pow(branch.foot.z.max(0.0), 1.4)
}

/// Spire above the last whorl: blades that close in on the tip.
fn leader(mesh: &mut Mesh, detail: &Detail) {
    let count = detail.pick([24, 7, 4, 0]);
    let width = detail.pick([0.006, 0.012, 0.026, 0.0]);
    for i in 0..count {
        let share = i as f32 / (count - 1).max(1) as f32;
        let out = around(i as f32 * GOLDEN);
        let look = Look { part: 0.95, light: 0.65, sway: 0.6 };
        let tip = Look { part: 1.0, light: 0.95, sway: 0.7 };
        let at = Vec3::Z * mix(0.9, 0.965, share);
        let along = (Vec3::Z * mix(0.7, 1.0, share) + out * (1.0 - share)).normalize_or(Vec3::Z);
        let (across, normal) = (out.cross(Vec3::Z), out + Vec3::Z * 0.4);
        let length = mix(detail.pick([0.03, 0.045, 0.06, 0.0]), 0.035, share);
        let one = Leaf { at, along, across, length, width, normal, look, tip };
        leaf::triangle(mesh, &one, 0.0);
    }
}

/// Far levels: cones one above the other like tiers, of a share of the crown's width and with a share of the sky.
fn cones(mesh: &mut Mesh, form: &Conifer, detail: &Detail, tiers: usize, [wide, light]: [f32; 2]) {
    let (foot, sides) = (form.trunk as f32, detail.pick([6, 6, 6, 5]));
    let swell = detail.swell() * wide;
    for t in 0..tiers {
        let low = t as f32 / tiers as f32;
        let tall = detail.pick([1.0, 1.0, 0.8, 1.0]);
        let high = if t == tiers - 1 { 1.0 } else { (t as f32 + tall) / tiers as f32 };
        let radius = form.crown_width as f32 * 0.5 * profile(form, low + 0.06) * swell;
        let z = |h: f32| foot + (1.0 - foot) * h;
        // Tiers of rising branches stay steep enough to be seen from the side.
        let drop = (radius * form.droop as f32 * 0.45).max(-0.3 * (z(high) - z(low)));
        // The inside of the crown lies in the shade.
        let inner = if t == tiers - 1 { 1.0 } else { 0.5 };
        let top_look = Look { part: mix(0.7, 1.0, inner), light: light * inner, sway: 0.6 * low };
        let (start, peak) = (mesh.vertices.len(), Vec3::Z * z(high));
        let top = mesh.vertex(peak, Vec3::Z, top_look);
        let ring: Vec<u16> = (0..sides)
            .map(|s| {
                let out = around(TURN * (s as f32 + 0.5 * (t % 2) as f32) / sides as f32);
                let wild = Random::new(detail.seed, (700 + t * sides + s) as u32).signed() * 0.18;
                let jag = if s % 2 == 0 { 1.18 } else { 0.8 } + wild;
                let at = out * (radius * jag) + Vec3::Z * (z(low) - drop * jag).max(0.02);
                mesh.vertex(at, out + Vec3::Z * 0.5, Look { part: 1.0, light, sway: 0.6 * low + 0.1 })
            })
            .collect();
        for s in 0..sides {
            mesh.triangle(ring[s], ring[(s + 1) % sides], top);
        }
        detail.flatten_part(mesh, start, peak);
    }
}
