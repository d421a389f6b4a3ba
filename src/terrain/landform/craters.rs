//! Craters of many sizes: bowls with a raised rim, scattered without storing any.
//!
//! Space is divided into cells with one jittered centre each. Only centres near the sphere's surface make a crater,
//! fainter with distance from the surface. Jitter, reach and thickness are limited so that a crater lies within the
//! eight cells nearest to any point that it reaches.
//!
//! The widest craters may have the flat floor and central peak of large impacts. Each crater has its own age: worn
//! ones are shallow dishes without a rim. Counts may follow a power law, as on moons.

mod near;

use super::fbm::LEAST_POINTS;
use super::octaves::{Weighted, series};
use super::places::{CORNERS, Places, neighbour, unit};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Scratch64};
use crate::planet;
use crate::simd::for_each_simd;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::{self, Octave};
use crate::terrain::scalar::Scalar;
use glam::DVec3;

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.56;
/// Greatest radius of a crater, in cells.
const RADIUS: f32 = 0.45;
/// Greatest reach of the ejecta, in crater radii.
const REACH: f32 = 1.6;
/// Radius of the central peak, in crater radii.
const PEAK: f32 = 0.28;
/// Radius (in crater radii) and depth of the dish that a crater wears down to.
const DISH: f32 = 1.3;
const DISH_DEPTH: f32 = 0.7;
/// Share of its depth that a crater loses with age.
const FILLED: f32 = 0.75;
/// Greatest distance of a centre from the surface, in cells. sqrt((RADIUS * REACH)^2 + THICKNESS^2) + 0.2 (jitter) <
/// 1.
const THICKNESS: f32 = 0.34;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Craters {
    sizes: Vec<Size>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
}

/// The craters of one octave.
#[derive(Clone, Debug, PartialEq)]
struct Size {
    /// One lattice, or two with one in the gaps of the other: the layers of a single lattice show as bands where they
    /// are parallel to the ground.
    lattices: Vec<Octave>,
    weight: f32,
    mould: Mould,
}

/// The form of the craters of one octave.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mould {
    /// Share of cells that hold a crater.
    density: f32,
    /// Whether sizes within the octave follow a power law: the ratio of the widest to a crater is then `1 + a u + b
    /// u^2`, with `u` random and `spread` = [a, b].
    power: bool,
    spread: [f32; 2],
    rim: f32,
    reach: f32,
    floor: f32,
    peak: f32,
    age: f32,
    fresh: f32,
}

impl Craters {
    pub(super) fn new(params: &planet::Craters, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Craters { diameter_km, octaves, gain, lacunarity, power, density, .. } = *params;
        // The widest crater is 0.9 cells across.
        let octaves = series(seed, 0.9 * radius_km / diameter_km, octaves, gain, lacunarity);
        // Equal densities in all octaves make a power of 2; other powers change the density from octave to octave,
        // until every cell is full.
        let excess = if power > 0.0 { power - 2.0 } else { 0.0 };
        let sizes = octaves.into_iter().enumerate().map(|(i, Weighted { octave, weight })| {
            let density = (density * libm::pow(lacunarity, excess * i as f64)).min(1.0);
            // Large impacts collapse: fully at half the widest diameter, not at all at a tenth.
            let collapse = ((libm::pow(lacunarity, -(i as f64)) - 0.1) / 0.4).clamp(0.0, 1.0);
            let gaps = Octave {
                offset: octave.offset.map(|offset| offset + 0.5),
                seed: noise::scramble(octave.seed),
                ..octave
            };
            let lattices = if power > 0.0 { vec![octave, gaps] } else { vec![octave] };
            Size { lattices, weight, mould: Mould::new(params, density, collapse) }
        });
        let sizes: Vec<Size> = sizes.collect();
        Self { f64_octaves: arithmetic.f64_count(sizes.iter().map(|size| size.weight), REST), sizes }
    }
}

impl Mould {
    /// The radius of a crater in cells.
    #[inline(always)]
    fn radius(self, random: u32) -> f32 {
        let size = unit::<f32>(random >> 10);
        let even = RADIUS * (0.3 + 0.7 * size * size);
        let steep = RADIUS / (1.0 + size * (self.spread[0] + size * self.spread[1]));
        if self.power { steep } else { even }
    }

