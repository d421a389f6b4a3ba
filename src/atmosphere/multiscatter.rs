//! Light that was scattered twice or more (Hillaire 2020, section 5.5), as a table by altitude and the star's height: the same
//! directions and steps as in `multiscatter.wgsl`, in 64 bits.

use super::depth::bilinear;
use super::line::Line;
use super::medium::Medium;
use super::scatter::Lit;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Texels along each side, as in `multiscatter.wgsl`. They crowd at the ground and about the terminator.
const SIDE: usize = 32;
/// Rings of equal height from zenith to nadir.
const RINGS: usize = 16;
/// Points along half of each ring; the other half is its mirror image.
const AROUND: usize = 4;
const STEPS: u32 = 20;
/// Most of the light that may come back: where nothing gets out, the series has no end.
const MOST_RETURNED: f64 = 0.999;

#[derive(Clone, Debug)]
pub(super) struct MultiscatterTable {
    top: f64,
    texels: Vec<DVec3>,
}

/// Cosine to the zenith of each ring.
fn rings() -> impl Iterator<Item = f64> {
    (0..RINGS).map(|ring| 1.0 - 2.0 * (ring as f64 + 0.5) / RINGS as f64)
}

/// The share of isotropic light from a place that the air sends back to it: f_ms. Always less than one.
pub(super) fn returned(medium: &Medium, radius: f64, altitude: f64) -> DVec3 {
    let mut returned = DVec3::ZERO;
    for mu in rings() {
        march(medium, &Line { radius, altitude, mu }, |_, inside| returned += inside / RINGS as f64);
    }
    returned.min(DVec3::splat(MOST_RETURNED))
}

/// Calls `each` with the way along a ray and what of isotropic unit light the air there scatters to its beginning. Gives the
/// transmittance of the whole.
fn march(medium: &Medium, line: &Line, mut each: impl FnMut(f64, DVec3)) -> DVec3 {
    let mut transmittance = DVec3::ONE;
    let Some(way) = line.within(medium.top) else { return transmittance };
    for (t, length) in way.steps(STEPS) {
        let place = medium.at(line.altitude_at(t));
        let passed = (-place.extinction * length).exp();
        let share = (place.rayleigh + place.mie) / place.extinction.max(DVec3::splat(1e-300));
        each(t, transmittance * share * (1.0 - passed));
        transmittance *= passed;
    }
    transmittance
}

impl MultiscatterTable {
    pub(super) fn new(lit: &Lit) -> Self {
        let top = lit.medium.top;
        let altitude = |row: usize| ((row as f64 / (SIDE - 1) as f64).powi(2) * top).clamp(top * 1e-5, top * 0.9999);
        let rows: Vec<DVec3> = (0..SIDE).map(|row| returned(&lit.medium, lit.radius, altitude(row))).collect();
        let texel = |i: usize| {
            let root = (i % SIDE) as f64 / (SIDE - 1) as f64 * 2.0 - 1.0;
            second(lit, altitude(i / SIDE), root * root.abs()) / (1.0 - rows[i / SIDE])
        };
        Self { top, texels: (0..SIDE * SIDE).into_par_iter().map(texel).collect() }
    }

    /// Radiance that comes from all around.
    pub(super) fn at(&self, altitude: f64, sun_mu: f64) -> DVec3 {
        let root = sun_mu.signum() * sun_mu.abs().sqrt();
        let texel = |unit: f64| unit.clamp(0.0, 1.0) * (SIDE - 1) as f64;
        bilinear(texel(root * 0.5 + 0.5), texel((altitude / self.top).max(0.0).sqrt()), SIDE, SIDE, |i| self.texels[i])
    }
}

/// Mean radiance at a place of light that was scattered once on its way there, by air or ground, as if evenly to all sides.
fn second(lit: &Lit, altitude: f64, sun_mu: f64) -> DVec3 {
    let (radius, sun_flat) = (lit.radius, (1.0 - sun_mu * sun_mu).max(0.0).sqrt());
    let mut sum = DVec3::ZERO;
    let share = 1.0 / (RINGS * AROUND) as f64;
    for mu in rings() {
        let line = Line { radius, altitude, mu };
        let flat = (1.0 - mu * mu).max(0.0).sqrt();
        let cosines: [f64; AROUND] = std::array::from_fn(|i| {
            let angle = PI * (i as f64 + 0.5) / AROUND as f64;
            mu * sun_mu + flat * sun_flat * angle.cos()
        });
        // Cosine between zenith and star after a way along each of the rays of the ring.
        let sun_mus = |t: f64, altitude_there: f64| {
            cosines.map(|c| (((radius + altitude) * sun_mu + t * c) / (radius + altitude_there)).clamp(-1.0, 1.0))
        };
        let transmittance = march(&lit.medium, &line, |t, inside| {
            let there = line.altitude_at(t);
            let light: DVec3 = sun_mus(t, there).into_iter().map(|mu| lit.sunlight(there, mu)).sum();
            sum += inside * light * (share / (4.0 * PI));
        });
        if let Some(ground) = line.ground() {
            let light: DVec3 = sun_mus(ground, 0.0).into_iter().map(|mu| lit.sunlight(0.0, mu) * mu.max(0.0)).sum();
            sum += transmittance * light * lit.medium.ground_albedo * (share / PI);
        }
    }
    sum
}
