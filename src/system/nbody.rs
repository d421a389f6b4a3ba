//! Motion under the attraction of all bodies, to see whether a system lasts.
//!
//! Two symplectic schemes: velocity Verlet (second order: Swope et al., A computer simulation method for the
//! calculation of equilibrium constants, 1982) and a composition of seven Verlet steps (sixth order, solution A:
//! Yoshida, Construction of higher order symplectic integrators, Physics Letters A 150, 1990). Their energy error stays
//! bounded; it does not grow as that of other schemes does. Equal inputs give equal bits: bodies are summed in one
//! order, on one thread.

use super::kepler::Ellipse;
use super::{Ephemeris, System, YEAR_SECS};
use glam::DVec3;

/// A scheme of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Velocity Verlet: second order, one evaluation of the forces for each step.
    Verlet,
    /// Yoshida's composition: sixth order, seven evaluations for each step.
    #[default]
    Yoshida6,
}

/// Weights of Yoshida's solution A, outermost first; the middle one makes their sum 1.
const YOSHIDA: [f64; 3] = [0.784_513_610_477_560, 0.235_573_213_359_357, -1.177_679_984_178_87];

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
    accelerations: Vec<DVec3>,
    /// Seconds since the start.
    time_secs: f64,
}

impl Bodies {
    /// Masses at the start.
    pub fn new(masses: Vec<Mass>) -> Self {
        let mut bodies = Self { accelerations: vec![DVec3::ZERO; masses.len()], masses, time_secs: 0.0 };
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
        let all: f64 = masses.iter().map(|mass| mass.gravity).sum::<f64>().max(f64::MIN_POSITIVE);
        let mean = |of: fn(&Mass) -> DVec3| masses.iter().map(|mass| of(mass) * mass.gravity).sum::<DVec3>() / all;
        let (center_m, drift) = (mean(|mass| mass.position_m), mean(|mass| mass.velocity));
        for mass in &mut masses {
            mass.position_m -= center_m;
            mass.velocity -= drift;
        }
        Self::new(masses)
    }

    /// The masses now.
    pub fn masses(&self) -> &[Mass] {
        &self.masses
    }

    /// Seconds since the start.
    pub fn time_secs(&self) -> f64 {
        self.time_secs
    }

    /// Moves on by a step.
    pub fn step(&mut self, scheme: Scheme, step_secs: f64) {
        match scheme {
            Scheme::Verlet => self.verlet(step_secs),
            Scheme::Yoshida6 => {
                let middle = 1.0 - 2.0 * YOSHIDA.iter().sum::<f64>();
                let outwards = YOSHIDA.iter().rev();
                for share in YOSHIDA.iter().chain([&middle]).chain(outwards) {
                    self.verlet(share * step_secs);
                }
            }
        }
        self.time_secs += step_secs;
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

    /// Computes the accelerations. Points attract nothing and nothing attracts them.
    fn attract(&mut self) {
        self.accelerations.fill(DVec3::ZERO);
        for i in 0..self.masses.len() {
            for j in 0..i {
                let (a, b) = (self.masses[i], self.masses[j]);
                if a.gravity == 0.0 || b.gravity == 0.0 {
                    continue;
                }
                let away = b.position_m - a.position_m;
                let square = away.length_squared();
                let pull = away / (square * square.sqrt());
                self.accelerations[i] += pull * b.gravity;
                self.accelerations[j] -= pull * a.gravity;
            }
        }
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

/// What a run of a system showed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trial {
    /// Seconds that were run.
    pub secs: f64,
    /// Greatest relative error of the energy.
    pub energy_error: f64,
    /// Bodies that left their parent or met another: what happened, and when.
    pub events: Vec<Event>,
}

/// Something that ends the peace of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Seconds since the start.
    pub time_secs: f64,
    /// Numbers of the two bodies.
    pub bodies: [usize; 2],
    /// What happened to them.
    pub kind: EventKind,
}

impl Event {
    /// What happened, and when, with the names of the bodies.
    pub fn told(&self, system: &System) -> String {
        let [a, b] = self.bodies.map(|body| &system.bodies[body].name);
        let years = self.time_secs / YEAR_SECS;
        match self.kind {
            EventKind::Encounter => {
                format!("after {years:.3} years {a} and {b} are nearer to each other than the Hill radius of one")
            }
            EventKind::Escape => format!("after {years:.3} years {a} leaves {b}"),
            EventKind::Collision => format!("after {years:.3} years {a} and {b} collide"),
        }
    }
}

/// The kinds of [`Event`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// Two bodies that do not orbit each other came within the Hill radius of the heavier one.
    Encounter,
    /// A body left the Hill sphere of its parent, or moves too fast to stay.
    Escape,
    /// Two bodies touched.
    Collision,
}

