// LUT of the sky's radiance seen from the reference sphere, the mean over all azimuths, by the cosines of sun and view
// to the zenith.
#include "screen.wgsl"
#include "ring.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let x = (pixel.xy - 0.5) / (SKY_SIZE - 1.0);
    let sun_mu = sun_cosine_at(x.x);
    if all_is_dark(0.0, sun_mu) { return vec4f(0.0, 0.0, 0.0, 1.0); }
    return vec4f(ring_light(0.0, x.y * x.y, sun_mu, 4u, 12u), 1.0);
}
