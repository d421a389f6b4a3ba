// Objects that stand on the ground: plants, stones. Opaque meshes, drawn by instance.
#include "object_shadow.wgsl"
#include "neighbours.wgsl"
#include "life_material.wgsl"
#include "hues.wgsl"
#include "life_instance.wgsl"
#include "life_vertex.wgsl"

@group(1) @binding(0) var<storage, read> instances: array<Instance>;
@group(1) @binding(1) var<storage, read> lights: array<ObjectLight>;

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) rel_m: vec3f,
    @location(1) normal: vec3f,
    @location(2) albedo: vec3f,
    // Share of the second colour, and of the sky that is seen; height over the ground, metres
    @location(3) look: vec3f,
    @location(4) @interpolate(flat) sun: vec4f,
    @location(5) @interpolate(flat) sky: vec3f,
    // Place in the form, metres, moved by another way in each object; strength of the mottling
    @location(6) place_m: vec4f,
    @location(7) @interpolate(flat) size_m: f32,
    // Share of the sun's light that neighbours leave, where no map of shadows tells
    @location(8) @interpolate(flat) among: f32,
    @location(9) @interpolate(flat) level: f32,
    @location(10) @interpolate(flat) material: u32,
    // Factor on the light of the level of detail
    @location(11) @interpolate(flat) level_light: f32,
}

@vertex
fn vertex(in: Vertex, @builtin(instance_index) index: u32) -> Surface {
    let instance = instances[index];
    let light = lights[index];
    let turn = normalize(vec4f(unpack2x16snorm(instance.turn.x), unpack2x16snorm(instance.turn.y)));
    let first = unpack4x8unorm(instance.colors.x);
    let second = unpack4x8unorm(instance.colors.y);
    var at_m = widened(instance, turned(turn, in.position) * instance.size_m, turned(turn, vec3f(0.0, 0.0, 1.0)));
    // The wind sways the tips to and fro, each object in its own time.
    let gust = sin(frame.time_secs * (1.1 + 0.5 * second.a) + 6.2832 * second.a);
    let reach_m = 0.5 * first.a * instance.size_m * in.look.z * in.look.z;
    at_m += turned(turn, vec3f(0.8, 0.6, 0.0)) * (gust * reach_m);
    var out: Surface;
    out.rel_m = instance.foot_rel_m + at_m;
    out.position = body.clip_from_rel_m * vec4f(out.rel_m, 1.0);
    out.normal = turned(turn, in.normal.xyz);
    // The phase goes with the rank, by which objects thin out: hues do not.
    let leaf = second.rgb * second.rgb;
    let hued = hue_of_one(leaf, fract(second.a * 157.7) + STAND_HUES * light.stand) * (1.0 + STANDS * light.stand);
    out.albedo = mix(first.rgb * first.rgb, select(leaf, hued, kind_of(instance) >= LEAFY), in.look.x);
    out.albedo *= tint_of(in);
    out.look = vec3f(in.look.xy, (in.position.z - sunk_of(instance)) * instance.size_m);
    out.sun = vec4f(light.sun, light.visible);
    out.sky = light.sky;
    let sun = body.suns[0].dir;
    out.among = neighbours_leave(
        neighbours_of(instance), ray_tangent(dot(body.eye_up, sun)), dot(normalize(-out.rel_m), sun),
    );
    out.level = in.look.w;
    out.level_light = exp2(in.normal.w);
    out.size_m = instance.size_m;
    out.material = kind_of(instance);
    // Coarse levels are smooth where fine ones have single leaves.
    out.place_m = vec4f((in.position + 6.0 * second.a) * instance.size_m, in.look.w * in.look.x);
    return out;
}

struct Output {
    // As of the ground (terrain.wgsl)
    @location(0) light: vec4f,
    @location(1) surface: vec4f,
}

// Distance within which leaves before the eye dissolve, metres.
const LENS_M: f32 = 1.2;

// Noise of mean 0.5 over the pixels of the picture (interleaved gradient noise, Jimenez 2014).
fn pixel_noise(at: vec2f) -> f32 { return fract(52.9829189 * fract(dot(at, vec2f(0.06711056, 0.00583715)))); }

// Normal of a surface that rises over that of the mesh (Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU,
// 2010). `along`, `rise`: change of the place and of the height from one pixel to the next.
fn raised(n: vec3f, along: mat2x3f, rise: vec2f) -> vec3f {
    let right = cross(along[1], n);
    let up = cross(n, along[0]);
    let area = dot(along[0], right);
    let slope = sign(area) * (rise.x * right + rise.y * up);
    return normalize(abs(area) * n - clamp(slope, vec3f(-1.5 * abs(area)), vec3f(1.5 * abs(area))));
}

