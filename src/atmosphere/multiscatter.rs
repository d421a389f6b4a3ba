//! Light that air and ground have scattered, as a LUT by altitude and sun elevation: its mean over all directions, and
//! how it differs from direction to direction. Scattering blurs, so few numbers suffice. Directions and steps are those
//! of the shaders, in f64.
//!
//! Sunlight scattered once is gathered from all around. Hillaire's sum over all orders (2020, section 5.5) assumes that
//! light is as bright everywhere as at the point, and that the sky does not light the ground: that is the first
//! [`guess`]. Each [`correction`](corrected) gathers the light before it from all around once: one step of the
//! iteration that solves the equation of radiative transfer.

use super::depth::bilinear;
use super::line::{Line, horizon_mu};
use super::medium::{Coefficients, Haze, Medium, henyey_greenstein, rayleigh_phase};
use super::sunlit::SunlitAir;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_4, PI};

/// Texels along the sun's elevation and along the altitude, as in the shaders.
pub(super) const COLUMNS: usize = 28;
pub(super) const ROWS: usize = 10;
/// Columns are densest at the terminator; where [`bent_sun`] has these values, by day and in the planet's shadow, they
/// are a quarter as dense.
const DAYLIGHT: f64 = 0.1;
const TWILIGHT: f64 = 0.15;
/// Number of corrections, as in the shaders.
const CORRECTIONS: usize = 4;
/// Upper limit of f_ms: the sum over all orders of scattering diverges at 1.
const MAX_RETURNED: f64 = 0.999;
/// Upper limit of f_ms in the sum over all orders of a correction. It holds for thin air only: in dense air, a
/// correction differs too much from place to place.
const MAX_CORRECTION_RETURNED: f64 = 0.4;
/// Weight of the second moment in the mean cosine to the sun, where the first one is weighted by the squared sine of
/// the sun's zenith angle.
const WEIGHT_OF_SQUARE: f64 = 0.1;
/// Upper limit of the mean cosine to the sun.
const MAX_ALONG: f64 = 0.95;

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
        (0.015_919_880_246_187, 0.040_637_194_180_787),
        (0.081_984_446_336_682, 0.090_324_080_347_429),
        (0.193_314_283_649_705, 0.130_305_348_201_468),
        (0.337_873_288_298_096, 0.156_173_538_520_001),
        (0.5, 0.165_119_677_500_63),
        (0.662_126_711_701_905, 0.156_173_538_520_001),
        (0.806_685_716_350_295, 0.130_305_348_201_468),
        (0.918_015_553_663_318, 0.090_324_080_347_429),
        (0.984_080_119_753_813, 0.040_637_194_180_787),
    ],
    lower: &[(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)],
    steps: 9,
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

/// A direction, as cosines to the zenith and to the sun.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction {
    pub(super) mu: f64,
    pub(super) cosine: f64,
}

/// Light at a point. It comes from around the sun as by the phase function of Henyey and Greenstein, and is brighter or
/// darker upwards and near the zenith or the horizon.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Light {
    /// Mean radiance over all directions.
    pub(super) mean: DVec3,
    /// Mean cosine to the sun of the light around the sun, 0 to 1.
    along: f64,
    /// Mean cosine to the zenith, without the light around the sun.
    up: f64,
    /// Mean squared cosine to the zenith, without the light around the sun.
    zenith: DVec3,
}

impl Light {
    /// Radiance that molecules and haze scatter into a ray, per scattering coefficient: the moments of the light times
    /// those of the phase function.
    pub(super) fn scattered(&self, haze: &Haze, to: Direction) -> (DVec3, DVec3) {
        let Direction { mu, cosine } = to;
        let (around, zenith) = (self.along * self.along * squared(cosine), self.zenith * (1.5 * squared(mu)));
        let rayleigh = 0.75 * (around + zenith) + 1.0;
        let peaked = 4.0 * PI * henyey_greenstein(haze.first * self.along, cosine);
        let mie = zenith * (7.5 * haze.second) + (peaked + 3.0 * haze.first * self.up * mu);
        (self.mean * rayleigh.max(DVec3::ZERO), self.mean * mie.max(DVec3::ZERO))
    }

