//! Finer levels: tributaries that the solver did not resolve.
//!
//! Each cell of a finer level has a node on the ground of the level before, and drains to the steepest of the eight
//! around it (as in Dendry, Gaillard et al. 2019). Nodes near a coarser reach move onto it: there tributaries end.
//! Everything is a pure function of the cells around, so that blocks agree about every reach they share.

use super::Rivers;
use super::block::{Block, Touch, block_of, cells_of};
use super::cache::Cache;
use super::grid::{BESIDE, Cell, FacePlace, Grid, RATIO, STEPS, mixed};
use super::reach::{INFLUENCE, Line, Piece, Reach, width_m};
use super::winding::{REFINED, refine};
use glam::DVec3;
use std::collections::BTreeMap;

/// Rings of cells around a block whose reaches may touch it.
const REACHES: usize = 2;
/// Rings whose cells have a receiver, and whose nodes are needed to find those.
const DRAINED: usize = REACHES + 2;
const NODES: usize = DRAINED + 1;
/// Nodes nearer to a coarser reach than this share of a cell move onto it.
const ANCHOR: f64 = 0.55;
/// Straight pieces of a reach: few, because each costs time at every point near it.
pub(super) const PIECES: usize = 3;
/// Height of springs above the ground of the level before, by the relief between reaches: valleys begin on ridges.
const SPRING: f64 = 0.8;
/// How far the line of the banks goes on uphill from a spring, by the relief between reaches.
pub(super) const RISE: f64 = 0.5;

struct Node {
    cell: Cell,
    index: u64,
    dir: DVec3,
    height_m: f64,
    /// Whether water flows on from here: not in standing water, nor on a coarser reach.
    is_free: bool,
    /// Relief between reaches here.
    relief_m: f64,
    /// Pieces of coarser reaches around.
    lines: Vec<Line>,
    receiver: Option<usize>,
}

/// The nodes of a block and of the rings around it, ring by ring.
struct Net {
    nodes: Vec<Node>,
    /// Positions of the eight around, of nodes that have a receiver.
    around: Vec<[usize; 8]>,
    /// How many nodes lie in the block and its first rings.
    ends: [usize; NODES + 1],
}

impl Rivers {
    /// The block of the coarsest level: reaches of the solved drainage.
    pub(super) fn trunk_block(&self, block: u64) -> Block {
        let grid = &self.trunks.grid;
        let (mut cells, _) = rings(grid, block, REACHES);
        cells.sort_by_key(|cell| grid.index(*cell));
        let mut pieces = Vec::new();
        for reach in cells.into_iter().filter_map(|cell| self.trunks.reach(cell)) {
            reach.cut(PIECES, self.trunks.radius_m, &mut pieces);
        }
        Block::new(grid, block, pieces.into_iter())
    }

    /// A block of a finer level: coarser reaches, then tributaries.
    pub(super) fn tributary_block(&self, grid: &Grid, block: u64, cache: &mut Cache) -> Block {
        let net = self.net(grid, block, cache);
        let mut reaches: Vec<(u64, Reach)> = (0..net.ends[REACHES])
            .filter_map(|node| Some((net.nodes[node].index, self.tributary(grid, &net, node)?)))
            .collect();
        reaches.sort_by_key(|(index, _)| *index);
        let mut pieces = self.coarser(grid, block, cache);
        for (_, reach) in &reaches {
            reach.cut(PIECES, self.trunks.radius_m, &mut pieces);
        }
        Block::new(grid, block, pieces.into_iter())
    }

    /// The pieces of the coarser block around, with the lesser influence that they have on this level.
    fn coarser(&self, grid: &Grid, number: u64, cache: &mut Cache) -> Vec<Piece> {
        let parent = Grid::new(self.trunks.grid.side, grid.level - 1, grid.seed);
        let Some(cell) = cells_of(grid, number).next() else { return Vec::new() };
        let parent_cell = Cell { face: cell.face, x: cell.x / RATIO, y: cell.y / RATIO };
        let block = self.block(parent.level, block_of(&parent, parent_cell), cache);
        let mut pieces = Vec::with_capacity(block.pieces.len() * REFINED);
        let near = Touch::new(grid, number);
        for piece in block.pieces.iter().filter(|piece| near.bounds(piece, RATIO as f64).is_some()) {
            refine(piece, &mut pieces);
        }
        pieces
    }

