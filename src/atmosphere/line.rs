//! A straight ray over a sphere. Everything is worked out from altitudes, never from |p|^2 - R^2, as in the shaders.

/// A ray from an altitude at an angle to the zenith; lengths in kilometres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) radius: f64,
    pub(super) altitude: f64,
    /// Cosine of the angle to the zenith where the ray begins.
    pub(super) mu: f64,
}

impl Line {
    /// Altitude after a way `t`.
    pub(super) fn altitude_at(&self, t: f64) -> f64 {
        let r = self.radius + self.altitude;
        let grown = t * (t + 2.0 * r * self.mu);
        self.altitude + grown / (r + (r * r + grown).max(0.0).sqrt())
    }

    /// Where the ray enters and leaves the sphere at an altitude; `None` when it passes by. Negative is behind.
    pub(super) fn meets(&self, altitude: f64) -> Option<(f64, f64)> {
        let b = (self.radius + self.altitude) * self.mu;
        let c = (self.altitude - altitude) * (2.0 * self.radius + self.altitude + altitude);
        let discriminant = b * b - c;
        if discriminant < 0.0 {
            return None;
        }
        // The root that does not cancel, and the other from the product of both.
        let q = if b >= 0.0 { -b - discriminant.sqrt() } else { -b + discriminant.sqrt() };
        let other = if q == 0.0 { 0.0 } else { c / q };
        Some((q.min(other), q.max(other)))
    }

    /// Way to the ground, if the ray meets it.
    pub(super) fn ground(&self) -> Option<f64> {
        self.meets(0.0).map(|(near, _)| near).filter(|near| *near >= 0.0 && self.mu < 0.0)
    }

    /// The part within the air that ends at `top`, up to the ground.
    pub(super) fn within(&self, top: f64) -> Option<Way> {
        let (near, far) = self.meets(top)?;
        let (from, to) = (near.max(0.0), self.ground().map_or(far, |ground| ground.min(far)));
        let middle = -(self.radius + self.altitude) * self.mu;
        (to > from).then(|| Way { from, to, middle: middle.clamp(from, to) })
    }
}

/// A part of a ray, and its lowest point, where air is densest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) middle: f64,
}

impl Way {
    /// The range of `w` with t = middle + w|w|, which crowds even steps about the middle.
    pub(super) fn bent_range(&self) -> (f64, f64) {
        (-(self.middle - self.from).sqrt(), (self.to - self.middle).sqrt())
    }

    /// Even steps of `w`: the middle of each on the ray, and its length.
    pub(super) fn steps(self, count: u32) -> impl Iterator<Item = (f64, f64)> {
        let (start, end) = self.bent_range();
        let step = (end - start) / f64::from(count);
        let bent = move |w: f64| self.middle + w * w.abs();
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
