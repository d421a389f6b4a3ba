//! A packet: a few points that lie in the same blocks, and the sums over the pieces around each, level by level.
//!
//! Every piece is taken in by all points that share its list at once, so that the loop over these is vectorised. The
//! sums of a point run in the order of the pieces, whichever points it shares a packet with.

use super::blend::{Foot, Jet, Lane, PACKET, Sums};
use super::block::Block;
use super::cache::{Cache, LEVELS};
use super::channel::Cut;
use super::grid::FacePlace;
use super::reach::Line;
use crate::sphere::raster::{NearPoints, Raster};
use glam::DVec3;
use std::ops::Range;

/// Share by which a straight distance may differ from one along the ground, with room to spare.
const BENT: f64 = 1.02;
/// Share by which rounding changes the square of a distance at most, with room to spare.
const ROUNDING: f64 = 1e-9;

/// The points and their sums.
#[derive(Debug, Default)]
pub(super) struct Packet {
    pub(super) points: Vec<(DVec3, FacePlace)>,
    dirs: [Lane; 3],
    near: NearPoints,
    /// Solved ground and relief at each point, without gradients.
    pub(super) solved: [Vec<f64>; 2],
    pub(super) sums: [Sums; LEVELS],
    /// The channels at each point.
    pub(super) cuts: Vec<Cut>,
    /// How far layers over the structure stand from the rivers of no level, of the first, of the first two, and so on.
    pub(super) besides: Vec<[Jet; LEVELS + 1]>,
}

/// A ball around some points: its middle and its radius.
struct Ball(DVec3, f64);

impl Packet {
    /// Takes up the first of some points, in whose blocks the cache is, and those after it that lie there too. How
    /// many these are.
    pub(super) fn fill(&mut self, dirs: &[DVec3], levels: usize, cache: &Cache) -> usize {
        self.points.clear();
        for &dir in dirs.iter().take(PACKET) {
            let place = FacePlace::new(dir);
            if !self.points.is_empty() && !cache.covers(&place, levels) {
                break;
            }
            let at = self.points.len();
            (self.dirs[0][at], self.dirs[1][at], self.dirs[2][at]) = (dir.x, dir.y, dir.z);
            self.points.push((dir, place));
        }
        self.points.len()
    }

    /// Finds solved ground and relief at each point.
    pub(super) fn find_solved(&mut self, rasters: &[Raster<f32>; 2]) {
        self.near.refill(self.points.iter().map(|(dir, _)| *dir));
        for (raster, solved) in rasters.iter().zip(&mut self.solved) {
            raster.values(&self.near, solved);
        }
    }

    /// Sums up the pieces of the first levels around each point. `SLOPES`: with gradients. `CHANNELS`: with the
    /// channels of rivers.
    #[inline(always)]
    pub(super) fn sum_up<const SLOPES: bool, const CHANNELS: bool>(&mut self, levels: usize, cache: &Cache) {
        let count = self.points.len();
        if CHANNELS {
            let cut = Cut::default();
            self.cuts.clear();
            self.cuts.resize(count, cut);
            self.besides.clear();
            self.besides.resize(count, [cut.beside; LEVELS + 1]);
        }
        for (level, current) in cache.current[..levels].iter().enumerate() {
            let Some((_, block)) = current else { continue };
            let mut first = 0;
            while first < count {
                let list = block.near(&self.points[first].1);
                let shares = |(_, place): &(DVec3, FacePlace)| std::ptr::eq(block.near(place), list);
                let points = first..first + self.points[first..].iter().take_while(|point| shares(point)).count();
                self.sum_list::<SLOPES, CHANNELS>((level, level + 1 == levels), points.clone(), block, list);
                first = points.end;
            }
            if CHANNELS {
                for (beside, cut) in self.besides.iter_mut().zip(&self.cuts) {
                    beside[level + 1] = cut.beside;
                }
            }
        }
    }

    /// Sums up the pieces of a list at points that share it. `level`: its number, and whether it is the last one.
    #[inline(always)]
    fn sum_list<const SLOPES: bool, const CHANNELS: bool>(
        &mut self,
        (level, is_last): (usize, bool),
        points: Range<usize>,
        block: &Block,
        list: &[u16],
    ) {
        let ball = Ball::around(&self.points[points.clone()]);
        let Self { points: all, dirs, sums, cuts, .. } = self;
        let sums = &mut sums[level];
        sums.restart(points.clone(), list.first().map_or(0.0, |&first| block.lines[usize::from(first)].bank_m));
        for &number in list {
            let line = &block.lines[usize::from(number)];
            if ball.is_beyond(line) {
                continue;
            }
            sums.take_in::<SLOPES>(points.clone(), dirs, line, number);
            if CHANNELS && line.channel2 > 0.0 {
                let (is_cut, channel) = (line.is_cut(is_last), &block.stream(number).channel);
                let reach2 = channel.farthest2().max(line.channel2) * (1.0 + ROUNDING);
                for i in points.clone().filter(|&i| sums.newest2[i] < reach2) {
                    cuts[i].join(level, is_cut, (number, line, channel), &Foot::new(line, all[i].0));
                }
            }
        }
    }
}

impl Ball {
    #[inline(always)]
    fn around(points: &[(DVec3, FacePlace)]) -> Self {
        let middle = points.iter().map(|(dir, _)| *dir).sum::<DVec3>() / points.len() as f64;
        let radius2 = points.iter().map(|(dir, _)| dir.distance_squared(middle)).fold(0.0, f64::max);
        Self(middle, radius2.sqrt())
    }

    /// Whether all of it lies beyond the influence of a piece. What lies just beyond may count as within.
    #[inline(always)]
    fn is_beyond(&self, line: &Line) -> bool {
        let Self(middle, radius) = *self;
        let v = middle - line.start;
        let share = (v.dot(line.along) * line.per_length2).clamp(0.0, 1.0);
        let away2 = (v - line.along * share).length_squared();
        let influence = BENT / line.per_influence2.sqrt();
        away2 > (influence + radius) * (influence + radius)
    }
}
