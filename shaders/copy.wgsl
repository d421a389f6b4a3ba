// Copies the radiance of the scene, with no stars.
#include "screen.wgsl"

@group(1) @binding(0) var radiance: texture_2d<f32>;

struct Output {
    @location(0) light: vec4f,
    @location(1) stars: vec4f,
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Output {
    return Output(textureLoad(radiance, vec2i(position.xy), 0), vec4f(0.0));
}
