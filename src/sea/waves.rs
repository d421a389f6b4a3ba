//! The waves of a place, and the water's height.

use super::column::Column;
use super::spectrum::{GRAVITY_M_S2, Spectrum};
use super::wind::relative_wind;
use crate::planet::Planet;
use crate::sphere::spread;
use crate::terrain::Terrain;
use crate::world::noise::{hash, ramp, unit};
use crate::world::weather::Weather;
use glam::{DQuat, DVec3, EulerRot};
use std::f64::consts::TAU;

/// The longest and the shortest wavelength, metres, and the number of bands between them.
const LENGTHS_M: (f64, f64) = (420.0, 0.14);
const BANDS: u32 = 14;
/// Directions of space in a band of long waves, and of short ones; about a sixth of them run with the wind of a place.
/// Few long waves would cross in a lattice.
const DIRECTIONS: (usize, usize) = (44, 20);
/// Wave number from which waves are short, radians per metre.
const SHORT_PER_M: f64 = 0.9;
/// The most waves of a place.
pub(crate) const MOST_WAVES: usize = 80;
/// Waves of less slope that are also lower are left out.
const LEAST_SLOPE: f64 = 1e-3;
const LEAST_M: f64 = 0.02;
/// Share of the variance of the strongest wave of a band below which a wave is left out.
const WEAKEST: f64 = 0.25;
/// Where the wave vector leans out of the tangent plane, the wave is longer: its tangential part below which it is left
/// out, and from which it counts in full.
const TANGENT: (f64, f64) = (0.7, 0.95);
/// Angle between swell and wind.
const SWELL_TURN_RAD: f64 = 0.7;
/// How much higher crests are than troughs are deep, by the standard deviation of the height: the second-order term of
/// Stokes waves (Longuet-Higgins 1963) for a fully developed sea.
pub(crate) const SKEW: f64 = 0.14;
/// The least factor of slopes that the skew leaves.
pub(crate) const LEAST_SKEWED: f64 = 0.25;

/// A plane wave: its height is amplitude times cosine of (wave vector times position, plus phase, minus frequency times
/// time).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wave {
    /// Wave vector in the planet frame, radians per metre. Its radial part does nothing at sea level.
    pub(crate) vector_per_m: DVec3,
    pub(crate) amplitude_m: f64,
    pub(crate) phase_rad: f64,
    pub(crate) frequency_rad_s: f64,
}

/// The waves around a place of the sea, longest first.
///
/// They hold for some ten kilometres around; further away, other waves run with another wind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waves {
    waves: Vec<Wave>,
    level_m: f64,
    radius_m: f64,
    deviation_m: f64,
}

/// The surface of the sea at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct WaterSurface {
    /// Height above the reference sphere, metres.
    pub height_m: f64,
    /// Height of the wave above the mean level, metres.
    pub wave_m: f64,
    /// Unit normal of the surface in the planet frame. Waves shorter than 1 m are left out.
    pub normal_planet: DVec3,
}

/// Wavelengths below which waves do not tilt a boat, metres.
const TILTING_M: f64 = 1.0;

impl Waves {
    /// The waves around a unit direction, with the wind of the terrain's weather. Empty where the planet has no sea.
    pub fn near(terrain: &Terrain, dir_planet: DVec3) -> Self {
        Self::of(terrain.planet(), terrain.weather().map(|weather| &**weather), dir_planet)
    }