    /// Mean squared cosine to the zenith, less that of even light.
    fn squared_up(&self, sun_mu: f64) -> DVec3 {
        self.zenith + self.along * self.along * squared(sun_mu)
    }
}

/// Square of a cosine, less its mean over all directions.
fn squared(cosine: f64) -> f64 {
    cosine * cosine - 1.0 / 3.0
}

/// The same for all colours.
fn squares(cosine: f64) -> DVec3 {
    DVec3::splat(squared(cosine))
}

/// Sine of an angle by its cosine.
pub(super) fn flat(mu: f64) -> f64 {
    (1.0 - mu * mu).max(0.0).sqrt()
}

/// Sums over directions that make a [`Light`].
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    mean: DVec3,
    /// Cosine to the sun's azimuth on the horizon, times the sine of the sun's zenith angle.
    ahead: f64,
    /// Cosine to the zenith.
    up: f64,
    /// Second Legendre polynomial of the cosine to the sun.
    around: f64,
    /// Square of the cosine to the zenith.
    zenith: DVec3,
}

impl Sums {
    /// Adds light from a direction. `share`: of all directions.
    fn add(&mut self, light: DVec3, from: Direction, sun_mu: f64, share: f64) {
        let light = light * share;
        let all = light.element_sum();
        self.mean += light;
        self.ahead += all * (from.cosine - from.mu * sun_mu);
        self.up += all * from.mu;
        self.around += all * 1.5 * squared(from.cosine);
        self.zenith += light * squared(from.mu);
    }

    /// Adds another light.
    fn add_light(&mut self, light: &Light, sun_mu: f64) {
        let all = light.mean.element_sum();
        self.mean += light.mean;
        self.ahead += all * light.along * (1.0 - sun_mu * sun_mu);
        self.up += all * (light.up + light.along * sun_mu);
        self.around += all * light.along * light.along;
        self.zenith += light.mean * light.squared_up(sun_mu);
    }

    /// The light if its mean is another one: what it then has more or less is even.
    fn light(&self, mean: DVec3, sun_mu: f64) -> Light {
        let all = mean.element_sum().max(1e-300);
        // Light from the ground counts in the cosine to the sun, but neither in the horizontal part of it, which tells
        // nothing when the sun is at the zenith, nor much in the square.
        let by_square = (self.around / all).clamp(0.0, 1.0).sqrt();
        let weight = 1.0 - sun_mu * sun_mu + WEIGHT_OF_SQUARE;
        let along = ((self.ahead / all + WEIGHT_OF_SQUARE * by_square) / weight).clamp(0.0, MAX_ALONG);
        // A colour that all but vanishes can have moments beyond those of any light.
        let zenith = (self.zenith / mean.max(DVec3::splat(1e-300))).clamp(squares(0.0), squares(1.0));
        let up = (self.up / all).clamp(-1.0, 1.0);
        Light { mean, along, up: up - along * sun_mu, zenith: zenith - along * along * squared(sun_mu) }
    }
}

/// The point at which light is gathered, and the sun's place there.
struct Point {
    radius: f64,
    altitude: f64,
    sun_mu: f64,
}

/// Directions of equal elevation from a point.
struct Ring {
    line: Line,
    /// Share of the ring of all directions.
    share: f64,
    /// Cosines to the sun of the middles of the quarters of the ring towards the sun and away from it. The other half
    /// of the ring is their mirror image.
    cosines: [f64; 2],
}

impl Point {
    fn rings(&self, quadrature: &Quadrature) -> impl Iterator<Item = Ring> {
        let &Self { radius, altitude, sun_mu } = self;
        let horizon = horizon_mu(radius, altitude);
        let side = |span: f64| move |&(x, weight): &(f64, f64)| (horizon + span * x, weight * 0.5 * span.abs());
        let upper = quadrature.upper.iter().map(side(1.0 - horizon));
        upper.chain(quadrature.lower.iter().map(side(-1.0 - horizon))).map(move |(mu, share)| Ring {
            line: Line { radius, altitude, mu },
            share,
            cosines: [FRAC_PI_4, 3.0 * FRAC_PI_4].map(|azimuth| cosine_at(mu, sun_mu, azimuth)),
        })
    }

