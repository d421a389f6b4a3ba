//! The water under a place: how its bed and its ice change the waves above.

use super::waves::Wave;
use crate::planet::Planet;
use crate::sphere::geo::east_north;
use crate::terrain::Terrain;
use crate::world::noise::ramp;
use glam::DVec3;

/// Distance from a place to the three points whose mean and whose plane are its bed, metres.
pub(crate) const BED_REACH_M: f64 = 5.0;
/// Wave number times depth from which the bed does nothing to a wave.
pub(crate) const DEEP: f64 = 4.0;
/// The phase that a wave gains on its way to depth 0 over a beach, times the root of its wave number: the integral of
/// the growth of the wave number (Eckart 1952) over an equilibrium profile (Dean 1977: depth = 0.15 times distance to
/// the power of 2/3, metres). It falls with wave number times depth as an exponential, within 1%.
pub(crate) const TURN: f64 = 0.469 / 0.0387;
pub(crate) const TURN_FALL: f64 = 1.75;
/// Standard deviation of the height of waves that break, by the depth: a quarter of 0.72, for waves as high as the mean
/// of the highest third (Thornton and Guza 1982).
pub(crate) const BREAKING: f64 = 0.18;
/// Share of the height of waves that come from the shore: they bend around the land.
pub(crate) const LEE: f64 = 0.35;
/// How many times shorter than the depth makes them waves may be; on steeper beds they are low.
pub(crate) const CROWDED: f64 = 3.5;
/// Length over which closed ice damps a wave, by its wave number.
pub(crate) const ICE_DAMPING_M: f64 = 60.0;
/// From how much colder than it freezes water has the first ice that damps waves, to where it is closed, °C.
pub(crate) const ICE_COLDER_C: [f64; 2] = [-4.0, 1.0];

/// The water under a place of the sea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Depth of the calm water, metres.
    pub depth_m: f64,
    /// Gradient of the depth: a tangent in the planet frame that points to deeper water.
    pub deepening_planet: DVec3,
    /// Share of the water that ice covers, 0 to 1.
    pub ice: f64,
}

impl Column {
    /// Deep open water.
    pub const DEEP: Self = Self { depth_m: f64::INFINITY, deepening_planet: DVec3::ZERO, ice: 0.0 };

    /// The water at a unit direction. Deep water where the planet has no sea.
    pub fn at(terrain: &Terrain, dir_planet: DVec3) -> Self {
        Self::of(terrain.planet(), terrain, dir_planet)
    }

    /// As [`Column::at`], with the sea of a planet over the ground of a terrain: edits of the sea need no new ground.
    pub(crate) fn of(planet: &Planet, terrain: &Terrain, dir_planet: DVec3) -> Self {
        let Some(water) = &planet.water else { return Self::DEEP };
        let (east, north) = east_north(dir_planet);
        let reach = BED_REACH_M / (planet.radius_m() + water.level_m);
        let (mut depth_m, mut deepening_planet) = (0.0, DVec3::ZERO);
        for [x, y] in [[0.0, 1.0], [-0.75_f64.sqrt(), -0.5], [0.75_f64.sqrt(), -0.5]] {
            let aside = east * x + north * y;
            let here_m = water.level_m - terrain.height_m((dir_planet + aside * reach).normalize());
            depth_m += here_m / 3.0;
            deepening_planet += aside * (here_m * 2.0 / (3.0 * BED_REACH_M));
        }
        let colder_c = water.freezing_c - terrain.sample(dir_planet).temperature_c;
        Self { depth_m: depth_m.max(0.0), deepening_planet, ice: ramp(ICE_COLDER_C[0], ICE_COLDER_C[1], colder_c) }
    }
}

/// A wave over a bed.
pub(super) struct Shoaled {
    /// Factor of its amplitude.
    pub(super) amplitude: f64,
    /// Phase that it gained.
    pub(super) turned_rad: f64,
    /// Tangential wave vector.
    pub(super) along_per_m: DVec3,
}

