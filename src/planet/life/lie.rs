//! Lie: what populations ask of water near and of ridges and hollows. Most ask for nothing, which costs nothing.

use super::Population;

/// Distance from water from which on a greatest distance is none.
pub(super) const ANY_BANK_M: f64 = 10_000.0;
/// Width over which a population thins out beyond the ends of its distances from water: metres, and a share of the end.
const SOFT_BANK: (f64, f64) = (2.0, 0.25);
/// Curvature over which it thins out beyond the ends of its curvatures.
const SOFT_CURVATURE: f64 = 0.02;

/// Whether a field has the value that asks for nothing. Such fields are not written.
pub(super) fn is<const ANY: i64>(value: &f64) -> bool {
    *value == ANY as f64
}

impl Population {
    /// Whether the population asks for a distance from water.
    pub(crate) fn asks_bank(&self) -> bool {
        self.bank_from_m > 0.0 || self.bank_to_m < ANY_BANK_M
    }

    /// Whether the population asks for a curvature of the ground.
    pub(crate) fn asks_curvature(&self) -> bool {
        self.curvature_from > -1.0 || self.curvature_to < 1.0
    }

    /// Whether the population asks for either.
    pub(crate) fn asks_lie(&self) -> bool {
        self.asks_bank() || self.asks_curvature()
    }

    /// Takes over from an older population that it asks for no distance from water and no curvature: a bound on one
    /// that stands anywhere is no small change.
    pub(crate) fn ask_no_more_than(&mut self, old: &Self) {
        for (own, old, any) in [
            (&mut self.bank_from_m, old.bank_from_m, 0.0),
            (&mut self.bank_to_m, old.bank_to_m, ANY_BANK_M),
            (&mut self.curvature_from, old.curvature_from, -1.0),
            (&mut self.curvature_to, old.curvature_to, 1.0),
        ] {
            if old == any {
                *own = any;
            }
        }
    }

    /// Share of the density at a distance from water; infinity where none is known.
    pub(crate) fn by_bank(&self, bank_m: f64) -> f64 {
        let within = |beyond_m: f64, end_m: f64| share(beyond_m, SOFT_BANK.0 + SOFT_BANK.1 * end_m);
        let far = if self.bank_from_m > 0.0 { within(self.bank_from_m - bank_m, self.bank_from_m) } else { 1.0 };
        let near = if self.bank_to_m < ANY_BANK_M { within(bank_m - self.bank_to_m, self.bank_to_m) } else { 1.0 };
        far * near
    }

    /// Greatest distance from water at which any of the population stands; infinity if there is none.
    pub(crate) fn farthest_bank_m(&self) -> f64 {
        let is_bound = self.bank_to_m < ANY_BANK_M;
        if is_bound { self.bank_to_m * (1.0 + SOFT_BANK.1) + SOFT_BANK.0 } else { f64::INFINITY }
    }

    /// Share of the density on ground of a curvature.
    pub(crate) fn by_curvature(&self, curvature: f64) -> f64 {
        let low = if self.curvature_from > -1.0 { share(self.curvature_from - curvature, SOFT_CURVATURE) } else { 1.0 };
        let high = if self.curvature_to < 1.0 { share(curvature - self.curvature_to, SOFT_CURVATURE) } else { 1.0 };
        low * high
    }
}

/// 1 up to the end of a range, 0 from `soft` beyond it on.
fn share(beyond: f64, soft: f64) -> f64 {
    (1.0 - beyond.max(0.0) / soft).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, random};

    #[test]
    fn who_asks_for_nothing_stands_anywhere_and_says_nothing() {
        let any = Population::default();
        assert!(!any.asks_lie() && any.farthest_bank_m() == f64::INFINITY);
        for far in [0.0, 1e9, f64::INFINITY] {
            assert_eq!((any.by_bank(far), any.by_curvature(far), any.by_curvature(-far)), (1.0, 1.0, 1.0));
        }
        let text = |life: Population| Planet { life: vec![life], ..Planet::default() }.to_text();
        assert!(!text(any.clone()).contains("bank_") && !text(any.clone()).contains("curvature_"));
        let reeds = Population { bank_to_m: 10_000.0_f64.next_down(), curvature_from: -0.5, ..any };
        let saved = text(reeds.clone());
        assert!(saved.contains("bank_to_m") && saved.contains("curvature_from") && !saved.contains("bank_from_m"));
        assert_eq!(Planet::from_text("saved", &saved).unwrap().life, [reeds]);
    }

    #[test]
    fn variations_ask_for_nothing_new() {
        let reeds = Population { bank_to_m: 8.0, ..Population::default() };
        let planet = Planet { life: vec![Population::default(), reeds], ..Planet::default() };
        for seed in 0..20 {
            let varied = random::vary(&planet, seed, 0.8).life;
            assert!(!varied[0].asks_lie() && !varied[1].asks_curvature() && varied[1].bank_to_m < 100.0, "{seed}");
        }
    }

    #[test]
    fn the_ends_of_ranges_thin_out() {
        let reeds = Population { bank_from_m: 4.0, bank_to_m: 8.0, ..Population::default() };
        let shares = [0.0, 1.0, 2.5, 4.0, 8.0, 10.0, 12.0, f64::INFINITY].map(|bank_m| reeds.by_bank(bank_m));
        assert_eq!(shares, [0.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.0, 0.0]);
        assert_eq!(reeds.farthest_bank_m(), 12.0);
        let far = Population { bank_from_m: 100.0, ..Population::default() };
        assert_eq!((far.by_bank(0.0), far.by_bank(f64::INFINITY)), (0.0, 1.0));
        let gully = Population { curvature_to: -0.1, ..Population::default() };
        assert_eq!([-3.0, -0.1, -0.08, 0.5].map(|curvature| gully.by_curvature(curvature)), [1.0, 1.0, 0.0, 0.0]);
    }
}