    fn net(&self, grid: &Grid, block: u64, cache: &mut Cache) -> Net {
        let (cells, ends) = rings(grid, block, NODES);
        let mut nodes: Vec<Node> = cells.iter().map(|&cell| self.child_node(grid, cell, cache)).collect();
        let positions: BTreeMap<u64, usize> = nodes.iter().enumerate().map(|(at, node)| (node.index, at)).collect();
        let position = |cell: Cell| positions.get(&grid.index(cell)).copied().unwrap_or(0);
        let around: Vec<[usize; 8]> = nodes[..ends[DRAINED]]
            .iter()
            .map(|node| STEPS.map(|step| position(grid.beside(node.cell, step))))
            .collect();
        for (at, around) in around.iter().enumerate() {
            nodes[at].receiver = receiver(&nodes, at, around);
        }
        Net { nodes, around, ends }
    }

    fn child_node(&self, grid: &Grid, cell: Cell, cache: &mut Cache) -> Node {
        let (index, dir) = (grid.index(cell), grid.node(cell));
        let at = self.ground(dir, grid.level, cache);
        let anchor_rad = ANCHOR * grid.width_rad(dir);
        let nearest = at.nearest.filter(|near| near.distance2 < anchor_rad * anchor_rad);
        let mut node = Node {
            cell,
            index,
            dir,
            height_m: at.ground.value,
            is_free: false,
            relief_m: at.next_relief_m,
            lines: Vec::new(),
            receiver: None,
        };
        match nearest {
            Some(near) => {
                let Some((_, block)) = &cache.current[grid.level - 1] else { return node };
                // The foot on the reach as this level has it.
                let mut pieces = Vec::with_capacity(REFINED);
                refine(&block.pieces[usize::from(near.piece)], &mut pieces);
                let mut least = f64::MAX;
                for line in pieces.iter().map(|piece| &piece.line) {
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
                    node.lines = self.lines_near(grid.level - 1, dir, cache);
                }
            }
        }
        node
    }

    /// Pieces of coarser reaches, as the next level has them, that a way from a node to a neighbour may cross.
    fn lines_near(&self, level: usize, dir: DVec3, cache: &mut Cache) -> Vec<Line> {
        let grid = &self.grids[level];
        let place = FacePlace::new(dir);
        let block = self.block(level, block_of(grid, grid.cell_at(&place)), cache);
        let far = 2.0 / RATIO as f64 * grid.width_rad(dir);
        let mut pieces = Vec::new();
        for &number in block.near(&place) {
            let piece = &block.pieces[usize::from(number)];
            let line = &piece.line;
            let share = ((dir - line.start).dot(line.along) * line.per_length2).clamp(0.0, 1.0);
            if (line.start + line.along * share).distance_squared(dir) < far * far {
                refine(piece, &mut pieces);
            }
        }
        pieces.into_iter().map(|piece| piece.line).collect()
    }

    fn tributary(&self, grid: &Grid, net: &Net, at: usize) -> Option<Reach> {
        let node = &net.nodes[at];
        let to = node.receiver?;
        let end = &net.nodes[to];
        // Direction of flow through a node, from its main branch to its receiver.
        let tangent = |at: usize| {
            let (main, receiver) = (net.main(at)?, net.nodes[at].receiver?);
            Some(net.nodes[receiver].dir - net.nodes[main].dir)
        };
        let trunk = self.trunks.grid.index(self.trunks.grid.cell_of(node.dir)) as usize;
        let cells = (RATIO * RATIO).pow(grid.level as u32) as f64;
        let runoff = f64::from(self.trunks.runoff_m3_s[trunk]) / cells;
        let discharge = runoff * net.upstream(at, REACHES) as f64;
        let relief_m = f64::from(self.trunks.relief_m[trunk]);
        let flat_rad = 6.0 * width_m(discharge) / (1.0 + relief_m * (1.0 / 60.0)) / self.trunks.radius_m;
        Some(Reach {
            // Below 2^53: a number of JSON that every reader keeps whole.
            river: node.index | ((grid.level as u64) << 48),
            from: node.dir,
            to: end.dir,
            tangents: [tangent(at), tangent(to)],
            is_main: end.is_free && net.main(to) == Some(at),
            bank_m: [node.height_m + if net.main(at).is_none() { SPRING * node.relief_m } else { 0.0 }, end.height_m],
            lake: 0,
            rise_m: RISE * node.relief_m,
            discharge_m3_s: [discharge; 2],
            flat_rad: [flat_rad; 2],
            influence_rad: INFLUENCE * grid.width_rad(node.dir),
        })
    }
}

