//! Light between bodies: reflected by a neighbour, or covered by one.

use glam::DVec3;

/// Brightness of the light that a body reflects to another, as a share of the starlight on the first: a Lambert sphere
/// (Russell, On the albedo of planets and their satellites, Astrophysical Journal 43, 1916).
///
/// `albedo`: share of the light that it reflects. `radius_m`, `distance_m`: of the body that reflects. `phase_rad`:
/// angle at it between the star and the place that it lights, 0 when full.
pub fn reflected(albedo: f64, radius_m: f64, distance_m: f64, phase_rad: f64) -> f64 {
    let lambert =
        (libm::sin(phase_rad) + (std::f64::consts::PI - phase_rad) * libm::cos(phase_rad)) / std::f64::consts::PI;
    2.0 / 3.0 * albedo * (radius_m / distance_m).powi(2) * lambert.max(0.0)
}

/// Angle at `corner` between two other places.
pub fn angle_at(corner: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (to_a, to_b) = (a - corner, b - corner);
    libm::atan2(to_a.cross(to_b).length(), to_a.dot(to_b))
}

/// Share of a star's disc that a round body leaves visible: the overlap of two discs, seen from one place.
/// `apart_rad`: angle between their middles.
pub fn visible_share(star_radius_rad: f64, body_radius_rad: f64, apart_rad: f64) -> f64 {
    let (star, body, apart) = (star_radius_rad, body_radius_rad, apart_rad);
    if apart >= star + body {
        return 1.0;
    }
    if apart <= body - star {
        return 0.0;
    }
    if apart <= star - body {
        return 1.0 - (body / star).powi(2);
    }
    let cosine =
        |own: f64, other: f64| ((apart * apart + own * own - other * other) / (2.0 * apart * own)).clamp(-1.0, 1.0);
    let segment = |own: f64, other: f64| {
        let half = libm::acos(cosine(own, other));
        own * own * (half - libm::sin(half) * libm::cos(half))
    };
    1.0 - (segment(star, body) + segment(body, star)) / (std::f64::consts::PI * star * star)
}

/// A star in the sky of a body.
#[derive(Clone, Copy, Debug)]
pub struct StarInSky {
    /// Unit vector from the body to the star.
    pub dir: DVec3,
    /// Distance between them.
    pub distance_m: f64,
    /// Angular radius of the star.
    pub radius_rad: f64,
}

/// Whether a neighbour covers a part of a star somewhere on a body of radius `radius_m`. `away_m`: the neighbour's
/// centre from the body's. `neighbour_m`: its radius.
pub fn may_shade(star: &StarInSky, away_m: DVec3, neighbour_m: f64, radius_m: f64) -> bool {
    let along_m = away_m.dot(star.dir);
    if along_m <= 0.0 || along_m >= star.distance_m {
        return false;
    }
    let aside_m = (away_m - star.dir * along_m).length();
    // The penumbra widens from the neighbour on, by the angular radius of the star.
    aside_m < neighbour_m + along_m * libm::tan(star.radius_rad) + radius_m * 1.05
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn discs_cover_as_in_geometry() {
        assert_eq!(visible_share(1.0, 1.0, 2.0), 1.0);
        assert_eq!(visible_share(1.0, 2.0, 0.9), 0.0);
        assert_eq!(visible_share(1.0, 0.5, 0.4), 0.75);
        // Two equal discs whose rims pass through each other's middle: the lens has 2 pi / 3 - sqrt(3) / 2.
        let lens = 2.0 * std::f64::consts::PI / 3.0 - 3f64.sqrt() / 2.0;
        assert!((visible_share(1.0, 1.0, 1.0) - (1.0 - lens / std::f64::consts::PI)).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_share_grows_with_the_distance(star in 0.001..0.1, body in 0.001..0.2, apart in 0.0..0.3, more in 0.0..0.05) {
            let [near, far] = [apart, apart + more].map(|apart| visible_share(star, body, apart));
            prop_assert!((0.0..=1.0).contains(&near) && far >= near - 1e-9, "{near} {far}");
        }
    }

    #[test]
    fn shadows_are_looked_for_where_they_can_fall() {
        let star = StarInSky { dir: DVec3::X, distance_m: 1.496e11, radius_rad: 0.00465 };
        let shades = |moon_m: DVec3| may_shade(&star, moon_m, 1.737e6, 6.371e6);
        assert!(shades(DVec3::new(3.844e8, 0.0, 0.0)));
        assert!(shades(DVec3::new(3.844e8, 9.5e6, 0.0)), "the penumbra touches the limb");
        assert!(!shades(DVec3::new(3.844e8, 3.0e7, 0.0)) && !shades(DVec3::new(-3.844e8, 0.0, 0.0)));
        let near = StarInSky { distance_m: 1e8, ..star };
        assert!(!may_shade(&near, DVec3::new(3.844e8, 0.0, 0.0), 1.737e6, 6.371e6), "it is behind the star");
    }

    #[test]
    fn the_full_moon_is_as_bright_as_known() {
        // 0.25 lux of 120,000 lux: with the Moon's geometric albedo of 0.12, a Lambert sphere has 0.18.
        let share = reflected(0.18, 1.737e6, 3.844e8, 0.0);
        assert!((2.0e-6..3.0e-6).contains(&share), "{share}");
        // The half Moon of a Lambert sphere has 1/pi of it, the new moon none.
        assert!(
            (reflected(0.18, 1.737e6, 3.844e8, std::f64::consts::FRAC_PI_2) / share - std::f64::consts::FRAC_1_PI)
                .abs()
                < 0.001
        );
        assert!(reflected(0.18, 1.737e6, 3.844e8, std::f64::consts::PI) < 1e-12);
    }
}
