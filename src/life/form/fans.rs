//! Fans: flat nets of branches, grown by space colonisation (Runions et al. 2007) in a sheet.

use super::build::{Detail, Look, Mesh};
use super::grow::{self, Growth, Node};
use super::leaf::{self, Rib};
use super::math::{around, mix, pow, sin};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Fans;
use glam::Vec3;

/// Grown fan: a skeleton in a flat sheet (x across, z up) and where the sheet stands.
struct Fan {
    nodes: Vec<Node>,
    branches: Vec<Vec<usize>>,
    links: Vec<[usize; 2]>,
    heading: f32,
    size: f32,
    lean: f32,
}

/// Fans from which all levels are drawn.
pub(super) struct Plan<'a> {
    form: &'a Fans,
    fans: Vec<Fan>,
}

/// Growth of a group of fans.
pub(super) fn plan(form: &Fans, seed: u32) -> Plan<'_> {
    let mut random = Random::new(seed, 1);
    let start = random.range(0.0, 7.0);
    let count = form.fans as f32;
    let fans = (0..form.fans)
        .map(|i| {
            let heading = start + std::f32::consts::PI * (i as f32 + 0.25 * random.signed()) / count;
            let size = if i == 0 { 1.0 } else { random.range(0.6, 0.88) };
            let lean = if i == 0 { 0.06 } else { random.range(0.15, 0.4) } * if i % 2 == 0 { 1.0 } else { -1.0 };
            let (nodes, branches) = sheet(form, &mut random);
            let links = links(&nodes);
            Fan { nodes, branches, links, heading, size, lean }
        })
        .collect();
    Plan { form, fans }
}

/// Skeleton of one fan in its sheet.
fn sheet(form: &Fans, random: &mut Random) -> (Vec<Node>, Vec<Vec<usize>>) {
    let wide = form.width as f32 * 0.5;
    let count = (mix(200.0, 1500.0, form.density as f32) / (form.fans as f32).sqrt()) as usize;
    let notch = random.range(0.0, 7.0);
    let points: Vec<Vec3> = (0..count * 3)
        .map(|_| Vec3::new(random.signed(), 0.0, random.unit()))
        .filter(|p| {
            // A rounded fan whose rim is wavy.
            let angle = p.x * 1.2;
            let rim = 0.93 + 0.07 * sin(angle * 9.0 + notch);
            let up = (p.z - 0.45) / 0.55;
            let side = p.x / 1.0;
            (side * side + up * up).sqrt() < rim && p.z > 0.1 + 0.22 * p.x.abs()
        })
        .take(count)
        .map(|p| Vec3::new(p.x * wide, 0.0, p.z))
        .collect();
    let stem: Vec<Vec3> = (0..4).map(|i| Vec3::Z * (i as f32 * 0.035 - 0.05)).collect();
    let step = mix(0.042, 0.010, form.density as f32) * (0.55 + 0.25 * (form.fans as f32).sqrt());
    let rules = Growth { step, reach: step * 1.25, pull: Vec3::Z * 0.2, wander: 0.3, most: 1200 };
    let mut nodes = grow::grow(&stem, &points, &rules, random);
    nodes.iter_mut().for_each(|n| n.at.y *= 0.3);
    grow::smooth(&mut nodes, stem.len());
    let branches = grow::branches(&nodes);
    (nodes, branches)
}

/// Links from tips to near neighbours on other branches, which close the net.
fn links(nodes: &[Node]) -> Vec<[usize; 2]> {
    let mut links = Vec::new();
    for (i, tip) in nodes.iter().enumerate().filter(|(_, n)| n.children == 0) {
        let length = (tip.at - nodes[tip.parent].at).length();
        let kin =
            |j: usize| j == i || j == tip.parent || nodes[j].parent == tip.parent || nodes[tip.parent].parent == j;
        let near = (0..nodes.len()).filter(|&j| !kin(j) && nodes[j].at.z > 0.2);
        let distance = |j: &usize| nodes[*j].at.distance_squared(tip.at);
        if let Some(j) = near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
            && distance(&j) < length * length * 6.0
        {
            links.push([i, j]);
        }
    }
    links
}

impl Plan<'_> {
    /// Knot of a tube at a node.
    fn knot(&self, fan: &Fan, node: &Node, load: f32) -> Knot {
        let thick = mix(0.006, 0.03, self.form.thickness as f32);
        let at = self.place(fan, node.at);
        let radius = (thick * pow(load, 0.4)).max(0.0048) * fan.size;
        let tip = 1.0 - pow(load, 0.25);
        let part = (1.1 * tip * mix(0.6, 1.0, node.at.z)).min(1.0);
        let light = mix(0.5, 1.0, at.z.clamp(0.0, 1.0));
        Knot { at, radius, look: Look { part, light, sway: 0.55 * pow(at.z.max(0.0), 1.4) } }
    }

    /// Place of a sheet's point in space.
    fn place(&self, fan: &Fan, p: Vec3) -> Vec3 {
        let right = around(fan.heading);
        let front = Vec3::new(-right.y, right.x, 0.0);
        let cup = self.form.cup as f32 * (0.9 * p.x * p.x + 0.12 * sin(p.x * 7.0 + p.z * 5.0) * p.z);
        let out = fan.lean * p.z * p.z + cup * if fan.lean < 0.0 { -1.0 } else { 1.0 } + p.y;
        let flat = right * p.x + front * out;
        let at = flat * fan.size + front * (fan.lean * 0.22);
        Vec3::new(at.x, at.y, p.z * if p.z > 0.0 { fan.size } else { 1.0 })
    }
}

