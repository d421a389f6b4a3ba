//! Cells (Worley 1996): jittered centres in space, each with the ground that is nearest to it.
//!
//! Distances are squared and in lattice cells. The difference of the squared distances to two centres is linear
//! across the border between them, so that slopes and cracks are straight and need no root.
//!
//! Which lattice cells to search: with centres at most [`JITTER`] from the middle of their cell along each axis, the
//! eight cells nearest to a point hold at least two centres within sqrt(3) (0.5 + JITTER) = 1.5503. Cells outside
//! [`neighbourhood`] are at least 2 - JITTER = 1.605 away along one axis, or 1.5 - JITTER along two, which is
//! sqrt([`HORIZON`]) = 1.5627. So the two nearest centres are always found, and nothing jumps as the search moves on.
//!
//! Of these cells, most cannot matter for any point of a chunk once the eight nearest are known: [`least_distance`]
//! tells, and they are left out. This changes no bit.

mod near;

use super::octaves::{Weighted, series};
use super::places::{CORNERS, Places, neighbour, unit};
use super::{Arithmetic, Chunk, Evaluate, JETS, Scratch, Scratch64};
use crate::planet::{self, CellStyle};
use crate::simd::for_each_simd;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::{self, Octave};
use crate::terrain::scalar::Scalar;
use glam::DVec3;
use near::Near;

/// Greatest distance of a centre from the middle of its cell along each axis, in cells.
const JITTER: f32 = 0.395;
/// Square of the distance within which all centres are found: 2 (1.5 - JITTER)^2.
const HORIZON: f32 = 2.442;
/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.12;
/// Points per border width, or per half dome, at which they show in full.
const LEAST_POINTS: f64 = 1.2;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cells {
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
    style: CellStyle,
    jitter: f32,
    width: f32,
}

impl Cells {
    pub(super) fn new(params: &planet::Cells, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Cells { cell_km, style, width, jitter, octaves, gain, lacunarity } = *params;
        let octaves = series(seed, radius_km / cell_km, octaves, gain, lacunarity);
        Self {
            f64_octaves: arithmetic.f64_octaves(&octaves, REST),
            octaves,
            style,
            jitter: JITTER * jitter as f32,
            width: width as f32,
        }
    }
}

impl Evaluate for Cells {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.001, if self.style == CellStyle::Cracks { 0.0 } else { 1.001 })
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let (least, most) = self.bounds();
        self.octaves.iter().fold((-1e-5, 1e-5), |(lo, hi), Weighted { octave, weight }| {
            let near = Near::new(octave, self.jitter, dir_planet, angle_rad);
            let (low, high) = match self.style {
                CellStyle::Plates => near.plates(f64::from(self.width)).unwrap_or((least, most)),
                CellStyle::Cracks => near.cracks(f64::from(self.width)),
                CellStyle::Bumps => near.bumps(),
            };
            (lo + low.clamp(least, most) * f64::from(*weight), hi + high.clamp(least, most) * f64::from(*weight))
        })
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, jets, places, in_f64, .. } = scratch;
        let width = if self.style == CellStyle::Bumps { 0.5 } else { f64::from(self.width) };
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let fades = chunk.fades(width / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                break;
            }
            let unseen = fades.is_unseen();
            let is_f64 = k < chunk.f64_octaves(self.f64_octaves);
            if is_f64 {
                let Scratch64 { jets, places, .. } = in_f64;
                let height = self.octave::<f64>(chunk, octave, places, jets);
                sums.add_f64(chunk, &height.value, f64::from(*weight));
                if unseen {
                    continue;
                }
            }
            let evaluate = if unseen { Self::octave::<f32> } else { Self::octave::<Jet> };
            let height = evaluate(self, chunk, octave, places, jets);
            if is_f64 {
                sums.add_gradients(chunk, &height.gradient, *weight, &fades);
            } else {
                sums.add(chunk, &height.value, &height.gradient, *weight, &fades);
            }
        }
    }
}

