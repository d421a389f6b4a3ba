//! Limits of a system: how far a body holds its moons, how near they may come, and what is not stable.

use super::{Ephemeris, System};

/// Radius of the Hill sphere of each body, metres: within it, the body holds what orbits it against its own parent.
/// Infinite at the root and for bodies around a point.
///
/// r = a (1 - e) (m / 3M)^(1/3) (Hamilton and Burns, Orbital stability zones about asteroids II, Icarus 96, 1992).
pub fn hill_radii_m(system: &System) -> Vec<f64> {
    let parents = system.parents();
    let radius = |(number, body): (usize, &super::Member)| {
        let parent = parents[number].map(|parent| &system.bodies[parent]);
        match parent.and_then(|parent| Some((parent, body.ellipse(parent.gravity_m3_s2())?))) {
            Some((parent, orbit)) if parent.mass_earths > 0.0 => {
                let nearest_m = orbit.semi_major_m * (1.0 - orbit.eccentricity);
                nearest_m * (body.mass_earths / (3.0 * parent.mass_earths)).cbrt()
            }
            _ => f64::INFINITY,
        }
    };
    system.bodies.iter().enumerate().map(radius).collect()
}

/// Distance from the centre of a body within which its tides tear a fluid satellite apart, metres: 2.44 R (D / d)^(1/3)
/// (Roche, 1849). `radius_m`: radius of the body. `densities`: of the body and of the satellite, in one unit.
pub fn roche_limit_m(radius_m: f64, densities: [f64; 2]) -> f64 {
    2.44 * radius_m * (densities[0] / densities[1]).cbrt()
}

/// Mutual Hill radius of two bodies on neighbouring orbits about one mass, metres (Gladman, Dynamics of systems of two
/// close planets, Icarus 106, 1993). `masses`: of the bodies, as shares of that mass.
pub fn mutual_hill_radius_m(semi_major_m: [f64; 2], masses: [f64; 2]) -> f64 {
    0.5 * (semi_major_m[0] + semi_major_m[1]) * ((masses[0] + masses[1]) / 3.0).cbrt()
}

/// Share of the Hill radius within which the moons of a planet are stable for long: half for orbits in the direction of
/// the planet's own motion (Domingos, Winter and Yokoyama, 2006).
pub const STABLE_SHARE: f64 = 0.49;
/// Least distance of planets on neighbouring orbits, in mutual Hill radii, for them to stay for billions of years
/// (Chambers, Wetherill and Boss, 1996).
pub const STABLE_SPACING: f64 = 10.0;

/// A limit that a system violates: the numbers of the bodies, and a sentence that names them and the figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// The body, and the other one that it concerns.
    pub bodies: [usize; 2],
    /// What is wrong, with figures.
    pub message: String,
}

/// Everything about a valid system that does not last. `radii_m`: radius of each body, 0 where it is unknown.
pub fn warnings(system: &System, radii_m: &[f64]) -> Vec<Warning> {
    let (parents, hill_m, ephemeris) = (system.parents(), hill_radii_m(system), Ephemeris::new(system));
    let mut found = Vec::new();
    for (number, body) in system.bodies.iter().enumerate() {
        let (Some(parent), Some(orbit)) = (parents[number], ephemeris.orbit(number)) else { continue };
        let of = &system.bodies[parent];
        let (nearest_m, farthest_m) =
            (orbit.semi_major_m * (1.0 - orbit.eccentricity), orbit.semi_major_m * (1.0 + orbit.eccentricity));
        let mut warn = |message: String| found.push(Warning { bodies: [number, parent], message });
        let (radius_m, parent_radius_m) = (radii_m[number], radii_m[parent]);
        if nearest_m < radius_m + parent_radius_m {
            warn(format!("{} comes within {} of {}, which is inside it", body.name, distance_text(nearest_m), of.name));
            continue;
        }
        if radius_m > 0.0 && parent_radius_m > 0.0 && of.mass_earths > 0.0 && body.mass_earths > 0.0 {
            let density = |mass: f64, radius_m: f64| mass / radius_m.powi(3);
            let densities = [density(of.mass_earths, parent_radius_m), density(body.mass_earths, radius_m)];
            let limit_m = roche_limit_m(parent_radius_m, densities);
            if nearest_m < limit_m {
                warn(format!(
                    "{} comes within {} of {}, whose tides tear it apart within {} (Roche)",
                    body.name,
                    distance_text(nearest_m),
                    of.name,
                    distance_text(limit_m)
                ));
            }
        }
        if farthest_m > STABLE_SHARE * hill_m[parent] {
            warn(format!(
                "{} goes as far as {} from {}, which holds moons within {} for long (Hill)",
                body.name,
                distance_text(farthest_m),
                of.name,
                distance_text(STABLE_SHARE * hill_m[parent])
            ));
        }
    }
    neighbours(system, &parents, &ephemeris, &mut found);
    found
}