// Height over the ground up to which soil and moss stain wood and stone, metres, and as a share of the height of the
// object; factor on the colour where they cover it, and the share of that which stone takes.
const SOIL_M: f32 = 0.45;
const SOIL_SHARE: f32 = 0.3;
const SOIL_TINT: vec3f = vec3f(0.42, 0.40, 0.28);
const SOIL_ON_STONE: f32 = 0.5;

// Factor on the albedo near the ground. `above_m`: height over it.
fn soiled(kind: u32, leaf: f32, above_m: f32, size_m: f32, p_m: vec3f) -> vec3f {
    let reach_m = min(SOIL_M, SOIL_SHARE * size_m);
    let is_wood = kind >= LEAFY && kind != BLADED && leaf < 0.5;
    // Where there is no water there is no soil.
    let is_stained = is_wood || (kind == ROCK && body.has_sea != 0u);
    if above_m > reach_m || !is_stained { return vec3f(1.0); }
    let ragged = 0.6 * (lattice_noise(p_m / (0.3 * reach_m)) - 0.5);
    let share = 1.0 - smoothstep(0.0, 1.0, max(above_m / reach_m, 0.0) + ragged);
    return mix(vec3f(1.0), SOIL_TINT, share * select(1.0, SOIL_ON_STONE, kind == ROCK));
}

// Albedo of the ground around, which lights the undersides of objects.
const GROUND_ALBEDO: f32 = 0.25;

@fragment
fn fragment(in: Surface) -> Output {
    let up = normalize(body.eye_km + in.rel_m * 0.001);
    let l = body.suns[0].dir;
    let leaf = in.look.x;
    let distance_m = length(in.rel_m);
    let material = object_material(in.material, leaf, in.place_m.xyz, in.size_m, distance_m * frame.pixel_rad);
    let along = mat2x3f(dpdx(in.rel_m), dpdy(in.rel_m));
    let rise = vec2f(dpdx(material.height_m), dpdy(material.height_m));
    let n = raised(normalize(in.normal + material.tilt), along, rise);
    let is_at_lens = leaf > 0.5 && distance_m < LENS_M * (0.4 + 0.6 * pixel_noise(in.position.xy));
    if is_at_lens || material.gap > 0.5 { discard; }
    let facing = dot(n, l);
    // Light is spread within a crown: its edge between light and shade is soft.
    let soft = leaf * mix(LEAF_SOFT.x, LEAF_SOFT.y, in.level);
    let front = max((facing + soft) / (1.0 + soft), 0.0) / (1.0 + 0.5 * soft);
    let behind = TRANSLUCENT * leaf * max(-facing, 0.0);
    // What sees little of the sky is shaded by the rest of the object.
    let lit = (front + behind) * smoothstep(0.0, 0.75, in.look.y);
    let open = (0.5 + 0.5 * dot(n, up)) * in.look.y;
    let mottled = 1.0 + in.place_m.w * 1.3 * (lattice_noise(in.place_m.xyz * (11.0 / in.size_m)) - 0.5);
    let soil = soiled(in.material, leaf, in.look.z, in.size_m, in.place_m.xyz);
    let albedo = in.albedo * material.tint * soil * (mottled * in.level_light);
    var shade = object_shade(in.rel_m + l * (OWN_LEAVES * leaf * in.size_m), n);
    shade.sun -= (1.0 - shade.known.x) * (1.0 - in.among);
    let sky = in.sky * mix(1.0, shade.sky, 1.0 - 0.6 * leaf);
    // The ground around is in the sun as far as crowns leave it the sky, also where the object shades itself.
    let ground = in.sun.rgb * (max(dot(up, l), 0.0) * shade.sky) + sky;
    let from_below = ground * (GROUND_ALBEDO * (1.0 - open) * in.look.y);
    let through_leaves = in.sun.rgb * body.through_leaves * (1.0 - shade.sky) * open;
    let radiance = albedo * (in.sun.rgb * (lit * shade.sun) + sky * open + through_leaves + from_below) / PI;
    let shown = select(radiance, in.albedo, frame.debug_view == VIEW_ALBEDO);
    let altitude_m = dot(in.rel_m, body.eye_up) + body.eye_altitude_km * 1000.0;
    let over_sea_m = clamp(altitude_m - body.sea_level_km * 1000.0, 1.0, 60000.0);
    return Output(vec4f(min(shown, vec3f(60000.0)), over_sea_m), vec4f(15.0, 1.0 - in.sun.a, 0.0, 0.0));
}