impl Column {
    /// How the column changes a wave. `deviation_m`: standard deviation of the height of all waves on deep water.
    pub(super) fn shoal(&self, wave: &Wave, up: DVec3, deviation_m: f64) -> Shoaled {
        let along = wave.vector_per_m.reject_from(up);
        let k = along.length();
        let afloat = libm::exp(-ICE_DAMPING_M * k * self.ice * self.ice);
        let depths = k * self.depth_m;
        if depths >= DEEP {
            return Shoaled { amplitude: afloat, turned_rad: 0.0, along_per_m: along };
        }
        let flat = libm::tanh(depths.max(1e-5));
        // Speed by that on deep water.
        let slower = flat.sqrt();
        let turned_rad = TURN / k.sqrt() * libm::exp(-TURN_FALL * depths);
        let along_per_m = along - self.deepening_planet * (TURN_FALL * k * turned_rad);
        let shorter = along_per_m.length() / k;
        let aligned = along_per_m.dot(along) / (k * k * shorter).max(1e-9);
        let lee = LEE + (1.0 - LEE) * ramp(-0.5, 0.5, aligned);
        let crowded = libm::pow(shorter * slower / CROWDED, 4.0);
        let breaking_m = BREAKING * self.depth_m;
        let unbroken = breaking_m / libm::hypot(breaking_m, deviation_m).max(1e-9);
        // Green's law; waves shorter than the depth do not feel the breaking of the long ones.
        let grown = (1.0 / (slower * (2.0 - flat))).sqrt() * (unbroken + (1.0 - unbroken) * flat * flat);
        Shoaled { amplitude: afloat * grown * lee / (1.0 + crowded), turned_rad, along_per_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(length_m: f64) -> Wave {
        Wave { vector_per_m: DVec3::X * TAU / length_m, amplitude_m: 1.0, phase_rad: 0.0, frequency_rad_s: 1.0 }
    }

    /// A beach of the profile of Dean, which rises towards +X, at a depth.
    fn beach(depth_m: f64) -> Column {
        let steep = 2.0 / 3.0 * libm::pow(0.15, 1.5) / depth_m.sqrt();
        Column { depth_m, deepening_planet: DVec3::NEG_X * steep, ice: 0.0 }
    }

    #[test]
    fn waves_get_as_short_as_the_depth_makes_them() {
        for length_m in [40.0, 120.0] {
            for depth_m in [1.0, 2.0, 4.0, 8.0, 16.0, 40.0] {
                let k = TAU / length_m;
                let shoaled = beach(depth_m).shoal(&wave(length_m), DVec3::Z, 0.0);
                // The dispersion relation: the deep wave number is the local one times tanh(local times depth).
                let local = shoaled.along_per_m.x;
                let deep = local * libm::tanh(local * depth_m);
                assert!((0.9..1.02).contains(&(deep / k)), "{length_m} m at {depth_m} m: {deep} for {k} per m");
            }
        }
    }

    #[test]
    fn crests_turn_to_the_shore_grow_and_break() {
        let oblique = Wave { vector_per_m: DVec3::new(0.6, 0.8, 0.0) * TAU / 80.0, ..wave(80.0) };
        let angle = |depth_m| beach(depth_m).shoal(&oblique, DVec3::Z, 0.0).along_per_m.angle_between(DVec3::X);
        assert!(angle(60.0) > 0.85 && angle(3.0) < 0.45 && angle(0.5) < 0.25, "{} {}", angle(3.0), angle(0.5));
        let height = |depth_m, deviation_m| beach(depth_m).shoal(&wave(80.0), DVec3::Z, deviation_m).amplitude;
        assert!(height(1.0, 0.01) > 1.2 && (height(30.0, 0.01) - 1.0).abs() < 0.1);
        // The waves of a sea of 4 m break where they are as high as the depth allows.
        assert!(height(2.0, 1.0) < 1.5 * BREAKING * 2.0);
        let dry = Column { depth_m: 0.0, ..beach(0.1) };
        assert!(dry.shoal(&wave(80.0), DVec3::Z, 1.0).amplitude < 1e-3);
        // Waves from the shore, and those on a cliff, are low.
        let from_land = Wave { vector_per_m: DVec3::NEG_X * TAU / 80.0, ..wave(80.0) };
        assert!(beach(2.0).shoal(&from_land, DVec3::Z, 0.1).amplitude < 0.6 * height(2.0, 0.1));
        let cliff = Column { deepening_planet: DVec3::NEG_X * 2.0, ..beach(2.0) };
        assert!(cliff.shoal(&wave(80.0), DVec3::Z, 0.1).amplitude < 0.1 * height(2.0, 0.1));
    }

    #[test]
    fn ice_damps_short_waves_first() {
        let height = |length_m, ice| {
            let column = Column { ice, ..Column::DEEP };
            column.shoal(&wave(length_m), DVec3::Z, 1.0).amplitude
        };
        assert_eq!(height(200.0, 0.0), 1.0);
        assert!(height(10.0, 0.3) < 0.1 && height(200.0, 0.3) > 0.7);
        assert!(height(30.0, 1.0) < 1e-4 && height(200.0, 1.0) < 0.2);
    }
}
