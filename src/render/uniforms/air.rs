//! Uniforms of the air.

use super::{Body, rgb};
use crate::planet::{Atmosphere, Planet};

/// Sets the air of a planet.
pub(super) fn of(out: &mut Body, planet: &Planet) {
    // Without air the scale heights still stand in denominators.
    let none = Atmosphere::default();
    let (air, height_km) = planet.atmosphere.as_ref().map_or((&none, 0.0), |air| (air, air.height_km));
    let extinction: [f64; 3] = std::array::from_fn(|i| air.mie_scattering_per_km[i] + air.mie_absorption_per_km[i]);
    out.rayleigh_per_km = rgb(air.rayleigh_per_km);
    out.rayleigh_scale_km = air.rayleigh_scale_km as f32;
    out.mie_scattering_per_km = rgb(air.mie_scattering_per_km);
    out.mie_scale_km = air.mie_scale_km as f32;
    out.mie_extinction_per_km = rgb(extinction);
    out.mie_anisotropy = air.mie_anisotropy as f32;
    out.absorber_per_km = rgb(air.absorber_per_km);
    out.absorber_height_km = air.absorber_height_km as f32;
    out.absorber_width_km = air.absorber_width_km as f32;
    out.air_height_km = height_km as f32;
    out.aurora = if height_km > 0.0 { air.aurora as f32 } else { 0.0 };
    out.aurora_lat_rad = air.aurora_lat_deg.to_radians() as f32;
    out.ground_albedo = rgb(air.ground_albedo);
}
