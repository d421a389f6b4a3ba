//! Trees: a skeleton grown by space colonisation (Runions et al. 2007) into a crown of leaf lobes.

use super::build::{Detail, Look, Mesh};
use super::clump;
use super::crown::{Canopy, Spot};
use super::foliage::Foliage;
use super::grow::{self, Growth, Node};
use super::math::{TURN, around, cos, exp, mix, pow, smooth};
use super::random::{Random, noise};
use super::tube::{self, Knot};
use crate::planet::life::{Crown, Tree};
use glam::Vec3;

/// Skeleton and leaf spots of a tree, from which all levels are drawn.
pub(super) struct Plan<'a> {
    form: &'a Tree,
    nodes: Vec<Node>,
    branches: Vec<Vec<usize>>,
    canopy: Canopy,
    spots: Vec<Spot>,
    seed: u32,
    /// Height above which a trunk is hidden in the crown.
    hidden: f32,
    /// Whether it is a shrub, which branches at the ground.
    low: bool,
}

/// Growth of a tree.
pub(super) fn plan(form: &Tree, seed: u32) -> Plan<'_> {
    let mut random = Random::new(seed, 1);
    let canopy = Canopy::new(form, &mut random);
    let outline = canopy.outline;
    let spots = canopy.spots(if form.leaves < 0.02 { 620 } else { 430 }, &mut random);
    // Far levels take the first spots, which lie evenly over the crown.
    let places: Vec<Vec3> = spots.iter().map(|s| s.at).collect();
    let spots: Vec<Spot> = clump::even_order(&places, 160).iter().map(|&i| spots[i]).collect();
    let size = outline.size();
    let irregular = form.irregular as f32;
    let step = (size * 0.075).clamp(0.012, 0.06);
    let leader = match form.crown {
        Crown::Cone | Crown::Column => 0.85,
        Crown::Weeping => 0.6,
        Crown::Round => mix(0.5, 0.25, irregular),
        Crown::Umbrella => -0.4,
    };
    // Several branches part low on a shrub.
    let end = (outline.foot + outline.height * leader).clamp(0.04, 0.95).max(form.trunk as f32);
    let low = outline.low();
    let end = if low { 0.04 } else { end };
    let rings = (end / step).clamp(2.0, 40.0) as usize;
    let stem: Vec<Vec3> = (0..=rings)
        .map(|i| {
            let z = end * i as f32 / rings as f32;
            let sway = |s: u32| noise(Vec3::Z * z * 2.6, seed ^ s) - noise(Vec3::ZERO, seed ^ s);
            Vec3::new(sway(11), sway(23), 0.0) * (0.14 * irregular * z.min(0.6)) + Vec3::Z * z
        })
        .collect();
    // Twigs end below the leaves.
    let sunk = 0.1 * size * smooth(0.3, 0.6, form.leaves as f32);
    let points: Vec<Vec3> = spots.iter().filter(|s| s.hang == 0.0).map(|s| s.at - s.normal * sunk).collect();
    let pull = Vec3::Z * if form.crown == Crown::Umbrella { 0.0 } else { 0.12 };
    let rules = Growth { step, reach: step * 1.9, pull, wander: 0.25 + 0.5 * irregular, most: 1400 };
    let shoots: Vec<Vec3> = (0..if low { 5 } else { 0 })
        .map(|i| around(i as f32 * TURN / 5.0 + random.range(0.0, 0.9)) * 0.05 + Vec3::Z * random.range(0.02, 0.06))
        .collect();
    let mut nodes = grow::grow_shrub(&stem, &shoots, &points, &rules, &mut random);
    grow::smooth(&mut nodes, stem.len() + shoots.len());
    let branches = grow::branches(&nodes);
    let hidden = outline.foot + 0.4 * outline.height;
    let spots = if form.leaves < 0.45 { attached(spots, &nodes, &branches, 1.2 * step) } else { spots };
    Plan { form, nodes, branches, canopy, spots, seed, hidden, low }
}

/// Spots of a sparse crown, moved to the branches that are drawn.
fn attached(mut spots: Vec<Spot>, nodes: &[Node], branches: &[Vec<usize>], most: f32) -> Vec<Spot> {
    let twigs = branches.iter().take(26).flatten().map(|&i| &nodes[i]).filter(|n| n.load < 0.2);
    let places: Vec<Vec3> = twigs.map(|n| n.at).collect();
    for spot in spots.iter_mut().filter(|s| s.hang == 0.0) {
        let away = |p: &&Vec3| p.distance_squared(spot.at);
        if let Some(near) = places.iter().min_by(|a, b| away(a).total_cmp(&away(b))) {
            spot.at = *near + (spot.at - *near).clamp_length_max(most);
        }
    }
    spots
}

