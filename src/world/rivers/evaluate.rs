//! The ground, the water and the river at a point, level by level.

use super::blend::{Jet, Level, Nearest, laid_over};
use super::block::{BLOCK, Block, Square, block_of};
use super::cache::{Cache, LEVELS, Spot};
use super::grid::{Cell, FacePlace, Grid, RATIO};
use super::net::{NODES, REACHES};
use super::packet::Packet;
use super::reach::FREEBOARD;
use super::shore::{Lakeside, sunk};
use super::window::Window;
use super::{River, RiverPoint, Rivers};
use crate::simd::{Simd, for_each_simd};
use glam::DVec3;
use std::sync::Arc;

/// The relief of a level by that of the level before. Slopes grow as cells shrink to a quarter: with the area drained
/// to the power -0.45 (Flint 1974), and that area with the length of the valley to the power 1.75 (Hack 1957), so by
/// 2.98; a little less, because springs lie above the ground.
const RELIEF_RATIO: f64 = 0.7;
/// The relief between the reaches of the coarsest level, by the mean difference in height of neighbouring cells. The
/// same laws give 1.6 times the fall of a river across a cell; differences between rivers are greater than that fall.
pub(super) const RELIEF: f64 = 1.0;
/// The steepest hillslope: a tangent of about 35 degrees.
const STEEPEST: f64 = 0.7;
/// Cells of the solved drainage around a point of the open sea whose ground is looked at: farther than those on whose
/// ground its nodes lie.
const OPEN_SEA: f64 = 8.0;
/// The relief of a level on the reaches of the level before, by that on its ridges.
const LEAST_SHARE: f64 = 0.2;

/// Mean rise of the ground by each level of reaches, by its relief. Measured: see the test of levels that are left out.
const MEAN_RISE: [f64; LEVELS] = [0.4, 0.9, 0.9, 0.9];
/// Mean share of a level's relief that the levels before it leave.
const MEAN_SHARE: f64 = 0.7;
/// Where the mean rise of finer levels begins, and where it is whole: by the influence of a reach. Beds have none.
const RISE_FROM_TO: [f64; 2] = [0.1, 0.5];

/// The ground at a point, and the reaches of its finest level.
pub(super) struct Ground {
    pub(super) ground: Jet,
    /// The ground with the mean rise of the levels that are left out.
    mean: Jet,
    /// The gradient of that for the solved ground alone, for the first level, for the first two, and so on.
    gradients: [DVec3; LEVELS + 1],
    /// Mean of the rise over all levels: 0 in valleys, 1 on ridges.
    ridge: f64,
    pub(super) nearest: Option<Nearest>,
    /// The cell of the solved drainage.
    trunk: usize,
    /// The lake whose basin this is, counted from 1.
    pub(super) lake: u32,
    /// The lakes around, and the height of the banks of the nearest reach if that has nothing to do with a lake.
    lakeside: Option<Lakeside>,
    dry_bank_m: Option<f64>,
    /// The relief of the level after the finest one.
    pub(super) next_relief_m: f64,
}

impl Rivers {
    /// The block of a level, built if it is not there.
    pub(super) fn block(&self, level: usize, number: u64, cache: &mut Cache) -> Arc<Block> {
        self.blocks.get(level, number, || {
            let grid = &self.grids[level];
            let square = Square::of_block(grid, number);
            let Some(before) = level.checked_sub(1) else { return self.trunk_block(&square) };
            let parent = Cell { face: square.face, x: square.left / RATIO, y: square.top / RATIO };
            let parent = self.block(before, block_of(&self.grids[before], parent), cache);
            self.tributary_block(grid, &square, &parent, cache)
        })
    }

    /// Makes the blocks of the first levels at a place current. `is_asked`: for a point that was asked for, which may
    /// stand alone, not for a node of a block that is built.
    #[inline(always)]
    pub(super) fn find_blocks(&self, place: &FacePlace, levels: usize, is_asked: bool, cache: &mut Cache) {
        if !cache.covers(place, levels) {
            if is_asked && cache.is_spread {
                self.find_spot(place, levels, cache);
            } else {
                self.find_whole(place, levels, cache);
            }
        }
    }

