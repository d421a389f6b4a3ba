//! What serde cannot see.
use super::Planet;
use super::param::ParamPath;

/// Everything that is wrong with a planet: where, and what would be right.
pub fn problems(planet: &Planet) -> Vec<(ParamPath, String)> {
    let _ = planet;
    Vec::new()
}
