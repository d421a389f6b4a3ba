//! The radiance of the air by path tracing: all orders of scattering with exact phase functions. It is slow; it
//! measures the error of the LUT method, in tests and in `tellus sky --reference`.
//!
//! The first collision is stratified over the ray. Further collisions come from delta tracking (Woodcock et al.,
//! Techniques used in the GEM code, 1965). Every collision with air or ground adds direct sunlight.

use super::line::Line;
use super::medium::rayleigh_phase;
use super::scatter::{Air, SkyRay};
use super::sunlit::SunlitAir;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// A path ends after this many collisions.
const MAX_COLLISIONS: usize = 400;
/// Steps of the optical depth along the first ray.
const STEPS: u32 = 4000;

/// Radiance that the air scatters along a ray to the observer, for a sun of unit irradiance: the mean of `paths` paths
/// for each colour channel.
pub fn radiance(air: &Air, ray: &SkyRay, paths: u32) -> [f64; 3] {
    let Some((lit, _)) = &air.lit else { return [0.0; 3] };
    let (dir, sun) = ray.directions();
    let line = Line { radius: lit.radius, altitude: ray.altitude_m * 1e-3, mu: dir.z };
    let Some(segment) = line.within(lit.medium.top) else { return [0.0; 3] };
    let eye = DVec3::Z * (line.radius + line.altitude);

    // For each step: distance and length of it, and the transmittance from its midpoint to the eye.
    let mut depth = DVec3::ZERO;
    let steps: Vec<(f64, f64, DVec3)> = segment
        .steps(STEPS)
        .map(|(t, length)| {
            let half = lit.medium.at(line.altitude_at(t)).extinction * (0.5 * length);
            depth += half;
            let transmittance = (-depth).exp();
            depth += half;
            (t, length, transmittance)
        })
        .collect();
    let path = |number: u32| {
        let mut dice = Dice::new(number);
        let step = (f64::from(number) + dice.unit()) / f64::from(paths) * f64::from(STEPS);
        let (t, length, transmittance) = steps[(step as usize).min(steps.len() - 1)];
        let altitude = line.altitude_at(t);
        let air = lit.medium.at(altitude);
        let weight = transmittance * air.scattering() * length * f64::from(STEPS);
        DVec3::from_array(std::array::from_fn(|color| {
            let walk = Walk { lit, sun, color };
            // All colours use the same random numbers: that lowers the noise of their ratios.
            walk.collided(eye + dir * t, dir, weight[color], &mut dice.clone())
        }))
    };
    let sum: DVec3 = (0..paths).into_par_iter().map(path).reduce(|| DVec3::ZERO, |a, b| a + b);
    (sum / f64::from(paths)).to_array()
}

/// The walk of one path, for one colour channel.
struct Walk<'a> {
    lit: &'a SunlitAir,
    sun: DVec3,
    color: usize,
}

