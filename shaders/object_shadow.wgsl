// What objects, and things of a game, leave of the light of the first sun and of the sky at a point.
#include "uniforms.wgsl"

struct ObjectShade {
    // Share of the sun's light
    sun: f32,
    // Share of the sky's light: under crowns the sky is hidden where the sun is, or will be
    sky: f32,
    // How much of both is known: objects beyond the map shade, too
    known: vec2f,
}

const NO_SHADE: ObjectShade = ObjectShade(1.0, 1.0, vec2f(0.0));
// Around a point, the metres within which objects hide its sky, and the share that crowns leave of it.
const SKY_REACH_M: f32 = 5.0;
const UNDER_CROWNS: f32 = 0.45;
// The maps: around the eye all that casts shadows; farther out objects alone, which tells of the sky, too; farthest out
// things of a game alone.
const NEAR_MAP: i32 = 0;
const WIDE_MAP: i32 = 1;
const CASTER_MAP: i32 = 2;

// A point in a map: its place in clip space, and how far the map counts there.
struct InMap {
    clip: vec3f,
    own: f32,
}

// The point of a surface with normal `n`, `rel_m` from the eye.
fn in_map(map: i32, rel_m: vec3f, n: vec3f) -> InMap {
    // A surface does not shade itself: it is looked at from a little above.
    let at = rel_m + (n + body.suns[0].dir) * (1.3 * body.shadow_texel_m[map]);
    let clip = (body.shadow_from_rel_m[map] * vec4f(at, 1.0)).xyz;
    // Each map hands over to the next towards its edge.
    let own = 1.0 - smoothstep(0.75, 0.98, max(abs(clip.x), abs(clip.y)));
    return InMap(clip, select(own, 0.0, clip.z <= 0.0 || clip.z >= 1.0));
}

// Mean share over four points about a place of a map, `apart` texels from one another.
fn map_light(map: i32, clip: vec3f, apart: f32) -> f32 {
    let uv = clip.xy * vec2f(0.5, -0.5) + 0.5;
    let step = apart / vec2f(textureDimensions(object_shadows));
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let aside = (vec2f(f32(i & 1), f32(i >> 1u)) - 0.5) * step;
        sum += textureSampleCompareLevel(object_shadows, compared, uv + aside, map, clip.z);
    }
    return 0.25 * sum;
}

// A mean over few texels softens the edge.
const SOFT_TEXELS: f32 = 1.2;

// `n`: normal of the surface at the point, which is `rel_m` from the eye.
fn object_shade(rel_m: vec3f, n: vec3f) -> ObjectShade {
    if body.has_shadows + body.has_casters == 0u { return NO_SHADE; }
    let near = in_map(NEAR_MAP, rel_m, n);
    var out = NO_SHADE;
    if body.has_shadows != 0u {
        let wide = in_map(WIDE_MAP, rel_m, n);
        if wide.own > 0.0 {
            if near.own < 1.0 { out.sun = mix(1.0, map_light(WIDE_MAP, wide.clip, SOFT_TEXELS), wide.own); }
            let around = map_light(WIDE_MAP, wide.clip, 2.0 * SKY_REACH_M / body.shadow_texel_m[WIDE_MAP]);
            out.sky = mix(1.0, mix(UNDER_CROWNS, 1.0, around), wide.own);
        }
        out.known = vec2f(mix(wide.own, 1.0, near.own), wide.own);
    }
    if body.has_casters != 0u && near.own < 1.0 {
        let far = in_map(CASTER_MAP, rel_m, n);
        if far.own > 0.0 { out.sun *= mix(1.0, map_light(CASTER_MAP, far.clip, SOFT_TEXELS), far.own); }
    }
    if near.own > 0.0 { out.sun = mix(out.sun, map_light(NEAR_MAP, near.clip, SOFT_TEXELS), near.own); }
    return out;
}
