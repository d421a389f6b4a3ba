//! Transmittance to the star, and the radiance that air alone scatters along a ray, by the method of the shaders.

use super::depth::{self, DepthTable};
use super::line::{Line, horizon_mu};
use super::medium::{Medium, rayleigh_phase};
use super::multiscatter::{self, MultiscatterTable};
use crate::planet::{InvalidPlanet, Planet};
use glam::DVec3;

/// Steps along a ray: within 1e-3 of many more.
const STEPS: u32 = 400;

/// A question to the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyRay {
    /// Height of the eye over the reference sphere.
    pub altitude_m: f64,
    /// Angle from the zenith to where one looks.
    pub view_zenith_rad: f64,
    /// Angle from the zenith to the star.
    pub sun_zenith_rad: f64,
    /// Angle about the zenith from the star to where one looks.
    pub azimuth_rad: f64,
}

impl SkyRay {
    /// Unit vectors to where one looks and to the star; the zenith is +Z.
    pub fn directions(&self) -> (DVec3, DVec3) {
        let (view_sin, view_cos) = self.view_zenith_rad.sin_cos();
        let (sun_sin, sun_cos) = self.sun_zenith_rad.sin_cos();
        let (side, ahead) = self.azimuth_rad.sin_cos();
        (DVec3::new(view_sin * ahead, view_sin * side, view_cos), DVec3::new(sun_sin, 0.0, sun_cos))
    }
}

/// A planet's air, ready to be asked. A planet without air has an air of no height.
#[derive(Clone, Debug)]
pub struct Air {
    pub(super) lit: Option<(Lit, MultiscatterTable)>,
    radius: f64,
}

impl Air {
    /// The air of a planet; takes a moment, for the tables.
    ///
    /// # Errors
    /// A planet that was changed to something that no preset may say.
    pub fn try_new(planet: &Planet) -> Result<Self, InvalidPlanet> {
        planet.check()?;
        let lit = Lit::new(planet).map(|lit| {
            let table = MultiscatterTable::new(&lit);
            (lit, table)
        });
        Ok(Self { lit, radius: planet.radius_km })
    }

    /// What the air leaves of the light of the star's centre; nothing when the planet stands before it.
    pub fn sun_transmittance(&self, altitude_m: f64, sun_zenith_rad: f64) -> [f64; 3] {
        let line = Line { radius: self.radius, altitude: altitude_m * 1e-3, mu: sun_zenith_rad.cos() };
        if line.mu < horizon_mu(line.radius, line.altitude) {
            return [0.0; 3];
        }
        let depth = self.lit.as_ref().map_or(DVec3::ZERO, |(lit, _)| depth::to_top(&lit.medium, &line));
        (-depth).exp().to_array()
    }

    /// Radiance that the air scatters towards the eye along a ray, for a star of unit irradiance: neither the ground nor the
    /// star's disc is in it.
    pub fn radiance(&self, ray: &SkyRay) -> [f64; 3] {
        self.lit.as_ref().map_or(DVec3::ZERO, |(lit, table)| radiance(lit, table, ray)).to_array()
    }

    /// The share of light from a place that air scatters back to it (f_ms of Hillaire's method): less than one, or the sum
    /// over all orders of scattering would have no end.
    pub fn returned_share(planet: &Planet, altitude_m: f64) -> [f64; 3] {
        let returned = |air| multiscatter::returned(&Medium::new(air), planet.radius_km, altitude_m * 1e-3);
        planet.atmosphere.as_ref().map_or(DVec3::ZERO, returned).to_array()
    }
}

/// Air under a star.
#[derive(Clone, Debug)]
pub(super) struct Lit {
    pub(super) medium: Medium,
    pub(super) radius: f64,
    sun_radius_rad: f64,
    depths: DepthTable,
}

impl Lit {
    fn new(planet: &Planet) -> Option<Self> {
        let medium = Medium::new(planet.atmosphere.as_ref()?);
        let radius = planet.radius_km;
        let depths = DepthTable::new(&medium, radius);
        Some(Self { medium, radius, sun_radius_rad: planet.star.radius_deg.to_radians(), depths })
    }

    /// Share of the star's disc over the horizon, as in the shaders.
    pub(super) fn over_horizon(&self, altitude: f64, mu: f64) -> f64 {
        let half = self.sun_radius_rad.max(0.0015);
        let x = ((mu - horizon_mu(self.radius, altitude)) / (2.0 * half) + 0.5).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    }

    /// Light of the star that reaches a place, of one.
    pub(super) fn sunlight(&self, altitude: f64, mu: f64) -> DVec3 {
        let visible = self.over_horizon(altitude, mu);
        if visible <= 0.0 {
            return DVec3::ZERO;
        }
        // The part of the disc that is seen is over the horizon.
        (-self.depths.at(altitude, mu.max(horizon_mu(self.radius, altitude)))).exp() * visible
    }
}

fn radiance(lit: &Lit, table: &MultiscatterTable, ray: &SkyRay) -> DVec3 {
    let (dir, sun) = ray.directions();
    let line = Line { radius: lit.radius, altitude: ray.altitude_m * 1e-3, mu: dir.z };
    let Some(way) = line.within(lit.medium.top) else { return DVec3::ZERO };
    let cosine = dir.dot(sun);
    let phases = (rayleigh_phase(cosine), lit.medium.mie_phase(cosine));
    let (mut radiance, mut transmittance) = (DVec3::ZERO, DVec3::ONE);
    for (t, length) in way.steps(STEPS) {
        let altitude = line.altitude_at(t);
        let sun_mu = (((lit.radius + line.altitude) * sun.z + t * cosine) / (lit.radius + altitude)).clamp(-1.0, 1.0);
        let place = lit.medium.at(altitude);
        let direct = (place.rayleigh * phases.0 + place.mie * phases.1) * lit.sunlight(altitude, sun_mu);
        let source = direct + (place.rayleigh + place.mie) * table.at(altitude, sun_mu);
        let passed = (-place.extinction * length).exp();
        radiance += transmittance * source * (1.0 - passed) / place.extinction.max(DVec3::splat(1e-300));
        transmittance *= passed;
    }
    radiance
}