impl Cells {
    /// The height of one octave.
    fn octave<'j, R: Real>(
        &self,
        chunk: &Chunk<'_>,
        octave: &Octave,
        places: &mut Places<R::S>,
        jets: &'j mut [Jets<R::S>; JETS],
    ) -> &'j Jets<R::S> {
        let [first, second, steepness, shares, levels, height, ..] = jets;
        let (simd, n, seed, frequency) = (chunk.simd, chunk.len(), octave.seed, octave.frequency as f32);
        places.find(simd, chunk.skewed, octave);
        first.fill(n, R::S::MOST);
        second.fill(n, R::S::MOST);
        let least = |step: &[i32; 3]| R::S::from_f32(least_distance(*step, self.jitter));
        if self.style == CellStyle::Cracks {
            for step in CORNERS {
                meet_two::<R>(simd, n, places, step, seed, self.jitter, first, second);
            }
            let farthest = second.greatest(n);
            for step in farther_cells().filter(|step| least(step) < farthest) {
                meet_two::<R>(simd, n, places, step, seed, self.jitter, first, second);
            }
        } else {
            for step in CORNERS {
                meet::<R>(simd, n, places, step, seed, self.jitter, first);
            }
            let farthest = first.greatest(n);
            for step in farther_cells().filter(|step| least(step) < farthest) {
                meet::<R>(simd, n, places, step, seed, self.jitter, first);
            }
        }
        match self.style {
            CellStyle::Plates => {
                begin::<R>(simd, n, self.width, first, steepness);
                shares.fill(n, R::S::default());
                levels.fill(n, R::S::default());
                // Beyond this distance a plate has no share.
                let farthest = first.greatest(n) + R::S::from_f32(self.width);
                for step in neighbourhood().filter(|step| least(step) < farthest) {
                    share::<R>(simd, n, places, step, seed, self.jitter, first, steepness, shares, levels);
                }
                level::<R>(simd, n, frequency, shares, levels, height);
            }
            CellStyle::Cracks => crack::<R>(simd, n, frequency, self.width, first, second, height),
            CellStyle::Bumps => swell::<R>(simd, n, frequency, first, height),
        }
        height
    }
}

/// The cells to search, in steps towards the nearer side: all around a point, and one further along one axis on its
/// nearer side.
fn neighbourhood() -> impl Iterator<Item = [i32; 3]> {
    let all = (0..64).map(|k| [(k & 3) - 1, ((k >> 2) & 3) - 1, (k >> 4) - 1]);
    all.filter(|step| step.iter().filter(|s| **s == 2).count() <= 1)
}

/// The same without the eight nearest ones.
fn farther_cells() -> impl Iterator<Item = [i32; 3]> {
    neighbourhood().filter(|step| !CORNERS.contains(step))
}

/// A squared distance that no point of a cell has less of to the centre of the cell at a number of steps, with room for
/// rounding.
fn least_distance(step: [i32; 3], jitter: f32) -> f32 {
    // A point is at most half a cell away from the nearer side of its own cell, and at least half from the other side.
    let along = |steps: i32| match steps {
        0 => 0.0,
        steps if steps < 0 => -steps as f32 - jitter,
        steps => steps as f32 - 0.5 - jitter,
    };
    0.999 * step.map(along).map(|away| away * away).iter().sum::<f32>()
}

/// The squared distance to the centre of a cell, and the hash of that cell.
#[inline(always)]
fn centre<R: Real>(places: &Places<R::S>, step: [i32; 3], seed: u32, jitter: f32, i: usize) -> (R, u32) {
    let (cell, from) = neighbour(places, step, i);
    let random = noise::cell_hash(cell, seed);
    let (low, span) = (R::S::from_f32(0.5 - jitter), R::S::from_f32(2.0 * jitter));
    let towards = |axis: usize, bits: u32| from[axis] + low + span * unit(bits) - places.fraction[axis][i];
    let (x, y, z) = (towards(0, random), towards(1, random >> 10), towards(2, random >> 20));
    let twice = R::S::of(-2.0);
    (R::of(x * x + y * y + z * z, [twice * x, twice * y, twice * z]), random)
}

