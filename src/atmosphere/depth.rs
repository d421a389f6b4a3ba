//! Optical depth from a place to the top of the air.

use super::line::Line;
use super::medium::Medium;
use glam::DVec3;
use rayon::prelude::*;

/// Steps of the exact integral: within 2e-5 of 10,000 steps for air like the Earth's.
const STEPS: u32 = 120;

/// Optical depth along a ray up to the top of the air, or to the ground.
pub(super) fn to_top(medium: &Medium, line: &Line) -> DVec3 {
    let way = line.within(medium.top);
    way.map_or(DVec3::ZERO, |way| {
        way.steps(STEPS).map(|(t, length)| medium.at(line.altitude_at(t)).extinction * length).sum()
    })
}

/// The same as a table by altitude and zenith angle of rays that miss the ground (mapping: Bruneton and Neyret,
/// Precomputed Atmospheric Scattering, 2008), for what would ask the integral too often.
#[derive(Clone, Debug)]
pub(super) struct DepthTable {
    radius: f64,
    top: f64,
    texels: Vec<DVec3>,
}

const ACROSS: usize = 384;
const UP: usize = 96;

impl DepthTable {
    pub(super) fn new(medium: &Medium, radius: f64) -> Self {
        let top = medium.top;
        let horizon2 = top * (2.0 * radius + top);
        let texel = |i: usize| {
            let (x, y) = ((i % ACROSS) as f64 / (ACROSS - 1) as f64, (i / ACROSS) as f64 / (UP - 1) as f64);
            let rho = y * horizon2.sqrt();
            let altitude = rho * rho / (radius + (radius * radius + rho * rho).sqrt());
            let (least, most) = (top - altitude, rho + horizon2.sqrt());
            let way = least + x * (most - least);
            let mu = match way > 0.0 {
                true => (horizon2 - rho * rho - way * way) / (2.0 * (radius + altitude) * way),
                false => 1.0,
            };
            // A ray that grazes the ground does not end there.
            let line = Line { radius, altitude, mu: mu.clamp(super::line::horizon_mu(radius, altitude), 1.0) };
            let whole = line.meets(top).map(|(_, far)| far.max(0.0)).unwrap_or_default();
            let middle = (-(radius + altitude) * line.mu).clamp(0.0, whole);
            let way = super::line::Way { from: 0.0, to: whole, middle };
            way.steps(STEPS).map(|(t, length)| medium.at(line.altitude_at(t)).extinction * length).sum()
        };
        Self { radius, top, texels: (0..ACROSS * UP).into_par_iter().map(texel).collect() }
    }

    /// Between the texels, linearly. The ray must miss the ground.
    pub(super) fn at(&self, altitude: f64, mu: f64) -> DVec3 {
        let (radius, top) = (self.radius, self.top);
        let h = altitude.clamp(0.0, top);
        let rho2 = h * (2.0 * radius + h);
        let horizon2 = top * (2.0 * radius + top);
        let r = radius + h;
        let way = (-r * mu + (r * r * mu * mu + horizon2 - rho2).max(0.0).sqrt()).max(0.0);
        let (least, most) = (top - h, rho2.sqrt() + horizon2.sqrt());
        let x = ((way - least) / (most - least).max(1e-12)).clamp(0.0, 1.0) * (ACROSS - 1) as f64;
        let y = (rho2 / horizon2).sqrt().clamp(0.0, 1.0) * (UP - 1) as f64;
        bilinear(x, y, ACROSS, UP, |i| self.texels[i])
    }
}

/// Value between the four texels about `x`, `y` (in texels) of a table of `across` by `up`.
pub(super) fn bilinear(x: f64, y: f64, across: usize, up: usize, texel: impl Fn(usize) -> DVec3) -> DVec3 {
    let (i, j) = ((x as usize).min(across - 2), (y as usize).min(up - 2));
    let (u, v) = (x - i as f64, y - j as f64);
    let row = |j: usize| texel(j * across + i).lerp(texel(j * across + i + 1), u);
    row(j).lerp(row(j + 1), v)
}
