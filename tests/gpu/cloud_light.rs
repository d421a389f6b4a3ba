//! Light under clouds: what arrives at the layers beneath others.

use crate::night::{radiance, sum};
use crate::support::earth;
use std::sync::Arc;
use tellus::planet::{Clouds, Planet};

/// Light of a view from 2 m, 45 degrees upwards, the star at a longitude.
fn light(clouds: Clouds, sun_lon: f64) -> f64 {
    let planet = Arc::new(Planet { clouds: Some(clouds), ..earth() });
    sum(&radiance(&planet, [0.0, -70.0, 2.0, 0.0, 45.0], sun_lon))
}

/// Layers under a closed deck are lit by the light that it lets through: they are no brighter than its base.
#[test]
fn rain_and_fog_are_no_brighter_than_the_deck_over_them() {
    for density in [8.0, 32.0, 80.0] {
        let deck =
            Clouds { coverage: 1.0, density, layering: 1.0, middle: 0.0, veil: 0.0, fog: 0.0, ..Clouds::default() };
        let base = Clouds { rain: 0.0, ..deck.clone() };
        // At noon and near sunset.
        for sun_lon in [-60.0, 12.0] {
            let dry = light(base.clone(), sun_lon);
            for (name, wet) in
                [("rain", Clouds { rain: 1.0, ..deck.clone() }), ("fog", Clouds { fog: 1.0, ..base.clone() })]
            {
                let wet = light(wet, sun_lon);
                assert!(wet < 1.1 * dry && wet > 0.2 * dry, "{name} under {density} at {sun_lon}: {}", wet / dry);
            }
        }
    }
}

/// From below, clouds hide the airglow: they are darker than the sky beside them.
#[test]
fn clouds_are_dark_at_night() {
    let with = |coverage: f64| {
        let clouds = earth().clouds.map(|clouds| Clouds { coverage, middle: 0.0, veil: 0.0, fog: 0.0, ..clouds });
        sum(&radiance(&Arc::new(Planet { clouds, ..earth() }), [0.0, -70.0, 2.0, 0.0, 60.0], 110.0))
    };
    let (clear, overcast) = (with(0.0), with(1.0));
    assert!(overcast < 0.75 * clear && overcast > 0.1 * clear, "{overcast} under clouds, {clear} without");
}
