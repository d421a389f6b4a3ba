//! The clouds of a gas giant: bands over latitude, the jets that drive them, and storms, at a time.
//!
//! The picture is a function of place and time (`shaders/giant.wgsl`): a point is traced back along jets and eddies to
//! where its colour comes from. Jets would shear the eddies without end, so two tracings that begin at different times
//! fade into each other, each with eddies of its own: nothing repeats and nothing jumps.

use crate::planet::{Giant, Planet};
use crate::rings::smooth;
use crate::world::noise::mix;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Latitudes at which bands are known: even steps from the south pole to the north pole.
pub const BAND_ENTRIES: usize = 96;
/// Most storms, the great spot among them.
pub const MAX_STORMS: usize = 8;
/// Depth below the tops of the clouds to which an eye may sink: it is dark there.
pub const DEEPEST_M: f64 = 300_000.0;
/// Longest wave of the tops' detail, in sizes of an eddy.
pub const DETAIL_EDDIES: f64 = 0.12;
/// Each wave of the detail over the next.
pub const DETAIL_RATIO: f64 = 2.2;
/// Seconds after which the detail of the tops has changed: heaps of cloud last for hours.
const DETAIL_SECS: f64 = 14_000.0;
/// Shortest wave of the detail.
const LEAST_DETAIL_M: f64 = 700.0;
/// Angle in radians by which the fastest jet shears the eddies before they fade.
const SHEAR_RAD: f64 = 0.9;

/// The bands of a giant.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// Red, green and blue, and the jet's angular speed in radians per second eastward.
    pub entries: Vec<[f64; 4]>,
    /// Seconds after which the eddies of a tracing have faded.
    pub cycle_secs: f64,
}

/// A storm: an oval that turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Storm {
    /// Its middle, a unit vector in the planet frame.
    pub center: DVec3,
    /// Half of its width along the latitude, in radii.
    pub size: f64,
    /// Turns of its middle, radians: positive is counter-clockwise seen from above.
    pub spin: f64,
    /// Its colour, linear RGB.
    pub color: [f64; 3],
}

impl Bands {
    /// The bands of a planet; None if it is no giant.
    pub fn new(planet: &Planet) -> Option<Self> {
        let giant = planet.giant.as_ref()?;
        let seed = seed(planet, giant);
        let edges = edges(giant, seed);
        let speed = giant.jet_m_s / planet.radius_m();
        let entry = |index: usize| {
            let lat = -FRAC_PI_2 + PI * index as f64 / (BAND_ENTRIES - 1) as f64;
            let [r, g, b] = color(giant, &edges, seed, lat);
            [r, g, b, speed * jet(&edges, lat)]
        };
        let entries: Vec<[f64; 4]> = (0..BAND_ENTRIES).map(entry).collect();
        let fastest = entries.iter().map(|entry| entry[3].abs()).fold(1e-9, f64::max);
        Some(Self { entries, cycle_secs: SHEAR_RAD / fastest })
    }

    /// Angular speed of the jets at a latitude, radians per second eastward.
    pub fn speed(&self, lat_rad: f64) -> f64 {
        let place = (lat_rad / PI + 0.5).clamp(0.0, 1.0) * (BAND_ENTRIES - 1) as f64;
        let first = (place as usize).min(BAND_ENTRIES - 2);
        let share = place - first as f64;
        self.entries[first][3] * (1.0 - share) + self.entries[first + 1][3] * share
    }

    /// The two tracings at a time: seconds since the middle of each, its weight, and the number of its eddies.
    pub fn tracings(&self, time_secs: f64) -> [(f64, f64, u32); 2] {
        tracings(time_secs, self.cycle_secs)
    }

    /// The same of the detail of the tops.
    pub fn detail_tracings(&self, time_secs: f64) -> [(f64, f64, u32); 2] {
        tracings(time_secs, self.cycle_secs.min(DETAIL_SECS))
    }

    /// Colour at a latitude.
    pub fn color(&self, lat_rad: f64) -> [f64; 3] {
        let place = (lat_rad / PI + 0.5).clamp(0.0, 1.0) * (BAND_ENTRIES - 1) as f64;
        let first = (place as usize).min(BAND_ENTRIES - 2);
        let share = place - first as f64;
        std::array::from_fn(|i| self.entries[first][i] * (1.0 - share) + self.entries[first + 1][i] * share)
    }

