//! Optical depth from a point to the top of the air.

use super::line::{Line, Segment, horizon_mu};
use super::medium::Medium;
use glam::DVec3;
use rayon::prelude::*;

/// Steps of the integral. For air like the Earth's, the result is within 2e-5 of the one with 10,000 steps.
const STEPS: u32 = 120;

/// Optical depth along a ray to the top of the air, or to the ground.
pub(super) fn to_top(medium: &Medium, line: &Line) -> DVec3 {
    line.within(medium.top).map_or(DVec3::ZERO, |segment| integral(medium, line, segment))
}

fn integral(medium: &Medium, line: &Line, segment: Segment) -> DVec3 {
    segment.steps(STEPS).map(|(t, length)| medium.at(line.altitude_at(t)).extinction * length).sum()
}

/// Optical depth to the top of the air as a LUT by altitude and zenith angle, for callers that need it very often. Its
/// rays miss the ground. Parametrisation: Bruneton and Neyret, Precomputed Atmospheric Scattering, 2008.
#[derive(Clone, Debug)]
pub(super) struct DepthLut {
    radius: f64,
    top: f64,
    texels: Vec<DVec3>,
}

/// Texels along the zenith angle and along the altitude.
const COLUMNS: usize = 384;
const ROWS: usize = 96;

impl DepthLut {
    pub(super) fn new(medium: &Medium, radius: f64) -> Self {
        let top = medium.top;
        let horizon2 = top * (2.0 * radius + top);
        let texel = |i: usize| {
            let (x, y) = ((i % COLUMNS) as f64 / (COLUMNS - 1) as f64, (i / COLUMNS) as f64 / (ROWS - 1) as f64);
            let rho = y * horizon2.sqrt();
            let altitude = rho * rho / (radius + (radius * radius + rho * rho).sqrt());
            let (shortest, longest) = (top - altitude, rho + horizon2.sqrt());
            let distance = shortest + x * (longest - shortest);
            let mu = match distance > 0.0 {
                true => (horizon2 - rho * rho - distance * distance) / (2.0 * (radius + altitude) * distance),
                false => 1.0,
            };
            // The lowest ray grazes the ground and continues beyond it.
            let line = Line { radius, altitude, mu: mu.clamp(horizon_mu(radius, altitude), 1.0) };
            let end = line.meets(top).map(|(_, far)| far.max(0.0)).unwrap_or_default();
            let lowest = (-(radius + altitude) * line.mu).clamp(0.0, end);
            integral(medium, &line, Segment { start: 0.0, end, lowest })
        };
        Self { radius, top, texels: (0..COLUMNS * ROWS).into_par_iter().map(texel).collect() }
    }

    /// Bilinear look-up. The ray must miss the ground.
    pub(super) fn at(&self, altitude: f64, mu: f64) -> DVec3 {
        let (radius, top) = (self.radius, self.top);
        let h = altitude.clamp(0.0, top);
        let rho2 = h * (2.0 * radius + h);
        let horizon2 = top * (2.0 * radius + top);
        let r = radius + h;
        let distance = (-r * mu + (r * r * mu * mu + horizon2 - rho2).max(0.0).sqrt()).max(0.0);
        let (shortest, longest) = (top - h, rho2.sqrt() + horizon2.sqrt());
        let x = ((distance - shortest) / (longest - shortest).max(1e-12)).clamp(0.0, 1.0) * (COLUMNS - 1) as f64;
        let y = (rho2 / horizon2).sqrt().clamp(0.0, 1.0) * (ROWS - 1) as f64;
        bilinear(x, y, COLUMNS, ROWS, |i| self.texels[i])
    }
}

/// Bilinear interpolation at `x`, `y` (in texels) of a LUT with the given numbers of columns and rows.
pub(super) fn bilinear(x: f64, y: f64, columns: usize, rows: usize, texel: impl Fn(usize) -> DVec3) -> DVec3 {
    let (i, j) = ((x as usize).min(columns - 2), (y as usize).min(rows - 2));
    let (u, v) = (x - i as f64, y - j as f64);
    let row = |j: usize| texel(j * columns + i).lerp(texel(j * columns + i + 1), u);
    row(j).lerp(row(j + 1), v)
}
