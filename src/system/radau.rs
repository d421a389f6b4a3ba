//! The Gauss-Radau integrator of 15th order: close encounters and long ellipses to the digits of f64.
//!
//! Everhart, An efficient integrator that uses Gauss-Radau spacings, 1985; compensated sums and the test of
//! convergence as in Rein and Spiegel, IAS15, MNRAS 446, 2015. Within a step the acceleration of each body is a
//! polynomial of 7th degree of the share of the step, found by iteration at seven nodes. Unlike theirs, the step
//! follows from the state of all pairs ([`Bodies::pace_secs`](super::nbody::Bodies::pace_secs)): a moon is followed as
//! well as a planet, however small its part of the attraction.

use super::nbody::Mass;
use glam::DVec3;

/// Nodes of the step, as shares of it: zero, and the roots of the Radau polynomial.
const NODES: [f64; 8] = [
    0.0,
    0.056_262_560_536_922_15,
    0.180_240_691_736_892_36,
    0.352_624_717_113_169_6,
    0.547_153_626_330_555_4,
    0.734_210_177_215_410_5,
    0.885_320_946_839_095_8,
    0.977_520_613_561_287_5,
];
/// Coefficients of the powers of the share, from the first, in Newton's polynomials: s, s (s - s1) and so on.
const NEWTON: [[f64; 7]; 7] = newton();
/// Binomial coefficients: the number of choices of `k` from `n` in row `k`, column `n`.
const CHOOSE: [[f64; 8]; 8] = choose();
/// Most iterations of a step, and the change of the last coefficient, as a share of the acceleration, that ends them.
const MOST_ITERATIONS: usize = 12;
const CONVERGED: f64 = 1e-16;
/// Change that is too much after all iterations: the step is too long.
const DIVERGED: f64 = 1e-9;
/// Greatest factor from step to step over which the polynomial tells the next one.
const MOST_GROWTH: f64 = 20.0;

const fn newton() -> [[f64; 7]; 7] {
    let mut all = [[0.0; 7]; 7];
    all[0][0] = 1.0;
    let mut k = 1;
    while k < 7 {
        let mut power = 0;
        while power < 7 {
            let below = if power > 0 { all[k - 1][power - 1] } else { 0.0 };
            all[k][power] = below - NODES[k] * all[k - 1][power];
            power += 1;
        }
        k += 1;
    }
    all
}

const fn choose() -> [[f64; 8]; 8] {
    let mut all = [[0.0; 8]; 8];
    let mut n = 0;
    while n < 8 {
        all[0][n] = 1.0;
        let mut k = 1;
        while k <= n {
            all[k][n] = all[k - 1][n - 1] + all[k][n - 1];
            k += 1;
        }
        n += 1;
    }
    all
}

/// Gives the accelerations of masses at positions.
pub(super) type Attract<'a> = dyn Fn(&[Mass], &[DVec3], &mut [DVec3]) + 'a;

/// A polynomial of the share of a step, without its constant: coefficients from the first power on.
type Polynomial = [DVec3; 7];

/// What the integrator keeps of a body from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Kept {
    /// Acceleration over that at the start, by powers, as it was found and as it was foretold.
    found: Polynomial,
    foretold: Polynomial,
    /// What the sums of position and velocity have lost to rounding.
    lost_m: DVec3,
    lost_velocity: DVec3,
}

/// The state of the integrator.
#[derive(Clone, Debug, Default)]
pub(super) struct Radau {
    kept: Vec<Kept>,
    /// Seconds of the last step; 0 before the first.
    last_secs: f64,
}

impl Radau {
    /// Moves masses on by a step. `attract` gives the accelerations at positions. Gives false, and leaves the masses
    /// where they are, if the step is too long for the iteration.
    pub(super) fn step(&mut self, masses: &mut [Mass], step_secs: f64, attract: &Attract<'_>) -> bool {
        self.kept.resize(masses.len(), Kept::default());
        let mut positions_m: Vec<DVec3> = masses.iter().map(|mass| mass.position_m).collect();
        let mut start = vec![DVec3::ZERO; masses.len()];
        attract(masses, &positions_m, &mut start);
        let mut now = start.clone();
        let growth = if self.last_secs > 0.0 { step_secs / self.last_secs } else { f64::INFINITY };
        let mut found: Vec<Kept> = self.kept.iter().map(|kept| kept.next(growth)).collect();
        let mut differences: Vec<Polynomial> = found.iter().map(|kept| differences(&kept.found)).collect();
        let (mut change, mut last) = (f64::INFINITY, f64::INFINITY);
        for iteration in 0..MOST_ITERATIONS {
            for node in 1..NODES.len() {
                for (body, mass) in masses.iter().enumerate() {
                    let moved_m = mass.moved_m(&found[body].found, start[body], step_secs, NODES[node]);
                    positions_m[body] = mass.position_m + (moved_m - found[body].lost_m);
                }
                attract(masses, &positions_m, &mut now);
                change = 0.0;
                for body in 0..masses.len() {
                    let mut difference = (now[body] - start[body]) / NODES[node];
                    for before in 1..node {
                        difference = (difference - differences[body][before - 1]) / (NODES[node] - NODES[before]);
                    }
                    let more = difference - differences[body][node - 1];
                    differences[body][node - 1] = difference;
                    for (power, coefficient) in found[body].found.iter_mut().enumerate().take(node) {
                        *coefficient += more * NEWTON[node - 1][power];
                    }
                    let share = more.length() / now[body].length().max(f64::MIN_POSITIVE);
                    // A share that is no number stays: there is no convergence.
                    if share.is_nan() || share > change {
                        change = share;
                    }
                }
            }
            if change < CONVERGED || (iteration > 1 && change >= last) {
                break;
            }
            last = change;
        }
        // Near the digits of f64 the change wavers; above, the iteration has not found a polynomial.
        if change.is_nan() || change.min(last) >= DIVERGED {
            return false;
        }
        for (body, mass) in masses.iter_mut().enumerate() {
            let kept = &mut found[body];
            let moved_m = mass.moved_m(&kept.found, start[body], step_secs, 1.0);
            let gained: DVec3 = powers(&kept.found).map(|(power, value)| value / (power + 1.0)).sum();
            let faster = (start[body] + gained) * step_secs;
            add(&mut mass.position_m, &mut kept.lost_m, moved_m);
            add(&mut mass.velocity, &mut kept.lost_velocity, faster);
        }
        (self.kept, self.last_secs) = (found, step_secs);
        true
    }
}

