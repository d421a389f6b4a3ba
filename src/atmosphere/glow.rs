//! Light that air scatters for a second time or more, by altitude, sun elevation and direction, as a LUT.
//!
//! The few moments of [`Light`](super::multiscatter::Light) suffice for light that is scattered on, but not for what
//! dust scatters to the eye: light scattered once comes both from around the sun and from along the horizon, and dust
//! keeps that pattern. So the last two scatterings are sums over directions with the exact phase functions: the light
//! that a point sees is gathered from all around (as in the final gathering of photon maps: Jensen, Global
//! illumination using photon maps, 1996), and scattered once more. Only light of the third order and more is by
//! moments. Directions and steps are those of the shaders, in f64.

use super::line::{Line, horizon_mu};
use super::medium::{Medium, rayleigh_phase};
use super::multiscatter::{COLUMNS, Direction, MultiscatterLut, ROWS, flat, march, place, point_at};
use super::sunlit::SunlitAir;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Nodes along the zenith angle of the direction of scattering, and along its azimuth from the sun, as in the shaders.
const VIEWS: usize = 11;
const TURNS: usize = 6;
/// A node's place is this power of the squared sine of half its azimuth.
const TURN_POWER: f64 = 0.6;
/// Rings of directions of the light that a point sees, over the horizon: Gauss-Legendre nodes between the horizon (0)
/// and the zenith (1) with their weights. When the sun has set, light comes from along the horizon, and there are more.
const BY_DAY: [(f64, f64); 4] = [
    (0.069_431_844_202_974, 0.173_927_422_568_727),
    (0.330_009_478_207_572, 0.326_072_577_431_273),
    (0.669_990_521_792_428, 0.326_072_577_431_273),
    (0.930_568_155_797_026, 0.173_927_422_568_727),
];
const AT_NIGHT: [(f64, f64); 7] = [
    (0.025_446_043_828_621, 0.064_742_483_084_435),
    (0.129_234_407_200_303, 0.139_852_695_744_638),
    (0.297_077_424_311_301, 0.190_915_025_252_56),
    (0.5, 0.208_979_591_836_735),
    (0.702_922_575_688_699, 0.190_915_025_252_56),
    (0.870_765_592_799_697, 0.139_852_695_744_638),
    (0.974_553_956_171_379, 0.064_742_483_084_435),
];
/// Rings below the horizon, to the nadir (1).
const LOWER: [(f64, f64); 2] = [(0.211_324_865_405_187, 0.5), (0.788_675_134_594_813, 0.5)];
/// Azimuths of these directions from the sun, in half a turn. The other half is the mirror image.
const SEEN_TURNS: usize = 9;
/// At night, places of rings are this power of their nodes, denser at the horizon. It grows to that over the second
/// figure: a cosine of the sun's zenith angle, negated.
const NIGHT_POWER: f64 = 1.85;
const NIGHT_OVER: f64 = 0.12;
/// Steps along each direction.
const STEPS: u32 = 7;

/// Light that air scatters for a second time or more. Values are fourth roots of radiance per scattering coefficient.
#[derive(Clone, Debug)]
pub(super) struct GlowLut {
    top: f64,
    /// By altitude and sun, as in [`MultiscatterLut`]; each has nodes by zenith angle and azimuth.
    texels: Vec<[[DVec3; TURNS]; VIEWS]>,
}

/// Light from a direction that a point sees.
struct Seen {
    mu: f64,
    turn: f64,
    /// Share of all directions.
    share: f64,
    light: DVec3,
}

impl GlowLut {
    pub(super) fn new(lit: &SunlitAir, lut: &MultiscatterLut) -> Self {
        let texel = |i: usize| {
            let (altitude, sun_mu) = point_at(i, lit.medium.top);
            let seen = seen(lit, lut, altitude, sun_mu);
            let shares = Shares::new(&lit.medium, altitude);
            std::array::from_fn(|view| {
                std::array::from_fn(|turn| {
                    let (mu, turn) = (view_mu(view as f64 / (VIEWS - 1) as f64), cosine_of_turn(turn));
                    shares.rescattered(&lit.medium, &seen, mu, turn).map(|light| light.sqrt().sqrt())
                })
            })
        };
        Self { top: lit.medium.top, texels: (0..COLUMNS * ROWS).into_par_iter().map(texel).collect() }
    }

    /// Radiance that air scatters into a direction, per scattering coefficient. `sun_mu`: cosine of the sun's zenith
    /// angle.
    pub(super) fn at(&self, altitude: f64, sun_mu: f64, to: Direction) -> DVec3 {
        let (x, y) = place(altitude / self.top, sun_mu);
        let across = flat(to.mu) * flat(sun_mu);
        let turn = ((to.cosine - to.mu * sun_mu) / across.max(1e-6)).clamp(-1.0, 1.0);
        let view = unit_of_view(to.mu) * (VIEWS - 1) as f64;
        let turn = (0.5 - 0.5 * turn).max(0.0).powf(TURN_POWER) * (TURNS - 1) as f64;
        let (i, j) = ((view as usize).min(VIEWS - 2), (turn as usize).min(TURNS - 2));
        let (u, v) = (view - i as f64, turn - j as f64);
        let root = super::depth::bilinear(x, y, COLUMNS, ROWS, |texel| {
            let nodes = &self.texels[texel];
            nodes[i][j].lerp(nodes[i + 1][j], u).lerp(nodes[i][j + 1].lerp(nodes[i + 1][j + 1], u), v)
        });
        let square = root * root;
        square * square
    }
}

