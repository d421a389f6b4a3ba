//! The radiance of the air by path tracing: every order of scattering with its true phase functions. Slow, for tests and to see
//! what the tables leave out.
//!
//! The first collision is spread evenly over the ray; from there paths walk by delta tracking (Woodcock et al., Techniques
//! used in the GEM code, 1965), and at each collision with air or ground the star is asked for directly.

use super::line::Line;
use super::medium::rayleigh_phase;
use super::scatter::{Air, Lit, SkyRay};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Collisions after which a path is given up.
const MOST_COLLISIONS: usize = 400;
/// Steps of the optical depth along the first ray.
const STEPS: u32 = 4000;

/// Radiance that the air scatters towards the eye along a ray, for a star of unit irradiance, the mean of so many paths for
/// each colour.
pub fn radiance(air: &Air, ray: &SkyRay, paths: u32) -> [f64; 3] {
    let Some((lit, _)) = &air.lit else { return [0.0; 3] };
    let (dir, sun) = ray.directions();
    let line = Line { radius: lit.radius, altitude: ray.altitude_m * 1e-3, mu: dir.z };
    let Some(way) = line.within(lit.medium.top) else { return [0.0; 3] };
    let eye = DVec3::Z * (line.radius + line.altitude);

    // Where a share of the bent way ends, and the transmittance from there to the eye.
    let mut depth = DVec3::ZERO;
    let steps: Vec<(f64, f64, DVec3)> = way
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
        let place = (f64::from(number) + dice.unit()) / f64::from(paths) * f64::from(STEPS);
        let (t, length, transmittance) = steps[(place as usize).min(steps.len() - 1)];
        let altitude = line.altitude_at(t);
        let air = lit.medium.at(altitude);
        let weight = transmittance * (air.rayleigh + air.mie) * length * f64::from(STEPS);
        DVec3::from_array(std::array::from_fn(|color| {
            let walk = Walk { lit, sun, color };
            // The same dice for each colour: their ratios settle sooner.
            walk.collided(eye + dir * t, dir, weight[color], &mut dice.clone())
        }))
    };
    let sum: DVec3 = (0..paths).into_par_iter().map(path).reduce(|| DVec3::ZERO, |a, b| a + b);
    (sum / f64::from(paths)).to_array()
}

struct Walk<'a> {
    lit: &'a Lit,
    sun: DVec3,
    color: usize,
}

impl Walk<'_> {
    fn altitude(&self, place: DVec3) -> f64 {
        place.length() - self.lit.radius
    }

    fn sunlight(&self, place: DVec3) -> f64 {
        let mu = place.dot(self.sun) / place.length();
        self.lit.sunlight(self.altitude(place).max(0.0), mu.clamp(-1.0, 1.0))[self.color]
    }

    /// What a path gathers that came along `dir` and collides with air at `place`; `weight`: what a scattered unit of light
    /// there is worth.
    fn collided(&self, mut place: DVec3, mut dir: DVec3, mut weight: f64, dice: &mut Dice) -> f64 {
        let mut gathered = 0.0;
        for _ in 0..MOST_COLLISIONS {
            let air = self.lit.medium.at(self.altitude(place));
            let mie_share = air.mie[self.color] / (air.mie + air.rayleigh)[self.color].max(1e-300);
            let cosine = dir.dot(self.sun);
            let phase = rayleigh_phase(cosine) * (1.0 - mie_share) + self.lit.medium.mie_phase(cosine) * mie_share;
            gathered += weight * phase * self.sunlight(place);

            let before = dir;
            if dice.unit() < mie_share {
                // By Henyey and Greenstein's function, weighed by how it differs from the phase.
                let g = self.lit.medium.anisotropy();
                dir = about(before, henyey_greenstein_cosine(g, dice.unit()), dice.unit());
                let c = dir.dot(before);
                let base = (1.0 + g * g - 2.0 * g * c).max(1e-6);
                weight *= self.lit.medium.mie_phase(c) * 4.0 * PI * base * base.sqrt() / (1.0 - g * g);
            } else {
                dir = about(before, 2.0 * dice.unit() - 1.0, dice.unit());
                weight *= 4.0 * PI * rayleigh_phase(dir.dot(before));
            }
            // Flies on, from the ground too, until it collides with air or is lost.
            loop {
                match self.fly(place, dir, dice) {
                    Flight::Lost => return gathered,
                    Flight::Collision(at) => {
                        place = at;
                        break;
                    }
                    Flight::Ground(at) => {
                        let up = at.normalize();
                        weight *= self.lit.medium.ground_albedo[self.color];
                        gathered += weight / PI * up.dot(self.sun).max(0.0) * self.sunlight(at);
                        place = at;
                        dir = about(up, dice.unit().sqrt(), dice.unit());
                        if weight <= 0.0 {
                            return gathered;
                        }
                    }
                }
            }
            let air = self.lit.medium.at(self.altitude(place));
            weight *= (air.rayleigh + air.mie)[self.color] / air.extinction[self.color];
            // Faint paths end by lot.
            if weight < 1e-3 {
                if dice.unit() < 0.5 {
                    return gathered;
                }
                weight *= 2.0;
            }
        }
        gathered
    }

    fn fly(&self, place: DVec3, dir: DVec3, dice: &mut Dice) -> Flight {
        let r = place.length();
        let line = Line { radius: self.lit.radius, altitude: (r - self.lit.radius).max(1e-9), mu: place.dot(dir) / r };
        let ground = line.ground();
        let Some(end) = ground.or_else(|| line.meets(self.lit.medium.top).map(|(_, far)| far)) else {
            return Flight::Lost;
        };
        let most = self.lit.medium.greatest_extinction()[self.color];
        let mut t = 0.0;
        loop {
            t -= (1.0 - dice.unit()).ln() / most.max(1e-300);
            if t >= end {
                return if ground.is_some() { Flight::Ground(place + dir * end) } else { Flight::Lost };
            }
            if dice.unit() * most < self.lit.medium.at(line.altitude_at(t)).extinction[self.color] {
                return Flight::Collision(place + dir * t);
            }
        }
    }
}

enum Flight {
    Collision(DVec3),
    Ground(DVec3),
    Lost,
}

fn henyey_greenstein_cosine(g: f64, x: f64) -> f64 {
    if g.abs() < 1e-3 {
        return 2.0 * x - 1.0;
    }
    let ratio = (1.0 - g * g) / (1.0 + g * (2.0 * x - 1.0));
    ((1.0 + g * g - ratio * ratio) / (2.0 * g)).clamp(-1.0, 1.0)
}

/// A direction at an angle of the given cosine to `axis`, `turn` of the way around it.
fn about(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let (side, other) = axis.any_orthonormal_pair();
    let flat = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    axis * cosine + side * (flat * cos) + other * (flat * sin)
}

/// SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014).
#[derive(Clone)]
struct Dice(u64);

impl Dice {
    fn new(number: u32) -> Self {
        Self(u64::from(number).wrapping_mul(0x0000_0100_0000_01B3).wrapping_add(0x1234_5678_9ABC))
    }

    /// From 0 to less than 1.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
