//! Starting seas. The level of a sea and the climate are the planet's own. Colours and absorption of water are those of
//! Jerlov's water types as far as they are known; the others are tuned by eye.

use super::Water;
use super::starting::Starting;

/// All of them, the Earth's first.
pub const STARTING_SEAS: &[Starting<Water>] = &[
    Starting::new("Ocean", "Deep blue, with the swell of far storms", Water::default),
    Starting::new("Lagoon", "Clear and calm: turquoise over sand", lagoon),
    Starting::new("Stormy", "High waves and whitecaps", stormy),
    Starting::new("Silt", "Brown and shallow: a flooded plain", silt),
    Starting::new("Frozen", "Floes and leads nearly everywhere", frozen),
    Starting::new("Methane", "Dark, calm and very cold", methane),
    Starting::new("Acid", "Yellow-green, cloudy", acid),
    Starting::new("Lava", "Dark crust that drifts on glowing rock", lava),
];

fn lagoon() -> Water {
    Water {
        absorption_per_m: [0.3, 0.025, 0.01],
        color: [0.004, 0.035, 0.06],
        wind_m_s: 4.0,
        fetch_km: 20.0,
        swell_m: 0.1,
        ..Water::default()
    }
}

fn stormy() -> Water {
    Water {
        absorption_per_m: [0.36, 0.06, 0.04],
        color: [0.006, 0.024, 0.032],
        wind_m_s: 18.0,
        swell_m: 4.0,
        ..Water::default()
    }
}

fn silt() -> Water {
    Water {
        absorption_per_m: [0.5, 0.7, 1.4],
        color: [0.14, 0.095, 0.045],
        wind_m_s: 5.0,
        fetch_km: 30.0,
        swell_m: 0.0,
        ..Water::default()
    }
}

fn frozen() -> Water {
    Water { freezing_c: 6.0, floe_m: 5000.0, swell_m: 0.2, ..Water::default() }
}

/// Liquid methane absorbs red in the near infrared bands; waves are low where air is thick and gravity weak.
fn methane() -> Water {
    Water {
        absorption_per_m: [0.22, 0.08, 0.06],
        color: [0.006, 0.004, 0.002],
        wind_m_s: 1.0,
        fetch_km: 50.0,
        swell_m: 0.0,
        freezing_c: -182.0,
        ice_color: [0.5, 0.42, 0.3],
        ..Water::default()
    }
}

fn acid() -> Water {
    Water {
        absorption_per_m: [0.12, 0.08, 0.9],
        color: [0.09, 0.11, 0.006],
        wind_m_s: 5.0,
        freezing_c: -40.0,
        ice_color: [0.6, 0.6, 0.25],
        ..Water::default()
    }
}

/// Crust is the ice of this sea: it covers what is colder than molten basalt.
fn lava() -> Water {
    Water {
        absorption_per_m: [8.0, 8.0, 8.0],
        color: [0.02, 0.008, 0.004],
        wind_m_s: 0.5,
        fetch_km: 1.0,
        swell_m: 0.0,
        freezing_c: 1000.0,
        ice_color: [0.022, 0.02, 0.019],
        floe_m: 400.0,
        glow: 1.2,
        glow_color: [1.0, 0.16, 0.012],
        ..Water::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, validate};

    #[test]
    fn every_starting_sea_is_valid_and_another() {
        for (number, sea) in STARTING_SEAS.iter().enumerate() {
            let planet = Planet { water: Some(sea.make()), ..Planet::default() };
            assert_eq!(validate::problems(&planet), [], "{}", sea.name);
            assert!(STARTING_SEAS[..number].iter().all(|other| other.make() != sea.make()), "{}", sea.name);
        }
    }
}