impl Net {
    /// The gentlest of the branches that flow into a node.
    fn main(&self, at: usize) -> Option<usize> {
        let around = self.around.get(at)?;
        let key = |at: &usize| (self.nodes[*at].height_m, self.nodes[*at].index);
        let flows_here = around.iter().copied().filter(|&other| self.nodes[other].receiver == Some(at));
        flows_here.min_by(|a, b| {
            let ((a_m, a), (b_m, b)) = (key(a), key(b));
            a_m.total_cmp(&b_m).then(a.cmp(&b))
        })
    }

    /// Nodes that flow through a node within some steps, itself included.
    fn upstream(&self, at: usize, steps: usize) -> usize {
        let Some(around) = self.around.get(at).filter(|_| steps > 0) else { return 1 };
        let mut count = 1;
        for (k, &other) in around.iter().enumerate() {
            // At a corner of the cube one neighbour may stand in the list twice.
            if self.nodes[other].receiver == Some(at) && !around[..k].contains(&other) {
                count += self.upstream(other, steps - 1);
            }
        }
        count
    }
}

/// The neighbour to which the ground falls most steeply. Of the two diagonals of four cells only the one with the
/// lowest cell is allowed, so that no two reaches cross.
fn receiver(nodes: &[Node], at: usize, around: &[usize; 8]) -> Option<usize> {
    let node = &nodes[at];
    if !node.is_free {
        return None;
    }
    let below = |a: &Node, b: &Node| a.height_m.total_cmp(&b.height_m).then(a.index.cmp(&b.index)).is_lt();
    let mut best: Option<(f64, usize)> = None;
    for (k, &other) in around.iter().enumerate() {
        let end = &nodes[other];
        let fall_m = node.height_m - end.height_m;
        if fall_m <= 0.0 {
            continue;
        }
        if let Some((a, b)) = BESIDE[k]
            && (below(&nodes[around[a]], end) || below(&nodes[around[b]], end))
        {
            continue;
        }
        if node.lines.iter().any(|line| crosses(node.dir, end.dir, line)) {
            continue;
        }
        let step = node.dir - end.dir;
        // Uneven ground below the scale of the level: without it, all around a hollow would flow straight into it.
        let uneven = 0.5 + (mixed(node.index ^ mixed(end.index)) >> 40) as f64 * (1.0 / (1_u64 << 24) as f64);
        let slope = uneven * fall_m / step.dot(step).sqrt().max(1e-30);
        let is_better = |(least, old): (f64, usize)| slope > least || (slope == least && end.index < nodes[old].index);
        if best.is_none_or(is_better) {
            best = Some((slope, other));
        }
    }
    best.map(|(_, other)| other)
}

/// Whether the straight way between two nodes crosses a piece before its end.
fn crosses(from: DVec3, to: DVec3, line: &Line) -> bool {
    let (a, b) = (line.start, line.start + line.along);
    let side = |p: DVec3, q: DVec3, r: DVec3| p.cross(q).dot(r);
    // A way that ends on a reach does not cross it there.
    let end = from + (to - from) * 0.97;
    (side(a, b, from) > 0.0) != (side(a, b, end) > 0.0) && (side(from, end, a) > 0.0) != (side(from, end, b) > 0.0)
}

/// The cells of a block, then ring by ring those around it; and how many there are up to each ring.
fn rings(grid: &Grid, block: u64, count: usize) -> (Vec<Cell>, [usize; NODES + 1]) {
    let mut cells: Vec<Cell> = cells_of(grid, block).collect();
    let mut known: std::collections::BTreeSet<u64> = cells.iter().map(|cell| grid.index(*cell)).collect();
    let mut ends = [cells.len(); NODES + 1];
    let mut first = 0;
    for ring in 1..=count {
        let last = cells.len();
        for at in first..last {
            for step in STEPS {
                let cell = grid.beside(cells[at], step);
                if known.insert(grid.index(cell)) {
                    cells.push(cell);
                }
            }
        }
        first = last;
        ends[ring..].fill(cells.len());
    }
    (cells, ends)
}
