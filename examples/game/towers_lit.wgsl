// A game's own shader: towers that stand in the air of a planet. `air_wgsl` and `towers.wgsl` stand before this text.

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) rel_m: vec3f,
    @location(1) normal: vec3f,
    @location(2) height: f32,
    @location(3) @interpolate(flat) sun_shares: vec4f,
}

@vertex
fn tower_vertex(in: Tower) -> Corner {
    let rel_m = tower_rel_m(in);
    let n = in.normal.x * normalize(in.east_m) + in.normal.y * normalize(in.north_m) + in.normal.z * normalize(in.up_m);
    return Corner(body.clip_from_rel_m * vec4f(rel_m, 1.0), rel_m, n, in.position.z, in.sun_shares);
}

@fragment
fn tower_fragment(in: Corner) -> @location(0) vec4f {
    const ALBEDO: vec3f = vec3f(0.55, 0.14, 0.10);
    // Between the heights at which the shadow of the ground is known.
    let part = clamp(vec3f(3.0 * in.height) - vec3f(0.0, 1.0, 2.0), vec3f(0.0), vec3f(1.0));
    let from_ground = in.sun_shares.x + dot(part, in.sun_shares.yzw - in.sun_shares.xyz);
    let light = shaded_light_at(in.rel_m, normalize(in.normal), from_ground);
    return vec4f(ALBEDO / PI * (light.sun + light.sky), 1.0);
}
