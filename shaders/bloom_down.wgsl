// A level of the bloom from the next finer one.
#include "bloom.wgsl"

@group(1) @binding(0) var finer: texture_2d<f32>;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(spline(finer, floor(position.xy) * 2.0 + 1.0), 1.0);
}
