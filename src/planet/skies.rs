//! Starting clouds. The seed and the wind of the clouds are the planet's own.

use super::Clouds;
use super::starting::Starting;

/// All of them, a fair sky first.
pub const STARTING_SKIES: &[Starting<Clouds>] = &[
    Starting::new("Fair", "Heaps and streaks, far apart", fair),
    Starting::new("Earth", "Belts of rain, clear subtropics, cyclones", earth),
    Starting::new("Overcast", "A low grey deck with few gaps", overcast),
    Starting::new("Storms", "Cyclones side by side, towering clouds", storms),
    Starting::new("Ice haze", "A thin veil high up and nothing below", ice_haze),
    Starting::new("Dust storms", "Fronts of dust that roll over the deserts", dust),
    Starting::new("Venus", "A closed, yellowish deck, streaked by fast winds", venus),
    Starting::new("Jupiter-like haze", "Ochre bands that curl into each other", giant),
];

fn fair() -> Clouds {
    Clouds {
        coverage: 0.15,
        storms: 0.2,
        middle: 0.05,
        veil: 0.15,
        veil_gap_km: 5.0,
        altitude_km: 1.2,
        thickness_km: 1.4,
        puff_km: 2.5,
        ..Clouds::default()
    }
}

fn earth() -> Clouds {
    Clouds {
        coverage: 0.35,
        storms: 0.7,
        altitude_km: 1.5,
        thickness_km: 6.0,
        density: 24.0,
        puff_km: 4.0,
        towers: 0.8,
        rain: 0.4,
        middle: 0.15,
        middle_gap_km: 0.3,
        veil: 0.12,
        veil_gap_km: 2.0,
        fog: 0.04,
        ..Clouds::default()
    }
}

fn overcast() -> Clouds {
    Clouds {
        coverage: 0.92,
        storms: 0.3,
        altitude_km: 1.0,
        thickness_km: 1.5,
        density: 22.0,
        puff_km: 9.0,
        layering: 0.8,
        rain: 0.3,
        middle: 0.3,
        veil: 0.0,
        fog: 0.05,
        ..Clouds::default()
    }
}

fn storms() -> Clouds {
    Clouds {
        coverage: 0.45,
        storms: 1.0,
        cyclones: 40,
        altitude_km: 1.2,
        thickness_km: 9.0,
        density: 50.0,
        puff_km: 6.0,
        layering: -0.3,
        towers: 1.0,
        rain: 1.0,
        middle: 0.2,
        middle_gap_km: 0.2,
        veil: 0.3,
        veil_gap_km: 2.0,
        ..Clouds::default()
    }
}

fn ice_haze() -> Clouds {
    Clouds {
        coverage: 0.0,
        storms: 0.3,
        veil: 0.8,
        altitude_km: 8.0,
        thickness_km: 1.0,
        veil_gap_km: 1.0,
        ..Clouds::default()
    }
}

fn dust() -> Clouds {
    Clouds {
        coverage: 0.3,
        storms: 0.5,
        veil: 0.0,
        scale_km: 1200.0,
        curl: 1.2,
        altitude_km: 0.1,
        thickness_km: 5.0,
        density: 8.0,
        puff_km: 12.0,
        layering: 0.5,
        color: [0.8, 0.5, 0.28],
        ..Clouds::default()
    }
}

fn venus() -> Clouds {
    Clouds {
        coverage: 1.0,
        storms: 0.0,
        veil: 0.5,
        scale_km: 6000.0,
        curl: 0.5,
        altitude_km: 48.0,
        thickness_km: 18.0,
        density: 30.0,
        puff_km: 60.0,
        veil_gap_km: 18.0,
        color: [0.96, 0.88, 0.62],
        ..Clouds::default()
    }
}

fn giant() -> Clouds {
    Clouds {
        coverage: 0.75,
        storms: 0.8,
        veil: 0.4,
        scale_km: 9000.0,
        curl: 2.0,
        altitude_km: 20.0,
        thickness_km: 25.0,
        density: 25.0,
        puff_km: 120.0,
        middle: 0.4,
        middle_gap_km: 5.0,
        middle_thickness_km: 8.0,
        middle_puff_km: 60.0,
        veil_gap_km: 25.0,
        color: [0.85, 0.64, 0.42],
        ..Clouds::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, validate};

    #[test]
    fn every_starting_sky_is_valid_and_another() {
        for (number, sky) in STARTING_SKIES.iter().enumerate() {
            let planet = Planet { clouds: Some(sky.make()), ..Planet::default() };
            assert_eq!(validate::problems(&planet), [], "{}", sky.name);
            assert!(STARTING_SKIES[..number].iter().all(|other| other.make() != sky.make()), "{}", sky.name);
        }
    }
}
