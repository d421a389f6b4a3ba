//! Trials: a system is run under the attraction of all its bodies, to see whether it lasts.
//!
//! A trial either follows the motion or says that it does not. The step follows the fastest pair, or, for the schemes
//! with an even step, must suit the shortest orbit. Bodies meet along their paths within steps, not only at their ends.
//! What follows a collision is not known, so the trial ends there.

use super::nbody::{Bodies, Mass, Scheme, center};
use super::sweep::Sweep;
use super::{Ephemeris, System, YEAR_SECS, limits};

/// Relative error of the energy above which a trial says nothing about a system.
pub const TRUSTED_ENERGY_ERROR: f64 = 1e-3;
/// Most steps of a trial: some hours for a system of ten bodies.
pub const MOST_STEPS: u64 = 1_000_000_000;
/// Steps of a period of a circle that follow the motion.
const FOLLOWING_STEPS_A_PERIOD: f64 = 36.0;
/// Share of the pace of the fastest pair that a step takes.
const SHARE_OF_PACE: f64 = 0.25;
/// The pace of a circle as a share of its period.
const PACE_OF_CIRCLE: f64 = 0.112_54;
/// Factor by which bodies may turn faster than an even step was chosen for.
const MARGIN: f64 = 2.0;

/// A trial that can be run: a valid system, the radius of each body in metres, 0 where it is unknown, and how to go.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    system: &'a System,
    radii_m: &'a [f64],
    scheme: Scheme,
    secs: f64,
    /// The step, or the longest step of a scheme that chooses its own.
    step_secs: f64,
    most_steps: u64,
}

/// What a run of a system showed.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Seconds that were run.
    pub secs: f64,
    /// Steps that were taken.
    pub steps: u64,
    /// Greatest relative error of the energy.
    pub energy_error: f64,
    /// Bodies that left their parent or met another: what happened, and when, the first first.
    pub events: Vec<Event>,
    /// Why it ended.
    pub ending: Ending,
    /// The first pair that an even step does not follow, and the seconds until then.
    pub unfollowed: Option<(f64, [usize; 2])>,
    /// The bodies at the end, around their common centre of mass.
    pub masses: Vec<Mass>,
}

/// Why a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It was run to its end.
    Whole,
    /// It was stopped.
    Stopped,
    /// Two bodies collided.
    Collision,
    /// A position is no number any more, or no step is short enough for the motion.
    Lost,
    /// It took more than [`MOST_STEPS`]: these bodies turn too fast about each other.
    TooManySteps([usize; 2]),
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
            EventKind::Collision => format!("after {years:.3} years {a} and {b} collide; the trial ends there"),
        }
    }
}

impl Trial {
    /// Why the trial says nothing about the system; empty if it can be trusted.
    pub fn doubts(&self, system: &System) -> Vec<String> {
        let mut doubts = Vec::new();
        let names = |bodies: [usize; 2]| bodies.map(|body| system.bodies[body].name.as_str()).join(" and ");
        match self.ending {
            Ending::Lost => doubts.push("the motion can no longer be computed".to_owned()),
            Ending::TooManySteps(bodies) => {
                let years = self.secs / YEAR_SECS;
                let names = names(bodies);
                doubts.push(format!(
                    "{names} turn too fast about each other: {} steps led to {years:.3} years",
                    self.steps
                ));
            }
            Ending::Whole | Ending::Stopped | Ending::Collision => {}
        }
        // An error that is no number is too large.
        if self.energy_error.is_nan() || self.energy_error > TRUSTED_ENERGY_ERROR {
            let error = self.energy_error;
            doubts.push(format!("the energy is off by {error:.1e}; more than {TRUSTED_ENERGY_ERROR:.0e} is too much"));
        }
        if let Some((secs, bodies)) = self.unfollowed {
            let (years, names) = (secs / YEAR_SECS, names(bodies));
            doubts.push(format!("after {years:.3} years {names} come too near to each other for the step"));
        }
        doubts
    }
}

impl Scheme {
    /// The longest step, as a share of the pace of the fastest pair.
    fn longest(self) -> f64 {
        match self {
            Scheme::Radau15 => SHARE_OF_PACE,
            Scheme::Verlet => 1.0 / 12.0,
            Scheme::Yoshida6 => 1.0 / 3.0,
        }
    }

    /// A step that suits, as such a share: a part of the period of a circle, or what follows the motion.
    fn suiting(self) -> f64 {
        match self {
            Scheme::Radau15 => SHARE_OF_PACE,
            Scheme::Verlet => 1.0 / (1000.0 * PACE_OF_CIRCLE),
            Scheme::Yoshida6 => 1.0 / (200.0 * PACE_OF_CIRCLE),
        }
    }
}

