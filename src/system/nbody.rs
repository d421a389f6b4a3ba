//! Motion under the attraction of all bodies. [`trial`](super::trial) runs it to see whether a system lasts.
//!
//! The scheme of trials is a Gauss-Radau integrator of 15th order, whose step follows the pair that changes fastest
//! (`radau`). Two symplectic schemes with an even step stand beside it for comparison: velocity Verlet (second order:
//! Swope et al., A computer simulation method for the calculation of equilibrium constants, 1982) and a composition of
//! seven Verlet steps (sixth order, solution A: Yoshida, Construction of higher order symplectic integrators, Physics
//! Letters A 150, 1990). Their energy error stays bounded, but they do not see an encounter that is shorter than a
//! step. Equal inputs give equal bits: bodies are summed in one order, on one thread.

use super::radau::Radau;
use super::{Ephemeris, System};
use glam::DVec3;

/// A scheme of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Gauss-Radau: 15th order, steps that follow the fastest pair.
    #[default]
    Radau15,
    /// Velocity Verlet: second order, even steps, one evaluation of the forces for each.
    Verlet,
    /// Yoshida's composition: sixth order, even steps, seven evaluations for each.
    Yoshida6,
}

/// Weights of Yoshida's solution A, outermost first; the middle one makes their sum 1.
const YOSHIDA: [f64; 3] = [0.784_513_610_477_560, 0.235_573_213_359_357, -1.177_679_984_178_87];
/// Most times that a step which finds no solution is halved.
const MOST_HALVINGS: u32 = 40;

/// A mass that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Standard gravitational parameter, m³/s².
    pub gravity: f64,
    /// Position, metres.
    pub position_m: DVec3,
    /// Velocity, m/s.
    pub velocity: DVec3,
}

/// Masses that attract each other.
#[derive(Clone, Debug)]
pub struct Bodies {
    masses: Vec<Mass>,
    /// What each point of a system carries: it goes where their centre of mass is. None for a body.
    points: Vec<Option<Vec<usize>>>,
    accelerations: Vec<DVec3>,
    radau: Radau,
    /// Seconds since the start.
    time_secs: f64,
}

impl Bodies {
    /// Masses at the start. Those of no mass are attracted and attract nothing.
    pub fn new(masses: Vec<Mass>) -> Self {
        let points = vec![None; masses.len()];
        Self::with_points(masses, points)
    }

    fn with_points(masses: Vec<Mass>, points: Vec<Option<Vec<usize>>>) -> Self {
        let accelerations = vec![DVec3::ZERO; masses.len()];
        let mut bodies = Self { masses, points, accelerations, radau: Radau::default(), time_secs: 0.0 };
        bodies.place_points();
        bodies.attract();
        bodies
    }

    /// The bodies of a system at time zero, around their common centre of mass.
    pub fn of(system: &System) -> Self {
        let poses = Ephemeris::new(system).at(0.0);
        let mass = |(body, pose): (&super::Member, &super::Pose)| Mass {
            gravity: body.gravity_m3_s2(),
            position_m: pose.position_m,
            velocity: pose.velocity,
        };
        let mut masses: Vec<Mass> = system.bodies.iter().zip(&poses).map(mass).collect();
        recoil(system, &mut masses);
        let all: Vec<usize> = (0..masses.len()).collect();
        let (center_m, drift) = center(&masses, &all).unwrap_or_default();
        for mass in &mut masses {
            mass.position_m -= center_m;
            mass.velocity -= drift;
        }
        let carried = |point: usize| all.iter().copied().filter(|body| system.carries(point, *body)).collect();
        let points = all.iter().map(|body| system.bodies[*body].is_point().then(|| carried(*body))).collect();
        Self::with_points(masses, points)
    }

    /// The masses now.
    pub fn masses(&self) -> &[Mass] {
        &self.masses
    }

    /// Seconds since the start.
    pub fn time_secs(&self) -> f64 {
        self.time_secs
    }

    /// Whether a body is a mere point, which nothing attracts.
    pub fn is_point(&self, body: usize) -> bool {
        self.points[body].is_some()
    }