    /// Makes blocks current for a point that may stand alone: those of the spot of its cell. A spot is made if no other
    /// spot of the thread lay in the same block lately. Otherwise the whole block is built.
    #[inline(never)]
    fn find_spot(&self, place: &FacePlace, levels: usize, cache: &mut Cache) {
        let Some(finest) = self.grids[..levels].last() else { return };
        let cell = finest.cell_at(place);
        let key = (levels, finest.index(cell));
        let spot = self.blocks.spot(key).or_else(|| {
            let block = (levels, block_of(finest, cell));
            if cache.lately.contains(&Some(block)) || self.blocks.has(levels - 1, block.1) {
                return None;
            }
            cache.lately.rotate_right(1);
            cache.lately[0] = Some(block);
            let spot = self.new_spot(cell, levels)?;
            self.blocks.keep_spot(key, &spot);
            Some(spot)
        });
        match spot {
            // Numbers of blocks are far smaller.
            Some(spot) => cache.current = spot.map(|block| Some((key.1 | 1 << 63, block?))),
            None => self.find_whole(place, levels, cache),
        }
    }

    /// Whether no reach of any level is near a cell in a direction. All ground around lies under the sea, and no cell
    /// has a reach of the solved drainage, as land below the level of the sea has. `square`: the coarsest cells that
    /// the spot needs.
    fn is_open_sea(&self, dir: DVec3, square: &Square) -> bool {
        let grid = &self.trunks.grid;
        let far_rad = OPEN_SEA * grid.width_rad(dir);
        let has_reach = |(cell, _): &(Cell, u8)| self.trunks.ends(grid.index(*cell) as usize).is_some();
        self.trunks.sea_level_m.is_some_and(|sea_m| self.bounds.near(dir, far_rad).1 < sea_m)
            && !Window::new(grid, square, REACHES).cells.iter().any(has_reach)
    }

    /// The pieces near a cell, from blocks that hold no more than it needs. None near an edge of a face.
    fn new_spot(&self, cell: Cell, levels: usize) -> Option<Spot> {
        let mut squares = [Square::of_cell(cell); LEVELS];
        for level in (1..levels).rev() {
            squares[level - 1] = squares[level].parents(&self.grids[level], NODES)?;
        }
        let finest = self.grids[..levels].last()?;
        if self.is_open_sea(finest.node(cell), &squares[0]) {
            for level in (1..levels).rev() {
                squares[level - 1] = squares[level].parents(&self.grids[level], 0)?;
            }
            return Some(std::array::from_fn(|level| {
                (level < levels).then(|| Arc::new(Block::new(&self.grids[level], &squares[level], &[])))
            }));
        }
        let mut cache = Cache::default();
        let mut parent: Option<Arc<Block>> = None;
        for (level, (square, grid)) in squares.iter().zip(&self.grids).enumerate().take(levels) {
            let block = Arc::new(match &parent {
                None => self.trunk_block(square),
                Some(parent) => self.tributary_block(grid, square, parent, &mut cache),
            });
            cache.current[level] = Some((u64::MAX, block.clone()));
            parent = Some(block);
        }
        let mut spot = [const { None }; LEVELS];
        for (level, (slot, current)) in spot.iter_mut().zip(&cache.current).enumerate().take(levels) {
            let (_, block) = current.as_ref()?;
            // A cell of the next level is a bucket of this one.
            *slot = Some(if level + 1 == levels {
                block.clone()
            } else {
                let per_bucket = RATIO.pow((levels - 2 - level) as u32);
                Arc::new(block.cropped([cell.x / per_bucket, cell.y / per_bucket]))
            });
        }
        Some(spot)
    }

    /// Makes whole blocks current. They are built if they are not there.
    fn find_whole(&self, place: &FacePlace, levels: usize, cache: &mut Cache) {
        // Building a block moves the current blocks of coarser levels, so that the search starts again.
        loop {
            let mut moved = false;
            for (level, grid) in self.grids[..levels].iter().enumerate() {
                if cache.current[level].as_ref().is_none_or(|(_, block)| !block.covers(place)) {
                    let number = block_of(grid, grid.cell_at(place));
                    let block = self.block(level, number, cache);
                    cache.current[level] = Some((number, block));
                    moved = true;
                }
            }
            if !moved {
                return;
            }
        }
    }

