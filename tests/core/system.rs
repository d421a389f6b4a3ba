//! Systems as their users see them: resonances, starts.

use tellus::glam::DVec3;
use tellus::system::kepler::Ellipse;
use tellus::system::nbody::{Bodies, Mass, Scheme};
use tellus::system::{Orbit, System};

const DAY_SECS: f64 = 86_400.0;
/// Standard gravitational parameter of Jupiter, m³/s².
const JUPITER: f64 = 1.266_865_34e17;

/// Jupiter with Io, Europa and Ganymede. Mean motions, eccentricities and masses are those of the moons (Lieske,
/// Galilean satellites of Jupiter, theory E5, 1998). Io and Europa begin in conjunction, at Io's periapsis and Europa's
/// apoapsis, where conjunctions stay; Ganymede is a quarter turn ahead.
fn jupiter() -> Bodies {
    // Degrees a day, eccentricity, longitude of periapsis, longitude, gravitational parameter.
    let moons = [
        (203.488_955, 0.0041, 0.0, 0.0, 5.9599e12),
        (101.374_724, 0.0094, 180.0, 0.0, 3.2027e12),
        (50.317_609, 0.0013, 0.0, 90.0, 9.8878e12),
    ];
    let mut masses = vec![Mass { gravity: JUPITER, position_m: DVec3::ZERO, velocity: DVec3::ZERO }];
    for (degrees_a_day, eccentricity, periapsis_deg, longitude_deg, gravity) in moons {
        let mean_motion = f64::to_radians(degrees_a_day) / DAY_SECS;
        let semi_major_km = ((JUPITER + gravity) / mean_motion.powi(2)).cbrt() / 1000.0;
        let anomaly_deg = f64::rem_euclid(longitude_deg - periapsis_deg, 360.0);
        let orbit = Orbit { semi_major_km, eccentricity, periapsis_deg, anomaly_deg, ..Orbit::default() };
        let (position_m, velocity) = Ellipse::new(&orbit, JUPITER + gravity).state(0.0);
        masses.push(Mass { gravity, position_m, velocity });
    }
    Bodies::new(masses)
}

/// The argument of Laplace: λ1 - 3 λ2 + 2 λ3, degrees from 180, -180 to 180.
fn argument_deg(bodies: &Bodies) -> f64 {
    let masses = bodies.masses();
    let longitude = |moon: usize| {
        let away_m = masses[moon].position_m - masses[0].position_m;
        let velocity = masses[moon].velocity - masses[0].velocity;
        let elements = Ellipse::from_state(away_m, velocity, JUPITER + masses[moon].gravity).unwrap().elements();
        elements.node_deg + elements.periapsis_deg + elements.anomaly_deg
    };
    (longitude(1) - 3.0 * longitude(2) + 2.0 * longitude(3)).rem_euclid(360.0) - 180.0
}

/// Greatest distance of the argument from 180 degrees over some years.
fn most_deg(mut bodies: Bodies, years: f64) -> f64 {
    let step_secs = 1.769 * DAY_SECS / 60.0;
    let mut most: f64 = 0.0;
    let steps = (years * 365.25 * DAY_SECS / step_secs) as u32;
    for number in 0..steps {
        bodies.step(Scheme::Yoshida6, step_secs);
        if number % 25 == 0 {
            most = most.max(argument_deg(&bodies).abs());
        }
    }
    most
}

#[test]
fn the_moons_of_jupiter_keep_their_resonance() {
    let kept = most_deg(jupiter(), 12.0);
    assert!(kept < 90.0, "the argument librates within {kept} degrees");
    // Io on an orbit a hundredth wider is out of it.
    let mut masses = jupiter().masses().to_vec();
    masses[1].velocity *= 1.005;
    let lost = most_deg(Bodies::new(masses), 3.0);
    assert!(lost > 170.0, "it circulates: {lost}");
}

#[test]
fn a_start_is_an_orbit_and_one_that_does_not_stay_is_told() {
    let text = |start: &str| {
        format!(
            "(version: 1, bodies: [(name: \"Sun\", mass_earths: 332946.0, light: ()), \
             (name: \"One\", preset: \"one.ron\", parent: \"Sun\", start: {start})])"
        )
    };
    let told = |start: &str| System::from_text("x.ron", &text(start)).unwrap_err().to_string();
    let system = System::from_text("x.ron", &text("(x_km: 1.5e8, y_km_s: 31.0)")).unwrap();
    let ephemeris = tellus::system::Ephemeris::new(&system);
    let at = ephemeris.at(0.0)[1];
    assert!((at.position_m - DVec3::X * 1.5e11).length() < 1.0 && (at.velocity - DVec3::Y * 31e3).length() < 1e-6);
    // Faster than on a circle: it begins at the periapsis.
    let orbit = ephemeris.orbit(1).unwrap();
    assert!((orbit.eccentricity - (1.5e11 * 31e3_f64.powi(2) / 1.327_124e20 - 1.0)).abs() < 1e-4);
    assert_eq!(System::from_text("x.ron", &system.to_text()).unwrap(), system);
    assert!(
        told("(x_km: 1.5e8, y_km_s: 60.0)").contains("at 60.000 km/s the body leaves `Sun`, which holds less than 42.")
    );
    assert!(told("(x_km: 1.5e8, y_km_s: 0.0)").contains("falls straight into `Sun`"));
    assert!(told("(x_km: 1.5e8, y_km_s: 30.0), orbit: ()").contains("remove the start or the orbit"));
}
