// A game's own towers, as both of its shaders know them.

struct Tower {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    // Foot of the tower from the eye, metres, and its axes with their lengths
    @location(2) foot_m: vec3f,
    @location(3) east_m: vec3f,
    @location(4) north_m: vec3f,
    @location(5) up_m: vec3f,
    // What the ground leaves of the sun at four heights
    @location(6) sun_shares: vec4f,
}

fn tower_rel_m(in: Tower) -> vec3f {
    return in.foot_m + in.position.x * in.east_m + in.position.y * in.north_m + in.position.z * in.up_m;
}