    /// The ground at a direction alone, without channels and gradients.
    pub(super) fn ground_at(&self, dir: DVec3, levels: usize, cache: &mut Cache) -> Ground {
        self.find_blocks(&FacePlace::new(dir), levels, false, cache);
        let mut packet = cache.packet.take().unwrap_or_default();
        packet.fill(&[dir], levels, cache);
        packet.sum_up::<false, false>(levels, cache);
        packet.find_solved(&self.rasters);
        let ground = self.ground::<false>(&packet, 0, levels, cache);
        cache.packet = Some(packet);
        ground
    }

    /// The ground of the first `levels` levels at a point of a packet.
    #[inline(always)]
    fn ground<const SLOPES: bool>(&self, packet: &Packet, number: usize, levels: usize, cache: &Cache) -> Ground {
        let (dir, face_place) = packet.points[number];
        let tangential = |(value, gradient): (f64, DVec3)| Jet { value, gradient: gradient - dir * gradient.dot(dir) };
        let of_rasters = if SLOPES {
            let place = self.rasters[0].place(dir);
            self.rasters.each_ref().map(|raster| tangential(raster.sample(&place, 0)))
        } else {
            packet.solved.each_ref().map(|solved| Jet { value: solved[number], gradient: DVec3::ZERO })
        };
        let (solved, relief) = (of_rasters[0], of_rasters[1].scaled(RELIEF));
        let trunk = self.trunks.grid.index(self.trunks.grid.cell_at(&face_place)) as usize;
        let (mut lake, lakeside, mut dry_bank_m) = (self.trunks.lake_near(trunk), self.lakeside(dir, trunk), None);
        // What nobody reads, the compiler leaves out; it cannot where an array is read at unknown numbers.
        let flat = |jet: Jet| if SLOPES { jet } else { Jet { gradient: DVec3::ZERO, ..jet } };
        let amplitudes = self.amplitudes(relief).map(flat);
        let rises = mean_rises(&amplitudes).map(flat);
        let drowned = |ground: Jet| {
            // Off the coast the solved sea floor holds, as the solved bed does in a lake.
            let depth_m = self.trunks.sea_level_m.map(|sea_m| solved.scaled(-1.0).plus_number(sea_m));
            let ground = depth_m.map_or(ground, |depth_m| sunk(ground, solved, depth_m));
            lakeside.map_or(ground, |lakeside| lakeside.drowned(ground, solved))
        };
        let (mut ground, mut share) = (solved, Jet { value: 1.0, gradient: DVec3::ZERO });
        let mut mean = drowned(ground.plus(rises[0]));
        let mut gradients = [DVec3::ZERO; LEVELS + 1];
        if SLOPES {
            gradients[0] = mean.gradient;
        }
        let (mut scale, mut ridge, mut ridges, mut nearest) = (1.0, 0.0, 0.0, None);
        for k in 0..levels {
            let Some((_, block)) = &cache.current[k] else { continue };
            let here = packet.sums[k].level(number);
            let x = here.x;
            let laid = laid_over(ground, amplitudes[k].times(share), &here);
            ground = drowned(laid);
            share = share.times(x.mapped(LEAST_SHARE + (1.0 - LEAST_SHARE) * x.value, 1.0 - LEAST_SHARE));
            let rise = rises[k + 1].times(share).times(beside(x));
            mean = drowned(laid.plus(rise));
            if SLOPES {
                // Sums of tangential parts keep a little of the radial one.
                gradients[k + 1] = mean.gradient - dir * mean.gradient.dot(dir);
            }
            ridges += scale;
            ridge += scale * x.value;
            scale *= RELIEF_RATIO;
            if k == 0 && lake != 0 {
                (lake, dry_bank_m) = self.lake_at(lake, &here, block);
            }
            nearest = here.nearest;
        }
        let ridge = if ridges > 0.0 { ridge / ridges } else { 0.0 };
        let next_relief_m = amplitudes.get(levels).map_or(0.0, |amplitude| amplitude.value * share.value);
        Ground { ground, mean, gradients, ridge, nearest, trunk, lake, lakeside, dry_bank_m, next_relief_m }
    }

