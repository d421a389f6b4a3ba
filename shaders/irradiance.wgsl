// Table: irradiance of the sky on level ground, by cosine to the star and altitude.
#include "screen.wgsl"
#include "scattering.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let x = (pixel.xy - 0.5) / vec2f(63.0, 15.0);
    let root = x.x * 2.0 - 1.0;
    let sun_mu = clamp(sign(root) * root * root, -1.0, 1.0);
    let h = x.y * x.y * globals.air.x * 0.9999;
    let sun = vec3f(sqrt(max(0.0, 1.0 - sun_mu * sun_mu)), 0.0, sun_mu);
    const RINGS: u32 = 6u;
    const AROUND: u32 = 5u;
    var sum = vec3f(0.0);
    for (var i = 0u; i < RINGS * AROUND; i++) {
        // Directions spread by the cosine: each has the same share of the irradiance.
        let mu = sqrt((f32(i / AROUND) + 0.5) / f32(RINGS));
        let angle = PI * (f32(i % AROUND) + 0.5) / f32(AROUND);
        let flat = sqrt(1.0 - mu * mu);
        let dir = vec3f(flat * cos(angle), flat * sin(angle), mu);
        sum += scattered_from(h, vec3f(0.0, 0.0, 1.0), dir, sun, 12.0);
    }
    return vec4f(sum * (PI / f32(RINGS * AROUND)), 1.0);
}