    /// As [`Waves::near`], from a planet and its solved weather.
    pub(crate) fn of(planet: &Planet, weather: Option<&Weather>, dir_planet: DVec3) -> Self {
        let Some(water) = &planet.water else { return Self::default() };
        let up = dir_planet.normalize_or(DVec3::Z);
        let wind = relative_wind(planet, weather, up);
        let spectrum = Spectrum::new(water, water.wind_m_s * wind.length());
        let blowing = Course { dir: wind.normalize_or_zero(), clear: ramp(0.05, 0.5, wind.length()) };
        let swelling = Course {
            dir: blowing.dir * libm::cos(SWELL_TURN_RAD) + up.cross(blowing.dir) * libm::sin(SWELL_TURN_RAD),
            clear: blowing.clear,
        };
        let mut waves: Vec<Wave> =
            (0..BANDS).flat_map(|band| band_of(band, up, &spectrum, &blowing, &swelling)).collect();
        let slope = |wave: &Wave| wave.amplitude_m * wave.vector_per_m.reject_from(up).length();
        waves.retain(|wave| slope(wave) > LEAST_SLOPE || wave.amplitude_m > LEAST_M);
        waves.sort_by(|a, b| a.vector_per_m.length_squared().total_cmp(&b.vector_per_m.length_squared()));
        // The shortest are the first to become roughness.
        waves.truncate(MOST_WAVES);
        let deviation_m = libm::sqrt(waves.iter().map(|wave| 0.5 * wave.amplitude_m * wave.amplitude_m).sum());
        Self { waves, level_m: water.level_m, radius_m: planet.radius_m(), deviation_m }
    }

    /// Significant wave height: four standard deviations, about the mean height of the highest third, metres.
    pub fn significant_height_m(&self) -> f64 {
        4.0 * self.deviation_m
    }

    /// The surface at a unit direction, `time_secs` after time zero, over a column of water: [`Column::at`] there.
    pub fn surface(&self, dir_planet: DVec3, time_secs: f64, column: &Column) -> WaterSurface {
        let at_m = dir_planet * (self.radius_m + self.level_m);
        let (mut height_m, mut slope, mut variance) = (0.0, DVec3::ZERO, 0.0);
        for wave in &self.waves {
            let shoaled = column.shoal(wave, dir_planet, self.deviation_m);
            let amplitude_m = wave.amplitude_m * shoaled.amplitude;
            let (sin, cos) = libm::sincos(wave.phase_at(at_m, time_secs) + shoaled.turned_rad);
            height_m += amplitude_m * cos;
            variance += 0.5 * amplitude_m * amplitude_m;
            if shoaled.along_per_m.length() < TAU / TILTING_M {
                slope -= shoaled.along_per_m * (amplitude_m * sin);
            }
        }
        let (wave_m, steeper) = skewed(height_m, libm::sqrt(variance));
        let normal_planet = (dir_planet - slope * steeper).normalize_or(dir_planet);
        WaterSurface { height_m: self.level_m + wave_m, wave_m, normal_planet }
    }

    /// The waves.
    #[cfg(feature = "render")]
    pub(crate) fn all(&self) -> &[Wave] {
        &self.waves
    }

    /// Standard deviation of the height, metres.
    #[cfg(feature = "render")]
    pub(crate) fn deviation_m(&self) -> f64 {
        self.deviation_m
    }
}

impl Wave {
    /// Its phase at a position at sea level, 0 to a full turn.
    pub(crate) fn phase_at(&self, at_m: DVec3, time_secs: f64) -> f64 {
        (self.vector_per_m.dot(at_m) + self.phase_rad - self.frequency_rad_s * time_secs).rem_euclid(TAU)
    }
}

/// Crests are sharp and troughs flat: a height, and the factor of its slope, from the sum of waves.
pub(crate) fn skewed(height_m: f64, deviation_m: f64) -> (f64, f64) {
    if deviation_m <= 0.0 {
        return (0.0, 1.0);
    }
    let x = height_m / deviation_m;
    (height_m + SKEW * deviation_m * (x * x - 1.0), (1.0 + 2.0 * SKEW * x).max(LEAST_SKEWED))
}

/// Where waves run to.
struct Course {
    dir: DVec3,
    /// 0: anywhere, 1: with the wind alone.
    clear: f64,
}

impl Course {
    /// How much a unit tangent counts; not normalised. `narrow`: exponent of the cosine.
    fn weight(&self, along: DVec3, narrow: f64) -> f64 {
        let with = libm::pow(along.dot(self.dir).max(0.0), narrow);
        // A few waves run across the wind.
        let anywhere = 0.02;
        anywhere + (1.0 - anywhere) * (with * self.clear + 0.3 * (1.0 - self.clear))
    }
}