impl<'a> Plan<'a> {
    /// A trial of some seconds. `step_secs`: the step, or the longest step of a scheme that chooses its own; None for
    /// one that suits.
    ///
    /// # Errors
    /// A step that is too long for an orbit, and a trial of too many steps: what is wrong and what would be right.
    pub fn new(
        system: &'a System,
        radii_m: &'a [f64],
        scheme: Scheme,
        secs: f64,
        step_secs: Option<f64>,
    ) -> Result<Self, String> {
        let (pace_secs, fastest) = shortest_pace(system);
        let longest_secs = scheme.longest() * pace_secs;
        let suiting_secs = scheme.suiting() * pace_secs;
        let name = &system.bodies[fastest].name;
        if step_secs.is_some_and(|step_secs| step_secs <= 0.0 || step_secs.is_nan() || step_secs > longest_secs) {
            return Err(format!(
                "a step of {} is too long for the orbit of {name}; use {} or less, {} suits",
                hours(step_secs.unwrap_or_default()),
                hours(longest_secs),
                hours(suiting_secs)
            ));
        }
        // Away from the periapsis, steps that follow the motion may be longer than those that suit there.
        let default_secs = if scheme == Scheme::Radau15 { f64::INFINITY } else { suiting_secs };
        let step_secs = step_secs.unwrap_or(default_secs).min(secs);
        let mean_secs = match scheme {
            Scheme::Radau15 => step_secs.min(shortest_period_secs(system) / FOLLOWING_STEPS_A_PERIOD),
            Scheme::Verlet | Scheme::Yoshida6 => step_secs,
        };
        if secs / mean_secs > MOST_STEPS as f64 {
            return Err(format!(
                "{} years take {:.0e} steps, because the orbit of {name} is short; use at most {} years",
                secs / YEAR_SECS,
                secs / mean_secs,
                rounded_down(mean_secs * MOST_STEPS as f64 / YEAR_SECS)
            ));
        }
        Ok(Self { system, radii_m, scheme, secs, step_secs, most_steps: MOST_STEPS })
    }

    /// Runs the system and watches it. `observe` is told the share that is done and the bodies before each step, and
    /// answers whether to go on.
    pub fn run(&self, observe: &mut dyn FnMut(f64, &Bodies) -> bool) -> Trial {
        let mut bodies = Bodies::of(self.system);
        let watch = Watch::new(self.system, self.radii_m);
        let start = bodies.energy();
        // Bodies without mass have no energy.
        let scale = start.abs().max(f64::MIN_POSITIVE);
        let mut trial = Trial {
            secs: 0.0,
            steps: 0,
            energy_error: 0.0,
            events: Vec::new(),
            ending: Ending::Whole,
            unfollowed: None,
            masses: Vec::new(),
        };
        let mut before = bodies.masses().to_vec();
        watch.look(&bodies, &before, 0.0, &mut trial.events);
        trial.ending = loop {
            if trial.events.iter().any(|event| event.kind == EventKind::Collision) {
                break Ending::Collision;
            }
            let left_secs = self.secs - bodies.time_secs();
            if left_secs <= f64::EPSILON * self.secs {
                break Ending::Whole;
            }
            if !observe(bodies.time_secs() / self.secs, &bodies) {
                break Ending::Stopped;
            }
            if trial.steps == self.most_steps {
                break Ending::TooManySteps(bodies.pace_secs().1);
            }
            let step_secs = self.next_secs(&bodies).min(left_secs);
            before.clear();
            before.extend_from_slice(bodies.masses());
            let passed_secs = bodies.step(self.scheme, step_secs);
            let energy_error = ((bodies.energy() - start) / scale).abs();
            let stands = trial.secs == bodies.time_secs();
            if stands || !bodies.is_finite() || !energy_error.is_finite() {
                break Ending::Lost;
            }
            trial.steps += 1;
            let known = trial.events.len();
            watch.look(&bodies, &before, passed_secs, &mut trial.events);
            let collision = trial.events[known..].iter().find(|event| event.kind == EventKind::Collision);
            trial.secs = collision.map_or(bodies.time_secs(), |event| event.time_secs);
            if trial.unfollowed.is_none() && collision.is_none() {
                let pair = self.unfollowed(&bodies, &before, passed_secs);
                trial.unfollowed = pair.map(|pair| (bodies.time_secs(), pair));
            }
            // After a collision the bodies fell through each other until the end of the step.
            if collision.is_none() {
                trial.energy_error = trial.energy_error.max(energy_error);
            }
        };
        if trial.ending == Ending::Whole {
            trial.secs = self.secs;
        }
        trial.masses = bodies.masses().to_vec();
        trial
    }

