//! The spectrum of the waves that wind raises, and of swell.

use crate::planet::Water;
use std::f64::consts::TAU;

/// Gravity that drives the waves, m/s².
pub(super) const GRAVITY_M_S2: f64 = 9.81;
/// Share of the variance of slopes in each natural logarithm of the wavelength, in a sea as high as its wind can raise
/// it: half of the constant of Phillips (Pierson and Moskowitz 1964).
const PHILLIPS: f64 = 0.0081;
/// Dimensionless fetch (gravity times fetch, over the square of the wind) from which waves grow no more: there the
/// peak of JONSWAP (Hasselmann et al. 1973) is that of Pierson and Moskowitz.
const FULL_FETCH: f64 = 15_800.0;
/// How much higher the peak of a young sea is (Hasselmann et al. 1973).
const PEAK: f64 = 3.3;
/// Wavelength of swell, metres, and its width in natural logarithms.
const SWELL_M: f64 = 190.0;
const SWELL_WIDTH: f64 = 0.25;

/// Variance of the slope by wavelength, at a speed of the wind.
pub(super) struct Spectrum {
    peak_per_m: f64,
    alpha: f64,
    /// Height of the peak over the rest.
    gamma: f64,
    /// Variance of the slope of all swell.
    swell: f64,
}

impl Spectrum {
    /// The spectrum of a sea under a wind.
    pub(super) fn new(water: &Water, wind_m_s: f64) -> Self {
        let wind_m_s = wind_m_s.max(0.2);
        let fetch = GRAVITY_M_S2 * water.fetch_km * 1e3 / (wind_m_s * wind_m_s);
        let young = (1.0 - fetch / FULL_FETCH).clamp(0.0, 1.0);
        let fetch = fetch.clamp(1.0, FULL_FETCH);
        let peak_rad_s = 22.0 * libm::cbrt(1.0 / fetch) * GRAVITY_M_S2 / wind_m_s;
        // A significant height is four standard deviations.
        let swell_k = TAU / SWELL_M;
        let slope = 0.25 * water.swell_m * swell_k;
        // The mean height over the width of the peak is a little greater than in its middle.
        let swell = slope * slope * libm::exp(-2.0 * SWELL_WIDTH * SWELL_WIDTH);
        Self {
            peak_per_m: peak_rad_s * peak_rad_s / GRAVITY_M_S2,
            alpha: (0.076 * libm::pow(fetch, -0.22)).max(PHILLIPS),
            gamma: 1.0 + (PEAK - 1.0) * young,
            swell,
        }
    }

    /// Variance of the slope in one natural logarithm of the wavelength: of the waves that the wind raises.
    pub(super) fn wind(&self, k_per_m: f64) -> f64 {
        let x = self.peak_per_m / k_per_m;
        let from_peak = (libm::sqrt(k_per_m / self.peak_per_m) - 1.0) / 0.08;
        let peak = libm::pow(self.gamma, libm::exp(-0.5 * from_peak * from_peak));
        0.5 * self.alpha * libm::exp(-1.25 * x * x) * peak
    }

    /// The same of swell.
    pub(super) fn swell(&self, k_per_m: f64) -> f64 {
        let x = libm::log(k_per_m * SWELL_M / TAU) / SWELL_WIDTH;
        self.swell * libm::exp(-0.5 * x * x) / (SWELL_WIDTH * libm::sqrt(TAU))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Significant wave height: four standard deviations of the height.
    fn significant_m(water: &Water, wind_m_s: f64) -> f64 {
        let spectrum = Spectrum::new(water, wind_m_s);
        let steps = (0..2000).map(|i| libm::exp(-8.0 + 12.0 * f64::from(i) / 2000.0));
        let variance: f64 = steps.map(|k| (spectrum.wind(k) + spectrum.swell(k)) / (k * k) * (12.0 / 2000.0)).sum();
        4.0 * variance.sqrt()
    }

    #[test]
    fn heights_are_those_that_sailors_know() {
        let open = Water { swell_m: 0.0, fetch_km: 10_000.0, ..Water::default() };
        // Pierson and Moskowitz: 0.0246 s²/m times the square of the wind at 10 m, within its spread.
        for wind_m_s in [5.0, 10.0, 15.0, 20.0] {
            let ratio = significant_m(&open, wind_m_s) / (0.0246 * wind_m_s * wind_m_s);
            assert!((0.8..1.2).contains(&ratio), "{ratio} of the height at {wind_m_s} m/s");
        }
        // A lake 10 km wide under 10 m/s has waves of half a metre (JONSWAP: 0.0016 times the root of the fetch).
        let lake = Water { fetch_km: 10.0, ..open.clone() };
        let jonswap_m = 0.0016 * (9.81 * 1e4_f64 / 100.0).sqrt() * 100.0 / 9.81;
        let ratio = significant_m(&lake, 10.0) / jonswap_m;
        assert!((0.75..1.3).contains(&ratio), "{ratio} of {jonswap_m} m");
        let swell = Water { swell_m: 2.0, ..open };
        assert!((significant_m(&swell, 0.5) - 2.0).abs() < 0.1);
    }
}
