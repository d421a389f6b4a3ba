// For shaders of a game that draw its things into the maps of shadows. Points are relative to the eye in the body's
// axes. A vertex shader gives `shadow_view.clip_from_rel_m * vec4f(rel_m, 1.0)`.

struct ShadowView {
    clip_from_rel_m: mat4x4f,
}

@group(0) @binding(0) var<uniform> shadow_view: ShadowView;
