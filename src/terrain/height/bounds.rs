//! The range of heights by interval arithmetic: each layer's noise may be anywhere in its range, independently of the
//! others.

use super::{CompiledLayer, CompiledMask, Edge, LayerStack, Source, Steps};
use crate::planet::Blend;
use glam::DVec3;

/// A closed interval.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };
    const UNIT: Interval = Interval { lo: 0.0, hi: 1.0 };

    /// The smallest interval that holds all values.
    fn of(values: &[f64]) -> Self {
        let (lo, hi) = values.iter().fold((f64::MAX, f64::MIN), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
        Self { lo, hi }
    }

    /// The image under a rising function.
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self { lo: function(self.lo), hi: function(self.hi) }
    }

    /// The image of two intervals under a function that rises with both.
    fn with(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self { lo: function(self.lo, other.lo), hi: function(self.hi, other.hi) }
    }

    fn times(self, o: Self) -> Self {
        Self::of(&[self.lo * o.lo, self.lo * o.hi, self.hi * o.lo, self.hi * o.hi])
    }

    /// A little wider, for rounding.
    fn widened(self) -> Self {
        let by = 1e-9 * self.lo.abs().max(self.hi.abs());
        Self { lo: self.lo - by, hi: self.hi + by }
    }
}

/// The directions within an angle of one; `None` is the whole planet.
type Near = Option<(DVec3, f64)>;

/// Discs wider than this are not split.
const WIDEST_SPLIT_RAD: f64 = 0.1;

/// Centres and angles of 19 discs that together cover a disc: a hexagon of hexagons, two rings around the central
/// one.
fn parts(dir_planet: DVec3, angle_rad: f64) -> impl Iterator<Item = (DVec3, f64)> {
    // The discs around the hexagons. The nearest gap is sqrt(13) of their radii away; 2% more for the sphere.
    let radius_rad = angle_rad / 3.6 * 1.02;
    let step_rad = angle_rad / 3.6 * 3.0_f64.sqrt();
    let (a, b) = dir_planet.any_orthonormal_pair();
    let cells = (-2..=2_i32).flat_map(|q| (-2..=2_i32).map(move |r| (q, r))).filter(|(q, r)| (q + r).abs() <= 2);
    cells.map(move |(q, r)| {
        let (q, r) = (f64::from(q), f64::from(r));
        let (x, y) = (step_rad * (q + 0.5 * r), step_rad * r * 0.75_f64.sqrt());
        ((dir_planet + a * x + b * y).normalize(), radius_rad)
    })
}

impl LayerStack {
    /// Lowest and greatest height over the whole planet. Conservative.
    pub(crate) fn bounds_m(&self) -> (f64, f64) {
        self.bounds(None)
    }

    /// Lowest and greatest height within an angle of a direction. Conservative.
    pub(crate) fn bounds_near_m(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        if angle_rad > WIDEST_SPLIT_RAD {
            return self.bounds(Some((dir_planet, angle_rad)));
        }
        // The looseness of bounds grows with the square of the angle, so smaller discs together are tighter.
        let parts =
            parts(dir_planet, angle_rad).map(|(dir_planet, angle_rad)| self.bounds(Some((dir_planet, angle_rad))));
        parts.fold((f64::MAX, f64::MIN), |(lo, hi), (low, high)| (lo.min(low), hi.max(high)))
    }

    fn bounds(&self, near: Near) -> (f64, f64) {
        let mut height = Interval::ZERO;
        for layer in self.layers.iter().filter(|layer| layer.enabled) {
            let mask = layer.masks.iter().fold(Interval { lo: 1.0, hi: 1.0 }, |product, mask| {
                product.with(self.mask(mask, height, near), |a, b| a * b)
            });
            let target = layer.joined(height, near);
            // For any mask, low heights come from low ones; between the ends of the mask they are linear.
            let share = |mask: f64| height.with(target, |h, t| h * (1.0 - mask) + t * mask);
            let (least, most) = (share(mask.lo), share(mask.hi));
            height = Interval { lo: least.lo.min(most.lo), hi: least.hi.max(most.hi) }.widened();
        }
        if let Some(curve) = &self.height_curve {
            let (lo, hi) = curve.range(height.lo, height.hi);
            height = Interval { lo, hi }.widened();
        }
        let (lowest_m, highest_m) = self.limits_m();
        (height.lo.clamp(lowest_m, highest_m), height.hi.clamp(lowest_m, highest_m))
    }