    /// Seconds of the next step.
    fn next_secs(&self, bodies: &Bodies) -> f64 {
        match self.scheme {
            Scheme::Radau15 => self.step_secs.min(SHARE_OF_PACE * bodies.pace_secs().0),
            Scheme::Verlet | Scheme::Yoshida6 => self.step_secs,
        }
    }

    /// The first pair that comes nearer to each other within an even step than it follows: that takes longer than a
    /// part of the fall towards each other, (r³ / μ)^(1/2).
    fn unfollowed(&self, bodies: &Bodies, before: &[Mass], step_secs: f64) -> Option<[usize; 2]> {
        if self.scheme == Scheme::Radau15 {
            return None;
        }
        let (masses, fall_secs) = (bodies.masses(), step_secs / (MARGIN * self.scheme.longest()));
        let is_near = |[a, b]: &[usize; 2]| {
            let near_m = libm::cbrt((masses[*a].gravity + masses[*b].gravity) * fall_secs * fall_secs);
            Sweep::new([[before[*a], before[*b]], [masses[*a], masses[*b]]], step_secs).first_within(near_m).is_some()
        };
        let real = |body: &usize| !bodies.is_point(*body);
        let pairs = (0..masses.len()).filter(real).flat_map(|b| (0..b).filter(real).map(move |a| [a, b]));
        pairs.into_iter().find(is_near)
    }
}

/// The least pace of an orbit at its periapsis, as of [`Bodies::pace_secs`], and the number of its body. Infinite, and
/// that of the root, if there is no orbit.
fn shortest_pace(system: &System) -> (f64, usize) {
    let (ephemeris, parents) = (Ephemeris::new(system), system.parents());
    let pace_secs = |body: usize| -> Option<f64> {
        let (orbit, parent) = (ephemeris.orbit(body)?, &system.bodies[parents[body]?]);
        let e = orbit.eccentricity;
        let nearest_m = orbit.semi_major_m * (1.0 - e);
        let moves = orbit.mean_motion.powi(2) * (1.0 + e) / (1.0 - e).powi(3);
        // About a point the attraction is that of the others, which the period tells.
        let falls = match parent.is_point() {
            true => orbit.mean_motion.powi(2) / (1.0 - e).powi(3),
            false => (parent.gravity_m3_s2() + system.bodies[body].gravity_m3_s2()) / nearest_m.powi(3),
        };
        Some(1.0 / (moves + falls).sqrt())
    };
    let all = (0..system.bodies.len()).filter_map(|body| Some((pace_secs(body)?, body)));
    all.fold((f64::INFINITY, 0), |least, other| if other.0 < least.0 { other } else { least })
}

fn shortest_period_secs(system: &System) -> f64 {
    let ephemeris = Ephemeris::new(system);
    let orbits = (0..system.bodies.len()).filter_map(|body| ephemeris.orbit(body));
    orbits.map(super::kepler::Ellipse::period_secs).fold(f64::INFINITY, f64::min)
}

/// A time in hours.
fn hours(secs: f64) -> String {
    format!("{} hours", rounded_down(secs / 3600.0))
}

/// A number to three digits, never more than it is: what is named as the most must be allowed.
fn rounded_down(value: f64) -> f64 {
    let scale = libm::pow(10.0, (2.0 - libm::floor(libm::log10(value.max(1e-300)))).clamp(0.0, 300.0));
    (value * scale).floor() / scale
}

/// What is looked for in each step.
struct Watch<'a> {
    radii_m: &'a [f64],
    parents: Vec<Option<usize>>,
    hill_m: Vec<f64>,
    /// For a body about a point: all others that the point carries and that do not go with the body.
    around: Vec<Vec<usize>>,
}

impl<'a> Watch<'a> {
    fn new(system: &'a System, radii_m: &'a [f64]) -> Self {
        let parents = system.parents();
        let around = |body: usize| -> Vec<usize> {
            let Some(point) = parents[body].filter(|parent| system.bodies[*parent].is_point()) else {
                return Vec::new();
            };
            let others = (0..parents.len()).filter(|other| *other != body && !system.carries(body, *other));
            others.filter(|other| system.carries(point, *other)).collect()
        };
        let around = (0..parents.len()).map(around).collect();
        Self { radii_m, hill_m: limits::hill_radii_m(system), around, parents }
    }

