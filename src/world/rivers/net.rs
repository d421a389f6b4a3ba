//! The nodes around a block of a finer level, and where each drains.
//!
//! Each cell has a node on the ground of the level before, and drains to the steepest of the eight around it (as in
//! Dendry, Gaillard et al. 2019). Nodes near a coarser reach move onto it: there tributaries end. Everything is a pure
//! function of the cells around, so that blocks agree about every reach they share.

use super::Rivers;
use super::block::Square;
use super::cache::Cache;
use super::coarser::Coarser;
use super::grid::{BESIDE, Cell, Grid, RATIO};
use super::reach::Line;
use super::window::Window;
use crate::world::noise::mix;
use glam::DVec3;
use std::ops::Range;

/// Rings of cells around a square whose reaches may touch it.
pub(super) const REACHES: usize = 2;
/// Rings whose cells have a receiver, and whose nodes are needed to find those.
const DRAINED: usize = REACHES + 2;
pub(super) const NODES: usize = DRAINED + 1;
/// Nodes nearer to a coarser reach than this share of a cell move onto it.
const ANCHOR: f64 = 0.55;

/// No node.
const NONE: u32 = u32::MAX;

pub(super) struct Node {
    /// The ring of the cell: 0 in the square.
    pub(super) ring: u8,
    /// Whether water flows on from here: not in standing water, nor on a coarser reach.
    pub(super) is_free: bool,
    /// Position of the node to which water flows on, and of the gentlest branch that flows in; or [`NONE`].
    receiver: u32,
    main: u32,
    /// Nodes that flow in directly, and in two steps.
    inflows: [u16; 2],
    /// Number of the cell in its level.
    pub(super) index: u64,
    pub(super) dir: DVec3,
    pub(super) height_m: f64,
    /// Relief between reaches here.
    pub(super) relief_m: f64,
    /// The coarser lines around; see [`Coarser::near`].
    lines: Range<u32>,
}

/// The nodes of a square and of the rings around it.
pub(super) struct Net {
    pub(super) nodes: Vec<Node>,
}

impl Net {
    pub(super) fn new(rivers: &Rivers, grid: &Grid, square: &Square, cache: &mut Cache) -> Self {
        let Window { cells, around } = Window::new(grid, square, NODES);
        let mut coarser = Coarser::default();
        let mut nodes: Vec<Node> =
            cells.into_iter().map(|(cell, ring)| rivers.child_node(grid, cell, ring, &mut coarser, cache)).collect();
        let drained = |node: &Node| usize::from(node.ring) <= DRAINED;
        for at in (0..nodes.len()).filter(|&at| drained(&nodes[at])).collect::<Vec<_>>() {
            nodes[at].receiver = receiver(&nodes, at, &around[at], &coarser).unwrap_or(NONE);
        }
        let is_gentler = |a: &Node, b: &Node| a.height_m.total_cmp(&b.height_m).then(a.index.cmp(&b.index)).is_lt();
        for at in 0..nodes.len() {
            let Some(to) = follow(nodes[at].receiver) else { continue };
            if follow(nodes[to].main).is_none_or(|main| is_gentler(&nodes[at], &nodes[main])) {
                nodes[to].main = at as u32;
            }
            nodes[to].inflows[0] += 1;
            if let Some(next) = follow(nodes[to].receiver) {
                nodes[next].inflows[1] += 1;
            }
        }
        Self { nodes }
    }

    /// Where water flows on from a node.
    pub(super) fn receiver(&self, at: usize) -> Option<usize> {
        follow(self.nodes[at].receiver)
    }

    /// The gentlest of the branches that flow into a node.
    pub(super) fn main(&self, at: usize) -> Option<usize> {
        follow(self.nodes[at].main)
    }
}

impl Node {
    /// Nodes that flow through this one, itself included, as far as two steps away.
    pub(super) fn upstream(&self) -> u16 {
        1 + self.inflows[0] + self.inflows[1]
    }
}

fn follow(at: u32) -> Option<usize> {
    (at != NONE).then_some(at as usize)
}

