//! Blocks of each level: the reaches of the solved drainage, and tributaries that the solver did not resolve.

use super::Rivers;
use super::block::{Block, Square, Touch};
use super::cache::Cache;
use super::grid::{Grid, RATIO};
use super::net::{Net, REACHES};
use super::reach::{INFLUENCE, Piece, Reach, width_m};
use super::winding::{REFINED, refine};
use super::window::Window;

/// Straight pieces of a reach: few, because each costs time at every point near it.
pub(super) const PIECES: usize = 3;
/// Height of springs above the ground of the level before, by the relief between reaches: valleys begin on ridges.
const SPRING: f64 = 0.8;
/// How far the line of the banks goes on uphill from a spring, by the relief between reaches.
pub(super) const RISE: f64 = 0.5;

impl Rivers {
    /// The block of the coarsest level: reaches of the solved drainage.
    pub(super) fn trunk_block(&self, square: &Square) -> Block {
        let grid = &self.trunks.grid;
        let Window { mut cells, .. } = Window::new(grid, square, REACHES);
        cells.sort_by_key(|(cell, _)| grid.index(*cell));
        let mut pieces = Vec::with_capacity(cells.len() * PIECES);
        for reach in cells.into_iter().filter_map(|(cell, _)| self.trunks.reach(cell)) {
            reach.cut(PIECES, self.trunks.radius_m, &mut pieces);
        }
        Block::new(grid, square, &pieces)
    }

    /// A block of a finer level: the reaches of the level before around it, then tributaries.
    pub(super) fn tributary_block(&self, grid: &Grid, square: &Square, parent: &Block, cache: &mut Cache) -> Block {
        let net = Net::new(self, grid, square, cache);
        let near = (0..net.nodes.len()).filter(|&at| usize::from(net.nodes[at].ring) <= REACHES);
        let mut reaches: Vec<(u64, Reach)> =
            near.filter_map(|at| Some((net.nodes[at].index, self.tributary(grid, &net, at)?))).collect();
        reaches.sort_by_key(|(index, _)| *index);
        let mut pieces = coarser(grid, square, parent);
        for (_, reach) in &reaches {
            reach.cut(PIECES, self.trunks.radius_m, &mut pieces);
        }
        Block::new(grid, square, &pieces)
    }

    fn tributary(&self, grid: &Grid, net: &Net, at: usize) -> Option<Reach> {
        let (to, node) = (net.receiver(at)?, &net.nodes[at]);
        let end = &net.nodes[to];
        // Direction of flow through a node, from its main branch to its receiver.
        let tangent = |at: usize| Some(net.nodes[net.receiver(at)?].dir - net.nodes[net.main(at)?].dir);
        let trunk = self.trunks.grid.index(self.trunks.grid.cell_of(node.dir)) as usize;
        let cells = (RATIO * RATIO).pow(grid.level as u32) as f64;
        let runoff = f64::from(self.trunks.runoff_m3_s[trunk]) / cells;
        let discharge = runoff * f64::from(node.upstream());
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

/// The pieces of the level before around a square, with the lesser influence that they have on this level.
fn coarser(grid: &Grid, square: &Square, parent: &Block) -> Vec<Piece> {
    let near = Touch::new(grid, square);
    let mut pieces = Vec::with_capacity(parent.lines.len() * REFINED / 4);
    for piece in parent.pieces().filter(|piece| near.reaches(piece, RATIO as f64)) {
        refine(&piece, &mut |piece| pieces.push(piece));
    }
    pieces
}