    fn new(params: &planet::Craters, density: f64, collapse: f64) -> Self {
        let planet::Craters { lacunarity, power, rim, ejecta, floor, peak, age, fresh, .. } = *params;
        // Matches the inverse of the cumulative count at its ends and its middle.
        let middle = libm::pow(0.5 + 0.5 * libm::pow(lacunarity, power), 1.0 / power.max(0.01));
        let spread = [4.0 * middle - lacunarity - 3.0, 2.0 * lacunarity - 4.0 * middle + 2.0];
        Self {
            density: density as f32,
            power: power > 0.0,
            spread: spread.map(|a| a as f32),
            rim: rim as f32,
            reach: (ejecta as f32).min(REACH),
            floor: (floor * collapse) as f32,
            peak: (peak * collapse) as f32,
            age: age as f32,
            fresh: fresh as f32,
        }
    }

    /// Height (-1 at the floor, up to the rim) and slope of a crater at a distance from its middle in radii. `random`
    /// is 0 to 1.
    #[inline(always)]
    fn profile<S: Scalar>(self, r: S, random: f32) -> (S, S) {
        let (of, zero, one, two) = (S::from_f32, S::of(0.0), S::of(1.0), S::of(2.0));
        // A flat floor and a bowl up to the rim, then ejecta that thin out.
        let inside = r < one;
        let widen = of(1.0 / (1.0 - self.floor));
        let bowl = ((r - of(self.floor)) * widen).max(zero);
        let thin = of(1.0 / (self.reach - 1.0));
        let tail = ((of(self.reach) - r) * thin).max(zero);
        let top = (one - (r * r) * of(1.0 / (PEAK * PEAK))).max(zero);
        let (rim, peak) = (of(self.rim), of(self.peak));
        let inner = (one + rim) * bowl * bowl - one + peak * (top * top);
        let inner_slope = two * (one + rim) * bowl * widen - peak * of(4.0 / (PEAK * PEAK)) * (top * r);
        let height = if inside { inner } else { rim * tail * tail };
        let slope = if inside { inner_slope } else { -two * rim * tail * thin };
        // Worn down to a dish.
        let age = self.age * ((random - self.fresh) / (1.0 - self.fresh).max(1e-6)).max(0.0);
        let dish = (one - (r * r) * of(1.0 / (DISH * DISH))).max(zero);
        let left = of(1.0 - FILLED * age);
        let worn = height + of(age) * (of(-DISH_DEPTH) * (dish * dish) - height);
        let worn_slope = slope + of(age) * (of(DISH_DEPTH * (4.0 / (DISH * DISH))) * (dish * r) - slope);
        (left * worn, left * worn_slope)
    }
}

impl Evaluate for Craters {
    fn octave_count(&self) -> usize {
        self.sizes.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let add = |sum: (f64, f64), size: &Size| {
            let (low, high) = size.bounds_near(dir_planet, angle_rad);
            (sum.0 + low * f64::from(size.weight), sum.1 + high * f64::from(size.weight))
        };
        let (lo, hi) = self.sizes.iter().fold((0.0, 0.0), add);
        (lo - 1e-5, hi + 1e-5)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, jets: [craters, ..], places, in_f64, .. } = scratch;
        for (k, size) in self.sizes.iter().enumerate() {
            let weight = size.weight;
            let fades = chunk.fades(1.0 / size.lattices[0].frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                break;
            }
            let unseen = fades.is_unseen();
            let is_f64 = k < chunk.f64_octaves(self.f64_octaves);
            if is_f64 {
                let Scratch64 { jets: [craters, ..], places, .. } = in_f64;
                size.evaluate::<f64>(chunk, places, craters);
                sums.add_f64(chunk, &craters.value, f64::from(weight));
                if unseen {
                    continue;
                }
            }
            let evaluate = if unseen { Size::evaluate::<f32> } else { Size::evaluate::<Jet> };
            evaluate(size, chunk, places, craters);
            if is_f64 {
                sums.add_gradients(chunk, &craters.gradient, weight, &fades);
            } else {
                sums.add(chunk, &craters.value, &craters.gradient, weight, &fades);
            }
        }
    }
}

impl Size {
    /// The height of all craters of the octave.
    fn evaluate<R: Real>(&self, chunk: &Chunk<'_>, places: &mut Places<R::S>, craters: &mut Jets<R::S>) {
        let (simd, n) = (chunk.simd, chunk.len());
        craters.fill(n, R::S::default());
        for octave in &self.lattices {
            places.find(simd, chunk.skewed, octave);
            for corner in CORNERS {
                dig::<R>(simd, n, places, corner, octave.seed, self.mould, craters);
            }
        }
        settle::<R>(simd, n, self.lattices[0].frequency as f32, craters);
    }
}

