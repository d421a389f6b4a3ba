//! A straight ray over a sphere. All formulas use altitudes, as in the shaders: |p|^2 - R^2 would lose the digits of
//! the altitude.

/// A ray that starts at an altitude, at an angle to the zenith. Lengths are kilometres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Radius of the sphere.
    pub(super) radius: f64,
    pub(super) altitude: f64,
    /// Cosine of the zenith angle at the start of the ray.
    pub(super) mu: f64,
}

impl Line {
    /// Altitude at distance `t` along the ray.
    pub(super) fn altitude_at(&self, t: f64) -> f64 {
        let r = self.radius + self.altitude;
        let grown = t * (t + 2.0 * r * self.mu);
        self.altitude + grown / (r + (r * r + grown).max(0.0).sqrt())
    }

    /// Distances at which the ray's line crosses the sphere at an altitude; negative behind the start. `None` when it
    /// misses.
    pub(super) fn meets(&self, altitude: f64) -> Option<(f64, f64)> {
        let b = (self.radius + self.altitude) * self.mu;
        let c = (self.altitude - altitude) * (2.0 * self.radius + self.altitude + altitude);
        let discriminant = b * b - c;
        if discriminant < 0.0 {
            return None;
        }
        // The root without cancellation; the other follows from the product of both.
        let q = if b >= 0.0 { -b - discriminant.sqrt() } else { -b + discriminant.sqrt() };
        let other = if q == 0.0 { 0.0 } else { c / q };
        Some((q.min(other), q.max(other)))
    }

    /// Distance to the ground, if the ray hits it.
    pub(super) fn ground(&self) -> Option<f64> {
        self.meets(0.0).map(|(near, _)| near).filter(|near| *near >= 0.0 && self.mu < 0.0)
    }

    /// The part of the ray below the altitude `top` and above the ground.
    pub(super) fn within(&self, top: f64) -> Option<Segment> {
        let (near, far) = self.meets(top)?;
        let (start, end) = (near.max(0.0), self.ground().map_or(far, |ground| ground.min(far)));
        let lowest = -(self.radius + self.altitude) * self.mu;
        (end > start).then(|| Segment { start, end, lowest: lowest.clamp(start, end) })
    }
}

/// A part of a ray, as distances from its start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) start: f64,
    pub(super) end: f64,
    /// The lowest point, where the air is densest.
    pub(super) lowest: f64,
}

impl Segment {
    /// The range of `w` in t = lowest + w|w|: even steps of `w` are shortest at the lowest point.
    fn bent_range(&self) -> (f64, f64) {
        (-(self.lowest - self.start).sqrt(), (self.end - self.lowest).sqrt())
    }

    /// Even steps of `w`: for each the distance of its midpoint and its length.
    pub(super) fn steps(self, count: u32) -> impl Iterator<Item = (f64, f64)> {
        let (start, end) = self.bent_range();
        let step = (end - start) / f64::from(count);
        let bent = move |w: f64| self.lowest + w * w.abs();
        (0..count).map(move |i| {
            let w = start + f64::from(i) * step;
            (bent(w + 0.5 * step), bent(w + step) - bent(w))
        })
    }
}

/// Cosine of the zenith angle of the horizon.
pub(super) fn horizon_mu(radius: f64, altitude: f64) -> f64 {
    let h = altitude.max(0.0);
    -(h * (2.0 * radius + h)).sqrt() / (radius + h)
}