    /// Cosine of the sun's zenith angle at a distance along a ray and an altitude.
    fn sun_mu_at(&self, t: f64, altitude: f64, cosine: f64) -> f64 {
        (((self.radius + self.altitude) * self.sun_mu + t * cosine) / (self.radius + altitude)).clamp(-1.0, 1.0)
    }

    /// Sunlight that air and ground have scattered once, and the share of even light from the point that air scatters
    /// back to it (f_ms), less than 1.
    fn first(&self, lit: &SunlitAir) -> (Sums, DVec3) {
        let (mut sums, mut returned) = (Sums::default(), DVec3::ZERO);
        let haze = lit.smooth.haze_without_peak();
        for ring in self.rings(&FINE) {
            // For both quarters of the ring: sunlight that molecules and haze scatter, without the phase functions.
            let mut scattered = [(DVec3::ZERO, DVec3::ZERO); 2];
            let through = march(&lit.smooth, &ring.line, FINE.steps, |t, altitude, air, inside| {
                for (scattered, cosine) in scattered.iter_mut().zip(ring.cosines) {
                    let light = inside * lit.beam(altitude, self.sun_mu_at(t, altitude, cosine));
                    scattered.0 += light * air.rayleigh;
                    scattered.1 += light * air.mie;
                }
                returned += inside * air.scattering() * ring.share;
            });
            for (quarter, (scattered, cosine)) in scattered.into_iter().zip(ring.cosines).enumerate() {
                let ground =
                    ring.line.ground().map_or(DVec3::ZERO, |t| sunlit_ground(lit, self.sun_mu_at(t, 0.0, cosine)));
                // Phase functions change faster around the ring than sunlight does, so each quarter has two of each.
                for eighth in [0.5, 1.5] {
                    let azimuth = (2.0 * quarter as f64 + eighth) * FRAC_PI_4;
                    let from = Direction { mu: ring.line.mu, cosine: cosine_at(ring.line.mu, self.sun_mu, azimuth) };
                    let phases = (rayleigh_phase(from.cosine), henyey_greenstein(haze.first, from.cosine));
                    let light = scattered.0 * phases.0 + scattered.1 * phases.1 + through * ground;
                    sums.add(light, from, self.sun_mu, ring.share / 4.0);
                }
            }
        }
        (sums, returned.min(DVec3::splat(MAX_RETURNED)))
    }
}

/// Cosine to the sun of a direction, by its cosine to the zenith and its azimuth from the sun.
fn cosine_at(mu: f64, sun_mu: f64, azimuth: f64) -> f64 {
    mu * sun_mu + flat(mu) * flat(sun_mu) * azimuth.cos()
}

/// Marches along a ray to the ground or out of the air. `step`: gets the distance, the altitude, the coefficients
/// there, and the length of the step, dimmed by the air up to it and in it. Returns the transmittance.
pub(super) fn march(
    medium: &Medium,
    line: &Line,
    steps: u32,
    mut step: impl FnMut(f64, f64, &Coefficients, DVec3),
) -> DVec3 {
    let mut transmittance = DVec3::ONE;
    let Some(segment) = line.within(medium.top) else { return transmittance };
    for (t, length) in segment.steps(steps) {
        let altitude = line.altitude_at(t);
        let air = medium.at(altitude);
        let passed = (-air.extinction * length).exp();
        step(t, altitude, &air, transmittance * (1.0 - passed) / air.extinction.max(DVec3::splat(1e-300)));
        transmittance *= passed;
    }
    transmittance
}

/// The share of even light from a point that air scatters back to it (f_ms), less than 1.
pub(super) fn returned(medium: &Medium, radius: f64, altitude: f64) -> DVec3 {
    let (point, medium) = (Point { radius, altitude, sun_mu: 1.0 }, medium.without_peak());
    let mut returned = DVec3::ZERO;
    for ring in point.rings(&FINE) {
        march(&medium, &ring.line, FINE.steps, |_, _, air, inside| returned += inside * air.scattering() * ring.share);
    }
    returned.min(DVec3::splat(MAX_RETURNED))
}

