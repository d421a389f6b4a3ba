//! The colour of a star by its temperature: the chromaticity of a black body (Kim et al., Design of advanced color
//! temperature control system for HDTV applications, 2002) in linear sRGB, scaled so that the greatest component is 1.

/// The temperatures, in kelvin, for which the fit holds.
pub const STAR_KELVIN: std::ops::RangeInclusive<f64> = 1700.0..=25_000.0;

/// Linear sRGB of a star.
pub fn star_color(kelvin: f64) -> [f64; 3] {
    let t = 1000.0 / kelvin.clamp(*STAR_KELVIN.start(), *STAR_KELVIN.end());
    let x = if t > 0.25 {
        -0.266_123_9 * t * t * t - 0.234_358_9 * t * t + 0.877_695_6 * t + 0.179_910
    } else {
        -3.025_846_9 * t * t * t + 2.107_037_9 * t * t + 0.222_634_7 * t + 0.240_390
    };
    let y = if t > 1.0 / 2.222 {
        -1.106_381_4 * x * x * x - 1.348_110_2 * x * x + 2.185_558_32 * x - 0.202_196_83
    } else if t > 0.25 {
        -0.954_947_6 * x * x * x - 1.374_185_93 * x * x + 2.091_370_15 * x - 0.167_488_67
    } else {
        3.081_758 * x * x * x - 5.873_386_7 * x * x + 3.751_129_97 * x - 0.370_014_83
    };
    let (cie_x, cie_z) = (x / y, (1.0 - x - y) / y);
    let rgb = [
        3.240_454 * cie_x - 1.537_138 - 0.498_531 * cie_z,
        -0.969_266 * cie_x + 1.876_011 + 0.041_556 * cie_z,
        0.055_643 * cie_x - 0.204_026 + 1.057_225 * cie_z,
    ]
    .map(|c| c.max(0.0));
    let greatest = rgb.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    // Four digits: more would only clutter the file.
    rgb.map(|c| (c / greatest * 1e4).round() / 1e4)
}

/// The temperature whose colour has the same balance of red and blue.
pub fn star_kelvin(color: [f64; 3]) -> f64 {
    let blueness = |[red, _, blue]: [f64; 3]| blue - red;
    let greatest = color.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let wanted = blueness(color.map(|c| c / greatest));
    let (mut low, mut high) = (*STAR_KELVIN.start(), *STAR_KELVIN.end());
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if blueness(star_color(middle)) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cool_stars_are_red_and_hot_ones_blue() {
        let [red, green, blue] = star_color(3000.0);
        assert!(red == 1.0 && green < 0.7 && blue < 0.3, "{red} {green} {blue}");
        // The white of sRGB lies near 6500 K, a little above the locus of black bodies.
        assert!(star_color(6504.0).iter().all(|c| *c > 0.93));
        let [red, _, blue] = star_color(20_000.0);
        assert!(blue == 1.0 && red < 0.6);
    }

    #[test]
    fn a_colour_tells_its_temperature() {
        for kelvin in [2000.0, 3500.0, 5772.0, 8000.0, 15_000.0] {
            let found = star_kelvin(star_color(kelvin));
            assert!((found / kelvin - 1.0).abs() < 0.01, "{kelvin}: {found}");
        }
    }
}
