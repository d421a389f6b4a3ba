//! Light that is scattered twice or more (Hillaire 2020, section 5.5), as a LUT by altitude and sun elevation.
//! Directions and steps are those of `multiscatter.wgsl`, in f64.

use super::depth::bilinear;
use super::line::{Line, horizon_mu};
use super::medium::Medium;
use super::sunlit::SunlitAir;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Texels along each side, as in `multiscatter.wgsl`. They are densest at the ground and at the terminator.
const SIDE: usize = 32;
/// Directions are grouped in rings of equal elevation. Radiance jumps at the horizon, so each side of it has a
/// quadrature of its own: Gauss-Legendre nodes between 0 (the horizon) and 1, with their weights.
const UPPER: [(f64, f64); 7] = [
    (0.025_446_043_828_620_7, 0.064_742_483_084_434_9),
    (0.129_234_407_200_302_8, 0.139_852_695_744_638_4),
    (0.297_077_424_311_301_4, 0.190_915_025_252_559_4),
    (0.5, 0.208_979_591_836_734_6),
    (0.702_922_575_688_698_5, 0.190_915_025_252_559_4),
    (0.870_765_592_799_697_2, 0.139_852_695_744_638_4),
    (0.974_553_956_171_379_3, 0.064_742_483_084_434_9),
];
const LOWER: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_6),
    (0.230_765_344_947_158_4, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_3),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_331_9, 0.118_463_442_528_094_6),
];
/// Cosines of the azimuths from the sun of the two directions in half a ring; the other half is their mirror image.
const AZIMUTH_COSINES: [f64; 2] = [FRAC_1_SQRT_2, -FRAC_1_SQRT_2];
/// Steps along each direction.
const STEPS: u32 = 14;
/// Upper limit of f_ms: the sum over all orders of scattering diverges at 1.
const MAX_RETURNED: f64 = 0.999;

/// Radiance of light scattered twice or more, the same in all directions.
#[derive(Clone, Debug)]
pub(super) struct MultiscatterLut {
    top: f64,
    texels: Vec<DVec3>,
}

/// Cosine of the zenith angle of each ring at an altitude, and the ring's share of the sphere of directions.
fn rings(radius: f64, altitude: f64) -> impl Iterator<Item = (f64, f64)> {
    let horizon = horizon_mu(radius, altitude);
    let side = move |span: f64| move |(x, weight): (f64, f64)| (horizon + span * x, weight * 0.5 * span.abs());
    UPPER.into_iter().map(side(1.0 - horizon)).chain(LOWER.into_iter().map(side(-1.0 - horizon)))
}

/// The share of isotropic light from a point that the air scatters back to it (f_ms), less than 1.
pub(super) fn returned(medium: &Medium, radius: f64, altitude: f64) -> DVec3 {
    let mut returned = DVec3::ZERO;
    for (mu, share) in rings(radius, altitude) {
        march(medium, &Line { radius, altitude, mu }, |_, inside| returned += inside * share);
    }
    returned.min(DVec3::splat(MAX_RETURNED))
}

/// Marches along a ray. Calls `each` with the distance of a step and the light that its air scatters to the start of
/// the ray when isotropic unit light shines on it. Returns the transmittance of the whole ray.
fn march(medium: &Medium, line: &Line, mut each: impl FnMut(f64, DVec3)) -> DVec3 {
    let mut transmittance = DVec3::ONE;
    let Some(segment) = line.within(medium.top) else { return transmittance };
    for (t, length) in segment.steps(STEPS) {
        let air = medium.at(line.altitude_at(t));
        let passed = (-air.extinction * length).exp();
        let albedo = air.scattering() / air.extinction.max(DVec3::splat(1e-300));
        each(t, transmittance * albedo * (1.0 - passed));
        transmittance *= passed;
    }
    transmittance
}

impl MultiscatterLut {
    pub(super) fn new(lit: &SunlitAir) -> Self {
        let top = lit.medium.top;
        let altitude = |row: usize| ((row as f64 / (SIDE - 1) as f64).powi(2) * top).clamp(top * 1e-5, top * 0.9999);
        let rows: Vec<DVec3> = (0..SIDE).map(|row| returned(&lit.medium, lit.radius, altitude(row))).collect();
        let texel = |i: usize| {
            let root = (i % SIDE) as f64 / (SIDE - 1) as f64 * 2.0 - 1.0;
            second_order(lit, altitude(i / SIDE), root * root.abs()) / (1.0 - rows[i / SIDE])
        };
        Self { top, texels: (0..SIDE * SIDE).into_par_iter().map(texel).collect() }
    }

    /// Radiance at an altitude; `sun_mu`: cosine of the sun's zenith angle.
    pub(super) fn at(&self, altitude: f64, sun_mu: f64) -> DVec3 {
        let root = sun_mu.signum() * sun_mu.abs().sqrt();
        let texel = |unit: f64| unit.clamp(0.0, 1.0) * (SIDE - 1) as f64;
        bilinear(texel(root * 0.5 + 0.5), texel((altitude / self.top).max(0.0).sqrt()), SIDE, SIDE, |i| self.texels[i])
    }
}

/// Mean radiance, over all directions, of light that air or ground scattered once, isotropically.
fn second_order(lit: &SunlitAir, altitude: f64, sun_mu: f64) -> DVec3 {
    let (radius, sun_flat) = (lit.radius, (1.0 - sun_mu * sun_mu).max(0.0).sqrt());
    let mut sum = DVec3::ZERO;
    for (mu, share) in rings(radius, altitude) {
        let line = Line { radius, altitude, mu };
        let flat = (1.0 - mu * mu).max(0.0).sqrt();
        let cosines = AZIMUTH_COSINES.map(|cosine| mu * sun_mu + flat * sun_flat * cosine);
        // Cosine of the sun's zenith angle at distance `t` along each direction of the ring.
        let sun_mus = |t: f64, altitude_there: f64| {
            cosines.map(|c| (((radius + altitude) * sun_mu + t * c) / (radius + altitude_there)).clamp(-1.0, 1.0))
        };
        let transmittance = march(&lit.medium, &line, |t, inside| {
            let there = line.altitude_at(t);
            let light: DVec3 = sun_mus(t, there).into_iter().map(|mu| lit.sunlight(there, mu)).sum();
            sum += inside * light * (share / (8.0 * PI));
        });
        if let Some(ground) = line.ground() {
            let light: DVec3 = sun_mus(ground, 0.0).into_iter().map(|mu| lit.sunlight(0.0, mu) * mu.max(0.0)).sum();
            sum += transmittance * light * lit.medium.ground_albedo * (share / (2.0 * PI));
        }
    }
    sum
}
