// The weather map: cloudiness over the whole globe as six faces of a cube. Fractal noise, advected along the curl of a
// potential, so that it swirls without bunching up.
//
// Without a structure, r is distributed evenly over 0..1. With one, r is the noise alone, and g is what the rain of the
// structure adds to it; the wind carries r, and g stays over the ground. b: speed of the wind by its mean, for the sea.
#include "screen.wgsl"
#include "math.wgsl"
#include "cloud_cover.wgsl"

struct Face {
    // The face's axes in the planet frame
    center: vec4f,
    right: vec4f,
    down: vec4f,
}
@group(1) @binding(0) var<uniform> face: Face;
// Wetness of the sky, 0.5 at its median; speed of the wind by FASTEST_WIND times its mean
@group(1) @binding(1) var solved_map: texture_cube<f32>;
// Noise for each unit of wetness, which is eight octaves of rain: chosen by eye.
const WETNESS: f32 = 0.9;

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

// Displacement by wind along the level lines of a noise on the sphere.
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
    // Weather systems smaller than the map can resolve are enlarged to the smallest size that it resolves.
    let cells = min(body.cloud_systems_per_radius, side * 0.2);
    let curl = body.cloud_curl;
    var p = dir * cells;
    // Three scales of swirl: weather systems, their arms, and frayed edges.
    p += swirl(p * 0.7, dir, 1u) * curl * 0.55;
    p += swirl(p * 1.9, dir, 2u) * curl * 0.16;
    p += swirl(p * 5.1, dir, 3u) * curl * 0.045;
    var sum = 0.0;
    var amplitude = 1.0;
    // Fronts are stretched along the parallels.
    var q = p * vec3f(0.85, 0.85, 1.3);
    // Octaves finer than the map resolves are left out.
    let finest = side * 0.2;
    for (var i = 0u; i < 9u; i++) {
        if i > 0u && cells * exp2(f32(i)) > finest { break; }
        sum += amplitude * noise(q, 10u + i);
        q = q.yzx * 2.03 + 17.3;
        amplitude *= 0.62;
    }
    // More cloud in the wet belts of the climate (Hadley and Ferrel cells), less in the dry ones.
    let s = dir.z * dir.z;
    let wet = CLIMATE_BELTS.x + s * (CLIMATE_BELTS.y + s * (CLIMATE_BELTS.z + s * CLIMATE_BELTS.w));
    let belt = body.cloud_belts * wet;
    if body.weather_share > 0.0 {
        let solved = textureSampleLevel(solved_map, clamped, dir, 0.0);
        let wind = mix(1.0, solved.g * FASTEST_WIND, body.weather_share);
        return vec4f(sum + belt, body.weather_share * WETNESS * (solved.r - 0.5), wind, 1.0);
    }
    return vec4f(evenly(sum + belt), 0.0, 0.0, 1.0);
}
