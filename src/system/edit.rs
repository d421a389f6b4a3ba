//! Changes of a system that keep it valid: bodies that are added, removed and renamed, and orbits where there is room.

use super::limits::{self, STABLE_SHARE};
use super::{ASTRONOMICAL_UNIT_M, Ephemeris, GRAVITATION, Member, Orbit, System};

/// Factor between the orbits of a new body and of the neighbour next to it.
const SPACING: f64 = 1.6;
/// Least distance from a pair of stars, in their own distance (Holman and Wiegert, Long-term stability of planets in
/// binary systems, 1999).
const PAIR_SPACING: f64 = 4.0;
/// Widest orbit about a star as bright as the Sun, and about a body whose reach is not known, in its radii.
const WIDEST_AU: f64 = 60.0;
const WIDEST_RADII: f64 = 100.0;
/// Margins of the Roche limit and of the stable part of the Hill sphere.
const ROCHE_MARGIN: f64 = 1.3;
const HILL_MARGIN: f64 = 0.8;

/// A body that may get an orbit: its mass, and its radius in metres, 0 where it is unknown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) mass_earths: f64,
    pub(super) radius_m: f64,
}

impl System {
    /// Adds a body on an orbit about `parent` where there is room, under a name of its own. Gives its number.
    /// `radii_m`: radius of each body, 0 where it is unknown; `radius_m`: that of the new one.
    pub fn add(&mut self, parent: usize, member: Member, radii_m: &[f64], radius_m: f64) -> usize {
        let size = Size { mass_earths: member.mass_earths, radius_m };
        let semi_major_m = self.room(parent, size, radii_m);
        let name = self.free_name(&member.name);
        let mut orbit = Orbit { semi_major_km: readable(semi_major_m / 1000.0), ..Orbit::default() };
        // Away from the others, which stand at their own anomalies.
        orbit.anomaly_deg = (self.bodies.len() as f64 * 137.5).rem_euclid(360.0).round();
        orbit.period_hours = self.forced_period_hours(parent, orbit.semi_major_km * 1000.0);
        let parent = self.bodies[parent].name.clone();
        self.bodies.push(Member { name, parent, orbit: Some(orbit), start: None, ..member });
        self.bodies.len() - 1
    }

    /// Removes a body and all that orbits it. Gives the number that each body had before.
    pub fn remove(&mut self, body: usize) -> Vec<usize> {
        let parents = self.parents();
        let mut gone = vec![false; self.bodies.len()];
        for number in 0..self.bodies.len() {
            // A parent comes before its children.
            gone[number] = number == body || parents[number].is_some_and(|parent| gone[parent]);
        }
        let kept: Vec<usize> = (0..gone.len()).filter(|number| !gone[*number]).collect();
        let mut at = 0;
        self.bodies.retain(|_| {
            at += 1;
            !gone[at - 1]
        });
        kept
    }

    /// Renames a body; its children follow. Gives the name, which differs from `wanted` if another body has that.
    pub fn rename(&mut self, body: usize, wanted: &str) -> String {
        let old = std::mem::take(&mut self.bodies[body].name);
        let name = self.free_name(wanted);
        for child in self.bodies.iter_mut().filter(|child| child.parent == old) {
            child.parent.clone_from(&name);
        }
        self.bodies[body].name.clone_from(&name);
        name
    }

    /// A name that no body has: the wanted one, or the same with a number.
    pub fn free_name(&self, wanted: &str) -> String {
        let wanted = match wanted.trim() {
            "" => "Unnamed",
            name => name,
        };
        // Room for the number within the longest name.
        let wanted: String = wanted.chars().take(58).collect();
        let numbered = (2..).map(|number| format!("{wanted} {number}"));
        let mut names = std::iter::once(wanted.clone()).chain(numbered);
        names.find(|name| self.find(name).is_none()).unwrap_or(wanted)
    }