    fn mask(&self, mask: &CompiledMask, height: Interval, near: Near) -> Interval {
        let source = match mask.source {
            Source::Layer(layer) => self.layers[layer].noise(near),
            Source::Height => height,
            Source::Slope { .. } => Interval::UNIT,
            Source::Latitude { both } => {
                let sine = sine_of_latitude(near);
                match both {
                    true if sine.lo < 0.0 && sine.hi > 0.0 => Interval { lo: 0.0, hi: sine.hi.max(-sine.lo) },
                    true => Interval::of(&[sine.lo.abs(), sine.hi.abs()]),
                    false => sine,
                }
            }
        };
        let Edge { from, to, invert } = mask.edge;
        let step = |x: f64| {
            let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
            let step = t * t * (3.0 - 2.0 * t);
            if invert { 1.0 - step } else { step }
        };
        let Interval { lo, hi } = Interval::of(&[step(source.lo), step(source.hi)]).widened();
        Interval { lo: lo.max(0.0), hi: hi.min(1.0) }
    }
}

impl CompiledLayer {
    /// The layer's own noise.
    fn noise(&self, near: Near) -> Interval {
        let (lo, hi) = match near {
            Some((dir_planet, angle_rad)) => self.landform.bounds_near(dir_planet, angle_rad),
            None => self.landform.bounds(),
        };
        Interval { lo, hi }.widened()
    }

    /// The target of its blend with the height below.
    fn joined(&self, height: Interval, near: Near) -> Interval {
        let mut noise = match &self.steps {
            Some(steps) => steps.range(height, self.noise(near)),
            None => self.noise(near),
        };
        if let Some(curve) = &self.curve {
            let (lo, hi) = curve.range(noise.lo, noise.hi);
            noise = Interval { lo, hi }.widened();
        }
        let blend = self.blend;
        let noise = noise.map(|v| v + blend.bias);
        let output = noise.map(|v| v * blend.amplitude_m);
        let soft = |gap_m: f64| 0.25 * (blend.softness_m - gap_m.abs()).max(0.0).powi(2) / blend.softness_m;
        let target = match blend.kind {
            Blend::Add => height.with(output, |h, y| h + y),
            Blend::Subtract => height.with(Interval { lo: -output.hi, hi: -output.lo }, |h, y| h + y),
            Blend::Multiply => height.times(noise),
            Blend::Max => height.with(output, f64::max),
            Blend::Min => height.with(output, f64::min),
            Blend::Replace => output,
            Blend::SmoothMax => height.with(output, |h, y| h.max(y) + soft(y - h)),
            Blend::SmoothMin => height.with(output, |h, y| h.min(y) - soft(y - h)),
        };
        // The evaluator adds a share of the difference to the height below, and so rounds as coarsely as that.
        let rounding_m = 4.0 * f64::EPSILON * height.lo.abs().max(height.hi.abs());
        Interval { lo: target.lo - rounding_m, hi: target.hi + rounding_m }
    }
}

impl Steps {
    /// The distance of the ground from its step, in steps: see `steps::cut`.
    fn range(&self, height: Interval, waves: Interval) -> Interval {
        let place = height.with(waves, |height, wave| height / self.height_m + self.waviness * wave);
        let half = 0.5 * self.sharpness;
        // At most half a step either way, whatever the waviness.
        if !(place.hi - place.lo < 1.0 && place.lo.abs().max(place.hi.abs()) < 1e9) {
            return Interval { lo: -half, hi: half };
        }
        let riser = 0.5 - 0.4 * self.sharpness;
        let (start, per_riser) = (0.5 - riser, 0.5 / riser);
        let cut = |place: f64| {
            let t = place - place.floor();
            let s = ((t - start) * per_riser).clamp(0.0, 1.0);
            self.sharpness * (s * s * (3.0 - 2.0 * s) - t)
        };
        // The extremes lie where the riser is as steep as the ground.
        let turn = (0.25 - 1.0 / (6.0 * per_riser)).max(0.0).sqrt();
        let turns = [0.5 - turn, 0.5 + turn].map(|s| start + s / per_riser);
        let whole = [place.lo.floor(), place.lo.floor() + 1.0];
        let inner = whole.into_iter().flat_map(|whole| turns.map(|turn| whole + turn));
        let inner = inner.filter(|turn| (place.lo..=place.hi).contains(turn));
        let values: Vec<f64> = inner.chain([place.lo, place.hi]).map(cut).collect();
        let Interval { lo, hi } = Interval::of(&values);
        Interval { lo: lo - 1e-6, hi: hi + 1e-6 }
    }
}

/// The sine of the latitude.
fn sine_of_latitude(near: Near) -> Interval {
    let Some((dir_planet, angle_rad)) = near else { return Interval { lo: -1.0, hi: 1.0 }.widened() };
    let latitude_rad = libm::asin(dir_planet.z.clamp(-1.0, 1.0));
    let quarter = std::f64::consts::FRAC_PI_2;
    let sine = |latitude_rad: f64| libm::sin(latitude_rad.clamp(-quarter, quarter));
    Interval { lo: sine(latitude_rad - angle_rad), hi: sine(latitude_rad + angle_rad) }.widened()
}
