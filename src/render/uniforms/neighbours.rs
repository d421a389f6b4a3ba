//! Uniforms of the bodies that may cover a sun of another body.

use super::Body;
use crate::render::scene::{self, Scene};
use crate::render::shared::{MAX_OCCLUDERS, Occluder};
use crate::system::light::may_shade;
use glam::Vec3;

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
        .filter(|(_, away_m, other_m)| stars.iter().any(|star| may_shade(&star.in_sky(), *away_m, *other_m, radius_m)))
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
