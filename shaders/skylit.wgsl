// The ground in the light of the sky, from the multiple-scattering LUT.
#include "gather.wgsl"

// Radiance of the ground in light from the sky. On the ground, half of all directions see the sky, and half see the
// ground. `skylit`: whether the ground in the LUT is itself skylit.
fn skylit_ground(sun_mu: f32, skylit: bool) -> vec3f {
    let light = scattered_light(0.0, sun_mu);
    // The mean over the sky weighted by the cosine, if the sky changes with the squared cosine to the zenith.
    let sky = light.mean * (2.0 + 3.75 * squared_up(light, sun_mu)) - sunlit_ground(sun_mu);
    return body.ground_albedo * max(sky, vec3f(0.0)) / select(vec3f(1.0), 1.0 + body.ground_albedo, skylit);
}
