//! Light that is scattered twice or more, as a LUT by altitude and sun elevation: the mean over all directions, because
//! scattering blurs (Hillaire 2020, section 5.5). Directions and steps are those of the shaders, in f64.
//!
//! Hillaire's sum over all orders assumes that light is as bright everywhere as at the point, and that the sky does not
//! light the ground. That is the first [`guess`]. It is too dark by up to a third in the blue of twilight. The
//! correction gathers the guess from all around once: one step of the iteration that solves the equation of radiative
//! transfer.

use super::depth::bilinear;
use super::line::{Line, horizon_mu};
use super::medium::{Coefficients, Medium, rayleigh_phase};
use super::sunlit::SunlitAir;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Texels along the sun's elevation and along the altitude, as in the shaders.
const COLUMNS: usize = 32;
const ROWS: usize = 16;
/// Columns are densest at the terminator; at this cosine of the sun's zenith angle, they are a quarter as dense.
const TWILIGHT: f64 = 0.15;
/// Cosines of the azimuths from the sun of the two directions in half a ring; the other half is their mirror image.
const AZIMUTH_COSINES: [f64; 2] = [FRAC_1_SQRT_2, -FRAC_1_SQRT_2];
/// Upper limit of f_ms: the sum over all orders of scattering diverges at 1.
const MAX_RETURNED: f64 = 0.999;
/// Upper limit of f_ms in the sum over all orders of a correction. It holds for thin air only: in dense air, a
/// correction differs too much from place to place.
const MAX_CORRECTION_RETURNED: f64 = 0.4;

/// Directions of a sum over the sphere in rings of equal elevation, and steps along each direction. Radiance jumps at
/// the horizon, so each side of it has a quadrature of its own: Gauss-Legendre nodes between 0 (the horizon) and 1
/// (zenith or nadir), with their weights.
struct Quadrature {
    upper: &'static [(f64, f64)],
    lower: &'static [(f64, f64)],
    steps: u32,
}

/// For sunlight, which ends abruptly at the planet's shadow.
const FINE: Quadrature = Quadrature {
    upper: &[
        (0.019_855_071_751_231_9, 0.050_614_268_145_188_1),
        (0.101_666_761_293_186_6, 0.111_190_517_226_687_2),
        (0.237_233_795_041_835_5, 0.156_853_322_938_943_6),
        (0.408_282_678_752_175_1, 0.181_341_891_689_181),
        (0.591_717_321_247_825, 0.181_341_891_689_181),
        (0.762_766_204_958_164_5, 0.156_853_322_938_943_6),
        (0.898_333_238_706_813_4, 0.111_190_517_226_687_2),
        (0.980_144_928_248_768_1, 0.050_614_268_145_188_1),
    ],
    lower: &[
        (0.033_765_242_898_424, 0.085_662_246_189_585_2),
        (0.169_395_306_766_867_7, 0.180_380_786_524_069_3),
        (0.380_690_406_958_401_6, 0.233_956_967_286_345_5),
        (0.619_309_593_041_598_4, 0.233_956_967_286_345_5),
        (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
        (0.966_234_757_101_576, 0.085_662_246_189_585_2),
    ],
    steps: 14,
};
/// For light that has been scattered before, which is smooth.
const COARSE: Quadrature = Quadrature {
    upper: &[
        (0.112_701_665_379_258_3, 0.277_777_777_777_777_8),
        (0.5, 0.444_444_444_444_444_4),
        (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
    ],
    lower: &[(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)],
    steps: 6,
};

/// Light that comes to a point from all directions: air and ground around it, and the sun's place at the point.
struct Gather<'a> {
    medium: &'a Medium,
    radius: f64,
    altitude: f64,
    sun_mu: f64,
}

impl Gather<'_> {
    /// Mean radiance over all directions. `shine`: light that air emits, per kilometre, by its altitude, the cosine of
    /// the sun's zenith angle there, and the cosine of the ray to the sun. `ground`: radiance of the ground by the
    /// cosine of the sun's zenith angle there.
    fn mean(
        &self,
        quadrature: &Quadrature,
        shine: impl Fn(&Coefficients, f64, f64, f64) -> DVec3,
        ground: impl Fn(f64) -> DVec3,
    ) -> DVec3 {
        let &Self { medium, radius, altitude, sun_mu } = self;
        let horizon = horizon_mu(radius, altitude);
        let side = |span: f64| move |&(x, weight): &(f64, f64)| (horizon + span * x, weight * 0.5 * span.abs());
        let upper = quadrature.upper.iter().map(side(1.0 - horizon));
        let rings = upper.chain(quadrature.lower.iter().map(side(-1.0 - horizon)));
        let flat = |mu: f64| (1.0 - mu * mu).max(0.0).sqrt();
        let mut sum = DVec3::ZERO;
        for (mu, share) in rings {
            let line = Line { radius, altitude, mu };
            let cosines = AZIMUTH_COSINES.map(|cosine| mu * sun_mu + flat(mu) * flat(sun_mu) * cosine);
            let share = share / cosines.len() as f64;
            let sun_mu_at = |t: f64, altitude_there: f64, cosine: f64| {
                (((radius + altitude) * sun_mu + t * cosine) / (radius + altitude_there)).clamp(-1.0, 1.0)
            };
            let mut transmittance = DVec3::ONE;
            let Some(segment) = line.within(medium.top) else { continue };
            for (t, length) in segment.steps(quadrature.steps) {
                let there = line.altitude_at(t);
                let air = medium.at(there);
                let passed = (-air.extinction * length).exp();
                let inside = transmittance * (1.0 - passed) / air.extinction.max(DVec3::splat(1e-300));
                let shines = cosines.map(|cosine| shine(&air, there, sun_mu_at(t, there, cosine), cosine));
                sum += inside * shines.into_iter().sum::<DVec3>() * share;
                transmittance *= passed;
            }
            if let Some(t) = line.ground() {
                let grounds = cosines.map(|cosine| ground(sun_mu_at(t, 0.0, cosine)));
                sum += transmittance * grounds.into_iter().sum::<DVec3>() * share;
            }
        }
        sum
    }

    /// The share of isotropic light from the point that air scatters back to it (f_ms), less than 1.
    fn returned(&self, quadrature: &Quadrature) -> DVec3 {
        let returned = self.mean(quadrature, |air, _, _, _| air.scattering(), |_| DVec3::ZERO);
        returned.min(DVec3::splat(MAX_RETURNED))
    }
}

