//! White balance: gains that make white ground in daylight white on the display.
//!
//! A camera set to daylight corrects the colour of its star's light after the air has filtered it. The correction is
//! bounded: the picture stays orange under the orange haze of a Titan.

use crate::planet::{Atmosphere, Planet};

/// Cosine of the star's zenith angle that counts as daylight.
const DAYLIGHT_COSINE: f64 = 0.75;
/// Share of the scattered light that reaches the ground as skylight. A two-stream estimate for thin air.
const SCATTERED_DOWN: f64 = 0.5;
/// Number of times that daylight crosses the absorber on its way to a viewer: down to white clouds, and up again.
const ABSORBER_CROSSINGS: f64 = 2.0;
/// Largest and smallest gain of a channel, relative to the luminance of white.
const GAIN_RANGE: (f64, f64) = (0.9, 1.1);

/// Gains on red, green and blue radiance that make white ground in a planet's daylight white. Each is 0.9 to 1.1;
/// white keeps its luminance unless a gain meets one of those bounds.
pub fn white_balance(planet: &Planet) -> [f64; 3] {
    let air = planet.atmosphere.as_ref();
    let white: [f64; 3] =
        std::array::from_fn(|i| planet.star.color[i] * air.map_or(1.0, |air| daylight(air, i)).max(1e-6));
    let luminance = 0.2126 * white[0] + 0.7152 * white[1] + 0.0722 * white[2];
    white.map(|c| (luminance / c.max(1e-6)).clamp(GAIN_RANGE.0, GAIN_RANGE.1))
}

/// Share of the star's light, direct and scattered, that white ground receives in daylight; `channel` is 0 to 2.
fn daylight(air: &Atmosphere, channel: usize) -> f64 {
    let scattering =
        air.rayleigh_per_km[channel] * air.rayleigh_scale_km + air.mie_scattering_per_km[channel] * air.mie_scale_km;
    let haze = air.mie_absorption_per_km[channel] * air.mie_scale_km;
    // The absorber's density is a triangle of height 1.
    let absorber = air.absorber_per_km[channel] * air.absorber_width_km;
    let kept = |depth: f64| libm::exp(-depth / DAYLIGHT_COSINE);
    let direct = kept(scattering);
    (direct + SCATTERED_DOWN * (1.0 - direct)) * kept(haze + ABSORBER_CROSSINGS * absorber)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::STARTING_AIRS;

    fn under(air: Option<Atmosphere>, color: [f64; 3]) -> [f64; 3] {
        let mut planet = Planet { atmosphere: air, ..Planet::default() };
        planet.star.color = color;
        white_balance(&planet)
    }

    #[test]
    fn daylight_becomes_white_and_strange_light_stays_strange() {
        let [r, g, b] = under(Some(Atmosphere::default()), [1.0, 0.98, 0.955]);
        assert!(r < 0.96 && b > 1.03 && (0.97..1.05).contains(&g), "{r} {g} {b}");
        let bare = under(None, [1.0; 3]);
        assert!(bare.iter().all(|gain| (gain - 1.0).abs() < 1e-12), "{bare:?}");
        for air in STARTING_AIRS {
            for color in [[1.0, 0.4, 0.1], [0.6, 0.7, 1.0], [0.0; 3]] {
                let found = under(Some(air.make()), color);
                assert!(found.iter().all(|gain| (0.9..=1.1).contains(gain)), "{} {found:?}", air.name);
            }
        }
    }
}