/// Bodies on neighbouring orbits that are too close to each other.
fn neighbours(system: &System, parents: &[Option<usize>], ephemeris: &Ephemeris, found: &mut Vec<Warning>) {
    for parent in 0..system.bodies.len() {
        let mass = system.bodies[parent].mass_earths;
        if mass <= 0.0 {
            continue;
        }
        let mut children: Vec<(f64, usize)> = (0..system.bodies.len())
            .filter(|child| parents[*child] == Some(parent))
            .filter_map(|child| Some((ephemeris.orbit(child)?.semi_major_m, child)))
            .collect();
        children.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in children.windows(2) {
            let [(inner_m, inner), (outer_m, outer)] = [pair[0], pair[1]];
            let share = |body: usize| system.bodies[body].mass_earths / mass;
            let mutual_m = mutual_hill_radius_m([inner_m, outer_m], [share(inner), share(outer)]);
            let spacing = (outer_m - inner_m) / mutual_m;
            if spacing < STABLE_SPACING {
                let [inner_name, outer_name] = [inner, outer].map(|body| &system.bodies[body].name);
                let message = format!(
                    "the orbits of {inner_name} and {outer_name} are {spacing:.1} mutual Hill radii apart; \
                     {STABLE_SPACING} or more last for long"
                );
                found.push(Warning { bodies: [inner, outer], message });
            }
        }
    }
}

/// A distance with a unit that suits it.
pub fn distance_text(distance_m: f64) -> String {
    let km = distance_m / 1000.0;
    match km {
        _ if km >= 1e7 => format!("{:.3} AU", distance_m / super::ASTRONOMICAL_UNIT_M),
        _ if km >= 1e5 => format!("{:.0} thousand km", km / 1e3),
        _ => format!("{km:.0} km"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Light, Member, Orbit};

    fn sun_earth_moon(moon_km: f64) -> System {
        let star = Member {
            name: "Sun".to_owned(),
            mass_earths: 332_946.0,
            light: Some(Light::default()),
            ..Member::default()
        };
        let orbiting = |name: &str, parent: &str, mass_earths: f64, semi_major_km: f64| Member {
            name: name.to_owned(),
            parent: parent.to_owned(),
            mass_earths,
            orbit: Some(Orbit { semi_major_km, ..Orbit::default() }),
            ..Member::default()
        };
        let planet = orbiting("Earth", "Sun", 1.0, 149_597_870.7);
        System { name: String::new(), bodies: vec![star, planet, orbiting("Moon", "Earth", 0.0123, moon_km)] }
    }

    #[test]
    fn figures_of_the_earth_are_known() {
        let hill_km = hill_radii_m(&sun_earth_moon(384_400.0))[1] / 1000.0;
        assert!((hill_km - 1_496_500.0).abs() < 2000.0, "{hill_km}");
        // Fluid limit of the Moon at the Earth: about 18,400 km.
        let roche_km = roche_limit_m(6371.0e3, [5.514, 3.344]) / 1000.0;
        assert!((roche_km - 18_365.0).abs() < 60.0, "{roche_km}");
    }

    #[test]
    fn what_does_not_last_is_named() {
        let radii_m = [6.957e8, 6.371e6, 1.737e6];
        let told = |moon_km: f64| -> Vec<String> {
            warnings(&sun_earth_moon(moon_km), &radii_m).into_iter().map(|warning| warning.message).collect()
        };
        assert_eq!(told(384_400.0), Vec::<String>::new());
        assert!(told(15_000.0)[0].contains("Roche"), "{:?}", told(15_000.0));
        assert!(told(1_200_000.0)[0].contains("Hill"));
        assert!(told(7000.0)[0].contains("inside"));
        let mut close = sun_earth_moon(384_400.0);
        close.bodies.push(Member {
            name: "Twin".to_owned(),
            parent: "Sun".to_owned(),
            mass_earths: 1.0,
            orbit: Some(Orbit { semi_major_km: 155e6, ..Orbit::default() }),
            ..Member::default()
        });
        let radii_m = [radii_m.as_slice(), &[6.4e6]].concat();
        let message = &warnings(&close, &radii_m)[0].message;
        assert!(message.contains("Earth and Twin") && message.contains("mutual Hill"), "{message}");
    }
}
