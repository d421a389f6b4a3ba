//! Uniforms of gas giants.

use super::{Body, rgb};
use crate::giant::{Bands, DETAIL_EDDIES, detail_octaves, eddy_seed};
use crate::planet::Planet;
use crate::render::shared::{FOG_TOP_KM, Storm};
use glam::{DVec3, DVec4, Vec4};

/// Sets the bands and storms of a giant at a time, and what an eye near it sees. `pixel_rad`: angle of a pixel.
pub(super) fn at(out: &mut Body, planet: &Planet, time_secs: f64, eye_m: DVec3, pixel_rad: f32) {
    let (Some(giant), Some(bands)) = (&planet.giant, Bands::new(planet)) else { return };
    out.is_giant = 1;
    out.giant_turbulence = giant.turbulence as f32;
    out.giant_eddy_radii = giant.eddy_radii as f32;
    out.giant_filaments = giant.filaments as f32;
    out.giant_bright = rgb(giant.zone_color.map(|c| c + 0.3 * (1.0 - c)));
    for (slot, entry) in out.giant_bands.iter_mut().zip(&bands.entries) {
        *slot = DVec4::from_array(*entry).as_vec4();
    }
    let seed = eddy_seed(planet) % 65_536;
    for (slot, (age_secs, weight, number)) in out.giant_tracings.iter_mut().zip(bands.tracings(time_secs)) {
        *slot = Vec4::new(age_secs as f32, weight as f32, ((seed + number * 97) % 65_536) as f32, 0.0);
    }
    let over_m = eye_m.length() - planet.radius_m();
    out.giant_octaves = detail_octaves(planet, over_m.max(0.0) * f64::from(pixel_rad));
    let wave_m = DETAIL_EDDIES * giant.eddy_radii * planet.radius_m();
    out.giant_detail_radii = (wave_m / planet.radius_m()) as f32;
    for (slot, (age_secs, weight, number)) in out.giant_detail.iter_mut().zip(bands.detail_tracings(time_secs)) {
        *slot = Vec4::new(age_secs as f32, weight as f32, ((seed + number * 89) % 65_536) as f32, 0.0);
    }
    out.is_in_giant = u32::from(over_m < FOG_TOP_KM * 1e3);
    out.giant_fog = rgb(bands.color((eye_m.z / eye_m.length().max(1.0)).clamp(-1.0, 1.0).asin()));
    let storms = bands.storms(planet, time_secs);
    out.giant_storm_count = storms.len() as u32;
    for (slot, storm) in out.giant_storms.iter_mut().zip(storms) {
        *slot = Storm {
            center: storm.center.as_vec3(),
            size: storm.size as f32,
            color: rgb(storm.color),
            spin: storm.spin as f32,
        };
    }
}