    /// The relief of each level, where no level before it takes a share.
    #[inline(always)]
    fn amplitudes(&self, relief: Jet) -> [Jet; LEVELS] {
        let mut scale = 1.0;
        self.steepest_m.map(|steepest_m| {
            let amplitude = capped(relief.scaled(scale), steepest_m);
            scale *= RELIEF_RATIO;
            amplitude
        })
    }

    /// The lake near a point if its water may stand there: not where the nearest reach lies below it, beyond its sill.
    /// And the height of the banks of that reach, if it flows neither into a lake nor out of one.
    fn lake_at(&self, lake: u32, here: &Level, block: &Block) -> (u32, Option<f64>) {
        let Some(near) = &here.nearest else { return (lake, None) };
        let line = &block.lines[usize::from(near.piece)];
        let bank_m = line.bank_m + line.bank_change_m * near.share;
        match block.stream(near.piece).lake {
            0 if self.trunks.standing(lake).0.is_some_and(|level_m| bank_m < level_m) => (0, Some(bank_m)),
            0 => (lake, Some(bank_m)),
            own => (own, None),
        }
    }

    /// How many levels have cells no finer than this many points.
    pub(crate) fn levels_for(&self, spacing_rad: f64, points: f64) -> usize {
        self.grids.iter().take_while(|grid| 2.0 / grid.side as f64 > points * spacing_rad).count()
    }

    /// Whether points are so few or so far apart that blocks would be built for one point each.
    pub(super) fn is_spread(&self, dirs: &[DVec3], levels: usize) -> bool {
        let (Some(grid), [first, ..]) = (self.grids[..levels].last(), dirs) else { return true };
        let block2 = (BLOCK as f64 * grid.width_rad(*first)).powi(2);
        let far = dirs.windows(2).filter(|pair| pair[0].distance_squared(pair[1]) > block2).count();
        2 * far >= dirs.len() - 1
    }

    /// Evaluates points near each other, in order: one answer for each direction. Without `slopes` gradients are 0,
    /// which takes less time.
    pub(crate) fn evaluate(
        &self,
        dirs: &[DVec3],
        slopes: bool,
        levels: usize,
        cache: &mut Cache,
        out: &mut Vec<RiverPoint>,
    ) {
        for_each_simd!(fn with_slopes(
            rivers: &Rivers, dirs: &[DVec3], levels: usize, cache: &mut Cache, out: &mut Vec<RiverPoint>
        ) = points::<true>);
        for_each_simd!(fn without_slopes(
            rivers: &Rivers, dirs: &[DVec3], levels: usize, cache: &mut Cache, out: &mut Vec<RiverPoint>
        ) = points::<false>);
        cache.belongs_to(self.number);
        cache.is_spread = self.is_spread(dirs, levels);
        out.clear();
        out.reserve(dirs.len());
        let evaluate = if slopes { with_slopes } else { without_slopes };
        evaluate(Simd::detect(), self, dirs, levels, cache, out);
    }

