// LUT of light that air scatters for a second time or more, by direction: a tile for each node of the cosine to the
// zenith (across) and each half of the azimuths (down), and a layer for each azimuth in it, with the columns and rows
// of the multiple-scattering LUT. The moments in that LUT suffice for light that is scattered on, but not for what
// dust scatters to the eye, so here the light seen from all around is summed with the exact phase functions.
#include "screen.wgsl"
#include "glow_nodes.wgsl"

// Stands in the place of the LUT of the sky
@group(1) @binding(2) var seen_lut: texture_2d_array<f32>;

// Light seen by the point of a pixel of the multiple-scattering LUT, scattered once more. The sum is divided by that
// over even light: directions are too far apart to resolve a sharp phase function. `by_rayleigh`: the share of
// molecules in all scattering; haze has the rest. `turns` and `sines`: cosines and sines of the azimuths.
fn rescattered(pixel: vec2i, at: vec2f, by_rayleigh: vec3f, mu: f32, turns: vec3f, sines: vec3f) -> Lights {
    // Factors of the phase functions that do not depend on the direction cancel.
    let g = body.mie_anisotropy;
    let across = flat_of(mu);
    // For each colour and for even light: sums of the three azimuths
    var rayleigh = mat4x3f();
    var mie = mat4x3f();
    let rings = rings_under(at.y);
    for (var i = 0u; i < rings.count; i++) {
        let ring = seen_ring(at.x, rings, i);
        let along = mu * ring.mu;
        let both_across = across * flat_of(ring.mu);
        for (var k = 0u; k < SEEN_TURNS; k++) {
            let tile = vec2i(vec2u(i, k / TURNS_AT_ONCE)) * vec2i(MULTISCATTER_SIZE);
            let root = textureLoad(seen_lut, pixel + tile, i32(k % TURNS_AT_ONCE), 0).rgb;
            let light = root * root * ring.share;
            // The direction and its mirror image
            let azimuth = SEEN_AZIMUTHS[k] * both_across;
            let middle = along + turns * azimuth.x;
            let aside = sines * azimuth.y;
            let one = middle - aside;
            let other = middle + aside;
            let even = 1.0 + one * one;
            let other_even = 1.0 + other * other;
            let base = inverseSqrt(max(1.0 + g * g - 2.0 * g * one, vec3f(1e-6)));
            let other_base = inverseSqrt(max(1.0 + g * g - 2.0 * g * other, vec3f(1e-6)));
            let by_molecules = even + other_even;
            let by_haze = even * (base * base * base) + other_even * (other_base * other_base * other_base);
            rayleigh[0] += light.r * by_molecules;
            rayleigh[1] += light.g * by_molecules;
            rayleigh[2] += light.b * by_molecules;
            rayleigh[3] += ring.share * by_molecules;
            mie[0] += light.r * by_haze;
            mie[1] += light.g * by_haze;
            mie[2] += light.b * by_haze;
            mie[3] += ring.share * by_haze;
        }
    }
    let red = mix(mie[0] / mie[3], rayleigh[0] / rayleigh[3], by_rayleigh.r) / MULTISCATTER_SCALE;
    let green = mix(mie[1] / mie[3], rayleigh[1] / rayleigh[3], by_rayleigh.g) / MULTISCATTER_SCALE;
    let blue = mix(mie[2] / mie[3], rayleigh[2] / rayleigh[3], by_rayleigh.b) / MULTISCATTER_SCALE;
    return Lights(
        vec3f(red.x, green.x, blue.x), vec3f(red.y, green.y, blue.y), vec3f(red.z, green.z, blue.z),
    );
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Turns {
    set_lut_sun();
    let to = to_turns(position);
    let at = to.at;
    var none: Lights;
    if all_is_dark(at.x, at.y) { return turns_of(none); }
    let sines = sqrt(max(vec3f(0.0), 1.0 - to.turns * to.turns));
    return turns_of(rescattered(vec2i(to.pixel), at, to.by_rayleigh, to.mu, to.turns, sines));
}