/// Mesh of planned fans.
pub(super) fn build(plan: &Plan, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    if detail.level == 3 {
        plan.fans.iter().for_each(|fan| wedges(&mut mesh, plan, fan, detail));
        return mesh;
    }
    let mut left: usize = detail.pick([3990, 695, 138, 28]);
    let mut order: Vec<(&Fan, &Vec<usize>, f32)> = Vec::new();
    for fan in &plan.fans {
        order.extend(fan.branches.iter().map(|b| (fan, b, fan.size * fan.nodes[b[1.min(b.len() - 1)]].load)));
    }
    order.sort_by(|a, b| b.2.total_cmp(&a.2));
    for (fan, path, _) in order {
        let last = path.len() - 1;
        let first = fan.nodes[path[1.min(last)]].load;
        let load = |i: usize, node: &Node| if i == 0 { first } else { node.load };
        let knots: Vec<Knot> =
            path.iter().enumerate().map(|(i, &n)| plan.knot(fan, &fan.nodes[n], load(i, &fan.nodes[n]))).collect();
        let most = detail.pick([knots.len().min(24), 5, 3, 2]);
        let knots = tube::thinned(&knots, most);
        // Only thick branches are round; the rest are ribbons.
        let round = detail.level == 0 && knots[0].radius > 0.0075;
        let sides = if knots[0].radius > 0.011 { 5 } else { 3 };
        let cost = if round { tube::triangles(knots.len(), sides) } else { 2 * knots.len() - 3 };
        if cost > left {
            break;
        }
        left -= cost;
        if round {
            tube::tube(&mut mesh, &knots, sides);
        } else {
            ribbon(&mut mesh, &knots, fan, detail);
        }
    }
    if detail.level == 0 {
        let links = plan.fans.iter().flat_map(|fan| fan.links.iter().map(move |l| (fan, l)));
        for (fan, link) in links.take(left / 3) {
            let [a, b] = link.map(|n| plan.knot(fan, &fan.nodes[n], 0.0));
            let middle = Knot { at: (a.at + b.at) * 0.5, ..a };
            ribbon(&mut mesh, &[a, middle, b], fan, detail);
        }
    }
    mesh
}

/// Far level: a fan as wedges from its foot to its rim.
fn wedges(mesh: &mut Mesh, plan: &Plan, fan: &Fan, detail: &Detail) {
    let count = 28 / plan.fans.len().max(1);
    let mut tips: Vec<&Node> = fan.nodes.iter().filter(|n| n.children == 0).collect();
    tips.sort_by(|a, b| (a.at.x / (a.at.z + 0.3)).total_cmp(&(b.at.x / (b.at.z + 0.3))));
    let foot = plan.knot(fan, &fan.nodes[0], 1.0);
    let high =
        |list: &[&Node]| list.iter().map(|n| n.at).fold(Vec3::ZERO, |a, b| if a.length() > b.length() { a } else { b });
    let sector = tips.len().div_ceil(count).max(1);
    for part in tips.chunks(sector) {
        let rim = high(part);
        let half = Vec3::new(rim.z, 0.0, -rim.x).normalize_or(Vec3::X) * (plan.form.width as f32 / count as f32);
        let half = half * (0.7 * detail.fill).min(2.5);
        let corner = |p: Vec3| plan.knot(fan, &Node { at: p, parent: 0, children: 0, load: 0.02 }, 0.02);
        let (a, b) = (corner(rim - half - Vec3::Z * 0.04), corner(rim + half));
        let right = around(fan.heading);
        let normal = Vec3::new(-right.y, right.x, 0.0) * 0.4 + Vec3::Z;
        let index = [foot, b, a].map(|k| mesh.vertex(k.at, normal, k.look));
        mesh.triangle(index[0], index[1], index[2]);
    }
}

/// Flat branch in the fan's sheet, for far levels.
fn ribbon(mesh: &mut Mesh, knots: &[Knot], fan: &Fan, detail: &Detail) {
    let right = around(fan.heading);
    let front = Vec3::new(-right.y, right.x, 0.0);
    let last = knots.len() - 1;
    let rib = |i: usize| {
        let along = (knots[(i + 1).min(last)].at - knots[i.saturating_sub(1)].at).normalize_or(Vec3::Z);
        let half = front.cross(along).normalize_or(right) * (knots[i].radius * 1.2 * detail.fill);
        Rib { at: knots[i].at, half, normal: front * 0.4 + Vec3::Z, look: knots[i].look }
    };
    leaf::blade(mesh, &(0..=last).map(rib).collect::<Vec<_>>());
}
