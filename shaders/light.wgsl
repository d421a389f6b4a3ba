// Light of star and sky at a place, from the tables.
#include "air_model.wgsl"
#include "tables.wgsl"

// Transmittance of the air alone along a ray that misses the ground.
fn clear_transmittance(h: f32, mu: f32) -> vec3f {
    let top = body.air_height_km;
    if top <= 0.0 { return vec3f(1.0); }
    var at = vec2f(h, mu);
    if h > top {
        // From outer space the way begins where it meets the air, if it does.
        let b = (body.radius_km + h) * mu;
        let into = b * b - (h - top) * (2.0 * body.radius_km + h + top);
        if b >= 0.0 || into <= 0.0 { return vec3f(1.0); }
        at = vec2f(top, -sqrt(into) / (body.radius_km + top));
    }
    return exp(-textureSampleLevel(depth_table, clamped, depth_uv(at.x, at.y), 0.0).rgb);
}

// Transmittance to the star, its setting behind the smooth planet included.
fn sun_transmittance(h: f32, mu: f32) -> vec3f {
    let visible = disc_share(mu - horizon_cosine(h), 0.0);
    if visible <= 0.0 { return vec3f(0.0); }
    return clear_transmittance(h, mu) * visible;
}

// Whether the star has set for all air that is seen from an altitude: the farthest is where a ray that grazes the ground leaves it.
fn all_is_dark(h: f32, sun_mu: f32) -> bool {
    let radius = body.radius_km;
    let dips = acos(radius / (radius + max(h, 0.0))) + 2.0 * acos(radius / (radius + body.air_height_km));
    return asin(sun_mu) < -dips - max(active_sun.radius_rad, 0.0015) - 0.02;
}

// The square root spreads tables about the terminator.
fn signed_root(x: f32) -> f32 { return sign(x) * sqrt(abs(x)); }

// Lifts the dim light of deep twilight into the range of 16 bits.
const MULTISCATTER_SCALE: f32 = 1024.0;

// Radiance that comes from all around after two or more scatterings, for unit irradiance.
fn multiscatter(h: f32, mu: f32) -> vec3f {
    let x = vec2f(signed_root(mu) * 0.5 + 0.5, sqrt(saturate1(h / body.air_height_km)));
    return textureSampleLevel(multiscatter_table, clamped, texel_from_unit(x, MULTISCATTER_SIZE), 0.0).rgb / MULTISCATTER_SCALE;
}

// Radiance of the sky at night, the mean over stars, dust and the air's own glow. Sunlit white ground has 1: on the Earth the sun that is 7
// degrees under the horizon leaves as much. Eyes that are used to the dark see by a thousandth of it, 16 bits do not.
const NIGHT_SKY: vec3f = vec3f(0.85e-5, 1.0e-5, 1.3e-5);
// Shares of what is not drawn as stars, and of what air adds by itself and by what it scatters: chosen by eye.
const NIGHT_BACKGROUND: f32 = 0.2;
const NIGHT_AIRGLOW: f32 = 0.7;

// Irradiance of the sky on level ground.
fn sky_irradiance(h: f32, mu: f32) -> vec3f {
    // Once, however many suns there are.
    let night = select(vec3f(0.0), PI * NIGHT_SKY, is_first_sun);
    if body.air_height_km <= 0.0 { return night; }
    let x = vec2f(signed_root(mu) * 0.5 + 0.5, sqrt(saturate1(h / body.air_height_km)));
    let table = textureSampleLevel(irradiance_table, clamped, texel_from_unit(x, IRRADIANCE_SIZE), 0.0).rgb;
    return table * active_sun.irradiance + night;
}

// Radiance of the sky seen from the reference sphere, the mean over all azimuths.
fn sky_radiance(view_mu: f32, sun_mu: f32) -> vec3f {
    let night = select(vec3f(0.0), NIGHT_SKY, is_first_sun);
    if body.air_height_km <= 0.0 { return night; }
    let x = vec2f(signed_root(sun_mu) * 0.5 + 0.5, sqrt(saturate1(view_mu)));
    let table = textureSampleLevel(sky_table, clamped, texel_from_unit(x, SKY_SIZE), 0.0).rgb;
    return table * active_sun.irradiance + night;
}
