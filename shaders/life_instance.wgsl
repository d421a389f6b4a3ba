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
    // Area of neighbours that shade the object, for each area of ground
    neighbours: f32,
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

fn kind_of(instance: Instance) -> u32 { return instance.material & 0xffu; }

// Share of its height that is under the ground.
fn sunk_of(instance: Instance) -> f32 { return f32((instance.material >> 8u) & 0xffu) / 255.0; }
