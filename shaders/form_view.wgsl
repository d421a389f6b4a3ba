// A form by itself, as the editor shows it: on a round floor, in the sun, seen from the side without perspective.
#include "life_material.wgsl"
#include "life_vertex.wgsl"

struct FormView {
    // Form space (height 1, z up) to clip space
    clip_from_form: mat4x4f,
    // Unit vectors in form space: towards the sun, towards the eye
    to_sun: vec3f,
    size_m: f32,
    to_eye: vec3f,
    // Width of a pixel on the form, metres
    pixel_m: f32,
    first: vec3f,
    material: u32,
    second: vec3f,
    // Radius of the floor
    floor: f32,
    // Colour behind all
    behind: vec3f,
}

@group(0) @binding(0) var<uniform> view: FormView;

// Light of the sun and of the sky, albedo of the floor, and factor on radiance.
const SUN: vec3f = vec3f(2.7, 2.5, 2.2);
const SKY: vec3f = vec3f(0.55, 0.65, 0.85);
const FLOOR: vec3f = vec3f(0.045, 0.044, 0.042);
const EXPOSURE: f32 = 3.0;
// Share of the sun's light in the shadow.
const IN_SHADOW: f32 = 0.25;

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) place: vec3f,
    @location(1) normal: vec3f,
    @location(2) look: vec2f,
    @location(3) tint: vec3f,
}

// Colour of a radiance, as the picture of the planet has it: encoded for a display.
fn shown(radiance: vec3f) -> vec4f {
    let light = saturate(1.0 - exp(-EXPOSURE * radiance));
    let dark = light * 12.92;
    let bright = 1.055 * pow(light, vec3f(1.0 / 2.4)) - 0.055;
    return vec4f(select(bright, dark, light < vec3f(0.0031308)), 1.0);
}

@vertex
fn vertex(in: Vertex) -> Surface {
    return Surface(view.clip_from_form * vec4f(in.position, 1.0), in.position, in.normal.xyz, in.look.xy, tint_of(in));
}

@fragment
fn fragment(in: Surface) -> @location(0) vec4f {
    let leaf = in.look.x;
    let material = object_material(view.material, leaf, in.place * view.size_m, view.size_m, view.pixel_m);
    // What is below the ground is not seen.
    if in.place.z < 0.0 || material.gap > 0.5 { discard; }
    let n = normalize(in.normal + material.tilt);
    let facing = dot(n, view.to_sun);
    let soft = leaf * LEAF_SOFT.x;
    let front = max((facing + soft) / (1.0 + soft), 0.0) / (1.0 + 0.5 * soft);
    let lit = (front + TRANSLUCENT * leaf * max(-facing, 0.0)) * smoothstep(0.0, 0.75, in.look.y);
    let open = (0.5 + 0.5 * n.z) * in.look.y;
    let albedo = mix(view.first, view.second, leaf) * material.tint * in.tint;
    let from_below = FLOOR * (SUN * view.to_sun.z + SKY) * (1.0 - open) * in.look.y;
    return shown(albedo * (SUN * lit + SKY * open + from_below) / PI);
}

// The floor at a place: it fades into what is behind. `lit`: share of the sun's light.
fn floor_at(place: vec2f, lit: f32) -> vec4f {
    let radiance = FLOOR * (SUN * (view.to_sun.z * lit) + SKY) / PI;
    let light = shown(radiance);
    return mix(light, vec4f(view.behind, 1.0), smoothstep(0.3, 1.0, length(place) / view.floor));
}

@vertex
fn floor_vertex(@builtin(vertex_index) index: u32) -> Surface {
    let corner = (vec2f(vec2u(index & 1u, index >> 1u)) * 2.0 - 1.0) * view.floor;
    let place = vec3f(corner, 0.0);
    return Surface(view.clip_from_form * vec4f(place, 1.0), place, vec3f(0.0, 0.0, 1.0), vec2f(0.0, 1.0), vec3f(1.0));
}

@fragment
fn floor_fragment(in: Surface) -> @location(0) vec4f {
    return floor_at(in.place.xy, 1.0);
}

// The shadow: the form, laid on the floor along the light.
@vertex
fn shadow_vertex(in: Vertex) -> Surface {
    let flat = in.position - view.to_sun * (max(in.position.z, 0.0) / view.to_sun.z);
    let place = vec3f(flat.xy, 0.0);
    return Surface(view.clip_from_form * vec4f(place, 1.0), place, in.normal.xyz, in.look.xy, vec3f(1.0));
}

@fragment
fn shadow_fragment(in: Surface) -> @location(0) vec4f {
    return floor_at(in.place.xy, IN_SHADOW);
}