    /// The answer at a point of a packet.
    #[inline(always)]
    fn point<const SLOPES: bool>(&self, packet: &Packet, number: usize, levels: usize, cache: &Cache) -> RiverPoint {
        let (dir, cut, beside) = (packet.points[number].0, &packet.cuts[number], packet.besides[number]);
        let at = self.ground::<SLOPES>(packet, number, levels, cache);
        let bed = cut.bed(at.mean);
        let mut gradients = [DVec3::ZERO; LEVELS + 1];
        if SLOPES {
            gradients = at.gradients;
            if let Some(gradient) = gradients.get_mut(levels) {
                *gradient = bed.gradient - dir * bed.gradient.dot(dir);
            }
        }
        // In lakes layers are lower, too.
        let off_lakes = at.lakeside.map(|lakeside| lakeside.beside());
        let layers = beside.map(|beside| {
            let Jet { value, gradient } = off_lakes.map_or(beside, |off| beside.times(off));
            Jet { value, gradient: if SLOPES { gradient - dir * gradient.dot(dir) } else { DVec3::ZERO } }
        });
        let lake_level_m = at.lakeside.and_then(|lakeside| self.shore_m(&lakeside, at.dry_bank_m));
        let mut point = RiverPoint {
            height_m: bed.value,
            gradients,
            rise_m: cut.rise_m(),
            lake: if at.lake == 0 && lake_level_m.is_some() { self.trunks.lake_near(at.trunk) } else { at.lake },
            lake_level_m,
            layers,
            ridge: 2.0 * at.ridge - 1.0,
            river: None,
        };
        // The channel that the point is in, or the nearest reach.
        let last = levels.wrapping_sub(1);
        let near = cut.river.or_else(|| Some((last, at.nearest?)));
        if let Some((level, near)) = near
            && let Some((_, block)) = cache.current.get(level).and_then(Option::as_ref)
        {
            let (line, stream) = (&block.lines[usize::from(near.piece)], block.stream(near.piece));
            let channel = &stream.channel;
            let depth_m = channel.depth_m + channel.depth_change_m * near.share;
            let along = line.along - dir * line.along.dot(dir);
            point.river = Some(River {
                id: stream.river,
                distance_m: near.distance2.sqrt() * self.trunks.radius_m,
                width_m: 2.0 * channel.half_width_rad(near.share) * self.trunks.radius_m,
                depth_m: depth_m * (1.0 - FREEBOARD),
                discharge_m3_s: channel.discharge_m3_s + channel.discharge_change_m3_s * near.share,
                flow: along / along.dot(along).sqrt().max(1e-30),
            });
        }
        point
    }
}

#[inline(always)]
fn points<const SLOPES: bool>(
    rivers: &Rivers,
    dirs: &[DVec3],
    levels: usize,
    cache: &mut Cache,
    out: &mut Vec<RiverPoint>,
) {
    let mut rest = dirs;
    while let [first, ..] = rest {
        rivers.find_blocks(&FacePlace::new(*first), levels, true, cache);
        let mut packet = cache.packet.take().unwrap_or_default();
        let count = packet.fill(rest, levels, cache);
        packet.sum_up::<SLOPES, true>(levels, cache);
        if !SLOPES {
            packet.find_solved(&rivers.rasters);
        }
        for number in 0..count {
            out.push(rivers.point::<SLOPES>(&packet, number, levels, cache));
        }
        cache.packet = Some(packet);
        rest = &rest[count..];
    }
}

/// The mean rise of the ground by the levels from each one on; the last is that of none.
#[inline(always)]
fn mean_rises(amplitudes: &[Jet; LEVELS]) -> [Jet; LEVELS + 1] {
    let mut rises = [Jet::default(); LEVELS + 1];
    for (k, amplitude) in amplitudes.iter().enumerate().rev() {
        rises[k] = amplitude.scaled(MEAN_RISE[k]).plus(rises[k + 1].scaled(MEAN_SHARE));
    }
    rises
}

/// The share of the mean rise of finer levels beside the reaches of a level.
#[inline(always)]
fn beside(x: Jet) -> Jet {
    let [from, to] = RISE_FROM_TO;
    let t = ((x.value - from) * (1.0 / (to - from))).clamp(0.0, 1.0);
    x.mapped(t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) * (1.0 / (to - from)))
}

/// A relief that approaches the steepest possible one, never above it.
#[inline(always)]
fn capped(relief: Jet, cap_m: f64) -> Jet {
    let per = 1.0 / (relief.value * relief.value + cap_m * cap_m).sqrt();
    relief.mapped(relief.value * cap_m * per, cap_m * cap_m * cap_m * per * per * per)
}

/// The greatest relief of a level: the steepest hillslope over the distance between its reaches, metres.
pub(super) fn steepest_m(grid: &Grid, radius_m: f64) -> f64 {
    STEEPEST * 0.4 * (2.0 / grid.side as f64) * radius_m
}

/// Bound of the rise of all levels above the reaches, by the relief of the cells: springs, drawn-out banks and ridges
/// together stay below 1.45 times the relief of their level.
pub(super) const MOST_RELIEF: f64 = 1.45 * RELIEF * (1.0 + RELIEF_RATIO * (1.0 + RELIEF_RATIO * (1.0 + RELIEF_RATIO)));
