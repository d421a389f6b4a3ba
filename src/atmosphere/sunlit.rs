//! The air of a planet together with its sun: the sunlight that reaches an altitude.

use super::depth::DepthLut;
use super::line::horizon_mu;
use super::medium::Medium;
use crate::planet::Planet;
use glam::DVec3;

/// Smallest angular radius of the sun, in radians: sunset takes at least this long. `air_model.wgsl` uses the same
/// value.
const MIN_SUN_RADIUS_RAD: f64 = 0.0015;

/// Air that a sun shines on.
#[derive(Clone, Debug)]
pub(super) struct SunlitAir {
    pub(super) medium: Medium,
    pub(super) radius: f64,
    sun_radius_rad: f64,
    depths: DepthLut,
    /// The air without the forward peak of haze, and its depths.
    pub(super) smooth: Medium,
    smooth_depths: DepthLut,
}

impl SunlitAir {
    pub(super) fn new(planet: &Planet) -> Option<Self> {
        let medium = Medium::new(planet.atmosphere.as_ref()?);
        let radius = planet.radius_km;
        let smooth = medium.without_peak();
        let (depths, smooth_depths) = (DepthLut::new(&medium, radius), DepthLut::new(&smooth, radius));
        let sun_radius_rad = planet.star.radius_deg.to_radians();
        Some(Self { medium, radius, sun_radius_rad, depths, smooth, smooth_depths })
    }

    /// Share of the sun's disc above the horizon, 0 to 1, approximated by the same smooth step as in the shaders.
    fn share_above_horizon(&self, altitude: f64, mu: f64) -> f64 {
        let half = self.sun_radius_rad.max(MIN_SUN_RADIUS_RAD);
        let x = ((mu - horizon_mu(self.radius, altitude)) / (2.0 * half) + 0.5).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    }

    /// Direct sunlight at an altitude, as a share of the irradiance above the air; `mu`: cosine of the sun's zenith
    /// angle.
    pub(super) fn sunlight(&self, altitude: f64, mu: f64) -> DVec3 {
        self.through(&self.depths, altitude, mu)
    }

    /// The same, with the light that haze has scattered into its forward peak.
    pub(super) fn beam(&self, altitude: f64, mu: f64) -> DVec3 {
        self.through(&self.smooth_depths, altitude, mu)
    }

    fn through(&self, depths: &DepthLut, altitude: f64, mu: f64) -> DVec3 {
        let visible = self.share_above_horizon(altitude, mu);
        if visible <= 0.0 {
            return DVec3::ZERO;
        }
        // When the centre has set, light still comes from the part of the disc above the horizon.
        (-depths.at(altitude, mu.max(horizon_mu(self.radius, altitude)))).exp() * visible
    }
}
