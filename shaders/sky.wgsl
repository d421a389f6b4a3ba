// Table: radiance of the sky from the reference sphere, the mean over all azimuths, by cosine to star and zenith.
#include "screen.wgsl"
#include "scattering.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let x = (pixel.xy - 0.5) / vec2f(63.0, 31.0);
    let root = x.x * 2.0 - 1.0;
    let sun_mu = clamp(sign(root) * root * root, -1.0, 1.0);
    let mu = x.y * x.y;
    let sun = vec3f(sqrt(max(0.0, 1.0 - sun_mu * sun_mu)), 0.0, sun_mu);
    const AROUND: u32 = 8u;
    var sum = vec3f(0.0);
    for (var i = 0u; i < AROUND; i++) {
        let angle = PI * (f32(i) + 0.5) / f32(AROUND);
        let flat = sqrt(max(0.0, 1.0 - mu * mu));
        let dir = vec3f(flat * cos(angle), flat * sin(angle), mu);
        sum += scattered_from(0.0, vec3f(0.0, 0.0, 1.0), dir, sun, 16.0);
    }
    return vec4f(sum / f32(AROUND), 1.0);
}