/// Mesh of a planned tree.
pub(super) fn build(plan: &Plan, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let leaves = plan.form.leaves as f32;
    let bare = leaves < 0.02;
    // Sparse leaves show the twigs.
    let dense = smooth(0.25, 0.7, leaves);
    let near = mix(if plan.low { 1450.0 } else { 3200.0 }, if plan.low { 480.0 } else { 1500.0 }, dense) as usize;
    let far = mix(230.0, 170.0, dense) as usize;
    let farther = mix(43.0, 34.0, dense) as usize;
    let wood = if bare { detail.pick([3900, 445, 112, 28]) } else { detail.pick([near, far, farther, 6]) };
    plan.wood(&mut mesh, detail, wood, bare);
    if bare {
        return mesh;
    }
    if detail.level == 3 && leaves >= 0.45 {
        let points: Vec<Vec3> = plan.spots.iter().map(|s| s.at).collect();
        let core = mix(0.45, 0.95, smooth(0.1, 0.7, leaves));
        clump::draw(&mut mesh, &points, core, detail);
        return mesh;
    }
    Foliage { form: plan.form, canopy: &plan.canopy, spots: &plan.spots, seed: plan.seed }.draw(&mut mesh, detail);
    mesh
}

impl Plan<'_> {
    /// Knots of a branch's path.
    fn knots(&self, path: &[usize], swell: f32) -> Vec<Knot> {
        let thick = self.form.trunk_width as f32 * 0.5;
        let roots = if self.low { 0.1 } else { 0.6 };
        let own = path.get(1).map_or(1.0, |&i| self.nodes[i].load);
        let last = path.len() - 1;
        let knot = |(i, &node): (usize, &usize)| {
            let node = &self.nodes[node];
            let load = if i == 0 { own.max(if path[0] == 0 && !self.low { 1.0 } else { 0.0 }) } else { node.load };
            let z = node.at.z.max(0.0);
            let flare = if path[0] == 0 { 1.0 - 0.25 * z + roots * exp(-z / 0.035) } else { 1.0 };
            let taper = if i == last { 0.3 } else { 1.0 };
            let radius = (thick * grow::radius(load) * flare).max(0.0016) * taper * mix(swell, 1.0, load.sqrt());
            let light = 0.78 - 0.33 * z * self.form.leaves as f32;
            let sway = 0.6 * pow(z, 1.6) * (1.0 + 0.4 * (1.0 - load));
            Knot { at: node.at, radius, look: Look { part: 0.0, light, sway } }
        };
        let mut knots: Vec<Knot> = path.iter().enumerate().map(knot).collect();
        if path[0] == 0 {
            let mut root = knots[0];
            root.at.z = -0.1;
            root.radius *= 1.25;
            root.look.light = 0.5;
            knots.insert(0, root);
        }
        knots
    }

    /// Trunk and branches, from the thickest on, within a number of triangles.
    fn wood(&self, mesh: &mut Mesh, detail: &Detail, budget: usize, bare: bool) {
        let swell = if bare { detail.fill } else { 1.0 };
        let mut left = budget;
        let thick = self.form.trunk_width as f32 * 0.5;
        let phase = Random::new(self.seed, 4).range(0.0, TURN);
        for (rank, path) in self.branches.iter().enumerate() {
            // The leader of a far level ends inside the crown.
            let whole = detail.level < 2 || rank > 0 || bare;
            let inside = path.iter().position(|&n| self.nodes[n].at.z > self.hidden).unwrap_or(path.len());
            let shown = if whole { path.len() } else { inside.clamp(2.min(path.len()), path.len()) };
            let knots = self.knots(&path[..shown], swell);
            let girth = knots[knots.len() / 2].radius / thick;
            let most = match detail.level {
                0 if bare || rank == 0 => 30,
                0 if self.low => (knots.len() / 3 + 2).min(7),
                0 => (knots.len() / 2 + 2).min(12),
                1 if bare => (knots.len() / 3 + 2).min(8),
                1 => {
                    if rank == 0 {
                        8
                    } else {
                        4
                    }
                }
                2 => {
                    if rank == 0 {
                        4
                    } else {
                        3 - usize::from(rank > 4)
                    }
                }
                _ => {
                    if rank == 0 && !bare {
                        2 + usize::from(left >= 9)
                    } else {
                        2
                    }
                }
            };
            let sides = match detail.level {
                0 if rank == 0 => 10,
                0 => (3.0 + girth * 7.0).clamp(3.0, if self.low { 4.0 } else { 7.0 }) as usize,
                1 if rank == 0 => 5,
                _ => 3,
            };
            // Short twigs of a far level would float beside the simplified branches.
            if detail.level > 0 && rank > 0 && (path.len() < 4 || (detail.level == 3 && !bare)) {
                continue;
            }
            let knots = tube::thinned(&knots, most);
            let cost = tube::triangles(knots.len(), sides);
            if cost > left {
                if rank == 0 { continue } else { break }
            }
            left -= cost;
            // Roots show as ridges around the foot of the trunk.
            let roots = if rank == 0 && detail.level == 0 { 0.22 } else { 0.0 };
            let fade = |share: f32| roots * exp(-share * 9.0);
            tube::fluted(mesh, &knots, sides, |a, share| 1.0 + fade(share) * cos(a * 5.0 + phase));
        }
    }
}