/// Adds the craters of one of the eight cells: a loop for each cell, because the compiler vectorises only innermost
/// loops.
#[inline(always)]
fn dig_body<R: Real>(
    n: usize,
    places: &Places<R::S>,
    corner: [i32; 3],
    seed: u32,
    mould: Mould,
    craters: &mut Jets<R::S>,
) {
    for i in 0..n.min(CHUNK) {
        let (cell, step) = neighbour(places, corner, i);
        let random = noise::cell_hash(cell, seed);
        let (low, span) = (R::S::of(0.3), R::S::of(0.4));
        let jitter = |bits: u32| low + span * unit(bits);
        let towards = |axis: usize, bits: u32| step[axis] + jitter(bits) - places.fraction[axis][i];
        let to = [towards(0, random), towards(1, random >> 10), towards(2, random >> 20)];
        let dir = [places.dir[0][i], places.dir[1][i], places.dir[2][i]];
        let crater = crater::<R>(to, dir, noise::scramble(random), mould);
        (R::load(craters, i) + crater).store(craters, i);
    }
}
for_each_simd!(fn dig<R: Real>(n: usize, places: &Places<R::S>, corner: [i32; 3], seed: u32, mould: Mould, craters: &mut Jets<R::S>) = dig_body);

/// Limits the depth of overlapping craters to that of one; gradients by the lattice become gradients by the
/// direction.
#[inline(always)]
fn settle_body<R: Real>(n: usize, frequency: f32, craters: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        let sum = R::load(craters, i);
        let (v, one) = (sum.value(), R::S::of(1.0));
        let slope = R::S::from_f32(if v > -one && v < one { frequency } else { 0.0 });
        sum.chain(v.clamp(-one, one), slope).store(craters, i);
    }
}
for_each_simd!(fn settle<R: Real>(n: usize, frequency: f32, craters: &mut Jets<R::S>) = settle_body);

/// Height and gradient by lattice coordinates of the crater whose centre is at `to` from a point with unit direction
/// `dir`. `random` decides whether it exists, its size and its age.
#[inline(always)]
fn crater<R: Real>(to: [R::S; 3], dir: [R::S; 3], random: u32, mould: Mould) -> R {
    let of = R::S::of;
    let radius = R::S::from_f32(mould.radius(random));
    let off = to[0] * dir[0] + to[1] * dir[1] + to[2] * dir[2];
    let flat = [to[0] - off * dir[0], to[1] - off * dir[1], to[2] - off * dir[2]];
    let distance = (flat[0] * flat[0] + flat[1] * flat[1] + flat[2] * flat[2]).sqrt();
    let (height, slope) = mould.profile(distance / radius, unit(random >> 20));

    let nearness = (of(1.0) - off.abs() * R::S::from_f32(1.0 / THICKNESS)).max(of(0.0));
    let depth = if unit::<f32>(random) < mould.density {
        nearness * nearness * (of(3.0) - of(2.0) * nearness) * (radius / R::S::from_f32(RADIUS))
    } else {
        of(0.0)
    };
    let pull = -depth * slope / (radius * distance.max(of(1e-6)));
    R::of(depth * height, [pull * flat[0], pull * flat[1], pull * flat[2]])
}

#[cfg(test)]
mod tests {
    use super::super::tests::moon;
    use super::*;

    /// Counts above a diameter follow its power, within an octave and from one to the next.
    #[test]
    fn counts_follow_the_power_law() {
        let Craters { sizes, .. } = Craters::new(&moon(), 7, 1740.0, Arithmetic::Fine);
        let above = |diameter: f64| -> f64 {
            let counts = sizes.iter().map(|Size { lattices, mould, .. }| {
                let frequency = lattices[0].frequency;
                let wide = |i: u32| {
                    let u = (f64::from(i) + 0.5) / 1000.0;
                    let [a, b] = mould.spread.map(f64::from);
                    1.0 / (frequency * (1.0 + u * (a + b * u))) > diameter
                };
                let share = (0..1000).filter(|i| wide(*i)).count() as f64 / 1000.0;
                share * f64::from(mould.density) * frequency * frequency
            });
            counts.sum()
        };
        let widest = 1.0 / sizes[0].lattices[0].frequency;
        // No crater is wider than the widest: their count is missing from the endless power law.
        for diameter in [0.8, 0.6, 0.5, 0.4, 0.25, 0.15] {
            let count = above(widest * diameter) / above(widest * 0.5);
            let law = (f64::powf(diameter, -2.4) - 1.0) / (f64::powf(0.5, -2.4) - 1.0);
            assert!((count / law - 1.0).abs() < 0.15, "{diameter}: {count} {law}");
        }
    }
}