    /// The storms at a time. They drift with the jets at their latitude, at half the speed.
    pub fn storms(&self, planet: &Planet, time_secs: f64) -> Vec<Storm> {
        let Some(giant) = &planet.giant else { return Vec::new() };
        let seed = seed(planet, giant);
        let place = |lat: f64, lon: f64| {
            // Whole turns are taken off before the sine: after years they are many.
            let period_secs = TAU / (0.5 * self.speed(lat)).abs().max(1e-12);
            let lon = lon + 0.5 * self.speed(lat) * (time_secs % period_secs);
            DVec3::new(libm::cos(lat) * libm::cos(lon), libm::cos(lat) * libm::sin(lon), libm::sin(lat))
        };
        let spin = |lat: f64| if lat > 0.0 { -1.0 } else { 1.0 };
        let mut storms = Vec::new();
        if giant.spot_radii > 0.0 {
            let lat = giant.spot_lat_deg.to_radians();
            let center = place(lat, TAU * random(0, 40, seed));
            storms.push(Storm { center, size: giant.spot_radii, spin: 2.6 * spin(lat), color: giant.spot_color });
        }
        for number in 0..giant.storms.min(MAX_STORMS as u32 - 1) {
            let side = if random(number, 41, seed) < 0.5 { -1.0 } else { 1.0 };
            let lat = side * (12.0 + 48.0 * random(number, 42, seed)).to_radians();
            let center = place(lat, TAU * random(number, 43, seed));
            let size = 0.025 + 0.05 * random(number, 44, seed).powi(2);
            let white = giant.zone_color.map(|c| c + 0.45 * (1.0 - c));
            let color = if random(number, 45, seed) < 0.7 { white } else { giant.spot_color };
            storms.push(Storm { center, size, spin: 2.2 * spin(lat), color });
        }
        storms
    }
}

/// Octaves of the tops' detail that a pixel of this width on the tops resolves.
pub fn detail_octaves(planet: &Planet, pixel_m: f64) -> u32 {
    let Some(giant) = &planet.giant else { return 0 };
    let longest_m = DETAIL_EDDIES * giant.eddy_radii * planet.radius_m();
    let octaves = libm::log(longest_m / (1.5 * pixel_m).max(LEAST_DETAIL_M)) / DETAIL_RATIO.ln();
    octaves.ceil().clamp(0.0, 12.0) as u32
}

/// Two tracings at a time: seconds since the middle of each, its weight, and its number.
fn tracings(time_secs: f64, cycle_secs: f64) -> [(f64, f64, u32); 2] {
    [0.0, 0.5].map(|shift| {
        let cycles = time_secs / cycle_secs + shift;
        let share = cycles - cycles.floor();
        let number = (cycles.floor() as i64).rem_euclid(1 << 20) as u32 * 2 + u32::from(shift > 0.0);
        ((share - 0.5) * cycle_secs, 1.0 - (2.0 * share - 1.0).abs(), number)
    })
}

fn seed(planet: &Planet, giant: &Giant) -> u32 {
    planet.seed.wrapping_mul(0x85EB_CA6B) ^ giant.seed
}

/// Number of the eddies of a giant for the shaders.
pub fn eddy_seed(planet: &Planet) -> u32 {
    planet.giant.as_ref().map_or(0, |giant| seed(planet, giant))
}

/// Edges of the bands as latitudes, from pole to pole.
fn edges(giant: &Giant, seed: u32) -> Vec<f64> {
    let widths: Vec<f64> =
        (0..giant.bands).map(|band| 1.0 + giant.variation * 1.6 * (random(band, 1, seed) - 0.5)).collect();
    let whole: f64 = widths.iter().sum();
    let mut at = -FRAC_PI_2;
    let mut edges = vec![at];
    for width in widths {
        at += width / whole * PI;
        edges.push(at);
    }
    edges
}

/// Share of the fastest jet at a latitude: one jet on each edge of a band, eastward and westward in turn, and one on
/// the equator.
fn jet(edges: &[f64], lat: f64) -> f64 {
    let width = PI / (edges.len() - 1) as f64;
    let mut speed = libm::exp(-(lat / 0.16).powi(2));
    for (number, edge) in edges.iter().enumerate().skip(1).take(edges.len().saturating_sub(2)) {
        let away = (lat - edge) / (0.33 * width);
        let strength = 0.42 * libm::cos(*edge).max(0.0);
        speed += if number % 2 == 0 { strength } else { -strength } * libm::exp(-away * away);
    }
    speed * libm::cos(lat)
}

