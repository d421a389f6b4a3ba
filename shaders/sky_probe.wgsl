// Radiance and transmittance of the air along given rays, by the functions that draw the picture; see
// src/render/sky_probe.rs.
#include "screen.wgsl"
#include "scattering.wgsl"

// One ray for each column. Row 0: direction, altitude in km. Row 1: direction of the sun. The zenith is +Z.
@group(2) @binding(0) var rays: texture_2d<f32>;

struct Answer {
    @location(0) radiance: vec4f,
    @location(1) transmittance: vec4f,
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> Answer {
    set_lut_sun();
    let ray = textureLoad(rays, vec2i(i32(pixel.x), 0), 0);
    let sun = textureLoad(rays, vec2i(i32(pixel.x), 1), 0).xyz;
    var answer = Answer(vec4f(0.0), vec4f(0.0));
    if body.air_height_km > 0.0 {
        answer.radiance = vec4f(scattered_from(ray.w, vec3f(0.0, 0.0, 1.0), ray.xyz, sun, frame.air_steps), 0.0);
    }
    if sun.z >= horizon_cosine(ray.w) { answer.transmittance = vec4f(clear_transmittance(ray.w, sun.z), 0.0); }
    return answer;
}
