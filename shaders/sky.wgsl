// LUTs of the light of the sky, side by side in one texture. From column IRRADIANCE_AT on: its irradiance on level
// ground, by the sun's cosine to the zenith and altitude. From column SKY_AT on: its radiance seen from the reference
// sphere, the mean over all azimuths, by the cosines of sun and view to the zenith.
//
// Software adapters share a picture among their threads in squares of 64 pixels: each LUT lies in two of them.
#include "screen.wgsl"
#include "ring.wgsl"

// Nodes of Gauss-Legendre quadrature between 0 and 1, and their weights.
const NODES: array<vec2f, 4> = array<vec2f, 4>(
    vec2f(0.0694318442, 0.1739274226),
    vec2f(0.3300094782, 0.3260725774),
    vec2f(0.6699905218, 0.3260725774),
    vec2f(0.9305681558, 0.1739274226),
);

fn irradiance(x: vec2f, sun_mu: f32) -> vec3f {
    let h = x.y * x.y * body.air_height_km * 0.9999;
    if all_is_dark(h, sun_mu) { return vec3f(0.0); }
    var sum = vec3f(0.0);
    for (var i = 0u; i < 4u; i++) {
        // Nodes are spaced in the squared cosine: the square root weights each ring by its cosine, as irradiance does.
        let node = NODES[i];
        sum += ring_light(h, sqrt(node.x), sun_mu, 3u, 8u) * node.y;
    }
    return sum * PI;
}

fn radiance(x: vec2f, sun_mu: f32) -> vec3f {
    if all_is_dark(0.0, sun_mu) { return vec3f(0.0); }
    return ring_light(0.0, x.y * x.y, sun_mu, 4u, 12u);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    if pixel.x < SKY_AT {
        let x = (pixel.xy - vec2f(IRRADIANCE_AT, 0.0) - 0.5) / (IRRADIANCE_SIZE - 1.0);
        if x.x < 0.0 || x.y > 1.0 { return vec4f(0.0); }
        return vec4f(irradiance(x, sun_cosine_at(x.x)), 1.0);
    }
    let x = (pixel.xy - vec2f(SKY_AT, 0.0) - 0.5) / (SKY_SIZE - 1.0);
    return vec4f(radiance(x, sun_cosine_at(x.x)), 1.0);
}
