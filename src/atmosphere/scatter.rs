//! Transmittance to the sun, and the radiance that air alone scatters along a ray, by the method of the shaders.

use super::depth;
use super::glow::GlowLut;
use super::line::{Line, horizon_mu};
use super::medium::{Medium, rayleigh_phase};
use super::multiscatter::{self, Direction, MultiscatterLut};
use super::sunlit::SunlitAir;
use crate::planet::{InvalidPlanet, Planet};
use glam::DVec3;

/// Steps along a ray. The error against the limit of many steps is below 1e-3 of the radiance.
const STEPS: u32 = 400;

/// A ray from an observer into the sky. The zenith of the observer is the reference direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyRay {
    /// Height of the observer above the reference sphere.
    pub altitude_m: f64,
    /// Angle from the zenith to the ray.
    pub view_zenith_rad: f64,
    /// Angle from the zenith to the sun.
    pub sun_zenith_rad: f64,
    /// Angle about the zenith from the sun to the ray.
    pub azimuth_rad: f64,
}

impl SkyRay {
    /// Unit vectors along the ray and to the sun; the zenith is +Z.
    pub fn directions(&self) -> (DVec3, DVec3) {
        let (view_sin, view_cos) = self.view_zenith_rad.sin_cos();
        let (sun_sin, sun_cos) = self.sun_zenith_rad.sin_cos();
        let (side, ahead) = self.azimuth_rad.sin_cos();
        (DVec3::new(view_sin * ahead, view_sin * side, view_cos), DVec3::new(sun_sin, 0.0, sun_cos))
    }
}

/// A planet's air with its LUTs. A planet without air has transmittance 1 and radiance 0.
#[derive(Clone, Debug)]
pub struct Air {
    pub(super) lit: Option<(SunlitAir, GlowLut)>,
    radius: f64,
}

impl Air {
    /// Computes the LUTs of a planet's air.
    ///
    /// # Errors
    /// The planet is invalid: it was changed to values that a preset must not have.
    pub fn try_new(planet: &Planet) -> Result<Self, InvalidPlanet> {
        planet.check()?;
        let lit = SunlitAir::new(planet).map(|lit| {
            let glow = GlowLut::new(&lit, &MultiscatterLut::new(&lit));
            (lit, glow)
        });
        Ok(Self { lit, radius: planet.radius_km })
    }

    /// Transmittance from an altitude to the centre of the sun; 0 when the planet hides it.
    pub fn sun_transmittance(&self, altitude_m: f64, sun_zenith_rad: f64) -> [f64; 3] {
        let line = Line { radius: self.radius, altitude: altitude_m * 1e-3, mu: sun_zenith_rad.cos() };
        if line.mu < horizon_mu(line.radius, line.altitude) {
            return [0.0; 3];
        }
        let depth = self.lit.as_ref().map_or(DVec3::ZERO, |(lit, _)| depth::to_top(&lit.medium, &line));
        (-depth).exp().to_array()
    }

    /// Radiance that the air scatters along a ray to the observer, for a sun of unit irradiance, without light from the
    /// ground or the sun's disc.
    pub fn radiance(&self, ray: &SkyRay) -> [f64; 3] {
        self.lit.as_ref().map_or(DVec3::ZERO, |(lit, glow)| radiance(lit, glow, ray)).to_array()
    }

    /// The share of light from a point that air scatters back to it (f_ms in Hillaire's method). It is less than 1: the
    /// sum over all orders of scattering must converge.
    pub fn returned_share(planet: &Planet, altitude_m: f64) -> [f64; 3] {
        let returned = |air| multiscatter::returned(&Medium::new(air), planet.radius_km, altitude_m * 1e-3);
        planet.atmosphere.as_ref().map_or(DVec3::ZERO, returned).to_array()
    }
}

fn radiance(lit: &SunlitAir, glow: &GlowLut, ray: &SkyRay) -> DVec3 {
    let (dir, sun) = ray.directions();
    let line = Line { radius: lit.radius, altitude: ray.altitude_m * 1e-3, mu: dir.z };
    let Some(segment) = line.within(lit.medium.top) else { return DVec3::ZERO };
    let cosine = dir.dot(sun);
    let phases = (rayleigh_phase(cosine), lit.medium.mie_phase(cosine));
    let (mut radiance, mut transmittance) = (DVec3::ZERO, DVec3::ONE);
    for (t, length) in segment.steps(STEPS) {
        let altitude = line.altitude_at(t);
        let sun_mu = (((lit.radius + line.altitude) * sun.z + t * cosine) / (lit.radius + altitude)).clamp(-1.0, 1.0);
        let air = lit.medium.at(altitude);
        let mu = ((lit.radius + line.altitude) * line.mu + t) / (lit.radius + altitude);
        let direct = lit.sunlight(altitude, sun_mu) * (air.rayleigh * phases.0 + air.mie * phases.1);
        let source = direct + air.scattering() * glow.at(altitude, sun_mu, Direction { mu, cosine });
        let passed = (-air.extinction * length).exp();
        radiance += transmittance * source * (1.0 - passed) / air.extinction.max(DVec3::splat(1e-300));
        transmittance *= passed;
    }
    radiance
}