    /// Semi-major axis in metres of an orbit about `parent` with room for a body.
    fn room(&self, parent: usize, size: Size, radii_m: &[f64]) -> f64 {
        let [least_m, most_m] = self.reach_m(parent, size, radii_m);
        let ephemeris = Ephemeris::new(self);
        let parents = self.parents();
        let children = (0..self.bodies.len()).filter(|child| parents[*child] == Some(parent));
        let mut taken_m: Vec<f64> =
            children.filter_map(|child| Some(ephemeris.orbit(child)?.semi_major_m)).filter(|at| *at < most_m).collect();
        taken_m.sort_by(f64::total_cmp);
        let star = self.bodies[parent].light.as_ref();
        let (Some(first_m), Some(last_m)) = (taken_m.first(), taken_m.last()) else {
            // Where a star is as bright as the Sun on the Earth; else in the middle.
            let wanted_m =
                star.map_or((least_m * most_m).sqrt(), |light| ASTRONOMICAL_UNIT_M * light.luminosity_suns.sqrt());
            return wanted_m.clamp(least_m, most_m);
        };
        let gaps = taken_m.windows(2).map(|pair| [pair[0], pair[1]]);
        let widest = gaps.max_by(|a, b| (a[1] / a[0]).total_cmp(&(b[1] / b[0])));
        let between = widest.map(|[inner_m, outer_m]| (inner_m * outer_m).sqrt());
        let candidates = [Some(last_m * SPACING), Some(first_m / SPACING), between];
        let fits = |at_m: &f64| (least_m..=most_m).contains(at_m);
        candidates.into_iter().flatten().find(fits).unwrap_or((last_m * SPACING).clamp(least_m, most_m))
    }

    /// Least and greatest semi-major axis in metres of a body about `parent`: neither inside it or its tides, nor out
    /// of its reach.
    pub(super) fn reach_m(&self, parent: usize, size: Size, radii_m: &[f64]) -> [f64; 2] {
        let of = &self.bodies[parent];
        let radius_m = radii_m.get(parent).copied().unwrap_or(0.0);
        let density = |mass: f64, radius_m: f64| mass / radius_m.powi(3);
        let mut least_m = 1.5 * (radius_m + size.radius_m).max(1000.0);
        if radius_m > 0.0 && size.radius_m > 0.0 && of.mass_earths > 0.0 && size.mass_earths > 0.0 {
            let densities = [density(of.mass_earths, radius_m), density(size.mass_earths, size.radius_m)];
            least_m = least_m.max(ROCHE_MARGIN * limits::roche_limit_m(radius_m, densities));
        }
        let widest_m = WIDEST_AU * ASTRONOMICAL_UNIT_M;
        let most_m = match (&of.light, of.is_point()) {
            (Some(light), _) => widest_m * light.luminosity_suns.sqrt(),
            (None, true) => {
                let parents = self.parents();
                let ephemeris = Ephemeris::new(self);
                // The pair in the middle; what orbits both is farther out.
                let massive = (0..self.bodies.len()).filter(|child| parents[*child] == Some(parent));
                let stars = massive.filter(|child| self.bodies[*child].light.is_some());
                let pair_m = stars.filter_map(|child| Some(ephemeris.orbit(child)?.semi_major_m)).sum::<f64>();
                least_m = least_m.max(PAIR_SPACING * pair_m);
                widest_m.max(2.0 * least_m)
            }
            (None, false) => match limits::hill_radii_m(self)[parent] {
                hill_m if hill_m.is_finite() => HILL_MARGIN * STABLE_SHARE * hill_m,
                _ => WIDEST_RADII * radius_m.max(1000.0),
            },
        };
        [least_m, most_m.max(least_m)]
    }