/// The waves of a band: its variance, distributed over those of its waves that are tangential and run with the course.
fn band_of(band: u32, up: DVec3, spectrum: &Spectrum, blowing: &Course, swelling: &Course) -> Vec<Wave> {
    let ratio = LENGTHS_M.1 / LENGTHS_M.0;
    let width = -libm::log(ratio) / f64::from(BANDS);
    let k_at = |x: f64| TAU / (LENGTHS_M.0 * libm::pow(ratio, x / f64::from(BANDS)));
    let k_per_m = k_at(f64::from(band) + 0.5);
    let variances = [spectrum.wind(k_per_m) * width, spectrum.swell(k_per_m) * width];
    // Short waves spread further (Hasselmann et al. 1980).
    let narrow = if k_per_m < 0.2 { 6.0 } else { 2.0 };
    let directions = if k_per_m < SHORT_PER_M { DIRECTIONS.0 } else { DIRECTIONS.1 };
    let random = |number: usize, n: u32| unit(hash(band * 64 + number as u32, n));
    let turn = [0, 1, 2].map(|n| TAU * random(63, n));
    let tilt = DQuat::from_euler(EulerRot::XYZ, turn[0], turn[1], turn[2]);
    let candidates = spread(directions).enumerate().filter_map(|(number, dir)| {
        let dir = tilt * dir;
        let along = dir.reject_from(up);
        let flat = along.length();
        let window = ramp(TANGENT.0, TANGENT.1, flat);
        let weights = [blowing.weight(along / flat.max(1e-9), narrow), swelling.weight(along / flat.max(1e-9), 8.0)];
        (window > 0.0).then_some((number, dir, flat, weights.map(|weight| weight * window)))
    });
    let candidates: Vec<_> = candidates.collect();
    let totals = [0, 1].map(|part| candidates.iter().map(|(.., weights)| weights[part]).sum::<f64>().max(1e-9));
    let variance_of =
        |weights: [f64; 2]| (0..2).map(|part| variances[part] * weights[part] / totals[part]).sum::<f64>();
    // Waves much weaker than the strongest of their band leave their variance to it. The rest falls to 0 steadily, so
    // that no wave comes or goes at once.
    let strongest = candidates.iter().map(|(.., weights)| variance_of(*weights)).fold(0.0, f64::max);
    let kept = |weights: [f64; 2]| (variance_of(weights) - WEAKEST * strongest).max(0.0);
    let gain =
        (variances[0] + variances[1]) / candidates.iter().map(|(.., weights)| kept(*weights)).sum::<f64>().max(1e-12);
    let wave = |(number, dir, flat, weights): (usize, DVec3, f64, [f64; 2])| {
        let vector_per_m = dir * k_at(f64::from(band) + random(number, 3));
        let k = vector_per_m.length();
        Wave {
            vector_per_m,
            amplitude_m: libm::sqrt(2.0 * kept(weights) * gain) / (k * flat),
            phase_rad: TAU * random(number, 4),
            // Deep water. A frequency of the whole vector is the same everywhere.
            frequency_rad_s: libm::sqrt(GRAVITY_M_S2 * k),
        }
    };
    candidates.into_iter().map(wave).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Water;
    use crate::sphere::LatLon;
    use std::sync::Arc;

    fn sea(wind_m_s: f64, swell_m: f64) -> Terrain {
        let water = Water { wind_m_s, swell_m, ..Water::default() };
        let planet = Planet { water: Some(water), layers: Vec::new(), ..Planet::default() };
        Terrain::try_new(Arc::new(planet)).unwrap()
    }

    /// From the swell down to ripples: the most waves leave room for all bands.
    #[test]
    fn short_waves_are_there_too() {
        for (wind_m_s, swell_m) in [(3.0, 0.0), (6.0, 0.5), (10.0, 2.0), (20.0, 6.0)] {
            for dir in spread(30) {
                let waves = Waves::near(&sea(wind_m_s, swell_m), dir);
                let shortest = waves.waves.last().unwrap();
                let length_m = TAU / shortest.vector_per_m.length();
                assert!(length_m < 0.8, "{wind_m_s} m/s: {} waves down to {length_m} m", waves.waves.len());
                assert!(waves.waves.len() > 20);
            }
        }
    }

    #[test]
    fn waves_are_as_high_as_the_spectrum_and_run_with_the_wind() {
        let terrain = sea(10.0, 0.0);
        for dir in spread(40) {
            let waves = Waves::near(&terrain, dir);
            assert!((1.7..3.0).contains(&waves.significant_height_m()), "{} m", waves.significant_height_m());
            assert!(waves.waves.len() <= MOST_WAVES);
            // The mean over places and times is that height, too; the skew adds little.
            let (mut sum, mut square) = (0.0, 0.0);
            for i in 0..400 {
                let at = (dir + DVec3::new(0.3, -0.7, 0.5) * 1e-4 * f64::from(i)).normalize();
                let wave_m = waves.surface(at, f64::from(i) * 3.7, &Column::DEEP).wave_m;
                (sum, square) = (sum + wave_m / 400.0, square + wave_m * wave_m / 400.0);
            }
            let ratio = 4.0 * square.sqrt() / waves.significant_height_m();
            assert!((0.7..1.4).contains(&ratio) && sum.abs() < 0.25, "{ratio}, mean {sum} m");
            let wind = relative_wind(terrain.planet(), None, dir);
            let run: DVec3 = waves.waves.iter().map(|wave| wave.vector_per_m.normalize() * wave.amplitude_m).sum();
            let run = run.reject_from(dir).normalize();
            assert!(run.dot(wind.normalize()) > 0.6, "{} at {dir}", run.dot(wind.normalize()));
        }
    }

    #[test]
    fn neighbours_have_the_same_waves_and_time_moves_them() {
        let terrain = sea(8.0, 1.0);
        let dir = LatLon::from_degrees(12.0, 34.0).direction();
        let near = (dir + DVec3::Z * 1e-4).normalize();
        let (here, there) = (Waves::near(&terrain, dir), Waves::near(&terrain, near));
        for time_secs in [0.0, 1e6, 1e9] {
            let [a, b] = [&here, &there].map(|waves| waves.surface(dir, time_secs, &Column::DEEP));
            assert!((a.wave_m - b.wave_m).abs() < 0.02, "{a:?} {b:?}");
            assert!((a.normal_planet.length() - 1.0).abs() < 1e-9 && a.normal_planet.dot(dir) > 0.8);
            let later = here.surface(dir, time_secs + 0.02, &Column::DEEP);
            assert!((later.wave_m - a.wave_m).abs() < 0.05);
        }
        // In the shallows waves are low; without a sea there are none.
        assert!(here.surface(dir, 5.0, &Column { depth_m: 0.0, ..Column::DEEP }).wave_m.abs() < 1e-6);
        let dry = Terrain::try_new(Arc::new(Planet { layers: Vec::new(), ..Planet::default() })).unwrap();
        assert_eq!(Waves::near(&dry, dir).surface(dir, 3.0, &Column::DEEP).wave_m, 0.0);
    }

    #[test]
    fn the_normal_is_that_of_the_heights() {
        let terrain = sea(12.0, 2.0);
        let dir = LatLon::from_degrees(-40.0, 100.0).direction();
        let mut waves = Waves::near(&terrain, dir);
        waves.waves.retain(|wave| wave.vector_per_m.length() < 0.5);
        let (east, north) = crate::sphere::geo::east_north(dir);
        let step = 0.1 / terrain.planet().radius_m();
        for time_secs in [0.0, 3.0, 11.0] {
            let at = |v: DVec3| waves.surface((dir + v).normalize(), time_secs, &Column::DEEP).height_m;
            let rise = |v: DVec3| (at(v * step) - at(-v * step)) / 0.2;
            let normal = (dir - east * rise(east) - north * rise(north)).normalize();
            let found = waves.surface(dir, time_secs, &Column::DEEP).normal_planet;
            assert!(found.angle_between(normal) < 2e-3, "{found} for {normal}");
        }
    }
}
