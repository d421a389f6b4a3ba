// The weather over the whole globe as six faces of a cube: how cloudy a place is, spread evenly over 0..1.
// Fractal noise, torn along the curl of a potential so that it swirls but never bunches up.
#include "screen.wgsl"
#include "math.wgsl"

struct Face {
    // The face's axes: centre, right, down
    center: vec4f,
    right: vec4f,
    down: vec4f,
}
@group(1) @binding(0) var<uniform> face: Face;

fn lattice(cell: vec3i, seed: u32) -> vec3f {
    let bits = hash3(bitcast<vec3u>(cell) + vec3u(body.cloud_seed, seed, body.cloud_seed ^ 0x9e3779b9u));
    return unit_from_hash(bits) * 2.0 - 1.0;
}

fn corner(base: vec3f, cell: vec3i, f: vec3f, o: vec3i, seed: u32) -> f32 {
    return dot(lattice(cell + o, seed), f - vec3f(o));
}

// Gradient noise (Perlin 2002), about -1..1.
fn noise(p: vec3f, seed: u32) -> f32 {
    let base = floor(p);
    let cell = vec3i(base);
    let f = p - base;
    let u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let x00 = mix(corner(base, cell, f, vec3i(0, 0, 0), seed), corner(base, cell, f, vec3i(1, 0, 0), seed), u.x);
    let x10 = mix(corner(base, cell, f, vec3i(0, 1, 0), seed), corner(base, cell, f, vec3i(1, 1, 0), seed), u.x);
    let x01 = mix(corner(base, cell, f, vec3i(0, 0, 1), seed), corner(base, cell, f, vec3i(1, 0, 1), seed), u.x);
    let x11 = mix(corner(base, cell, f, vec3i(0, 1, 1), seed), corner(base, cell, f, vec3i(1, 1, 1), seed), u.x);
    return mix(mix(x00, x10, u.y), mix(x01, x11, u.y), u.z);
}

// The way wind carries a point along the level lines of a noise on the sphere.
fn swirl(p: vec3f, dir: vec3f, seed: u32) -> vec3f {
    const E: f32 = 0.05;
    let here = noise(p, seed);
    let gradient = vec3f(
        noise(p + vec3f(E, 0.0, 0.0), seed) - here,
        noise(p + vec3f(0.0, E, 0.0), seed) - here,
        noise(p + vec3f(0.0, 0.0, E), seed) - here,
    ) / E;
    return cross(dir, gradient);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let side = f32(WEATHER_SIDE);
    let x = pixel.xy / side * 2.0 - 1.0;
    let dir = normalize(face.center.xyz + face.right.xyz * x.x + face.down.xyz * x.y);
    // Smaller systems than the map can hold are drawn as large as it can.
    let cells = min(body.cloud_systems_per_radius, side * 0.2);
    let curl = body.cloud_curl;
    var p = dir * cells;
    // Weather systems turn, then their arms turn, then their edges fray.
    p += swirl(p * 0.7, dir, 1u) * curl * 0.55;
    p += swirl(p * 1.9, dir, 2u) * curl * 0.16;
    p += swirl(p * 5.1, dir, 3u) * curl * 0.045;
    var sum = 0.0;
    var amplitude = 1.0;
    // Fronts are long along the parallels.
    var q = p * vec3f(0.85, 0.85, 1.3);
    // No octave finer than the map can hold.
    let finest = side * 0.2;
    for (var i = 0u; i < 9u; i++) {
        if i > 0u && cells * exp2(f32(i)) > finest { break; }
        sum += amplitude * noise(q, 10u + i);
        q = q.yzx * 2.03 + 17.3;
        amplitude *= 0.62;
    }
    // Wet at the equator and in the middle latitudes, dry between them (Hadley and Ferrel cells).
    let belt = 0.10 * cos(6.0 * asin(clamp(dir.z, -1.0, 1.0)));
    let evenly = 0.5 + 0.5 * tanh((sum + belt) * 1.9);
    return vec4f(evenly, 0.0, 0.0, 1.0);
}
