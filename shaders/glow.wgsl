// LUT of light that air scatters for a second time or more, by direction: a tile for each direction, with the columns
// and rows of the multiple-scattering LUT. The moments in that LUT suffice for light that is scattered on, but not for
// what dust scatters to the eye, so here the light seen from all around is summed with the exact phase functions.
#include "screen.wgsl"
#include "glow_model.wgsl"

// Stands in the place of the LUT of the sky
@group(1) @binding(3) var seen_lut: texture_2d<f32>;

// Light seen by the point of a pixel of the multiple-scattering LUT, scattered once more. The sum is divided by that
// over even light: directions are too far apart to resolve a sharp phase function. `shares`: of molecules and haze in
// all scattering are `by_rayleigh` and 1 - `by_rayleigh`.
fn rescattered(pixel: vec2i, h: f32, by_rayleigh: vec3f, mu: f32, turn: f32) -> vec3f {
    // Factors of the phase functions that do not depend on the direction cancel.
    let g = body.mie_anisotropy;
    let across = flat_of(mu);
    let azimuth = vec2f(turn, flat_of(turn));
    var rayleigh = vec4f(0.0);
    var mie = vec4f(0.0);
    for (var i = 0u; i < SEEN_RINGS; i++) {
        let ring = seen_ring(h, i);
        let along = mu * ring.mu;
        let both_across = across * flat_of(ring.mu);
        for (var k = 0u; k < SEEN_TURNS; k++) {
            let root = textureLoad(seen_lut, pixel + vec2i(vec2u(k, i)) * vec2i(MULTISCATTER_SIZE), 0).rgb;
            let light = vec4f(root * root, 1.0) * ring.share;
            // The direction and its mirror image
            let turns = azimuth * SEEN_AZIMUTHS[k];
            let cosines = along + both_across * vec2f(turns.x - turns.y, turns.x + turns.y);
            let even = 1.0 + cosines * cosines;
            let base = inverseSqrt(max(1.0 + g * g - 2.0 * g * cosines, vec2f(1e-6)));
            rayleigh += light * (even.x + even.y);
            mie += light * dot(even, base * base * base);
        }
    }
    return mix(mie.rgb / mie.a, rayleigh.rgb / rayleigh.a, by_rayleigh) / MULTISCATTER_SCALE;
}

// The same by moments, and what the peak of haze has added to the beam.
fn by_moments(h: f32, sun_mu: f32, by_rayleigh: vec3f, mu: f32, cosine: f32) -> vec3f {
    let light = scattered_light(h, sun_mu);
    let peak = max(sun_beam(h, sun_mu) - sun_transmittance(h, sun_mu), vec3f(0.0));
    var shares = Air(by_rayleigh, 1.0 - by_rayleigh, vec3f(0.0));
    return peak * (shares.rayleigh * rayleigh_phase(cosine) + shares.mie * mie_phase(cosine))
        + scattered(shares, light, haze_moments(), mu, cosine);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let place = tiled(position);
    let at = point_of_texel(place.pixel);
    if all_is_dark(at.x, at.y) { return vec4f(0.0); }
    let nodes = vec2f(place.tile) / (GLOW_TILES - 1.0);
    let mu = view_cosine_at(nodes.x);
    let turn = 1.0 - 2.0 * nodes.y * nodes.y;
    let air = air_at(at.x);
    let by_rayleigh = air.rayleigh / max(air.rayleigh + air.mie, vec3f(1e-30));
    let moments = share_of_moments(at.y);
    var light = vec3f(0.0);
    if moments < 1.0 {
        light += (1.0 - moments) * rescattered(vec2i(place.pixel.xy), at.x, by_rayleigh, mu, turn);
    }
    if moments > 0.0 {
        let cosine = mu * at.y + flat_of(mu) * flat_of(at.y) * turn;
        light += moments * by_moments(at.x, at.y, by_rayleigh, mu, cosine);
    }
    return vec4f(sqrt(light * MULTISCATTER_SCALE), 1.0);
}