    /// Moves on by a step, or by a part of it if the scheme finds no solution for the whole. Gives the seconds that
    /// passed; 0 if no step is short enough.
    pub fn step(&mut self, scheme: Scheme, step_secs: f64) -> f64 {
        let mut passed_secs = step_secs;
        match scheme {
            Scheme::Radau15 => passed_secs = self.radau(step_secs),
            Scheme::Verlet => self.verlet(step_secs),
            Scheme::Yoshida6 => {
                let middle = 1.0 - 2.0 * YOSHIDA.iter().sum::<f64>();
                let outwards = YOSHIDA.iter().rev();
                for share in YOSHIDA.iter().chain([&middle]).chain(outwards) {
                    self.verlet(share * step_secs);
                }
            }
        }
        self.place_points();
        self.time_secs += passed_secs;
        passed_secs
    }

    fn radau(&mut self, step_secs: f64) -> f64 {
        let mut secs = step_secs;
        for _ in 0..MOST_HALVINGS {
            let points = &self.points;
            let attract = |masses: &[Mass], positions_m: &[DVec3], to: &mut [DVec3]| {
                accelerations(masses, points, positions_m, to);
            };
            if self.radau.step(&mut self.masses, secs, &attract) {
                return secs;
            }
            secs *= 0.5;
        }
        0.0
    }

    fn verlet(&mut self, step_secs: f64) {
        for (mass, acceleration) in self.masses.iter_mut().zip(&self.accelerations) {
            mass.velocity += *acceleration * (0.5 * step_secs);
            mass.position_m += mass.velocity * step_secs;
        }
        self.attract();
        for (mass, acceleration) in self.masses.iter_mut().zip(&self.accelerations) {
            mass.velocity += *acceleration * (0.5 * step_secs);
        }
    }

    fn attract(&mut self) {
        let positions_m: Vec<DVec3> = self.masses.iter().map(|mass| mass.position_m).collect();
        accelerations(&self.masses, &self.points, &positions_m, &mut self.accelerations);
    }

    fn place_points(&mut self) {
        for point in 0..self.points.len() {
            let Some(carried) = &self.points[point] else { continue };
            if let Some((position_m, velocity)) = center(&self.masses, carried) {
                self.masses[point] = Mass { gravity: 0.0, position_m, velocity };
            }
        }
    }

    /// Whether all positions and velocities are numbers.
    pub fn is_finite(&self) -> bool {
        self.masses.iter().all(|mass| mass.position_m.is_finite() && mass.velocity.is_finite())
    }

    /// Seconds in which the pair that changes fastest would change wholly, and that pair: the least of
    /// (μ / r³ + v² / r²)^(-1/2). On a circle it is 0.11 of the period. Infinite if nothing attracts anything.
    pub fn pace_secs(&self) -> (f64, [usize; 2]) {
        let (mut most, mut pair) = (0.0, [0, 0]);
        for (i, a) in self.masses.iter().enumerate() {
            for (j, b) in self.masses[..i].iter().enumerate() {
                let gravity = a.gravity + b.gravity;
                if gravity == 0.0 || self.is_point(i) || self.is_point(j) {
                    continue;
                }
                let square = (b.position_m - a.position_m).length_squared();
                let speed_square = (b.velocity - a.velocity).length_squared();
                let rate_square = gravity / (square * square.sqrt()) + speed_square / square;
                if rate_square > most {
                    (most, pair) = (rate_square, [j, i]);
                }
            }
        }
        (1.0 / most.sqrt(), pair)
    }

    /// Energy times the constant of gravitation: kinetic and potential.
    pub fn energy(&self) -> f64 {
        let mut energy = 0.0;
        for (i, a) in self.masses.iter().enumerate() {
            energy += 0.5 * a.gravity * a.velocity.length_squared();
            for b in &self.masses[..i] {
                if a.gravity > 0.0 && b.gravity > 0.0 {
                    energy -= a.gravity * b.gravity / (b.position_m - a.position_m).length();
                }
            }
        }
        energy
    }

    /// Angular momentum times the constant of gravitation.
    pub fn momentum(&self) -> DVec3 {
        self.masses.iter().map(|mass| mass.position_m.cross(mass.velocity) * mass.gravity).sum()
    }
}

