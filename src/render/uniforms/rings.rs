//! Uniforms of rings.

use super::Body;
use crate::lod::Quality;
use crate::planet::Planet;
use crate::render::shared::RingClass;
use crate::rings::{Pieces, Profile, RINGLET_OCTAVES, SIZE_CLASSES};
use glam::{DVec2, DVec3, DVec4, UVec2, Vec2};

/// Angle by which the grid of each class is turned against that of the one before: the golden angle, so that no two
/// lie alike.
const TURN_RAD: f64 = 2.399_963;

/// Sets the rings of a planet.
pub(super) fn of(out: &mut Body, planet: &Planet) {
    let Some(profile) = Profile::new(planet) else { return };
    out.ring_count = 1;
    out.ring_inner_km = (profile.inner_m * 1e-3) as f32;
    out.ring_outer_km = (profile.outer_m * 1e-3) as f32;
    out.ringlets = profile.ringlets as f32;
    out.ringlet_count = profile.ringlet_count as f32;
    out.ringlet_octaves = if profile.ringlets > 0.0 { RINGLET_OCTAVES } else { 0 };
    out.ring_seed = profile.seed;
    out.ring_dust = profile.dust as f32;
    for (slot, entry) in out.ring_profile.iter_mut().zip(&profile.entries) {
        *slot = DVec4::from_array(*entry).as_vec4();
    }
}

/// Sets the pieces of the rings around an eye. `pixel_rad`: angle of a pixel.
pub(super) fn from_eye(out: &mut Body, planet: &Planet, eye_m: DVec3, quality: Quality, pixel_rad: f32) {
    let Some(pieces) = Pieces::new(planet) else { return };
    let pixel_rad = f64::from(pixel_rad);
    let reach_m = pieces.reach_m(0, pixel_rad);
    let half_m = 0.5 * pieces.thickness_m + pieces.classes[0].radius_m;
    if eye_m.z.abs() >= half_m + reach_m || pieces.share <= 0.0 {
        return;
    }
    let Some(profile) = Profile::new(planet) else { return };
    let away_m = eye_m.truncate().length();
    if !(profile.inner_m - reach_m..profile.outer_m + reach_m).contains(&away_m) {
        return;
    }
    (out.ring_class_count, out.ring_facets) = (SIZE_CLASSES as u32, 4);
    (out.ring_steps, out.ring_tries) = match quality {
        Quality::Low => (16, 3),
        Quality::Medium => (28, 4),
        Quality::High => (44, 6),
    };
    out.ring_thickness_m = pieces.thickness_m as f32;
    out.ring_eye_m = eye_m.z as f32;
    out.ring_edges_m = DVec2::new(profile.inner_m - away_m, profile.outer_m - away_m).as_vec2();
    // Within sight of the pieces, the depth is all but linear.
    let near_m = away_m.clamp(profile.inner_m, profile.outer_m);
    let depth = |at_m: f64| profile.at(at_m.clamp(profile.inner_m, profile.outer_m), 0.0)[3];
    let slope = (depth(near_m + SLOPE_M) - depth(near_m - SLOPE_M)) / (2.0 * SLOPE_M);
    out.ring_depth = Vec2::new((depth(near_m) + slope * (away_m - near_m)) as f32, slope as f32);
    for (number, (slot, class)) in out.ring_classes.iter_mut().zip(&pieces.classes).enumerate() {
        let turn = DVec2::from_angle(TURN_RAD * number as f64);
        // Against the turn: from the body's axes to those of the grid.
        let place = DVec2::new(turn.x, -turn.y).rotate(eye_m.truncate()) / class.cell_m;
        let first = place.floor();
        let wrapped = |cell: f64| cell.rem_euclid(f64::from(u32::MAX) + 1.0) as u32;
        *slot = RingClass {
            eye: (place - first).extend((eye_m.z + 0.5 * pieces.thickness_m) / class.layer_m).as_vec3(),
            cell_m: class.cell_m as f32,
            turn: turn.as_vec2(),
            first: UVec2::new(wrapped(first.x), wrapped(first.y)),
            layer_m: class.layer_m as f32,
            layers: class.layers,
            radius_m: class.radius_m as f32,
            chance: class.chance as f32,
            crowding: class.crowding as f32,
            reach_m: pieces.reach_m(number, pixel_rad) as f32,
            search_m: (f64::from(out.ring_steps) * class.cell_m / CELLS_ON_THE_WAY) as f32,
            seed: profile.seed.wrapping_add((number as u32).wrapping_mul(0x9E37_79B9)),
        };
    }
}

/// Distance over which the change of the optical depth is taken.
const SLOPE_M: f64 = 2000.0;
/// Cells that a slanted ray crosses on a way as long as a cell is wide.
const CELLS_ON_THE_WAY: f64 = 1.45;
