//! Ambient occlusion: how much of the sky the ground around a point leaves open.
//!
//! In each of [`AZIMUTHS`] directions the horizon is the steepest line from the point to the ground at [`DISTANCES`],
//! or the ground of the point itself, whose slope is that of the nearest ring. The part of the hemisphere over this
//! ground that lies above the horizon counts by the cosine to the ground's normal, as diffuse light does; each slice
//! has a closed form (as in Jimenez, Wu, Pesce and Jarabo 2016, "Practical realtime strategies for accurate indirect
//! occlusion", with slices about the vertical). The surface of the sea counts as ground.
//!
//! All heights are the evaluator's, so that the answer depends on the point and the pixels' size alone.

use crate::sphere::geo::east_north;
use crate::terrain::{Scratch, Terrain};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Directions in which the horizon is found.
const AZIMUTHS: usize = 12;
/// Distances at which the ground is looked up, in pixels.
pub(super) const DISTANCES: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Valleys of a structure that points this share of a distance apart would not show are left out there.
const SEEN: f64 = 0.25;
/// Farthest that ground is looked up, as an angle: on pixels of a small globe the last distances would lie behind it.
const FARTHEST_RAD: f64 = 0.5;

/// The open share of the sky over each unit direction, 0 to 1. `pixel_rad`: the angle between pixels. `spacing_rad`:
/// valleys that points so far apart would not show are left out.
pub(super) fn open_shares(
    terrain: &Terrain,
    (dirs, heights_m): (&[DVec3], impl Iterator<Item = f64>),
    (pixel_rad, spacing_rad): (f64, f64),
    scratch: &mut Scratch,
) -> Vec<f64> {
    let planet = terrain.planet();
    let (radius_m, sea_m) = (planet.radius_m(), planet.sea_level_m().unwrap_or(f64::MIN));
    let coarsest_rad = terrain.river_spacing_rad().unwrap_or_default();
    let own_m: Vec<f64> = heights_m.map(|height_m| radius_m + height_m.max(sea_m)).collect();
    let axes: Vec<_> = dirs.iter().map(|&dir| east_north(dir)).collect();
    // Rise over run of the horizon, and of the nearest ring.
    let mut horizons = vec![[f64::NEG_INFINITY; AZIMUTHS]; dirs.len()];
    let mut nearest = vec![[0.0; AZIMUTHS]; dirs.len()];
    let mut around = Vec::with_capacity(dirs.len());
    let mut around_m = vec![0.0; dirs.len()];
    for (ring, distance) in DISTANCES.into_iter().enumerate() {
        let away_rad = (distance * pixel_rad).min(FARTHEST_RAD);
        let (sin, cos) = libm::sincos(away_rad);
        let seen_rad = spacing_rad.max((SEEN * away_rad).min(coarsest_rad));
        for azimuth in 0..AZIMUTHS {
            let along = heading(azimuth);
            around.clear();
            around.extend(
                dirs.iter()
                    .zip(&axes)
                    .map(|(&dir, &(east, north))| (dir * cos + (east * along.x + north * along.y) * sin).normalize()),
            );
            terrain.heights_spaced_into(&around, seen_rad, &mut around_m, scratch);
            for (i, height_m) in around_m.iter().enumerate() {
                let there_m = radius_m + height_m.max(sea_m);
                let rise = (there_m * cos - own_m[i]) / (there_m * sin);
                horizons[i][azimuth] = horizons[i][azimuth].max(rise);
                if ring == 0 {
                    nearest[i][azimuth] = rise;
                }
            }
        }
    }
    horizons.iter().zip(&nearest).map(|(horizon, nearest)| open_share(horizon, slope_of(nearest))).collect()
}

/// The slope (rise over run along east and north) of the plane that fits the rises of a ring best.
fn slope_of(rises: &[f64; AZIMUTHS]) -> DVec2 {
    let sum: DVec2 = rises.iter().enumerate().map(|(azimuth, rise)| heading(azimuth) * *rise).sum();
    sum * (2.0 / AZIMUTHS as f64)
}

/// The open share over ground of a slope, below horizons of these rises over run.
fn open_share(horizon: &[f64; AZIMUTHS], slope: DVec2) -> f64 {
    let up = 1.0 / libm::sqrt(1.0 + slope.length_squared());
    let slice = |(azimuth, rise): (usize, &f64)| {
        let uphill = slope.dot(heading(azimuth));
        let rise = rise.max(uphill);
        let cos2 = 1.0 / (1.0 + rise * rise);
        // The integral of (normal . direction) cos(elevation) from the horizon to the zenith.
        -uphill * up * 0.5 * (FRAC_PI_2 - libm::atan(rise) - rise * cos2) + up * 0.5 * cos2
    };
    let sum: f64 = horizon.iter().enumerate().map(slice).sum();
    (sum * 2.0 / AZIMUTHS as f64).clamp(0.0, 1.0)
}