/// Where a cosine to the zenith lies between nadir (0) and zenith (1): light changes fastest at the horizon.
fn unit_of_view(mu: f64) -> f64 {
    0.5 + 0.5 * mu
}

/// The inverse of [`unit_of_view`].
fn view_mu(unit: f64) -> f64 {
    2.0 * unit - 1.0
}

/// Cosine of the azimuth of a node: nodes are densest towards the sun.
fn cosine_of_turn(node: usize) -> f64 {
    1.0 - 2.0 * (node as f64 / (TURNS - 1) as f64).powf(1.0 / TURN_POWER)
}

/// The light that a point sees from all around.
fn seen(lit: &SunlitAir, lut: &MultiscatterLut, altitude: f64, sun_mu: f64) -> Vec<Seen> {
    let horizon = horizon_mu(lit.radius, altitude);
    let upper: &[(f64, f64)] = if sun_mu < 0.0 { &AT_NIGHT } else { &BY_DAY };
    let power = 1.0 + (NIGHT_POWER - 1.0) * (-sun_mu / NIGHT_OVER).clamp(0.0, 1.0);
    let side = |span: f64| {
        move |&(x, weight): &(f64, f64)| {
            (horizon + span * x.powf(power), weight * power * x.powf(power - 1.0) * 0.5 * span.abs())
        }
    };
    let rings = upper.iter().map(side(1.0 - horizon)).chain(LOWER.iter().map(side(-1.0 - horizon)));
    let turns = (0..SEEN_TURNS).map(|i| (PI * (i as f64 + 0.5) / SEEN_TURNS as f64).cos());
    rings
        .flat_map(|(mu, share)| turns.clone().map(move |turn| (mu, turn, share / SEEN_TURNS as f64)))
        .map(|(mu, turn, share)| Seen { mu, turn, share, light: seen_from(lit, lut, (altitude, sun_mu), mu, turn) })
        .collect()
}

/// The light that a point sees from one direction.
fn seen_from(lit: &SunlitAir, lut: &MultiscatterLut, at: (f64, f64), mu: f64, turn: f64) -> DVec3 {
    let (altitude, sun_mu) = at;
    let (radius, haze) = (lit.radius, lit.medium.haze());
    let line = Line { radius, altitude, mu };
    let cosine = mu * sun_mu + flat(mu) * flat(sun_mu) * turn;
    let phases = (rayleigh_phase(cosine), lit.medium.mie_phase(cosine));
    let sun_mu_at =
        |t: f64, height: f64| (((radius + altitude) * sun_mu + t * cosine) / (radius + height)).clamp(-1.0, 1.0);
    let mut light = DVec3::ZERO;
    let through = march(&lit.medium, &line, STEPS, |t, height, air, inside| {
        let sun_mu = sun_mu_at(t, height);
        let mu = ((radius + altitude) * mu + t) / (radius + height);
        // The forward peak of haze is part of the beam: scattered once more, it counts as scattered once.
        let beam = lit.beam(height, sun_mu);
        let more = lut.at(height, sun_mu).scattered(&haze, Direction { mu, cosine });
        light += inside * (air.rayleigh * (beam * phases.0 + more.0) + air.mie * (beam * phases.1 + more.1));
    });
    light + through * line.ground().map_or(DVec3::ZERO, |t| lut.ground(lit, sun_mu_at(t, 0.0)))
}

/// Shares of molecules and haze in the scattering at an altitude.
struct Shares {
    rayleigh: DVec3,
    mie: DVec3,
}

impl Shares {
    fn new(medium: &Medium, altitude: f64) -> Self {
        let air = medium.at(altitude);
        let all = air.scattering().max(DVec3::splat(1e-300));
        Self { rayleigh: air.rayleigh / all, mie: air.mie / all }
    }

    /// Light seen, scattered once more. The sum is divided by that over even light: directions are too far apart to
    /// resolve a sharp phase function.
    fn rescattered(&self, medium: &Medium, seen: &[Seen], mu: f64, turn: f64) -> DVec3 {
        let (mut rayleigh, mut mie) = ((DVec3::ZERO, 0.0), (DVec3::ZERO, 0.0));
        for from in seen {
            let (along, across) = (mu * from.mu, flat(mu) * flat(from.mu));
            // The direction and its mirror image.
            for sine in [-1.0, 1.0] {
                let cosine = along + across * (turn * from.turn + sine * flat(turn) * flat(from.turn));
                let weights = (rayleigh_phase(cosine) * from.share, medium.mie_phase(cosine) * from.share);
                rayleigh = (rayleigh.0 + from.light * weights.0, rayleigh.1 + weights.0);
                mie = (mie.0 + from.light * weights.1, mie.1 + weights.1);
            }
        }
        self.rayleigh * rayleigh.0 / rayleigh.1 + self.mie * mie.0 / mie.1
    }
}
