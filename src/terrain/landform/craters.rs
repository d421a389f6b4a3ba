//! Craters of many sizes: bowls with a raised rim, scattered without storing any.
//!
//! Space is cut into cells; each holds one jittered centre. Only centres near the sphere's surface count, the fainter the
//! farther they lie off it, which reads as age. Jitter, reach and thickness are chosen so that a crater can only be felt in the
//! eight cells nearest to a point: whatever point asks, it looks at every crater that reaches it.

use super::fbm::LEAST_POINTS;
use super::octaves::{Weighted, series};
use super::places::{CORNERS, Places, neighbour, unit};
use super::{Chunk, Evaluate, Scratch};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{self, CHUNK};
use crate::terrain::simd::for_each_simd;

/// Most radius of a crater, in cells.
const RADIUS: f32 = 0.45;
/// How far the ejecta reach, in crater radii.
const REACH: f32 = 1.6;
/// Height of the rim, in depths.
const RIM: f32 = 0.28;
/// Centres up to this far off the surface count, in cells. sqrt((RADIUS * REACH)^2 + THICKNESS^2) + 0.2 (jitter) < 1.
const THICKNESS: f32 = 0.34;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Craters {
    octaves: Vec<Weighted>,
    /// Share of cells that hold a crater.
    density: f32,
}

impl Craters {
    pub(super) fn new(params: &planet::Craters, seed: u64, radius_km: f64) -> Self {
        let planet::Craters { diameter_km, octaves, gain, lacunarity, density } = *params;
        // The widest crater is 0.9 cells across.
        let octaves = series(seed, 0.9 * radius_km / diameter_km, octaves, gain, lacunarity);
        Self { octaves, density: density as f32 }
    }
}

impl Evaluate for Craters {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, jets: [craters, ..], .. } = scratch;
        let n = chunk.len();
        let mut places = Places::default();
        for Weighted { octave, weight } in &self.octaves {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            let dig = if fades.is_unseen() { dig_values } else { dig_gradients };
            let settle = if fades.is_unseen() { settle_values } else { settle_gradients };
            places.find(chunk.simd, chunk.skewed, octave);
            craters.fill(n, 0.0);
            for corner in CORNERS {
                dig(chunk.simd, n, &places, corner, octave.seed, self.density, craters);
            }
            settle(chunk.simd, n, octave.frequency as f32, craters);
            sums.add(chunk, &craters.value, &craters.gradient, *weight, &fades);
        }
    }
}

/// Adds the craters of one cell of the eight: one loop for each cell, as the compiler makes vectors of innermost loops alone.
#[inline(always)]
fn dig_body<R: Real>(n: usize, places: &Places, corner: [i32; 3], seed: u32, density: f32, craters: &mut Jets) {
    for i in 0..n.min(CHUNK) {
        let (cell, step) = neighbour(places, corner, i);
        let random = noise::cell_hash(cell, seed);
        let jitter = |bits: u32| 0.3 + 0.4 * unit(bits);
        let towards = |axis: usize, bits: u32| step[axis] + jitter(bits) - places.fraction[axis][i];
        let to = [towards(0, random), towards(1, random >> 10), towards(2, random >> 20)];
        let dir = [places.dir[0][i], places.dir[1][i], places.dir[2][i]];
        let crater = crater::<R>(to, dir, noise::scramble(random), density);
        (R::load(craters, i) + crater).store(craters, i);
    }
}
for_each_simd!(fn dig_values(n: usize, places: &Places, corner: [i32; 3], seed: u32, density: f32, craters: &mut Jets) = dig_body::<f32>);
for_each_simd!(fn dig_gradients(n: usize, places: &Places, corner: [i32; 3], seed: u32, density: f32, craters: &mut Jets) = dig_body::<Jet>);

/// Overlapping craters dig no deeper than one; and gradients by the lattice become gradients by the direction.
#[inline(always)]
fn settle_body<R: Real>(n: usize, frequency: f32, craters: &mut Jets) {
    for i in 0..n.min(CHUNK) {
        let sum = R::load(craters, i);
        let v = sum.value();
        let slope = if v > -1.0 && v < 1.0 { frequency } else { 0.0 };
        sum.chain(v.clamp(-1.0, 1.0), slope).store(craters, i);
    }
}
for_each_simd!(fn settle_values(n: usize, frequency: f32, craters: &mut Jets) = settle_body::<f32>);
for_each_simd!(fn settle_gradients(n: usize, frequency: f32, craters: &mut Jets) = settle_body::<Jet>);

/// Height (-1, the floor of the largest, to [`RIM`]) and gradient by the lattice coordinates of a crater whose centre lies
/// `to` from a point with unit direction `dir`. `random` decides its size, and with `density`, the share of cells that hold
/// a crater, whether it is there.
#[inline(always)]
fn crater<R: Real>(to: [f32; 3], dir: [f32; 3], random: u32, density: f32) -> R {
    let size = unit(random >> 10);
    let radius = RADIUS * (0.3 + 0.7 * size * size);
    let off = to[0] * dir[0] + to[1] * dir[1] + to[2] * dir[2];
    let flat = [to[0] - off * dir[0], to[1] - off * dir[1], to[2] - off * dir[2]];
    let distance = (flat[0] * flat[0] + flat[1] * flat[1] + flat[2] * flat[2]).sqrt();
    let r = distance / radius;

    let nearness = (1.0 - off.abs() * (1.0 / THICKNESS)).max(0.0);
    let depth =
        if unit(random) < density { nearness * nearness * (3.0 - 2.0 * nearness) * (radius / RADIUS) } else { 0.0 };
    // A bowl up to the rim, then ejecta that run out.
    let inside = r < 1.0;
    let tail = ((REACH - r) * (1.0 / (REACH - 1.0))).max(0.0);
    let height = if inside { (1.0 + RIM) * r * r - 1.0 } else { RIM * tail * tail };
    let slope = if inside { 2.0 * (1.0 + RIM) * r } else { -2.0 * RIM * tail * (1.0 / (REACH - 1.0)) };
    let pull = -depth * slope / (radius * distance.max(1e-6));
    R::of(depth * height, [pull * flat[0], pull * flat[1], pull * flat[2]])
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    #[test]
    fn craters_are_sound() {
        let craters = Craters::new(&planet::Craters { octaves: 2, ..Default::default() }, 7, 1740.0);
        check::kind(&craters, 0.02);
    }

    #[test]
    #[ignore = "prints figures"]
    fn speed() {
        check::speed("craters", &Craters::new(&planet::Craters::default(), 7, 1740.0));
    }
}