impl Rivers {
    fn child_node(&self, grid: &Grid, cell: Cell, ring: u8, coarser: &mut Coarser, cache: &mut Cache) -> Node {
        let (index, dir) = (grid.index(cell), grid.node(cell));
        let at = self.ground_at(dir, grid.level, cache);
        let mut node = Node {
            ring,
            is_free: false,
            receiver: NONE,
            main: NONE,
            inflows: [0; 2],
            index,
            dir,
            height_m: at.ground.value,
            relief_m: at.next_relief_m,
            lines: 0..0,
        };
        let Some((number, block)) = &cache.current[grid.level - 1] else { return node };
        let anchor_rad = ANCHOR * grid.width_rad(dir);
        match at.nearest.filter(|near| near.distance2 < anchor_rad * anchor_rad) {
            Some(near) => {
                // The foot on the reach as this level has it.
                let mut least = f64::MAX;
                for line in coarser.refined(*number, block, near.piece) {
                    let share = ((dir - line.start).dot(line.along) * line.per_length2).clamp(0.0, 1.0);
                    let foot = line.start + line.along * share;
                    if foot.distance_squared(dir) < least {
                        least = foot.distance_squared(dir);
                        node.height_m = line.bank_m + line.bank_change_m * share;
                        node.dir = foot / foot.dot(foot).sqrt();
                    }
                }
            }
            None => {
                node.is_free = self.trunks.standing(at.lake).0.is_none_or(|level_m| node.height_m > level_m);
                if node.is_free && at.nearest.is_some() {
                    // A way to a neighbour is no longer than this.
                    let far_rad = 2.0 / RATIO as f64 * self.grids[grid.level - 1].width_rad(dir);
                    node.lines = coarser.near(*number, block, dir, far_rad);
                }
            }
        }
        node
    }
}

/// The neighbour to which the ground falls most steeply. Of the two diagonals of four cells only the one with the
/// lowest cell is allowed, so that no two reaches cross.
fn receiver(nodes: &[Node], at: usize, around: &[u32; 8], coarser: &Coarser) -> Option<u32> {
    let node = &nodes[at];
    if !node.is_free {
        return None;
    }
    let below = |a: &Node, b: &Node| a.height_m.total_cmp(&b.height_m).then(a.index.cmp(&b.index)).is_lt();
    let beside = |k: usize| &nodes[around[k] as usize];
    let mut best: Option<(f64, u32)> = None;
    for (k, &other) in around.iter().enumerate() {
        let end = beside(k);
        let fall_m = node.height_m - end.height_m;
        if fall_m <= 0.0 {
            continue;
        }
        let step = node.dir - end.dir;
        // Uneven ground below the scale of the level: without it, all around a hollow would flow straight into it.
        let uneven = 0.5 + (mix(node.index ^ mix(end.index)) >> 40) as f64 * (1.0 / (1_u64 << 24) as f64);
        let slope = uneven * fall_m / step.dot(step).sqrt().max(1e-30);
        let is_better =
            best.is_none_or(|(most, old)| slope > most || (slope == most && end.index < nodes[old as usize].index));
        let is_crossed = || BESIDE[k].is_some_and(|(a, b)| below(beside(a), end) || below(beside(b), end));
        if is_better && !is_crossed() && !coarser.lines(&node.lines).any(|line| crosses(node.dir, end.dir, line)) {
            best = Some((slope, other));
        }
    }
    best.map(|(_, other)| other)
}

/// Whether the straight way between two nodes crosses a line before its end.
fn crosses(from: DVec3, to: DVec3, line: &Line) -> bool {
    let (a, b) = (line.start, line.start + line.along);
    // A way that ends on a reach does not cross it there.
    let end = from + (to - from) * 0.97;
    let across = a.cross(b);
    if (across.dot(from) > 0.0) == (across.dot(end) > 0.0) {
        return false;
    }
    let way = from.cross(end);
    (way.dot(a) > 0.0) != (way.dot(b) > 0.0)
}