/// Keeps the nearest centre.
#[inline(always)]
fn meet_body<R: Real>(n: usize, places: &Places<R::S>, step: [i32; 3], seed: u32, jitter: f32, first: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        let (here, _) = centre::<R>(places, step, seed, jitter, i);
        let one = R::load(first, i);
        R::select(here.value() < one.value(), here, one).store(first, i);
    }
}
for_each_simd!(fn meet<R: Real>(n: usize, places: &Places<R::S>, step: [i32; 3], seed: u32, jitter: f32, first: &mut Jets<R::S>) = meet_body);

/// Keeps the two nearest centres.
#[inline(always)]
fn meet_two_body<R: Real>(
    n: usize,
    places: &Places<R::S>,
    step: [i32; 3],
    seed: u32,
    jitter: f32,
    first: &mut Jets<R::S>,
    second: &mut Jets<R::S>,
) {
    for i in 0..n.min(CHUNK) {
        let (here, _) = centre::<R>(places, step, seed, jitter, i);
        let (one, two) = (R::load(first, i), R::load(second, i));
        let nearest = here.value() < one.value();
        let farther = R::select(nearest, one, here);
        R::select(nearest, here, one).store(first, i);
        R::select(farther.value() < two.value(), farther, two).store(second, i);
    }
}
for_each_simd!(fn meet_two<R: Real>(n: usize, places: &Places<R::S>, step: [i32; 3], seed: u32, jitter: f32, first: &mut Jets<R::S>, second: &mut Jets<R::S>) = meet_two_body);

/// The steepness with which a plate's share falls off beyond its border: never so low that centres beyond the horizon
/// would count.
#[inline(always)]
fn begin_body<R: Real>(n: usize, width: f32, first: &Jets<R::S>, steepness: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        (-R::load(first, i)).plus(HORIZON).at_most(width).recip().store(steepness, i);
    }
}
for_each_simd!(fn begin<R: Real>(n: usize, width: f32, first: &Jets<R::S>, steepness: &mut Jets<R::S>) = begin_body);

/// Adds the share of a cell's plate at each point, and its level times the share.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn share_body<R: Real>(
    n: usize,
    places: &Places<R::S>,
    step: [i32; 3],
    seed: u32,
    jitter: f32,
    first: &Jets<R::S>,
    steepness: &Jets<R::S>,
    shares: &mut Jets<R::S>,
    levels: &mut Jets<R::S>,
) {
    for i in 0..n.min(CHUNK) {
        let (here, random) = centre::<R>(places, step, seed, jitter, i);
        let beyond = (here - R::load(first, i)) * R::load(steepness, i);
        let share = (-beyond).plus(1.0).at_least(0.0).square();
        let level = 2.0 * unit::<f32>(noise::scramble(random)) - 1.0;
        (R::load(shares, i) + share).store(shares, i);
        (R::load(levels, i) + share.scale(level)).store(levels, i);
    }
}
for_each_simd!(fn share<R: Real>(n: usize, places: &Places<R::S>, step: [i32; 3], seed: u32, jitter: f32, first: &Jets<R::S>, steepness: &Jets<R::S>, shares: &mut Jets<R::S>, levels: &mut Jets<R::S>) = share_body);

/// The mean level of the plates, weighted by their shares. The nearest plate's share is 1, so the sum is never 0.
#[inline(always)]
fn level_body<R: Real>(n: usize, frequency: f32, shares: &Jets<R::S>, levels: &Jets<R::S>, height: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        let level = R::load(levels, i) * R::load(shares, i).recip();
        level.chain(level.value(), R::S::from_f32(frequency)).store(height, i);
    }
}
for_each_simd!(fn level<R: Real>(n: usize, frequency: f32, shares: &Jets<R::S>, levels: &Jets<R::S>, height: &mut Jets<R::S>) = level_body);

