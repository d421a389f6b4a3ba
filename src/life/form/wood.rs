//! Fallen wood: trunks, boughs and twigs that lie on the ground, with broken ends, stubs and moss on their backs.

use super::build::{Detail, Look, Mesh};
use super::math::{GOLDEN, TURN, around, cos, exp, mix, sin, smooth};
use super::random::{Random, hash, noise};
use crate::planet::life::Wood;
use glam::Vec3;

/// Radius of the thickest piece without branches; its height is 1.
const RADIUS: f32 = 0.5;
/// Radius of the thinnest piece of a group, as a share of the thickest.
const THINNEST: f32 = 0.45;

/// Piece of wood: a trunk that lies, or a branch of one.
struct Stick {
    /// Middle of the butt.
    butt: Vec3,
    /// Unit vector to the tip.
    along: Vec3,
    length: f32,
    /// Radii of the butt and of the tip.
    radii: [f32; 2],
    /// How far the middle lies aside.
    bend: f32,
    /// Widening at the butt, as a share of the radius.
    flare: f32,
    /// Both ends are broken; a branch begins within its trunk.
    is_trunk: bool,
}

impl Stick {
    /// Middle at a share of the length. A trunk rests on the ground.
    fn at(&self, s: f32) -> Vec3 {
        let aside = Vec3::Z.cross(self.along) * (self.bend * sin(s * TURN * 0.5));
        let mut at = self.butt + self.along * (self.length * s) + aside;
        if self.is_trunk {
            at.z = self.radius(s);
        }
        at
    }

    fn radius(&self, s: f32) -> f32 {
        mix(self.radii[0], self.radii[1], s) * (1.0 + self.flare * exp(-s / 0.04))
    }
}

/// Pieces from the thickest on, trunks first.
fn sticks(form: &Wood, seed: u32) -> Vec<Stick> {
    let (branches, bend) = (form.branches as f32, form.bend as f32);
    let mut random = Random::new(seed, 1);
    // Branches rise higher than the trunk that carries them.
    let thick = RADIUS * (1.0 - 0.3 * branches);
    let mut trunks = Vec::new();
    let spin = random.range(0.0, TURN);
    for i in 0..form.pieces {
        let share = if i == 0 { 1.0 } else { random.range(THINNEST, 0.9) };
        let length = form.length as f32 * if i == 0 { 1.0 } else { random.range(0.45, 1.0) };
        let radius = thick * share;
        let along = around(spin + i as f32 * GOLDEN * 1.3 + random.signed() * 0.4);
        let aside = if i == 0 { 0.0 } else { random.range(0.1, 0.3) * form.length as f32 };
        let middle = around(random.range(0.0, TURN)) * aside;
        trunks.push(Stick {
            butt: middle - along * (0.5 * length),
            along,
            length,
            radii: [radius, radius * random.range(0.45, 0.7)],
            bend: bend * 0.09 * length * random.signed(),
            flare: form.flare as f32 * random.range(0.6, 1.0),
            is_trunk: true,
        });
    }
    let each = (branches * 6.0).round() as u32;
    let mut all = trunks;
    for trunk in 0..all.len() {
        for k in 0..each {
            all.push(branch(&all[trunk], k, branches, &mut random));
        }
    }
    all
}

/// Branch of a trunk, to one side and the other in turn.
fn branch(trunk: &Stick, k: u32, branches: f32, random: &mut Random) -> Stick {
    let s = random.range(0.3, 0.95);
    let hand = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let side = Vec3::Z.cross(trunk.along) * hand;
    let from = trunk.at(s);
    let reach = trunk.length * mix(0.05, 0.34, branches) * random.range(0.45, 1.0) * (1.15 - 0.6 * s);
    let rise = (random.range(-0.35, 1.0) * 0.6).clamp(-0.8 * from.z / reach, (0.97 - from.z) / reach);
    let along = (trunk.along * random.range(0.5, 1.1) + side + Vec3::Z * rise).normalize_or(side);
    let radius = trunk.radius(s) * random.range(0.3, 0.5);
    let bend = 0.12 * reach * random.signed();
    Stick { butt: from, along, length: reach, radii: [radius, 0.35 * radius], bend, flare: 0.0, is_trunk: false }
}

/// Rings along a piece and sides around it.
type Grid = (usize, usize);

/// Coarsest piece: a prism.
const COARSEST: Grid = (2, 3);

/// Mesh of pieces of wood.
pub(super) fn build(form: &Wood, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let all = sticks(form, detail.seed);
    let (trunks, branches) = all.split_at(form.pieces as usize);
    let plan = plan(detail, trunks.len(), branches.len());
    let chosen = trunks[..plan.trunks].iter().map(|stick| (stick, plan.trunk));
    let chosen = chosen.chain(branches[..plan.branches].iter().map(|stick| (stick, plan.branch)));
    for (seed, (stick, (rings, sides))) in (0_u32..).zip(chosen) {
        draw(&mut mesh, form, detail, &Piece { stick, rings, sides, seed: hash(detail.seed ^ seed) });
    }
    mesh
}

