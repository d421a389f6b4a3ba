// An object that stands on the ground, as the CPU writes it (src/render/life/view.rs).
#include "shared.wgsl"

struct Instance {
    // Foot of the form, metres from the eye
    foot_rel_m: vec3f,
    // Height of the form, metres
    size_m: f32,
    // Quaternion that turns the form (z up) into the planet frame, four signed 16-bit numbers
    turn: vec2u,
    // Square roots of the two colours of the form, 8 bits each; the last bytes: sway, 255 for 0.5, and its phase
    colors: vec2u,
    // Place in the horizon tile, two unsigned 16-bit numbers; then its layer (0xffff without one), and in the upper
    // half the code of its first tangent axis
    horizon: vec2u,
    // From the lowest bit on: area of neighbours that shade the object, for each area of ground, 4096 for 1, 16 bits;
    // factor on its width across the ray to the eye, 64 for an octave, 8 bits; how far the ground rises with each metre
    // to that side, 64 for 1, 8 bits with a sign
    among: u32,
    // From the lowest bit on: kind of material (src/render/life/material.rs), 8 bits; share of the height that is under
    // the ground, 255 for all, 8 bits; width of an object of the population, cm, 16 bits
    material: u32,
}

// Light on an object: irradiance of the sun and of the sky.
struct ObjectLight {
    sun: vec3f,
    // Visible share of the sun's disc over the surrounding ground
    visible: f32,
    sky: vec3f,
    // Stand of the object: stands.wgsl
    stand: f32,
}

fn neighbours_of(instance: Instance) -> f32 { return f32(instance.among & 0xffffu) / 4096.0; }

fn turned(q: vec4f, v: vec3f) -> vec3f {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

// Sines of the angle of the ray to an object over the ground: on flatter rays it is widened to the side alone, on
// steeper ones to all sides.
const WIDENED_ASIDE: vec2f = vec2f(0.25, 0.8);

// A place in an object, metres from its foot: that of an object that stands for several is moved away from its axis.
// `up`: its axis.
fn widened(instance: Instance, at_m: vec3f, up: vec3f) -> vec3f {
    let code = (instance.among >> 16u) & 0xffu;
    if code == 0u { return at_m; }
    let to_foot = normalize(instance.foot_rel_m);
    let aside = normalize(cross(up, to_foot) + 1e-5 * up.zxy);
    let along = cross(aside, up);
    let octaves = f32(code) / 64.0;
    let steep = 0.5 * smoothstep(WIDENED_ASIDE.x, WIDENED_ASIDE.y, abs(dot(up, to_foot)));
    let across_m = dot(at_m, aside) * (exp2(octaves * (1.0 - steep)) - 1.0);
    let rise = f32(bitcast<i32>(instance.among) >> 24u) / 64.0;
    return at_m + (aside + up * rise) * across_m + along * (dot(at_m, along) * (exp2(octaves * steep) - 1.0));
}

fn kind_of(instance: Instance) -> u32 { return instance.material & 0xffu; }

// Share of its height that is under the ground.
fn sunk_of(instance: Instance) -> f32 { return f32((instance.material >> 8u) & 0xffu) / 255.0; }
