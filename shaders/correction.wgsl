// Light that air and ground have scattered, gathered from all around from the light in the LUT so far: one step of the
// iteration that solves the equation of radiative transfer. That light is smooth, so few directions and steps suffice.
#include "gather.wgsl"
#include "skylit.wgsl"

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

// Light from the texel of a pixel, in two layers from the given one.
fn own_light(pixel: vec4f, layer: i32) -> Diffuse {
    let at = vec2i(pixel.xy);
    return light_of_texels(
        textureLoad(multiscatter_lut, at, layer, 0), textureLoad(multiscatter_lut, at, layer + 1, 0),
    );
}

fn corrected(pixel: vec4f, skylit: bool) -> Texel {
    set_lut_sun();
    let at = point_of_texel(pixel);
    if all_is_dark(at.x, at.y) { return dark_texel(); }
    let moments = haze_moments_without_peak();
    var sums: Sums;
    var returned = vec3f(0.0);
    for (var i = 0u; i < UPPER + LOWER; i++) {
        let ring = ring_around(at.x, at.y, NODES[i], i >= UPPER, STEPS);
        var transmittance = vec3f(1.0);
        var gathered = array<vec3f, 2>(vec3f(0.0), vec3f(0.0));
        for (var s = 0u; s < STEPS; s++) {
            let part = part_of(ring, at.x, s);
            let air = without_peak(air_at(part.height));
            let inside = transmittance * shining_length(air.extinction, part.length_km);
            let mus = sun_cosines(at.x, at.y, ring, part.at_km, part.height);
            let mu = ((body.radius_km + at.x) * ring.mu + part.at_km) / (body.radius_km + part.height);
            for (var k = 0; k < 2; k++) {
                let light = scattered_light(part.height, mus[k]);
                gathered[k] += inside * scattered(air, light, moments, mu, ring.cosines[k]);
            }
            returned += inside * (air.rayleigh + air.mie) * (2.0 * ring.share);
            transmittance *= exp(-air.extinction * part.length_km);
        }
        let mus = sun_cosines(at.x, at.y, ring, ring.path_km, 0.0);
        for (var k = 0; k < 2; k++) {
            if ring.hits { gathered[k] += transmittance * skylit_ground(mus[k], skylit); }
            add_light(&sums, gathered[k] * ring.share, ring.mu, ring.cosines[k], at.y);
        }
    }
    let here = own_light(pixel, 0);
    let once = own_light(pixel, 2);
    let all = sum_of(once.mean);
    sums.mean += once.mean;
    sums.ahead += all * once.along * (1.0 - at.y * at.y);
    sums.up += all * (once.up + once.along * at.y);
    sums.around += all * once.along * once.along;
    sums.zenith += once.mean * squared_up(once, at.y);
    // The correction is scattered on too. Its sum over all orders is limited to thin air: in dense air, it differs too
    // much from place to place. The result is no less than the first term of the series.
    let correction = (sums.mean - here.mean) / (1.0 - min(returned, vec3f(0.4)));
    return texel_of(light_of(sums, max(here.mean + correction, once.mean), at.y), once);
}
