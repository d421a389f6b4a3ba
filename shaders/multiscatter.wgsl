// LUT of light scattered twice or more: the guess, corrected for how much brighter or darker it is in the surroundings,
// and for the light of the sky on the ground. That light is smooth, so few directions and steps suffice.
#include "screen.wgsl"
#include "gather.wgsl"

const UPPER: u32 = 3u;
const LOWER: u32 = 2u;
const NODES: array<vec2f, 5> = array<vec2f, 5>(
    vec2f(0.1127016654, 0.2777777778),
    vec2f(0.5, 0.4444444444),
    vec2f(0.8872983346, 0.2777777778),
    vec2f(0.2113248654, 0.5),
    vec2f(0.7886751346, 0.5),
);
const STEPS: u32 = 6u;

// Radiance of the ground in light from the sky. On the ground, half of all directions see the sky, and half see the
// sunlit ground.
fn skylit_ground(sun_mu: f32) -> vec3f {
    return body.ground_albedo * max(2.0 * multiscatter(0.0, sun_mu) - sunlit_ground(sun_mu), vec3f(0.0));
}

// While this LUT is drawn, multiscatter() reads the guess.
@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let at = point_of_texel(pixel);
    if all_is_dark(at.x, at.y) { return vec4f(0.0, 0.0, 0.0, 1.0); }
    let here = multiscatter(at.x, at.y);
    var correction = vec3f(0.0);
    var returned = vec3f(0.0);
    for (var i = 0u; i < UPPER + LOWER; i++) {
        let ring = ring_around(at.x, at.y, NODES[i], i >= UPPER, STEPS);
        var transmittance = vec3f(1.0);
        for (var s = 0u; s < STEPS; s++) {
            let part = part_of(ring, at.x, s);
            let air = air_at(part.height);
            let inside =
                transmittance * (air.rayleigh + air.mie) * shining_length(air.extinction, part.length_km) * ring.share;
            let mus = sun_cosines(at.x, at.y, ring, part.at_km, part.height);
            correction += inside * (multiscatter(part.height, mus.x) + multiscatter(part.height, mus.y) - 2.0 * here);
            returned += inside * 2.0;
            transmittance *= exp(-air.extinction * part.length_km);
        }
        if ring.hits {
            let mus = sun_cosines(at.x, at.y, ring, ring.path_km, 0.0);
            correction += transmittance * (skylit_ground(mus.x) + skylit_ground(mus.y)) * ring.share;
        }
    }
    returned = min(returned, vec3f(0.999));
    // The correction is scattered on too. Its sum over all orders is limited to thin air: in dense air, it differs too
    // much from place to place. The result is no less than the first term of the series.
    let all = max(here + correction / (1.0 - min(returned, vec3f(0.4))), here * (1.0 - returned));
    return vec4f(min(all * MULTISCATTER_SCALE, vec3f(60000.0)), 1.0);
}