/// Accelerations at positions. Points attract nothing and nothing attracts them.
fn accelerations(masses: &[Mass], points: &[Option<Vec<usize>>], positions_m: &[DVec3], to: &mut [DVec3]) {
    to.fill(DVec3::ZERO);
    for i in 0..masses.len() {
        for j in 0..i {
            let [a, b] = [masses[i].gravity, masses[j].gravity];
            if a + b == 0.0 || points[i].is_some() || points[j].is_some() {
                continue;
            }
            let away = positions_m[j] - positions_m[i];
            let square = away.length_squared();
            let pull = away / (square * square.sqrt());
            to[i] += pull * b;
            to[j] -= pull * a;
        }
    }
}

/// Centre of mass of some bodies and its velocity; None if they have no mass.
pub(super) fn center(masses: &[Mass], bodies: &[usize]) -> Option<(DVec3, DVec3)> {
    let all: f64 = bodies.iter().map(|body| masses[*body].gravity).sum();
    let mean = |of: fn(&Mass) -> DVec3| bodies.iter().map(|body| of(&masses[*body]) * masses[*body].gravity).sum();
    let (position_m, velocity): (DVec3, DVec3) = (mean(|mass| mass.position_m), mean(|mass| mass.velocity));
    (all > 0.0).then(|| (position_m / all, velocity / all))
}

