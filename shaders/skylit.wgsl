// The ground in the light of the sky, from the multiple-scattering LUT.
#include "gather.wgsl"

// Radiance of the ground in light from the sky. On the ground, half of all directions see the sky, and half see the
// ground. `skylit`: whether the ground in the LUT is itself skylit.
fn skylit_ground(sun_mu: f32, skylit: bool) -> vec3f {
    let light = scattered_light(0.0, sun_mu);
    let share = select(vec3f(1.0), 1.0 + body.ground_albedo, skylit);
    let even = 2.0 * light.mean - sunlit_ground(sun_mu);
    let squared = 2.0 * light.mean * squared_up(light, sun_mu);
    // The mean over the sky weighted by the cosine. The first two terms are exact if the sky changes with the squared
    // cosine to the zenith; less light falls from one that is brightest in a band along the horizon. Its weight
    // is by path tracing.
    let band = min(squared, vec3f(0.0));
    let sky = even + 1.875 * squared - band * band * share / max(even, vec3f(1e-30));
    return body.ground_albedo * max(sky, vec3f(0.0)) / share;
}
