// LUT of the sky's irradiance on level ground, by the sun's cosine to the zenith and altitude.
#include "screen.wgsl"
#include "ring.wgsl"

// Nodes of Gauss-Legendre quadrature between 0 and 1, and their weights.
const NODES: array<vec2f, 4> = array<vec2f, 4>(
    vec2f(0.0694318442, 0.1739274226),
    vec2f(0.3300094782, 0.3260725774),
    vec2f(0.6699905218, 0.3260725774),
    vec2f(0.9305681558, 0.1739274226),
);

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let x = (pixel.xy - 0.5) / (IRRADIANCE_SIZE - 1.0);
    let sun_mu = sun_cosine_at(x.x);
    let h = x.y * x.y * body.air_height_km * 0.9999;
    if all_is_dark(h, sun_mu) { return vec4f(0.0, 0.0, 0.0, 1.0); }
    var sum = vec3f(0.0);
    for (var i = 0u; i < 4u; i++) {
        // Nodes are spaced in the squared cosine: the square root weights each ring by its cosine, as irradiance does.
        let node = NODES[i];
        sum += ring_light(h, sqrt(node.x), sun_mu, 3u, 8u) * node.y;
    }
    return vec4f(sum * PI, 1.0);
}
