// What objects leave of the light of the first sun and of the sky at a point.
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
// The cascade that tells of the sky.
const WIDE: i32 = 1;

// Mean share over four points about a place of a cascade, `apart` from one another in texture coordinates.
fn cascade_light(cascade: i32, clip: vec3f, apart: vec2f) -> f32 {
    let uv = clip.xy * vec2f(0.5, -0.5) + 0.5;
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let aside = (vec2f(f32(i & 1), f32(i >> 1u)) - 0.5) * apart;
        sum += textureSampleCompareLevel(object_shadows, compared, uv + aside, cascade, clip.z);
    }
    return 0.25 * sum;
}

// `n`: normal of the surface at the point, which is `rel_m` from the eye.
fn object_shade(rel_m: vec3f, n: vec3f) -> ObjectShade {
    if body.has_shadows == 0u { return NO_SHADE; }
    let texel = 1.0 / vec2f(textureDimensions(object_shadows));
    var out = NO_SHADE;
    var left = 1.0;
    for (var cascade = 0; cascade < 2; cascade++) {
        let texel_m = body.shadow_texel_m[cascade];
        // A surface does not shade itself: it is looked at from a little above.
        let at = rel_m + (n + body.suns[0].dir) * (1.3 * texel_m);
        let clip = (body.shadow_from_rel_m[cascade] * vec4f(at, 1.0)).xyz;
        // Each cascade hands over to the next towards its edge.
        let own = 1.0 - smoothstep(0.75, 0.98, max(abs(clip.x), abs(clip.y)));
        if own <= 0.0 || clip.z <= 0.0 || clip.z >= 1.0 { continue; }
        // A mean over few texels softens the edge.
        out.sun += left * own * (cascade_light(cascade, clip, 1.2 * texel) - 1.0);
        left *= 1.0 - own;
        if cascade == WIDE {
            let wide = cascade_light(cascade, clip, 2.0 * SKY_REACH_M / texel_m * texel);
            out.sky = mix(1.0, mix(UNDER_CROWNS, 1.0, wide), own);
            out.known.y = own;
        }
    }
    out.known.x = 1.0 - left;
    return out;
}