/// Seconds of a step that suits a system: a two-hundredth of the shortest period.
pub fn fitting_step_secs(system: &System) -> f64 {
    let ephemeris = Ephemeris::new(system);
    let orbits = (0..system.bodies.len()).filter_map(|body| ephemeris.orbit(body));
    orbits.map(Ellipse::period_secs).fold(YEAR_SECS, f64::min) / 200.0
}

/// Runs a system and watches it. `radii_m`: radius of each body, 0 where it is unknown. `observe` is told the share
/// that is done and the bodies after each step, and answers whether to go on.
pub fn try_out(
    system: &System,
    radii_m: &[f64],
    scheme: Scheme,
    (secs, step_secs): (f64, f64),
    observe: &mut dyn FnMut(f64, &Bodies) -> bool,
) -> Trial {
    let (mut bodies, parents) = (Bodies::of(system), system.parents());
    let start = bodies.energy();
    let mut trial = Trial::default();
    let hill_m = super::limits::hill_radii_m(system);
    let steps = (secs / step_secs).ceil().max(0.0) as u64;
    for number in 0..steps {
        if !observe(number as f64 / steps as f64, &bodies) {
            break;
        }
        bodies.step(scheme, step_secs);
        let error = ((bodies.energy() - start) / start).abs();
        trial.energy_error = trial.energy_error.max(error);
        trial.secs = bodies.time_secs();
        watch(&bodies, &parents, (radii_m, &hill_m), &mut trial.events);
    }
    trial
}

fn watch(bodies: &Bodies, parents: &[Option<usize>], (radii_m, hill_m): (&[f64], &[f64]), events: &mut Vec<Event>) {
    let masses = bodies.masses();
    let mut tell = |i: usize, j: usize, kind: EventKind| {
        if !events.iter().any(|event| event.bodies == [i, j] && event.kind == kind) {
            events.push(Event { time_secs: bodies.time_secs(), bodies: [i, j], kind });
        }
    };
    for i in 0..masses.len() {
        for j in 0..i {
            if masses[i].gravity == 0.0 || masses[j].gravity == 0.0 {
                continue;
            }
            let apart_m = (masses[i].position_m - masses[j].position_m).length();
            let radius_m = |body: usize| radii_m.get(body).copied().unwrap_or(0.0);
            if apart_m < radius_m(i) + radius_m(j) {
                tell(i, j, EventKind::Collision);
            }
            if parents[i] == Some(j) {
                let speed = (masses[i].velocity - masses[j].velocity).length();
                let flees = 0.5 * speed * speed > (masses[i].gravity + masses[j].gravity) / apart_m;
                // Moons are held by less than the star's pull; the planets' own escape is that from the star.
                if flees || apart_m > hill_m[j] {
                    tell(i, j, EventKind::Escape);
                }
            } else if parents[i] == parents[j] && apart_m < hill_m[i].max(hill_m[j]) {
                tell(i, j, EventKind::Encounter);
            }
        }
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
        let run = || {
            let mut bodies = pair();
            for _ in 0..1000 {
                bodies.step(Scheme::Yoshida6, 0.01);
            }
            bodies.masses().to_vec()
        };
        assert_eq!(run(), run());
    }
}
