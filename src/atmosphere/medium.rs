//! What the air is made of: scattering and extinction coefficients by altitude, and phase functions.

use crate::planet::Atmosphere;
use glam::DVec3;
use std::f64::consts::PI;

/// Coefficients per kilometre at the reference sphere, and their profiles over altitude.
#[derive(Clone, Debug)]
pub(super) struct Medium {
    /// Altitude at which the air ends, km.
    pub(super) top: f64,
    rayleigh: DVec3,
    rayleigh_scale: f64,
    mie_scattering: DVec3,
    mie_extinction: DVec3,
    mie_scale: f64,
    anisotropy: f64,
    absorber: DVec3,
    absorber_height: f64,
    absorber_width: f64,
    pub(super) ground_albedo: DVec3,
}

/// Coefficients at one altitude, per kilometre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coefficients {
    /// Scattering by molecules.
    pub(super) rayleigh: DVec3,
    /// Scattering by haze.
    pub(super) mie: DVec3,
    /// All scattering and absorption.
    pub(super) extinction: DVec3,
}

/// Moments of the phase function of haze.
#[derive(Clone, Copy, Debug)]
pub(super) struct Haze {
    /// The mean cosine.
    pub(super) first: f64,
    /// The mean of the second Legendre polynomial of the cosine.
    pub(super) second: f64,
}

impl Coefficients {
    /// Scattering by molecules and haze.
    pub(super) fn scattering(&self) -> DVec3 {
        self.rayleigh + self.mie
    }
}

impl Medium {
    pub(super) fn new(air: &Atmosphere) -> Self {
        let mie_scattering = DVec3::from_array(air.mie_scattering_per_km);
        Self {
            top: air.height_km,
            rayleigh: DVec3::from_array(air.rayleigh_per_km),
            rayleigh_scale: air.rayleigh_scale_km,
            mie_scattering,
            mie_extinction: mie_scattering + DVec3::from_array(air.mie_absorption_per_km),
            mie_scale: air.mie_scale_km,
            anisotropy: air.mie_anisotropy,
            absorber: DVec3::from_array(air.absorber_per_km),
            absorber_height: air.absorber_height_km,
            absorber_width: air.absorber_width_km,
            ground_albedo: DVec3::from_array(air.ground_albedo),
        }
    }

    /// Coefficients at an altitude in kilometres.
    pub(super) fn at(&self, altitude: f64) -> Coefficients {
        let h = altitude.max(0.0);
        let rayleigh = self.rayleigh * (-h / self.rayleigh_scale).exp();
        let haze = (-h / self.mie_scale).exp();
        let absorber = self.absorber * (1.0 - (h - self.absorber_height).abs() / self.absorber_width).max(0.0);
        let extinction = rayleigh + self.mie_extinction * haze + absorber;
        Coefficients { rayleigh, mie: self.mie_scattering * haze, extinction }
    }

    /// The same air with haze that does not scatter its forward peak: light in the peak counts as not scattered. Haze
    /// that scatters forward is then nearly even, and the first two moments of its phase function suffice (delta-M
    /// method: Wiscombe, The delta-M method: rapid yet accurate radiative flux calculations for strongly asymmetric
    /// phase functions, 1977).
    pub(super) fn without_peak(&self) -> Self {
        let peak = self.mie_scattering * self.peak();
        Self { mie_scattering: self.mie_scattering - peak, mie_extinction: self.mie_extinction - peak, ..self.clone() }
    }

    /// Share of light scattered by haze that is in the forward peak: the fourth moment of the phase function of Henyey
    /// and Greenstein.
    fn peak(&self) -> f64 {
        self.anisotropy.max(0.0).powi(4)
    }

    /// Moments of the Mie phase function: the means of the first two Legendre polynomials of the cosine.
    pub(super) fn haze(&self) -> Haze {
        let (g, g2) = (self.anisotropy, self.anisotropy * self.anisotropy);
        // The mean squared cosine, from those of the second and the fourth power over Henyey and Greenstein's function.
        let squared = 1.5 / (2.0 + g2) * ((2.0 * g2 + 1.0) / 3.0 + (8.0 * g2 * g2 + 20.0 * g2 + 7.0) / 35.0);
        Haze { first: 0.6 * g * (4.0 + g2) / (2.0 + g2), second: 1.5 * squared - 0.5 }
    }

    /// The moments without the forward peak, of what remains.
    pub(super) fn haze_without_peak(&self) -> Haze {
        let (all, peak) = (self.haze(), self.peak());
        Haze { first: (all.first - peak) / (1.0 - peak), second: (all.second - peak) / (1.0 - peak) }
    }

    /// Upper bound of the extinction at any altitude.
    pub(super) fn max_extinction(&self) -> DVec3 {
        self.rayleigh + self.mie_extinction + self.absorber
    }

    /// Cornette and Shanks, Physically reasonable analytic expression for the single-scattering phase function, 1992.
    pub(super) fn mie_phase(&self, cosine: f64) -> f64 {
        let g = self.anisotropy;
        let base = (1.0 + g * g - 2.0 * g * cosine).max(1e-6);
        3.0 / (8.0 * PI) * (1.0 - g * g) * (1.0 + cosine * cosine) / ((2.0 + g * g) * base * base.sqrt())
    }

    /// Asymmetry of the Mie phase function, -1 to 1; positive scatters forward.
    pub(super) fn anisotropy(&self) -> f64 {
        self.anisotropy
    }
}

/// Henyey and Greenstein, Diffuse radiation in the galaxy, 1941. `g`: the mean cosine.
pub(super) fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    let base = (1.0 + g * g - 2.0 * g * cosine).max(1e-6);
    (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
}

pub(super) fn rayleigh_phase(cosine: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + cosine * cosine)
}
