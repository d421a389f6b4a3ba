// LUT of light that air and ground have scattered, by the sun's cosine to the zenith and altitude: a first guess, as if
// light were as bright everywhere as at the point, and the sky did not light the ground (Hillaire 2020, section 5.5).
#include "screen.wgsl"
#include "gather.wgsl"

const UPPER: u32 = 9u;
const LOWER: u32 = 2u;
const NODES: array<vec2f, 11> = array<vec2f, 11>(
    vec2f(0.0159198802, 0.0406371942),
    vec2f(0.0819844463, 0.0903240803),
    vec2f(0.1933142836, 0.1303053482),
    vec2f(0.3378732883, 0.1561735385),
    vec2f(0.5000000000, 0.1651196775),
    vec2f(0.6621267117, 0.1561735385),
    vec2f(0.8066857164, 0.1303053482),
    vec2f(0.9180155537, 0.0903240803),
    vec2f(0.9840801198, 0.0406371942),
    vec2f(0.2113248654, 0.5),
    vec2f(0.7886751346, 0.5),
);
const STEPS: u32 = 9u;

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
