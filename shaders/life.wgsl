// Objects that stand on the ground: plants, stones. Opaque meshes, drawn by instance.
#include "object_shadow.wgsl"
#include "neighbours.wgsl"
#include "math.wgsl"
#include "life_instance.wgsl"

@group(1) @binding(0) var<storage, read> instances: array<Instance>;
@group(1) @binding(1) var<storage, read> lights: array<ObjectLight>;

struct Vertex {
    // Height 1, z up
    @location(0) position: vec3f,
    @location(1) normal: vec4f,
    // Share of the second colour; share of the sky that it sees; how far the wind moves it; level of detail, a third
    // for each
    @location(2) look: vec4f,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) rel_m: vec3f,
    @location(1) normal: vec3f,
    @location(2) albedo: vec3f,
    // Share of the second colour, and of the sky that is seen
    @location(3) look: vec2f,
    @location(4) @interpolate(flat) sun: vec4f,
    @location(5) @interpolate(flat) sky: vec3f,
    // Position in the form; strength of the mottling
    @location(6) mottle: vec4f,
    // Way towards the sun within the object's own leaves, which `look` already darkens
    @location(7) @interpolate(flat) own_m: f32,
    // Share of the sun's light that neighbours leave, where no map of shadows tells
    @location(8) @interpolate(flat) among: f32,
    @location(9) @interpolate(flat) level: f32,
}

fn lattice_value(cell: vec3i) -> f32 { return unit_from_hash(hash3(vec3u(cell))).x; }

// Smooth noise of mean 0.5 with cells of length 1.
fn lattice_noise(p: vec3f) -> f32 {
    let cell = vec3i(floor(p));
    let f = smoothstep(vec3f(0.0), vec3f(1.0), p - floor(p));
    var rows: array<f32, 4>;
    for (var i = 0; i < 4; i++) {
        let at = cell + vec3i(0, i & 1, i >> 1u);
        rows[i] = mix(lattice_value(at), lattice_value(at + vec3i(1, 0, 0)), f.x);
    }
    return mix(mix(rows[0], rows[1], f.y), mix(rows[2], rows[3], f.y), f.z);
}

fn turned(q: vec4f, v: vec3f) -> vec3f {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

@vertex
fn vertex(in: Vertex, @builtin(instance_index) index: u32) -> Surface {
    let instance = instances[index];
    let light = lights[index];
    let turn = normalize(vec4f(unpack2x16snorm(instance.turn.x), unpack2x16snorm(instance.turn.y)));
    let first = unpack4x8unorm(instance.colors.x);
    let second = unpack4x8unorm(instance.colors.y);
    var at_m = turned(turn, in.position) * instance.size_m;
    // The wind sways the tips to and fro, each object in its own time.
    let gust = sin(frame.time_secs * (1.1 + 0.5 * second.a) + 6.2832 * second.a);
    let reach_m = 0.5 * first.a * instance.size_m * in.look.z * in.look.z;
    at_m += turned(turn, vec3f(0.8, 0.6, 0.0)) * (gust * reach_m);
    var out: Surface;
    out.rel_m = instance.foot_rel_m + at_m;
    out.position = body.clip_from_rel_m * vec4f(out.rel_m, 1.0);
    out.normal = turned(turn, in.normal.xyz);
    out.albedo = mix(first.rgb * first.rgb, second.rgb * second.rgb, in.look.x);
    out.look = in.look.xy;
    out.sun = vec4f(light.sun, light.visible);
    out.sky = light.sky;
    let sun = body.suns[0].dir;
    out.among = neighbours_leave(
        instance.neighbours, ray_tangent(dot(body.eye_up, sun)), dot(normalize(-out.rel_m), sun),
    );
    out.level = in.look.w;
    out.own_m = OWN_LEAVES * in.look.x * instance.size_m;
    // Coarse levels are smooth where fine ones have single leaves.
    out.mottle = vec4f(in.position * 11.0 + 64.0 * second.a, in.look.w * in.look.x);
    return out;
}

struct Output {
    // As of the ground (terrain.wgsl)
    @location(0) light: vec4f,
    @location(1) surface: vec4f,
}

// Albedo of the ground around, which lights the undersides of objects.
const GROUND_ALBEDO: f32 = 0.25;

@fragment
fn fragment(in: Surface) -> Output {
    let up = normalize(body.eye_km + in.rel_m * 0.001);
    let n = normalize(in.normal);
    let l = body.suns[0].dir;
    let leaf = in.look.x;
    let facing = dot(n, l);
    // Light is spread within a crown: its edge between light and shade is soft.
    let soft = leaf * mix(LEAF_SOFT.x, LEAF_SOFT.y, in.level);
    let front = max((facing + soft) / (1.0 + soft), 0.0) / (1.0 + 0.5 * soft);
    let behind = TRANSLUCENT * leaf * max(-facing, 0.0);
    // What sees little of the sky is shaded by the rest of the object.
    let lit = (front + behind) * smoothstep(0.0, 0.75, in.look.y);
    let open = (0.5 + 0.5 * dot(n, up)) * in.look.y;
    let mottled = 1.0 + in.mottle.w * 1.3 * (lattice_noise(in.mottle.xyz) - 0.5);
    let albedo = in.albedo * mottled;
    var shade = object_shade(in.rel_m + l * in.own_m, n);
    shade.sun -= (1.0 - shade.known.x) * (1.0 - in.among);
    let sky = in.sky * mix(1.0, shade.sky, 1.0 - 0.6 * leaf);
    // The ground around is in the sun as far as crowns leave it the sky, also where the object shades itself.
    let ground = in.sun.rgb * (max(dot(up, l), 0.0) * shade.sky) + sky;
    let from_below = ground * (GROUND_ALBEDO * (1.0 - open) * in.look.y);
    let through_leaves = in.sun.rgb * THROUGH_LEAVES * (1.0 - shade.sky) * open;
    let radiance = albedo * (in.sun.rgb * (lit * shade.sun) + sky * open + through_leaves + from_below) / PI;
    let shown = select(radiance, in.albedo, frame.debug_view == VIEW_ALBEDO);
    let altitude_m = dot(in.rel_m, body.eye_up) + body.eye_altitude_km * 1000.0;
    let over_sea_m = clamp(altitude_m - body.sea_level_km * 1000.0, 1.0, 60000.0);
    return Output(vec4f(min(shown, vec3f(60000.0)), over_sea_m), vec4f(15.0, 1.0 - in.sun.a, 0.0, 0.0));
}
