// A game's own shader: towers that stand in the air of a planet. `air_wgsl` stands before this text.

struct Tower {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    // Foot of the tower from the eye, metres, and its axes with their lengths
    @location(2) foot_m: vec3f,
    @location(3) east_m: vec3f,
    @location(4) north_m: vec3f,
    @location(5) up_m: vec3f,
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) rel_m: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn tower_vertex(in: Tower) -> Corner {
    let rel_m = in.foot_m + in.position.x * in.east_m + in.position.y * in.north_m + in.position.z * in.up_m;
    let n = in.normal.x * normalize(in.east_m) + in.normal.y * normalize(in.north_m) + in.normal.z * normalize(in.up_m);
    return Corner(body.clip_from_rel_m * vec4f(rel_m, 1.0), rel_m, n);
}

@fragment
fn tower_fragment(in: Corner) -> @location(0) vec4f {
    const ALBEDO: vec3f = vec3f(0.55, 0.14, 0.10);
    let light = light_at(in.rel_m, normalize(in.normal));
    return vec4f(ALBEDO / PI * (light.sun + light.sky), 1.0);
}
