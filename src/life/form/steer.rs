//! Search for the fill and the flatness of a coarse level with which it covers as much as the nearest one, from the
//! side and from above.

use super::math::{exp, ln};
use super::sight::Sights;
use glam::Vec2;

/// Weights of the covers from the side and from above, where both cannot be had.
const WEIGHTS: Vec2 = Vec2::new(1.0, 0.35);
/// Resistance to steps of a knob that does little.
const DAMPING: f32 = 0.015;
/// Least and largest logarithms of fill and flatness.
const BOUNDS: [Vec2; 2] = [Vec2::new(-3.0, -0.7), Vec2::new(2.5, 0.7)];
/// Longest step along each logarithm.
const STRIDE: Vec2 = Vec2::splat(0.9);

/// Secant search in two dimensions (Broyden 1965). All is in logarithms: knobs are fill in x and flatness in y, covers
/// are from the side in x and from above in y.
pub(super) struct Search {
    knobs: Vec2,
    /// Change of the covers with fill and with flatness, as far as it is known.
    effects: [Vec2; 2],
    /// Last step of the knobs, and the covers before it.
    last: Option<(Vec2, Vec2)>,
}

impl Search {
    /// Search that begins with neither more nor less of both; the effects are those of most kinds.
    pub(super) fn new() -> Self {
        Self { knobs: Vec2::ZERO, effects: [Vec2::splat(0.6), Vec2::new(0.0, 1.1)], last: None }
    }

    /// Factors `fill` and `flat` of a `Detail`.
    pub(super) fn knobs(&self) -> [f32; 2] {
        [exp(self.knobs.x), exp(self.knobs.y)]
    }

    /// Step from what was seen with the present knobs towards `near`; false where none is left.
    pub(super) fn step(&mut self, near: &Sights, seen: &Sights) -> bool {
        let seen = covers(seen);
        if let Some((step, before)) = self.last {
            self.learn(step, seen - before);
        }
        let wanted = covers(near) - seen;
        let free = solved(wanted, self.effects);
        let mut step = self.held(free);
        if step.y != free.y {
            // What flatness cannot do at its bound is left to fill.
            let rest = wanted - self.effects[1] * step.y;
            step = self.held(Vec2::new(solved(rest, [self.effects[0], Vec2::ZERO]).x, step.y));
        }
        self.knobs += step;
        self.last = Some((step, seen));
        step.length_squared() > 4e-4
    }

    /// Step within the bounds and the stride.
    fn held(&self, step: Vec2) -> Vec2 {
        let step = step.clamp(-STRIDE, STRIDE);
        step.clamp(BOUNDS[0] - self.knobs, BOUNDS[1] - self.knobs)
    }

    /// Correction of the effects by what a step has changed.
    fn learn(&mut self, step: Vec2, change: Vec2) {
        let [fill, flat] = &mut self.effects;
        // The noise of the pictures would drown a short step.
        let missed = (change - *fill * step.x - *flat * step.y) / step.length_squared().max(1e-3);
        *fill += missed * step.x;
        *flat += missed * step.y;
    }
}

/// Logarithms of the covers.
fn covers(sights: &Sights) -> Vec2 {
    Vec2::new(ln(sights.side.cover.max(1e-4)), ln(sights.top.cover.max(1e-4)))
}

/// Step of the knobs with wanted changes of the covers, in the sense of damped least squares.
fn solved(wanted: Vec2, effects: [Vec2; 2]) -> Vec2 {
    let [fill, flat] = effects.map(|effect| effect * WEIGHTS);
    let wanted = wanted * WEIGHTS;
    let (aa, ab, bb) = (fill.dot(fill) + DAMPING, fill.dot(flat), flat.dot(flat) + DAMPING);
    let (a, b) = (fill.dot(wanted), flat.dot(wanted));
    Vec2::new(a * bb - b * ab, b * aa - a * ab) / (aa * bb - ab * ab)
}