/// The share of isotropic light from a point that air scatters back to it (f_ms), less than 1.
pub(super) fn returned(medium: &Medium, radius: f64, altitude: f64) -> DVec3 {
    Gather { medium, radius, altitude, sun_mu: 1.0 }.returned(&FINE)
}

/// Radiance of light scattered twice or more, the same in all directions.
#[derive(Clone, Debug)]
pub(super) struct MultiscatterLut {
    top: f64,
    texels: Vec<DVec3>,
}

impl MultiscatterLut {
    pub(super) fn new(lit: &SunlitAir) -> Self {
        let guess = Self::filled(lit, guess);
        Self::filled(lit, |lit, at| corrected(lit, at, &guess))
    }

    fn filled(lit: &SunlitAir, texel: impl Fn(&SunlitAir, &Gather<'_>) -> DVec3 + Sync) -> Self {
        let (medium, radius, top) = (&lit.medium, lit.radius, lit.medium.top);
        let at = |i: usize| {
            let x = (i % COLUMNS) as f64 / (COLUMNS - 1) as f64;
            let altitude = (((i / COLUMNS) as f64 / (ROWS - 1) as f64).powi(2) * top).clamp(top * 1e-5, top * 0.9999);
            texel(lit, &Gather { medium, radius, altitude, sun_mu: sun_mu_at(x) })
        };
        Self { top, texels: (0..COLUMNS * ROWS).into_par_iter().map(at).collect() }
    }

    /// Radiance at an altitude; `sun_mu`: cosine of the sun's zenith angle.
    pub(super) fn at(&self, altitude: f64, sun_mu: f64) -> DVec3 {
        let x = unit_of_sun(sun_mu).clamp(0.0, 1.0) * (COLUMNS - 1) as f64;
        let y = (altitude / self.top).clamp(0.0, 1.0).sqrt() * (ROWS - 1) as f64;
        bilinear(x, y, COLUMNS, ROWS, |i| self.texels[i])
    }
}

/// Where a cosine of the sun's zenith angle lies between the first column of the LUT (0) and the last one (1). Columns
/// are densest around the terminator.
fn unit_of_sun(mu: f64) -> f64 {
    0.5 + 0.5 * (1.0 + TWILIGHT) * mu / (mu.abs() + TWILIGHT)
}

/// The inverse of [`unit_of_sun`].
fn sun_mu_at(x: f64) -> f64 {
    let y = (2.0 * x - 1.0) / (1.0 + TWILIGHT);
    (TWILIGHT * y / (1.0 - y.abs())).clamp(-1.0, 1.0)
}

/// Radiance of the ground in the sun, without light from the sky.
fn sunlit_ground(lit: &SunlitAir, sun_mu: f64) -> DVec3 {
    lit.medium.ground_albedo * lit.sunlight(0.0, sun_mu) * (sun_mu.max(0.0) / PI)
}

/// Light scattered twice or more if it is as bright everywhere as at the point. Each further order is then the same
/// share of the one before, and the sum is a geometric series.
fn guess(lit: &SunlitAir, at: &Gather<'_>) -> DVec3 {
    // Molecules scatter sunlight by their phase function, haze evenly.
    let shine = |air: &Coefficients, altitude: f64, sun_mu: f64, cosine: f64| {
        (air.rayleigh * rayleigh_phase(cosine) + air.mie / (4.0 * PI)) * lit.sunlight(altitude, sun_mu)
    };
    let second = at.mean(&FINE, shine, |sun_mu| sunlit_ground(lit, sun_mu));
    second / (1.0 - at.returned(&FINE))
}

/// The guess, corrected for how much brighter or darker it is in the surroundings, and for the light of the sky on the
/// ground.
fn corrected(lit: &SunlitAir, at: &Gather<'_>, guess: &MultiscatterLut) -> DVec3 {
    let here = guess.at(at.altitude, at.sun_mu);
    let shine =
        |air: &Coefficients, altitude: f64, sun_mu: f64, _: f64| air.scattering() * (guess.at(altitude, sun_mu) - here);
    // On the ground, half of all directions see the sky, and half see the sunlit ground.
    let ground = |sun_mu: f64| {
        let sky = 2.0 * guess.at(0.0, sun_mu) - sunlit_ground(lit, sun_mu);
        lit.medium.ground_albedo * sky.max(DVec3::ZERO)
    };
    let correction = at.mean(&COARSE, shine, ground);
    let returned = at.returned(&COARSE);
    // No less than the first term of the series.
    (here + correction / (1.0 - returned.min(DVec3::splat(MAX_CORRECTION_RETURNED)))).max(here * (1.0 - returned))
}
