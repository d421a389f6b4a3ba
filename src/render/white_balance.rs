//! White balance: gains that make white ground in daylight white on the display.
//!
//! A camera set to daylight corrects the colour of its star's light after the air has filtered it. The correction is
//! bounded: the picture stays orange under the orange haze of a Titan.

use super::Post;
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

/// Gains on red, green and blue of a camera that shows light of a colour temperature in [`Post::WHITE_K`] as white.
/// Luminance of white stays.
pub(crate) fn camera_balance(white_k: f64) -> [f64; 3] {
    let (least, most) = Post::WHITE_K.into_inner();
    let shown = [white_k, Post::DAYLIGHT_K].map(|kelvins| black_body(kelvins.clamp(least, most)));
    let gains: [f64; 3] = std::array::from_fn(|i| shown[1][i] / shown[0][i].max(0.02));
    let luminance = 0.2126 * gains[0] + 0.7152 * gains[1] + 0.0722 * gains[2];
    gains.map(|gain| gain / luminance)
}

/// Colour of a black body in linear sRGB, of luminance 1, from 1,667 to 25,000 kelvins (Kim et al., Design of advanced
/// color temperature control system for HDTV applications, 2002).
fn black_body(kelvins: f64) -> [f64; 3] {
    let polynomial = |x: f64, of: [f64; 4]| of.iter().fold(0.0, |sum, factor| sum * x + factor);
    let t = 1000.0 / kelvins;
    let x = match kelvins {
        _ if kelvins < 4000.0 => polynomial(t, [-0.266_123_9, -0.234_358_9, 0.877_695_6, 0.179_910]),
        _ => polynomial(t, [-3.025_846_9, 2.107_037_9, 0.222_634_7, 0.240_390]),
    };
    let y = match kelvins {
        _ if kelvins < 2222.0 => polynomial(x, [-1.106_381_4, -1.348_110_2, 2.185_558_32, -0.202_196_83]),
        _ if kelvins < 4000.0 => polynomial(x, [-0.954_947_6, -1.374_185_93, 2.091_370_15, -0.167_488_67]),
        _ => polynomial(x, [3.081_758, -5.873_386_7, 3.751_129_97, -0.370_014_83]),
    };
    let [x, z] = [x / y, (1.0 - x - y) / y];
    [
        3.240_45 * x - 1.537_14 - 0.498_53 * z,
        -0.969_27 * x + 1.876_01 + 0.041_56 * z,
        0.055_64 * x - 0.204_03 + 1.057_23 * z,
    ]
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
    fn a_camera_set_to_lamps_shows_daylight_blue() {
        let daylight = camera_balance(Post::DAYLIGHT_K);
        assert!(daylight.iter().all(|gain| (gain - 1.0).abs() < 1e-9), "{daylight:?}");
        let mut redness = 0.0;
        for kelvins in [2000.0, 2500.0, 3900.0, 4100.0, 6504.0, 9000.0, 25_000.0] {
            let [r, g, b] = camera_balance(kelvins);
            assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 1e-9);
            assert!(r / b > redness, "{kelvins} K: {r} {g} {b}");
            redness = r / b;
        }
        // Standard illuminant A, 2,856 K: XYZ of 1.0985, 1, 0.3558 (CIE 15), in linear sRGB.
        let [r, g, b] = black_body(2856.0);
        assert!((r - 1.845).abs() < 0.02 && (g - 0.826).abs() < 0.01 && (b - 0.233).abs() < 0.01, "{r} {g} {b}");
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
