//! Uniforms of rings.

use super::Body;
use crate::planet::Planet;
use crate::rings::{Profile, RINGLET_OCTAVES};
use glam::DVec4;

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
