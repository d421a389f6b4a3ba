// A coarser level of the bloom, blended over the next finer one.
#include "bloom.wgsl"

@group(1) @binding(0) var coarser: texture_2d<f32>;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let level = vec2f(textureDimensions(coarser));
    return vec4f(smoothed(coarser, position.xy * 0.5 / level), 1.0);
}