/// Colour of a latitude.
fn color(giant: &Giant, edges: &[f64], seed: u32, lat: f64) -> [f64; 3] {
    let band = |number: usize| -> [f64; 3] {
        let number = number.min(edges.len() - 2) as u32;
        let mean: [f64; 3] = std::array::from_fn(|i| 0.5 * (giant.zone_color[i] + giant.belt_color[i]));
        let of = if number.is_multiple_of(2) { giant.zone_color } else { giant.belt_color };
        let accent = giant.variation * 0.9 * random(number, 2, seed).powi(2);
        let bright = 1.0 + giant.variation * 0.3 * (random(number, 3, seed) - 0.5);
        std::array::from_fn(|i| {
            let c = mean[i] + giant.contrast * (of[i] - mean[i]);
            (c + accent * (giant.accent_color[i] - c)) * bright
        })
    };
    let number = edges.iter().skip(1).take_while(|edge| **edge < lat).count().min(edges.len() - 2);
    let (low, high) = (edges[number], edges[number + 1]);
    let share = ((lat - low) / (high - low)).clamp(0.0, 1.0);
    let own = band(number);
    // Edges are soft over a fifth of a band on each side.
    let to_low = 0.5 * (1.0 - smooth(share / 0.22));
    let to_high = 0.5 * (1.0 - smooth((1.0 - share) / 0.22));
    let (below, above) = (band(number.saturating_sub(1)), band(number + 1));
    let polar = smooth((lat.abs() - 0.95) / 0.4);
    std::array::from_fn(|i| {
        let c = own[i] * (1.0 - to_low - to_high) + below[i] * to_low + above[i] * to_high;
        (c + 0.85 * polar * (giant.pole_color[i] - c)).clamp(0.0, 1.0)
    })
}

/// A random number from 0 to 1.
fn random(number: u32, salt: u32, seed: u32) -> f64 {
    let bits = mix(u64::from(seed) << 32 | u64::from(salt) << 16 | u64::from(number));
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::STARTING_GIANTS;

    #[test]
    fn bands_are_colours_and_jets_keep_to_the_asked_speed() {
        for starting in STARTING_GIANTS {
            let giant = starting.make();
            let jet_m_s = giant.jet_m_s;
            let planet = Planet { giant: Some(giant), radius_km: 60_000.0, ..Planet::default() };
            let bands = Bands::new(&planet).unwrap();
            let fastest = bands.entries.iter().map(|entry| entry[3].abs() * planet.radius_m()).fold(0.0, f64::max);
            assert!((0.6..1.6).contains(&(fastest / jet_m_s)), "{}: {fastest} m/s", starting.name);
            assert!(bands.entries.iter().all(|entry| entry[..3].iter().all(|c| (0.0..=1.0).contains(c))));
        }
    }

    #[test]
    fn tracings_share_all_weight_and_change_their_eddies_unseen() {
        let planet = Planet { giant: Some(Giant::default()), ..Planet::default() };
        let bands = Bands::new(&planet).unwrap();
        for step in 0..400 {
            let time_secs = (f64::from(step) / 37.0 - 4.0) * bands.cycle_secs;
            let [a, b] = bands.tracings(time_secs);
            assert!((a.1 + b.1 - 1.0).abs() < 1e-9 && a.2 != b.2);
            let after = bands.tracings(time_secs + 1e-4 * bands.cycle_secs);
            for (now, then) in [a, b].iter().zip(&after) {
                assert!(now.2 == then.2 || now.1 < 1e-3, "eddies change while they are seen");
            }
        }
    }

    #[test]
    fn storms_drift_and_stay_on_their_latitude() {
        let planet = Planet { giant: Some(Giant::default()), ..Planet::default() };
        let bands = Bands::new(&planet).unwrap();
        let (now, later) = (bands.storms(&planet, 0.0), bands.storms(&planet, 3e5));
        assert_eq!(now.len(), 6);
        for (now, later) in now.iter().zip(&later) {
            assert!((now.center.length() - 1.0).abs() < 1e-12 && (now.center.z - later.center.z).abs() < 1e-12);
        }
        assert!(now.iter().zip(&later).any(|(now, later)| now.center.distance(later.center) > 0.1));
    }
}
