//! Lines of coarser reaches near the nodes of a block, as the finer level has them. Each piece is refined once.

use super::block::Block;
use super::grid::FacePlace;
use super::reach::Line;
use super::winding::{REFINED, refine};
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// A piece that has not been refined yet.
const NOT_YET: u32 = u32::MAX;

#[derive(Default)]
pub(super) struct Coarser {
    /// The coarser blocks, by number, and for each of their pieces the first of its lines.
    blocks: Vec<(u64, Arc<Block>, Vec<u32>)>,
    /// [`REFINED`] lines for each piece.
    lines: Vec<Line>,
    /// First lines of the pieces near nodes; nodes have ranges of it.
    near: Vec<u32>,
}

impl Coarser {
    /// The lines of a piece of a block.
    pub(super) fn refined(&mut self, number: u64, block: &Arc<Block>, piece: u16) -> &[Line] {
        let slot = self.slot(number, block);
        let first = self.first_line(slot, piece) as usize;
        &self.lines[first..first + REFINED]
    }

    /// Finds the lines of pieces within an angle of a direction.
    pub(super) fn near(&mut self, number: u64, block: &Arc<Block>, dir: DVec3, far_rad: f64) -> Range<u32> {
        let slot = self.slot(number, block);
        let start = self.near.len() as u32;
        for &piece in block.near(&FacePlace::new(dir)) {
            let line = &block.lines[usize::from(piece)];
            let share = ((dir - line.start).dot(line.along) * line.per_length2).clamp(0.0, 1.0);
            if (line.start + line.along * share).distance_squared(dir) < far_rad * far_rad {
                let first = self.first_line(slot, piece);
                self.near.push(first);
            }
        }
        start..self.near.len() as u32
    }

    /// The lines of a range that [`Coarser::near`] gave.
    pub(super) fn lines(&self, near: &Range<u32>) -> impl Iterator<Item = &Line> {
        let firsts = &self.near[near.start as usize..near.end as usize];
        firsts.iter().flat_map(|&first| &self.lines[first as usize..first as usize + REFINED])
    }

    fn slot(&mut self, number: u64, block: &Arc<Block>) -> usize {
        self.blocks.iter().position(|(known, ..)| *known == number).unwrap_or_else(|| {
            self.blocks.push((number, block.clone(), vec![NOT_YET; block.lines.len()]));
            self.blocks.len() - 1
        })
    }

    fn first_line(&mut self, slot: usize, piece: u16) -> u32 {
        let (_, block, firsts) = &mut self.blocks[slot];
        let first = &mut firsts[usize::from(piece)];
        if *first == NOT_YET {
            *first = self.lines.len() as u32;
            refine(&block.piece(piece), &mut |piece| self.lines.push(piece.line));
        }
        *first
    }
}