impl Kept {
    /// What to begin the next step with, `growth` times as long as this one: the polynomial from the end of this step
    /// on, with the error that this step's own foretelling had.
    fn next(&self, growth: f64) -> Self {
        let mut next = Self { found: Polynomial::default(), foretold: Polynomial::default(), ..*self };
        if growth > MOST_GROWTH {
            return next;
        }
        let mut scale = 1.0;
        for (power, choose) in CHOOSE.iter().enumerate().skip(1) {
            scale *= growth;
            let shifted: DVec3 = (power..=7).map(|from| self.found[from - 1] * choose[from]).sum();
            next.foretold[power - 1] = shifted * scale;
            next.found[power - 1] = next.foretold[power - 1] + (self.found[power - 1] - self.foretold[power - 1]);
        }
        next
    }
}

impl Mass {
    /// How far it moves up to a share of a step, metres.
    fn moved_m(&self, found: &Polynomial, start: DVec3, step_secs: f64, share: f64) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (power, value) in powers(found).rev() {
            sum = (sum + value / ((power + 1.0) * (power + 2.0))) * share;
        }
        let secs = step_secs * share;
        self.velocity * secs + (start * 0.5 + sum) * (secs * secs)
    }
}

fn powers(polynomial: &Polynomial) -> impl DoubleEndedIterator<Item = (f64, DVec3)> + '_ {
    const POWERS: [f64; 7] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
    POWERS.into_iter().zip(polynomial.iter().copied())
}

/// Divided differences of a polynomial: its coefficients in Newton's polynomials.
fn differences(polynomial: &Polynomial) -> Polynomial {
    let mut rest = *polynomial;
    for k in (0..7).rev() {
        let top = rest[k];
        for power in 0..k {
            rest[power] -= top * NEWTON[k][power];
        }
    }
    rest
}

/// Adds to a sum and keeps what is lost to rounding (Kahan, 1965).
fn add(sum: &mut DVec3, lost: &mut DVec3, value: DVec3) {
    let value = value - *lost;
    let next = *sum + value;
    *lost = (next - *sum) - value;
    *sum = next;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_the_polynomial_in_the_other_basis() {
        let polynomial: Polynomial = std::array::from_fn(|k| DVec3::new(1.0 + k as f64, 0.5, -2.0 * k as f64));
        let found = differences(&polynomial);
        for share in [0.1, 0.6, 1.0] {
            let direct: DVec3 = powers(&polynomial).map(|(power, value)| value * f64::powf(share, power)).sum();
            let (mut newton, mut product) = (DVec3::ZERO, 1.0);
            for (k, value) in found.iter().enumerate() {
                product *= share - NODES[k];
                newton += *value * product;
            }
            assert!((direct - newton).length() < 1e-12, "{direct} {newton}");
        }
    }

    #[test]
    fn a_longer_step_continues_the_polynomial() {
        let found: Polynomial = std::array::from_fn(|k| DVec3::X * (1.0 + k as f64));
        let kept = Kept { found, foretold: found, ..Kept::default() };
        let next = kept.next(0.5);
        let value = |polynomial: &Polynomial, share: f64| -> f64 {
            powers(polynomial).map(|(power, value)| value.x * f64::powf(share, power)).sum()
        };
        // Half of the next step is a quarter of the last.
        let (expected, told) = (value(&found, 1.25) - value(&found, 1.0), value(&next.found, 0.5));
        assert!((told / expected - 1.0).abs() < 1e-12, "{told} {expected}");
        assert_eq!(kept.next(30.0).found, Polynomial::default());
    }
}
