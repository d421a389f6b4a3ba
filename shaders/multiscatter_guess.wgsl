// LUT of light that air and ground have scattered, by the sun's cosine to the zenith and altitude: a first guess, as if
// light were as bright everywhere as at the point, and the sky did not light the ground (Hillaire 2020, section 5.5).
#include "screen.wgsl"
#include "gather.wgsl"

const UPPER: u32 = 6u;
const LOWER: u32 = 4u;
const NODES: array<vec2f, 10> = array<vec2f, 10>(
    vec2f(0.0337652429, 0.0856622462),
    vec2f(0.1693953068, 0.1803807865),
    vec2f(0.3806904070, 0.2339569673),
    vec2f(0.6193095930, 0.2339569673),
    vec2f(0.8306046932, 0.1803807865),
    vec2f(0.9662347571, 0.0856622462),
    vec2f(0.0694318442, 0.1739274226),
    vec2f(0.3300094782, 0.3260725774),
    vec2f(0.6699905218, 0.3260725774),
    vec2f(0.9305681558, 0.1739274226),
);
const STEPS: u32 = 10u;

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> Texel {
    set_lut_sun();
    let at = point_of_texel(pixel);
    if all_is_dark(at.x, at.y) { return dark_texel(); }
    let anisotropy = haze_moments_without_peak().x;
    var sums: Sums;
    var returned = vec3f(0.0);
    for (var i = 0u; i < UPPER + LOWER; i++) {
        let ring = ring_around(at.x, at.y, NODES[i], i >= UPPER, STEPS);
        var transmittance = vec3f(1.0);
        // Sunlight that molecules and haze scatter at both points, without the phase functions
        var rayleigh = array<vec3f, 2>(vec3f(0.0), vec3f(0.0));
        var mie = array<vec3f, 2>(vec3f(0.0), vec3f(0.0));
        for (var s = 0u; s < STEPS; s++) {
            let part = part_of(ring, at.x, s);
            let air = without_peak(air_at(part.height));
            let inside = transmittance * shining_length(air.extinction, part.length_km);
            let by_rayleigh = inside * air.rayleigh;
            let by_mie = inside * air.mie;
            let mus = sun_cosines(at.x, at.y, ring, part.at_km, part.height);
            for (var k = 0; k < 2; k++) {
                let beam = sun_beam(part.height, mus[k]);
                rayleigh[k] += by_rayleigh * beam;
                mie[k] += by_mie * beam;
            }
            returned += (by_rayleigh + by_mie) * (2.0 * ring.share);
            transmittance *= exp(-air.extinction * part.length_km);
        }
        let mus = sun_cosines(at.x, at.y, ring, ring.path_km, 0.0);
        for (var k = 0; k < 2; k++) {
            var ground = vec3f(0.0);
            if ring.hits { ground = transmittance * sunlit_ground(mus[k]); }
            // Phase functions change faster around the ring than sunlight does, so each quarter has two of each.
            for (var e = 0; e < 2; e++) {
                let cosine = ring.mu * at.y + select(-EIGHTHS[e], EIGHTHS[e], k == 0) * ring.flat;
                let seen =
                    rayleigh[k] * rayleigh_phase(cosine) + mie[k] * henyey_greenstein(anisotropy, cosine) + ground;
                add_light(&sums, seen * (0.5 * ring.share), ring.mu, cosine, at.y);
            }
        }
    }
    // Each further order of scattering returns the same share, so the sum is a geometric series.
    let all = sums.mean / (1.0 - min(returned, vec3f(0.999)));
    return texel_of(light_of(sums, all, at.y), light_of(sums, sums.mean, at.y));
}