    /// Looks at a step that led to bodies from what was before.
    fn look(&self, bodies: &Bodies, before: &[Mass], step_secs: f64, events: &mut Vec<Event>) {
        let (masses, known) = (bodies.masses(), events.len());
        let start_secs = bodies.time_secs() - step_secs;
        let mut tell = |time_secs: f64, pair: [usize; 2], kind: EventKind| {
            if !events.iter().any(|event| event.bodies == pair && event.kind == kind) {
                events.push(Event { time_secs, bodies: pair, kind });
            }
        };
        let radius_m = |body: usize| self.radii_m.get(body).copied().unwrap_or(0.0);
        for i in (0..masses.len()).filter(|body| !bodies.is_point(*body)) {
            for j in (0..i).filter(|body| !bodies.is_point(*body)) {
                let sweep = Sweep::new([[before[j], before[i]], [masses[j], masses[i]]], step_secs);
                let touch_m = radius_m(i) + radius_m(j);
                let are_siblings = self.parents[i] == self.parents[j];
                let hill_m = self.hill_m[i].max(self.hill_m[j]);
                let met_m = if are_siblings && hill_m.is_finite() { hill_m.max(touch_m) } else { touch_m };
                if let Some(met) = sweep.first_within(met_m) {
                    if met_m > touch_m {
                        tell(start_secs + met * step_secs, [i, j], EventKind::Encounter);
                    }
                    if let Some(touched) = sweep.first_within(touch_m) {
                        tell(start_secs + touched * step_secs, [i, j], EventKind::Collision);
                    }
                }
                if self.parents[i] == Some(j) && self.flees(masses, i, j) {
                    tell(bodies.time_secs(), [i, j], EventKind::Escape);
                }
            }
            if let Some(point) = self.parents[i].filter(|parent| bodies.is_point(*parent))
                && self.flees_from_point(masses, i)
            {
                tell(bodies.time_secs(), [i, point], EventKind::Escape);
            }
        }
        events[known..].sort_by(|a, b| a.time_secs.total_cmp(&b.time_secs));
        // Nothing that follows a collision within the step is known.
        if let Some(first) = events[known..].iter().position(|event| event.kind == EventKind::Collision) {
            events.truncate(known + first + 1);
        }
    }

    /// Whether a body leaves its parent.
    fn flees(&self, masses: &[Mass], body: usize, parent: usize) -> bool {
        let apart_m = (masses[body].position_m - masses[parent].position_m).length();
        let square = (masses[body].velocity - masses[parent].velocity).length_squared();
        // Moons are held by less than the star's pull; the planets' own escape is that from the star.
        0.5 * square > (masses[body].gravity + masses[parent].gravity) / apart_m || apart_m > self.hill_m[parent]
    }

    /// Whether a body leaves all others about its point.
    fn flees_from_point(&self, masses: &[Mass], body: usize) -> bool {
        let Some((_, velocity)) = center(masses, &self.around[body]) else { return false };
        let away_m = |other: usize| (masses[other].position_m - masses[body].position_m).length();
        let pulls = self.around[body].iter().map(|other| masses[*other].gravity / away_m(*other));
        let held: f64 = self.around[body].iter().map(|other| masses[*other].gravity).sum();
        // The others recoil from the body's own mass.
        let share = 1.0 + masses[body].gravity / held;
        0.5 * (masses[body].velocity - velocity).length_squared() > share * pulls.sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::shipped;

    #[test]
    fn a_trial_ends_after_its_most_steps() {
        let system = shipped::ALL[0].load().unwrap();
        let radii_m = vec![0.0; system.bodies.len()];
        let mut plan = Plan::new(&system, &radii_m, Scheme::Radau15, YEAR_SECS, None).unwrap();
        plan.most_steps = 50;
        let trial = plan.run(&mut |_, _| true);
        assert!(matches!(trial.ending, Ending::TooManySteps(_)) && trial.steps == 50);
        let doubts = trial.doubts(&system);
        assert!(doubts[0].contains("Garland and Hoarfrost turn too fast"), "{doubts:?}");
    }

    #[test]
    fn times_are_told_with_three_digits_and_never_too_long() {
        assert_eq!(rounded_down(3.168_8), 3.16);
        for (secs, told) in [(3600.0 * 2.3499, "2.34 hours"), (3600.0 * 1234.5, "1234 hours"), (3.6, "0.001 hours")] {
            assert_eq!(hours(secs), told);
        }
    }
}