/// Numbers of trunks and branches that a level draws, and how fine.
struct Plan {
    trunks: usize,
    branches: usize,
    trunk: Grid,
    branch: Grid,
}

/// Plan within the triangles of a level: pieces get coarser before branches, and then trunks, are left out.
fn plan(detail: &Detail, trunks: usize, branches: usize) -> Plan {
    let most = detail.pick([3900, 690, 138, 28]);
    let (trunk, branch) = detail.pick([((14, 12), (5, 6)), ((7, 7), (3, 4)), ((4, 5), COARSEST), ((2, 6), COARSEST)]);
    let branches = if detail.level == 3 { 0 } else { branches };
    let mut plan = Plan { trunks, branches, trunk, branch };
    while plan.trunks * triangles(plan.trunk) + plan.branches * triangles(plan.branch) > most {
        if plan.branches > 0 && plan.branch != COARSEST {
            plan.branch = coarser(plan.branch);
        } else if plan.trunk != COARSEST {
            plan.trunk = coarser(plan.trunk);
        } else if plan.branches > 0 {
            plan.branches -= 1;
        } else {
            plan.trunks -= 1;
        }
    }
    plan
}

/// Triangles of a piece with its two ends.
fn triangles((rings, sides): Grid) -> usize {
    2 * sides * (rings - 1) + 2 * (sides - 2)
}

/// Next coarser piece.
fn coarser((rings, sides): Grid) -> Grid {
    if sides == COARSEST.1 || (rings > sides && rings > COARSEST.0) { (rings - 1, sides) } else { (rings, sides - 1) }
}

/// Piece as a level of detail draws it.
struct Piece<'a> {
    stick: &'a Stick,
    rings: usize,
    sides: usize,
    seed: u32,
}

/// Bark around a piece, and its broken ends.
fn draw(mesh: &mut Mesh, form: &Wood, detail: &Detail, piece: &Piece) {
    let Piece { stick, rings, sides, seed } = *piece;
    let across = Vec3::Z.cross(stick.along).normalize_or(Vec3::Y);
    let upward = stick.along.cross(across);
    // Coarse levels are wider along the ground: the height stays.
    let spread = detail.swell();
    let placed = |at: Vec3| Vec3::new(at.x * spread, at.y * spread, at.z);
    // Corners of a polygon lie on the circle, its sides within.
    let round = 1.0 + 0.5 / (sides * sides) as f32;
    let mut ends: [Vec<Vec3>; 2] = [Vec::new(), Vec::new()];
    let mut previous: Vec<u16> = Vec::new();
    for ring in 0..rings {
        let s = ring as f32 / (rings - 1) as f32;
        // Rings are closer where the butt widens.
        let s = if rings > 5 { s * mix(s, 1.0, 0.6) } else { s };
        let is_end = ring == 0 || ring + 1 == rings;
        let middle = stick.at(s);
        let corner = |i: usize| {
            // One corner is on top, where moss grows.
            let angle = TURN * (i as f32 / sides as f32 + 0.25);
            let (aside, up) = (cos(angle), sin(angle));
            let knobs = 1.0 + 0.1 * noise(middle * 2.5 + Vec3::new(aside, up, 0.0) * 1.3, seed);
            let radius = stick.radius(s) * knobs * round;
            let splinter = Random::new(seed, (ring * sides + i) as u32).signed();
            let torn = if is_end && stick.is_trunk { 0.35 * radius * splinter } else { 0.0 };
            let at = placed(middle) + across * (aside * radius * spread * detail.flat) + upward * (up * radius);
            (at + stick.along * torn, across * aside + upward * up)
        };
        let look = |at: Vec3, normal: Vec3| {
            let back = 0.5 + 0.5 * normal.z + 0.3 * noise(at * 3.0, seed ^ 5);
            let moss = form.moss as f32;
            let part = if moss > 0.0 { smooth(1.02 - 0.8 * moss, 1.32 - 0.8 * moss, back) } else { 0.0 };
            Look { part, light: mix(0.3, 0.95, smooth(-0.9, 0.7, normal.z)), sway: 0.0 }
        };
        let corners: Vec<(Vec3, Vec3)> = (0..sides).map(corner).collect();
        let row: Vec<u16> = corners.iter().map(|&(at, normal)| mesh.vertex(at, normal, look(at, normal))).collect();
        for i in 0..previous.len() {
            let next = (i + 1) % sides;
            mesh.triangle(previous[i], previous[next], row[next]);
            mesh.triangle(previous[i], row[next], row[i]);
        }
        if is_end {
            ends[usize::from(ring > 0)] = corners.iter().map(|(at, _)| *at).collect();
        }
        previous = row;
    }
    for (end, (way, is_tip)) in ends.iter().zip([(-stick.along, false), (stick.along, true)]) {
        let face: Vec<u16> =
            end.iter().map(|&at| mesh.vertex(at, way, Look { part: 0.0, light: 0.75, sway: 0.0 })).collect();
        for i in 1..sides - 1 {
            let (b, c) = if is_tip { (face[i], face[i + 1]) } else { (face[i + 1], face[i]) };
            mesh.triangle(face[0], b, c);
        }
    }
}
