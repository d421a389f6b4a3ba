//! Reproducible random numbers.
#![allow(dead_code, unreachable_pub)]

use glam::DVec3;
use tellus::sphere::LatLon;

/// Numbers from 0 to 1 (SplitMix64).
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A uniformly distributed direction.
    pub fn place(&mut self) -> LatLon {
        LatLon {
            lat_rad: libm::asin(2.0 * self.roll() - 1.0),
            lon_rad: (2.0 * self.roll() - 1.0) * std::f64::consts::PI,
        }
    }
}

/// Pseudo-random unit directions (a linear congruential generator; goldens depend on them).
pub fn directions(mut state: u64, n: usize) -> Vec<DVec3> {
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| DVec3::new(next(), next(), next()).normalize()).collect()
}