/// What a texel holds: the light, and the part of it that has been scattered once.
#[derive(Clone, Copy, Debug)]
struct Texel {
    all: Light,
    once: Light,
}

/// Light that air and ground have scattered.
#[derive(Clone, Debug)]
pub(super) struct MultiscatterLut {
    top: f64,
    texels: Vec<Texel>,
    /// Square roots of the means of all light. In the planet's shadow, light falls by half from column to column: roots
    /// between two columns are nearly linear, means are not.
    roots: Vec<DVec3>,
}

impl MultiscatterLut {
    pub(super) fn new(lit: &SunlitAir) -> Self {
        let guess = Self::filled(lit, |_, point| guess(lit, point));
        (0..CORRECTIONS).fold(guess, |before, number| {
            Self::filled(lit, |i, point| Texel {
                all: corrected(lit, point, (&before, number), &before.texels[i]),
                ..before.texels[i]
            })
        })
    }

    fn filled(lit: &SunlitAir, texel: impl Fn(usize, &Point) -> Texel + Sync) -> Self {
        let (radius, top) = (lit.radius, lit.medium.top);
        let at = |i: usize| {
            let (altitude, sun_mu) = point_at(i, top);
            texel(i, &Point { radius, altitude, sun_mu })
        };
        let texels: Vec<Texel> = (0..COLUMNS * ROWS).into_par_iter().map(at).collect();
        let roots = texels.iter().map(|texel| texel.all.mean.max(DVec3::ZERO).map(f64::sqrt)).collect();
        Self { top, texels, roots }
    }

    /// Light at an altitude; `sun_mu`: cosine of the sun's zenith angle.
    pub(super) fn at(&self, altitude: f64, sun_mu: f64) -> Light {
        let (x, y) = place(altitude / self.top, sun_mu);
        let mean = |of: &dyn Fn(&Light) -> DVec3| bilinear(x, y, COLUMNS, ROWS, |i| of(&self.texels[i].all));
        let shape = mean(&|light| DVec3::new(light.along, light.up, 0.0));
        let root = bilinear(x, y, COLUMNS, ROWS, |i| self.roots[i]);
        Light { mean: root * root, along: shape.x, up: shape.y, zenith: mean(&|light| light.zenith) }
    }

    /// Radiance of the ground in the light of sun and sky.
    pub(super) fn ground(&self, lit: &SunlitAir, sun_mu: f64) -> DVec3 {
        sunlit_ground(lit, sun_mu) + skylit_ground(lit, (self, CORRECTIONS), sun_mu)
    }
}

/// The altitude and the cosine of the sun's zenith angle of a texel of the LUT.
pub(super) fn point_at(texel: usize, top: f64) -> (f64, f64) {
    let x = (texel % COLUMNS) as f64 / (COLUMNS - 1) as f64;
    let y = (texel / COLUMNS) as f64 / (ROWS - 1) as f64;
    ((y * y * top).clamp(top * 1e-5, top * 0.9999), sun_mu_at(x))
}

/// Column and row of the LUT, with fractions. `altitude`: as a share of that of the top of the air.
pub(super) fn place(altitude: f64, sun_mu: f64) -> (f64, f64) {
    let x = unit_of_sun(sun_mu).clamp(0.0, 1.0) * (COLUMNS - 1) as f64;
    (x, altitude.clamp(0.0, 1.0).sqrt() * (ROWS - 1) as f64)
}

/// A cosine of the sun's zenith angle, bent by day: the light around a high sun moves with it, so that columns there
/// must lie as close in the angle as others.
fn bent_sun(mu: f64) -> f64 {
    if mu < 0.0 { mu } else { mu / (1.0 + (1.0 - mu).max(0.0).sqrt()) }
}

/// Where a cosine of the sun's zenith angle lies between the first column of the LUT (0) and the last one (1). Columns
/// are densest around the terminator.
fn unit_of_sun(mu: f64) -> f64 {
    let (bent, bend) = (bent_sun(mu), if mu >= 0.0 { DAYLIGHT } else { TWILIGHT });
    0.5 + 0.5 * (1.0 + bend) * bent / (bent.abs() + bend)
}

