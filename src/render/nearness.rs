//! How near the eye is to a body. Pipelines for distant views leave out the detail that no pixel of them resolves: an
//! `if` does not save it on adapters that run both branches, and its registers cost the others.

use super::shared::{Body, CLOUD_MAP_SIDE, WAVE_ACROSS, WAVE_LOST};
use std::f32::consts::FRAC_PI_2;

/// Distance of the eye from the nearest ground, water or cloud of a body, by what a pixel resolves there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Nearness {
    /// No texel of the cloud maps, no floe, no wave.
    Orbit,
    /// No foam, no caustics; the sea is smooth, and the eye above it.
    Air,
    /// Everything.
    Ground,
}

/// Width of a pixel on the ground below which foam and caustics show, metres.
const NEAR_M: f32 = 0.7;

impl Nearness {
    /// Of a body with these uniforms.
    pub(crate) fn of(body: &Body, pixel_rad: f32) -> Self {
        if body.wave_steps > 0 || body.eye_is_under == 1 {
            return Self::Ground;
        }
        let sea_km = if body.has_sea == 1 { body.sea_level_km } else { f32::MIN };
        let ground_km = (body.height_range_m.y * 1e-3).max(sea_km);
        let pixel_km = (body.eye_altitude_km - ground_km).max(0.0) * pixel_rad;
        // The top of the veil is 0 without clouds.
        let over_clouds_km = body.eye_altitude_km - body.veil_km;
        let cloud_pixel_km = if body.veil_km > 0.0 { over_clouds_km.max(0.0) * pixel_rad } else { f32::MAX };
        let texel_km = FRAC_PI_2 * body.radius_km / CLOUD_MAP_SIDE as f32;
        let floe_km = if body.floes_per_m > 0.0 { 1e-3 / body.floes_per_m } else { 0.0 };
        // Width of a pixel in which waves.wgsl loses the longest wave.
        let longest_per_m = if body.wave_count > 0 { body.waves[0].vector_per_m.length() } else { f32::MAX };
        let wave_km = 1e-3 * (WAVE_LOST / WAVE_ACROSS) as f32 / longest_per_m;
        match () {
            () if pixel_km < NEAR_M * 1e-3 => Self::Ground,
            () if pixel_km < wave_km.max(0.5 * floe_km) || cloud_pixel_km < texel_km => Self::Air,
            () => Self::Orbit,
        }
    }

    /// The constant of a shader and its value.
    pub(crate) fn constant(self) -> (&'static str, f64) {
        ("NEARNESS", f64::from(self as u8))
    }
}

#[cfg(test)]
mod tests {
    use super::super::shared::{WAVES, Wave};
    use super::*;
    use glam::Vec3;
    use std::f32::consts::TAU;

    /// A planet like the Earth with clouds, under an eye at a height.
    fn body(eye_altitude_km: f32) -> Body {
        Body {
            radius_km: 6371.0,
            has_sea: 1,
            eye_altitude_km,
            veil_km: 8.0,
            floes_per_m: 1.0 / 3000.0,
            ..Body::default()
        }
    }

    #[test]
    fn detail_is_left_out_only_where_no_pixel_resolves_it() {
        let of = |body: &Body| Nearness::of(body, 0.0015);
        assert_eq!(of(&body(15_000.0)), Nearness::Orbit);
        // A pixel is 14 km wide in clouds, a texel 19.5 km.
        assert_eq!(of(&body(9000.0)), Nearness::Air);
        assert_eq!(of(&Body { veil_km: 0.0, ..body(9000.0) }), Nearness::Orbit);
        assert_eq!(of(&body(0.9)), Nearness::Air);
        // Without clouds and floes, a pixel of 3 m shows a swell 60 m long and loses one 6 m long.
        let calm = |wave_m: f32| {
            let mut waves = [Wave::default(); WAVES];
            waves[0].vector_per_m = Vec3::X * TAU / wave_m;
            Body { veil_km: 0.0, floes_per_m: 0.0, wave_count: 1, waves, ..body(2.0) }
        };
        assert_eq!([60.0, 6.0].map(|wave_m| of(&calm(wave_m))), [Nearness::Air, Nearness::Orbit]);
        assert_eq!(of(&body(0.2)), Nearness::Ground);
        assert_eq!(of(&Body { wave_steps: 6, ..body(0.9) }), Nearness::Ground);
        assert_eq!(of(&Body { eye_is_under: 1, ..body(0.9) }), Nearness::Ground);
    }
}
