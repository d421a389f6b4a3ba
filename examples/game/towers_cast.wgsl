// A game's own shader: towers in a map of shadows. `caster_wgsl` and `towers.wgsl` stand before this text.

@vertex
fn tower_vertex(in: Tower) -> @builtin(position) vec4f {
    return shadow_view.clip_from_rel_m * vec4f(tower_rel_m(in), 1.0);
}
