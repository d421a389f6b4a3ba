//! Skeletons of branches that grow towards points in space.
//!
//! The method is space colonisation: A. Runions, B. Lane, P. Prusinkiewicz, "Modeling Trees with a Space
//! Colonization Algorithm", Eurographics Workshop on Natural Phenomena 2007. Widths follow the pipe model.

use super::math::pow;
use super::random::Random;
use glam::Vec3;

/// Node of a skeleton.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Place.
    pub at: Vec3,
    /// Index of the node below; the root is its own parent.
    pub parent: usize,
    /// Number of nodes that grew from it.
    pub children: u32,
    /// Share of all tips that it carries, 0 .. 1.
    pub load: f32,
}

/// Rules of growth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// Length of one step.
    pub step: f32,
    /// Distance at which a point is reached.
    pub reach: f32,
    /// Pull that acts on every step besides the points.
    pub pull: Vec3,
    /// Random deviation of each step.
    pub wander: f32,
    /// Largest number of nodes.
    pub most: usize,
}

/// Skeleton grown from a stem towards points.
pub(super) fn grow(stem: &[Vec3], points: &[Vec3], rules: &Growth, random: &mut Random) -> Vec<Node> {
    grow_shrub(stem, &[], points, rules, random)
}

/// Skeleton grown from a stem, and from shoots around its foot, towards points.
pub(super) fn grow_shrub(
    stem: &[Vec3],
    shoots: &[Vec3],
    points: &[Vec3],
    rules: &Growth,
    random: &mut Random,
) -> Vec<Node> {
    let node = |(i, &at): (usize, &Vec3)| Node { at, parent: i.saturating_sub(1), children: 1, load: 0.0 };
    let mut nodes: Vec<Node> = stem.iter().enumerate().map(node).collect();
    nodes.extend(shoots.iter().map(|&at| Node { at, parent: 0, children: 1, load: 0.0 }));
    let mut near: Vec<(f32, usize)> = vec![(f32::MAX, 0); points.len()];
    let mut first = 0;
    for _ in 0..160 {
        let added = first..nodes.len();
        for (point, near) in points.iter().zip(near.iter_mut()).filter(|(_, n)| n.0 > rules.reach * rules.reach) {
            for i in added.clone() {
                let distance = point.distance_squared(nodes[i].at);
                if distance < near.0 {
                    *near = (distance, i);
                }
            }
        }
        first = nodes.len();
        let mut pulls = vec![Vec3::ZERO; nodes.len()];
        for (point, near) in points.iter().zip(&near).filter(|(_, n)| n.0 > rules.reach * rules.reach) {
            pulls[near.1] += (*point - nodes[near.1].at).normalize_or_zero();
        }
        for (i, pull) in pulls.iter().enumerate() {
            if *pull == Vec3::ZERO || nodes[i].children > 3 || nodes.len() >= rules.most {
                continue;
            }
            let way = pull.normalize_or(Vec3::Z) + rules.pull + random.ball() * rules.wander;
            let at = nodes[i].at + way.normalize_or(Vec3::Z) * rules.step;
            nodes[i].children += 1;
            nodes.push(Node { at, parent: i, children: 0, load: 0.0 });
        }
        if nodes.len() == first {
            break;
        }
    }
    carry(&mut nodes);
    nodes
}

/// Count of the tips above each node, as shares of all.
fn carry(nodes: &mut [Node]) {
    nodes.iter_mut().for_each(|n| n.children = 0);
    for i in 1..nodes.len() {
        nodes[nodes[i].parent].children += 1;
    }
    for i in (1..nodes.len()).rev() {
        if nodes[i].children == 0 {
            nodes[i].load = 1.0;
        }
        nodes[nodes[i].parent].load += nodes[i].load;
    }
    let all = nodes.first().map_or(1.0, |n| n.load).max(1.0);
    nodes.iter_mut().for_each(|n| n.load /= all);
}

/// Smoothing of the zigzags that stepwise growth leaves; branch points and tips stay.
pub(super) fn smooth(nodes: &mut [Node], fixed: usize) {
    let before: Vec<Vec3> = nodes.iter().map(|n| n.at).collect();
    let mut above = vec![Vec3::ZERO; nodes.len()];
    for i in 1..nodes.len() {
        above[nodes[i].parent] = before[i];
    }
    for i in fixed.max(1)..nodes.len() {
        if nodes[i].children == 1 {
            nodes[i].at = before[i] * 0.4 + (before[nodes[i].parent] + above[i]) * 0.3;
        }
    }
}

/// Radius of a branch that carries a share of the tips, as a share of the trunk's radius (pipe model).
pub(super) fn radius(load: f32) -> f32 {
    pow(load, 0.45)
}

/// Branches from the thickest on: each starts at the node it grew from and follows the heaviest child.
pub(super) fn branches(nodes: &[Node]) -> Vec<Vec<usize>> {
    let mut heavy: Vec<Option<usize>> = vec![None; nodes.len()];
    for i in 1..nodes.len() {
        let slot = &mut heavy[nodes[i].parent];
        if slot.is_none_or(|h| nodes[i].load > nodes[h].load) {
            *slot = Some(i);
        }
    }
    let mut branches = Vec::new();
    for i in 0..nodes.len() {
        let own = i == 0 || heavy[nodes[i].parent] != Some(i);
        if own {
            let mut path = if i == 0 { vec![0] } else { vec![nodes[i].parent, i] };
            while let Some(next) = path.last().and_then(|&p| heavy[p]) {
                path.push(next);
            }
            branches.push(path);
        }
    }
    let load = |path: &Vec<usize>| path.get(1).map_or(0.0, |&i| nodes[i].load);
    branches.sort_by(|a, b| load(b).total_cmp(&load(a)));
    branches
}