/// On rails a parent does not feel its children; here it does. Each parent and its own children keep the common centre
/// of mass that the rails give to the parent. The innermost parents come first, so that each moves with all it carries.
fn recoil(system: &System, masses: &mut [Mass]) {
    let parents = system.parents();
    let mut carried: Vec<f64> = masses.iter().map(|mass| mass.gravity).collect();
    let mut shifts = vec![(DVec3::ZERO, DVec3::ZERO); masses.len()];
    // A parent comes before its children: from the last to the first, each subtree is complete when it is met.
    for child in (0..masses.len()).rev() {
        let Some(parent) = parents[child] else { continue };
        carried[parent] += carried[child];
    }
    for parent in 0..masses.len() {
        if masses[parent].gravity == 0.0 {
            continue;
        }
        for child in (0..masses.len()).filter(|child| parents[*child] == Some(parent)) {
            let share = carried[child] / carried[parent];
            shifts[parent].0 -= (masses[child].position_m - masses[parent].position_m) * share;
            shifts[parent].1 -= (masses[child].velocity - masses[parent].velocity) * share;
        }
    }
    // The children of a parent that is shifted move along: distances within a pair stay those of the rails.
    for body in 0..masses.len() {
        let mut total = shifts[body];
        let mut above = parents[body];
        while let Some(parent) = above {
            total.0 += shifts[parent].0;
            total.1 += shifts[parent].1;
            above = parents[parent];
        }
        masses[body].position_m += total.0;
        masses[body].velocity += total.1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal masses on a long ellipse; G = 1.
    fn pair() -> Bodies {
        let e: f64 = 0.5;
        let at = DVec3::X * 0.5 * (1.0 - e);
        let velocity = DVec3::Y * 0.5 * ((1.0 + e) / (1.0 - e)).sqrt();
        let mass = |sign: f64| Mass { gravity: 0.5, position_m: at * sign, velocity: velocity * sign };
        Bodies::new(vec![mass(1.0), mass(-1.0)])
    }

    /// Greatest relative energy error over periods, with steps of a share of a period.
    fn energy_error(scheme: Scheme, steps_a_period: u32, periods: u32) -> f64 {
        let mut bodies = pair();
        let start = bodies.energy();
        let step = std::f64::consts::TAU / f64::from(steps_a_period);
        let mut most: f64 = 0.0;
        for _ in 0..steps_a_period * periods {
            bodies.step(scheme, step);
            most = most.max(((bodies.energy() - start) / start).abs());
        }
        most
    }

    #[test]
    fn the_energy_error_is_of_the_order_of_the_scheme_and_does_not_grow() {
        for (scheme, order, steps) in [(Scheme::Verlet, 2.0, 400), (Scheme::Yoshida6, 6.0, 100)] {
            let coarse = energy_error(scheme, steps, 2);
            let fine = energy_error(scheme, 2 * steps, 2);
            let found = (coarse / fine).log2();
            assert!((found - order).abs() < 0.35, "{scheme:?}: order {found} ({coarse:e}, {fine:e})");
            let later = energy_error(scheme, steps, 100);
            assert!(later < coarse * 1.05, "{scheme:?}: {coarse:e} after 2 periods, {later:e} after 100");
        }
    }

    #[test]
    fn the_figure_of_eight_closes() {
        // Chenciner and Montgomery, A remarkable periodic solution of the three-body problem, 2000; values of C. Simo.
        let mass = |x: f64, y: f64, vx: f64, vy: f64| Mass {
            gravity: 1.0,
            position_m: DVec3::new(x, y, 0.0),
            velocity: DVec3::new(vx, vy, 0.0),
        };
        let (vx, vy) = (-0.932_407_37, -0.864_731_46);
        let start = vec![
            mass(0.970_004_36, -0.243_087_53, -0.5 * vx, -0.5 * vy),
            mass(-0.970_004_36, 0.243_087_53, -0.5 * vx, -0.5 * vy),
            mass(0.0, 0.0, vx, vy),
        ];
        let mut bodies = Bodies::new(start.clone());
        let (period, steps) = (6.325_913_98, 4000);
        for _ in 0..steps {
            bodies.step(Scheme::Yoshida6, period / f64::from(steps));
        }
        for (before, after) in start.iter().zip(bodies.masses()) {
            let off = (before.position_m - after.position_m).length();
            assert!(off < 1e-6, "{off}");
        }
        assert!(bodies.momentum().length() < 1e-12);
    }

    #[test]
    fn equal_inputs_give_equal_bits() {
        let run = |scheme: Scheme| {
            let mut bodies = pair();
            for _ in 0..1000 {
                bodies.step(scheme, 0.01);
            }
            bodies.masses().to_vec()
        };
        for scheme in [Scheme::Radau15, Scheme::Yoshida6] {
            assert_eq!(run(scheme), run(scheme));
        }
    }

    /// Steps that follow the pace, over periods of a pair of unit mass on a long ellipse: the relative error of the
    /// energy and of the place, and the steps of a period.
    fn followed(eccentricity: f64, periods: f64) -> (f64, f64, f64) {
        let at = DVec3::X * (1.0 - eccentricity);
        let velocity = DVec3::Y * ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt();
        let light = Mass { gravity: 0.0, position_m: at, velocity };
        let mut bodies =
            Bodies::new(vec![Mass { gravity: 1.0, position_m: DVec3::ZERO, velocity: DVec3::ZERO }, light]);
        let energy = |mass: &Mass| 0.5 * mass.velocity.length_squared() - 1.0 / mass.position_m.length();
        let (end, mut most, mut steps) = (periods * std::f64::consts::TAU, 0.0_f64, 0.0);
        while bodies.time_secs() < end {
            let step = (0.25 * bodies.pace_secs().0).min(end - bodies.time_secs());
            bodies.step(Scheme::Radau15, step);
            steps += 1.0;
            most = most.max((energy(&bodies.masses()[1]) / -0.5 - 1.0).abs());
        }
        (most, (bodies.masses()[1].position_m - at).length(), steps / periods)
    }

    #[test]
    fn long_ellipses_close_to_the_digits() {
        for eccentricity in [0.0, 0.5, 0.9, 0.97, 0.999] {
            let (energy, place, steps) = followed(eccentricity, 20.0);
            println!("e {eccentricity}: energy {energy:.1e}, place {place:.1e}, {steps} steps a period");
            // At the periapsis both terms of the energy are large beside their sum, and an error of the period by one
            // digit moves a place that is passed fast.
            let fast = 1.0 / (1.0 - eccentricity);
            assert!(energy < 1e-14 * fast && place < 1e-12 * fast * fast, "{eccentricity}: {energy:e} {place:e}");
            assert!((30.0..120.0).contains(&steps), "{eccentricity}: {steps} steps a period");
        }
    }
}