/// Unit vector along east and north.
fn heading(azimuth: usize) -> DVec2 {
    let (sin, cos) = libm::sincos(azimuth as f64 * (TAU / AZIMUTHS as f64));
    DVec2::new(cos, sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;

    #[test]
    fn level_ground_and_even_slopes_are_open_and_a_bowl_is_as_deep_as_its_rim() {
        assert_eq!(open_share(&[-0.01; AZIMUTHS], DVec2::ZERO), 1.0);
        for slope in [0.1, 0.5, 1.5] {
            let open = open_share(&[f64::NEG_INFINITY; AZIMUTHS], DVec2::new(0.0, slope));
            assert!((open - 1.0).abs() < 0.02, "{slope}: {open}");
        }
        // The horizon at an elevation all around leaves the square of its cosine.
        for elevation in [0.2_f64, 0.7, 1.2] {
            let open = open_share(&[elevation.tan(); AZIMUTHS], DVec2::ZERO);
            assert!((open - elevation.cos().powi(2)).abs() < 1e-12);
        }
        // A wall on one side hides half of what is below its top.
        let wall = std::array::from_fn(|azimuth| if heading(azimuth).x > 0.1 { 1e9 } else { 0.0 });
        assert!((open_share(&wall, DVec2::ZERO) - 7.0 / 12.0).abs() < 1e-6);
    }

    #[test]
    fn the_closed_form_is_the_integral_over_the_hemisphere() {
        let (slope, steps) = (DVec2::new(0.3, -0.4), 400);
        let horizon: [f64; AZIMUTHS] = std::array::from_fn(|azimuth| 0.6 + 0.05 * (azimuth % 5) as f64);
        let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
        let mut sum = 0.0;
        for (azimuth, rise) in horizon.iter().enumerate() {
            let (from, along) = (rise.atan(), heading(azimuth));
            let step = (FRAC_PI_2 - from) / f64::from(steps);
            for i in 0..steps {
                let (sin, cos) = (from + (f64::from(i) + 0.5) * step).sin_cos();
                sum += normal.dot(DVec3::new(cos * along.x, cos * along.y, sin)) * cos * step;
            }
        }
        let wanted = sum * TAU / AZIMUTHS as f64 / std::f64::consts::PI;
        assert!((open_share(&horizon, slope) - wanted).abs() < 1e-5);
    }

    #[test]
    fn pits_are_darker_than_peaks_and_a_sea_is_open() {
        let text = r#"(version: 3, name: "Islet", radius_km: 40.0,
            layers: [(name: "Hills", amplitude_m: 900.0, shape: Fbm(wavelength_km: 6.0, octaves: 4))],
            water: (level_m: -700.0))"#;
        let terrain = Terrain::try_new(Planet::from_text("islet.ron", text).unwrap().into()).unwrap();
        let dirs: Vec<DVec3> = crate::sphere::geo::spread(3000).collect();
        let heights_m = terrain.heights_m(&dirs);
        let open = open_shares(&terrain, (&dirs, heights_m.iter().copied()), (0.005, 0.0), &mut Scratch::default());
        let mean = |is_in: &dyn Fn(f64) -> bool| {
            let found: Vec<f64> =
                open.iter().zip(&heights_m).filter(|(_, h)| is_in(**h)).map(|(open, _)| *open).collect();
            assert!(found.len() > 30);
            found.iter().sum::<f64>() / found.len() as f64
        };
        let (low, high) = (mean(&|height_m| (-500.0..-250.0).contains(&height_m)), mean(&|height_m| height_m > 300.0));
        assert!(low < high - 0.02, "{low} {high}");
        assert!(open.iter().all(|open| (0.2..=1.0).contains(open)));
        let level = Terrain::try_new(Planet { layers: Vec::new(), ..Planet::clone(terrain.planet()) }.into()).unwrap();
        let open = open_shares(&level, (&dirs[..9], [0.0; 9].into_iter()), (0.005, 0.0), &mut Scratch::default());
        assert!(open.iter().all(|open| *open == 1.0), "{open:?}");
    }
}