impl Walk<'_> {
    fn altitude(&self, point: DVec3) -> f64 {
        point.length() - self.lit.radius
    }

    fn sunlight(&self, point: DVec3) -> f64 {
        let mu = point.dot(self.sun) / point.length();
        self.lit.sunlight(self.altitude(point).max(0.0), mu.clamp(-1.0, 1.0))[self.color]
    }

    /// Radiance gathered by a path that arrives along `dir` and collides with air at `point`; `weight`: throughput of
    /// the path so far.
    fn collided(&self, mut point: DVec3, mut dir: DVec3, mut weight: f64, dice: &mut Dice) -> f64 {
        let mut gathered = 0.0;
        for _ in 0..MAX_COLLISIONS {
            let air = self.lit.medium.at(self.altitude(point));
            let mie_share = air.mie[self.color] / (air.mie + air.rayleigh)[self.color].max(1e-300);
            let cosine = dir.dot(self.sun);
            let phase = rayleigh_phase(cosine) * (1.0 - mie_share) + self.lit.medium.mie_phase(cosine) * mie_share;
            gathered += weight * phase * self.sunlight(point);

            let before = dir;
            if dice.unit() < mie_share {
                // Sampled by the Henyey-Greenstein function; the weight corrects to the Mie phase function.
                let g = self.lit.medium.anisotropy();
                dir = about(before, henyey_greenstein_cosine(g, dice.unit()), dice.unit());
                let c = dir.dot(before);
                let base = (1.0 + g * g - 2.0 * g * c).max(1e-6);
                weight *= self.lit.medium.mie_phase(c) * 4.0 * PI * base * base.sqrt() / (1.0 - g * g);
            } else {
                dir = about(before, 2.0 * dice.unit() - 1.0, dice.unit());
                weight *= 4.0 * PI * rayleigh_phase(dir.dot(before));
            }
            // Flies on, also after a reflection by the ground, until it collides with air or escapes.
            loop {
                match self.fly(point, dir, dice) {
                    Flight::Escaped => return gathered,
                    Flight::Collision(at) => {
                        point = at;
                        break;
                    }
                    Flight::Ground(at) => {
                        let up = at.normalize();
                        weight *= self.lit.medium.ground_albedo[self.color];
                        gathered += weight / PI * up.dot(self.sun).max(0.0) * self.sunlight(at);
                        point = at;
                        dir = about(up, dice.unit().sqrt(), dice.unit());
                        if weight <= 0.0 {
                            return gathered;
                        }
                    }
                }
            }
            let air = self.lit.medium.at(self.altitude(point));
            weight *= air.scattering()[self.color] / air.extinction[self.color];
            // Russian roulette for faint paths.
            if weight < 1e-3 {
                if dice.unit() < 0.5 {
                    return gathered;
                }
                weight *= 2.0;
            }
        }
        gathered
    }

    fn fly(&self, point: DVec3, dir: DVec3, dice: &mut Dice) -> Flight {
        let r = point.length();
        let line = Line { radius: self.lit.radius, altitude: (r - self.lit.radius).max(1e-9), mu: point.dot(dir) / r };
        let ground = line.ground();
        let Some(end) = ground.or_else(|| line.meets(self.lit.medium.top).map(|(_, far)| far)) else {
            return Flight::Escaped;
        };
        let max_extinction = self.lit.medium.max_extinction()[self.color];
        let mut t = 0.0;
        loop {
            t -= (1.0 - dice.unit()).ln() / max_extinction.max(1e-300);
            if t >= end {
                return if ground.is_some() { Flight::Ground(point + dir * end) } else { Flight::Escaped };
            }
            if dice.unit() * max_extinction < self.lit.medium.at(line.altitude_at(t)).extinction[self.color] {
                return Flight::Collision(point + dir * t);
            }
        }
    }
}

/// How a straight flight ends.
enum Flight {
    Collision(DVec3),
    Ground(DVec3),
    Escaped,
}

fn henyey_greenstein_cosine(g: f64, x: f64) -> f64 {
    if g.abs() < 1e-3 {
        return 2.0 * x - 1.0;
    }
    let ratio = (1.0 - g * g) / (1.0 + g * (2.0 * x - 1.0));
    ((1.0 + g * g - ratio * ratio) / (2.0 * g)).clamp(-1.0, 1.0)
}

/// The direction at the angle `acos(cosine)` to `axis`, and at the share `turn` of a full turn around it.
fn about(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let (side, other) = axis.any_orthonormal_pair();
    let flat = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    axis * cosine + side * (flat * cos) + other * (flat * sin)
}

/// Pseudo-random numbers: SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014).
#[derive(Clone)]
struct Dice(u64);

impl Dice {
    fn new(number: u32) -> Self {
        Self(u64::from(number).wrapping_mul(0x0000_0100_0000_01B3).wrapping_add(0x1234_5678_9ABC))
    }

    /// The next number, uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
