// Shadows of objects: their depth from the sun.
#include "caster_api.wgsl"
#include "life_instance.wgsl"

@group(1) @binding(0) var<storage, read> instances: array<Instance>;

@vertex
fn vertex(@location(0) position: vec3f, @builtin(instance_index) index: u32) -> @builtin(position) vec4f {
    let instance = instances[index];
    let q = normalize(vec4f(unpack2x16snorm(instance.turn.x), unpack2x16snorm(instance.turn.y)));
    let turned = position + 2.0 * cross(q.xyz, cross(q.xyz, position) + q.w * position);
    return shadow_view.clip_from_rel_m * vec4f(instance.foot_rel_m + turned * instance.size_m, 1.0);
}

@fragment
fn fragment() {}