/// The inverse of [`unit_of_sun`].
fn sun_mu_at(x: f64) -> f64 {
    let bend = if x >= 0.5 { DAYLIGHT } else { TWILIGHT };
    let y = (2.0 * x - 1.0) / (1.0 + bend);
    let bent = (bend * y / (1.0 - y.abs())).clamp(-1.0, 1.0);
    if bent < 0.0 { bent } else { bent * (2.0 - bent) }
}

/// Radiance of the ground in the sun, without light from the sky.
fn sunlit_ground(lit: &SunlitAir, sun_mu: f64) -> DVec3 {
    lit.medium.ground_albedo * lit.beam(0.0, sun_mu) * (sun_mu.max(0.0) / PI)
}

/// Light if it is as bright everywhere as at the point. Each further order of scattering is then the same share of the
/// one before, and the sum is a geometric series.
fn guess(lit: &SunlitAir, point: &Point) -> Texel {
    let (sums, returned) = point.first(lit);
    let light = |mean: DVec3| sums.light(mean, point.sun_mu);
    Texel { all: light(sums.mean / (1.0 - returned)), once: light(sums.mean) }
}

/// Radiance of the ground in light from the sky. On the ground, half of all directions see the sky, and half see the
/// ground.
fn skylit_ground(lit: &SunlitAir, (before, number): (&MultiscatterLut, usize), sun_mu: f64) -> DVec3 {
    let (albedo, light) = (lit.medium.ground_albedo, before.at(0.0, sun_mu));
    // After the first correction, the ground seen is itself skylit.
    let share = if number == 0 { DVec3::ONE } else { 1.0 + albedo };
    let even = 2.0 * light.mean - sunlit_ground(lit, sun_mu);
    let squared = 2.0 * light.mean * light.squared_up(sun_mu);
    // The mean over the sky weighted by the cosine. The first two terms are exact if the sky changes with the squared
    // cosine to the zenith; less light falls from one that is brightest in a band along the horizon. Its weight
    // is by path tracing.
    let band = squared.min(DVec3::ZERO);
    let sky = even + 1.875 * squared - band * band * share / even.max(DVec3::splat(1e-300));
    albedo * sky.max(DVec3::ZERO) / share
}

/// Light gathered from all around, from that `before`. `own`: the texel of the point.
fn corrected(lit: &SunlitAir, point: &Point, before: (&MultiscatterLut, usize), own: &Texel) -> Light {
    let (mut sums, mut returned) = (Sums::default(), DVec3::ZERO);
    let haze = lit.smooth.haze_without_peak();
    for ring in point.rings(&COARSE) {
        let mut gathered = [DVec3::ZERO; 2];
        let through = march(&lit.smooth, &ring.line, COARSE.steps, |t, altitude, air, inside| {
            let mu = ((point.radius + point.altitude) * ring.line.mu + t) / (point.radius + altitude);
            for (gathered, cosine) in gathered.iter_mut().zip(ring.cosines) {
                let sun_mu = point.sun_mu_at(t, altitude, cosine);
                let light = before.0.at(altitude, sun_mu).scattered(&haze, Direction { mu, cosine });
                *gathered += inside * (air.rayleigh * light.0 + air.mie * light.1);
            }
            returned += inside * air.scattering() * ring.share;
        });
        for (gathered, cosine) in gathered.into_iter().zip(ring.cosines) {
            let at = |t: f64| skylit_ground(lit, before, point.sun_mu_at(t, 0.0, cosine));
            let ground = ring.line.ground().map_or(DVec3::ZERO, at);
            sums.add(
                gathered + through * ground,
                Direction { mu: ring.line.mu, cosine },
                point.sun_mu,
                ring.share / 2.0,
            );
        }
    }
    sums.add_light(&own.once, point.sun_mu);
    let here = own.all.mean;
    let correction = (sums.mean - here) / (1.0 - returned.min(DVec3::splat(MAX_CORRECTION_RETURNED)));
    // No less than the first term of the series.
    sums.light((here + correction).max(own.once.mean), point.sun_mu)
}
