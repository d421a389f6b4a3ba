//! Uniforms of the bodies that may cover a sun of another body.

use super::Body;
use crate::render::scene::{self, Scene};
use crate::render::shared::{MAX_OCCLUDERS, Occluder};
use glam::{DVec3, Vec3};

/// Share of the sunlight that air like the Earth's bends into the shadow of its planet: the light of a total eclipse of
/// the Moon, about a ten-thousandth and copper red.
const BENT: Vec3 = Vec3::new(4.0e-4, 7.0e-5, 1.6e-5);

/// Sets the bodies of the scene that may shade a body, the nearest first. `suns`: the lights at the body.
pub(super) fn of(out: &mut Body, scene: &Scene<'_>, body: &scene::Body<'_>, suns: impl Iterator<Item = scene::Sun>) {
    let radius_m = body.planet().radius_m();
    let stars: Vec<scene::Sun> = suns.filter(|sun| sun.has_disc).collect();
    let mut near: Vec<(f64, &scene::Body<'_>)> = scene
        .bodies
        .iter()
        .filter(|other| other.id != body.id)
        .map(|other| (other, other.position_m - body.position_m, other.planet().radius_m()))
        .filter(|(_, away_m, other_m)| stars.iter().any(|star| may_cover(star, *away_m, *other_m, radius_m)))
        .map(|(other, away_m, _)| (away_m.length(), other))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.truncate(MAX_OCCLUDERS);
    out.occluder_count = near.len() as u32;
    let body_from_scene = body.scene_from_body.inverse();
    for (slot, (_, other)) in out.occluders.iter_mut().zip(near) {
        let planet = other.planet();
        *slot = Occluder {
            center_km: (body_from_scene * (other.position_m - body.position_m) * 1e-3).as_vec3(),
            radius_km: planet.radius_km as f32,
            glow: if planet.atmosphere.is_some() { BENT } else { Vec3::ZERO },
        };
    }
}

/// Whether a neighbour covers a part of a star somewhere on a body. `away_m`: the neighbour's centre from the body's.
fn may_cover(star: &scene::Sun, away_m: DVec3, occluder_m: f64, radius_m: f64) -> bool {
    let along_m = away_m.dot(star.dir_scene);
    if along_m <= 0.0 || along_m >= star.distance_m {
        return false;
    }
    let aside_m = (away_m - star.dir_scene * along_m).length();
    // The penumbra widens from the occluder on, by the angular radius of the star.
    aside_m < occluder_m + along_m * star.radius_rad.tan() + radius_m * 1.05
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Star;

    #[test]
    fn shadows_are_looked_for_where_they_can_fall() {
        let star = scene::Sun::new(&Star::default(), DVec3::X);
        let covers = |moon_m: DVec3| may_cover(&star, moon_m, 1.737e6, 6.371e6);
        assert!(covers(DVec3::new(3.844e8, 0.0, 0.0)));
        assert!(covers(DVec3::new(3.844e8, 9.5e6, 0.0)), "the penumbra touches the limb");
        assert!(!covers(DVec3::new(3.844e8, 3.0e7, 0.0)) && !covers(DVec3::new(-3.844e8, 0.0, 0.0)));
        let near = scene::Sun { distance_m: 1e8, ..star };
        assert!(!may_cover(&near, DVec3::new(3.844e8, 0.0, 0.0), 1.737e6, 6.371e6), "it is behind the star");
    }
}
