//! Starting atmospheres. Surface densities, scale heights and optical depths are those of the real atmospheres as far
//! as they are known, rounded, then tuned by eye for three colours.

use super::Atmosphere;
use super::starting::Starting;

/// All of them, the Earth's first.
pub const STARTING_AIRS: &[Starting<Atmosphere>] = &[
    Starting::new("Earth", "Blue by day, red at sunset", Atmosphere::default),
    Starting::new("Mars", "Thin and dusty: butterscotch by day, a blue sunset", mars),
    Starting::new("Titan", "Deep orange haze high above the ground", titan),
    Starting::new("Venus", "Dense and yellow; the ground lies in an orange dusk", venus),
    Starting::new("Hydrogen", "Deep and clear over the clouds of a gas giant", hydrogen),
    Starting::new("Alien green", "Green by day, a violet sunset", green),
];

/// Dust scatters more red than blue and absorbs blue; around a low star, the light that remains is blue.
fn mars() -> Atmosphere {
    Atmosphere {
        height_km: 100.0,
        rayleigh_per_km: [0.00008, 0.00019, 0.00046],
        rayleigh_scale_km: 11.1,
        mie_scattering_per_km: [0.03, 0.0225, 0.0145],
        mie_absorption_per_km: [0.0008, 0.003, 0.006],
        mie_scale_km: 11.1,
        mie_anisotropy: 0.72,
        absorber_per_km: [0.0; 3],
        ground_albedo: [0.3, 0.17, 0.1],
        ..Atmosphere::default()
    }
}

/// Four times the Earth's density at the ground, a haze that reaches hundreds of kilometres up.
fn titan() -> Atmosphere {
    Atmosphere {
        height_km: 500.0,
        rayleigh_per_km: [0.024, 0.057, 0.14],
        rayleigh_scale_km: 20.0,
        mie_scattering_per_km: [0.045, 0.034, 0.014],
        mie_absorption_per_km: [0.003, 0.012, 0.034],
        mie_scale_km: 55.0,
        mie_anisotropy: 0.6,
        absorber_per_km: [0.0, 0.002, 0.006],
        absorber_height_km: 200.0,
        absorber_width_km: 120.0,
        ground_albedo: [0.18, 0.12, 0.07],
        ..Atmosphere::default()
    }
}

fn venus() -> Atmosphere {
    Atmosphere {
        height_km: 160.0,
        rayleigh_per_km: [0.05, 0.118, 0.29],
        rayleigh_scale_km: 14.0,
        mie_scattering_per_km: [0.06, 0.056, 0.046],
        mie_absorption_per_km: [0.0003, 0.002, 0.008],
        mie_scale_km: 16.0,
        mie_anisotropy: 0.7,
        absorber_per_km: [0.0005, 0.004, 0.016],
        absorber_height_km: 60.0,
        absorber_width_km: 15.0,
        ground_albedo: [0.25, 0.2, 0.13],
        ..Atmosphere::default()
    }
}

/// Hydrogen scatters little; a haze of ice and soot lies over the clouds.
fn hydrogen() -> Atmosphere {
    Atmosphere {
        height_km: 420.0,
        rayleigh_per_km: [0.0002, 0.00045, 0.001],
        rayleigh_scale_km: 45.0,
        mie_scattering_per_km: [0.0012, 0.001, 0.0007],
        mie_absorption_per_km: [0.0001, 0.0003, 0.0008],
        mie_scale_km: 40.0,
        mie_anisotropy: 0.6,
        absorber_per_km: [0.0; 3],
        ground_albedo: [0.55, 0.42, 0.27],
        ..Atmosphere::default()
    }
}

fn green() -> Atmosphere {
    Atmosphere {
        rayleigh_per_km: [0.0065, 0.024, 0.0125],
        rayleigh_scale_km: 9.0,
        absorber_per_km: [0.0006, 0.0015, 0.0002],
        ..Atmosphere::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, validate};

    #[test]
    fn every_starting_air_is_valid() {
        for air in STARTING_AIRS {
            let planet = Planet { atmosphere: Some(air.make()), ..Planet::default() };
            assert_eq!(validate::problems(&planet), [], "{}", air.name);
        }
    }
}