/// Cracks along the borders.
#[inline(always)]
fn crack_body<R: Real>(
    n: usize,
    frequency: f32,
    width: f32,
    first: &Jets<R::S>,
    second: &Jets<R::S>,
    height: &mut Jets<R::S>,
) {
    for i in 0..n.min(CHUNK) {
        let crack = (R::load(second, i) - R::load(first, i)).smoothstep(0.0, width).plus(-1.0);
        crack.chain(crack.value(), R::S::from_f32(frequency)).store(height, i);
    }
}
for_each_simd!(fn crack<R: Real>(n: usize, frequency: f32, width: f32, first: &Jets<R::S>, second: &Jets<R::S>, height: &mut Jets<R::S>) = crack_body);

/// Domes around the centres.
#[inline(always)]
fn swell_body<R: Real>(n: usize, frequency: f32, first: &Jets<R::S>, height: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        let dome = R::load(first, i).scale(-2.0).plus(1.0).at_least(-1.0);
        dome.chain(dome.value(), R::S::from_f32(frequency)).store(height, i);
    }
}
for_each_simd!(fn swell<R: Real>(n: usize, frequency: f32, first: &Jets<R::S>, height: &mut Jets<R::S>) = swell_body);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every cell that is left out is farther away than the two nearest centres can be.
    #[test]
    fn the_search_finds_the_two_nearest_centres() {
        let known: Vec<[i32; 3]> = neighbourhood().collect();
        assert_eq!(known.len(), 54);
        let (lo, hi) = (0.5 - f64::from(JITTER), 0.5 + f64::from(JITTER));
        // A point in the lower half of its cell along each axis: the nearer side is down.
        for p in (0..1331).map(|k| [k % 11, k / 11 % 11, k / 121].map(|w| f64::from(w) * 0.05)) {
            let distance = |cell: [i32; 3], far: bool| -> f64 {
                let along = |axis: usize| {
                    let (near, other) = (f64::from(cell[axis]) + lo - p[axis], f64::from(cell[axis]) + hi - p[axis]);
                    let least = if near * other < 0.0 { 0.0 } else { near.abs().min(other.abs()) };
                    if far { near.abs().max(other.abs()) } else { least }
                };
                (0..3).map(|axis| along(axis) * along(axis)).sum()
            };
            let mut farthest: Vec<f64> = known.iter().map(|step| distance(step.map(|s| -s), true)).collect();
            farthest.sort_by(f64::total_cmp);
            let left_out = (0..343).map(|k| [k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3]);
            for cell in left_out.filter(|cell| !known.contains(&cell.map(|c| -c))) {
                assert!(distance(cell, false) > f64::from(HORIZON) - 1e-6, "{cell:?} from {p:?}");
            }
            assert!(farthest[1] < f64::from(HORIZON), "{p:?}");
        }
    }

    proptest! {
        /// No centre is nearer than the least distance to its cell, so that leaving cells out changes nothing.
        #[test]
        fn no_centre_is_nearer_than_the_least_distance(
            fraction in prop::array::uniform3(0.0f32..1.0), jitter in 0.0f32..=JITTER, cell: [u32; 3], seed: u32,
        ) {
            let mut places = Box::<Places>::default();
            for axis in 0..3 {
                (places.cell[axis][0], places.fraction[axis][0]) = (cell[axis], fraction[axis]);
            }
            for step in neighbourhood() {
                let (distance, _) = centre::<f32>(&places, step, seed, jitter, 0);
                prop_assert!(distance >= least_distance(step, jitter), "{distance} at {step:?}");
            }
        }
    }
}
