// Shadows of objects: their depth from the sun.
#include "caster_api.wgsl"
#include "life_instance.wgsl"

@group(1) @binding(0) var<storage, read> instances: array<Instance>;

@vertex
fn vertex(@location(0) position: vec3f, @builtin(instance_index) index: u32) -> @builtin(position) vec4f {
    let instance = instances[index];
    let q = normalize(vec4f(unpack2x16snorm(instance.turn.x), unpack2x16snorm(instance.turn.y)));
    let at_m = widened(instance, turned(q, position) * instance.size_m, turned(q, vec3f(0.0, 0.0, 1.0)));
    return shadow_view.clip_from_rel_m * vec4f(instance.foot_rel_m + at_m, 1.0);
}

@fragment
fn fragment() {}