    /// Period in hours that an orbit about a point must have: that of the masses of the point's other children. 0 about
    /// a body with a mass, which decides the period itself.
    pub fn forced_period_hours(&self, parent: usize, semi_major_m: f64) -> f64 {
        if !self.bodies[parent].is_point() {
            return 0.0;
        }
        let name = &self.bodies[parent].name;
        let stars = self.bodies.iter().filter(|body| body.parent == *name && body.light.is_some());
        let mass_kg = stars.map(Member::mass_kg).sum::<f64>().max(1.0);
        let secs = std::f64::consts::TAU * (semi_major_m.powi(3) / (GRAVITATION * mass_kg)).sqrt();
        readable(secs / 3600.0).clamp(1e-6, 1e10)
    }
}

/// Rounded to six digits, which read well in a file.
pub(super) fn readable(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use crate::system::{Light, shipped};
    use std::sync::Arc;

    fn load(file: &str) -> (System, Vec<f64>) {
        let shipped = shipped::ALL.iter().find(|shipped| shipped.file == file).unwrap();
        let system = shipped.load().unwrap();
        let radius_m = |(body, planet): (&Member, Option<Arc<Planet>>)| match planet {
            Some(planet) => planet.radius_m(),
            None => body.light.as_ref().map_or(0.0, Light::radius_m),
        };
        let planets = shipped.planets(&system);
        let radii_m = system.bodies.iter().zip(planets).map(radius_m).collect();
        (system, radii_m)
    }

    #[test]
    fn bodies_are_added_where_there_is_room() {
        for shipped in shipped::ALL {
            let (before, radii_m) = load(shipped.file);
            for parent in 0..before.bodies.len() {
                let (mut system, mut radii_m) = (before.clone(), radii_m.clone());
                let is_star = before.bodies[parent].light.is_some() || before.bodies[parent].is_point();
                let (mass_earths, radius_m) = if is_star { (0.8, 6e6) } else { (1e-5, 2e5) };
                // Several, one after the other.
                for _ in 0..3 {
                    let member = Member {
                        name: "Moon".to_owned(),
                        preset: "pallor.ron".to_owned(),
                        mass_earths,
                        ..Member::default()
                    };
                    let number = system.add(parent, member, &radii_m, radius_m);
                    radii_m.push(radius_m);
                    assert_eq!(number, system.bodies.len() - 1);
                    system.check().unwrap_or_else(|problems| panic!("{problems:?}"));
                    let orbit = system.bodies[number].orbit.as_ref().unwrap();
                    let size = Size { mass_earths, radius_m };
                    let [least_m, most_m] = before.reach_m(parent, size, &radii_m);
                    assert!((0.999 * least_m..=1.001 * most_m).contains(&(orbit.semi_major_km * 1000.0)), "{orbit:?}");
                }
                let named = |name: &str| limits::warnings(&system, &radii_m).iter().any(|it| it.message.contains(name));
                assert!(!named("Roche") && !named("inside") && !named("Hill)"), "{} {parent}", shipped.file);
            }
        }
    }

    #[test]
    fn a_body_takes_its_moons_along_when_it_is_removed_and_its_name_when_it_is_renamed() {
        let (mut system, _) = load("hearth.ron");
        let aurel = system.find("Aurel").unwrap();
        assert_eq!(system.rename(aurel, "Home"), "Home");
        assert_eq!(system.bodies[system.find("Pallor").unwrap()].parent, "Home");
        assert_eq!(system.rename(aurel, "Maren"), "Maren 2", "another body has that name");
        assert_eq!(system.rename(aurel, "Maren 2"), "Maren 2", "its own name is free");
        assert_eq!(system.rename(aurel, " "), "Unnamed");
        system.check().unwrap();
        let count = system.bodies.len();
        let kept = system.remove(aurel);
        assert_eq!((system.bodies.len(), kept.len()), (count - 2, count - 2));
        assert!(system.find("Pallor").is_none() && !kept.contains(&aurel));
        assert_eq!(kept[aurel..], (aurel + 2..count).collect::<Vec<_>>()[..], "those behind keep their order");
        system.check().unwrap();
    }
}
