// LUT of light scattered twice or more, the mean over all directions, by the sun's cosine to the zenith and altitude: a
// first guess, as if light were as bright everywhere as at the point, and the sky did not light the ground (Hillaire
// 2020, section 5.5).
#include "screen.wgsl"
#include "gather.wgsl"

const UPPER: u32 = 8u;
const LOWER: u32 = 6u;
const NODES: array<vec2f, 14> = array<vec2f, 14>(
    vec2f(0.0198550718, 0.0506142681),
    vec2f(0.1016667613, 0.1111905172),
    vec2f(0.2372337950, 0.1568533229),
    vec2f(0.4082826788, 0.1813418917),
    vec2f(0.5917173212, 0.1813418917),
    vec2f(0.7627662050, 0.1568533229),
    vec2f(0.8983332387, 0.1111905172),
    vec2f(0.9801449282, 0.0506142681),
    vec2f(0.0337652429, 0.0856622462),
    vec2f(0.1693953068, 0.1803807865),
    vec2f(0.3806904070, 0.2339569673),
    vec2f(0.6193095930, 0.2339569673),
    vec2f(0.8306046932, 0.1803807865),
    vec2f(0.9662347571, 0.0856622462),
);
const STEPS: u32 = 14u;

// Sunlight that air scatters along a ray, per km. Molecules scatter it by their phase function, haze evenly.
fn sunlit_air(air: Air, height: f32, sun_mu: f32, cosine: f32) -> vec3f {
    return (air.rayleigh * rayleigh_phase(cosine) + air.mie / (4.0 * PI)) * sun_transmittance(height, sun_mu);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let at = point_of_texel(pixel);
    if all_is_dark(at.x, at.y) { return vec4f(0.0, 0.0, 0.0, 1.0); }
    var second = vec3f(0.0);
    var returned = vec3f(0.0);
    for (var i = 0u; i < UPPER + LOWER; i++) {
        let ring = ring_around(at.x, at.y, NODES[i], i >= UPPER, STEPS);
        var transmittance = vec3f(1.0);
        for (var s = 0u; s < STEPS; s++) {
            let part = part_of(ring, at.x, s);
            let air = air_at(part.height);
            let inside = transmittance * shining_length(air.extinction, part.length_km) * ring.share;
            let mus = sun_cosines(at.x, at.y, ring, part.at_km, part.height);
            second += inside
                * (sunlit_air(air, part.height, mus.x, ring.cosines.x) + sunlit_air(air, part.height, mus.y, ring.cosines.y));
            returned += inside * 2.0 * (air.rayleigh + air.mie);
            transmittance *= exp(-air.extinction * part.length_km);
        }
        if ring.hits {
            let mus = sun_cosines(at.x, at.y, ring, ring.path_km, 0.0);
            second += transmittance * (sunlit_ground(mus.x) + sunlit_ground(mus.y)) * ring.share;
        }
    }
    // Each further order of scattering returns the same share, so the sum is a geometric series.
    let all = second / (1.0 - min(returned, vec3f(0.999)));
    return vec4f(min(all * MULTISCATTER_SCALE, vec3f(60000.0)), 1.0);
}
