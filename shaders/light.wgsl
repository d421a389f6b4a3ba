// Light of star and sky at a place, from the tables.
#include "air_model.wgsl"
#include "tables.wgsl"

// Transmittance to the star, its setting behind the smooth planet included.
fn sun_transmittance(h: f32, mu: f32) -> vec3f {
    let visible = sun_over_horizon(h, mu);
    if globals.air.x <= 0.0 || visible <= 0.0 { return vec3f(visible); }
    let clear = textureSampleLevel(transmittance_table, clamped, transmittance_uv(h, mu), 0.0).rgb;
    return clear * visible;
}

// Radiance that comes from all around after two or more scatterings, for unit irradiance.
fn multiscatter(h: f32, mu: f32) -> vec3f {
    let x = vec2f(mu * 0.5 + 0.5, saturate1(h / globals.air.x));
    return textureSampleLevel(multiscatter_table, clamped, texel_from_unit(x, vec2f(32.0)), 0.0).rgb;
}

// The square root spreads the table about the terminator.
fn signed_root(x: f32) -> f32 { return sign(x) * sqrt(abs(x)); }

// Irradiance of the sky on level ground.
fn sky_irradiance(h: f32, mu: f32) -> vec3f {
    if globals.air.x <= 0.0 { return vec3f(0.0); }
    let x = vec2f(signed_root(mu) * 0.5 + 0.5, sqrt(saturate1(h / globals.air.x)));
    let table = textureSampleLevel(irradiance_table, clamped, texel_from_unit(x, vec2f(64.0, 16.0)), 0.0).rgb;
    return table * globals.sun_irradiance.rgb;
}

// Radiance of the sky seen from the reference sphere, the mean over all azimuths.
fn sky_radiance(view_mu: f32, sun_mu: f32) -> vec3f {
    if globals.air.x <= 0.0 { return vec3f(0.0); }
    let x = vec2f(signed_root(sun_mu) * 0.5 + 0.5, sqrt(saturate1(view_mu)));
    let table = textureSampleLevel(sky_table, clamped, texel_from_unit(x, vec2f(64.0, 32.0)), 0.0).rgb;
    return table * globals.sun_irradiance.rgb;
}
