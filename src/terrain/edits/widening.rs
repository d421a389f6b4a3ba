//! What edits do to the bounds of heights. The lowest height falls by some amount, or to some level; the greatest
//! rises likewise. Such changes one after the other are such a change again, and so is the widest of several.

/// A change of the lowest and of the greatest height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Widening {
    /// By how much the lowest height falls at most, as a number below 0, and the lowest level that it falls to.
    lo: (f64, f64),
    /// By how much the greatest height rises at most, and the greatest level that it rises to.
    hi: (f64, f64),
}

impl Default for Widening {
    fn default() -> Self {
        Self { lo: (0.0, f64::INFINITY), hi: (0.0, f64::NEG_INFINITY) }
    }
}

impl Widening {
    /// Heights fall and rise by at most these amounts, both at least 0.
    pub(super) fn by(down_m: f64, up_m: f64) -> Self {
        Self { lo: (-down_m, f64::INFINITY), hi: (up_m, f64::NEG_INFINITY) }
    }

    /// Heights come to lie between these levels.
    pub(super) fn to(lo_m: f64, hi_m: f64) -> Self {
        Self { lo: (0.0, lo_m), hi: (0.0, hi_m) }
    }

    /// This change, and then another.
    pub(super) fn then(self, next: Self) -> Self {
        Self {
            lo: (self.lo.0 + next.lo.0, next.lo.1.min(self.lo.1 + next.lo.0)),
            hi: (self.hi.0 + next.hi.0, next.hi.1.max(self.hi.1 + next.hi.0)),
        }
    }

    /// Whichever of the two is wider.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            lo: (self.lo.0.min(other.lo.0), self.lo.1.min(other.lo.1)),
            hi: (self.hi.0.max(other.hi.0), self.hi.1.max(other.hi.1)),
        }
    }

    /// The bounds after the change.
    pub(super) fn of(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        ((lo + self.lo.0).min(self.lo.1), (hi + self.hi.0).max(self.hi.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_in_order_are_one_change() {
        let (raise, flatten) = (Widening::by(0.0, 500.0), Widening::to(-1000.0, -1000.0));
        let sink = Widening::by(300.0, 0.0);
        let all = raise.then(flatten).then(sink);
        for bounds in [(0.0, 0.0), (-5000.0, 200.0), (-900.0, 9000.0)] {
            assert_eq!(all.of(bounds), sink.of(flatten.of(raise.of(bounds))));
            let (lo, hi) = raise.or(sink).of(bounds);
            assert_eq!((lo, hi), (bounds.0 - 300.0, bounds.1 + 500.0));
        }
        assert_eq!(Widening::default().of((-1.0, 2.0)), (-1.0, 2.0));
    }
}
