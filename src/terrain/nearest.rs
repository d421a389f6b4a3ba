//! The nearest place with a property: the nearest coast, lake, biome or level ground.

use super::Terrain;
use super::query::{Detail, Sample, Wanted};
use crate::sphere::Tangent;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Most points of a search. They take seconds to minutes.
const MOST_POINTS: f64 = 16e6;
/// Points that are evaluated at once, so that all cores have work near the centre, too.
const AT_ONCE: usize = 4096;
/// The border of what was found is searched to this share of the spacing.
const HALVINGS: u32 = 10;

/// A search around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Direction of the place; it may have any length.
    pub around_planet: DVec3,
    /// Greatest distance along the reference sphere.
    pub within_m: f64,
    /// Distance between the points that are looked at. What is narrower may be overlooked.
    pub spacing_m: f64,
    /// What the property is decided by, besides the height.
    pub wanted: Wanted,
}

/// A place with the property.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Place {
    /// Unit direction.
    pub dir_planet: DVec3,
    /// Distance from the start along the reference sphere.
    pub away_m: f64,
    /// What is there: what the search wanted.
    pub sample: Sample,
}

impl Terrain {
    /// The nearest place for which `holds` says yes. None if there is none within the distance, or if `go_on` said no.
    ///
    /// Points lie on circles, `spacing_m` apart. The first circle with such a place ends the search; from each place
    /// on it the border towards the start is found to a thousandth of the spacing. So the answer is the nearest but
    /// for places narrower than the spacing. It takes pi (within / spacing)² samples at most, on all cores.
    ///
    /// `go_on` is asked on each circle with the share of the distance that is searched (0 to 1).
    ///
    /// # Errors
    /// A place without a direction, a distance or a spacing that is not a number above 0, or more than 16 million
    /// points.
    pub fn nearest(
        &self,
        search: &Search,
        holds: &(dyn Fn(&Sample) -> bool + Sync),
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<Option<Place>, String> {
        let Search { around_planet, within_m, spacing_m, wanted } = *search;
        if !around_planet.is_finite() || around_planet == DVec3::ZERO {
            return Err(format!(
                "around_planet is {around_planet:?}, which is no direction; use a vector of any length"
            ));
        }
        let radius_m = self.planet().radius_m();
        // Nothing is farther than the other side.
        let within_m = within_m.min(PI * radius_m);
        if !(within_m > 0.0 && spacing_m > 0.0) {
            return Err(format!("{within_m} m in steps of {spacing_m} m is no search; use numbers above 0"));
        }
        let points = 0.5 * TAU * (within_m / spacing_m).powi(2);
        if points > MOST_POINTS {
            let least_m = within_m * (0.5 * TAU / MOST_POINTS).sqrt();
            return Err(format!(
                "these are {:.0} million points; use steps of {least_m:.0} m or more, or a smaller distance",
                points * 1e-6
            ));
        }
        let tangent = Tangent::new(super::points::unit(around_planet));
        let circles = (within_m / spacing_m).ceil() as u32;
        let mut next = 0;
        while next <= circles {
            if !go_on(f64::from(next) / f64::from(circles)) {
                return Ok(None);
            }
            // The circle of each point, and the points.
            let (mut circle_of, mut dirs) = (Vec::new(), Vec::new());
            while next <= circles && dirs.len() < AT_ONCE {
                let away_rad = (f64::from(next) * spacing_m).min(within_m) / radius_m;
                let count = (TAU * libm::sin(away_rad).abs() * radius_m / spacing_m).ceil().max(1.0) as u32;
                for i in 0..count {
                    // Points of neighbouring circles do not line up.
                    let turn = TAU * (f64::from(i) + 0.5 * f64::from(next % 2)) / f64::from(count);
                    let (sin, cos) = libm::sincos(turn);
                    dirs.push(tangent.direction(away_rad * sin, away_rad * cos));
                    circle_of.push(next);
                }
                next += 1;
            }
            // Rivers and valleys narrower than the spacing are left out first: where they count, all detail is asked.
            let samples = self.samples_detailed(&dirs, wanted, Detail::SpacingM(spacing_m));
            let found: Vec<usize> = (0..dirs.len()).filter(|i| holds(&samples[*i])).collect();
            for circle in found.chunk_by(|a, b| circle_of[*a] == circle_of[*b]) {
                let dirs: Vec<DVec3> = circle.iter().map(|i| dirs[*i]).collect();
                let samples = self.samples(&dirs, wanted);
                let holding = dirs.into_iter().zip(samples).filter(|(_, sample)| holds(sample));
                let place = |found| self.border(tangent.up_planet, found, spacing_m, wanted, holds);
                let nearest = holding.map(place).min_by(|a, b| a.away_m.total_cmp(&b.away_m));
                if nearest.is_some() {
                    return Ok(nearest);
                }
            }
        }
        Ok(None)
    }

    /// The place nearest to the start on the way to a place that holds, not more than a spacing nearer.
    fn border(
        &self,
        start: DVec3,
        (dir, sample): (DVec3, Sample),
        spacing_m: f64,
        wanted: Wanted,
        holds: &(dyn Fn(&Sample) -> bool + Sync),
    ) -> Place {
        let radius_m = self.planet().radius_m();
        let away_rad = start.angle_between(dir);
        let mut place = Place { dir_planet: dir, away_m: away_rad * radius_m, sample };
        if away_rad == 0.0 {
            return place;
        }
        let across = (dir - start * dir.dot(start)).normalize_or_zero();
        let mut out_rad = (away_rad - spacing_m / radius_m).max(0.0);
        let mut in_rad = away_rad;
        for _ in 0..HALVINGS {
            let middle_rad = 0.5 * (out_rad + in_rad);
            let (sin, cos) = libm::sincos(middle_rad);
            let dir_planet = (start * cos + across * sin).normalize();
            let sample = self.samples(&[dir_planet], wanted)[0];
            if holds(&sample) {
                place = Place { dir_planet, away_m: middle_rad * radius_m, sample };
                in_rad = middle_rad;
            } else {
                out_rad = middle_rad;
            }
        }
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use crate::sphere::geo::spread;
    use std::sync::atomic::{AtomicU32, Ordering};

    fn terrain() -> Terrain {
        let text = r#"(version: 3, name: "Islet", radius_km: 40.0,
            layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 30.0, octaves: 3))],
            water: (level_m: 0.0))"#;
        Terrain::try_new(Planet::from_text("islet.ron", text).unwrap().into()).unwrap()
    }

    fn search(dir: DVec3) -> Search {
        Search { around_planet: dir * 3.0, within_m: 200e3, spacing_m: 200.0, wanted: Wanted::HEIGHT }
    }

    fn is_land(sample: &Sample) -> bool {
        sample.height_m > 0.0
    }

    #[test]
    fn nothing_is_nearer_than_what_is_found() {
        let terrain = terrain();
        let all: Vec<DVec3> = spread(100_000).collect();
        let heights_m = terrain.heights_m(&all);
        let mut at_sea = 0;
        for dir in spread(12) {
            let place = terrain.nearest(&search(dir), &is_land, &|_| true).unwrap().unwrap();
            assert!(terrain.height_m(place.dir_planet) > 0.0);
            assert_eq!(place.sample.height_m, terrain.height_m(place.dir_planet));
            assert!((place.away_m - dir.angle_between(place.dir_planet) * 40_000.0).abs() < 1e-3);
            let land = all.iter().zip(&heights_m).filter(|(_, height_m)| **height_m > 0.0);
            let nearest_m = land.map(|(other, _)| dir.angle_between(*other) * 40_000.0).fold(f64::INFINITY, f64::min);
            // An island as narrow as the spacing may be overlooked; this planet has none.
            assert!(place.away_m < nearest_m + 60.0, "{} {nearest_m}", place.away_m);
            if place.away_m > 0.0 {
                at_sea += 1;
                // The shore is the border of what holds.
                assert!(place.sample.height_m < 5.0, "{}", place.sample.height_m);
            }
        }
        assert!((2..11).contains(&at_sea), "{at_sea}");
    }

    #[test]
    fn a_search_ends_at_its_distance_and_when_it_is_told_to() {
        let terrain = terrain();
        let far = |sample: &Sample| sample.height_m > 1e6;
        assert_eq!(terrain.nearest(&search(DVec3::X), &far, &|_| true).unwrap(), None);
        let asked = AtomicU32::new(0);
        let stop = |_| asked.fetch_add(1, Ordering::Relaxed) < 2;
        assert_eq!(terrain.nearest(&search(DVec3::X), &far, &stop).unwrap(), None);
        assert_eq!(asked.into_inner(), 3);
        for (within_m, spacing_m) in [(0.0, 1.0), (1.0, 0.0), (f64::NAN, 1.0), (1.0, f64::NAN), (1e5, 1.0)] {
            let search = Search { within_m, spacing_m, ..search(DVec3::X) };
            assert!(terrain.nearest(&search, &far, &|_| true).is_err(), "{search:?}");
        }
        for around_planet in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            let search = Search { around_planet, ..search(DVec3::X) };
            assert!(terrain.nearest(&search, &far, &|_| true).is_err(), "{search:?}");
        }
    }
}
